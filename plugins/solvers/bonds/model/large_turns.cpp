#include "model/large_turns.h"

#include <charconv>

namespace bonds {

namespace {

/// Part of its length that a bond's stretch and shear are wrong by.
double leftOut(const Assembly &assembly, const State &state, std::int64_t bond)
{
   const Ends ends = endsOf(assembly, state, bond);
   Ends turned = ends;
   turned.qa = exponential(2 * vec(ends.qa));
   turned.qb = exponential(2 * vec(ends.qb));
   return norm(relate(turned).u - relateSmall(ends).u) / ends.length;
}

} // namespace

std::optional<std::string> largeTurnsIn(const Assembly &assembly, const State &state,
                                        const std::function<std::string(std::int64_t)> &name)
{
   if (!state.smallTurns)
      return {};
   constexpr double kTold = 1e-3;
   double most = 0;
   std::int64_t worst = -1;
   for (std::int64_t i = 0; i < assembly.links; ++i)
      if (const double wrong = leftOut(assembly, state, i); wrong > most) {
         most = wrong;
         worst = i;
      }
   if (!(most > kTold))
      return {};
   char percent[32];
   const auto end =
       std::to_chars(percent, percent + sizeof percent, 100 * most, std::chars_format::general, 2);
   return "rotation is switched off, but cells have moved and turned so far that strains come out wrong by "
          "up "
          "to " +
          std::string(percent, end.ptr) + " %, most in " + name(worst) +
          ": switch it on for motions like these";
}

} // namespace bonds
