// Cells into parts through the kernel: runs, composites, coverage, and what is refused.
#include "parts/decomposition.h"
#include "parts/part_batches.h"
#include "parts/part_list.h"
#include "support/scenes.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace diatom;

namespace {

std::shared_ptr<const PartMaker> makerFor(const std::string &lattice)
{
   auto maker = PartMaker::make(*test::catalogue(), "", {}, lattice, Job());
   if (!maker)
      qFatal("%s", maker.error().message.c_str());
   return *std::move(maker);
}

/// A run of `length` cells that starts at `first`.
void setRun(CellArray &cells, const Lattice &lattice, Index first, int length, MaterialIndex material)
{
   const Index step = lattice.supercellStep(lattice.site(first));
   for (int k = 0; k < length; ++k) {
      const int joins = (k > 0 ? Cell::kJoinsPrevious : 0) | (k + 1 < length ? Cell::kJoinsNext : 0);
      cells.set(first + step * k, {material, 0, static_cast<std::uint8_t>(joins)});
   }
}

bool equal(const Decomposition &a, const Decomposition &b)
{
   const auto same = [](const Part &p, const Part &q) {
      return p.type == q.type && p.length == q.length && p.material == q.material &&
             p.position == q.position && p.orientation.coeffs() == q.orientation.coeffs() &&
             p.firstCell == q.firstCell && p.cells == q.cells;
   };
   return a.covered == b.covered && a.left == b.left &&
          std::equal(a.parts.begin(), a.parts.end(), b.parts.begin(), b.parts.end(), same);
}

/// Two cells of one material at 7 8 9 and 7 8 10, and a batch that covers them rightly.
struct Offered
{
   GatheredCells cells;
   std::vector<PartType> types{{"part", "Part", 1}, {"third", "Third", 3}};
   std::vector<std::int32_t> type{0, 0}, length{1, 1}, material{1, 1};
   std::vector<double> position{0, 0, 0, 0, 0, 1}, orientation{1, 0, 0, 0, 1, 0, 0, 0};
   std::vector<std::int64_t> start{0, 1, 2}, covered{1, 0};

   Offered()
   {
      cells.index = {{7, 8, 9}, {7, 8, 10}};
      cells.site = {0, 0};
      cells.material = {1, 1};
      cells.supercell = {0, 1};
      cells.place = {0, 0};
      cells.position = {0, 0, 0, 0, 0, 1};
      cells.orientation = {1, 0, 0, 0, 1, 0, 0, 0};
   }
   void repeat(std::int32_t kind, std::int64_t cell, int times)
   {
      for (int i = 0; i < times; ++i) {
         type.push_back(kind);
         length.push_back(1);
         material.push_back(1);
         position.insert(position.end(), {double(i), 0, 0});
         orientation.insert(orientation.end(), {1, 0, 0, 0});
         covered.push_back(cell);
         start.push_back(static_cast<std::int64_t>(covered.size()));
      }
   }
   Result<Decomposition> finish(bool partial = false) const
   {
      PartBatches batches(cells, types);
      const diatom_part_sink sink = batches.sink();
      const diatom_part_batch batch{sizeof batch,       static_cast<std::int64_t>(type.size()),
                                    type.data(),        length.data(),
                                    material.data(),    position.data(),
                                    orientation.data(), start.data(),
                                    covered.data()};
      if (sink.parts(&sink, &batch) != DIATOM_OK)
         return Error{ErrorCode::internal, batches.fault()};
      return batches.finish(partial);
   }
   /// Whether it is refused with all of these words.
   bool refused(const std::vector<std::string> &words) const
   {
      const auto result = finish();
      return !result && std::all_of(words.begin(), words.end(), [&](const std::string &word) {
         return result.error().message.find(word) != std::string::npos;
      });
   }
};

} // namespace

