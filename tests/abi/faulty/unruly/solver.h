// Cells of one kilogram fall from rest, each for itself; it can save its state.
#pragma once

#include "fault.h"

#include <diatom/solver.hpp>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <set>
#include <vector>

namespace unruly {

class Falling
{
public:
   static const diatom_capabilities &capabilities()
   {
      static const char *const physics[] = {"mechanics"}, *const analyses[] = {"dynamics"},
                               *const lattices[] = {"*"};
      static const char *const effects[] = {"gravity", "rotation"};
      static const diatom_capabilities caps{
          sizeof caps, breaks("solver.abilities") ? 0 : 1, 1, physics, analyses, 2, effects, 1, lattices, 1};
      return caps;
   }
   static void estimate(diatom::sdk::Call, diatom::sdk::Values, const diatom::sdk::SceneView &scene,
                        diatom_estimate &estimate)
   {
      estimate.bytes =
          breaks("solver.estimate") ? 1 : 8.0 * kBallast + 56.0 * static_cast<double>(scene.cells());
      estimate.step_seconds = 1e-8;
      estimate.stable_step = kStep;
      estimate.stable_link = -1;
   }

   Falling(diatom::sdk::Call call, diatom::sdk::Values, const diatom::sdk::SceneView &scene)
       : m_ballast(kBallast)
   {
      for (std::int64_t cell = 0; cell < scene.cells(); ++cell)
         m_rest.insert(m_rest.end(), scene.position(cell), scene.position(cell) + 3);
      if (const auto gravity = scene.channel("gravity", 3); gravity.count() > 0)
         m_gravity = gravity.row(0)[2];
      const double density = scene.property(scene.material(0), "density");
      if (!std::isfinite(density) && !breaks("solver.bad_numbers"))
         throw diatom::sdk::Failure(DIATOM_BAD_INPUT, "what the cells are made of has no density");
      m_gravity += 0 * density; // the same for whatever density there is
      if (breaks("solver.known"))
         m_gravity *= 2;
      if (breaks("solver.parameters"))
         m_gravity = std::numeric_limits<double>::quiet_NaN();
      m_gravity += wobble("solver") + strayOf(call);
      m_output[0] = {"position", "m", scene.cells(), 3};
      m_output[1] = {"rotation", "", scene.cells(), 4};
      m_output[2] = {"energy", "J", 1, 6};
   }
   void apply(diatom::sdk::Call, std::span<const diatom_channel>)
   {
      throw diatom::sdk::Failure(DIATOM_UNSUPPORTED, "make a new one");
   }

   std::int32_t step(diatom::sdk::Call call, const diatom_step_request &request, diatom_step_result &result)
   {
      if (breaks("solver.life"))
         static_cast<char *>(std::malloc(64))[0] = 1; // never freed
      while (m_time < request.until && result.steps < request.max_steps) {
         if (call.cancelled() && !breaks("solver.cancel"))
            return DIATOM_CANCELLED;
         m_time += kStep;
         ++result.steps;
      }
      result.time = m_time;
      result.step = kStep;
      result.bad_cell = result.bad_link = -1;
      result.state = DIATOM_RUNNING;
      return DIATOM_OK;
   }
   const diatom_outputs &outputs() const { return m_outputs; }
   void read(diatom::sdk::Call, std::int64_t output, std::int64_t first, std::int64_t count,
             double *values) const
   {
      if (output == 2)
         return readEnergy(values);
      const std::int64_t from = breaks("solver.reads") ? 0 : first;
      for (std::int64_t i = from; i < from + count; ++i)
         for (int k = 0; k < (output == 0 ? 3 : 4); ++k)
            *values++ = output == 1 ? (k == 0 ? 1 : 0)
                                    : m_rest[static_cast<std::size_t>(3 * i + k)] +
                                          (k == 2 ? m_gravity * m_time * m_time / 2 : 0);
   }

   static std::int32_t save(void *self, const diatom_call *, void *bytes, std::int64_t room,
                            std::int64_t *count)
   {
      *count = sizeof(double);
      if (room < *count)
         return DIATOM_LIMIT;
      std::memcpy(bytes, &static_cast<const Falling *>(self)->m_time, sizeof(double));
      return DIATOM_OK;
   }
   static std::int32_t load(void *self, const diatom_call *, const void *bytes, std::int64_t)
   {
      if (!breaks("solver.state"))
         std::memcpy(&static_cast<Falling *>(self)->m_time, bytes, sizeof(double));
      return DIATOM_OK;
   }

private:
   static constexpr double kStep = 1e-3; // s
   static constexpr std::size_t kBallast = 1 << 20;

   /// What answers must not depend on, where that rule is broken.
   static double strayOf(const diatom::sdk::Call &call)
   {
      if (breaks("solver.worker"))
         return std::filesystem::read_symlink("/proc/self/exe").filename() == "diatom-worker" ? 1e-3 : 0;
      if (!breaks("solver.number_of_threads"))
         return 0;
      std::mutex mutex;
      std::set<std::thread::id> met;
      auto body = [&](std::int64_t, std::int64_t) {
         sleep(5);
         const std::lock_guard lock(mutex);
         met.insert(std::this_thread::get_id());
      };
      call.parallelFor(16, 1, body);
      return 1e-3 * static_cast<double>(met.size());
   }

   /// What it wins in motion it loses in height.
   void readEnergy(double *values) const
   {
      const double speed = m_gravity * m_time, cells = static_cast<double>(m_rest.size()) / 3;
      for (int k = 0; k < 6; ++k)
         values[k] = 0;
      values[0] = cells * speed * speed / 2;
      values[2] = -values[0];
   }

   std::vector<double> m_rest, m_ballast;
   double m_gravity = 0, m_time = 0;
   diatom_output m_output[3];
   diatom_outputs m_outputs{sizeof(diatom_outputs), 3, m_output};
};

inline std::int32_t createSolver(const diatom_call *call, const diatom_create *create,
                                 const diatom_scene *scene, void **self)
{
   const std::int32_t begun = diatom::sdk::guarded(call, [&] { begin("solver", call, create); });
   return begun != DIATOM_OK ? begun : diatom::sdk::SolverTable<Falling>::create(call, create, scene, self);
}

inline std::int32_t solverCapabilities(const diatom_call *call, const char *id,
                                       const diatom_capabilities **caps)
{
   if (std::string_view(id) != "test.unruly.solver" && !breaks("module.ids"))
      return DIATOM_BAD_INPUT;
   return diatom::sdk::SolverTable<Falling>::capabilities(call, id, caps);
}

using Solving = diatom::sdk::SolverTable<Falling>;
inline constexpr diatom_solver kSolver{solverCapabilities, Solving::estimate, createSolver,
                                       Solving::apply,     Solving::step,     Solving::outputs,
                                       Solving::read,      Solving::destroy};
inline constexpr diatom_solver_state kState{Falling::save, Falling::load};

} // namespace unruly
