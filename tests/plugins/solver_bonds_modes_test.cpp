// Vibrations about a balance, against exact frequencies of chains and blocks.
#include "solver_bonds_reference.h"
#include "solver_bonds_scene.h"

#include <algorithm>

using namespace diatom::test;
using nlohmann::json;

namespace {

/// The reference's cubes of mass m are cubes here too.
HandScene sceneOf(const json &reference, int nx, int ny, int nz)
{
   const double l = reference.at("lattice").at("pitch");
   const json &material = reference.at("materials").at("m");
   HandScene scene(l);
   scene.analysis = "modes";
   const double mass = material.value("mass", 0.001);
   scene.addMaterial(fifteen(material.at("k"), mass / (l * l * l)));
   scene.addBlock(nx, ny, nz);
   scene.link();
   return scene;
}

/// Largest eigenvalue of a cube of 4 cells an edge is (1.6e4 rad/s)^2, c04; rounding of it, some places.
constexpr double kNothing = 1e-14 * 1.6e4 * 1.6e4;

} // namespace

class SolverBondsModesTest : public QObject
{
   Q_OBJECT
private slots:
   void cantileversVibrateAsTheReference();
   void freeBlocksHaveSixRigidModesAndThenTheReferences();
   void highestFrequenciesAreTheReferences();
   void loadedColumnsLoseTheirStiffnessAtTheCriticalLoad();
   void shapesHaveUnitModalMassAndDoNotMix();
   void largeBlocksGiveTheSameBitsOnAnyThreads();
   void floatingPartsUnderLoadAreRefused();
   void moreModesThanFreedomsGiveAllOfThem();
};

/// c04, "eigen_rel" 1e-6. Bending comes in equal pairs.
void SolverBondsModesTest::cantileversVibrateAsTheReference()
{
   DIATOM_NEEDS_SHARED();
   const json reference = readReference("c04-cantilever-modes.json");
   for (const json &s : reference.at("scenarios"))
      for (const auto &[model, beam] : kModels) {
         const int n = s.at("cells")[0].at("box")[1][0];
         HandScene scene = sceneOf(reference, n + 1, 1, 1);
         scene.fix(0);
         Run run(scene, {.beam = beam, .modes = 8});
         QVERIFY2(run.to(0) == DIATOM_OK, run.host.said.c_str());
         QCOMPARE(run.result.state, DIATOM_CONVERGED);
         const json &expected = s.at("expected").at(model);
         std::vector<double> omega;
         for (const double w : expected.at("bending_rad_s"))
            omega.insert(omega.end(), 2, w);
         for (const char *kind : {"axial_rad_s", "torsion_rad_s"})
            for (const double w : expected.at(kind))
               omega.push_back(w);
         std::sort(omega.begin(), omega.end());
         const auto got = run.read("eigenvalue");
         QCOMPARE(got.size(), 8u);
         // The file ends at the third bending mode and the second of the others: below the least of these
         // last ones it lists every mode there is.
         const double last = std::min({expected.at("bending_rad_s").back().get<double>(),
                                       expected.at("axial_rad_s").back().get<double>(),
                                       expected.at("torsion_rad_s").back().get<double>()});
         for (std::size_t i = 0; i < 8 && omega[i] <= last; ++i)
            QVERIFY2(std::abs(std::sqrt(got[i]) / omega[i] - 1) < 1e-6,
                     qPrintable(QString("N=%1 %2 mode %3: %4 %5")
                                    .arg(n)
                                    .arg(beam.c_str())
                                    .arg(i)
                                    .arg(std::sqrt(got[i]))
                                    .arg(omega[i])));
      }
}