class DecompositionTest : public QObject
{
   Q_OBJECT

private slots:
   void everyCellBecomesOnePart_data();
   void everyCellBecomesOnePart();
   void everyWayCoversEveryCellExactly_data();
   void everyWayCoversEveryCellExactly();
   void crossesAreSharedByTheTwoCellsTheyJoin();
   void stretchedLatticesAreRefused();
   void bricksOfAnotherHeightAreRefused();
   void partsAreCountedWithTheirMass();
   void runsBecomeBricksOfTheirLength();
   void aRunThatLostACellFallsIntoTwo();
   void compositesAndEditOrderMakeNoDifference();
   void partsLieOnTheirCells();
   void theFittingPluginIsPickedByLattice();
   void aPluginForAnotherLatticeIsRefused();
   void anOrientationThatTheShapeLacksIsRefused();
   void anEmptyDesignHasNoParts();
   void aCancelledJobGivesNoParts();
   void rightCoverageIsTakenAndSorted();
   void wrongCoverageIsRefusedWithTheFirstCell();
   void sharesMustAddUpToOne();
   void partialPluginsMayLeaveCells();
   void badPosesAreRefusedWithTheirCell();
};

void DecompositionTest::everyCellBecomesOnePart_data()
{
   QTest::addColumn<QString>("lattice");
   QTest::newRow("cube") << "org.diatom_cad.lattice.cube";
   QTest::newRow("octahedron") << "org.diatom_cad.lattice.octahedron_edge";
   QTest::newRow("gik, no runs") << "org.diatom_cad.lattice.gik";
}

void DecompositionTest::everyCellBecomesOnePart()
{
   QFETCH(QString, lattice);
   test::Scene scene(lattice.toStdString());
   auto cells = test::blob(*scene.lattice, 300, 11);
   for (const Index i : cells)
      scene.model.root.cells.set(i, {1, 0, 0});
   const auto parts = makerFor(lattice.toStdString())->decompose(scene.hierarchy(), Job());
   DIATOM_VERIFY_OK(parts);
   QCOMPARE(parts->parts.size(), cells.size());
   std::sort(cells.begin(), cells.end());
   QVERIFY(parts->covered == cells);
   QVERIFY(parts->left.empty());
}

void DecompositionTest::everyWayCoversEveryCellExactly_data()
{
   QTest::addColumn<QString>("id");
   QTest::addColumn<QString>("lattice");
   QTest::addColumn<double>("height");
   for (const Offer &offer : test::catalogue()->offers(DIATOM_PARTS_1)) {
      const auto maker = PartMaker::make(*test::catalogue(), offer.provided->id, {}, "", Job());
      if (!maker)
         qFatal("%s", maker.error().message.c_str());
      const QString id = QString::fromStdString(offer.provided->id);
      const double height = id.contains("lego") ? 1.17 : id.contains("dna") ? 1.08 : 1.28;
      for (const std::string &lattice : (*maker)->lattices())
         QTest::addRow("%s on %s", offer.provided->id.c_str(), lattice.c_str())
             << id << QString::fromStdString(lattice) << height;
   }
}

// The host refuses a decomposition that leaves a cell, covers one twice or in part: here every plugin has
// random cells in three materials, and a composite placed many times, to cover.
void DecompositionTest::everyWayCoversEveryCellExactly()
{
   QFETCH(QString, id);
   QFETCH(QString, lattice);
   QFETCH(double, height);
   test::Scene scene(lattice.toStdString());
   const bool runs = scene.lattice->hasSupercells();
   if (runs) {
      scene.model.lattice.values["height"] = height;
      scene.lattice = *Lattice::make(*test::catalogue(), scene.model.lattice, Job());
   }
   Definition block{"block", "block", {}, {}};
   std::mt19937 random(5);
   std::size_t wanted = 0;
   const auto put = [&](CellArray &cells, Index at) {
      const auto material = static_cast<MaterialIndex>(1 + random() % 3);
      const Index step = runs ? scene.lattice->supercellStep(scene.lattice->site(at)) : Index{};
      const int length = runs ? 1 + static_cast<int>(random() % 2) : 1;
      for (int k = 0; k < length; ++k)
         if (!cells.at(at + step * k).empty())
            return;
      if (runs)
         setRun(cells, *scene.lattice, at, length, material);
      else
         cells.set(at, {material,
                        static_cast<std::uint8_t>(random() % scene.lattice->shape(0).rotations.size()), 0});
      wanted += static_cast<std::size_t>(length);
   };
   for (const Index i : test::blob(*scene.lattice, 200, 3))
      put(scene.model.root.cells, i);
   const std::size_t single = wanted;
   for (const Index i : test::blob(*scene.lattice, 30, 4))
      put(block.body.cells, i);
   const std::size_t each = wanted - single;
   const auto definition = scene.model.setDefinition(block);
   DIATOM_VERIFY_OK(definition);
   constexpr int kCopies = 5; // far from the blob and from each other, on the same parity
   for (int k = 1; k <= kCopies; ++k)
      scene.model.root.instances.insert({*definition, Index{1200 * k, 0, 1200 * k}, 0});
   const auto maker = PartMaker::make(*test::catalogue(), id.toStdString(), {}, lattice.toStdString(), Job());
   DIATOM_VERIFY_OK(maker);
   const auto parts = (*maker)->decompose(scene.hierarchy(), Job());
   DIATOM_VERIFY_OK(parts);
   QVERIFY(parts->left.empty());
   // And back: the cells that the parts tell are exactly those of the design.
   std::set<Index> covered(parts->covered.begin(), parts->covered.end());
   QCOMPARE(covered.size(), single + kCopies * each);
   for (const Index i : covered)
      QVERIFY(!scene.hierarchy().at(i).empty());
   double shares = 0;
   for (const Part &part : parts->parts)
      shares += static_cast<double>(part.cells) / parts->types[static_cast<std::size_t>(part.type)].share;
   QVERIFY(std::abs(shares - static_cast<double>(covered.size())) < 1e-6); // sums of a few thousand shares
}

