// The bond alone: forces and torques against reference values, the invariants, and the energy they are the
// gradient of.
#include "model/constants.h"
#include "solver_bonds_reference.h"
#include "support/support.h"

#include <random>

using namespace bonds;
using diatom::test::readReference;
using nlohmann::json;

namespace {

Vec3 vector(const json &v) { return {v[0], v[1], v[2]}; }
Quat quaternion(const json &q) { return {q[3], q[0], q[1], q[2]}; } // files have x y z w

/// The half bond of a cell with the file's fifteen constants, bond along `axis`.
HalfBond half(const json &k, int axis)
{
   const std::string names = "xyz";
   const auto y = static_cast<std::size_t>((axis + 1) % 3), z = static_cast<std::size_t>((axis + 2) % 3);
   const auto n = static_cast<std::size_t>(axis);
   HalfBond out;
   out.axial = k.at("axial")[n];
   out.torsion = k.at("torsion")[n];
   out.shear[0] = k.at("shear").at({names[n], names[y]});
   out.shear[1] = k.at("shear").at({names[n], names[z]});
   out.bending[0] = k.at("bending")[y];
   out.bending[1] = k.at("bending")[z];
   return out;
}

Vec3 permuted(Vec3 v, int axis)
{
   return axis == 0 ? v : axis == 1 ? Vec3{v.y, v.z, v.x} : Vec3{v.z, v.x, v.y};
}
Quat permuted(Quat q, int axis)
{
   const Vec3 v = permuted(vec(q), axis);
   return {q.w, v.x, v.y, v.z};
}

/// As long as 1, anisotropic, and unlike at its two ends.
BondConstants steppedBond()
{
   BondConstants k;
   const double stiffness[3] = {1, 0.3, 0.5}, turning[3] = {0.08, 0.02, 0.15};
   std::copy_n(stiffness, 3, k.k);
   std::copy_n(turning, 3, k.c);
   k.s[0] = k.turn[0] = 0.2;
   k.s[1] = k.turn[1] = -0.1;
   return k;
}

struct Result
{
   Vec3 f1, t1, f2, t2;
   double power = 0;
};

/// Evaluates in bond axes and turns the answer back to the world.
template<bool Damped, bool Exact>
Result bond(const BondConstants &k, int axis, double l, Ends world)
{
   Ends ends;
   ends.separation = permuted(world.separation, axis);
   ends.qa = permuted(world.qa, axis);
   ends.qb = permuted(world.qb, axis);
   ends.dv = permuted(world.dv, axis);
   ends.wa = permuted(world.wa, axis);
   ends.wb = permuted(world.wb, axis);
   BondForces f;
   evaluate<Damped, true, Exact ? Law::exact : Law::simple>(ends, k, {l, 0, 0}, {}, f);
   const int back = (3 - axis) % 3;
   return {permuted(f.force, back), permuted(f.torqueA, back), permuted(-f.force, back),
           permuted(f.torqueB, back), f.power};
}

double largest(Vec3 a, Vec3 b)
{
   return std::max(
       {std::abs(a.x), std::abs(a.y), std::abs(a.z), std::abs(b.x), std::abs(b.y), std::abs(b.z)});
}

constexpr double kNoInertia[3] = {1, 1, 1};
constexpr Beam kBeams[] = {Beam::thesis, Beam::timoshenko, Beam::euler};

} // namespace

class SolverBondsKernelTest : public QObject
{
   Q_OBJECT
private slots:
   void forcesAreThoseOfTheReference();
   void invariantsHoldInEveryConfiguration();
   void forcesAreTheGradientOfTheEnergy();
   void aChangeOfRestShapeGainsTheDifferenceOfEnergies();
   void workAroundAClosedLoopVanishes();
   void steppedBeamIsExactForUnlikeHalves();
   void aSteppedBondThatOnlyBendsKeepsItsLength();
   void givenDampingsInProportionToStiffnessesStaySo();
   void torsionConstantOfASquareIsSaintVenants();
};

