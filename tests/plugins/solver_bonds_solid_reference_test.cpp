// What blocks and solids are worth beside the solids they stand for: closed forms, and the free cube of case
// c04.
#include "plugins/solver_bonds_solid.h"

#include <nlohmann/json.hpp>

#include <fstream>

using namespace bonds;
using namespace diatom::test;

namespace {

constexpr double kE = 5e6, kEdge = 0.01;

HandScene block(int nx, int ny, int nz, double nu, double model = 2)
{
   HandScene scene(kEdge);
   scene.addMaterial(solidMaterial(nu, kE, 0, model));
   scene.addBlock(nx, ny, nz);
   scene.link();
   scene.effects = {"rotation", "solid"};
   return scene;
}

/// Cells of a block of one material.
struct Grid
{
   int n[3];
   int cell(int x, int y, int z) const { return (x * n[1] + y) * n[2] + z; }
   template<typename F>
   void each(F f) const
   {
      for (int x = 0; x < n[0]; ++x)
         for (int y = 0; y < n[1]; ++y)
            for (int z = 0; z < n[2]; ++z)
               f(cell(x, y, z), std::array<int, 3>{x, y, z});
   }
};

/// Loads of a uniform stress (xx yy zz yz zx xy) on the outer faces of a block, at the centres of the faces.
Vector tractions(const Grid &grid, const std::array<double, 6> &stress)
{
   Vector out = Vector::Zero(6 * grid.n[0] * grid.n[1] * grid.n[2]);
   Eigen::Matrix3d s;
   s << stress[0], stress[5], stress[4], stress[5], stress[1], stress[3], stress[4], stress[3], stress[2];
   grid.each([&](int cell, std::array<int, 3> at) {
      for (int axis = 0; axis < 3; ++axis)
         for (const int side : {-1, 1}) {
            if (at[axis] != (side < 0 ? 0 : grid.n[axis] - 1))
               continue;
            const Eigen::Vector3d normal = side * Eigen::Vector3d::Unit(axis);
            const Eigen::Vector3d force = kEdge * kEdge * s * normal;
            out.segment<3>(6 * cell) += force;
            out.segment<3>(6 * cell + 3) += (kEdge / 2 * normal).cross(force);
         }
   });
   return out;
}

/// A free block's answer to loads that balance: the first cell is held, and its supports have nothing to do.
Vector answer(const SolidModel &model, const Vector &load)
{
   Vector rest = load;
   Eigen::SparseMatrix<double> k = model.stiffness(model.state);
   std::vector<bool> held(static_cast<std::size_t>(load.size()), false);
   std::fill_n(held.begin(), 6, true);
   SolidModel::hold(held, k, rest);
   return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(k).solve(rest);
}

/// Displacement of `axis` per metre between two cells.
double slope(const Vector &u, int a, int b, int axis, int steps)
{
   return (u[6 * b + axis] - u[6 * a + axis]) / (steps * kEdge);
}

} // namespace

class SolverBondsSolidReferenceTest : public QObject
{
   Q_OBJECT
private slots:
   void uniaxialStressIsMet_data();
   void uniaxialStressIsMet();
   void uniformShearIsMetExactly();
   void pressureFindsTheBulkModulus();
   void bendingMomentsFindTheirCurvature_data();
   void bendingMomentsFindTheirCurvature();
   void cantileverBlockSagsAsASolid_data();
   void cantileverBlockSagsAsASolid();
   void twistedBarFindsSaintVenantsConstant();
   void freeCubeVibratesAsTheSolid_data();
   void freeCubeVibratesAsTheSolid();
   void solidsAndBondsMixInOneScene();
   void largeRotationsKeepTheAnswer();
};

void SolverBondsSolidReferenceTest::uniaxialStressIsMet_data()
{
   QTest::addColumn<double>("nu");
   QTest::addColumn<int>("axis");
   QTest::addColumn<double>("model");
   for (const double nu : {0.0, 0.3, 0.45, -0.5})
      for (const int axis : {0, 1, 2})
         QTest::newRow(qPrintable(QString("nu %1 along %2").arg(nu).arg(axis))) << nu << axis << 2.0;
   QTest::newRow("bonds with the effect poisson") << 0.35 << 0 << 0.0;
}

