// Cells fall freely from rest, each for itself: z - g t^2 / 2.
#include <diatom/solver.hpp>

#include <vector>

using namespace diatom::sdk;

class Falling
{
public:
   static const diatom_capabilities &capabilities()
   {
      static const char *const physics[] = {"mechanics"}, *const analyses[] = {"dynamics"},
                               *const effects[] = {"gravity", "rotation"}, *const lattices[] = {"*"};
      static const diatom_capabilities caps{sizeof caps, 1, 1, physics, analyses, 2, effects, 1, lattices, 1};
      return caps;
   }
   static void estimate(Call, Values, const SceneView &scene, diatom_estimate &estimate)
   {
      estimate.bytes = 56.0 * static_cast<double>(scene.cells());
      estimate.stable_step = 1e-3;
      estimate.stable_link = -1;
   }

   Falling(Call, Values, const SceneView &scene)
   {
      for (std::int64_t cell = 0; cell < scene.cells(); ++cell)
         m_rest.insert(m_rest.end(), scene.position(cell), scene.position(cell) + 3);
      const Channel gravity = scene.channel("gravity", 3);
      if (gravity.count() > 0)
         m_gravity = gravity.row(0)[2];
      m_output[0] = {"position", "m", scene.cells(), 3};
      m_output[1] = {"rotation", "", scene.cells(), 4};
      m_output[2] = {"energy", "J", 1, 6};
   }
   void apply(Call, std::span<const diatom_channel>) { throw Failure(DIATOM_UNSUPPORTED, "make a new one"); }
   std::int32_t step(Call call, const diatom_step_request &request, diatom_step_result &result)
   {
#ifdef DIATOM_GROWN
      if (DIATOM_HAS(diatom_step_request, &request, grown))
         throw Failure(DIATOM_INTERNAL, "the host says that it has what it cannot have");
#endif
      const double step = request.step > 0 ? request.step : 1e-3;
      while (m_time < request.until && result.steps < request.max_steps) {
         if (call.cancelled())
            return DIATOM_CANCELLED;
         m_time = request.until - m_time > step ? m_time + step : request.until;
         ++result.steps;
      }
      result.time = m_time;
      result.step = step;
      result.bad_cell = result.bad_link = -1;
      result.state = DIATOM_RUNNING;
      return DIATOM_OK;
   }
   const diatom_outputs &outputs() const { return m_outputs; }
   void read(Call, std::int64_t output, std::int64_t first, std::int64_t count, double *values) const
   {
      if (output == 2)
         return readEnergy(values);
      for (std::int64_t i = first; i < first + count; ++i) {
         const double *rest = m_rest.data() + 3 * i;
         if (output == 0) {
            *values++ = rest[0];
            *values++ = rest[1];
            *values++ = rest[2] + m_gravity * m_time * m_time / 2;
         } else {
            for (int k = 0; k < 4; ++k)
               *values++ = k == 0 ? 1 : 0;
         }
      }
   }

private:
   /// Of cells of one kilogram each: what they win in motion they lose in height.
   void readEnergy(double *values) const
   {
      const double speed = m_gravity * m_time, cells = static_cast<double>(m_rest.size()) / 3;
      for (int k = 0; k < 6; ++k)
         values[k] = 0;
      values[0] = cells * speed * speed / 2;
      values[2] = -values[0];
   }

   std::vector<double> m_rest;
   double m_gravity = 0, m_time = 0;
   diatom_output m_output[3] = {};
   diatom_outputs m_outputs{sizeof m_outputs, 3, m_output};
};
DIATOM_SOLVER(Falling)