/// c04, "eigen_rel" 1e-6; fivefold modes among them.
void SolverBondsModesTest::freeBlocksHaveSixRigidModesAndThenTheReferences()
{
   DIATOM_NEEDS_SHARED();
   const json reference = readReference("c04-free-block.json");
   for (const auto &[model, beam] : kModels) {
      HandScene scene = sceneOf(reference, 4, 4, 4);
      Run run(scene, {.beam = beam, .modes = 16});
      QVERIFY2(run.to(0) == DIATOM_OK, run.host.said.c_str());
      const auto got = run.read("eigenvalue");
      QCOMPARE(got.size(), 16u);
      for (std::size_t i = 0; i < 6; ++i)
         QVERIFY2(std::abs(got[i]) <= kNothing, qPrintable(QString::number(got[i])));
      const json &omega = reference.at("expected").at(model).at("first_10_nonrigid_rad_s");
      for (std::size_t i = 0; i < 10; ++i)
         QVERIFY2(std::abs(std::sqrt(got[6 + i]) / omega[i].get<double>() - 1) < 1e-6,
                  qPrintable(QString("%1 mode %2: %3").arg(beam.c_str()).arg(i).arg(std::sqrt(got[6 + i]))));
   }
}

/// c04 "omega_max_rad_s" of chains and of a free block, "eigen_rel" 1e-6.
void SolverBondsModesTest::highestFrequenciesAreTheReferences()
{
   DIATOM_NEEDS_SHARED();
   const auto check = [](HandScene &scene, const std::string &beam, double expected) {
      Run run(scene, {.beam = beam, .modes = 3, .modesFrom = "highest"});
      QVERIFY2(run.to(0) == DIATOM_OK, run.host.said.c_str());
      const auto eigenvalues = run.read("eigenvalue");
      QCOMPARE(eigenvalues.size(), std::size_t{3});
      QVERIFY(std::is_sorted(eigenvalues.begin(), eigenvalues.end()));
      const double error = std::sqrt(eigenvalues[2]) / expected - 1;
      QVERIFY2(std::abs(error) < 1e-6, qPrintable(QString::number(error)));
   };
   const json chains = readReference("c04-cantilever-modes.json");
   for (const json &s : chains.at("scenarios"))
      for (const auto &[model, beam] : kModels) {
         HandScene scene = sceneOf(chains, s.at("cells")[0].at("box")[1][0].get<int>() + 1, 1, 1);
         scene.fix(0);
         check(scene, beam, s.at("expected").at(model).at("omega_max_rad_s"));
      }
   const json block = readReference("c04-free-block.json");
   for (const auto &[model, beam] : kModels) {
      HandScene scene = sceneOf(block, 4, 4, 4);
      check(scene, beam, block.at("expected").at(model).at("omega_max_rad_s"));
   }
}

/// c03: the sign at 0.97 and 1.03 of the critical load, and all but nothing left at the load itself. The
/// first eigenvalue falls in proportion to what is left of the load, to first order.
void SolverBondsModesTest::loadedColumnsLoseTheirStiffnessAtTheCriticalLoad()
{
   DIATOM_NEEDS_SHARED();
   const json reference = readReference("c03-column-buckling.json");
   for (const json &s : reference.at("scenarios")) {
      const int n = s.at("N_bonds");
      std::vector<double> first;
      for (const double factor : {0.0, 0.97, 1.0, 1.03}) {
         HandScene scene = sceneOf(reference, n + 1, 1, 1);
         scene.fix(0);
         scene.effects = {"rotation", "loads"};
         const double load = s.at("expected_critical_load").at("b");
         scene.addRow("force", {-factor * load, 0, 0, 0, 0, 0}, n);
         Run run(scene, {.modes = 2});
         QVERIFY2(run.to(0) == DIATOM_OK, run.host.said.c_str());
         first.push_back(run.read("eigenvalue")[0]);
      }
      QVERIFY(first[1] > 0 && first[3] < 0);
      QVERIFY2(std::abs(first[2]) < 1e-6 * first[0], qPrintable(QString::number(first[2] / first[0])));
   }
}

