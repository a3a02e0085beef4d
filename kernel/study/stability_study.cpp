#include "study/stability_study.h"

#include "study/stability_cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace diatom {

namespace {

using stability::Case;

std::vector<Case> allCases()
{
   std::vector<Case> all;
   for (auto *some : {stability::undampedCases, stability::implicitCases, stability::settlingCases,
                      stability::bendingCases, stability::limitCases})
      for (Case &one : some())
         all.push_back(std::move(one));
   return all;
}

std::string verdictText(bool holds) { return holds ? "holds" : "FAILS"; }

} // namespace

bool StabilityCheck::holds() const { return measured <= bound; }

bool StabilityRow::holds() const
{
   return failure.empty() && !checks.empty() &&
          std::all_of(checks.begin(), checks.end(), [](const StabilityCheck &one) { return one.holds(); });
}

bool StabilityStudy::holds() const
{
   return std::all_of(rows.begin(), rows.end(), [](const StabilityRow &row) { return row.holds(); });
}

std::vector<std::pair<std::string, std::string>> stabilityRows()
{
   std::vector<std::pair<std::string, std::string>> names;
   for (const Case &one : allCases())
      names.emplace_back(one.id, one.scene);
   return names;
}

Result<StabilityStudy> studyStability(const std::shared_ptr<const Catalogue> &catalogue,
                                      const StabilityRequest &request, const Job &job)
{
   std::vector<Case> cases = allCases();
   for (const std::string &id : request.rows)
      if (std::none_of(cases.begin(), cases.end(), [&](const Case &one) { return one.id == id; }))
         return Error{ErrorCode::usage,
                      fmt::format("there is no hard case \"{}\"; --list names them all", id)};
   if (!request.rows.empty())
      std::erase_if(cases, [&](const Case &one) {
         return std::find(request.rows.begin(), request.rows.end(), one.id) == request.rows.end();
      });
   StabilityStudy study;
   study.longForm = request.longForm;
   for (const Case &one : cases) {
      job.progress(static_cast<double>(study.rows.size()) / static_cast<double>(cases.size()), one.id);
      StabilityRow row;
      row.id = one.id;
      row.scene = one.scene;
      const auto start = std::chrono::steady_clock::now();
      const Status ran = one.run({catalogue, request.longForm, job}, row);
      if (!ran) {
         if (ran.error().code == ErrorCode::cancelled)
            return ran.error();
         row.failure = ran.error().message;
      }
      row.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      study.rows.push_back(std::move(row));
   }
   return study;
}

std::string stabilityCsv(const StabilityStudy &study)
{
   std::string csv = "case,scene,how,cells,steps,seconds,measure,measured,bound,holds,why\n";
   for (const StabilityRow &row : study.rows) {
      const std::string head = fmt::format("{},\"{}\",\"{}\",{},{},{:.3f}", row.id, row.scene, row.how,
                                           row.cells, row.steps, row.seconds);
      for (const StabilityCheck &check : row.checks)
         csv += fmt::format("{},\"{}\",{:g},{:g},{},\"{}\"\n", head, check.what, check.measured, check.bound,
                            check.holds() ? 1 : 0, check.why);
      if (!row.failure.empty())
         csv += fmt::format("{},\"run to its end\",,,0,\"{}\"\n", head, row.failure);
   }
   return csv;
}

nlohmann::ordered_json stabilityJson(const StabilityStudy &study)
{
   const auto number = [](double value) {
      return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
   };
   nlohmann::ordered_json json{
       {"study", "stability"}, {"form", study.longForm ? "long" : "brief"}, {"holds", study.holds()}};
   json["rows"] = nlohmann::ordered_json::array();
   for (const StabilityRow &row : study.rows) {
      nlohmann::ordered_json one{{"case", row.id},       {"scene", row.scene},
                                 {"how", row.how},       {"cells", row.cells},
                                 {"steps", row.steps},   {"seconds", row.seconds},
                                 {"holds", row.holds()}, {"checks", nlohmann::ordered_json::array()}};
      for (const StabilityCheck &check : row.checks)
         one["checks"].push_back({{"what", check.what},
                                  {"measured", number(check.measured)},
                                  {"bound", number(check.bound)},
                                  {"holds", check.holds()},
                                  {"why", check.why}});
      if (!row.failure.empty())
         one["failure"] = row.failure;
      json["rows"].push_back(std::move(one));
   }
   return json;
}

std::string stabilityMarkdown(const StabilityStudy &study)
{
   std::string text =
       "| case | scene | how | steps | measure | measured | bound | |\n|---|---|---|---|---|---|---|---|\n";
   for (const StabilityRow &row : study.rows) {
      bool first = true;
      const auto line = [&](const std::string &what, const std::string &measured, const std::string &bound,
                            bool holds) {
         text += first ? fmt::format("| `{}` | {} | {} | {} ", row.id, row.scene, row.how, row.steps)
                       : std::string("| | | | ");
         text += fmt::format("| {} | {} | {} | {} |\n", what, measured, bound, verdictText(holds));
         first = false;
      };
      for (const StabilityCheck &check : row.checks)
         line(check.what, fmt::format("{:.3g}", check.measured), fmt::format("{:.3g}", check.bound),
              check.holds());
      if (!row.failure.empty())
         line(row.failure, "", "", false);
   }
   return text;
}

} // namespace diatom
