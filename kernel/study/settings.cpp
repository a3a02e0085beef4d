#include "study/settings.h"

#include <algorithm>

namespace diatom {

namespace {

const std::string &textOf(const Values &values, const std::string &name)
{
   return std::get<std::string>(values.at(name));
}

} // namespace

std::vector<Choice> solverChoices(const Catalogue &catalogue, const std::string &solver, const Values &inUse,
                                  std::span<const std::string_view> wanted)
{
   std::vector<Choice> found;
   const Offer *offer = catalogue.offer(DIATOM_SOLVER_1, solver);
   if (!offer)
      return found;
   for (const std::string_view name : wanted)
      for (const Parameter &parameter : offer->provided->parameters) {
         if (parameter.name != name || parameter.kind != Parameter::Kind::choice)
            continue;
         Choice choice{parameter.name, parameter.choices};
         const auto given = inUse.find(parameter.name);
         const auto *text = given == inUse.end() ? nullptr : std::get_if<std::string>(&given->second);
         const auto first =
             std::find(choice.choices.begin(), choice.choices.end(), text ? *text : parameter.text);
         if (first != choice.choices.end())
            std::rotate(choice.choices.begin(), first, first + 1);
         found.push_back(std::move(choice));
      }
   return found;
}

std::vector<Values> combinations(const std::vector<Choice> &choices)
{
   std::vector<Values> all{{}};
   for (const Choice &choice : choices) {
      std::vector<Values> longer;
      for (const Values &values : all)
         for (const std::string &one : choice.choices) {
            longer.push_back(values);
            longer.back()[choice.name] = one;
         }
      all = std::move(longer);
   }
   const auto unlike = [&](const Values &values) {
      return std::count_if(choices.begin(), choices.end(), [&](const Choice &choice) {
         return textOf(values, choice.name) != choice.choices.front();
      });
   };
   std::stable_sort(all.begin(), all.end(),
                    [&](const Values &a, const Values &b) { return unlike(a) < unlike(b); });
   return all;
}

std::string settingText(const std::vector<Choice> &choices, const Values &values)
{
   std::string text;
   for (const Choice &choice : choices)
      text += (text.empty() ? "" : " ") + textOf(values, choice.name);
   return text;
}

} // namespace diatom