void DecompositionTest::crossesAreSharedByTheTwoCellsTheyJoin()
{
   const std::string id = "org.diatom_cad.lattice.octahedron_vertex";
   test::Scene scene(id);
   constexpr int n = 4;
   scene.model.root.cells.fill({{0, 0, 0}, {n - 1, n - 1, n - 1}}, {1, 0, 0});
   const auto maker =
       PartMaker::make(*test::catalogue(), "org.diatom_cad.parts.octahedron_crosses", {}, id, Job());
   DIATOM_VERIFY_OK(maker);
   const auto count = [&](int type) {
      const auto parts = (*maker)->decompose(scene.hierarchy(), Job());
      return parts ? std::count_if(parts->parts.begin(), parts->parts.end(),
                                   [&](const Part &part) { return part.type == type; })
                   : -1;
   };
   // One per inner corner, half a one per corner of the outside: three whole ones per cell in all.
   QCOMPARE(count(0), 3 * n * n * (n - 1));
   QCOMPARE(count(1), 6 * n * n);
   // Cells of another material share no part with their neighbours.
   scene.model.root.cells.set({1, 1, 1}, {2, 0, 0});
   QCOMPARE(count(0), 3 * n * n * (n - 1) - 6);
   QCOMPARE(count(1), 6 * n * n + 12);
}

void DecompositionTest::stretchedLatticesAreRefused()
{
   test::Scene scene("org.diatom_cad.lattice.cube");
   scene.model.lattice.aspect = {1, 1, 2};
   scene.lattice = *Lattice::make(*test::catalogue(), scene.model.lattice, Job());
   scene.model.root.cells.set({0, 0, 0}, {1, 0, 0});
   const auto parts = makerFor(scene.model.lattice.id)->decompose(scene.hierarchy(), Job());
   QVERIFY(!parts);
   QVERIFY(parts.error().message.find("aspect") != std::string::npos);
}

void DecompositionTest::bricksOfAnotherHeightAreRefused()
{
   test::Scene scene("org.diatom_cad.lattice.gik"); // 1.28
   scene.model.root.cells.set({0, 0, 1}, {1, 0, 0});
   for (const char *name : {"gik_lego", "gik_dna_blocks", "gik_dna_strands"}) {
      const auto maker = PartMaker::make(*test::catalogue(), "org.diatom_cad.parts." + std::string(name), {},
                                         scene.model.lattice.id, Job());
      DIATOM_VERIFY_OK(maker);
      const auto parts = (*maker)->decompose(scene.hierarchy(), Job());
      QVERIFY(!parts);
      QVERIFY2(parts.error().message.find("height") != std::string::npos, parts.error().message.c_str());
   }
}

