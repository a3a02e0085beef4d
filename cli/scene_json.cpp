#include "cli/scene_json.h"

#include "core/text.h"
#include "scene/fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace diatom::cli {

namespace {

/// A number of the set-up that --set can reach.
struct SetupNumber
{
   const char *path;
   double &(*of)(Setup &);
};

constexpr std::array<SetupNumber, 9> kSetupNumbers{{
    {"drag", [](Setup &s) -> double & { return s.drag; }},
    {"step", [](Setup &s) -> double & { return s.step; }},
    {"gravity.x", [](Setup &s) -> double & { return s.gravity[0]; }},
    {"gravity.y", [](Setup &s) -> double & { return s.gravity[1]; }},
    {"gravity.z", [](Setup &s) -> double & { return s.gravity[2]; }},
    {"ground.height", [](Setup &s) -> double & { return s.ground.height; }},
    {"ground.stiffness", [](Setup &s) -> double & { return s.ground.stiffness; }},
    {"ground.damping", [](Setup &s) -> double & { return s.ground.damping; }},
    {"ground.friction", [](Setup &s) -> double & { return s.ground.friction; }},
}};

struct MaterialNumber
{
   const char *name;
   double Material::*member;
};

constexpr std::array<MaterialNumber, 4> kMaterialNumbers{{{"density", &Material::density},
                                                          {"youngs_modulus", &Material::youngsModulus},
                                                          {"poisson_ratio", &Material::poissonRatio},
                                                          {"damping_ratio", &Material::dampingRatio}}};

Error unknownSetting(const std::string &path)
{
   std::string known;
   for (const SetupNumber &one : kSetupNumbers)
      known += std::string(one.path) + ", ";
   return {ErrorCode::usage, fmt::format("--set knows no '{}'; it knows {}ground.present, solver.NAME and "
                                         "materials.ID.NAME with density, youngs_modulus, poisson_ratio, "
                                         "damping_ratio (ID may be *)",
                                         path, known)};
}

Status setMaterial(const std::string &path, double value, Design &design)
{
   const std::size_t begin = std::string_view("materials.").size(), end = path.rfind('.');
   if (end == std::string::npos || end <= begin)
      return unknownSetting(path);
   const std::string id = path.substr(begin, end - begin), name = path.substr(end + 1);
   const auto number = std::find_if(kMaterialNumbers.begin(), kMaterialNumbers.end(),
                                    [&](const MaterialNumber &one) { return name == one.name; });
   if (number == kMaterialNumbers.end())
      return unknownSetting(path);
   auto materials = std::make_shared<std::vector<Material>>(*design.model.materials);
   bool found = false;
   for (Material &material : *materials)
      if (!material.id.empty() && (id == "*" || material.id == id)) {
         material.*(number->member) = value;
         found = true;
      }
   if (!found)
      return Error{ErrorCode::usage, fmt::format("--set {}: the design has no material '{}'", path, id)};
   design.model.materials = std::move(materials);
   return {};
}

} // namespace

nlohmann::ordered_json toJson(Index index) { return {index.x, index.y, index.z}; }

nlohmann::ordered_json toJson(const std::vector<Index> &cells)
{
   auto list = nlohmann::ordered_json::array();
   for (const Index cell : cells)
      list.push_back(toJson(cell));
   return list;
}

nlohmann::ordered_json toJson(const std::vector<Problem> &problems)
{
   auto list = nlohmann::ordered_json::array();
   for (const Problem &problem : problems)
      list.push_back({{"severity", problem.severity == Problem::Severity::error ? "error" : "warning"},
                      {"kind", problem.kind},
                      {"text", problem.text},
                      {"cells", toJson(problem.cells)}});
   return list;
}

nlohmann::ordered_json toJson(const std::vector<Effect> &effects)
{
   auto list = nlohmann::ordered_json::array();
   for (const Effect &effect : effects) {
      nlohmann::ordered_json row{
          {"name", effect.name}, {"on", effect.on}, {"forced", effect.forced}, {"why", effect.why}};
      row["evidence"] = toJson(effect.evidence);
      row["cost_ns"] = effect.costNs ? nlohmann::ordered_json(*effect.costNs) : nlohmann::ordered_json();
      list.push_back(std::move(row));
   }
   return list;
}

const char *waveformName(Waveform waveform)
{
   constexpr std::array<const char *, 4> kNames{"sine", "square", "saw", "triangle"};
   return kNames[static_cast<std::size_t>(waveform)];
}

bool hasErrors(const std::vector<Problem> &problems)
{
   return std::any_of(problems.begin(), problems.end(),
                      [](const Problem &problem) { return problem.severity == Problem::Severity::error; });
}

Result<Index> parseIndex(const std::string &text)
{
   std::array<std::int32_t, 3> values{};
   std::size_t begin = 0;
   for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t end = k < 2 ? text.find(',', begin) : text.size();
      const auto value = end == std::string::npos
                             ? std::nullopt
                             : parseInteger(std::string_view(text).substr(begin, end - begin));
      if (!value || *value < -kIndexLimit || *value > kIndexLimit)
         return Error{ErrorCode::usage, fmt::format("\"{}\" is not a cell index; write X,Y,Z", text)};
      values[k] = static_cast<std::int32_t>(*value);
      begin = end + 1;
   }
   return Index{values[0], values[1], values[2]};
}

Status applyEffects(const std::string &text, Setup &setup)
{
   if (text == "auto") {
      setup.effects.clear();
      return {};
   }
   auto known = effectNames();
   for (std::string &field : fieldNames(setup))
      known.push_back(std::move(field));
   for (std::size_t begin = 0; begin <= text.size();) {
      const std::size_t end = std::min(text.find(',', begin), text.size());
      const std::string item = text.substr(begin, end - begin);
      const std::string name = item.empty() ? item : item.substr(1);
      if (item.empty() || (item[0] != '+' && item[0] != '-') ||
          std::find(known.begin(), known.end(), name) == known.end())
         return Error{ErrorCode::usage, fmt::format("--effects: \"{}\" is not + or - and one of {}", item,
                                                    fmt::join(known, ", "))};
      setup.effects[name] = item[0] == '+';
      begin = end + 1;
   }
   return {};
}

Status applySetting(const std::string &text, Design &design)
{
   const auto parsed = parseValues({text});
   if (!parsed)
      return Error{ErrorCode::usage, "--set: " + parsed.error().message};
   const auto &[path, value] = *parsed->begin();
   if (path.rfind("solver.", 0) == 0) {
      design.setup.solverValues[path.substr(std::string_view("solver.").size())] = value;
      return {};
   }
   const double *number = std::get_if<double>(&value);
   if (!number)
      return Error{ErrorCode::usage,
                   fmt::format("--set {}: '{}' is not a number", path, std::get<std::string>(value))};
   if (path == "ground.present") {
      design.setup.ground.present = *number != 0;
      return {};
   }
   if (path.rfind("materials.", 0) == 0)
      return setMaterial(path, *number, design);
   for (const SetupNumber &one : kSetupNumbers)
      if (path == one.path) {
         one.of(design.setup) = *number;
         return {};
      }
   return unknownSetting(path);
}

} // namespace diatom::cli