/// c01-single-bond: values from an energy gradient checked with 50 digits. Own variant 1e-11 (README); states
/// that do not deform leave rounding of k l. "linear" rows are first order: 1e-5 as the file says.
void SolverBondsKernelTest::forcesAreThoseOfTheReference()
{
   DIATOM_NEEDS_SHARED();
   const json file = readReference("c01-single-bond.json");
   const double l = file.at("lattice").at("pitch");
   int compared = 0;
   for (const json &s : file.at("scenarios")) {
      const int axis = s.at("axis").get<std::string>()[0] - 'x';
      const HalfBond a = half(s.at("cell1").at("k"), axis), b = half(s.at("cell2").at("k"), axis);
      const json &state = s.at("state");
      const Ends ends{vector(state.at("x2")) - vector(state.at("x1")),
                      quaternion(state.at("q1_xyzw")),
                      quaternion(state.at("q2_xyzw")),
                      {},
                      {},
                      {}};
      for (int model = 0; model < 3; ++model) {
         const BondConstants k = compose(a, b, l, kBeams[model], false, 1, kNoInertia);
         for (const auto &[variant, expected] :
              s.at("expected").at(std::string(1, char('a' + model))).items()) {
            const bool simple = variant == "mid_simple";
            if (variant != "mid" && variant != "linear" && !simple)
               continue;
            const Result r =
                simple ? bond<false, false>(k, axis, l, ends) : bond<false, true>(k, axis, l, ends);
            const Vec3 f1 = vector(expected.at("F1")), f2 = vector(expected.at("F2"));
            const Vec3 t1 = vector(expected.at("T1")), t2 = vector(expected.at("T2"));
            const double tolerance = variant == "linear" ? 1e-5 : 1e-11, floor = 1e-13 * k.k[0] * l;
            const double force = largest(r.f1 - f1, r.f2 - f2), torque = largest(r.t1 - t1, r.t2 - t2);
            const std::string where =
                s.at("name").get<std::string>() + " " + char('a' + model) + " " + variant;
            QVERIFY2(force <= tolerance * largest(f1, f2) + floor, where.c_str());
            QVERIFY2(torque <= tolerance * largest(t1, t2) + floor * l, where.c_str());
            ++compared;
         }
      }
   }
   QVERIFY(compared >= 90); // 20 scenarios, 3 models, one or two variants each
}

/// c01-bond-invariants: tolerances are the file's own; positions lie 100 l from the origin, which costs
/// digits.
void SolverBondsKernelTest::invariantsHoldInEveryConfiguration()
{
   DIATOM_NEEDS_SHARED();
   const json file = readReference("c01-bond-invariants.json");
   const double l = file.at("lattice").at("pitch");
   for (const json &c : file.at("configurations")) {
      const int axis = c.at("axis").get<std::string>()[0] - 'x';
      BondConstants k = compose(half(file.at("cell1").at("k"), axis), half(file.at("cell2").at("k"), axis), l,
                                Beam::timoshenko, true, 1, kNoInertia);
      for (int i = 0; i < 3; ++i) { // "damping": d15_like_k
         k.d[i] = k.k[i] / 100;
         k.e[i] = k.c[i] / 100;
      }
      const Vec3 separation = vector(c.at("x2")) - vector(c.at("x1"));
      Ends ends{separation,
                quaternion(c.at("q1")),
                quaternion(c.at("q2")),
                vector(c.at("v2")) - vector(c.at("v1")),
                vector(c.at("w1")),
                vector(c.at("w2"))};
      const Result r = bond<true, true>(k, axis, l, ends);
      const double scale = largest(r.t1, r.t2) + l * largest(r.f1, r.f2);
      QVERIFY(largest(r.t1 + r.t2 + cross(separation, r.f2), {}) <= 1e-12 * scale);
      QVERIFY(r.power >= 0);
      // What damping takes out of the motion is what it says it takes.
      Ends still = ends;
      still.dv = still.wa = still.wb = {};
      const Result e = bond<true, true>(k, axis, l, still);
      const double taken =
          -(dot(r.f2 - e.f2, ends.dv) + dot(r.t1 - e.t1, ends.wa) + dot(r.t2 - e.t2, ends.wb));
      QVERIFY(std::abs(taken - r.power) <= 1e-9 * r.power);

      const Mat3 turn = matrix(quaternion(c.at("Q")));
      const Quat q = quaternion(c.at("Q"));
      const Ends turned{turn * separation, q * ends.qa,    q * ends.qb,
                        turn * ends.dv,    turn * ends.wa, turn * ends.wb};
      const Result t = bond<true, true>(k, axis, l, turned);
      QVERIFY(largest(t.f1 - turn * r.f1, {}) <= 1e-7 * largest(r.f1, {}));
      QVERIFY(largest(t.t1 - turn * r.t1, t.t2 - turn * r.t2) <= 1e-7 * scale);

      Ends flipped = ends; // q and -q are one rotation
      flipped.qb = {-ends.qb.w, -ends.qb.x, -ends.qb.y, -ends.qb.z};
      QVERIFY(largest(bond<true, true>(k, axis, l, flipped).f1 - r.f1, {}) <= 1e-13 * largest(r.f1, {}));

      // Rigid spin: neither force nor torque, elastic or damping.
      const Vec3 omega{0.3, -1.2, 2.0};
      const Vec3 along = turn * permuted(Vec3{l, 0, 0}, (3 - axis) % 3);
      const Result spin = bond<true, true>(k, axis, l, {along, q, q, cross(omega, along), omega, omega});
      QVERIFY(largest(spin.f1, spin.f2) <= 1e-12 * k.k[0] * l);
      QVERIFY(largest(spin.t1, spin.t2) <= 1e-12 * k.k[0] * l * l);
   }
}