/// Strain sigma / E along and -nu times that across. Loads enter at the centres of the end cells, whose outer
/// halves hold the sides as an unstressed plate would: in the middle, two widths from both ends, that has
/// died away to less than 5e-3 (Saint-Venant's principle).
void SolverBondsSolidReferenceTest::uniaxialStressIsMet()
{
   QFETCH(double, nu);
   QFETCH(int, axis);
   QFETCH(double, model);
   int n[3] = {3, 3, 3};
   n[axis] = 13;
   const Grid grid{{n[0], n[1], n[2]}};
   HandScene scene = block(n[0], n[1], n[2], nu, model);
   if (model == 0)
      scene.effects = {"rotation", "poisson"};
   const SolidModel solid(scene);
   std::array<double, 6> stress{};
   stress[static_cast<std::size_t>(axis)] = 1000;
   const Vector u = answer(solid, tractions(grid, stress));
   for (int k = 0; k < 3; ++k) {
      int from[3] = {1, 1, 1}, to[3] = {1, 1, 1};
      from[axis] = to[axis] = 6;
      from[k] -= 1;
      to[k] += 1;
      const double strain =
          slope(u, grid.cell(from[0], from[1], from[2]), grid.cell(to[0], to[1], to[2]), k, 2);
      const double expected = 1000 / kE * (k == axis ? 1 : -nu);
      QVERIFY2(std::abs(strain - expected) < 5e-3 * 1000 / kE,
               qPrintable(QString("%1: %2 %3").arg(k).arg(strain).arg(expected)));
   }
}

/// Tractions of the six faces at the faces, that is with their moments about the outer cells' centres.
void SolverBondsSolidReferenceTest::uniformShearIsMetExactly()
{
   const double nu = 0.3, g = kE / 2 / (1 + nu);
   const Grid grid{{3, 4, 5}};
   for (const double model : {1.0, 2.0}) {
      HandScene scene = block(3, 4, 5, nu, model);
      const SolidModel solid(scene);
      const Vector u = answer(solid, tractions(grid, {0, 0, 0, 0, 0, 1000}));
      const double strain = slope(u, grid.cell(0, 0, 0), grid.cell(0, 3, 0), 0, 3) +
                            slope(u, grid.cell(0, 0, 0), grid.cell(2, 0, 0), 1, 2);
      QVERIFY2(std::abs(strain * g / 1000 - 1) < 1e-10, qPrintable(QString::number(strain * g / 1000)));
   }
}

/// Pressure acts at the centres of the outer cells, whose outer halves take their faces for free: right on
/// the whole, but by 9 % uneven inside a cube of 8 (by 6 % in one of 12).
void SolverBondsSolidReferenceTest::pressureFindsTheBulkModulus()
{
   const double nu = 0.3;
   const Grid grid{{8, 8, 8}};
   HandScene scene = block(8, 8, 8, nu);
   const SolidModel model(scene);
   const Vector u = answer(model, tractions(grid, {-1000, -1000, -1000, 0, 0, 0}));
   const double expected = -1000 * (1 - 2 * nu) / kE;
   const double inside = slope(u, grid.cell(3, 4, 4), grid.cell(4, 4, 4), 0, 1) / expected;
   const double whole = slope(u, grid.cell(0, 4, 4), grid.cell(7, 4, 4), 0, 7) / expected;
   qInfo("strain under pressure over the solid's: %.4f inside, %.4f overall", inside, whole);
   QVERIFY(std::abs(whole - 1) < 0.02);
   QVERIFY(std::abs(inside - 1) < 0.1);
}

void SolverBondsSolidReferenceTest::bendingMomentsFindTheirCurvature_data()
{
   QTest::addColumn<double>("nu");
   for (const double nu : {0.0, 0.3, 0.45})
      QTest::newRow(qPrintable(QString("nu %1").arg(nu))) << nu;
}

