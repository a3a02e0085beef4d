#include "cli/accuracy_option.h"

#include "core/text.h"

#include <fmt/format.h>

namespace diatom::cli {

namespace {

nlohmann::ordered_json estimateJson(const Estimate &estimate)
{
   nlohmann::ordered_json json{
       {"value", nullptr}, {"how", knowledgeText(estimate.how)}, {"why", estimate.why}};
   if (estimate.how != Knowledge::unknown)
      json["value"] = estimate.value;
   return json;
}

std::string errorText(const SettingOption &candidate)
{
   const Estimate &error = candidate.error;
   if (error.how == Knowledge::unknown)
      return fmt::format("its error over the first {:.3g} s is {} %, over the whole unknown ({})",
                         candidate.window, fixedText(100 * candidate.withinError, 3), error.why);
   return fmt::format("its error is {} % ({}: {})", fixedText(100 * error.value, 3), knowledgeText(error.how),
                      error.why);
}

} // namespace

Result<double> parseAccuracy(std::string text)
{
   const bool percent = !text.empty() && text.back() == '%';
   if (percent)
      text.pop_back();
   const auto value = parseNumber(text);
   const double relative = value ? *value / (percent ? 100 : 1) : 0;
   if (relative > 0 && relative < 1)
      return relative;
   return Error{ErrorCode::usage,
                fmt::format("\"{}{}\" is no accuracy: write 1% or 0.01", text, percent ? "%" : "")};
}

Result<AccuracyChoice> applyAccuracy(const AccuracyAsked &asked, const Context::Input &input, Setup &setup,
                                     Context &context)
{
   ChoiceRequest request;
   request.until = asked.until;
   request.error = asked.error;
   request.fixed = asked.fixed;
   request.budget = asked.budget;
   if (!asked.quantity.empty()) {
      auto quantity = parseQuantity(asked.quantity);
      if (!quantity)
         return quantity.error();
      request.quantity = *std::move(quantity);
   }
   auto choice = chooseForAccuracy({context.catalogue(), input.hierarchy, setup, 1}, request, context.job());
   if (!choice)
      return choice;
   const SettingOption &best = choice->best();
   for (const auto &[name, value] : best.values)
      setup.solverValues[name] = value;
   setup.step = best.step;
   context.note(fmt::format("accuracy {} % of {}: {}, step {} s; {}", numberText(100 * asked.error),
                            choice->quantity.text(), best.setting, fmt::format("{:.4g}", best.step),
                            errorText(best)));
   context.note(choice->why);
   context.note(
       fmt::format("this run takes {} s ({})", fmt::format("{:.3g}", best.seconds.value), best.seconds.why));
   return choice;
}

nlohmann::ordered_json choiceJson(const AccuracyChoice &choice, double wallSeconds)
{
   const SettingOption &best = choice.best();
   nlohmann::ordered_json json{{"asked", choice.error},
                               {"quantity", choice.quantity.text()},
                               {"setting", best.setting},
                               {"step_s", best.step},
                               {"error", estimateJson(best.error)},
                               {"error_tried", best.withinError},
                               {"tried_s", best.window},
                               {"why", choice.why},
                               {"predicted_wall_s", best.seconds.value},
                               {"wall_s", wallSeconds},
                               {"probe_s", choice.probeSeconds}};
   json["candidates"] = nlohmann::ordered_json::array();
   for (const SettingOption &one : choice.candidates) {
      nlohmann::ordered_json row{{"setting", one.setting}};
      if (one.step > 0)
         row.update({{"step_s", one.step},
                     {"error", estimateJson(one.error)},
                     {"predicted_wall_s", one.seconds.value}});
      else
         row["note"] = one.note;
      json["candidates"].push_back(std::move(row));
   }
   return json;
}

} // namespace diatom::cli
