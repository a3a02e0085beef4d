// Form "accuracy-ladder": how far the models are from the best that is known, gathered from the cases beside
// it, which are run for it.
#include "verify/forms.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

namespace diatom {

namespace {

using nlohmann::json;

/// Errors are listed with six digits of numbers near one.
constexpr double kListed = 2e-6;
/// The listed limit load is the largest of points on a path: 2e-5 below the load that the frame still carries
/// between them.
constexpr double kSampled = 5e-5;

/// A case of the same folder and what was computed for it.
struct Neighbour
{
   Case one;
   std::map<std::string, std::vector<double>> computed;
};

class Ladder
{
public:
   Ladder(const Case &one, const Bench &bench) : m_folder(one.file.parent_path()), m_bench(bench) {}

   /// Relative error of a model in a row; nothing where no rule knows the row or its case failed.
   std::optional<double> error(const json &row, const std::string &model);

private:
   const Neighbour *neighbour(const std::string &id);
   std::optional<double> computed(const std::string &id, const std::string &path, std::size_t i = 0);
   std::optional<double> relative(const std::string &id, const std::string &path, double truth,
                                  std::size_t i = 0)
   {
      const auto value = computed(id, path, i);
      return value ? std::optional(*value / truth - 1) : std::nullopt;
   }
   /// Number of the scenario of that name, -1 when there is none.
   static int scenario(const Neighbour &of, const std::string &name);

   std::optional<double> cantilever(const std::string &scene, const std::string &truth,
                                    const std::string &model);
   std::optional<double> named(const std::string &id, const std::string &name, const std::string &path);
   std::optional<double> bendingMode(const std::string &scene, const std::string &model);
   std::optional<double> leeFrame(const std::string &model);
   std::optional<double> freeBlock(const std::string &scene, const std::string &truth,
                                   const std::string &model);
   std::optional<double> flexure(const std::string &scene, const std::string &truth,
                                 const std::string &model);
   std::optional<double> composite(const std::string &scene, const std::string &model);
   std::optional<double> hinge(const std::string &scene, const std::string &model);
   std::optional<double> bimorph(const std::string &scene, const std::string &model);