/// Central differences of the energy over random states up to 2.6 rad, anisotropic and stepped. Step 1e-6 of
/// l and rad: the differences are good to about 1e-9 of the largest force, which is the tolerance times ten.
void SolverBondsKernelTest::forcesAreTheGradientOfTheEnergy()
{
   std::mt19937_64 random(20240611);
   std::uniform_real_distribution<double> unit(-1, 1);
   const auto any = [&] { return Vec3{unit(random), unit(random), unit(random)}; };
   const BondConstants k = steppedBond();
   for (int trial = 0; trial < 200; ++trial) {
      const Quat qa = exponential(2.0 * any());
      const Quat qb = qa * exponential(1.5 * any());
      const Vec3 separation = matrix(qa) * (Vec3{1, 0, 0} + 0.2 * any());
      const Ends ends{separation, qa, qb, {}, {}, {}};
      BondForces f;
      evaluate<false, true, Law::exact>(ends, k, {1, 0, 0}, {}, f);
      const double h = 1e-6;
      for (int axis = 0; axis < 3; ++axis) {
         const Vec3 e{axis == 0 ? h : 0, axis == 1 ? h : 0, axis == 2 ? h : 0};
         const auto energy = [&](const Ends &at) { return bondEnergy(relate(at), k, {1, 0, 0}, {}); };
         const auto slope = [&](const Ends &plus, const Ends &minus) {
            return -(energy(plus) - energy(minus)) / (2 * h);
         };
         const double parts[3] = {
             slope({separation - e, qa, qb, {}, {}, {}}, {separation + e, qa, qb, {}, {}, {}}),
             slope({separation, exponential(e) * qa, qb, {}, {}, {}},
                   {separation, exponential(-e) * qa, qb, {}, {}, {}}),
             slope({separation, qa, exponential(e) * qb, {}, {}, {}},
                   {separation, qa, exponential(-e) * qb, {}, {}, {}})};
         const auto of = [&](Vec3 v) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; };
         QVERIFY2(std::abs(parts[0] - of(f.force)) < 1e-8, qPrintable(QString::number(trial)));
         QVERIFY2(std::abs(parts[1] - of(f.torqueA)) < 1e-8, qPrintable(QString::number(trial)));
         QVERIFY2(std::abs(parts[2] - of(f.torqueB)) < 1e-8, qPrintable(QString::number(trial)));
      }
   }
}

/// Energies of random states and rest shapes, stepped and anisotropic, exact and small turns: 1e-13 of the
/// larger one is their rounding. A change of 1e-9 of the length, whose difference of energies is mostly
/// rounding, keeps its digits against the slope.
void SolverBondsKernelTest::aChangeOfRestShapeGainsTheDifferenceOfEnergies()
{
   std::mt19937_64 random(20261128);
   std::uniform_real_distribution<double> unit(-1, 1);
   const auto any = [&] { return Vec3{unit(random), unit(random), unit(random)}; };
   const BondConstants k = steppedBond();
   for (int trial = 0; trial < 400; ++trial) {
      Ends ends{{}, exponential(0.4 * any()), exponential(0.4 * any()), {}, {}, {}, 1};
      ends.separation = Vec3{1, 0, 0} + 0.2 * any();
      const Relation r = trial % 2 ? relate(ends) : relateSmall(ends);
      using Shape = std::array<Vec3, 2>;
      const Shape from{Vec3{1, 0, 0} + 0.1 * any(), 0.3 * any()};
      const Shape to{Vec3{1, 0, 0} + 0.1 * any(), trial % 4 < 2 ? from[1] : 0.3 * any()};
      const double before = bondEnergy(r, k, from[0], from[1]), after = bondEnergy(r, k, to[0], to[1]);
      QVERIFY2(std::abs(energyGain(r, k, from, to) - (after - before)) < 1e-13 * std::max(before, after),
               qPrintable(QString::number(trial)));
      const Vec3 d = ownSeparation(r, k, r.phi - from[1]) - from[0];
      const Shape near{from[0] + Vec3{1e-9, 0, 0}, from[1]};
      const double by = near[0].x - from[0].x, slope = -k.k[0] * d.x * by;
      QVERIFY(std::abs(energyGain(r, k, from, near) - (slope + 0.5 * k.k[0] * by * by)) < 1e-23);
   }
}

