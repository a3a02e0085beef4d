// Bonds of a scene: direction and frame from the rest positions, constants from the two cells' materials as
// they are turned.
#include "model/assembly.h"
#include "model/cell_model.h"

#include <algorithm>
#include <string>

namespace bonds {

using sdk::Failure;

namespace {

/// Fifteen constants in a cell's own axes; not a number = derive.
struct GivenConstants
{
   double axial[3], shear[3][3], bending[3], torsion[3];

   /// Reads them under names that begin with `prefix`; whether any is there.
   bool read(const sdk::SceneView &scene, std::int32_t material, const std::string &prefix);
};

bool GivenConstants::read(const sdk::SceneView &scene, std::int32_t material, const std::string &prefix)
{
   const std::string axes = "xyz";
   bool any = false;
   const auto get = [&](const std::string &name) {
      const double value = scene.property(material, prefix + name);
      if (!std::isnan(value)) {
         any = true;
         if (!(value >= 0) || std::isinf(value))
            throw Failure(DIATOM_BAD_INPUT, "the constant " + prefix + name + " of material " +
                                                std::to_string(material) + " must not be negative");
      }
      return value;
   };
   for (std::size_t i = 0; i < 3; ++i) {
      axial[i] = get(std::string("axial_") + axes[i]);
      bending[i] = get(std::string("bending_") + axes[i]);
      torsion[i] = get(std::string("torsion_") + axes[i]);
      for (std::size_t j = 0; j < 3; ++j)
         shear[i][j] = i == j ? std::nan("") : get(std::string("shear_") + axes[i] + axes[j]);
   }
   return any;
}

/// Stiffness data of one material; explicit constants replace what follows from E and nu.
struct Stiffness
{
   double youngsModulus = 0, poissonRatio = 0, dampingRatio = 0;
   GivenConstants given, damping;
   bool explicitConstants = false, ownDamping = false;
   CellModel model = CellModel::bond;
};

Stiffness readStiffness(const sdk::SceneView &scene, std::int32_t material)
{
   Stiffness s;
   s.explicitConstants = s.given.read(scene, material, "");
   s.ownDamping = s.damping.read(scene, material, "damping_");
   s.youngsModulus = scene.property(material, "youngs_modulus");
   s.poissonRatio = scene.property(material, "poisson_ratio");
   const double zeta = scene.property(material, "damping_ratio");
   s.dampingRatio = std::isnan(zeta) ? 0 : zeta;
   s.model = cellModelOf(scene, material);
   if (std::isnan(s.poissonRatio))
      s.poissonRatio = 0;
   if (s.dampingRatio < 0 || s.youngsModulus < 0 || std::isinf(s.youngsModulus) || !(s.poissonRatio > -1) ||
       !(s.poissonRatio <= 0.5))
      throw Failure(DIATOM_BAD_INPUT,
                    "material " + std::to_string(material) +
                        " needs a Young's modulus and a damping ratio that are not negative and a "
                        "Poisson ratio above -1 and at most 0.5");
   return s;
}

/// Which own axis of a turned cell lies along a world direction; -1 when none does.
int ownAxis(const Mat3 &own, Vec3 world)
{
   const Vec3 v = transposed(own, world);
   const double part[3] = {std::abs(v.x), std::abs(v.y), std::abs(v.z)};
   for (int k = 0; k < 3; ++k)
      if (part[k] > 1 - 1e-9)
         return k;
   return -1;
}

void replace(double &value, double constant)
{
   if (!std::isnan(constant))
      value = constant;
}

/// Own constants of a cell whose axes n, y and z lie along those of the bond.
void replace(HalfConstants &half, const GivenConstants &given, int n, int y, int z)
{
   replace(half.axial, given.axial[n]);
   replace(half.torsion, given.torsion[n]);
   replace(half.shear[0], given.shear[n][y]);
   replace(half.shear[1], given.shear[n][z]);
   replace(half.bending[0], given.bending[y]);
   replace(half.bending[1], given.bending[z]);
}

/// The half of a bond that lies in `cell`. Constants permute for the turns of a cube; cells and bonds that
/// lie askew have constants only through E and nu, with a square section as wide as the geometric mean of the
/// cell's edges.
HalfBond halfOf(const sdk::SceneView &scene, const Stiffness &s, std::int64_t cell, const Mat3 &frame,
                double length)
{
   const double *e = scene.extent(cell), *q = scene.orientation(cell);
   const Mat3 own = matrix({q[0], q[1], q[2], q[3]});
   const int n = ownAxis(own, frame.r0), y = ownAxis(own, frame.r1), z = ownAxis(own, frame.r2);
   const bool aligned = n >= 0 && y >= 0 && z >= 0;
   if ((s.explicitConstants || s.ownDamping) && !aligned)
      throw Failure(DIATOM_UNSUPPORTED,
                    "the cell " + scene.name(cell) +
                        " has bond constants of its own but lies askew to its bonds: give its "
                        "material a Young's modulus instead, or turn it by quarter turns only");
   const double mean = std::cbrt(e[0] * e[1] * e[2]);
   HalfBond half;
   if (!std::isnan(s.youngsModulus))
      half =
          fromModulus(s.youngsModulus, s.poissonRatio, length, aligned ? e[y] : mean, aligned ? e[z] : mean);
   else if (!s.explicitConstants)
      throw Failure(DIATOM_BAD_INPUT, "the material of cell " + scene.name(cell) +
                                          " has neither a Young's modulus nor bond constants");
   half.dampingRatio = s.dampingRatio;
   if (s.explicitConstants)
      replace(half, s.given, n, y, z);
   half.ownDamping = s.ownDamping;
   if (s.ownDamping)
      replace(half.damping, s.damping, n, y, z);
   return half;
}

/// A right-handed frame with its first row along `direction`.
Mat3 frameAlong(Vec3 direction)
{
   const Vec3 helper = std::abs(direction.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
   Vec3 y = cross(helper, direction);
   y = (1 / norm(y)) * y;
   return {direction, y, cross(direction, y)};
}

struct Direction
{
   int axis = 3; // 3 = askew
   bool reversed = false;
   Vec3 unit;
   double length = 0;
};

Direction directionOf(const Assembly &cells, std::int32_t a, std::int32_t b)
{
   const Vec3 d{cells.rest[0][b] - cells.rest[0][a], cells.rest[1][b] - cells.rest[1][a],
                cells.rest[2][b] - cells.rest[2][a]};
   Direction out;
   out.length = norm(d);
   if (!(out.length > 0))
      return out;
   out.unit = (1 / out.length) * d;
   const double part[3] = {out.unit.x, out.unit.y, out.unit.z};
   for (int k = 0; k < 3; ++k)
      if (std::abs(part[k]) > 1 - 1e-12) {
         out.axis = k;
         out.reversed = part[k] < 0;
      }
   if (out.reversed)
      out.unit = -out.unit;
   return out;
}

/// Directions and lengths that the scene's bonds have. Those of a lattice are few, but the places that they
/// are taken from are rounded: bonds that differ by no more than that are made alike, so that they share
/// constants.
class Alike
{
public:
   void make(Direction &one)
   {
      for (const Direction &known : m_known)
         if (one.axis == known.axis && std::abs(one.length - known.length) <= kRounding * known.length &&
             norm(one.unit - known.unit) <= kRounding)
         {
            one.unit = known.unit;
            one.length = known.length;
            return;
         }
      if (m_known.size() < kMost)
         m_known.push_back(one);
   }

private:
   static constexpr double kRounding = 1e-9; // of places up to 10^6 cells away
   static constexpr std::size_t kMost = 256; // more are no lattice's, and would take long to compare
   std::vector<Direction> m_known;
};

double inertiaAbout(const Assembly &cells, std::int32_t cell, Vec3 axis)
{
   const Vec3 own = transposed(matrix(cells.orientation[cell]), axis);
   return cells.boxInertia[0][cell] * own.x * own.x + cells.boxInertia[1][cell] * own.y * own.y +
          cells.boxInertia[2][cell] * own.z * own.z;
}

double reduced(double a, double b) { return a * b / (a + b); }

/// The materials' part in the constants of bonds, and which cells lie around a bond.
class Compiler
{
public:
   Compiler(const sdk::SceneView &scene, const Assembly &assembly, const Options &options)
       : m_scene(scene), m_assembly(assembly), m_options(options), m_neighbours(assembly.cells)
   {
      for (std::int32_t m = 0; m < scene.materials(); ++m)
         m_materials.push_back(readStiffness(scene, m));
      for (std::int64_t i = 0; i < assembly.group[3]; ++i)
         m_neighbours.join(assembly.a[i], assembly.b[i], assembly.axisOf(i));
   }
   BondConstants constantsOf(std::int64_t bond, double length, bool &damped) const;

private:
   const Stiffness &of(std::int64_t cell) const { return m_materials[m_scene.material(cell)]; }
   bool solid(std::int64_t cell) const { return of(cell).model == CellModel::solid; }
   /// Blocks are dense because the user says so, solids where they lie in a square of four.
   bool dense(std::int64_t bond, int plane) const;

   const sdk::SceneView &m_scene;
   const Assembly &m_assembly;
   const Options &m_options;
   std::vector<Stiffness> m_materials;
   Neighbours m_neighbours;
};

bool Compiler::dense(std::int64_t bond, int plane) const
{
   const std::int64_t a = m_assembly.a[bond], b = m_assembly.b[bond];
   const auto counts = [&](std::int64_t cell) {
      return of(cell).model != CellModel::bond && !of(cell).explicitConstants;
   };
   if (!counts(a) || !counts(b))
      return false;
   if (!solid(a) || !solid(b))
      return true;
   const int axis = m_assembly.axisOf(bond);
   return axis < 3 && m_neighbours.squared(a, b, axis, (axis + 1 + plane) % 3, counts);
}

BondConstants Compiler::constantsOf(std::int64_t bond, double length, bool &damped) const
{
   const Assembly &assembly = m_assembly;
   const std::int32_t a = assembly.a[bond], b = assembly.b[bond];
   const Mat3 axes = assembly.frameOf(bond);
   const auto turning = [&](Vec3 axis) {
      return reduced(inertiaAbout(assembly, a, axis), inertiaAbout(assembly, b, axis));
   };
   HalfBond ha = halfOf(m_scene, of(a), a, axes, length), hb = halfOf(m_scene, of(b), b, axes, length);
   const bool both[2] = {dense(bond, 0), dense(bond, 1)};
   for (int plane = 0; plane < 2; ++plane) {
      if (!both[plane])
         continue;
      makeDense(ha, plane);
      makeDense(hb, plane);
      if (!both[1 - plane] && solid(a) && solid(b)) {
         twistAsPlate(ha, plane, of(a).poissonRatio);
         twistAsPlate(hb, plane, of(b).poissonRatio);
      }
   }
   damped = ha.damped() && hb.damped();
   return compose(ha, hb, length, m_options.beam, m_options.stepped,
                  reduced(assembly.mass[a], assembly.mass[b]),
                  {turning(axes.r0), turning(axes.r1), turning(axes.r2)});
}

} // namespace

void Assembly::readBonds(const sdk::SceneView &scene, const Options &options)
{
   std::vector<Direction> direction;
   Alike alike;
   for (std::int64_t i = 0; i < links; ++i) {
      const std::int32_t ca = scene.linkA(i), cb = scene.linkB(i);
      if (ca < 0 || cb < 0 || ca >= cells || cb >= cells || ca == cb)
         throw Failure(DIATOM_BAD_INPUT,
                       "link " + std::to_string(i) + " does not join two cells of the scene");
      direction.push_back(directionOf(*this, ca, cb));
      if (!(direction.back().length > 0))
         throw Failure(DIATOM_BAD_INPUT, "the cells " + scene.name(ca) + " and " + scene.name(cb) +
                                             " are joined but lie at the same place");
      alike.make(direction.back());
   }
   for (int axis = 0; axis < 4; ++axis) {
      for (std::int64_t i = 0; i < links; ++i)
         if (direction[i].axis == axis)
            link.push_back(static_cast<std::int32_t>(i));
      group[axis + 1] = static_cast<std::int64_t>(link.size());
   }
   a.resize(link.size());
   b.resize(link.size());
   for (std::int64_t i = 0; i < links; ++i) {
      const Direction &d = direction[link[i]];
      a[i] = d.reversed ? scene.linkB(link[i]) : scene.linkA(link[i]);
      b[i] = d.reversed ? scene.linkA(link[i]) : scene.linkB(link[i]);
      if (d.axis == 3)
         frame.push_back(frameAlong(d.unit));
   }
   const Compiler compiler(scene, *this, options);
   bool anyDamping = false;
   for (std::int64_t i = 0; i < links; ++i) {
      bool own = false;
      const double length = direction[link[i]].length;
      constants.push_back(compiler.constantsOf(i, length, own), length);
      coupled = coupled || constants[i].s[0] != 0 || constants[i].s[1] != 0;
      anyDamping = anyDamping || own;
   }
   constants.finish();
   damped = damped && anyDamping;
   if (!damped)
      for (BondConstants &k : constants)
         for (int j = 0; j < 3; ++j)
            k.d[j] = k.e[j] = 0;
}

} // namespace bonds