void DecompositionTest::partsAreCountedWithTheirMass()
{
   // Two plates of 4 cells and one of 2, and one of 4 in another material, at DMDesign's pitch.
   test::Scene scene("org.diatom_cad.lattice.gik", 1.27e-3);
   Material heavy = scene.model.material(2);
   heavy.density = 8500;
   DIATOM_VERIFY_OK(scene.model.setMaterial(heavy));
   setRun(scene.model.root.cells, *scene.lattice, {0, 0, 0}, 4, 1);
   setRun(scene.model.root.cells, *scene.lattice, {1, 0, 0}, 4, 1);
   setRun(scene.model.root.cells, *scene.lattice, {2, 0, 0}, 2, 1);
   setRun(scene.model.root.cells, *scene.lattice, {0, 0, 1}, 4, 2);
   const auto maker = makerFor(scene.model.lattice.id);
   const auto hierarchy = scene.hierarchy();
   const auto parts = maker->decompose(hierarchy, Job());
   DIATOM_VERIFY_OK(parts);
   const auto rows = countParts(*maker, *parts, hierarchy, Job());
   DIATOM_VERIFY_OK(rows);
   QCOMPARE(rows->size(), std::size_t(3));
   // dmdesign.md section 2: (1.27 L - 0.127) x 3.175 x 0.254 mm less two slots of 0.254 x 0.7744 per cell.
   const auto volume = [](int length) {
      return ((1.27 * length - 0.127) * 3.175 - 2 * length * 0.254 * 0.7744) * 0.254 * 1e-9;
   };
   const auto holds = [&](const PartCount &row, int length, MaterialIndex material, std::int64_t count,
                          double mass) {
      return row.type == 0 && row.length == length && row.material == material && row.count == count &&
             std::abs(row.volume / volume(length) - 1) < 1e-12 &&
             std::abs(row.mass / mass - 1) < 1e-12; // rounding
   };
   QVERIFY(holds((*rows)[0], 2, 1, 1, 1000 * volume(2)));
   QVERIFY(holds((*rows)[1], 4, 1, 2, 1000 * volume(4)));
   QVERIFY(holds((*rows)[2], 4, 2, 1, 8500 * volume(4)));
}

void DecompositionTest::runsBecomeBricksOfTheirLength()
{
   test::Scene scene("org.diatom_cad.lattice.gik", 1.27e-3);
   std::map<int, int> wanted;
   for (int z = -3; z <= 3; ++z)
      for (int row = 0; row < 9; ++row) {
         const Index first = floorMod(z, 2) == 0 ? Index{2 * row, -4, z} : Index{-4, 2 * row, z};
         setRun(scene.model.root.cells, *scene.lattice, first, row + 1, 1);
         ++wanted[row + 1];
      }
   const auto parts = makerFor(scene.model.lattice.id)->decompose(scene.hierarchy(), Job());
   DIATOM_VERIFY_OK(parts);
   std::map<int, int> got;
   std::size_t covered = 0;
   for (const Part &part : parts->parts) {
      ++got[part.length];
      QCOMPARE(part.cells, std::int64_t(part.length));
      covered += static_cast<std::size_t>(part.cells);
      const Index first = parts->covered[static_cast<std::size_t>(part.firstCell)];
      const Index last = parts->covered[static_cast<std::size_t>(part.firstCell + part.cells - 1)];
      // The plate's +x, laid along the run, leads from its first cell to its last.
      const Vec3 run = scene.lattice->position(last) - scene.lattice->position(first);
      const Vec3 along = part.orientation * Vec3((part.length - 1) * 1.27e-3, 0, 0);
      QVERIFY((run - along).norm() < 1e-12);
      QVERIFY((part.position - scene.lattice->position(first)).norm() < 1e-15);
   }
   QVERIFY(got == wanted);
   QCOMPARE(covered, std::size_t(7 * 45));
}

void DecompositionTest::aRunThatLostACellFallsIntoTwo()
{
   test::Scene scene("org.diatom_cad.lattice.gik");
   setRun(scene.model.root.cells, *scene.lattice, {0, 0, 0}, 7, 1);
   scene.model.root.cells.set({0, 4, 0}, {});
   const auto parts = makerFor(scene.model.lattice.id)->decompose(scene.hierarchy(), Job());
   DIATOM_VERIFY_OK(parts);
   QCOMPARE(parts->parts.size(), std::size_t(2));
   QCOMPARE(parts->parts[0].length, 4);
   QCOMPARE(parts->parts[1].length, 2);
}

