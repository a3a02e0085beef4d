// The order of assembly, checked against the rules themselves: a second, slow reading of them that shares no
// code with the planner, and, for small designs, every order there is.
#include "assembly/columns.h"
#include "kernel/assembly_scene.h"

#include <ctime>

using namespace diatom;
using namespace diatom::test;

namespace {

const std::string kCube = "org.diatom_cad.lattice.cube";
const std::string kGik = "org.diatom_cad.lattice.gik";
constexpr unsigned kSeed = 20240611;

/// The rules as they read, for lattices whose columns are those of (x, y) and whose layers are those of z.
class Rules
{
public:
   explicit Rules(const AssemblyScene &scene) : m_scene(scene)
   {
      for (const Index cell : scene.parts.covered)
         m_lowest = std::min(m_lowest, cell.z);
   }

   std::vector<Index> cells(std::int64_t part) const
   {
      const Part &p = m_scene.parts.parts[static_cast<std::size_t>(part)];
      const auto first = m_scene.parts.covered.begin() + p.firstCell;
      return {first, first + p.cells};
   }

   bool held(std::int64_t part, const std::set<Index> &placed) const
   {
      for (const Index cell : cells(part)) {
         if (cell.z == m_lowest)
            return true;
         for (const Link &link : m_scene.lattice->links(m_scene.lattice->site(cell)))
            if (link.joined && link.offset.z <= 0 && placed.contains(cell + link.offset))
               return true;
      }
      return false;
   }

   bool reachable(std::int64_t part, const std::set<Index> &placed) const
   {
      for (const Index cell : cells(part))
         for (const Index other : placed)
            if (other.x == cell.x && other.y == cell.y && other.z > cell.z)
               return false;
      return true;
   }

   /// Parts that at least one legal order places: all states that can be reached, as sets of parts.
   std::set<std::int64_t> possible() const
   {
      const auto count = static_cast<int>(m_scene.parts.parts.size());
      std::set<std::uint32_t> seen{0};
      std::vector<std::uint32_t> open{0};
      std::uint32_t ever = 0;
      while (!open.empty()) {
         const std::uint32_t state = open.back();
         open.pop_back();
         ever |= state;
         std::set<Index> placed;
         for (int part = 0; part < count; ++part)
            if ((state >> part & 1u) != 0)
               for (const Index cell : cells(part))
                  placed.insert(cell);
         for (int part = 0; part < count; ++part) {
            const std::uint32_t next = state | 1u << part;
            if (next != state && held(part, placed) && reachable(part, placed) && seen.insert(next).second)
               open.push_back(next);
         }
      }
      std::set<std::int64_t> result;
      for (int part = 0; part < count; ++part)
         if ((ever >> part & 1u) != 0)
            result.insert(part);
      return result;
   }

private:
   const AssemblyScene &m_scene;
   std::int32_t m_lowest = std::numeric_limits<std::int32_t>::max();
};

/// Whether a cell of a block is joined to higher ones only, as at the corner of a block of shifted layers.
bool hangs(const Lattice &lattice, const std::vector<Index> &block, Index cell)
{
   const auto links = lattice.links(lattice.site(cell));
   const double height = lattice.position(cell).z();
   return cell.z > 1 && std::none_of(links.begin(), links.end(), [&](const Link &link) {
             const Index other = cell + link.offset;
             return link.joined && std::find(block.begin(), block.end(), other) != block.end() &&
                    lattice.position(other).z() < height + 1e-9;
          });
}

AssemblyPlan planOf(const AssemblyScene &scene)
{
   const auto plan = planAssembly(*scene.hierarchy, scene.parts, Job());
   if (!plan.ok())
      qFatal("%s", plan.error().message.c_str());
   return *plan;
}

std::vector<Index> firstCells(const AssemblyScene &scene, const AssemblyPlan &plan)
{
   std::vector<Index> result;
   for (const std::int64_t part : plan.order)
      result.push_back(Rules(scene).cells(part).front());
   return result;
}

/// Every step of the plan obeys the rules, and every part is either placed once or in a problem.
void verifySteps(const AssemblyScene &scene, const AssemblyPlan &plan)
{
   const Rules rules(scene);
   std::set<Index> placed, told;
   for (const std::int64_t part : plan.order) {
      QVERIFY2(rules.held(part, placed), "a part was placed that nothing holds");
      QVERIFY2(rules.reachable(part, placed), "a part was placed beneath another");
      for (const Index cell : rules.cells(part))
         QVERIFY(placed.insert(cell).second);
   }
   for (const Problem &problem : plan.problems)
      for (const Index cell : problem.cells)
         QVERIFY(told.insert(cell).second && !placed.contains(cell));
   QCOMPARE(placed.size() + told.size(), scene.parts.covered.size());
}

/// Processor time, as the tests may run beside others; planning and writing use one thread.
double processorSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

} // namespace

