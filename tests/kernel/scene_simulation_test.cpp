// Scenes run through the installed solver: known sags and strokes, conserved quantities, refusals, cancel,
// and the same bits for any number of threads.
#include "formats/files.h"
#include "kernel/scene_workbench.h"
#include "scene/simulation.h"

#include <QTest>

#include <cmath>

using namespace diatom;
using test::Workbench;

namespace {

Result<std::unique_ptr<Simulation>> start(const Workbench &bench, const Values &values = {})
{
   auto scene = Scene::build(bench.hierarchy(), bench.setup, bench.job);
   if (!scene)
      return scene.error();
   return Simulation::start(test::catalogue(), *std::move(scene), bench.setup, values, bench.job);
}

double probe(const Simulation &simulation, Index cell, const std::string &channel)
{
   const auto value = simulation.probe(simulation.scene().cellAt(cell), channel, Job());
   if (!value)
      qFatal("%s", value.error().message.c_str());
   return *value;
}

/// The stiff 1x1 cantilever of BeamBending: 14 cells along +y, E = k / l = 0.5 MPa, 3500 kg/m3, root clamped.
Workbench cantilever()
{
   Workbench bench;
   Material fibre = test::material("fibre");
   fibre.density = 3500;
   fibre.youngsModulus = 5e5;
   fibre.poissonRatio = 0.3;
   bench.add(fibre);
   for (std::int32_t y = 0; y < 14; ++y)
      bench.put("fibre", {{0, y, 0}});
   bench.setup.supports = {{Index{0, 0, 0}, 0x3f}};
   bench.setup.gravity = {0, 0, -9.8};
   return bench;
}

} // namespace

class SceneSimulationTest : public QObject
{
   Q_OBJECT

private slots:
   void initTestCase();
   void aSettledCantileverSagsAsTheSheetSays();
   void theGripperClosesAsTheSheetSays();
   void undampedMotionKeepsItsEnergy();
   void aFreeBodyKeepsItsMomentum();
   void anUnusedEffectChangesNoBit();
   void theResultDoesNotDependOnThreadsOrPieces();
   void aStepBeyondTheLimitIsRefused();
   void aDivergingRunNamesBondTimeAndRemedy();
   void whatCannotBeSimulatedIsRefusedByName();
   void aCancelledRunStopsWhereItIs();
   void unknownChannelsAreRefused();
};

void SceneSimulationTest::initTestCase()
{
   QVERIFY2(test::catalogue()->offer(DIATOM_SOLVER_1, Setup().solver), "the bond solver was not built");
}

void SceneSimulationTest::aSettledCantileverSagsAsTheSheetSays()
{
   Workbench bench = cantilever();
   bench.setup.drag = 100; // first mode 10.55 Hz = 66 rad/s: nearly critical, e^-15 is left after 0.3 s
   const auto simulation = start(bench);
   DIATOM_VERIFY_OK(simulation);
   DIATOM_VERIFY_OK((*simulation)->advance(0.3, bench.job));
   // amoeba.md 2.4: large-rotation static tip (dy, dz) = (-0.43, -3.11) mm, slope -18.6 degrees; given to two
   // decimals.
   const Index tip{0, 13, 0};
   const double dy = probe(**simulation, tip, "y"), dz = probe(**simulation, tip, "z");
   const double slope = probe(**simulation, tip, "rx") * 180 / M_PI;
   qInfo("tip dy %.4f mm, dz %.4f mm, slope %.3f degrees", 1e3 * dy, 1e3 * dz, slope);
   QVERIFY(std::abs(1e3 * dy + 0.43) < 0.006);
   QVERIFY(std::abs(1e3 * dz + 3.11) < 0.006);
   QVERIFY(std::abs(slope + 18.6) < 0.06);
   QVERIFY(std::abs(probe(**simulation, tip, "x")) < 1e-12);
   QVERIFY(std::abs(probe(**simulation, tip, "vz")) < 1e-5);
}

