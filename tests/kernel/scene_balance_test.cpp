// Statics and modes as the kernel asks for them, with a solver that stands in: every way it can end, sums of
// reactions, meaning of eigenvalues. What the real solver computes is tested with it.
#include "kernel/scene_workbench.h"
#include "scene/balance.h"
#include "scene/modes.h"

#include <QTest>

#include <cmath>

using namespace diatom;
using test::Workbench;

namespace {

std::shared_ptr<const Catalogue> standIns()
{
   static const auto found = Catalogue::find({test::binaryDir() / "tests" / "plugins" / "stand_ins"});
   return found;
}

/// Four cells along x, the first two held, the last two loaded; cells lie at 0, 1, 2 and 3 mm.
Workbench row()
{
   Workbench bench;
   bench.put("plain", {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}});
   bench.setup.solver = "test.balance";
   bench.setup.supports = {{Box{{0, 0, 0}, {1, 0, 0}}, kAllFreedoms}, {Index{1, 0, 0}, 0x07}};
   bench.setup.loads = {{Index{2, 0, 0}, {2, 0, 0}, {}}, {Index{3, 0, 0}, {0, 0, -4}, {0.5, 0, 0}}};
   return bench;
}

std::unique_ptr<Scene> sceneOf(const Workbench &bench, Analysis analysis)
{
   auto scene = Scene::build(bench.hierarchy(), bench.setup, bench.job, analysis);
   if (!scene)
      qFatal("%s", scene.error().message.c_str());
   return *std::move(scene);
}

Result<Balance> balanceOf(const Workbench &bench, const Values &values = {},
                          const BalanceRequest &request = {})
{
   return solveStatics(standIns(), sceneOf(bench, Analysis::statics), bench.setup, values, request,
                       bench.job);
}

void verifyNear(const Vec3 &found, const Vec3 &expected)
{
   // Sums of a few numbers of about one: rounding only.
   QVERIFY2((found - expected).norm() < 1e-15,
            qPrintable(QString("%1 %2 %3").arg(found.x()).arg(found.y()).arg(found.z())));
}

} // namespace

class SceneBalanceTest : public QObject
{
   Q_OBJECT

private slots:
   void initTestCase();
   void aBalanceTellsResidualIterationsAndTime();
   void balancesFollowOneAnother();
   void reactionsAreSummedForEachEntryAndOnceInAll();
   void loadsAndWeightAreSummedWhereCellsAre();
   void whatIsNotFoundIsToldWithPlaceAndRemedy();
   void aSilentSolverIsNotWaitedFor();
   void aCancelledSearchStops();
   void theSceneMustBeOfTheAnalysis();
   void aSolverWithoutTheAnalysisIsRefusedByName();
   void modesAreSortedIntoKinds();
   void shapesAreReadModeByMode();
};

void SceneBalanceTest::initTestCase()
{
   QVERIFY2(standIns()->offer(DIATOM_SOLVER_1, "test.balance"), "the stand-in was not built");
}

void SceneBalanceTest::aBalanceTellsResidualIterationsAndTime()
{
   Workbench bench = row();
   const auto balance = balanceOf(bench, {{"load_steps", 5.0}});
   DIATOM_VERIFY_OK(balance);
   QCOMPARE(balance->residual, 1e-10);
   QCOMPARE(balance->iterations, std::int64_t{5});
   QCOMPARE(balance->run->time(), 0.0); // no curve has an end
   bench.setup.drives = {{Index{3, 0, 0}, 1, {{0, 0}, {0.7, 1e-3}}},
                         {Index{3, 0, 0}, 2, {{0, 0}, {0.2, 1e-3}}}};
   const auto driven = balanceOf(bench);
   DIATOM_VERIFY_OK(driven);
   QCOMPARE(driven->run->time(), 0.7);
   const auto asked = balanceOf(bench, {}, {0.3, 1e-8});
   DIATOM_VERIFY_OK(asked);
   QCOMPARE(asked->run->time(), 0.3);
   QVERIFY(std::abs(*asked->run->probe(0, "x", bench.job) - 0.3e-3) < 1e-18);
}

void SceneBalanceTest::balancesFollowOneAnother()
{
   const Workbench bench = row();
   auto balance = balanceOf(bench);
   DIATOM_VERIFY_OK(balance);
   DIATOM_VERIFY_OK(rebalance(*balance, 2, 1e-8, bench.job));
   QCOMPARE(balance->run->time(), 2.0);
   QCOMPARE(balance->iterations, std::int64_t{2});
}

void SceneBalanceTest::reactionsAreSummedForEachEntryAndOnceInAll()
{
   Workbench bench = row();
   bench.setup.drives = {{Index{0, 0, 0}, 0, {{0, 0}}}};
   bench.setup.supports[0].fixed = 0x3e; // x of the first cell is driven instead
   const auto balance = balanceOf(bench);
   DIATOM_VERIFY_OK(balance);
   const auto reactions = reactionsOf(*balance->run, bench.setup, bench.job);
   DIATOM_VERIFY_OK(reactions);
   QCOMPARE(reactions->supports.size(), std::size_t{2});
   verifyNear(reactions->total.force, {-2, 0, 4});
   verifyNear(reactions->supports[0].force, {-2, 0, 4}); // both cells
   verifyNear(reactions->supports[1].force, {-1, 0, 2}); // the second alone
   verifyNear(reactions->drives[0].force, {-1, 0, 2});
   verifyNear(reactions->driven.force, {-1, 0, 2});
   // About the origin: force (0, 0, 2) at x = 1 mm turns by -2 mN m about y.
   verifyNear(reactions->supports[1].moment, {0, -2e-3, 0});
   verifyNear(reactions->total.moment, {0, -2e-3, 0});
}

