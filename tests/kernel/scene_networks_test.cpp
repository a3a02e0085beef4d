// Nets, actuators and wiring problems: the earlier programs' mechanisms against the fact sheet's counts, and
// a minimal assembly for each kind of fault.
#include "formats/files.h"
#include "kernel/scene_workbench.h"
#include "scene/networks.h"
#include "scene/problems.h"

#include <QTest>

#include <algorithm>
#include <map>

using namespace diatom;
using test::Workbench;

namespace {

std::vector<std::string> kinds(const Networks &networks)
{
   std::vector<std::string> found;
   for (const Problem &problem : networks.problems)
      found.push_back(problem.kind);
   return found;
}

Networks networksOf(const Workbench &bench)
{
   return findNetworks(bench.hierarchy(), bench.setup, bench.job);
}

/// Exactly one problem, of this kind, with these cells, and a remedy after the semicolon.
void verifyOnly(const Networks &networks, const char *kind, const std::vector<Index> &cells)
{
   QCOMPARE(kinds(networks), std::vector<std::string>{kind});
   const Problem &problem = networks.problems.front();
   QVERIFY2(problem.cells == cells, problem.text.c_str());
   QVERIFY2(problem.text.find(';') != std::string::npos, problem.text.c_str());
}

/// A net of wires with a source on it and an x actuator in the middle of a loop.
Workbench loopWithActuator()
{
   Workbench bench;
   bench.put("wire", {{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}, {2, 0, 0}});
   bench.put("piezo", {{1, 0, 0}});
   // The loop's middle would touch the actuator from above: an insulated detour is needed.
   bench.put("plain", {{1, 1, 0}});
   bench.put("wire", {{0, 2, 0}, {1, 2, 0}, {2, 2, 0}});
   bench.source({3, 1, 0});
   return bench;
}

} // namespace

class SceneNetworksTest : public QObject
{
   Q_OBJECT

private slots:
   void theEarlierMechanismsHaveTheSheetsNets_data();
   void theEarlierMechanismsHaveTheSheetsNets();
   void theCapacitorHasTheGoldenGroups();
   void anActuatorOnOneNetIsDrivenAgainstGround();
   void anActuatorBetweenTwoNetsIsDrivenByTheirDifference();
   void conductorsConnectOnlyWhereBothHaveAPort();
   void turnedConductorsConnectThroughTheirTurnedPorts();
   void twoSourcesOnOneNetAreAnError();
   void aSourceWithBothTerminalsOnOneNetIsShorted();
   void oppositePolaritiesOnOneNetAreAnError();
   void theMinusTerminalDrivesInverted();
   void aSourceThatTouchesNothingIsOpen();
   void aSourceOnAnInsulatorIsAnError();
   void aSourceCellWithoutSignalIsAWarning();
   void anActuatorWithAnOpenTerminalFloats();
   void anActuatorWithThreeWiresIsAmbiguous();
   void anActuatorOfOwnTerminalsOnOneNetIsShorted();
   void aNetThatFeedsActuatorsWantsASource();
   void aPortThatMeetsNothingIsAWarning();
   void waveformsFollowTheSheet();
};

void SceneNetworksTest::theEarlierMechanismsHaveTheSheetsNets_data()
{
   // amoeba.md table 2.3: separate bodies, nets and cells of each, actuators, their axis, how many a net
   // drives.
   QTest::addColumn<QString>("file");
   QTest::addColumn<int>("bodies");
   QTest::addColumn<int>("nets");
   QTest::addColumn<int>("cellsOfNet");
   QTest::addColumn<int>("actuators");
   QTest::addColumn<int>("axis");
   QTest::addColumn<int>("actuatorsOfNet");
   QTest::newRow("BeamBending") << "BeamBending.json" << 4 << 0 << 0 << 0 << 0 << 0;
   QTest::newRow("Bendy") << "Bendy.json" << 1 << 2 << 59 << 12 << 0 << 6;
   QTest::newRow("Gripper") << "Gripper.json" << 3 << 6 << 11 << 6 << 1 << 1;
   QTest::newRow("Locomotion") << "Locomotion.json" << 4 << 4 << 17 << 4 << 1 << 1;
}

