// What supports, drives, loads and starts on cells, boxes and materials become for a solver, and entries that
// contradict each other or leave a body free.
#include "kernel/scene_workbench.h"
#include "scene/problems.h"
#include "scene/scene.h"

#include <QTest>

#include <cmath>
#include <numbers>

using namespace diatom;
using test::Workbench;

namespace {

struct Row
{
   std::int64_t where;
   std::vector<double> values;
   friend bool operator==(const Row &, const Row &) = default;
};

std::unique_ptr<Scene> sceneOf(const Workbench &bench, Analysis analysis = Analysis::dynamics)
{
   auto scene = Scene::build(bench.hierarchy(), bench.setup, bench.job, analysis);
   if (!scene)
      qFatal("%s", scene.error().message.c_str());
   return *std::move(scene);
}

/// Rows of a channel; none without it.
std::vector<Row> rows(const Scene &scene, const std::string &name)
{
   std::vector<Row> found;
   for (std::int64_t k = 0; k < scene.view().channels; ++k) {
      const diatom_channel &one = scene.view().channel[k];
      for (std::int64_t row = 0; name == one.name && row < one.count; ++row)
         found.push_back(
             {one.where[row], {one.values + row * one.stride, one.values + (row + 1) * one.stride}});
   }
   return found;
}

/// A bar of three cells of material "plain" and one of "bar" along x.
Workbench bar()
{
   Workbench bench;
   bench.put("plain", {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
   bench.put("bar", {{3, 0, 0}});
   return bench;
}

void verifyProblem(const Workbench &bench, const char *kind, const std::vector<const char *> &words)
{
   const auto problems = findSetupProblems(bench.hierarchy(), bench.setup);
   QCOMPARE(problems.size(), std::size_t{1});
   QCOMPARE(problems[0].kind, std::string(kind));
   for (const char *word : words)
      QVERIFY2(problems[0].text.find(word) != std::string::npos, problems[0].text.c_str());
   QVERIFY(!Scene::build(bench.hierarchy(), bench.setup, bench.job));
}

/// How the only body can move, as the problem tells it; "" when it is held.
std::string freeOf(const Workbench &bench)
{
   const Hierarchy hierarchy = bench.hierarchy();
   const auto bodies = findBodies(hierarchy, bench.job);
   const auto problems = findUnheldBodies(hierarchy, *bodies, bench.setup, bench.job);
   if (problems.empty())
      return {};
   const std::string &text = problems[0].text;
   const std::size_t begin = text.find(" can ") + 5, end = text.find(" as a whole");
   return problems[0].kind + ": " + text.substr(begin, end - begin);
}

} // namespace

class SceneBoundaryTest : public QObject
{
   Q_OBJECT

private slots:
   void supportsOnOneCellHoldTogether();
   void entriesReachCellsOfCompositesAndBoxesAtTheirEdges();
   void loadsOnMaterialsAndBoxesAddUp();
   void drivesShareEqualCurves();
   void driveOffIsNoChannel();
   void startsTurnAndSpinAsOneBodyAboutAPoint();
   void whatIsHeldOrDrivenStartsAsItIsTold();
   void startsWithoutMotionKeepThePoseOnly();
   void modelAndCouplingAreHandedOver();
   void entriesWithoutCellsAreRefusedByPlace();
   void curvesMustAscend();
   void aFreedomHasOneMaster();
   void valuesThatAreNoNumbersAreRefused();
   void freeMotionsAreNamed();
};

void SceneBoundaryTest::supportsOnOneCellHoldTogether()
{
   Workbench bench = bar();
   bench.setup.supports = {
       {Index{0, 0, 0}, 0x01}, {Box{{0, 0, 0}, {1, 5, 5}}, 0x02}, {OfMaterial{"plain"}, 0x08}};
   QCOMPARE(rows(*sceneOf(bench), "fixed"), (std::vector<Row>{{0, {0x0b}}, {1, {0x0a}}, {2, {0x08}}}));
}

void SceneBoundaryTest::entriesReachCellsOfCompositesAndBoxesAtTheirEdges()
{
   Workbench bench = bar();
   Definition pair;
   pair.id = "pair";
   pair.body.cells.set({0, 0, 0}, {bench.model.material("bar"), 0, 0});
   pair.body.cells.set({1, 0, 0}, {bench.model.material("plain"), 0, 0});
   const auto id = bench.model.setDefinition(pair);
   DIATOM_VERIFY_OK(id);
   bench.model.root.instances.insert({*id, {4, 0, 0}, 0});
   bench.setup.supports = {{OfMaterial{"bar"}, 0x01}};
   QCOMPARE(rows(*sceneOf(bench), "fixed"), (std::vector<Row>{{3, {1}}, {4, {1}}}));
   bench.setup.supports = {{Box{{2, 0, 0}, {5, 0, 0}}, 0x04}};
   QCOMPARE(rows(*sceneOf(bench), "fixed"), (std::vector<Row>{{2, {4}}, {3, {4}}, {4, {4}}, {5, {4}}}));
}

void SceneBoundaryTest::loadsOnMaterialsAndBoxesAddUp()
{
   Workbench bench = bar();
   bench.setup.loads = {{OfMaterial{"plain"}, {1, 0, 0}, {}},
                        {Box{{2, 0, 0}, {3, 0, 0}}, {0, 2, 0}, {0, 0, 3}},
                        {Index{3, 0, 0}, {0, -2, 0}, {0, 0, -3}}};
   // What sums to nothing has no row.
   QCOMPARE(rows(*sceneOf(bench), "force"),
            (std::vector<Row>{{0, {1, 0, 0, 0, 0, 0}}, {1, {1, 0, 0, 0, 0, 0}}, {2, {1, 2, 0, 0, 0, 3}}}));
}

void SceneBoundaryTest::drivesShareEqualCurves()
{
   Workbench bench = bar();
   const Curve up{{0, 0}, {1, 1e-3}}, turn{{0.5, 0.1}};
   bench.setup.drives = {{Index{3, 0, 0}, 2, up},
                         {Box{{0, 0, 0}, {1, 0, 0}}, 5, turn},
                         {Index{0, 0, 0}, 0, up},
                         {Index{3, 0, 0}, 2, up}}; // said twice
   const auto scene = sceneOf(bench);
   QCOMPARE(rows(*scene, "driven"), (std::vector<Row>{{0, {0, 0}}, {0, {5, 1}}, {1, {5, 1}}, {3, {2, 0}}}));
   QCOMPARE(rows(*scene, "curve"), (std::vector<Row>{{0, {0, 0}}, {0, {1, 1e-3}}, {1, {0.5, 0.1}}}));
}

void SceneBoundaryTest::driveOffIsNoChannel()
{
   Workbench bench = bar();
   bench.setup.drives = {{Index{3, 0, 0}, 2, {{0, 1}}}};
   bench.setup.effects["driven"] = false;
   QVERIFY(rows(*sceneOf(bench), "driven").empty());
}

void SceneBoundaryTest::startsTurnAndSpinAsOneBodyAboutAPoint()
{
   Workbench bench = bar();
   const double quarter = std::numbers::pi / 2;
   bench.setup.starts = {{Box{{0, 0, 0}, {3, 0, 0}}, {}, {0, 0, quarter}, {}, {0, 0, 10}, {{1e-3, 0, 0}}},
                         {Index{3, 0, 0}, {}, {}, {1, 0, 0}, {}, {}}};
   const auto scene = sceneOf(bench);
   const auto pose = rows(*scene, "pose"), velocity = rows(*scene, "velocity");
   QCOMPARE(pose.size(), std::size_t{4});
   QCOMPARE(velocity.size(), std::size_t{4});
   for (std::size_t cell = 0; cell < 4; ++cell) {
      const double arm = 1e-3 * (static_cast<double>(cell) - 1); // a quarter turn takes it from x to y
      const std::array<double, 6> where{-arm, arm, 0, 0, 0, quarter},
          fast{-10 * arm + (cell == 3 ? 1 : 0), 0, 0, 0, 0, 10};
      for (std::size_t k = 0; k < 6; ++k) {
         QVERIFY(std::abs(pose[cell].values[k] - where[k]) < 1e-17 + 1e-15 * std::abs(where[k])); // rounding
         QVERIFY(std::abs(velocity[cell].values[k] - fast[k]) < 1e-15);
      }
   }
}

void SceneBoundaryTest::whatIsHeldOrDrivenStartsAsItIsTold()
{
   Workbench bench = bar();
   bench.setup.starts = {{OfMaterial{"plain"}, {1, 2, 3}, {}, {4, 5, 6}, {7, 8, 9}, {}}};
   bench.setup.supports = {{Index{0, 0, 0}, kAllFreedoms}};
   bench.setup.drives = {{Index{1, 0, 0}, 1, {{0, 0}}}};
   const auto scene = sceneOf(bench);
   QCOMPARE(rows(*scene, "pose"), (std::vector<Row>{{1, {1, 0, 3, 0, 0, 0}}, {2, {1, 2, 3, 0, 0, 0}}}));
   QCOMPARE(rows(*scene, "velocity"), (std::vector<Row>{{1, {4, 0, 6, 7, 8, 9}}, {2, {4, 5, 6, 7, 8, 9}}}));
}

void SceneBoundaryTest::startsWithoutMotionKeepThePoseOnly()
{
   Workbench bench = bar();
   bench.setup.starts = {{Index{1, 0, 0}, {1, 0, 0}, {}, {4, 5, 6}, {}, {}}};
   const auto scene = sceneOf(bench, Analysis::statics);
   QCOMPARE(rows(*scene, "pose").size(), std::size_t{1});
   QVERIFY(rows(*scene, "velocity").empty());
   QCOMPARE(std::string(scene->view().analysis), std::string("statics"));
}

void SceneBoundaryTest::modelAndCouplingAreHandedOver()
{
   Workbench bench;
   Material block = test::material("block"), solid = test::material("solid");
   block.cellModel = CellModel::block;
   block.poissonCoupling = true;
   solid.cellModel = CellModel::solid;
   bench.add(block);
   bench.add(solid);
   bench.put("plain", {{0, 0, 0}});
   bench.put("block", {{1, 0, 0}});
   bench.put("solid", {{2, 1, 0}});
   const auto property = [&](const Scene &scene, const std::string &name) {
      const diatom_scene &view = scene.view();
      std::vector<double> values;
      for (std::int32_t k = 0; k < view.properties; ++k)
         for (std::int64_t cell = 0; name == view.property_name[k] && cell < view.cells; ++cell)
            values.push_back(view.property[view.cell_material[cell] * view.properties + k]);
      return values;
   };
   QCOMPARE(property(*sceneOf(bench), "cell_model"), (std::vector<double>{0, 1, 2}));
   QCOMPARE(property(*sceneOf(bench), "poisson_coupling"), (std::vector<double>{0, 1, 0}));
   bench.setup.effects["poisson"] = true; // whatever has a ratio; a solid has it in itself
   QCOMPARE(property(*sceneOf(bench), "poisson_coupling"), (std::vector<double>{1, 1, 0}));
   bench.setup.effects["poisson"] = false;
   QCOMPARE(property(*sceneOf(bench), "poisson_coupling"), (std::vector<double>{0, 0, 0}));
}

void SceneBoundaryTest::entriesWithoutCellsAreRefusedByPlace()
{
   Workbench bench = bar();
   bench.setup.supports = {{Box{{5, 0, 0}, {6, 0, 0}}, 0x3f}};
   verifyProblem(bench, "support-without-cell", {"box (5, 0, 0) to (6, 0, 0)", "remove the support"});
   bench.setup = {};
   bench.setup.drives = {{Index{7, 0, 0}, 0, {{0, 0}}}};
   verifyProblem(bench, "drive-without-cell", {"(7, 0, 0)"});
   bench.setup = {};
   bench.setup.loads = {{OfMaterial{"wire"}, {1, 0, 0}, {}}}; // known, but not in use
   verifyProblem(bench, "load-without-cell", {"material wire"});
   bench.setup = {};
   bench.setup.starts = {{OfMaterial{"zinc"}, {}, {}, {1, 0, 0}, {}, {}}};
   verifyProblem(bench, "start-without-cell", {"material zinc"});
}

void SceneBoundaryTest::curvesMustAscend()
{
   Workbench bench = bar();
   bench.setup.drives = {{Index{1, 0, 0}, 0, {}}};
   verifyProblem(bench, "bad-curve", {"cell (1, 0, 0)", "has no points"});
   bench.setup.drives[0].curve = {{0, 0}, {0, 1}};
   verifyProblem(bench, "bad-curve", {"0 s follows 0 s"});
   bench.setup.drives[0].curve = {{0, std::nan("")}};
   verifyProblem(bench, "bad-curve", {"not a number"});
   bench.setup.drives[0] = {Index{1, 0, 0}, 6, {{0, 0}}};
   verifyProblem(bench, "bad-curve", {"no degree of freedom"});
}

void SceneBoundaryTest::aFreedomHasOneMaster()
{
   Workbench bench = bar();
   bench.setup.supports = {{OfMaterial{"plain"}, 0x02}};
   bench.setup.drives = {{Box{{2, 0, 0}, {3, 0, 0}}, 1, {{0, 0}, {1, 1}}}};
   verifyProblem(bench, "held-and-driven", {"cell (2, 0, 0)", "held and driven in y", "box (2, 0, 0)"});
   bench.setup.supports[0].fixed = 0x01;
   bench.setup.drives.push_back({Index{3, 0, 0}, 1, {{0, 0}, {1, 2}}});
   verifyProblem(bench, "driven-twice", {"cell (3, 0, 0)", "in y along two different curves"});
   bench.setup.drives[1].curve = bench.setup.drives[0].curve;
   QVERIFY(findSetupProblems(bench.hierarchy(), bench.setup).empty());
}

void SceneBoundaryTest::valuesThatAreNoNumbersAreRefused()
{
   Workbench bench = bar();
   bench.setup.loads = {{Index{1, 0, 0}, {1, std::nan(""), 0}, {}}};
   verifyProblem(bench, "not-a-number", {"load on cell (1, 0, 0)"});
   bench.setup = {};
   bench.setup.starts = {{Index{1, 0, 0}, {}, {}, {}, {0, INFINITY, 0}, {}}};
   verifyProblem(bench, "not-a-number", {"start on cell (1, 0, 0)"});
}

void SceneBoundaryTest::freeMotionsAreNamed()
{
   Workbench bench = bar();
   QCOMPARE(freeOf(bench), std::string()); // nothing acts on it
   bench.setup.loads = {{Index{3, 0, 0}, {0, 0, 1}, {}}};
   QCOMPARE(freeOf(bench), std::string("not-held: move and turn freely"));
   bench.setup.supports = {{Index{0, 0, 0}, kAllFreedoms}};
   QCOMPARE(freeOf(bench), std::string());
   bench.setup.supports = {{Index{0, 0, 0}, 0x07}}; // a ball joint
   QCOMPARE(freeOf(bench), std::string("may-turn: turn about x and y and z"));
   bench.setup.supports = {{Index{0, 0, 0}, 0x07}, {Index{3, 0, 0}, 0x07}}; // two of them in line
   QCOMPARE(freeOf(bench), std::string("may-turn: turn about x"));
   bench.setup.supports = {{Index{0, 0, 0}, 0x3e}}; // a slide along x
   QCOMPARE(freeOf(bench), std::string("not-held: move along x"));
   bench.setup.drives = {{Index{3, 0, 0}, 0, {{0, 0}}}}; // which a drive may hold
   QCOMPARE(freeOf(bench), std::string());
   bench.setup.drives.clear();
   bench.setup.supports = {{OfMaterial{"plain"}, 0x04}}; // lying on a line of rollers
   QCOMPARE(freeOf(bench), std::string("not-held: move along x and y and turn about x and z"));
   bench.put("plain", {{0, 1, 0}});
   QCOMPARE(freeOf(bench), std::string("not-held: move along x and y and turn about z"));
   bench.setup.ground.present = true;
   QCOMPARE(freeOf(bench), std::string());
   bench.setup.ground.present = false;
   bench.setup.supports.clear();
   bench.setup.gravity = {0, 0, -9.8};
   QCOMPARE(freeOf(bench), std::string()); // it falls, which findFloatingBodies() tells
}

QTEST_APPLESS_MAIN(SceneBoundaryTest)
#include "scene_boundary_test.moc"
