#include "gui/solver_values.h"

namespace diatom::gui {

Values mergedValues(const Catalogue &catalogue, const Setup &setup, const Values &changed)
{
   Values values = setup.solverValues;
   for (const auto &[name, value] : changed)
      values[name] = value;
   const Offer *offer = catalogue.offer(DIATOM_SOLVER_1, setup.solver);
   if (!offer)
      return values;
   for (const Parameter &parameter : offer->provided->parameters) {
      const auto found = values.find(parameter.name);
      if (found == values.end())
         continue;
      const auto *number = std::get_if<double>(&found->second);
      const auto *text = std::get_if<std::string>(&found->second);
      if (number ? *number == parameter.number : *text == parameter.text)
         values.erase(found);
   }
   return values;
}

nlohmann::json valuesArgument(const Values &values)
{
   auto json = nlohmann::json::object();
   for (const auto &[name, value] : values)
      std::visit([&, &key = name](const auto &v) { json[key] = v; }, value);
   return json;
}

double automaticFraction(const Catalogue &catalogue, const Setup &setup)
{
   constexpr double kUsual = 0.9;
   const auto given = setup.solverValues.find("safety");
   if (given != setup.solverValues.end())
      if (const double *number = std::get_if<double>(&given->second))
         return *number;
   if (const Offer *offer = catalogue.offer(DIATOM_SOLVER_1, setup.solver))
      for (const Parameter &parameter : offer->provided->parameters)
         if (parameter.name == "safety")
            return parameter.number;
   return kUsual;
}

} // namespace diatom::gui
