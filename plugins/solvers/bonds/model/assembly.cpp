// Compiling a scene: checks of the input, masses and inertias, supports, effects.
#include "model/assembly.h"

#include <algorithm>
#include <limits>
#include <string>

namespace bonds {

using sdk::Failure;

Options Options::from(const sdk::Values &values)
{
   Options o;
   const auto integrator = values.text("integrator"), beam = values.text("beam"),
              gradient = values.text("gradient");
   constexpr std::pair<std::string_view, Integrator> integrators[] = {
       {"semi_implicit", Integrator::semiImplicit},
       {"verlet", Integrator::verlet},
       {"rk4", Integrator::rungeKutta},
       {"midpoint", Integrator::midpoint},
       {"forward_euler", Integrator::forwardEuler},
       {"implicit", Integrator::implicit}};
   const auto *found = std::find_if(std::begin(integrators), std::end(integrators),
                                    [&](const auto &one) { return one.first == integrator; });
   if (found == std::end(integrators))
      throw Failure(DIATOM_BAD_INPUT, "unknown integrator \"" + std::string(integrator) + "\"");
   o.integrator = found->second;
   if (beam != "timoshenko" && beam != "thesis" && beam != "euler")
      throw Failure(DIATOM_BAD_INPUT, "unknown beam theory \"" + std::string(beam) + "\"");
   o.beam = beam == "thesis" ? Beam::thesis : beam == "euler" ? Beam::euler : Beam::timoshenko;
   const auto precision = values.text("precision");
   if (precision != "f64" && precision != "f32")
      throw Failure(DIATOM_BAD_INPUT, "unknown precision \"" + std::string(precision) + "\"");
   o.precision = precision == "f32" ? Precision::f32 : Precision::f64;
   const auto instructions = values.text("instructions");
   if (instructions != "best" && instructions != "avx2" && instructions != "sse4" && instructions != "scalar")
      throw Failure(DIATOM_BAD_INPUT, "unknown instructions \"" + std::string(instructions) + "\"");
   o.instructions = instructions == "avx2"     ? Instructions::avx2
                    : instructions == "sse4"   ? Instructions::sse4
                    : instructions == "scalar" ? Instructions::scalar
                                               : Instructions::best;
   o.reproducible = values.number("reproducible") != 0;
   o.stepped = values.text("junction") != "mean";
   o.exact = gradient != "simple";
   o.trueLimit = values.text("stable_step") == "eigenvalue";
   o.safety = values.number("safety");
   if (!(o.safety > 0 && o.safety <= 1))
      throw Failure(DIATOM_BAD_INPUT, "safety must lie between 0 and 1");
   o.forceStep = values.number("force_step") != 0;
   return o;
}

Assembly::Assembly(const sdk::SceneView &scene, const Options &options)
    : cells(scene.cells()), links(scene.links())
{
   if (cells <= 0)
      throw Failure(DIATOM_BAD_INPUT, "the scene has no cells");
   if (links > std::numeric_limits<std::int32_t>::max())
      throw Failure(DIATOM_LIMIT, "the scene has more than 2^31 links");
   readEffects(scene);
   law = links > 0 && !scene.hasEffect("rotation") ? Law::small : options.exact ? Law::exact : Law::simple;
   readCells(scene);
   readSupports(scene);
   readBonds(scene, options);
   indexBonds();
   if (!boxes) {
      boxInertia = {};
      orientation = {};
   }
}

Mat3 Assembly::frameOf(std::int64_t bond) const
{
   constexpr Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
   const int axis = axisOf(bond);
   if (axis == 3)
      return frame[static_cast<std::size_t>(bond - group[3])];
   return axis == 0 ? Mat3{x, y, z} : axis == 1 ? Mat3{y, z, x} : Mat3{z, x, y};
}

void Assembly::readEffects(const sdk::SceneView &scene)
{
   damped = scene.hasEffect("damping");
   actuated = scene.hasEffect("actuation");
   if (const auto g = scene.channel("gravity", 3); g && scene.hasEffect("gravity")) {
      hasGravity = true;
      std::copy_n(g.row(0), 3, gravity.begin());
   }
   if (const auto d = scene.channel("drag", 1); d && scene.hasEffect("drag")) {
      hasDrag = true;
      drag = *d.row(0);
   }
   hasLoads = scene.hasEffect("loads") && static_cast<bool>(scene.channel("force", 6));
   if (const auto g = scene.channel("ground", 4); g && scene.hasEffect("ground")) {
      hasGround = true;
      ground = {g.row(0)[0], g.row(0)[1], g.row(0)[2], g.row(0)[3]};
      hasFriction = scene.hasEffect("friction") && ground.friction > 0 && ground.stiffness > 0;
   }
   if (drag < 0 || ground.stiffness < 0 || ground.damping < 0 || ground.friction < 0)
      throw Failure(DIATOM_BAD_INPUT,
                    "drag and the ground's stiffness, damping and friction must not be negative");
   if (const auto v = scene.channel("velocity", 6)) {
      velocity.resize(static_cast<std::size_t>(cells));
      for (std::int64_t i = 0; i < v.count(); ++i)
         std::copy_n(v.row(i), 6, velocity[v.where(i)].begin());
   }
}

void Assembly::readCells(const sdk::SceneView &scene)
{
   constexpr const char *names[] = {"inertia_x", "inertia_y", "inertia_z"};
   const auto n = static_cast<std::size_t>(cells);
   for (int k = 0; k < 3; ++k) {
      rest[k].resize(n);
      boxInertia[k].resize(n);
   }
   mass.resize(n);
   inertia.resize(n);
   halfHeight.resize(hasGround ? n : 0);
   orientation.resize(n);
   for (std::int64_t i = 0; i < cells; ++i) {
      const double *p = scene.position(i), *q = scene.orientation(i), *e = scene.extent(i);
      const double density = scene.property(scene.material(i), "density");
      const double m = density * e[0] * e[1] * e[2];
      if (scene.material(i) < 0 || scene.material(i) >= scene.materials() || !(m > 0) || !std::isfinite(m))
         throw Failure(DIATOM_BAD_INPUT,
                       "the cell " + scene.name(i) + " has no mass: give its material a density above 0");
      const double norm2 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
      if (!std::isfinite(p[0] + p[1] + p[2]) || !(std::abs(norm2 - 1) < 1e-6))
         throw Failure(DIATOM_BAD_INPUT,
                       "the cell " + scene.name(i) + " has no valid position and orientation");
      mass[i] = m;
      orientation[i] = {q[0], q[1], q[2], q[3]};
      for (int k = 0; k < 3; ++k) {
         rest[k][i] = p[k];
         const double u = e[(k + 1) % 3], v = e[(k + 2) % 3];
         boxInertia[k][i] = m / 12 * (u * u + v * v);
         const double own = scene.property(scene.material(i), names[k]);
         if (own <= 0 || std::isinf(own))
            throw Failure(DIATOM_BAD_INPUT,
                          "the cell " + scene.name(i) + " has no inertia: give its material one above 0");
         if (!std::isnan(own))
            boxInertia[k][i] = own;
      }
      const double one = boxInertia[0][i];
      boxes = boxes || std::abs(one - boxInertia[1][i]) > 1e-9 * one ||
              std::abs(one - boxInertia[2][i]) > 1e-9 * one;
      if (!hasGround)
         continue;
      const Vec3 down = matrix(orientation[i]).r2;
      halfHeight[i] = 0.5 * (std::abs(down.x) * e[0] + std::abs(down.y) * e[1] + std::abs(down.z) * e[2]);
   }
   for (std::size_t i = 0; i < n; ++i)
      inertia[i] = std::min({boxInertia[0][i], boxInertia[1][i], boxInertia[2][i]});
}

void Assembly::readSupports(const sdk::SceneView &scene)
{
   fixed.assign(static_cast<std::size_t>(cells), 0);
   const auto supports = scene.channel("fixed", 1);
   for (std::int64_t i = 0; i < supports.count(); ++i)
      fixed[supports.where(i)] = static_cast<std::uint8_t>(static_cast<int>(*supports.row(i)) & 0x3f);
   const auto driven = scene.channel("driven", 2);
   for (std::int64_t i = 0; i < driven.count(); ++i)
      if (const double freedom = driven.row(i)[0]; freedom >= 0 && freedom <= 5)
         fixed[driven.where(i)] |= static_cast<std::uint8_t>(1 << static_cast<int>(freedom));
}

void Assembly::indexBonds()
{
   first.assign(static_cast<std::size_t>(cells) + 1, 0);
   for (std::int64_t i = 0; i < links; ++i) {
      ++first[a[i] + 1];
      ++first[b[i] + 1];
   }
   for (std::int64_t i = 0; i < cells; ++i)
      first[i + 1] += first[i];
   bondsOf.resize(static_cast<std::size_t>(2 * links));
   std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
   for (std::int64_t i = 0; i < links; ++i) {
      bondsOf[next[a[i]]++] = static_cast<std::uint32_t>(2 * i);
      bondsOf[next[b[i]]++] = static_cast<std::uint32_t>(2 * i + 1);
   }
}

} // namespace bonds
