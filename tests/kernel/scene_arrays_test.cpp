// The flat arrays a solver gets, against expectations written by hand.
#include "kernel/scene_workbench.h"
#include "scene/problems.h"
#include "scene/scene.h"

#include <QTest>

#include <cmath>
#include <set>

using namespace diatom;
using test::Workbench;

namespace {

std::unique_ptr<Scene> sceneOf(const Workbench &bench)
{
   auto scene = Scene::build(bench.hierarchy(), bench.setup, bench.job);
   if (!scene)
      qFatal("%s", scene.error().message.c_str());
   return *std::move(scene);
}

const diatom_channel *channel(const Scene &scene, const std::string &name)
{
   for (std::int64_t k = 0; k < scene.view().channels; ++k)
      if (name == scene.view().channel[k].name)
         return &scene.view().channel[k];
   return nullptr;
}

std::vector<double> values(const diatom_channel *one)
{
   return {one->values, one->values + one->count * one->stride};
}

double propertyOf(const Scene &scene, std::int64_t cell, const std::string &name)
{
   const diatom_scene &view = scene.view();
   for (std::int32_t k = 0; k < view.properties; ++k)
      if (name == view.property_name[k])
         return view.property[view.cell_material[cell] * view.properties + k];
   qFatal("no property %s", name.c_str());
}

struct LinkRow
{
   std::int32_t a, b, axis;
   friend bool operator==(const LinkRow &, const LinkRow &) = default;
};

std::vector<LinkRow> links(const Scene &scene)
{
   std::vector<LinkRow> rows;
   for (std::int64_t k = 0; k < scene.view().links; ++k)
      rows.push_back({scene.view().link_a[k], scene.view().link_b[k], scene.view().link_axis[k]});
   return rows;
}

void verifyRefused(const Workbench &bench, const char *words)
{
   const auto scene = Scene::build(bench.hierarchy(), bench.setup, bench.job);
   QVERIFY(!scene);
   QVERIFY2(scene.error().message.find(words) != std::string::npos, scene.error().message.c_str());
}

} // namespace

class SceneArraysTest : public QObject
{
   Q_OBJECT

private slots:
   void cellsAreNumberedByIndexAndLinkedOnceEach();
   void aBlockHasAllItsBonds();
   void arraysDoNotDependOnThreads();
   void propertiesAreNamedAndAbsentOnesAreNotNumbers();
   void turnedCellsKeepTheirFrame();
   void bricksAreLinkedWithinAndAcrossLayers();
   void channelsArePresentOnlyWithTheirEffect();
   void actuatorsPointAtTheirSources();
   void cellsOfCompositesAreLinkedAcrossTheirBorders();
   void aSceneThatMakesNoSenseIsRefused();
   void looseBodiesAreFoundOnlyWhereTheyFall();
};

