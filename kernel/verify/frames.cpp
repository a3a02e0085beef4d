// Form "space-frame": a frame of anisotropic cells that may be turned, at rest, swinging and after a blow.
#include "verify/forms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace diatom {

namespace {

using nlohmann::json;

/// What is proportional in the case is asked with this part of the load, and scaled back.
constexpr double kSmallStart = 1e-4;

class SpaceFrame
{
public:
   SpaceFrame(const Case &one, const Bench &bench) : m_content(one.content), m_bench(bench) {}

   Status build();
   void answer(const std::string &model, Findings &findings) const;

private:
   void statics(const std::string &model, Findings &findings) const;
   void farStatics(const std::string &model, Findings &findings) const;
   void vibrations(const std::string &model, Findings &findings) const;
   Status blow(const std::string &model, Findings &findings) const;
   CaseScene loaded(double factor) const;
   const json &expected(const std::string &model) const { return m_content.at("expected").at(model); }

   const json &m_content;
   const Bench &m_bench;
   CaseScene m_scene{1};
};

Status SpaceFrame::build()
{
   m_scene = CaseScene(m_content.at("lattice").at("pitch"));
   const auto lattice = Lattice::make(*m_bench.catalogue, m_scene.model().lattice, *m_bench.job);
   if (!lattice)
      return lattice.error();
   std::map<std::string, MaterialIndex> bases;
   for (const auto &[name, base] : m_content.at("base_materials").items()) {
      bases[name] = m_scene.materialOf(base);
      const Vec3 inertia = vectorOf(base.at("inertia_body"));
      m_scene.change(bases[name], [&](Material &material) {
         material.inertia = {inertia.x(), inertia.y(), inertia.z()};
      });
   }
   const auto &rotations = (*lattice)->shape(0).rotations;
   for (const json &cell : m_content.at("cells")) {
      const json &type = m_content.at("types").at(cell.at("type").get<std::string>());
      const Quat turn = turnOf(type.at("orientation_xyzw"));
      const auto same = std::find_if(rotations.begin(), rotations.end(),
                                     [&](const Quat &q) { return std::abs(q.dot(turn)) > 1 - 1e-6; });
      if (same == rotations.end())
         return Error{ErrorCode::invalid, "a cell is turned otherwise than by quarter turns"};
      m_scene.cell(indexOf(cell.at("at")), bases.at(type.at("base")),
                   static_cast<std::uint8_t>(same - rotations.begin()));
   }
   for (const json &held : m_content.at("boundary"))
      for (const json &cell : held.at("cells"))
         m_scene.hold(indexOf(cell));
   return {};
}

CaseScene SpaceFrame::loaded(double factor) const
{
   CaseScene scene = m_scene;
   const json &load = m_content.at("load");
   scene.load(indexOf(load.at("cell")), factor * vectorOf(load.at("force")),
              factor * vectorOf(load.at("torque")));
   return scene;
}

/// Largest number of one kind in the rows of a case.
double largest(const json &rows, const char *key)
{
   double most = 0;
   for (const json &row : rows)
      most = std::max(most, vectorOf(row.at(key)).cwiseAbs().maxCoeff());
   return most;
}

void SpaceFrame::statics(const std::string &model, Findings &findings) const
{
   const std::string path = fmt::format("expected.{}.linear_static", model);
   const auto answer = balanceOf(m_bench, loaded(kSmallStart), modelValues(model));
   if (!answer)
      return findings.fail(path + "*", answer.error().message);
   const json &rows = expected(model).at("linear_static");
   const double most = m_content.at("tol").at("linear_rel");
   for (std::size_t i = 0; i < rows.size(); ++i) {
      const Index at = indexOf(rows[i].at("cell"));
      const Vec3 moved = answer->displacement(at) / kSmallStart,
                 turned = rotationVector(answer->turn(at)) / kSmallStart;
      findings.compare(fmt::format("{}.{}.u", path, i), {moved.data(), 3},
                       Tolerance::of(most, largest(rows, "u"), "of the largest displacement"));
      findings.compare(fmt::format("{}.{}.rot", path, i), {turned.data(), 3},
                       Tolerance::of(most, largest(rows, "rot"), "of the largest turn"));
   }
   findings.skip(path + ".*.cell", "given, not asked");
}

void SpaceFrame::farStatics(const std::string &model, Findings &findings) const
{
   const std::string path = fmt::format("expected.{}.nonlinear_static_mid_conservative", model);
   findings.skip(path + ".load_factor", "given, not asked");
   findings.skip(path + ".*.cell", "given, not asked");
   const json &asked = expected(model).at("nonlinear_static_mid_conservative");
   const auto answer = balanceOf(m_bench, loaded(asked.at("load_factor")), modelValues(model));
   if (!answer)
      return findings.fail(path + "*", answer.error().message);
   const json &rows = asked.at("cells");
   const double most = m_content.at("tol").at("nonlinear_mid_rel");
   for (std::size_t i = 0; i < rows.size(); ++i) {
      const Index at = indexOf(rows[i].at("cell"));
      const Vec3 moved = answer->displacement(at);
      findings.compare(fmt::format("{}.cells.{}.x_minus_X", path, i), {moved.data(), 3},
                       Tolerance::of(most, largest(rows, "x_minus_X"), "of the largest displacement"));
      Quat turn = answer->turn(at);
      if (turn.dot(turnOf(rows[i].at("q_xyzw"))) < 0)
         turn.coeffs() = -turn.coeffs();
      const double four[4] = {turn.x(), turn.y(), turn.z(), turn.w()};
      findings.compare(fmt::format("{}.cells.{}.q_xyzw", path, i), four, Tolerance::absolute(most));
   }
}

void SpaceFrame::vibrations(const std::string &model, Findings &findings) const
{
   const double most = m_content.at("tol").at("omega_rel");
   Values values = modelValues(model);
   const std::string path = "expected." + model;
   values["modes"] = static_cast<double>(expected(model).at("omega_first_6").size());
   const auto low = modesOf(m_bench, m_scene, values);
   values["modes"] = 1.0;
   values["modes_from"] = "highest";
   const auto high = modesOf(m_bench, m_scene, values);
   if (!low || !high)
      return findings.fail(path + ".omega*", low ? high.error().message : low.error().message);
   std::vector<double> omega;
   for (const Mode &mode : low->modes)
      omega.push_back(std::sqrt(std::max(0.0, mode.eigenvalue)));
   findings.compare(path + ".omega_first_6", omega, Tolerance::each(most));
   findings.compare(path + ".omega_max", std::sqrt(high->modes.back().eigenvalue), Tolerance::relative(most));
}

/// The free motion after a blow, so weak that it is proportional to it.
Status SpaceFrame::blow(const std::string &model, Findings &findings) const
{
   const json &rows = expected(model).at("impulse_response_linear"),
              &linear = expected(model).at("linear_static");
   const json &start = m_content.at("initial_velocity_for_impulse");
   CaseScene scene = m_scene;
   const Vec3 velocity = kSmallStart * vectorOf(start.at("v"));
   Start first;
   first.where = indexOf(start.at("cell"));
   first.velocity = {velocity.x(), velocity.y(), velocity.z()};
   scene.setup().starts.push_back(first);
   scene.setup().step = 0.1 / expected(model).at("omega_max").get<double>();
   Values values = modelValues(model);
   values["integrator"] = "verlet";
   auto motion = motionOf(m_bench, scene, values);
   if (!motion)
      return motion.error();
   double peak = 0;
   for (const json &row : rows)
      for (const json &u : row.at("u"))
         peak = std::max(peak, vectorOf(u).cwiseAbs().maxCoeff());
   for (std::size_t i = 0; i < rows.size(); ++i) {
      if (const Status moved = (*motion)->advance(rows[i].at("t"), *m_bench.job); !moved)
         return moved.error();
      for (std::size_t c = 0; c < rows[i].at("u").size(); ++c) {
         const auto u = displacementOf(**motion, indexOf(linear.at(c).at("cell")), *m_bench.job);
         if (!u)
            return u.error();
         const Vec3 moved = *u / kSmallStart;
         findings.compare(fmt::format("expected.{}.impulse_response_linear.{}.u.{}", model, i, c),
                          {moved.data(), 3},
                          Tolerance::of(m_content.at("tol").at("impulse_over_peak"), peak, "of the peak"));
      }
   }
   return {};
}

void SpaceFrame::answer(const std::string &model, Findings &findings) const
{
   statics(model, findings);
   farStatics(model, findings);
   vibrations(model, findings);
   const std::string path = fmt::format("expected.{}.impulse_response_linear", model);
   if (const Status done = blow(model, findings); !done)
      findings.fail(path + "*", done.error().message);
   findings.skip(path + ".*.t", "given, not asked");
}

} // namespace

Status answerSpaceFrame(const Case &one, const Bench &bench, Findings &findings)
{
   SpaceFrame frame(one, bench);
   if (Status built = frame.build(); !built)
      return built;
   for (const char *model : kModels)
      frame.answer(model, findings);
   return {};
}

} // namespace diatom