/// Rounding of sums over a chain of 8.
void SolverBondsModesTest::shapesHaveUnitModalMassAndDoNotMix()
{
   const double l = 1e-2;
   HandScene scene(l);
   scene.analysis = "modes";
   scene.addMaterial({{"density", 1100}, {"youngs_modulus", 5e6}, {"poisson_ratio", 0.3}});
   scene.addBlock(8, 1, 1);
   for (int i = 0; i < 8; ++i) { // boxes: their inertia differs by axis
      scene.extent[3 * i + 1] = 0.5 * l;
      scene.extent[3 * i + 2] = 0.8 * l;
   }
   scene.link();
   scene.fix(0);
   Run run(scene, {.modes = 6});
   QVERIFY2(run.to(0) == DIATOM_OK, run.host.said.c_str());
   const auto shape = run.read("mode");
   const double box[3] = {l, 0.5 * l, 0.8 * l}, mass = 1100 * box[0] * box[1] * box[2];
   const std::size_t size = 8 * 6;
   for (std::size_t a = 0; a < 6; ++a)
      for (std::size_t b = 0; b <= a; ++b) {
         double product = 0;
         for (std::size_t i = 0; i < size; ++i) {
            const std::size_t k = i % 6;
            const double e = box[(k + 1) % 3], f = box[(k + 2) % 3];
            product +=
                shape[a * size + i] * shape[b * size + i] * (k < 3 ? mass : mass / 12 * (e * e + f * f));
         }
         QVERIFY2(std::abs(product - (a == b)) < 1e-9,
                  qPrintable(QString("%1 %2: %3").arg(a).arg(b).arg(product)));
      }
   for (std::size_t i = 0; i < 6; ++i)
      QCOMPARE(shape[i], 0.0); // the clamped cell
}

/// Large enough for multigrid and for threads.
void SolverBondsModesTest::largeBlocksGiveTheSameBitsOnAnyThreads()
{
   std::vector<double> value[2];
   for (const int threads : {1, 2}) {
      HandScene scene(1e-2);
      scene.analysis = "modes";
      scene.addMaterial({{"density", 1100}, {"youngs_modulus", 5e6}, {"poisson_ratio", 0.3}});
      scene.addBlock(10, 10, 12);
      scene.link();
      for (const auto &[at, cell] : scene.at)
         if (at[2] == 0)
            scene.fix(cell);
      Run run(scene, {.modes = 3}, threads);
      QVERIFY2(run.to(0) == DIATOM_OK, run.host.said.c_str());
      value[threads - 1] = run.read("eigenvalue");
   }
   QVERIFY(value[0] == value[1]);
   QVERIFY(std::abs(value[0][0] / value[0][1] - 1) < 1e-6); // x and y are alike
   QVERIFY(value[0][0] > 0 && value[0][2] > value[0][1]);
}

void SolverBondsModesTest::floatingPartsUnderLoadAreRefused()
{
   HandScene scene(1e-2);
   scene.analysis = "modes";
   scene.addMaterial({{"density", 1100}, {"youngs_modulus", 5e6}, {"poisson_ratio", 0.3}});
   scene.addBlock(3, 1, 1);
   scene.link();
   scene.effects = {"rotation", "gravity"};
   scene.addRow("gravity", {0, 0, -9.81});
   Run run(scene);
   QCOMPARE(run.to(0), DIATOM_BAD_INPUT);
   QVERIFY2(run.host.said.find("is free to move along x while") != std::string::npos, run.host.said.c_str());
}

void SolverBondsModesTest::moreModesThanFreedomsGiveAllOfThem()
{
   HandScene scene(1e-2);
   scene.analysis = "modes";
   scene.addMaterial({{"density", 1100}, {"youngs_modulus", 5e6}, {"poisson_ratio", 0.3}});
   scene.addBlock(2, 1, 1);
   scene.link();
   scene.fix(0);
   Run run(scene, {.modes = 50});
   QVERIFY2(run.to(0) == DIATOM_OK, run.host.said.c_str());
   const auto value = run.read("eigenvalue");
   QCOMPARE(value.size(), 6u);
   const double mass = 1100 * 1e-6, stretch = 5e6 * 1e-2 / mass; // one of them is k / m along the bond
   QVERIFY(
       std::any_of(value.begin(), value.end(), [&](double v) { return std::abs(v / stretch - 1) < 1e-9; }));
}

QTEST_APPLESS_MAIN(SolverBondsModesTest)
#include "solver_bonds_modes_test.moc"