/// A square bar under the stresses of pure bending at its ends: curvature M / EI in the middle. Exact in
/// single file and without a Poisson ratio. A cell at a face knows its strain across from one side alone,
/// half a cell further in, which stiffens a bar of 4 cells by 2 % at nu = 0.3 and by 5 % at 0.45; 6 cells do
/// better.
void SolverBondsSolidReferenceTest::bendingMomentsFindTheirCurvature()
{
   QFETCH(double, nu);
   double error[7]{};
   for (const int width : {1, 2, 3, 4, 6}) {
      const int length = std::max(4 * width + 1, 9);
      const Grid grid{{length, width, width}};
      HandScene scene = block(length, width, width, nu);
      const SolidModel model(scene);
      const double curvature = 0.01, area = kEdge * kEdge;
      Vector load = Vector::Zero(6 * model.assembly.cells);
      for (int y = 0; y < width; ++y)
         for (int z = 0; z < width; ++z)
            for (const int end : {0, length - 1}) {
               const double sign = end == 0 ? -1 : 1, height = (y - 0.5 * (width - 1)) * kEdge;
               load[6 * grid.cell(end, y, z)] = -sign * kE * curvature * height * area;
               load[6 * grid.cell(end, y, z) + 5] = sign * kE * curvature * area * area / 12;
            }
      const Vector u = answer(model, load);
      const int a = length / 2 - 1, b = length / 2 + 1, m = width / 2;
      const double turn = u[6 * grid.cell(b, m, m) + 5] - u[6 * grid.cell(a, m, m) + 5];
      const double ratio = turn / (2 * kEdge) / curvature;
      qInfo("curvature of %d x %d cells over M / EI: %.5f", width, width, ratio);
      error[width] = std::abs(ratio - 1);
   }
   QVERIFY(error[1] < 1e-9);
   QVERIFY(error[4] < (nu == 0 ? 1e-9 : nu == 0.3 ? 0.025 : 0.06));
   QVERIFY(nu == 0 || error[6] < error[4]);
}

void SolverBondsSolidReferenceTest::cantileverBlockSagsAsASolid_data()
{
   QTest::addColumn<double>("nu");
   QTest::addColumn<double>("model");
   QTest::addColumn<double>("elements");
   QTest::addColumn<double>("tolerance");
   QTest::newRow("solid, nu 0") << 0.0 << 2.0 << 1.0002 << 0.01;
   QTest::newRow("solid, nu 0.3") << 0.3 << 2.0 << 0.9828 << 0.03;
   QTest::newRow("solid, nu 0.45") << 0.45 << 2.0 << 0.9570 << 0.08;
   QTest::newRow("block, nu 0.3") << 0.3 << 1.0 << 0.9828 << 0.03;
}

/// 4 x 4 x 16 cells with a shear force at the end. `elements` is what CalculiX 2.20 finds with 33 x 4 x 4
/// C3D20 between the clamped plane of the first cells' centres and the free end, over Timoshenko's beam with
/// Cowper's coefficient for a rectangle (Journal of Applied Mechanics 33, 1966), 10 (1 + nu) / (12 + 11 nu),
/// which knows nothing of the clamp's hold on the sides. The bending test says why nu = 0.45 comes out 7 %
/// stiff.
void SolverBondsSolidReferenceTest::cantileverBlockSagsAsASolid()
{
   QFETCH(double, nu);
   QFETCH(double, model);
   QFETCH(double, elements);
   QFETCH(double, tolerance);
   const Grid grid{{17, 4, 4}};
   HandScene scene = block(17, 4, 4, nu, model);
   const SolidModel solid(scene);
   Vector load = Vector::Zero(6 * solid.assembly.cells);
   std::vector<bool> held(static_cast<std::size_t>(load.size()), false);
   for (int y = 0; y < 4; ++y)
      for (int z = 0; z < 4; ++z) {
         std::fill_n(held.begin() + 6 * grid.cell(0, y, z), 6, true);
         load[6 * grid.cell(16, y, z) + 2] = 1e-3;
      }
   Eigen::SparseMatrix<double> k = solid.stiffness(solid.state);
   Vector rest = load;
   SolidModel::hold(held, k, rest);
   const Vector u = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(k).solve(rest);
   const double width = 4 * kEdge, span = 16 * kEdge, inertia = std::pow(width, 4) / 12;
   const double shear = 10 * (1 + nu) / (12 + 11 * nu) * kE / 2 / (1 + nu) * width * width;
   const double expected = 16e-3 * (span * span * span / (3 * kE * inertia) + span / shear);
   const double ratio = u[6 * grid.cell(16, 1, 1) + 2] / (expected * elements);
   qInfo("sag over the solid elements': %.4f", ratio);
   QVERIFY(std::abs(ratio - 1) < tolerance);
}

