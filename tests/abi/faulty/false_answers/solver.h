// A solver whose answers are not what it says they are.
#pragma once

#include <diatom/solver.hpp>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <limits>
#include <string>
#include <thread>
#include <vector>

namespace false_answers {

class FalseSolver
{
public:
   static const diatom_capabilities &capabilities()
   {
      static const char *const kPhysics[] = {"mechanics"}, *const kAnalyses[] = {"dynamics"},
                               *const kEffects[] = {"rotation", "gravity", "loads"},
                               *const kLattices[] = {"*"};
      static const diatom_capabilities kCaps{sizeof kCaps, 1, 1,         kPhysics, kAnalyses, 3,
                                             kEffects,     1, kLattices, 1};
      return kCaps;
   }
   static void estimate(diatom::sdk::Call, diatom::sdk::Values, const diatom::sdk::SceneView &,
                        diatom_estimate &estimate)
   {
      estimate.stable_step = 1e-3;
      estimate.stable_link = -1;
   }

   FalseSolver(diatom::sdk::Call, diatom::sdk::Values values, const diatom::sdk::SceneView &scene)
       : m_fault(values.text("fault")), m_cells(scene.cells())
   {
      const std::int64_t rows = m_fault == "counts" ? m_cells - 1 : m_fault == "limits" ? -5 : m_cells;
      m_output = {{{"position", "m", rows, 3}, {"rotation", "", m_cells, 4}, {"energy", "J", 1, 6}}};
      m_outputs = {sizeof m_outputs, 3, m_output.data()};
   }

   void apply(diatom::sdk::Call, std::span<const diatom_channel>) {}
   std::int32_t step(diatom::sdk::Call call, const diatom_step_request &request, diatom_step_result &result)
   {
      if (m_fault == "throws")
         throw std::runtime_error("the wheel came off");
      if (m_fault == "crash")
         std::raise(SIGSEGV);
      if (m_fault == "leave")
         std::_Exit(0);
      if (m_fault == "memory")
         m_hoard.resize(std::size_t{64} << 30, 1);
      if (m_fault == "leaks")
         m_lost = new char[std::size_t{32} << 20]; // each time, and nobody ever gives it back
      if (m_fault == "hang")
         call.progress(0.5, "hanging"); // so that a test knows when
      while (m_fault == "hang")
         std::this_thread::sleep_for(std::chrono::milliseconds(10));
      result.state = m_fault == "state" ? 99 : DIATOM_DONE;
      result.time = m_fault == "time" ? std::numeric_limits<double>::quiet_NaN() : request.until;
      result.bad_cell = result.bad_link = -1;
      return DIATOM_OK;
   }
   const diatom_outputs &outputs() const { return m_outputs; }
   void read(diatom::sdk::Call, std::int64_t output, std::int64_t, std::int64_t count, double *values) const
   {
      const std::int64_t numbers = count * m_output[static_cast<std::size_t>(output)].stride;
      for (std::int64_t i = 0; i < numbers; ++i)
         values[i] =
             m_fault == "not finite" && output == 0 && i == 4 ? std::numeric_limits<double>::quiet_NaN() : 0;
   }

private:
   std::string m_fault;
   std::vector<char> m_hoard;
   char *volatile m_lost = nullptr;
   std::int64_t m_cells;
   std::array<diatom_output, 3> m_output{};
   diatom_outputs m_outputs{};
};

} // namespace false_answers