void DecompositionTest::compositesAndEditOrderMakeNoDifference()
{
   const std::string id = "org.diatom_cad.lattice.gik";
   test::Scene nested(id), forward(id), backward(id);
   Definition block{"block", "block", {}, {}};
   setRun(block.body.cells, *nested.lattice, {0, 0, 0}, 3, 1);
   setRun(block.body.cells, *nested.lattice, {0, 0, 1}, 2, 2);
   const auto definition = nested.model.setDefinition(block);
   DIATOM_VERIFY_OK(definition);
   for (int k = 0; k < 20; ++k) {
      nested.model.root.instances.insert({*definition, Index{3 * k, -5 * k, 2 * k - 8}, 0});
      for (auto *scene : {&forward, &backward}) {
         const int n = scene == &forward ? k : 19 - k;
         const Index at{3 * n, -5 * n, 2 * n - 8};
         setRun(scene->model.root.cells, *scene->lattice, at, 3, 1);
         setRun(scene->model.root.cells, *scene->lattice, at + Index{0, 0, 1}, 2, 2);
      }
   }
   const auto maker = makerFor(id);
   const auto a = maker->decompose(nested.hierarchy(), Job());
   const auto b = maker->decompose(forward.hierarchy(), Job());
   const auto c = maker->decompose(backward.hierarchy(), Job());
   DIATOM_VERIFY_OK(a);
   DIATOM_VERIFY_OK(b);
   DIATOM_VERIFY_OK(c);
   QCOMPARE(a->parts.size(), std::size_t(40));
   QVERIFY(equal(*a, *b));
   QVERIFY(equal(*b, *c));
}

void DecompositionTest::partsLieOnTheirCells()
{
   test::Scene scene("org.diatom_cad.lattice.cube");
   const auto &rotations = scene.lattice->shape(0).rotations;
   for (std::size_t r = 0; r < rotations.size(); ++r)
      scene.model.root.cells.set({static_cast<int>(r), 0, 0}, {1, static_cast<std::uint8_t>(r), 0});
   const auto parts = makerFor(scene.model.lattice.id)->decompose(scene.hierarchy(), Job());
   DIATOM_VERIFY_OK(parts);
   QCOMPARE(parts->parts.size(), rotations.size());
   for (std::size_t r = 0; r < rotations.size(); ++r) {
      QCOMPARE(parts->parts[r].position.x(), static_cast<double>(r) * 1e-3);
      QVERIFY(parts->parts[r].orientation.angularDistance(rotations[r]) < 1e-7); // acos near 1
   }
}

void DecompositionTest::theFittingPluginIsPickedByLattice()
{
   QCOMPARE(makerFor("org.diatom_cad.lattice.cube")->id(), std::string("org.diatom_cad.parts.cube"));
   QCOMPARE(makerFor("org.diatom_cad.lattice.gik")->id(), std::string("org.diatom_cad.parts.gik"));
   QCOMPARE(makerFor("org.diatom_cad.lattice.octahedron_edge")->id(),
            std::string("org.diatom_cad.parts.snap_voxel"));
   const auto none = PartMaker::make(*test::catalogue(), "", {}, "org.diatom_cad.lattice.kelvin", Job());
   QVERIFY(!none);
   QCOMPARE(none.error().code, ErrorCode::unsupported);
   QVERIFY(none.error().message.find("kelvin") != std::string::npos);
}

void DecompositionTest::aPluginForAnotherLatticeIsRefused()
{
   const auto wrong = PartMaker::make(*test::catalogue(), "org.diatom_cad.parts.gik", {},
                                      "org.diatom_cad.lattice.cube", Job());
   QVERIFY(!wrong);
   QCOMPARE(wrong.error().code, ErrorCode::unsupported);
   QVERIFY(!PartMaker::make(*test::catalogue(), "org.diatom_cad.parts.none", {}, "", Job()));
}