   std::filesystem::path m_folder;
   const Bench &m_bench;
   std::map<std::string, std::optional<Neighbour>> m_neighbours;
};

const Neighbour *Ladder::neighbour(const std::string &id)
{
   const auto [at, added] = m_neighbours.try_emplace(id);
   if (added) {
      const auto one = readCase(m_folder / (id + ".json"));
      const auto forms = verificationForms();
      const auto form = one ? std::find_if(forms.begin(), forms.end(),
                                           [&](const Form &known) { return one->form == known.name; })
                            : forms.end();
      if (form != forms.end() && form->answer) {
         Findings findings(*one);
         if (form->answer(*one, m_bench, findings)) {
            at->second = Neighbour{*one, {}};
            for (Finding &finding : std::move(findings).take())
               if (!finding.computed.empty())
                  at->second->computed.try_emplace(finding.path, std::move(finding.computed));
         }
      }
   }
   return at->second ? &*at->second : nullptr;
}

std::optional<double> Ladder::computed(const std::string &id, const std::string &path, std::size_t i)
{
   const Neighbour *of = neighbour(id);
   const auto at =
       of ? of->computed.find(path) : std::map<std::string, std::vector<double>>::const_iterator();
   if (!of || at == of->computed.end() || i >= at->second.size())
      return std::nullopt;
   return at->second[i];
}

int Ladder::scenario(const Neighbour &of, const std::string &name)
{
   const json &scenarios = of.one.content.at("scenarios");
   for (std::size_t s = 0; s < scenarios.size(); ++s)
      if (scenarios[s].at("name") == name)
         return static_cast<int>(s);
   return -1;
}

/// What follows a word, to the next space or the end.
std::string after(const std::string &text, const std::string &word)
{
   const auto at = text.find(word);
   if (at == std::string::npos)
      return "";
   const auto begin = at + word.size();
   return text.substr(begin, text.find_first_of(" ,", begin) - begin);
}

/// A value of the scenario of a case that has this name.
std::optional<double> Ladder::named(const std::string &id, const std::string &name, const std::string &path)
{
   const Neighbour *of = neighbour(id);
   const int s = of ? scenario(*of, name) : -1;
   return s < 0 ? std::nullopt : computed(id, fmt::format("scenarios.{}.{}", s, path));
}

std::optional<double> Ladder::cantilever(const std::string &scene, const std::string &truth,
                                         const std::string &model)
{
   const std::string id = "c02-cantilever-iso", n = after(scene, "n=");
   const auto tip = named(id, "n=" + n, "expected.0.models." + model);
   if (!tip)
      return std::nullopt;
   const json &content = neighbour(id)->one.content;
   if (truth == "Timoshenko continuum") {
      const int s = scenario(*neighbour(id), "n=" + n);
      return *tip / content.at("scenarios")[static_cast<std::size_t>(s)]
                        .at("expected")[0]
                        .at("continuum")
                        .at("timoshenko")
                        .get<double>() -
             1;
   }
   for (const json &row : content.at("calculix").at("rows"))
      if (row.at("element") == "C3D20" && std::to_string(row.at("n").get<int>()) == n)
         return *tip / row.at("tip_uz_mean_m").get<double>() - 1;
   return std::nullopt;
}

std::optional<double> Ladder::bendingMode(const std::string &scene, const std::string &model)
{
   const std::string id = "c04-cantilever-modes";
   const Neighbour *of = neighbour(id);
   const int s = of ? scenario(*of, "cantilever N=" + after(scene, "N=")) : -1;
   const int mode = std::atoi(after(scene, "mode ").c_str());
   if (s < 0 || mode < 1)
      return std::nullopt;
   return computed(id, fmt::format("scenarios.{}.relative_to_timoshenko.{}", s, model),
                   static_cast<std::size_t>(mode) - 1);
}

std::optional<double> Ladder::leeFrame(const std::string &model)
{
   const Neighbour *of = neighbour("c03-lee-frame");
   if (!of)
      return std::nullopt;
   return relative("c03-lee-frame", "expected.discrete_mid_conservative." + model + ".limit_load",
                   of->one.content.at("expected").at("continuum").at("limit_load"));
}

std::optional<double> Ladder::freeBlock(const std::string &scene, const std::string &truth,
                                        const std::string &model)
{
   const Neighbour *of = neighbour("c04-free-block");
   if (!of)
      return std::nullopt;
   const std::size_t mode = scene.ends_with("third mode") ? 2 : 0;
   for (const json &solid : of->one.content.at("calculix_solid"))
      if (truth == fmt::format("CalculiX solid nu={:g}", solid.at("nu").get<double>()))
         return relative("c04-free-block", "expected." + model + ".first_10_nonrigid_rad_s",
                         solid.at("omega_rad_s").at(6 + mode), mode);
   return std::nullopt;
}

std::optional<double> Ladder::flexure(const std::string &scene, const std::string &truth,
                                      const std::string &model)
{
   const std::string id = "c09-shear-flexure-" + after(scene, "shear flexure ");
   const Neighbour *of = neighbour(id);
   if (!of)
      return std::nullopt;
   const json &rows = of->one.content.at("results");
   const bool linear = scene.find(" linear ") != std::string::npos;
   for (std::size_t r = 0; r < rows.size(); ++r)
      if ((rows[r].at("geometric") == "linear") == linear && rows[r].contains(truth))
         return relative(id, fmt::format("results.{}.{}.uy", r, model), rows[r].at(truth).at("uy"));
   return std::nullopt;
}

std::optional<double> Ladder::composite(const std::string &scene, const std::string &model)
{
   const std::string id = "c05-composite-bonds";
   const Neighbour *of = neighbour(id);
   if (!of)
      return std::nullopt;
   const json &scenarios = of->one.content.at("scenarios");
   for (std::size_t s = 0; s < scenarios.size(); ++s)
      if (scene == "composite bar " + scenarios[s].at("name").get<std::string>() + " transverse" ||
          scene == fmt::format("composite bar ratio {:g} {} transverse",
                               scenarios[s].at("ratio_E_A_over_E_B").get<double>(),
                               scenarios[s].at("name").get<std::string>().substr(
                                   scenarios[s].at("name").get<std::string>().rfind(' ') + 1)))
      {
         const auto found =
             computed(id, fmt::format("scenarios.{}.expected_transverse_tip_per_P.{}", s, model));
         const double bar = scenarios[s].at("true_bar_timoshenko").at("transverse_tip_per_P");
         return found ? std::optional(*found / bar - 1) : std::nullopt;
      }
   return std::nullopt;
}

std::optional<double> Ladder::hinge(const std::string &scene, const std::string &model)
{
   const std::string id = "c05-composite-bonds";
   const Neighbour *of = neighbour(id);
   if (!of)
      return std::nullopt;
   const json &rows = of->one.content.at("hinge_in_stiff_leg").at("rows");
   for (std::size_t r = 0; r < rows.size(); ++r)
      if (scene.ends_with(fmt::format(" {:g}", rows[r].at("bending_ratio").get<double>())))
         return relative(id,
                         fmt::format("hinge_in_stiff_leg.rows.{}.guided_tip_per_P.{}", r,
                                     model == "b_exact" ? "exact" : model),
                         rows[r].at("guided_tip_per_P").at("exact"));
   return std::nullopt;
}

std::optional<double> Ladder::bimorph(const std::string &scene, const std::string &model)
{
   const std::string id = "c09-bimorph";
   const Neighbour *of = neighbour(id);
   if (!of)
      return std::nullopt;
   const json &rows = of->one.content.at("results");
   for (std::size_t r = 0; r < rows.size(); ++r)
      if (scene.ends_with(fmt::format(" {:g}", rows[r].at("strain").get<double>())))
         return relative(id, fmt::format("results.{}.{}.tip_uy_mean_of_two", r, model),
                         -rows[r].at("closed_form").at("tip_deflection_arc").get<double>());
   return std::nullopt;
}

std::optional<double> Ladder::error(const json &row, const std::string &model)
{
   const auto scene = row.at("scene").get<std::string>(), truth = row.at("truth").get<std::string>();
   if (scene.starts_with("cantilever n="))
      return cantilever(scene, truth, model);
   if (scene.starts_with("elastica "))
      return named("c03-elastica-tip-force",
                   fmt::format("N={} alpha={}", after(scene, "N="), after(scene, "alpha=")),
                   "relative_tip_z_vs_reissner." + model);
   if (scene.starts_with("right-angle frame "))
      return named("c03-right-angle-frame", scene.substr(std::string_view("right-angle frame ").size()),
                   "relative_error_of_tip_displacement_vs_continuum." + model);
   if (scene.starts_with("buckling load "))
      return named("c03-column-buckling", "N=" + after(scene, "N="), "relative_to_euler." + model);
   if (scene.starts_with("Lee frame"))
      return leeFrame(model);
   if (scene.starts_with("bending mode "))
      return bendingMode(scene, model);
   if (scene.starts_with("free 4x4x4 block"))
      return freeBlock(scene, truth, model);
   if (scene.starts_with("shear flexure "))
      return flexure(scene, truth, model);
   if (scene.starts_with("composite bar "))
      return composite(scene, model);
   if (scene.starts_with("one hinge"))
      return hinge(scene, model);
   if (scene.starts_with("bimorph tip"))
      return bimorph(scene, model);
   return std::nullopt;
}

} // namespace

Status answerAccuracyLadder(const Case &one, const Bench &bench, Findings &findings)
{
   Ladder ladder(one, bench);
   const json &rows = one.content.at("rows");
   for (std::size_t r = 0; r < rows.size(); ++r) {
      const auto scene = rows[r].at("scene").get<std::string>();
      for (const auto &[model, expected] : rows[r].at("relative_error").items()) {
         const std::string path = fmt::format("rows.{}.relative_error.{}", r, model);
         if (const auto error = ladder.error(rows[r], model))
            findings.compare(path, *error,
                             Tolerance::absolute(scene.starts_with("Lee frame") ? kSampled : kListed), scene);
         else if (scene.starts_with("primitive "))
            findings.skip(
                path, "its plates sit on the outer faces, joined by bonds of half a length, which a lattice "
                      "of whole cells does not have");
         else
            findings.fail(path, "the case of this row is not beside this one, or could not be answered");
      }
   }
   return {};
}

} // namespace diatom