void SceneNetworksTest::theEarlierMechanismsHaveTheSheetsNets()
{
   DIATOM_NEEDS_SHARED();
   QFETCH(QString, file);
   QFETCH(int, bodies);
   QFETCH(int, nets);
   QFETCH(int, cellsOfNet);
   QFETCH(int, actuators);
   QFETCH(int, axis);
   QFETCH(int, actuatorsOfNet);
   const Job job;
   const auto opened = openDesign(test::sharedDir() / "data" / "amoeba" / file.toStdString(), job);
   DIATOM_VERIFY_OK(opened);
   const auto lattice = Lattice::make(*test::catalogue(), opened->design.model.lattice, job);
   DIATOM_VERIFY_OK(lattice);
   const Hierarchy hierarchy(*lattice, opened->design.model);
   const Networks networks = findNetworks(hierarchy, opened->design.setup, job);
   for (const Problem &problem : networks.problems)
      QFAIL(problem.text.c_str());
   QCOMPARE(int(networks.nets.size()), nets);
   QCOMPARE(int(networks.actuators.size()), actuators);
   for (const Network &net : networks.nets) {
      QCOMPARE(int(net.cells.size()), cellsOfNet);
      QCOMPARE(int(net.sources.size()), 1);
      QCOMPARE(int(net.actuators.size()), actuatorsOfNet);
   }
   for (const DrivenActuator &actuator : networks.actuators) {
      QCOMPARE(actuator.axis, axis);
      QCOMPARE(actuator.netA, actuator.netB);
   }
   const auto found = findBodies(hierarchy, job);
   DIATOM_VERIFY_OK(found);
   QCOMPARE(int(found->size()), bodies);
}

void SceneNetworksTest::theCapacitorHasTheGoldenGroups()
{
   DIATOM_NEEDS_SHARED();
   const Job job;
   const auto opened = openDesign(test::sharedDir() / "data" / "dmdesign" / "capacitor.json", job);
   DIATOM_VERIFY_OK(opened);
   Model model = opened->design.model;
   const DefinitionId tower = model.definition("superc35");
   QVERIFY(tower != 0);
   model.root.instances.insert({tower, {0, 0, 0}, 0});
   const auto lattice = Lattice::make(*test::catalogue(), model.lattice, job);
   DIATOM_VERIFY_OK(lattice);
   const Hierarchy hierarchy(*lattice, model);
   const Networks networks = findNetworks(hierarchy, {}, job);
   // dmdesign.md 5.4: 8 conductor groups of 9 bricks of 4 cells, 2 structural groups of 54 bricks.
   QCOMPARE(networks.nets.size(), std::size_t(8));
   for (const Network &net : networks.nets)
      QCOMPARE(net.cells.size(), std::size_t(36));
   const auto bodies = findBodies(hierarchy, job);
   DIATOM_VERIFY_OK(bodies);
   QCOMPARE(bodies->size(), std::size_t(2));
   for (const auto &body : *bodies)
      QCOMPARE(body.size(), std::size_t(216));
}

void SceneNetworksTest::anActuatorOnOneNetIsDrivenAgainstGround()
{
   const Networks networks = networksOf(loopWithActuator());
   QVERIFY(networks.problems.empty());
   QCOMPARE(networks.nets.size(), std::size_t(1));
   QCOMPARE(networks.nets[0].cells.size(), std::size_t(8));
   QCOMPARE(networks.actuators.size(), std::size_t(1));
   QVERIFY(networks.actuators[0].cell == (Index{1, 0, 0}));
   QCOMPARE(networks.actuators[0].axis, 0);
   QCOMPARE(networks.actuators[0].netA, 0);
   QCOMPARE(networks.actuators[0].netB, 0);
   QCOMPARE(networks.nets[0].source(), 0);
}

void SceneNetworksTest::anActuatorBetweenTwoNetsIsDrivenByTheirDifference()
{
   for (const char *id : {"piezo", "own-terminals"}) {
      Workbench bench;
      bench.put("wire", {{0, 0, 0}, {2, 0, 0}});
      bench.put(id, {{1, 0, 0}});
      bench.source({-1, 0, 0});
      bench.source({3, 0, 0});
      const Networks networks = networksOf(bench);
      QVERIFY2(networks.problems.empty(), networks.problems.empty() ? "" : networks.problems[0].text.c_str());
      QCOMPARE(networks.nets.size(), std::size_t(2));
      QCOMPARE(networks.actuators.size(), std::size_t(1));
      QCOMPARE(networks.actuators[0].netA,
               0); // nets are ordered by smallest cell, so that 0 lies on the - side
      QCOMPARE(networks.actuators[0].netB, 1);
   }
}