void SceneSimulationTest::theGripperClosesAsTheSheetSays()
{
   DIATOM_NEEDS_SHARED();
   const Job job;
   const auto opened = openDesign(test::sharedDir() / "data" / "amoeba" / "Gripper.json", job);
   DIATOM_VERIFY_OK(opened);
   const auto lattice = Lattice::make(*test::catalogue(), opened->design.model.lattice, job);
   DIATOM_VERIFY_OK(lattice);
   const Hierarchy hierarchy(*lattice, opened->design.model);
   Setup setup = opened->design.setup;
   setup.gravity = {0, 0, 0};
   setup.ground.present = false;
   setup.step = 0;
   setup.drag = 400;                        // settles within some hundredths of a second
   setup.solverValues["junction"] = "mean"; // the sheet joins unlike cells by harmonic means
   for (Source &source : setup.sources) {
      source.waveform = Waveform::square; // duty 1: +0.5 V all the time
      source.duty = 1;
      source.phase = 0;
   }
   auto scene = Scene::build(hierarchy, setup, job);
   DIATOM_VERIFY_OK(scene);
   const auto simulation = Simulation::start(test::catalogue(), *std::move(scene), setup, {}, job);
   DIATOM_VERIFY_OK(simulation);
   DIATOM_VERIFY_OK((*simulation)->advance(0.3, job));
   // amoeba.md 2.4: the gap between the inner columns at the tip, x = -11, quasi-static and linear, in mm.
   const std::array<double, 3> expected{-0.52, -0.29, -0.55};
   for (std::int32_t k = 0; k < 3; ++k) {
      const double change = 1e3 * (probe(**simulation, {-11, 4 + 14 * k, 0}, "y") -
                                   probe(**simulation, {-11, 2 + 14 * k, 0}, "y"));
      qInfo("gripper %d: gap change %.4f mm", k + 1, change);
      // The sheet rounds to 0.01 and is linear.
      QVERIFY(std::abs(change - expected[std::size_t(k)]) < 0.006);
   }
}

void SceneSimulationTest::undampedMotionKeepsItsEnergy()
{
   Workbench bench = cantilever();
   const auto simulation = start(bench);
   DIATOM_VERIFY_OK(simulation);
   DIATOM_VERIFY_OK((*simulation)->advance(0.5, bench.job));
   const auto energy = (*simulation)->energy(bench.job);
   DIATOM_VERIFY_OK(energy);
   qInfo("energy drift %.3e of the energy in play after %lld steps", energy->drift,
         (long long)(*simulation)->steps());
   // A symplectic first-order step oscillates by half the step times the fastest frequency in use; here 1e-2
   // at most.
   QVERIFY(std::abs(energy->drift) < 1e-2);
   QCOMPARE(energy->dissipated, 0.0);
   QVERIFY(energy->kinetic + energy->elastic > 0);
}

void SceneSimulationTest::aFreeBodyKeepsItsMomentum()
{
   Workbench bench = cantilever();
   bench.setup.supports.clear();
   bench.setup.gravity = {0, 0, 0};
   bench.setup.loads = {{Index{0, 13, 0}, {1e-5, 0, 2e-5}, {}}};
   const auto simulation = start(bench);
   DIATOM_VERIFY_OK(simulation);
   DIATOM_VERIFY_OK((*simulation)->advance(0.05, bench.job));
   const auto momentum = (*simulation)->momentum(bench.job);
   DIATOM_VERIFY_OK(momentum);
   // Impulse = force times time, exactly, as bonds act in pairs; the rest is rounding over some thousand
   // steps.
   QVERIFY(std::abs(momentum->linear.x() - 5e-7) < 5e-7 * 1e-9);
   QVERIFY(std::abs(momentum->linear.z() - 1e-6) < 1e-6 * 1e-9);
   const auto energy = (*simulation)->energy(bench.job);
   DIATOM_VERIFY_OK(energy);
   QVERIFY(energy->work > 0);
}

void SceneSimulationTest::anUnusedEffectChangesNoBit()
{
   Workbench bench = cantilever();
   const auto planned = start(bench);
   for (const char *name : {"damping", "actuation", "drag", "loads"})
      bench.setup.effects[name] = true;
   const auto forced = start(bench);
   DIATOM_VERIFY_OK(planned);
   DIATOM_VERIFY_OK(forced);
   DIATOM_VERIFY_OK((*planned)->advance(0.02, bench.job));
   DIATOM_VERIFY_OK((*forced)->advance(0.02, bench.job));
   QCOMPARE((*planned)->frame(bench.job)->position, (*forced)->frame(bench.job)->position);
   QCOMPARE((*planned)->frame(bench.job)->rotation, (*forced)->frame(bench.job)->rotation);
}

void SceneSimulationTest::theResultDoesNotDependOnThreadsOrPieces()
{
   std::vector<std::vector<double>> positions;
   for (const int threads : {1, 2, 3}) {
      Workbench bench = cantilever();
      bench.block("fibre", {{0, 0, 0}, {19, 19, 11}});
      bench.job.setThreads(threads);
      const auto simulation = start(bench);
      DIATOM_VERIFY_OK(simulation);
      DIATOM_VERIFY_OK((*simulation)->advance(5e-3, bench.job));
      const auto frame = (*simulation)->frame(bench.job);
      DIATOM_VERIFY_OK(frame);
      positions.push_back(frame->position);
   }
   QCOMPARE(positions[0], positions[1]);
   QCOMPARE(positions[0], positions[2]);
}

