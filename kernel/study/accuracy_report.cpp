#include "study/accuracy_report.h"

#include "core/file.h"
#include "core/text.h"

#include <fmt/format.h>

#include <algorithm>

namespace diatom {

namespace {

using nlohmann::ordered_json;

std::string quoted(const std::string &text)
{
   std::string out = "\"";
   for (const char c : text)
      out += c == '"' ? std::string("\"\"") : std::string(1, c);
   return out + "\"";
}

template<typename Value>
ordered_json orNull(const std::optional<Value> &value)
{
   return value ? ordered_json(*value) : ordered_json();
}

ordered_json rowJson(const AccuracyRow &row)
{
   ordered_json json{{"analysis", row.analysis}};
   auto values = ordered_json::object();
   for (const auto &[name, value] : row.values)
      std::visit([&, &key = name](const auto &v) { values[key] = v; }, value);
   json["values"] = std::move(values);
   json["resolution"] = row.resolution;
   json["cells"] = row.cells;
   json["stable_fraction"] = row.fraction;
   json["step_s"] = row.step;
   json["steps"] = row.steps;
   json["value"] = row.value;
   json["error"] = orNull(row.error);
   json["seconds"] = row.seconds;
   json["ns_per_cell_step"] = row.nsPerCellStep;
   json["repeats"] = row.repeats;
   json["front"] = row.onFront;
   if (!row.note.empty())
      json["note"] = row.note;
   return json;
}

std::string rowName(const AccuracyRow &row)
{
   return row.resolution > 1 ? fmt::format("{} {}x", row.setting, row.resolution) : row.setting;
}

std::string percent(double relative)
{
   return relative >= 1e-4 ? fmt::format("{:.2g} %", 100 * relative) : fmt::format("{:.0e}", relative);
}

std::string titleOf(const AccuracyStudy &study)
{
   const std::string scene = study.scene.empty() ? "" : study.scene + ": ";
   return fmt::format("{}error of {} against time, {:.3g} s simulated", scene, study.quantity.text(),
                      study.until);
}

/// A line for each setting: in the order of its steps, or where there are none of its resolutions.
std::vector<Series> seriesOf(const AccuracyStudy &study)
{
   std::vector<Series> all;
   for (const AccuracyRow &row : study.rows) {
      if (!row.error)
         continue;
      const bool cut = row.analysis != "dynamics" && row.resolution > 1;
      const std::string name = cut ? row.setting : rowName(row);
      auto found = std::find_if(all.begin(), all.end(), [&](const Series &one) { return one.name == name; });
      if (found == all.end())
         found = all.insert(all.end(), Series{name, {}, true});
      found->points.push_back({row.seconds, *row.error, cut ? fmt::format("{}x", row.resolution) : ""});
   }
   return all;
}

} // namespace

std::string accuracyCsv(const AccuracyStudy &study)
{
   std::string csv = "analysis,setting,resolution,cells,stable fraction,step (s),steps,value,error "
                     "(relative),seconds,ns per cell-step,repeats,front,note\n";
   for (const AccuracyRow &row : study.rows)
      csv +=
          fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", row.analysis, quoted(row.setting),
                      row.resolution, row.cells, numberText(row.fraction), numberText(row.step), row.steps,
                      numberText(row.value), row.error ? numberText(*row.error) : "", numberText(row.seconds),
                      numberText(row.nsPerCellStep), row.repeats, row.onFront ? 1 : 0, quoted(row.note));
   return csv;
}

ordered_json accuracyJson(const AccuracyStudy &study)
{
   const AccuracyReference &reference = study.reference;
   ordered_json json{
       {"study", "accuracy"},           {"scene", study.scene},   {"quantity", study.quantity.text()},
       {"unit", study.quantity.unit()}, {"until_s", study.until}, {"tolerance", study.tolerance},
       {"scale", study.scale}};
   json["reference"] = {{"kind", reference.exact ? "exact" : "converged run"},
                        {"value", reference.value},
                        {"source", reference.source},
                        {"own_error", orNull(reference.ownError)},
                        {"order", orNull(reference.order)},
                        {"asymptotic", reference.asymptotic},
                        {"disagreement", orNull(reference.disagreement)},
                        {"doubt", reference.doubt}};
   json["sensitivity"] = orNull(study.sensitivity);
   const auto row = [&](int k) {
      return k < 0 ? ordered_json() : rowJson(study.rows[static_cast<std::size_t>(k)]);
   };
   json["cheapest"] = row(study.cheapest);
   json["careful"] = row(study.careful);
   json["gain"] = orNull(study.gain());
   json["rows"] = ordered_json::array();
   for (const AccuracyRow &one : study.rows)
      json["rows"].push_back(rowJson(one));
   json["notes"] = study.notes;
   json["seconds"] = study.seconds;
   return json;
}

Chart accuracyChart(const AccuracyStudy &study)
{
   Chart chart;
   chart.title = titleOf(study);
   chart.x = {"time of the run", "s", true};
   chart.y = {"error, relative", "", true};
   chart.series = seriesOf(study);
   std::vector<ChartPoint> all;
   for (const Series &one : chart.series)
      all.insert(all.end(), one.points.begin(), one.points.end());
   chart.front = paretoFront(all);
   chart.frontName = "nothing beats these";
   chart.limit = study.tolerance;
   chart.limitName = "asked: " + percent(study.tolerance);
   if (study.cheapest >= 0) {
      const AccuracyRow &row = study.rows[static_cast<std::size_t>(study.cheapest)];
      chart.marked = {row.seconds, *row.error, "cheapest: " + rowName(row) + ", " + percent(*row.error)};
   }
   return chart;
}

Status writeAccuracy(AccuracyStudy &study, const std::filesystem::path &folder)
{
   if (Status made = makeFolder(folder); !made)
      return made;
   if (!canPlot())
      study.notes.emplace_back("this build has no PLplot: there is no plot");
   else
      for (const char *name : {"accuracy.svg", "accuracy.png"})
         if (Status drawn = writePlot(accuracyChart(study), folder / name); !drawn)
            return drawn;
   if (Status table = writeFileAtomic(folder / "accuracy.csv", accuracyCsv(study)); !table)
      return table;
   return writeFileAtomic(folder / "accuracy.json", accuracyJson(study).dump(2) + "\n");
}

} // namespace diatom
