// The hierarchy's answers against full expansion, on random nested composites on every lattice.
#include "cells/hierarchy.h"
#include "support/support.h"

#include <map>
#include <random>

using namespace diatom;

namespace {

struct Logical
{
   Index index;
   Cell cell;
};

/// Every logical cell of a body in the order that decides overlaps, straight from the definition of placing.
std::vector<Logical> expand(const Lattice &lattice, const Model &model, const Body &body)
{
   std::vector<Logical> all;
   body.cells.visit([&](Index i, Cell cell) {
      all.push_back({i, cell});
      return true;
   });
   body.instances.visit([&](const Placement &p) {
      for (Logical logical : expand(lattice, model, model.definition(p.definition)->body)) {
         logical.cell.orientation = static_cast<std::uint8_t>(
             lattice.turnedOrientation(p.origin, logical.index, p.rotation, logical.cell.orientation));
         logical.index = lattice.place(p.origin, p.rotation, logical.index);
         all.push_back(logical);
      }
      return true;
   });
   return all;
}

/// Random nested composites with placements that the lattice allows.
class Maker
{
public:
   Maker(std::shared_ptr<const Lattice> lattice, unsigned seed)
       : m_lattice(std::move(lattice)), m_random(seed)
   {}

   Model make()
   {
      Model model;
      model.lattice = m_lattice->spec();
      for (const char *id : {"light", "heavy", "middle"}) {
         Material material;
         material.id = id;
         material.density = 500.0 + 1000.0 * below(8);
         static_cast<void>(model.setMaterial(material));
      }
      const auto add = [&](const char *id, const std::vector<DefinitionId> &children, int spread) {
         Definition definition;
         definition.id = id;
         definition.body = body(children, spread);
         return *model.setDefinition(definition);
      };
      const DefinitionId a = add("a", {}, 5), b = add("b", {a, a, a}, 9), c = add("c", {b, a, b}, 20);
      model.root = body({c, b, c, a}, 40);
      return model;
   }
   int below(int n) { return static_cast<int>(m_random() % static_cast<unsigned>(n)); }
   double uniform(double low, double high)
   {
      return low + (high - low) * (static_cast<double>(m_random()) / 4294967296.0);
   }
   Index index(int spread) { return {within(spread), within(spread), within(spread)}; }

private:
   int within(int spread) { return below(2 * spread + 1) - spread; }
   Body body(const std::vector<DefinitionId> &children, int spread)
   {
      Body body;
      for (int k = 0; k < 25; ++k) {
         const Index i = index(4);
         const auto turns = m_lattice->shape(m_lattice->site(i)).rotations.size();
         body.cells.set(i, {static_cast<MaterialIndex>(1 + below(3)),
                            static_cast<std::uint8_t>(below(static_cast<int>(turns))), 0});
      }
      if (below(2) == 0) {
         const Index low = index(6);
         body.cells.fill({low, low + Index{2 + below(20), 1, 1 + below(3)}}, {2});
      }
      for (const DefinitionId child : children) {
         Placement p{child, {}, 0};
         do {
            p.origin = index(spread);
            p.rotation = static_cast<std::uint8_t>(below(static_cast<int>(m_lattice->rotations().size())));
         } while (!m_lattice->placementAllowed(p.origin, p.rotation));
         body.instances.insert(p);
      }
      return body;
   }

   std::shared_ptr<const Lattice> m_lattice;
   std::mt19937 m_random;
};

/// Distance at which a ray enters a cell; infinite when it misses.
double rayToCell(const Lattice &lattice, Index i, const Vec3 &origin, const Vec3 &direction)
{
   const int site = lattice.site(i);
   const auto corners = lattice.corners(site);
   double enter = 0, exit = 1e300;
   for (const auto &face : lattice.shape(site).faces) {
      const auto corner = [&](std::size_t k) -> Vec3 {
         return lattice.position(i) + corners[static_cast<std::size_t>(face[k])];
      };
      const Vec3 normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
      const double speed = normal.dot(direction), gap = normal.dot(corner(0) - origin);
      if (std::abs(speed) < 1e-12) { // along the face, but for rounding
         if (gap < 0)
            return 1e300;
      } else if (speed < 0)
         enter = std::max(enter, gap / speed);
      else
         exit = std::min(exit, gap / speed);
   }
   return enter < exit ? enter : 1e300;
}

std::shared_ptr<const Lattice> makeLattice(const char *id)
{
   LatticeSpec spec;
   spec.id = id;
   auto made = Lattice::make(*test::catalogue(), spec, Job());
   return made.ok() ? *made : nullptr;
}

constexpr Box kEverything{{-kIndexLimit, -kIndexLimit, -kIndexLimit},
                          {kIndexLimit, kIndexLimit, kIndexLimit}};

} // namespace