void SceneSimulationTest::aStepBeyondTheLimitIsRefused()
{
   Workbench bench = cantilever();
   const auto sound = start(bench);
   DIATOM_VERIFY_OK(sound);
   QVERIFY((*sound)->stableStep() > 0);
   QVERIFY((*sound)->stableLink() >= 0 && (*sound)->stableLink() < 13);
   bench.setup.step = 1.1 * (*sound)->stableStep();
   const auto bold = start(bench);
   DIATOM_VERIFY_OK(bold);
   const Status ran = (*bold)->advance(0.1, bench.job);
   QVERIFY(!ran);
   QVERIFY(ran.error().message.find("stable") != std::string::npos);
}

void SceneSimulationTest::aDivergingRunNamesBondTimeAndRemedy()
{
   Workbench bench = cantilever();
   const double stable = (*start(bench))->stableStep();
   bench.setup.step = 3 * stable; // the limit is a bound: the true one is at most twice as long
   const auto simulation = start(bench, {{"force_step", 1.0}});
   DIATOM_VERIFY_OK(simulation);
   const Status ran = (*simulation)->advance(1, bench.job);
   QVERIFY(!ran);
   QVERIFY(ran.error().code == ErrorCode::unstable);
   for (const char *word : {"bond between cells (0, ", "t = ", "--step"})
      QVERIFY2(ran.error().message.find(word) != std::string::npos, ran.error().message.c_str());
   const auto frame = (*simulation)->frame(bench.job); // the last good state stays readable
   DIATOM_VERIFY_OK(frame);
   for (const double value : frame->position)
      QVERIFY(std::isfinite(value));
}

void SceneSimulationTest::whatCannotBeSimulatedIsRefusedByName()
{
   Workbench bench = cantilever();
   bench.setup.effects["self-contact"] = true;
   const auto wished = start(bench);
   QVERIFY(!wished);
   QVERIFY(wished.error().code == ErrorCode::unsupported);
   QVERIFY2(wished.error().message.find("self-contact") != std::string::npos, wished.error().message.c_str());
   bench.setup.effects.clear();
   bench.setup.solver = "org.example.none";
   const auto missing = start(bench);
   QVERIFY(!missing);
   QVERIFY2(missing.error().message.find("org.example.none") != std::string::npos,
            missing.error().message.c_str());
   bench.setup.solver = Setup().solver;
   const auto wrong = start(bench, {{"integrator", std::string("magic")}});
   QVERIFY(!wrong);
   QVERIFY2(wrong.error().message.find("integrator") != std::string::npos, wrong.error().message.c_str());
}

void SceneSimulationTest::aCancelledRunStopsWhereItIs()
{
   Workbench bench = cantilever();
   const auto simulation = start(bench);
   DIATOM_VERIFY_OK(simulation);
   Job *self = nullptr;
   Job job([&](double fraction, std::string_view) {
      if (fraction > 1e-6)
         self->cancel();
   });
   self = &job;
   const Status ran = (*simulation)->advance(1000, job);
   QVERIFY(!ran);
   QVERIFY(ran.error().code == ErrorCode::cancelled);
   QVERIFY((*simulation)->time() > 0 && (*simulation)->time() < 1000);
   const double before = (*simulation)->time();
   DIATOM_VERIFY_OK((*simulation)->frame(bench.job));
   DIATOM_VERIFY_OK((*simulation)->advance(before + 1e-3, bench.job)); // and goes on when asked to
   QCOMPARE((*simulation)->time(), before + 1e-3);
}

void SceneSimulationTest::unknownChannelsAreRefused()
{
   const Workbench bench = cantilever();
   const auto simulation = start(bench);
   DIATOM_VERIFY_OK(simulation);
   QVERIFY(!(*simulation)->probe(0, "temperature", bench.job));
   QVERIFY(!(*simulation)->probe(-1, "x", bench.job));
   for (const auto &[channel, unit] : Simulation::probeChannels()) {
      const auto value = (*simulation)->probe(3, channel, bench.job);
      // What supports supply is told by solvers that have the output "reaction"; others say so.
      if (!value && !(*simulation)->run().hasOutput("reaction"))
         QVERIFY2(value.error().message.find("has no output 'reaction'") != std::string::npos,
                  value.error().message.c_str());
      else
         DIATOM_VERIFY_OK(value);
   }
}

QTEST_APPLESS_MAIN(SceneSimulationTest)
#include "scene_simulation_test.moc"