void SceneNetworksTest::conductorsConnectOnlyWhereBothHaveAPort()
{
   Workbench bench;
   bench.put("bar", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
   const Networks networks = networksOf(bench);
   QCOMPARE(networks.nets.size(), std::size_t(2));
   QCOMPARE(networks.nets[0].cells, (std::vector<Index>{{0, 0, 0}, {1, 0, 0}}));
   QCOMPARE(networks.nets[1].cells, (std::vector<Index>{{0, 1, 0}}));
}

void SceneNetworksTest::turnedConductorsConnectThroughTheirTurnedPorts()
{
   Workbench bench;
   const std::uint8_t upright = bench.turn(Vec3::UnitX(), Vec3::UnitY());
   bench.put("bar", {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}}, upright);
   const Networks networks = networksOf(bench);
   QCOMPARE(networks.nets.size(), std::size_t(2));
   QCOMPARE(networks.nets[0].cells, (std::vector<Index>{{0, 0, 0}, {0, 1, 0}}));
}

void SceneNetworksTest::twoSourcesOnOneNetAreAnError()
{
   Workbench bench;
   bench.put("wire", {{1, 0, 0}});
   bench.source({0, 0, 0});
   bench.source({2, 0, 0});
   const Networks networks = networksOf(bench);
   verifyOnly(networks, "two-sources", {{0, 0, 0}, {2, 0, 0}});
   QVERIFY(networks.problems[0].severity == Problem::Severity::error);
   QCOMPARE(networks.nets[0].source(), -1); // in conflict: nothing drives it
   QCOMPARE(netVoltage(networks.nets[0], bench.setup, 0.025), 0.0);
}

void SceneNetworksTest::aSourceWithBothTerminalsOnOneNetIsShorted()
{
   Workbench bench;
   bench.put("wire", {{-1, 0, 0}, {-1, 1, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}});
   bench.source({0, 0, 0}, 1, "battery");
   const Networks networks = networksOf(bench);
   verifyOnly(networks, "source-shorted", {{0, 0, 0}});
   QCOMPARE(networks.nets.size(), std::size_t(1));
   QCOMPARE(networks.nets[0].cells.size(), std::size_t(5)); // the source is no part of it
}

void SceneNetworksTest::oppositePolaritiesOnOneNetAreAnError()
{
   Workbench bench;
   bench.source({0, 0, 0}, 1, "battery");
   bench.put("wire", {{1, 0, 0}});
   bench.source({2, 0, 0}, 1, "battery");
   bench.put("wire", {{-1, 0, 0}, {3, 0, 0}});
   verifyOnly(networksOf(bench), "opposite-polarity", {{0, 0, 0}, {2, 0, 0}});
}

void SceneNetworksTest::theMinusTerminalDrivesInverted()
{
   Workbench bench;
   bench.source({0, 0, 0}, 2, "battery");
   bench.put("wire", {{-1, 0, 0}, {1, 0, 0}});
   const Networks networks = networksOf(bench);
   QVERIFY(networks.problems.empty());
   QCOMPARE(networks.nets.size(), std::size_t(2));
   QVERIFY(networks.nets[0].inverted());
   QVERIFY(!networks.nets[1].inverted());
   // A quarter period of a 10 Hz sine of 2 V peak to peak.
   QVERIFY(std::abs(netVoltage(networks.nets[1], bench.setup, 0.025) - 1) < 1e-12);
   QVERIFY(std::abs(netVoltage(networks.nets[0], bench.setup, 0.025) + 1) < 1e-12);
}

void SceneNetworksTest::aSourceThatTouchesNothingIsOpen()
{
   Workbench lone;
   lone.source({0, 0, 0});
   verifyOnly(networksOf(lone), "open-source", {{0, 0, 0}});
   Workbench half;
   half.source({0, 0, 0}, 1, "battery");
   half.put("wire", {{1, 0, 0}});
   verifyOnly(networksOf(half), "open-source", {{0, 0, 0}});
}

void SceneNetworksTest::aSourceOnAnInsulatorIsAnError()
{
   Workbench bench;
   bench.source({0, 0, 0}, 1, "plain");
   verifyOnly(networksOf(bench), "source-not-conductive", {{0, 0, 0}});
}