/// The loop of c01-bond-invariants: the exact form gives nothing (1e-9 of the energy scale, the
/// file's bar), the simple form the 39 % that
/// the file states (4000 points each; the ratio to 1e-3).
void SolverBondsKernelTest::workAroundAClosedLoopVanishes()
{
   DIATOM_NEEDS_SHARED();
   const json file = readReference("c01-bond-invariants.json");
   const double l = file.at("lattice").at("pitch"), scale = file.at("loop").at("scale_energy");
   const BondConstants k = compose(half(file.at("cell1").at("k"), 0), half(file.at("cell2").at("k"), 0), l,
                                   Beam::timoshenko, false, 1, kNoInertia);
   const auto at = [&](double s) {
      const double c = 2 * 3.14159265358979323846 * s;
      Ends ends;
      ends.qb = exponential({0.3 * std::sin(c), 0.6 * (1 - std::cos(c)), 0.5 * std::sin(c)});
      ends.separation = {l + 0.05 * l * std::sin(c), 0.1 * l * (1 - std::cos(c)), 0.08 * l * std::sin(c)};
      return ends;
   };
   double exact = 0, simple = 0;
   const int points = 4000; // the midpoint rule of a smooth loop is exact to rounding
   for (int i = 0; i < points; ++i) {
      const double twoPi = 2 * 3.14159265358979323846, c = twoPi * (i + 0.5) / points, dc = twoPi / points;
      const Ends middle = at((i + 0.5) / points);
      const Vec3 step = (l * dc) * Vec3{0.05 * std::cos(c), 0.1 * std::sin(c), 0.08 * std::cos(c)};
      const Vec3 theta{0.3 * std::sin(c), 0.6 * (1 - std::cos(c)), 0.5 * std::sin(c)};
      const Vec3 rate = dc * Vec3{0.3 * std::cos(c), 0.6 * std::sin(c), 0.5 * std::cos(c)};
      const double x = norm(theta); // spin of exp(theta): the left Jacobian of the rotation vector
      const Vec3 turn = rate + (1 - std::cos(x)) / (x * x) * cross(theta, rate) +
                        (x - std::sin(x)) / (x * x * x) * cross(theta, cross(theta, rate));
      const Result e = bond<false, true>(k, 0, l, middle), s = bond<false, false>(k, 0, l, middle);
      exact += dot(e.f2, step) + dot(e.t2, turn);
      simple += dot(s.f2, step) + dot(s.t2, turn);
   }
   QVERIFY2(std::abs(exact) < 1e-9 * scale, qPrintable(QString::number(exact / scale)));
   const double expected = file.at("loop").at("ratio_mid_simple");
   QVERIFY2(std::abs(std::abs(simple) / scale - expected) < 1e-3,
            qPrintable(QString::number(simple / scale)));
}

/// bond-model.md, "Timoshenko for free": the compliance of two unlike half beams joined end to end, to
/// rounding. End a is held; a force V and a moment M act on end b.
void SolverBondsKernelTest::steppedBeamIsExactForUnlikeHalves()
{
   const double l = 1e-3;
   for (const double ratio : {1.0, 0.1, 30.0, 1e4}) {
      const HalfBond a = fromModulus(1e6, 0.3, l, l, l), b = fromModulus(1e6 * ratio, 0.2, l, l, l);
      const BondConstants k = compose(a, b, l, Beam::timoshenko, true, 1, kNoInertia);
      const auto half = [&](const HalfBond &h) { // tip compliance of a cantilever of length l/2
         const double length = l / 2, ei = h.bending[1] * l, ga = h.shear[0] * l;
         return std::array<double, 3>{length * length * length / (3 * ei) + length / ga,
                                      length * length / (2 * ei), length / ei};
      };
      const auto ha = half(a), hb = half(b);
      const double arm = l / 2;                                              // from the joint to b
      const double uv = ha[0] + 2 * arm * ha[1] + arm * arm * ha[2] + hb[0]; // displacement by V
      const double um = ha[1] + arm * ha[2] + hb[1];                         // displacement by M, turn by V
      const double tm = ha[2] + hb[2];                                       // turn by M
      // Linear bond: strain u - (l/2 - s) theta by force V; conjugate moment M - ... follows from the energy.
      const double lever = l / 2 - k.s[0];
      const double bondUv = 1 / k.k[1] + lever * lever / k.c[2], bondUm = lever / k.c[2], bondTm = 1 / k.c[2];
      QVERIFY(std::abs(bondUv / uv - 1) < 1e-12);
      QVERIFY(std::abs(bondUm / um - 1) < 1e-12);
      QVERIFY(std::abs(bondTm / tm - 1) < 1e-12);
   }
}