class AssemblyPlanTest : public QObject
{
   Q_OBJECT

private slots:
   void anEmptyDesignHasAnEmptyPlan()
   {
      const AssemblyPlan plan = planOf(assemblyOf(kCube, {}));
      QVERIFY(plan.order.empty());
      QVERIFY(plan.problems.empty());
   }

   void layersGoUpwardsAndRowsAlongX()
   {
      const AssemblyScene scene = cellsOf(
          kCube, {{1, 1, 1}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}});
      const std::vector<Index> expected = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                                           {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
      QVERIFY(firstCells(scene, planOf(scene)) == expected);
   }

   void anOverhangWaitsForThePartBesideIt()
   {
      // The left arm of a T comes before its stem in the row, but is held by it only.
      const AssemblyScene scene = cellsOf(kCube, {{0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {3, 0, 1}, {2, 0, 0}});
      const std::vector<Index> expected = {{2, 0, 0}, {2, 0, 1}, {1, 0, 1}, {0, 0, 1}, {3, 0, 1}};
      QVERIFY(firstCells(scene, planOf(scene)) == expected);
   }

   void anArchIsClosed()
   {
      std::vector<Index> cells;
      for (std::int32_t z = 0; z < 4; ++z)
         for (const std::int32_t x : {0, 4})
            cells.push_back({x, 0, z});
      for (std::int32_t x = 1; x < 4; ++x)
         cells.push_back({x, 0, 3});
      const AssemblyPlan plan = planOf(cellsOf(kCube, cells));
      QCOMPARE(plan.order.size(), cells.size());
      QVERIFY(plan.problems.empty());
   }

   void whatHangsIsNotHeldFromAbove()
   {
      const AssemblyScene scene = cellsOf(kCube, {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {1, 0, 2}, {1, 0, 1}});
      const AssemblyPlan plan = planOf(scene);
      // (1, 0, 1) is beside (0, 0, 1), so a cube holds; without that neighbour it would hang from (1, 0, 2).
      QCOMPARE(plan.order.size(), std::size_t{5});
      const AssemblyScene hanging =
          cellsOf(kCube, {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {1, 0, 2}, {2, 0, 2}, {2, 0, 1}});
      const AssemblyPlan left = planOf(hanging);
      QCOMPARE(left.order.size(), std::size_t{5});
      QCOMPARE(left.problems.size(), std::size_t{1});
      QCOMPARE(left.problems[0].kind, std::string("unsupported-part"));
      QVERIFY(left.problems[0].severity == Problem::Severity::error);
      QCOMPARE(left.problems[0].text, std::string("nothing holds the part at (2, 0, 1) from below or beside: "
                                                  "add a support or turn the design"));
      QVERIFY(left.problems[0].cells == std::vector<Index>({{2, 0, 1}}));
   }

   void aFloatingIslandIsOneProblem()
   {
      const AssemblyScene scene = cellsOf(kCube, {{0, 0, 0}, {5, 5, 5}, {5, 5, 6}, {6, 5, 5}, {9, 9, 9}});
      const AssemblyPlan plan = planOf(scene);
      QCOMPARE(plan.order.size(), std::size_t{1});
      QCOMPARE(plan.problems.size(), std::size_t{2});
      QCOMPARE(plan.problems[0].cells.size(), std::size_t{3});
      QVERIFY(plan.problems[0].text.find("the 3 parts around (5, 5, 5)") != std::string::npos);
   }

   void theLowestLayerIsThePlateWhereverItLies()
   {
      const AssemblyPlan plan = planOf(cellsOf(kCube, {{-7, 3, -40}, {-7, 3, -39}, {8, 8, -40}}));
      QCOMPARE(plan.order.size(), std::size_t{3});
   }

   void bricksAreHeldByBricksBelowOnly()
   {
      // Even layers run along y, odd ones along x. The second brick of layer 1 touches the first, end to end,
      // but GIK parts join up and down only.
      const AssemblyScene scene = assemblyOf(
          kGik, {{{0, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {1, 0, 1}, {2, 0, 1}}, {{3, 0, 1}, {4, 0, 1}}});
      const AssemblyPlan plan = planOf(scene);
      QVERIFY(firstCells(scene, plan) == std::vector<Index>({{0, 0, 0}, {0, 0, 1}}));
      QCOMPARE(plan.problems.size(), std::size_t{1});
   }

   void crossedBricksInterlock()
   {
      std::vector<std::vector<Index>> runs;
      for (std::int32_t z = 0; z < 6; ++z)
         for (std::int32_t i = 0; i < 4; ++i) {
            auto &run = runs.emplace_back();
            for (std::int32_t k = 0; k < 4; ++k)
               run.push_back(z % 2 == 0 ? Index{i, k, z} : Index{k, i, z});
         }
      const AssemblyScene scene = assemblyOf(kGik, runs);
      const AssemblyPlan plan = planOf(scene);
      QCOMPARE(plan.order.size(), runs.size());
      verifySteps(scene, plan);
   }

   void everyStepObeysTheRules_data()
   {
      QTest::addColumn<QString>("lattice");
      QTest::addColumn<int>("longest");
      QTest::newRow("cube") << QString::fromStdString(kCube) << 1;
      QTest::newRow("gik") << QString::fromStdString(kGik) << 5;
   }

   void everyStepObeysTheRules()
   {
      QFETCH(QString, lattice);
      QFETCH(int, longest);
      qInfo("seed %u", kSeed);
      std::mt19937 random(kSeed);
      std::size_t placed = 0, left = 0;
      for (int round = 0; round < 60; ++round) {
         const double density = 0.15 + 0.01 * round;
         const AssemblyScene scene = randomAssembly(lattice.toStdString(), random, 7, 6, density, longest);
         const AssemblyPlan plan = planOf(scene);
         verifySteps(scene, plan);
         placed += plan.order.size();
         left += scene.parts.parts.size() - plan.order.size();
      }
      QVERIFY2(placed > 500 && left > 500, "the designs must try both verdicts");
   }

   void whatIsLeftOutNoOrderCanPlace_data() { everyStepObeysTheRules_data(); }

   void whatIsLeftOutNoOrderCanPlace()
   {
      QFETCH(QString, lattice);
      QFETCH(int, longest);
      qInfo("seed %u", kSeed);
      std::mt19937 random(kSeed + 1);
      int tried = 0;
      for (int round = 0; round < 400; ++round) {
         const AssemblyScene scene = randomAssembly(lattice.toStdString(), random, 3, 4, 0.3, longest);
         if (scene.parts.parts.empty() || scene.parts.parts.size() > 11) // 2^11 states at most
            continue;
         ++tried;
         const AssemblyPlan plan = planOf(scene);
         verifySteps(scene, plan);
         const std::set<std::int64_t> order(plan.order.begin(), plan.order.end());
         QVERIFY2(order == Rules(scene).possible(), "an order exists that places another set of parts");
      }
      QVERIFY(tried > 50);
   }

   void partsOfSeveralLayersKeepTheRules()
   {
      // Upright and L-shaped parts: no promise of placing all that could be, but none is placed wrongly.
      std::mt19937 random(kSeed + 2);
      for (int round = 0; round < 200; ++round) {
         std::vector<std::vector<Index>> runs;
         std::set<Index> used;
         for (int tries = 0; tries < 30; ++tries) {
            Index at{static_cast<std::int32_t>(random() % 4), static_cast<std::int32_t>(random() % 4),
                     static_cast<std::int32_t>(random() % 5)};
            std::vector<Index> run;
            for (auto length = 1 + random() % 4; length > 0 && used.insert(at).second; --length) {
               run.push_back(at);
               const Index steps[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 1}};
               at = at + steps[random() % 4];
            }
            if (!run.empty())
               runs.push_back(run);
         }
         const AssemblyScene scene = assemblyOf(kCube, runs);
         verifySteps(scene, planOf(scene));
      }
   }

   void aPartWaitsForTheOneItWouldCover()
   {
      // Part 5 hangs beside 4, which hangs from its top beside 3. Part 6 lies over 5 and comes earlier in its
      // row.
      const AssemblyScene scene = assemblyOf(kCube, {{{-1, 0, 0}, {-1, 0, 1}, {-1, 0, 2}},
                                                     {{4, 0, 0}, {4, 0, 1}, {4, 0, 2}},
                                                     {{0, 0, 2}},
                                                     {{3, 0, 2}},
                                                     {{2, 0, 1}, {2, 0, 2}},
                                                     {{1, 0, 1}},
                                                     {{1, 0, 2}}});
      const AssemblyPlan plan = planOf(scene);
      QVERIFY(plan.order == std::vector<std::int64_t>({0, 1, 2, 3, 4, 5, 6}));
      verifySteps(scene, plan);
   }

   void theOrderDependsOnContentOnly()
   {
      std::mt19937 random(kSeed + 3);
      for (int round = 0; round < 20; ++round) {
         AssemblyScene scene = randomAssembly(kGik, random, 6, 5, 0.5, 4);
         const std::vector<Index> order = firstCells(scene, planOf(scene));
         std::shuffle(scene.parts.parts.begin(), scene.parts.parts.end(), random);
         QVERIFY(firstCells(scene, planOf(scene)) == order);
      }
   }

   void partsThatShareACellHoldEachOther()
   {
      AssemblyScene scene = cellsOf(kCube, {{0, 0, 0}, {0, 0, 1}});
      scene.parts.types[0].share = 3;
      const std::vector<Part> once = scene.parts.parts;
      for (int more = 0; more < 2; ++more)
         scene.parts.parts.insert(scene.parts.parts.end(), once.begin(), once.end());
      const AssemblyPlan plan = planOf(scene);
      QVERIFY(plan.order == std::vector<std::int64_t>({0, 2, 4, 1, 3, 5}));
   }

   void solidBlocksOfEveryLatticeAreBuiltWhole_data()
   {
      QTest::addColumn<QString>("lattice");
      for (const Offer &offer : catalogue()->offers(DIATOM_LATTICE_1))
         QTest::newRow(offer.provided->id.c_str()) << QString::fromStdString(offer.provided->id);
   }

   void solidBlocksOfEveryLatticeAreBuiltWhole()
   {
      QFETCH(QString, lattice);
      std::vector<Index> cells;
      for (std::int32_t z = 0; z < 6; ++z)
         for (std::int32_t y = 0; y < 6; ++y)
            for (std::int32_t x = 0; x < 6; ++x)
               cells.push_back({x, y, z});
      const auto made = cellsOf(lattice.toStdString(), cells).lattice;
      std::erase_if(cells, [&, all = cells](Index i) { return hangs(*made, all, i); });
      QVERIFY(cells.size() > 200);
      const AssemblyScene scene = cellsOf(lattice.toStdString(), cells);
      const AssemblyPlan plan = planOf(scene);
      QCOMPARE(plan.order.size(), cells.size());
      double last = -1e9;
      for (const std::int64_t part : plan.order) { // a solid block needs no deferral: heights never fall
         const double height = scene.parts.parts[static_cast<std::size_t>(part)].position.z();
         QVERIFY(height > last - 1e-9);
         last = height;
      }
   }

   void outlinesThatOnlyTouchShareNoColumn()
   {
      const AssemblyScene scene = cellsOf(kCube, {});
      const std::vector<Index> cells = {{0, 0, 0}, {0, 0, 5}, {1, 0, 0}, {1, 1, 3}};
      const Columns columns(*scene.lattice, cells);
      QCOMPARE(columns.count(), 3);
      QCOMPARE(columns.of(0), columns.of(1));
      for (int column = 0; column < columns.count(); ++column)
         QCOMPARE(columns.overlapping(column).size(), std::size_t{1});
   }

   void cancellingEndsThePlanning()
   {
      const AssemblyScene scene = cellsOf(kCube, {{0, 0, 0}});
      Job job;
      job.cancel();
      const auto plan = planAssembly(*scene.hierarchy, scene.parts, job);
      QVERIFY(!plan.ok());
      QVERIFY(plan.error().code == ErrorCode::cancelled);
   }

   void cellsWithoutAPartAreReported()
   {
      AssemblyScene scene = cellsOf(kCube, {{0, 0, 0}});
      scene.parts.left = {{4, 5, 6}};
      const AssemblyPlan plan = planOf(scene);
      QCOMPARE(plan.order.size(), std::size_t{1});
      QCOMPARE(plan.problems.size(), std::size_t{1});
      QCOMPARE(plan.problems[0].kind, std::string("uncovered-cells"));
   }

   void aMillionPartsArePlannedAndWritten()
   {
      // Figure of the design: 10^6 placements planned and written in 10 s. Printed, and bounded loosely.
      std::vector<Index> cells;
      for (std::int32_t z = 0; z < 100; ++z)
         for (std::int32_t y = 0; y < 100; ++y)
            for (std::int32_t x = 0; x < 100; ++x)
               cells.push_back({x, y, z});
      AssemblyScene scene = cellsOf(kCube, {});
      Model model = scene.hierarchy->model();
      model.root.cells.fill({{0, 0, 0}, {99, 99, 99}}, {1, 0, 0});
      scene.hierarchy = std::make_shared<Hierarchy>(scene.lattice, model);
      scene.parts.covered = cells;
      for (std::size_t i = 0; i < cells.size(); ++i) {
         Part part;
         part.material = 1;
         part.position = scene.lattice->position(cells[i]);
         part.firstCell = static_cast<std::int64_t>(i);
         part.cells = 1;
         scene.parts.parts.push_back(part);
      }
      double start = processorSeconds();
      const AssemblyPlan plan = planOf(scene);
      const double planning = processorSeconds() - start;
      QCOMPARE(plan.order.size(), cells.size());

      Job job;
      const auto machine = Machine::make(*catalogue(), "org.diatom_cad.machine.gcode", {}, job);
      DIATOM_VERIFY_OK(machine);
      std::size_t bytes = 0;
      start = processorSeconds();
      const auto summary = (*machine)->write(
          *scene.hierarchy, scene.parts, plan, "million",
          [&](std::string_view text) { bytes += text.size(); }, job);
      const double writing = processorSeconds() - start;
      DIATOM_VERIFY_OK(summary);
      QCOMPARE(summary->placements, std::int64_t{1000000});
      qInfo("10^6 placements: planned in %.2f s, written in %.2f s of processor time (%.0f MB)", planning,
            writing, double(bytes) / 1e6);
      QVERIFY(planning + writing < 60);
   }
};

QTEST_APPLESS_MAIN(AssemblyPlanTest)
#include "assembly_plan_test.moc"