/// A square bar 6 cells wide: 0.1406 a^4 (Timoshenko and Goodier, Theory of Elasticity, article 109). Couples
/// at the ends as Saint-Venant has them would be fields; a single couple of moments decays within a width.
void SolverBondsSolidReferenceTest::twistedBarFindsSaintVenantsConstant()
{
   const double nu = 0.3, g = kE / 2 / (1 + nu);
   for (const int width : {2, 4, 6}) {
      const int length = 4 * width;
      const Grid grid{{length, width, width}};
      HandScene scene = block(length, width, width, nu);
      const SolidModel model(scene);
      Vector load = Vector::Zero(6 * model.assembly.cells);
      double couple = 0;
      for (int y = 0; y < width; ++y)
         for (int z = 0; z < width; ++z) {
            const double dy = (y - 0.5 * (width - 1)) * kEdge, dz = (z - 0.5 * (width - 1)) * kEdge;
            for (const int end : {0, length - 1}) {
               const double sign = end == 0 ? -1 : 1;
               load[6 * grid.cell(end, y, z) + 1] = -sign * dz;
               load[6 * grid.cell(end, y, z) + 2] = sign * dy;
            }
            couple += dy * dy + dz * dz;
         }
      const Vector u = answer(model, load);
      const int a = length / 2 - width / 2, b = length / 2 + width / 2, m = width / 2;
      const auto turn = [&](int x) { // of the section, by its outer cells
         return (u[6 * grid.cell(x, width - 1, m) + 2] - u[6 * grid.cell(x, 0, m) + 2]) /
                ((width - 1) * kEdge);
      };
      const double rate = (turn(b) - turn(a)) / (width * kEdge);
      const double constant = couple / rate / g / std::pow(width * kEdge, 4);
      qInfo("torsion constant of %d x %d cells over Saint-Venant's: %.4f", width, width, constant / 0.140577);
      QVERIFY(std::abs(constant / 0.140577 - 1) < (width == 2 ? 0.1 : 0.03));
   }
}

void SolverBondsSolidReferenceTest::freeCubeVibratesAsTheSolid_data()
{
   QTest::addColumn<double>("nu");
   QTest::newRow("nu 0") << 0.0;
   QTest::newRow("nu 0.3") << 0.3;
}

/// c04-free-block, within 3 % of the frequencies of quadratic solid elements: all of the first ten at nu =
/// 0.3. At nu = 0 the first six; the next four have half a wave over two cells, where the lattice of four
/// cells has waves of its own (the file's model c has the same ones).
void SolverBondsSolidReferenceTest::freeCubeVibratesAsTheSolid()
{
   DIATOM_NEEDS_SHARED();
   QFETCH(double, nu);
   std::ifstream file(sharedDir() / "validation" / "c04-free-block.json");
   const auto reference = nlohmann::json::parse(file);
   std::vector<double> expected;
   for (const auto &solid : reference.at("calculix_solid"))
      if (solid.at("nu") == nu)
         expected = solid.at("omega_rad_s").get<std::vector<double>>();
   QCOMPARE(expected.size(), std::size_t{16});
   for (const double model : {0.0, 1.0, 2.0}) {
      HandScene scene = block(4, 4, 4, nu, model);
      const SolidModel solid(scene);
      const Vector values = solid.eigenvalues(solid.state);
      QString line;
      double worst = 0;
      for (Eigen::Index i = 6; i < 16; ++i) {
         const double ratio = std::sqrt(values[i]) / expected[static_cast<std::size_t>(i)];
         if (nu > 0 || i < 12)
            worst = std::max(worst, std::abs(ratio - 1));
         line += QString(" %1").arg(ratio, 0, 'f', 4);
      }
      qInfo("model %g: frequencies over the solid's:%s", model, qPrintable(line));
      if (model == 2)
         QVERIFY2(worst < 0.03, qPrintable(line));
   }
}