/// The halves of a stepped bond are arcs, one of them almost straight: a moment turns the ends against each
/// other and pulls them together by a twelfth of the square of the turn at most, never apart. The law has
/// none of that, to rounding, for turns up to 2 rad: without force the ends are as far apart as at rest.
/// Where they then are is the exact beam's place to second order: the softer half's chord, with all the turn
/// in that half, points where half the turn says.
void SolverBondsKernelTest::aSteppedBondThatOnlyBendsKeepsItsLength()
{
   const double l = 1e-3;
   const HalfBond stiff = fromModulus(1e9, 0.3, l, l, l), soft = fromModulus(1e5, 0.3, l, l, l);
   const BondConstants k = compose(stiff, soft, l, Beam::timoshenko, true, 1, kNoInertia);
   for (const double turn : {0.01, 0.1, 0.5, 2.0}) {
      // Without force the separation lies along the stepped bond's own frame.
      Ends ends;
      ends.qb = exponential({0, 0, turn});
      const Relation r = relate(ends);
      const Vec3 along = Step(k, r.phi).back({l, 0, 0});
      ends.separation = r.middle * along;
      BondForces f;
      evaluate<false, true, Law::exact>(ends, k, {l, 0, 0}, {}, f);
      const double size = k.c[2] * turn / l;
      QVERIFY(norm(f.force) < 1e-12 * (size + k.k[0] * l));
      QVERIFY(std::abs(norm(ends.separation) / l - 1) < 1e-15);
      QVERIFY(std::abs(f.torqueA.z - k.c[2] * turn) < 1e-12 * k.c[2] * turn + 1e-12 * k.k[0] * l * l);
      // All the turn in the softer half: the first half is straight, the second's chord is turned by half of
      // it.
      const double direction = std::atan2(0.5 * std::sin(turn / 2), 0.5 + 0.5 * std::cos(turn / 2));
      QVERIFY(std::abs(std::atan2(ends.separation.y, ends.separation.x) - direction) <
              0.02 * turn * turn * turn + 1e-4 * turn);
   }
}

/// Dampings that are 0.01 s times the stiffnesses of either half are so for the bond, whatever the beam
/// theory and the step: to rounding.
void SolverBondsKernelTest::givenDampingsInProportionToStiffnessesStaySo()
{
   const double l = 1e-3, beta = 0.01;
   for (const Beam beam : kBeams)
      for (const bool stepped : {false, true}) {
         HalfBond a = fromModulus(1e6, 0.3, l, l, l), b = fromModulus(3e7, 0.1, l, l, l);
         for (HalfBond *half : {&a, &b}) {
            half->ownDamping = true;
            half->damping = *half;
            half->damping.axial *= beta;
            half->damping.torsion *= beta;
            for (int i = 0; i < 2; ++i) {
               half->damping.shear[i] *= beta;
               half->damping.bending[i] *= beta;
            }
         }
         const BondConstants k = compose(a, b, l, beam, stepped, 1, kNoInertia);
         for (int i = 0; i < 3; ++i) {
            QVERIFY(std::abs(k.d[i] / (beta * k.k[i]) - 1) < 1e-12);
            QVERIFY(std::abs(k.e[i] / (beta * k.c[i]) - 1) < 1e-12);
         }
      }
}

/// Timoshenko and Goodier, table in article 109: 0.1406 a^4 for a square, 0.229 a b^3 for 2:1 (to the digits
/// printed). The square also by the double Fourier series of the stress function, 256/pi^6 sum 1/(m^2 n^2
/// (m^2 + n^2)) over odd m and n, whose part beyond 2000 is 2e-11.
void SolverBondsKernelTest::torsionConstantOfASquareIsSaintVenants()
{
   QVERIFY(std::abs(torsionConstant(1, 1) - 0.1406) < 5e-5);
   QVERIFY(std::abs(torsionConstant(2, 1) / 2 - 0.229) < 5e-4);
   const double pi = 3.14159265358979323846;
   double sum = 0;
   for (int m = 1999; m > 0; m -= 2)
      for (int n = 1999; n > 0; n -= 2)
         sum += 1 / (double(m) * m * n * n * (double(m) * m + double(n) * n));
   QVERIFY(std::abs(torsionConstant(1, 1) - 256 / std::pow(pi, 6) * sum) < 1e-10);
}

QTEST_APPLESS_MAIN(SolverBondsKernelTest)
#include "solver_bonds_kernel_test.moc"