void SceneArraysTest::cellsAreNumberedByIndexAndLinkedOnceEach()
{
   Workbench bench;
   bench.put("plain", {{1, 1, 0}, {0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {5, 5, 5}});
   const auto scene = sceneOf(bench);
   QCOMPARE(scene->cells(), 5);
   const std::vector<Index> order{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {5, 5, 5}};
   QCOMPARE(scene->indices(), order);
   for (std::size_t k = 0; k < order.size(); ++k)
      QCOMPARE(scene->cellAt(order[k]), std::int64_t(k));
   QCOMPARE(scene->cellAt({0, 0, 1}), -1);
   QCOMPARE(links(*scene), (std::vector<LinkRow>{{0, 1, 1}, {0, 2, 0}, {1, 3, 0}, {2, 3, 1}}));
   const diatom_scene &view = scene->view();
   QCOMPARE(view.pitch, 1e-3);
   QCOMPARE(view.cell_index[3 * 3 + 1], 1);
   const std::vector<double> position(view.cell_position + 12, view.cell_position + 15);
   for (const double coordinate : position) // of (5, 5, 5) at 1 mm; products of the basis, hence the rounding
      QVERIFY(std::abs(coordinate - 5e-3) < 1e-15);
   for (int k = 0; k < 3; ++k)
      QVERIFY(std::abs(view.cell_extent[k] - 1e-3) < 1e-15);
   QCOMPARE(view.cell_orientation[0], 1.0);
}

void SceneArraysTest::aBlockHasAllItsBonds()
{
   Workbench bench;
   constexpr int n = 40; // more cells than one piece of the parallel search
   bench.block("plain", {{-7, 3, 11}, {n - 8, n + 2, n + 10}});
   const auto scene = sceneOf(bench);
   QCOMPARE(scene->cells(), n * n * n);
   QCOMPARE(scene->view().links, 3 * n * n * (n - 1));
   std::pair<std::int32_t, std::int32_t> last{-1, -1};
   for (const LinkRow &link : links(*scene)) {
      QVERIFY(link.a < link.b);
      QVERIFY((last < std::pair{link.a, link.b}));
      last = {link.a, link.b};
      const Index step = scene->indices()[std::size_t(link.b)] - scene->indices()[std::size_t(link.a)];
      QVERIFY(step == (Index{link.axis == 0, link.axis == 1, link.axis == 2}));
   }
}

void SceneArraysTest::arraysDoNotDependOnThreads()
{
   Workbench bench;
   bench.block("plain", {{0, 0, 0}, {29, 29, 29}});
   bench.job.setThreads(1);
   const auto one = sceneOf(bench);
   bench.job.setThreads(4);
   const auto four = sceneOf(bench);
   QCOMPARE(links(*one), links(*four));
   QCOMPARE(one->indices(), four->indices());
   const auto count = std::size_t(3 * one->cells());
   QVERIFY(
       std::equal(one->view().cell_position, one->view().cell_position + count, four->view().cell_position));
}

void SceneArraysTest::propertiesAreNamedAndAbsentOnesAreNotNumbers()
{
   Workbench bench;
   Material special = test::material("special");
   special.density = 3500;
   special.youngsModulus = 5e5;
   special.poissonRatio = 0.25;
   special.dampingRatio = 0.01;
   special.bonds = BondConstants{{1, 2, 3}, {{{0, 4, 5}, {6, 0, 7}, {8, 9, 0}}}, {10, 11, 12}, {13, 14, 15}};
   bench.add(special);
   bench.put("special", {{0, 0, 0}});
   bench.put("plain", {{1, 0, 0}});
   const auto scene = sceneOf(bench);
   QCOMPARE(propertyOf(*scene, 0, "density"), 3500.0);
   QCOMPARE(propertyOf(*scene, 0, "youngs_modulus"), 5e5);
   QCOMPARE(propertyOf(*scene, 0, "poisson_ratio"), 0.25);
   QCOMPARE(propertyOf(*scene, 0, "damping_ratio"), 0.01);
   double expected = 1;
   for (const char *name :
        {"axial_x", "axial_y", "axial_z", "shear_xy", "shear_xz", "shear_yx", "shear_yz", "shear_zx",
         "shear_zy", "bending_x", "bending_y", "bending_z", "torsion_x", "torsion_y", "torsion_z"})
   {
      QCOMPARE(propertyOf(*scene, 0, name), expected++);
      QVERIFY(std::isnan(propertyOf(*scene, 1, name)));
   }
   QCOMPARE(propertyOf(*scene, 1, "density"), 1000.0);
}

void SceneArraysTest::turnedCellsKeepTheirFrame()
{
   Workbench bench;
   Material hinge = test::material("hinge");
   hinge.bonds = BondConstants{{80, 80, 80}, {}, {8e-4, 8e-4, 2e-5}, {8e-4, 8e-4, 8e-4}};
   bench.add(hinge);
   bench.put("hinge", {{0, 0, 0}}, bench.turn(Vec3::UnitZ(), Vec3::UnitX()));
   const auto scene = sceneOf(bench);
   const double *q = scene->view().cell_orientation;
   const Vec3 z = Quat(q[0], q[1], q[2], q[3]) * Vec3::UnitZ();
   QVERIFY((z - Vec3::UnitX()).norm() < 1e-12); // a rotation of the lattice's group, exact up to rounding
   bench.setup.effects["orientation"] = false;
   QCOMPARE(sceneOf(bench)->view().cell_orientation[0], 1.0);
}

void SceneArraysTest::bricksAreLinkedWithinAndAcrossLayers()
{
   Workbench bench("org.diatom_cad.lattice.gik");
   const Index along = bench.lattice->supercellStep(bench.lattice->site({0, 0, 0}));
   const MaterialIndex plain = bench.model.material("plain");
   // Two bricks of two cells end to end, and one cell of the next layer on top of the second cell.
   bench.model.root.cells.set({0, 0, 0}, {plain, 0, Cell::kJoinsNext});
   bench.model.root.cells.set(along, {plain, 0, Cell::kJoinsPrevious});
   bench.model.root.cells.set(along * 2, {plain, 0, Cell::kJoinsNext});
   bench.model.root.cells.set(along * 3, {plain, 0, Cell::kJoinsPrevious});
   bench.model.root.cells.set(along + Index{0, 0, 1}, {plain, 0, 0});
   const auto scene = sceneOf(bench);
   std::set<std::pair<std::int64_t, std::int64_t>> expected;
   const auto add = [&](Index a, Index b) {
      const auto first = scene->cellAt(a), second = scene->cellAt(b);
      expected.insert({std::min(first, second), std::max(first, second)});
   };
   add({0, 0, 0}, along);
   add(along * 2, along * 3);
   add(along, along + Index{0, 0, 1});
   std::set<std::pair<std::int64_t, std::int64_t>> found;
   for (const LinkRow &link : links(*scene))
      found.insert({link.a, link.b});
   QCOMPARE(found, expected);
   QCOMPARE(scene->view().links, 3);
}

void SceneArraysTest::channelsArePresentOnlyWithTheirEffect()
{
   Workbench bench;
   bench.put("plain", {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
   const auto bare = sceneOf(bench);
   QCOMPARE(bare->view().channels, 0);
   QCOMPARE(bare->view().effects, 1);
   QCOMPARE(std::string(bare->view().effect[0]), std::string("rotation"));

   bench.setup.gravity = {0, 0, -9.8};
   bench.setup.supports = {{Index{2, 0, 0}, 0x3f}, {Index{0, 0, 0}, 0x07}};
   bench.setup.loads = {{Index{1, 0, 0}, {1, 2, 3}, {4, 5, 6}}, {Index{1, 0, 0}, {1, 0, 0}, {}}};
   bench.setup.ground = {true, -1e-3, 500, 0.2, 0.4};
   bench.setup.drag = 7;
   const auto full = sceneOf(bench);
   QCOMPARE(values(channel(*full, "gravity")), (std::vector<double>{0, 0, -9.8}));
   QVERIFY(channel(*full, "gravity")->where == nullptr);
   QCOMPARE(values(channel(*full, "fixed")), (std::vector<double>{7, 63}));
   QCOMPARE(channel(*full, "fixed")->where[0], 0);
   QCOMPARE(channel(*full, "fixed")->where[1], 2);
   QCOMPARE(values(channel(*full, "force")),
            (std::vector<double>{2, 2, 3, 4, 5, 6})); // loads of one cell add up
   QCOMPARE(channel(*full, "force")->where[0], 1);
   QCOMPARE(values(channel(*full, "ground")), (std::vector<double>{-1e-3, 500, 0.2, 0.4}));
   QCOMPARE(values(channel(*full, "drag")), (std::vector<double>{7}));

   for (const char *name : {"gravity", "ground", "drag", "loads"})
      bench.setup.effects[name] = false;
   const auto off = sceneOf(bench);
   QCOMPARE(off->view().channels, 1); // supports are no effect
   bench.setup.effects = {{"friction", false}};
   QCOMPARE(values(channel(*sceneOf(bench), "ground"))[3], 0.0);
}

void SceneArraysTest::actuatorsPointAtTheirSources()
{
   Workbench bench;
   bench.put("wire", {{0, 0, 0}, {2, 0, 0}});
   bench.put("piezo", {{1, 0, 0}});
   bench.source({-1, 0, 0}, 1);
   bench.source({3, 0, 0}, 2);
   bench.setup.sources[1].waveform = Waveform::square;
   bench.setup.sources[1].phase = 0.25;
   const auto scene = sceneOf(bench);
   const auto *actuators = channel(*scene, "actuator");
   const auto *sources = channel(*scene, "source");
   QCOMPARE(actuators->count, 1);
   QCOMPARE(actuators->where[0], scene->cellAt({1, 0, 0}));
   const auto row = values(actuators);
   QCOMPARE(row[0], 0.0);
   QCOMPARE(row[1], 0.0);
   QCOMPARE(row[2], 0.3);
   const auto plus = std::int64_t(row[3]), minus = std::int64_t(row[4]);
   QCOMPARE(sources->where[plus], scene->cellAt({3, 0, 0}));
   QCOMPARE(sources->where[minus], scene->cellAt({-1, 0, 0}));
   const double *signal = sources->values + 6 * plus;
   QCOMPARE(std::vector<double>(signal, signal + 6), (std::vector<double>{1, 10, 0.25, 0.5, 0, 2}));

   // One net on both sides: its source against ground.
   bench.put("wire", {{0, 1, 0}, {0, 2, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}});
   bench.setup.sources.pop_back();
   bench.put("plain", {{3, 0, 0}});
   const auto one = values(channel(*sceneOf(bench), "actuator"));
   QCOMPARE(one[3], 0.0);
   QCOMPARE(one[4], -1.0);

   // A two-terminal source: its - side gets a row of its own, negated.
   Workbench two;
   two.source({0, 0, 0}, 2, "battery");
   two.put("wire", {{-1, 0, 0}, {1, 0, 0}, {-1, 1, 0}, {1, 1, 0}});
   two.put("piezo", {{0, 1, 0}});
   const auto driven = sceneOf(two);
   const auto pair = values(channel(*driven, "source"));
   const auto ends = values(channel(*driven, "actuator"));
   QCOMPARE(pair.size(), std::size_t(12));
   QCOMPARE(pair[std::size_t(6 * ends[3] + 5)], 2.0);
   QCOMPARE(pair[std::size_t(6 * ends[4] + 5)], -2.0);
}

void SceneArraysTest::cellsOfCompositesAreLinkedAcrossTheirBorders()
{
   Workbench bench;
   Definition pair;
   pair.id = "pair";
   pair.body.cells.set({0, 0, 0}, {bench.model.material("plain"), 0, 0});
   pair.body.cells.set({1, 0, 0}, {bench.model.material("plain"), 0, 0});
   const auto id = bench.model.setDefinition(pair);
   DIATOM_VERIFY_OK(id);
   for (const std::int32_t x : {0, 2, 4})
      bench.model.root.instances.insert({*id, {x, 0, 0}, 0});
   bench.put("plain", {{6, 0, 0}});
   const auto scene = sceneOf(bench);
   QCOMPARE(scene->cells(), 7);
   QCOMPARE(links(*scene),
            (std::vector<LinkRow>{{0, 1, 0}, {1, 2, 0}, {2, 3, 0}, {3, 4, 0}, {4, 5, 0}, {5, 6, 0}}));
}

void SceneArraysTest::aSceneThatMakesNoSenseIsRefused()
{
   Workbench bench;
   verifyRefused(bench, "no cells");
   bench.block("plain", {{0, 0, 0}, {9, 9, 9}});
   const auto tooMany = Scene::build(bench.hierarchy(), bench.setup, bench.job, Analysis::dynamics, 999);
   QVERIFY(!tooMany);
   QVERIFY2(tooMany.error().message.find("1000 cells") != std::string::npos, tooMany.error().message.c_str());

   bench.setup.supports = {{Index{-1, 0, 0}, 0x3f}};
   verifyRefused(bench, "(-1, 0, 0)");
   bench.setup.supports.clear();
   bench.setup.sources.push_back({{20, 0, 0}});
   verifyRefused(bench, "(20, 0, 0)");
   bench.setup.sources.clear();
   bench.setup.effects["magic"] = true;
   verifyRefused(bench, "magic");
   bench.setup.effects.clear();

   bench.job.cancel();
   const auto cancelled = Scene::build(bench.hierarchy(), bench.setup, bench.job);
   QVERIFY(!cancelled);
   QVERIFY(cancelled.error().code == ErrorCode::cancelled);
}

void SceneArraysTest::looseBodiesAreFoundOnlyWhereTheyFall()
{
   Workbench bench;
   bench.put("plain", {{0, 0, 0}, {1, 0, 0}, {5, 0, 0}});
   const auto bodies = findBodies(bench.hierarchy(), bench.job);
   DIATOM_VERIFY_OK(bodies);
   QCOMPARE(*bodies, (Bodies{{{0, 0, 0}, {1, 0, 0}}, {{5, 0, 0}}}));
   QVERIFY(findFloatingBodies(bench.hierarchy(), *bodies, bench.setup).empty());
   bench.setup.gravity = {0, 0, -9.8};
   QCOMPARE(findFloatingBodies(bench.hierarchy(), *bodies, bench.setup).size(), std::size_t(2));
   bench.setup.supports = {{Index{1, 0, 0}, 0x3f}};
   const auto loose = findFloatingBodies(bench.hierarchy(), *bodies, bench.setup);
   QCOMPARE(loose.size(), std::size_t(1));
   QCOMPARE(loose[0].cells, (std::vector<Index>{{5, 0, 0}}));
   bench.setup.ground.present = true;
   QVERIFY(findFloatingBodies(bench.hierarchy(), *bodies, bench.setup).empty());
}

QTEST_APPLESS_MAIN(SceneArraysTest)
#include "scene_arrays_test.moc"