void DecompositionTest::anOrientationThatTheShapeLacksIsRefused()
{
   test::Scene scene("org.diatom_cad.lattice.cube");
   scene.model.root.cells.set({3, 2, 1}, {1, 200, 0});
   const auto parts = makerFor(scene.model.lattice.id)->decompose(scene.hierarchy(), Job());
   QVERIFY(!parts);
   QVERIFY(parts.error().message.find("3 2 1") != std::string::npos);
}

void DecompositionTest::anEmptyDesignHasNoParts()
{
   const test::Scene scene("org.diatom_cad.lattice.cube");
   const auto parts = makerFor(scene.model.lattice.id)->decompose(scene.hierarchy(), Job());
   DIATOM_VERIFY_OK(parts);
   QVERIFY(parts->parts.empty());
}

void DecompositionTest::aCancelledJobGivesNoParts()
{
   test::Scene scene("org.diatom_cad.lattice.cube");
   scene.model.root.cells.fill({{0, 0, 0}, {40, 40, 40}}, {1, 0, 0});
   Job job;
   job.cancel();
   const auto parts = makerFor(scene.model.lattice.id)->decompose(scene.hierarchy(), job);
   QVERIFY(!parts);
   QCOMPARE(parts.error().code, ErrorCode::cancelled);
}

void DecompositionTest::rightCoverageIsTakenAndSorted()
{
   const auto parts = Offered().finish();
   DIATOM_VERIFY_OK(parts);
   QCOMPARE(parts->parts.size(), std::size_t(2));
   QVERIFY(parts->covered == std::vector<Index>({{7, 8, 9}, {7, 8, 10}}));
   QCOMPARE(parts->parts[0].position.z(), 1.0); // was offered second
}

void DecompositionTest::wrongCoverageIsRefusedWithTheFirstCell()
{
   Offered twice;
   twice.repeat(0, 1, 1);
   QVERIFY(twice.refused({"7 8 10", "more than once"}));
   Offered missing;
   missing.covered = {1, 1};
   QVERIFY(missing.refused({"7 8 9", "no part"}));
   Offered outside;
   outside.covered = {1, 2};
   QVERIFY(outside.refused({"does not exist"}));
   Offered nothing;
   nothing.start = {0, 2, 2};
   QVERIFY(nothing.refused({"covers no cell"}));
}

void DecompositionTest::sharesMustAddUpToOne()
{
   for (int times = 1; times <= 4; ++times) {
      Offered thirds;
      thirds.type = {0};
      thirds.length = {1};
      thirds.material = {1};
      thirds.start = {0, 1};
      thirds.covered = {0};
      thirds.position = {0, 0, 0};
      thirds.orientation = {1, 0, 0, 0};
      thirds.repeat(1, 1, times);
      QCOMPARE(thirds.finish().ok(), times == 3);
      if (times != 3)
         QVERIFY(thirds.refused({"7 8 10", times < 3 ? "in part only" : "more than once"}));
   }
}

void DecompositionTest::partialPluginsMayLeaveCells()
{
   Offered some;
   some.covered = {1, 1};
   some.types[0].share = 2;
   const auto parts = some.finish(true);
   DIATOM_VERIFY_OK(parts);
   QVERIFY(parts->left == std::vector<Index>({{7, 8, 9}}));
   QVERIFY(!some.finish(false));
}

void DecompositionTest::badPosesAreRefusedWithTheirCell()
{
   Offered far;
   far.position[3] = std::numeric_limits<double>::infinity();
   QVERIFY(far.refused({"7 8 9", "not finite"}));
   Offered unknown;
   unknown.orientation[4] = std::nan("");
   QVERIFY(unknown.refused({"7 8 9", "unit quaternion"}));
   Offered longer;
   longer.orientation[0] = 1.001;
   QVERIFY(longer.refused({"7 8 10", "unit quaternion"}));
   Offered kind;
   kind.type[1] = 2;
   QVERIFY(kind.refused({"7 8 9", "catalogue"}));
   Offered length;
   length.length[1] = 0;
   QVERIFY(length.refused({"7 8 9", "0 cells long"}));
   Offered painted;
   painted.material[1] = 2;
   QVERIFY(painted.refused({"7 8 9", "material 2"}));
}

QTEST_APPLESS_MAIN(DecompositionTest)
#include "parts_decomposition_test.moc"