/// A tall bar of single bonds on a solid block that is pressed at the top: stiffnesses in series, and a
/// moment at the top bends the bar alone as the block hardly gives.
void SolverBondsSolidReferenceTest::solidsAndBondsMixInOneScene()
{
   HandScene scene(kEdge);
   scene.addMaterial(solidMaterial(0.3, kE, 0, 2));
   scene.addMaterial(solidMaterial(0.3, kE, 0, 0));
   scene.addBlock(5, 5, 5);
   for (int z = 5; z < 15; ++z)
      scene.addCell(2, 2, z, 1);
   scene.link();
   scene.effects = {"rotation", "solid"};
   const SolidModel model(scene);
   const int top = scene.at.at({2, 2, 14}), root = scene.at.at({2, 2, 5});
   Vector load = Vector::Zero(6 * model.assembly.cells);
   load[6 * top + 2] = -0.01;
   std::vector<bool> held(static_cast<std::size_t>(load.size()), false);
   for (int x = 0; x < 5; ++x)
      for (int y = 0; y < 5; ++y)
         std::fill_n(held.begin() + 6 * scene.at.at({x, y, 0}), 6, true);
   Eigen::SparseMatrix<double> k = model.stiffness(model.state);
   Vector rest = load;
   SolidModel::hold(held, k, rest);
   Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(k);
   const Vector u = factors.solve(rest);
   const double bar = 0.01 / kE * 9 / kEdge; // nine bonds between the bar's cells
   QVERIFY(std::abs((u[6 * root + 2] - u[6 * top + 2]) / bar - 1) < 1e-10);
   // The block's middle strains sideways: in the bar above it nothing does.
   const double wide = u[6 * scene.at.at({4, 2, 2})] - u[6 * scene.at.at({0, 2, 2})];
   QVERIFY(wide > 0);
   QVERIFY(model.eigenvalues(model.state)[6] > 0);
}

/// A solid bar bent by a quarter of a circle: Newton's method on the tangent converges to rounding, and the
/// end turns as M / EI says, up to the stiffness of two cells (1 %) and to what a strain of 0.1 does: 5 %.
void SolverBondsSolidReferenceTest::largeRotationsKeepTheAnswer()
{
   const Grid grid{{17, 2, 2}};
   HandScene scene = block(17, 2, 2, 0.3);
   SolidModel model(scene);
   const double curvature = 1.5707963 / (16 * kEdge), inertia = std::pow(2 * kEdge, 4) / 12;
   Vector load = Vector::Zero(6 * model.assembly.cells);
   std::vector<bool> held(static_cast<std::size_t>(load.size()), false);
   for (int y = 0; y < 2; ++y)
      for (int z = 0; z < 2; ++z)
         std::fill_n(held.begin() + 6 * grid.cell(0, y, z), 6, true);
   double residual = 1;
   for (int part = 1; part <= 8; ++part) {
      for (int y = 0; y < 2; ++y)
         for (int z = 0; z < 2; ++z)
            load[6 * grid.cell(16, y, z) + 5] = part / 8.0 * kE * inertia * curvature / 4;
      residual = model.balance(load, held, 8);
   }
   QVERIFY2(residual < 1e-9, qPrintable(QString::number(residual)));
   const Quat q = model.state.turnOf(grid.cell(16, 0, 0));
   const double turn = 2 * std::atan2(q.z, q.w);
   qInfo("turn of the end over M L / EI: %.4f", turn / 1.5707963);
   QVERIFY(std::abs(turn / 1.5707963 - 1) < 0.05);
}

QTEST_APPLESS_MAIN(SolverBondsSolidReferenceTest)
#include "solver_bonds_solid_reference_test.moc"
