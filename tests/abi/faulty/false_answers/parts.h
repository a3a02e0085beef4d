// Cells as bricks, decomposed falsely.
#pragma once

#include <diatom/parts.hpp>

#include <chrono>
#include <filesystem>
#include <limits>
#include <thread>

namespace false_answers {

inline constexpr std::string_view kGoesOn = "goes on until there is "; // and the name of a file

/// Deaf to cancel; a minute at most, for the sake of a host that does not notice.
inline void goOnUntilThereIs(const std::string &file)
{
   for (int i = 0; i < 6000 && !std::filesystem::exists(file); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

inline diatom::sdk::PartSet falseParts(const diatom::sdk::Values &values)
{
   using namespace diatom::sdk;
   PartSet set;
   set.kinds = {{"brick", "Brick", 1}};
   set.lattices = {"*"};
   set.mesh = [](const MeshRequest &) { return PartMesh(); };
   set.decompose = [fault = std::string(values.text("fault"))](const Call &call, const diatom_cells &cells,
                                                               PartList &parts) {
      if (fault == "throws")
         throw std::runtime_error("the saw broke");
      if (fault == "memory" && !call.raw()->scratch(call.raw(), std::int64_t{1} << 60))
         throw std::bad_alloc();
      if (fault.starts_with(kGoesOn)) {
         call.progress(0, "sawing"); // the moment at which the test cancels
         goOnUntilThereIs(fault.substr(kGoesOn.size()));
      }
      const double off = fault == "not finite" ? std::numeric_limits<double>::infinity() : 0;
      for (std::int64_t i = fault == "misses one" ? 1 : 0; i < cells.count; ++i) {
         const double *at = cells.position + 3 * i;
         const std::int64_t covers = fault == "index" ? cells.count + i : i;
         parts.add(fault == "type" ? 5 : 0, 1, cells.material[i], {at[0] + off, at[1], at[2]}, {1, 0, 0, 0},
                   {covers});
         if (fault == "covers twice")
            parts.add(0, 1, cells.material[i], {at[0], at[1], at[2]}, {1, 0, 0, 0}, {i});
      }
   };
   return set;
}

} // namespace false_answers