void SceneNetworksTest::aSourceCellWithoutSignalIsAWarning()
{
   Workbench bench;
   bench.put("signal", {{0, 0, 0}});
   const Networks networks = networksOf(bench);
   verifyOnly(networks, "source-without-signal", {{0, 0, 0}});
   QVERIFY(networks.problems[0].severity == Problem::Severity::warning);
}

void SceneNetworksTest::anActuatorWithAnOpenTerminalFloats()
{
   Workbench bench;
   bench.put("piezo", {{1, 0, 0}});
   bench.source({0, 0, 0});
   bench.put("wire", {{-1, 0, 0}});
   const Networks networks = networksOf(bench);
   verifyOnly(networks, "floating-actuator", {{1, 0, 0}});
   QVERIFY(networks.actuators.empty());
}

void SceneNetworksTest::anActuatorWithThreeWiresIsAmbiguous()
{
   Workbench three;
   three.put("wire", {{0, 0, 0}, {2, 0, 0}, {1, 1, 0}});
   three.put("piezo", {{1, 0, 0}});
   verifyOnly(networksOf(three), "ambiguous-actuator", {{1, 0, 0}});
   Workbench corner;
   corner.put("wire", {{0, 0, 0}, {1, 1, 0}});
   corner.put("piezo", {{1, 0, 0}});
   verifyOnly(networksOf(corner), "ambiguous-actuator", {{1, 0, 0}});
}

void SceneNetworksTest::anActuatorOfOwnTerminalsOnOneNetIsShorted()
{
   Workbench bench = loopWithActuator();
   bench.put("own-terminals", {{1, 0, 0}});
   const Networks networks = networksOf(bench);
   verifyOnly(networks, "shorted-actuator", {{1, 0, 0}});
   QVERIFY(networks.actuators.empty());
}

void SceneNetworksTest::aNetThatFeedsActuatorsWantsASource()
{
   Workbench bench;
   bench.put("wire", {{0, 0, 0}, {2, 0, 0}});
   bench.put("piezo", {{1, 0, 0}});
   bench.source({3, 0, 0});
   const Networks networks = networksOf(bench);
   verifyOnly(networks, "net-without-source", {{0, 0, 0}});
   QCOMPARE(networks.actuators.size(), std::size_t(1));
}

void SceneNetworksTest::aPortThatMeetsNothingIsAWarning()
{
   Workbench bench;
   bench.put("wire", {{0, 0, 0}, {2, 0, 0}});
   bench.put("bar", {{1, 0, 0}});
   QVERIFY(networksOf(bench).problems.empty());
   bench.put("plain", {{2, 0, 0}});
   const Networks networks = networksOf(bench);
   verifyOnly(networks, "port-facing-nothing", {{1, 0, 0}});
   QVERIFY(networks.problems[0].severity == Problem::Severity::warning);
}

void SceneNetworksTest::waveformsFollowTheSheet()
{
   // amoeba.md 5.3 at u = 0.1, 0.3, 0.6, 0.9 for 1 V peak to peak; exact up to the rounding of u.
   const std::map<Waveform, std::array<double, 4>> expected{
       {Waveform::sine,
        {0.5 * std::sin(0.2 * M_PI), 0.5 * std::sin(0.6 * M_PI), 0.5 * std::sin(1.2 * M_PI),
         0.5 * std::sin(1.8 * M_PI)}},
       {Waveform::square, {0.5, -0.5, -0.5, -0.5}},
       {Waveform::saw, {-0.4, -0.2, 0.1, 0.4}},
       {Waveform::triangle, {-0.3, 0.1, 0.3, -0.3}}};
   for (const auto &[waveform, values] : expected) {
      Source source;
      source.waveform = waveform;
      source.frequency = 2;
      source.phase = 0.05;
      source.duty = 0.25;
      const std::array<double, 4> turns{0.1, 0.3, 0.6, 0.9};
      for (std::size_t k = 0; k < 4; ++k) {
         const double time = (turns[k] - source.phase + 3) / source.frequency; // three periods later
         QVERIFY(std::abs(sourceVoltage(source, time) - values[k]) < 1e-12);
      }
   }
   Source falling;
   falling.waveform = Waveform::saw;
   falling.inverted = true;
   falling.frequency = 1;
   falling.amplitude = 4;
   QVERIFY(std::abs(sourceVoltage(falling, 0.25) - 1) < 1e-12);
}

QTEST_APPLESS_MAIN(SceneNetworksTest)
#include "scene_networks_test.moc"
