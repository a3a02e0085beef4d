#include "plugins/values.h"

#include "core/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace diatom {

namespace {

bool isNumeric(const Parameter &parameter)
{
   return parameter.kind == Parameter::Kind::number || parameter.kind == Parameter::Kind::integer;
}

Status checkNumber(const Parameter &parameter, double value)
{
   if (!std::isfinite(value) || value < parameter.minimum || value > parameter.maximum)
      return Error{ErrorCode::invalid,
                   fmt::format("{} is {}{}{}; it must lie between {} and {}", parameter.name,
                               numberText(value), parameter.unit.empty() ? "" : " ", parameter.unit,
                               numberText(parameter.minimum), numberText(parameter.maximum))};
   if (parameter.kind == Parameter::Kind::integer && value != std::floor(value))
      return Error{ErrorCode::invalid,
                   fmt::format("{} is {}; it must be a whole number", parameter.name, numberText(value))};
   return {};
}

Status checkText(const Parameter &parameter, const std::string &value)
{
   if (parameter.kind != Parameter::Kind::choice ||
       std::find(parameter.choices.begin(), parameter.choices.end(), value) != parameter.choices.end())
      return {};
   return Error{ErrorCode::invalid, fmt::format("{} is \"{}\"; it must be one of: {}", parameter.name, value,
                                                fmt::join(parameter.choices, ", "))};
}

} // namespace

Result<Values> completeValues(std::span<const Parameter> parameters, const Values &given)
{
   Values complete;
   for (const Parameter &parameter : parameters) {
      const auto found = given.find(parameter.name);
      if (found == given.end()) {
         if (isNumeric(parameter))
            complete[parameter.name] = parameter.number;
         else
            complete[parameter.name] = parameter.text;
         continue;
      }
      const bool numberGiven = std::holds_alternative<double>(found->second);
      if (numberGiven != isNumeric(parameter))
         return Error{ErrorCode::invalid, fmt::format("{} must be a {}", parameter.name,
                                                      isNumeric(parameter) ? "number" : "text")};
      const Status fits = numberGiven ? checkNumber(parameter, std::get<double>(found->second))
                                      : checkText(parameter, std::get<std::string>(found->second));
      if (!fits)
         return fits.error();
      complete[parameter.name] = found->second;
   }
   for (const auto &[name, value] : given)
      if (!complete.contains(name))
         return Error{ErrorCode::invalid, fmt::format("there is no parameter named \"{}\"", name)};
   return complete;
}

} // namespace diatom
