// What the files of both earlier programs have in common.
#include "document/json_text.h"
#include "formats/importers.h"

#include <fmt/format.h>

namespace diatom {

void visitDense(const JsonPlace &array, Index origin,
                const std::function<void(Index, const JsonPlace &)> &visit)
{
   const auto nx = array.size();
   for (std::size_t x = 0; x < nx && array.ok(); ++x) {
      const auto plane = array.at(x);
      const auto ny = plane.size();
      for (std::size_t y = 0; y < ny && array.ok(); ++y) {
         const auto row = plane.at(y);
         const auto nz = row.size();
         for (std::size_t z = 0; z < nz && array.ok(); ++z) {
            const auto element = row.at(z);
            if (element.json().is_null())
               continue;
            const Index i = origin + Index{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y),
                                           static_cast<std::int32_t>(z)};
            if (!inRange(i))
               element.fail("it lies outside the index range; move the assembly towards the origin");
            else if (element.object())
               visit(i, element);
         }
      }
   }
}

Index readXyz(const JsonPlace &place)
{
   if (!place.object())
      return {};
   const auto axis = [&place](std::string_view key) {
      return static_cast<std::int32_t>(place.at(key).integer(-kIndexLimit, kIndexLimit));
   };
   return {axis("x"), axis("y"), axis("z")};
}

void noteUnknown(Opened &opened, const ReadLog &log)
{
   constexpr std::size_t kMostNotes = 50;
   std::size_t noted = 0;
   for (const auto &[pointer, value] : log.unknown.items()) {
      if (++noted > kMostNotes)
         break;
      auto text = jsonLine(value);
      if (text.size() > 60)
         text = text.substr(0, 57) + "...";
      opened.notes.push_back(fmt::format("{} ({}) has no meaning here and was left out", pointer, text));
   }
   if (log.unknown.size() > kMostNotes)
      opened.notes.push_back(fmt::format("{} more keys have no meaning here and were left out",
                                         log.unknown.size() - kMostNotes));
}

} // namespace diatom
