// Stands in for a solver of statics and modes. It computes no mechanics: each cell moves 1 mm along x for
// each second asked for, every held cell supplies an equal share of what the loads are, and the eigenvalues
// are four fixed ones.
#include <diatom/solver.hpp>

#include <algorithm>
#include <array>
#include <vector>

using namespace diatom::sdk;

namespace {

constexpr std::array<double, 4> kEigenvalues{-4.0, -1e-8, 5e-10, 355.30575843921691}; // the last is 3 Hz

class BalanceStandIn
{
public:
   static const diatom_capabilities &capabilities()
   {
      static const char *const kPhysics[] = {"mechanics"}, *const kAnalyses[] = {"statics", "modes"},
                               *const kEffects[] = {"rotation", "gravity", "loads", "driven"},
                               *const kLattices[] = {"*"};
      static const diatom_capabilities kCaps{sizeof kCaps, 1, 2,         kPhysics, kAnalyses, 4,
                                             kEffects,     1, kLattices, 1};
      return kCaps;
   }

   static void estimate(Call, Values, const SceneView &, diatom_estimate &estimate)
   {
      estimate.stable_step = 1e-3;
      estimate.stable_link = -1;
   }

   BalanceStandIn(Call, Values values, const SceneView &scene)
       : m_end(values.text("end")), m_iterations(std::max(1, static_cast<int>(values.number("load_steps")))),
         m_modes(static_cast<std::int64_t>(values.number("modes"))), m_cells(scene.cells())
   {
      for (std::int64_t cell = 0; cell < m_cells; ++cell)
         m_rest.insert(m_rest.end(), scene.position(cell), scene.position(cell) + 3);
      const Channel fixed = scene.channel("fixed", 1), force = scene.channel("force", 6);
      m_reaction.assign(static_cast<std::size_t>(6 * m_cells), 0);
      for (std::int64_t row = 0; row < fixed.count(); ++row)
         for (std::int64_t load = 0; load < force.count(); ++load)
            for (std::int64_t k = 0; k < 3; ++k)
               m_reaction[static_cast<std::size_t>(6 * fixed.where(row) + k)] -=
                   force.row(load)[k] / static_cast<double>(fixed.count());
      m_output = {{{"position", "m", m_cells, 3},
                   {"rotation", "", m_cells, 4},
                   {"reaction", "N", m_cells, 6},
                   {"eigenvalue", "rad2/s2", m_modes, 1},
                   {"mode", "", m_modes * m_cells, 6}}};
      m_outputs = {sizeof m_outputs, static_cast<std::int64_t>(m_output.size()), m_output.data()};
   }

   void apply(Call, std::span<const diatom_channel>) { throw Failure(DIATOM_UNSUPPORTED, "make a new one"); }

   std::int32_t step(Call call, const diatom_step_request &request, diatom_step_result &result)
   {
      result.bad_link = -1;
      result.bad_cell = m_end == "diverges" ? 1 : -1;
      result.residual = m_end == "diverges" ? 0.5 : 1e-10;
      result.iterations = m_end == "stalls" ? 0 : 1;
      result.state = m_end == "diverges" ? DIATOM_DIVERGED : DIATOM_RUNNING;
      if (call.cancelled())
         return DIATOM_CANCELLED;
      call.progress(0.5, "balancing");
      if (m_end == "found" && ++m_done >= m_iterations) {
         m_done = 0;
         m_time = result.time = request.until;
         result.state = DIATOM_CONVERGED;
      }
      return DIATOM_OK;
   }

   const diatom_outputs &outputs() const { return m_outputs; }

   void read(Call, std::int64_t output, std::int64_t first, std::int64_t count, double *values) const
   {
      for (std::int64_t i = 0; i < count; ++i)
         for (std::int64_t k = 0; k < m_output[static_cast<std::size_t>(output)].stride; ++k)
            *values++ = value(output, first + i, k);
   }

private:
   double value(std::int64_t output, std::int64_t row, std::int64_t k) const
   {
      switch (output) {
      case 0:
         return m_rest[static_cast<std::size_t>(3 * row + k)] + (k == 0 ? 1e-3 * m_time : 0);
      case 1:
         return k == 0 ? 1 : 0;
      case 2:
         return m_reaction[static_cast<std::size_t>(6 * row + k)];
      case 3:
         return kEigenvalues[static_cast<std::size_t>(row)];
      default: { // mode, cell and freedom as digits
         const std::int64_t mode = row / m_cells, cell = row % m_cells;
         return static_cast<double>(100 * mode + 10 * cell + k);
      }
      }
   }

   std::string m_end;
   int m_iterations, m_done = 0;
   std::int64_t m_modes, m_cells;
   std::vector<double> m_rest, m_reaction;
   double m_time = 0;
   std::array<diatom_output, 5> m_output{};
   diatom_outputs m_outputs{};
};

} // namespace

DIATOM_SOLVER(BalanceStandIn)