class CellsHierarchyTest : public QObject
{
   Q_OBJECT

   static void lattices()
   {
      QTest::addColumn<QByteArray>("id");
      QTest::addColumn<unsigned>("seed");
      for (const auto &offer : test::catalogue()->offers(DIATOM_LATTICE_1))
         for (unsigned seed = 1; seed <= 4; ++seed)
            QTest::addRow("%s, seed %u", offer.provided->id.c_str(), seed)
                << QByteArray::fromStdString(offer.provided->id) << seed;
   }

   static void compareSums(const Hierarchy &hierarchy, const std::vector<Logical> &all)
   {
      const Lattice &lattice = hierarchy.lattice();
      QCOMPARE(hierarchy.cells(), std::uint64_t{all.size()});
      Box bounds;
      std::vector<std::uint64_t> counts(4);
      double mass = 0;
      Vec3 first = Vec3::Zero();
      for (const auto &[i, cell] : all) {
         bounds.extend(i);
         ++counts[cell.material];
         const double m =
             hierarchy.model().material(cell.material).density * lattice.shape(lattice.site(i)).volume;
         mass += m;
         first += m * lattice.position(i);
      }
      QVERIFY(hierarchy.bounds() == bounds);
      auto got = hierarchy.countByMaterial();
      got.resize(4);
      QVERIFY(got == counts);
      // Sums of a few thousand doubles in another order: 1e-12 relative, of the centre in cell sizes.
      QVERIFY(std::abs(hierarchy.mass().mass - mass) <= 1e-12 * mass);
      QVERIFY((hierarchy.mass().centre - first / mass).norm() <= 1e-9 * lattice.radius());
   }

private slots:
   void latticesAreThere()
   {
      for (const char *id : {"org.diatom_cad.lattice.cube", "org.diatom_cad.lattice.gik"})
         QVERIFY2(makeLattice(id), id);
   }
   void agreesWithFullExpansion_data() { lattices(); }
   void agreesWithFullExpansion()
   {
      QFETCH(QByteArray, id);
      QFETCH(unsigned, seed);
      const auto lattice = makeLattice(id.constData());
      QVERIFY(lattice);
      Maker maker(lattice, seed);
      const Model model = maker.make();
      const Hierarchy hierarchy(lattice, model);
      const auto all = expand(*lattice, model, model.root);
      compareSums(hierarchy, all);
      QCOMPARE(hierarchy.depth(), 4);

      std::map<Index, Cell> first;
      for (const auto &[i, cell] : all)
         first.emplace(i, cell);
      for (const auto &[i, cell] : first) {
         const auto found = hierarchy.find(i);
         QVERIFY(found);
         QVERIFY(found->index == i);
         QVERIFY(found->cell == cell);
      }
      for (int k = 0; k < 2000; ++k) {
         const Index i = maker.index(60);
         QVERIFY(hierarchy.at(i) == (first.count(i) ? first.at(i) : Cell()));
      }
      int seen = 0;
      for (auto it = first.begin(); it != first.end() && seen < 40; std::advance(it, 1), ++seen) {
         std::map<Index, Cell> expected, got;
         for (const Link &link : lattice->links(lattice->site(it->first)))
            if (const auto there = first.find(it->first + link.offset); there != first.end())
               expected.insert(*there);
         for (const auto &[link, found] : hierarchy.neighbours(it->first)) {
            QVERIFY(found.index == it->first + link.offset);
            got[found.index] = found.cell;
         }
         QVERIFY(got == expected);
      }
   }
   void visitsEveryLogicalCellOfABoxOnce_data() { lattices(); }
   void visitsEveryLogicalCellOfABoxOnce()
   {
      QFETCH(QByteArray, id);
      QFETCH(unsigned, seed);
      const auto lattice = makeLattice(id.constData());
      Maker maker(lattice, seed + 100);
      const Model model = maker.make();
      const Hierarchy hierarchy(lattice, model);
      const auto all = expand(*lattice, model, model.root);
      for (int k = 0; k < 20; ++k) {
         Box box;
         box.extend(maker.index(50));
         box.extend(maker.index(50));
         if (k == 0)
            box = kEverything;
         std::multimap<std::pair<Index, std::uint32_t>, int> expected, got;
         for (const auto &[i, cell] : all)
            if (box.contains(i))
               expected.insert({{i, cell.packed()}, 0});
         hierarchy.visit(box, [&](Index i, Cell cell) {
            got.insert({{i, cell.packed()}, 0});
            return true;
         });
         QVERIFY(got == expected);
      }
      int n = 0;
      QVERIFY(!hierarchy.visit(kEverything, [&](Index, Cell) { return ++n < 7; }));
      QCOMPARE(n, 7);
   }
   void findsTheFirstCellThatARayMeets_data() { lattices(); }
   void findsTheFirstCellThatARayMeets()
   {
      QFETCH(QByteArray, id);
      QFETCH(unsigned, seed);
      const auto lattice = makeLattice(id.constData());
      Maker maker(lattice, seed + 200);
      const Model model = maker.make();
      const Hierarchy hierarchy(lattice, model);
      const auto all = expand(*lattice, model, model.root);
      const double size = lattice->radius();
      int hits = 0;
      for (int k = 0; k < 150; ++k) {
         // From around the assembly towards somewhere near one of its cells; sometimes from inside, sometimes
         // along an axis, so that directions with zeros occur.
         const Logical &aim = all[static_cast<std::size_t>(maker.below(static_cast<int>(all.size())))];
         const auto away = [&](double by) {
            return Vec3(maker.uniform(-by, by), maker.uniform(-by, by), maker.uniform(-by, by));
         };
         const Vec3 target = lattice->position(aim.index) + away(2 * size);
         Vec3 origin = target + away(k % 5 == 0 ? 5 * size : 150 * size);
         Vec3 direction = (target - origin).normalized();
         if (k % 7 == 0) {
            direction = Vec3::Unit(k % 3) * (k % 2 == 0 ? 1 : -1);
            origin = target - 40 * size * direction;
         }
         double nearest = 1e300;
         for (const auto &[i, cell] : all)
            nearest = std::min(nearest, rayToCell(*lattice, i, origin, direction));
         const auto hit = hierarchy.hit(origin, direction, 1e6 * size);
         QCOMPARE(hit.has_value(), nearest < 1e299);
         if (!hit)
            continue;
         ++hits;
         // Rounding of positions of some 100 cells' size: 1e-9 of a cell is far above it.
         QVERIFY(std::abs(hit->distance - nearest) <= 1e-9 * size);
         QVERIFY(std::abs(rayToCell(*lattice, hit->found.index, origin, direction) - nearest) <= 1e-9 * size);
         QVERIFY(hierarchy.at(hit->found.index).material != 0);
         const int site = lattice->site(hit->found.index);
         const auto &face = lattice->shape(site).faces[static_cast<std::size_t>(hit->face)];
         const auto corner = [&](std::size_t n) -> Vec3 {
            return lattice->position(hit->found.index) +
                   lattice->corners(site)[static_cast<std::size_t>(face[n])];
         };
         const Vec3 normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
         if (hit->distance > 0) { // not from inside a cell
            QVERIFY(std::abs(normal.dot(hit->point - corner(0))) <= 1e-9 * size);
            QVERIFY(!hierarchy.hit(origin, direction, 0.5 * hit->distance).has_value());
         }
      }
      QVERIFY2(hits > 25, qPrintable(QString::number(hits))); // tetrahedra leave five sixths of space empty
   }
   void takesOverWhatAnEditLeavesUnchanged_data() { lattices(); }
   void takesOverWhatAnEditLeavesUnchanged()
   {
      QFETCH(QByteArray, id);
      QFETCH(unsigned, seed);
      const auto lattice = makeLattice(id.constData());
      Maker maker(lattice, seed + 300);
      Model model = maker.make();
      auto hierarchy = std::make_unique<Hierarchy>(lattice, model);
      for (int step = 0; step < 6; ++step) {
         // Root only; the innermost definition; a material; an instance; nothing.
         if (step == 0)
            model.root.cells.set(maker.index(30), {2});
         if (step == 1) {
            Definition edited = *model.definition(1);
            edited.body.cells.fill({{-9, 0, 0}, {9, 0, 0}}, {3});
            DIATOM_VERIFY_OK(model.setDefinition(edited));
         }
         if (step == 2) {
            Material heavy = model.material(MaterialIndex{1});
            heavy.density *= 3;
            DIATOM_VERIFY_OK(model.setMaterial(heavy));
         }
         if (step == 3)
            model.root.instances.insert({1, {0, 0, 0}, 0});
         if (step == 4)
            model.root.cells.clear();
         hierarchy = std::make_unique<Hierarchy>(lattice, model, hierarchy.get());
         compareSums(*hierarchy, expand(*lattice, model, model.root));
      }
   }
   void keepsSuperCellsTogetherWhenTheyAreTurned()
   {
      const auto lattice = makeLattice("org.diatom_cad.lattice.gik");
      QVERIFY(lattice && lattice->hasSupercells());
      Model model;
      model.lattice = lattice->spec();
      Material material;
      material.id = "m";
      DIATOM_VERIFY_OK(model.setMaterial(material));
      Definition brick;
      brick.id = "brick";
      const Index step = lattice->supercellStep(lattice->site({}));
      for (int k = 0; k < 4; ++k) {
         const std::uint8_t joins = k == 0   ? Cell::kJoinsNext
                                    : k == 3 ? Cell::kJoinsPrevious
                                             : Cell::kJoinsNext | Cell::kJoinsPrevious;
         brick.body.cells.set(step * k, {1, 0, joins});
      }
      const DefinitionId number = *model.setDefinition(brick);
      int tried = 0;
      for (std::size_t r = 0; r < lattice->rotations().size(); ++r)
         for (std::int32_t z = 0; z < 2; ++z) {
            const Placement p{number, {3, 5, z}, static_cast<std::uint8_t>(r)};
            if (!lattice->placementAllowed(p.origin, p.rotation))
               continue;
            ++tried;
            Model placed = model;
            placed.root.instances.insert(p);
            const Hierarchy hierarchy(lattice, placed);
            for (int k = 0; k < 4; ++k) {
               const auto run = hierarchy.supercell(lattice->place(p.origin, p.rotation, step * k));
               QCOMPARE(run.size(), std::size_t{4});
               for (int n = 0; n < 4; ++n)
                  QVERIFY(std::find(run.begin(), run.end(), lattice->place(p.origin, p.rotation, step * n)) !=
                          run.end());
            }
         }
      QVERIFY2(tried >= 4, qPrintable(QString::number(tried)));
   }
   void opensABillionCellsOfNestedComposites()
   {
      const auto lattice = makeLattice("org.diatom_cad.lattice.cube");
      QVERIFY(lattice);
      Model model;
      Material material;
      material.id = "m";
      DIATOM_VERIFY_OK(model.setMaterial(material));
      Definition block;
      block.id = "level0";
      block.body.cells.fill({{0, 0, 0}, {9, 9, 9}}, {1});
      DefinitionId inner = *model.setDefinition(block);
      std::int32_t side = 10;
      for (int level = 1; level <= 2; ++level, side *= 10) {
         Definition next;
         next.id = "level" + std::to_string(level);
         for (int k = 0; k < 1000; ++k)
            next.body.instances.insert({inner, Index{k / 100, k / 10 % 10, k % 10} * side, 0});
         inner = *model.setDefinition(next);
      }
      model.root.instances.insert({inner, {-500, -500, -500}, 0});
      const Hierarchy hierarchy(lattice, model);
      QCOMPARE(hierarchy.cells(), std::uint64_t{1000000000});
      QVERIFY(hierarchy.bounds() == (Box{{-500, -500, -500}, {499, 499, 499}}));
      QCOMPARE(hierarchy.countByMaterial().at(1), std::uint64_t{1000000000});
      QCOMPARE(hierarchy.stored(), std::uint64_t{3001});
      const auto hit = hierarchy.hit(lattice->position({7, 600, 7}), Vec3(0, -1, 0), 1e6);
      QVERIFY(hit && hit->found.index == (Index{7, 499, 7}));
      QCOMPARE(hit->found.path.size(), std::size_t{3});
      // Mass of 10^9 cells of one cubic pitch at the default 1000 kg/m3; pairwise sums round below 1e-12.
      const double expected = 1e9 * 1000 * lattice->shape(0).volume;
      QVERIFY(std::abs(hierarchy.mass().mass - expected) <= 1e-12 * expected);
   }
   void treatsMissingAndCircularDefinitionsAsEmpty()
   {
      const auto lattice = makeLattice("org.diatom_cad.lattice.cube");
      Model model;
      auto circular = std::make_shared<Definition>();
      circular->id = "circular";
      circular->body.cells.set({0, 0, 0}, {1});
      circular->body.instances.insert({1, {5, 0, 0}, 0});
      model.definitions[1] = circular; // past setDefinition, which refuses it
      model.root.instances.insert({1, {0, 0, 0}, 0});
      model.root.instances.insert({42, {0, 0, 0}, 0});
      model.root.instances.insert({1, {0, 9, 0}, 200}); // no such rotation
      const Hierarchy hierarchy(lattice, model);
      QCOMPARE(hierarchy.cells(), 1ULL);
      QVERIFY(hierarchy.bounds() == (Box{{0, 0, 0}, {0, 0, 0}}));
      QVERIFY(!hierarchy.hit({0, 0, 0}, {0, 0, 0}, 1).has_value());
      QVERIFY(!hierarchy.hit({std::nan(""), 0, 0}, {1, 0, 0}, 1).has_value());
      QCOMPARE(hierarchy.mass().mass, 0.0); // material 1 does not exist
   }
};

QTEST_APPLESS_MAIN(CellsHierarchyTest)
#include "cells_hierarchy_test.moc"