void SceneBalanceTest::loadsAndWeightAreSummedWhereCellsAre()
{
   Workbench bench = row();
   bench.setup.gravity = {0, -10, 0};
   const auto balance = balanceOf(bench, {}, {1.0, 1e-8}); // each cell moves 1 mm along x
   DIATOM_VERIFY_OK(balance);
   const auto loads = loadsOn(*balance->run, bench.job);
   DIATOM_VERIFY_OK(loads);
   const double weight = 1000 * 1e-9 * 10; // N, of a cell of 1 mm and 1000 kg/m3
   verifyNear(loads->force, {2, -4 * weight, -4});
   // Load (0, 0, -4) at x = 4 mm; weights at 1, 2, 3 and 4 mm.
   verifyNear(loads->moment, {0.5, 4e-3 * 4, -10e-3 * weight});
}

void SceneBalanceTest::whatIsNotFoundIsToldWithPlaceAndRemedy()
{
   const auto balance = balanceOf(row(), {{"end", std::string("diverges")}});
   QVERIFY(!balance);
   QVERIFY(balance.error().code == ErrorCode::unstable);
   for (const char *word : {"static balance", "1 iterations", "0.5", "at cell (1, 0, 0)", "load_steps"})
      QVERIFY2(balance.error().message.find(word) != std::string::npos, balance.error().message.c_str());
}

void SceneBalanceTest::aSilentSolverIsNotWaitedFor()
{
   const auto balance = balanceOf(row(), {{"end", std::string("stalls")}});
   QVERIFY(!balance);
   QVERIFY(balance.error().code == ErrorCode::internal);
   QVERIFY2(balance.error().message.find("test.balance stopped") != std::string::npos,
            balance.error().message.c_str());
}

void SceneBalanceTest::aCancelledSearchStops()
{
   const Workbench bench = row();
   int told = 0;
   Job *self = nullptr;
   Job job([&](double, std::string_view) {
      if (++told == 3)
         self->cancel();
   });
   self = &job;
   const auto balance = solveStatics(standIns(), sceneOf(bench, Analysis::statics), bench.setup,
                                     {{"end", std::string("goes_on")}}, {}, job);
   QVERIFY(!balance);
   QVERIFY(balance.error().code == ErrorCode::cancelled);
   QCOMPARE(told, 3);
}

void SceneBalanceTest::theSceneMustBeOfTheAnalysis()
{
   const Workbench bench = row();
   QVERIFY(!solveStatics(standIns(), sceneOf(bench, Analysis::modes), bench.setup, {}, {}, bench.job));
   QVERIFY(!findModes(standIns(), sceneOf(bench, Analysis::statics), bench.setup, {}, {}, bench.job));
}

void SceneBalanceTest::aSolverWithoutTheAnalysisIsRefusedByName()
{
   const Workbench bench = row();
   const auto run =
       SolverRun::create(standIns(), sceneOf(bench, Analysis::dynamics), bench.setup, {}, bench.job);
   QVERIFY(!run);
   QVERIFY(run.error().code == ErrorCode::unsupported);
   QCOMPARE(run.error().message,
            std::string("test.balance cannot simulate motion in time; choose another solver"));
}

void SceneBalanceTest::modesAreSortedIntoKinds()
{
   const Workbench bench = row();
   const auto found = findModes(standIns(), sceneOf(bench, Analysis::modes), bench.setup, {}, {}, bench.job);
   DIATOM_VERIFY_OK(found);
   // The last place of the largest eigenvalue, 4 / (1 ms)2, is 8.9e-10 rad2/s2.
   using Kind = Mode::Kind;
   const std::array<Kind, 4> kinds{Kind::unstable, Kind::neutral, Kind::neutral, Kind::vibration};
   QCOMPARE(found->modes.size(), kinds.size());
   for (std::size_t k = 0; k < kinds.size(); ++k)
      QVERIFY2(found->modes[k].kind == kinds[k], qPrintable(QString::number(k)));
   QVERIFY(std::abs(found->modes[3].hertz - 3) < 1e-12); // the eigenvalue is written with 17 digits
   QCOMPARE(found->modes[0].hertz, 0.0);
   QVERIFY(modeOf(2e-9, 8.9e-10).kind == Kind::vibration); // close above rounding is kept
}

void SceneBalanceTest::shapesAreReadModeByMode()
{
   const Workbench bench = row();
   const auto found =
       findModes(standIns(), sceneOf(bench, Analysis::modes), bench.setup, {{"modes", 3.0}}, {}, bench.job);
   DIATOM_VERIFY_OK(found);
   QCOMPARE(found->modes.size(), std::size_t{3});
   const auto shape = found->shape(2, bench.job);
   DIATOM_VERIFY_OK(shape);
   QCOMPARE(shape->size(), std::size_t{24});
   QCOMPARE((*shape)[0], 200.0);
   QCOMPARE((*shape)[6 * 3 + 5], 235.0);
   QVERIFY(!found->shape(3, bench.job));
}

QTEST_APPLESS_MAIN(SceneBalanceTest)
#include "scene_balance_test.moc"
