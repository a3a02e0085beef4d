// Form "contact-friction": cells that fall, slide, stick and stand on the ground.
#include "verify/forms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace diatom {

namespace {

using nlohmann::json;

constexpr std::uint8_t kTurns = 0x38;

class OnGround
{
public:
   OnGround(const Case &one, const Bench &bench, Findings &findings)
       : m_content(one.content), m_bench(bench), m_findings(findings),
         m_pitch(m_content.at("cell").at("pitch")), m_mass(m_content.at("cell").at("mass")),
         m_gravity(m_content.at("g"))
   {}

   Status drop(std::size_t number);
   Status slide();
   Status incline(std::size_t number);
   Status column();

private:
   /// One cell whose lower face starts `gap` above the ground.
   CaseScene cell(double gap, double stiffness, double damping, double friction,
                  std::uint8_t held = kTurns) const;
   Result<std::unique_ptr<Simulation>> start(const CaseScene &scene, const char *integrator) const
   {
      return motionOf(m_bench, scene, {{"integrator", integrator}});
   }
   Result<double> at(Simulation &motion, double time, const char *channel) const;

   const json &m_content;
   const Bench &m_bench;
   Findings &m_findings;
   double m_pitch, m_mass, m_gravity;
};

CaseScene OnGround::cell(double gap, double stiffness, double damping, double friction,
                         std::uint8_t held) const
{
   CaseScene scene(m_pitch);
   Material material;
   material.density = m_mass / (m_pitch * m_pitch * m_pitch);
   scene.cell(kOrigin, scene.add(material));
   scene.hold(kOrigin, held);
   scene.setup().gravity = {0, 0, -m_gravity};
   scene.setup().ground = {true, -0.5 * m_pitch - gap, stiffness, damping, friction};
   return scene;
}

Result<double> OnGround::at(Simulation &motion, double time, const char *channel) const
{
   if (const Status moved = motion.advance(time, *m_bench.job); !moved)
      return moved.error();
   return motion.probe(0, channel, *m_bench.job);
}

/// Events of a drop, from heights and speeds at even times: straight between two of them.
struct Bounce
{
   double touch = -1, touchSpeed = 0, deepest = 0, deepestTime = 0, lift = -1, liftHeight = 0, liftSpeed = 0,
          apex = 0;
};

Status OnGround::drop(std::size_t number)
{
   const json &drop = m_content.at("drop")[number];
   const std::string path = fmt::format("drop.{}.", number);
   const double gap = drop.at("gap_height_h"), k = drop.at("k_contact"), c = drop.at("c_contact");
   CaseScene scene = cell(gap, k, c, 0);
   const double duration = drop.at("contact_duration"), step = duration / 400;
   scene.setup().step = step;
   const auto motion = start(scene, "verlet");
   if (!motion)
      return motion.error();
   Bounce b;
   b.apex = -HUGE_VAL;
   // Up to the next apex and a little on; free flight wants no small steps, but that is the case's bar.
   const double end = drop.at("t_touch").get<double>() + duration +
                      1.2 * drop.at("v_at_liftoff").get<double>() / m_gravity + 4 * step;
   double z = 0, v = 0, time = 0;
   const auto force = [&](double height, double speed) { return k * -(height + gap) - c * speed; };
   while (time < end) {
      const double next = time + step;
      const auto height = at(**motion, next, "z"), speed = at(**motion, next, "vz");
      if (!height || !speed)
         return height ? speed.error() : height.error();
      if (b.touch < 0 && *height <= -gap) {
         const double f = (z + gap) / (z - *height);
         b.touch = time + f * step;
         b.touchSpeed = -(v + f * (*speed - v));
      }
      if (b.touch >= 0 && b.lift < 0 && -gap - *height > b.deepest) {
         b.deepest = -gap - *height;
         b.deepestTime = next;
      }
      // The ground pushes only: a cell leaves it where the damped spring would pull.
      if (b.touch >= 0 && b.lift < 0 && time > b.touch && force(*height, *speed) <= 0 && *speed > 0) {
         const double before = force(z, v), after = force(*height, *speed), f = before / (before - after);
         b.lift = time + f * step;
         b.liftHeight = z + f * (*height - z) + gap;
         b.liftSpeed = v + f * (*speed - v);
      }
      if (b.lift >= 0)
         b.apex = std::max(b.apex, *height + gap);
      z = *height;
      v = *speed;
      time = next;
   }
   const auto bar = Tolerance::relative(m_content.at("tol").at("bounce_rel"));
   m_findings.compare(path + "t_touch", b.touch, bar);
   m_findings.compare(path + "v_touch", b.touchSpeed, bar);
   m_findings.compare(path + "max_penetration", b.deepest, bar);
   m_findings.compare(path + "time_of_max_penetration_after_touch", b.deepestTime - b.touch, bar);
   m_findings.compare(path + "max_normal_force_at_max_penetration", k * b.deepest, bar,
                      "stiffness times the computed penetration, where the speed is nothing");
   m_findings.compare(path + "contact_duration", b.lift - b.touch, bar);
   m_findings.compare(path + "z_at_liftoff", b.liftHeight,
                      Tolerance::of(bar.most, drop.at("max_penetration"), "of the deepest penetration"));
   m_findings.compare(path + "v_at_liftoff", b.liftSpeed, bar);
   m_findings.compare(path + "restitution", b.liftSpeed / b.touchSpeed, bar);
   m_findings.compare(path + "next_apex_above_touch_height", b.apex, bar);
   const auto still = balanceOf(m_bench, cell(0, k, c, 0, kTurns | 0x03), {});
   if (!still)
      return still.error();
   m_findings.compare(path + "static_penetration", -still->displacement(kOrigin).z(), bar);
   return {};
}

Status OnGround::slide()
{
   const json &slide = m_content.at("slide");
   const double stiffness = 2000, sunk = m_mass * m_gravity / stiffness, stop = slide.at("t_stop");
   CaseScene scene = cell(-sunk, stiffness, 0.5, slide.at("mu"));
   Start start;
   start.where = kOrigin;
   start.velocity[0] = slide.at("v0");
   scene.setup().starts.push_back(start);
   scene.setup().step = stop / 2e4;
   const auto motion = this->start(scene, "semi_implicit");
   if (!motion)
      return motion.error();
   const auto bar = Tolerance::relative(m_content.at("tol").at("slide_rel"));
   double before = slide.at("v0"), timeBefore = 0;
   for (std::size_t i = 0; i < slide.at("samples").size(); ++i) {
      const json &sample = slide.at("samples")[i];
      timeBefore = sample.at("t");
      const auto x = at(**motion, timeBefore, "x"), v = at(**motion, timeBefore, "vx");
      if (!x || !v)
         return x ? v.error() : x.error();
      m_findings.compare(fmt::format("slide.samples.{}.x", i), *x, bar);
      m_findings.compare(fmt::format("slide.samples.{}.v", i), *v, bar);
      before = *v;
   }
   // Where the last speed, falling evenly, would be nothing.
   const auto end = at(**motion, 2 * stop, "x"), still = at(**motion, 2 * stop, "vx");
   if (!end || !still)
      return end ? still.error() : end.error();
   m_findings.compare("slide.distance", *end, bar);
   m_findings.compare("slide.t_stop", timeBefore + before / (slide.at("mu").get<double>() * m_gravity), bar,
                      "from the last sample's speed, which friction takes away evenly");
   m_findings.check("slide: speed after the stop over that at the start",
                    std::abs(*still) / slide.at("v0").get<double>(), 1e-6);
   return {};
}

Status OnGround::incline(std::size_t number)
{
   const json &incline = m_content.at("incline")[number];
   const std::string path = fmt::format("incline.{}.", number);
   const Vec3 gravity = vectorOf(incline.at("gravity_vector"));
   // The case leaves the ground's stiffness open. Until the grip of the ground is drawn as far as friction
   // holds, friction is less than its limit, and a cell let go of gains sqrt(g mass g / stiffness) or so:
   // little on a stiff one.
   const double stiffness = 1e9, damping = 0.3 * std::sqrt(stiffness * m_mass);
   const double sunk = -m_mass * gravity.z() / stiffness, time = incline.at("T"),
                mu = m_content.at("slide").at("mu");
   CaseScene scene = cell(-sunk, stiffness, damping, mu);
   scene.setup().gravity = {gravity.x(), gravity.y(), gravity.z()};
   const auto motion = start(scene, "semi_implicit");
   if (!motion)
      return motion.error();
   const auto x = at(**motion, time, "x"), v = at(**motion, time, "vx");
   if (!x || !v)
      return x ? v.error() : x.error();
   const bool sticks = incline.at("verdict") == "sticks";
   const double creepAllowed = m_content.at("tol").at("incline_creep_over_l").get<double>() * m_pitch;
   m_findings.compareWord(path + "verdict", std::abs(*x) <= creepAllowed ? "sticks" : "slides");
   const double creep = m_content.at("tol").at("incline_creep_over_l"),
                rel = m_content.at("tol").at("slide_rel");
   const auto bar = sticks ? Tolerance::of(creep, m_pitch, "of the pitch") : Tolerance::relative(rel);
   m_findings.compare(path + "distance_after_T", *x, bar);
   m_findings.compare(path + "v_after_T", *v,
                      sticks ? Tolerance::of(creep, m_pitch / time, "of the pitch over T") : bar);
   m_findings.compare(path + "acceleration", *v / time,
                      sticks ? Tolerance::of(creep, m_gravity, "of g") : bar, "speed over time");
   return {};
}

Status OnGround::column()
{
   const json &column = m_content.at("column_at_rest");
   const int n = column.at("n");
   CaseScene scene(m_pitch);
   const double k = column.at("k_axial");
   Material material;
   material.density = m_mass / (m_pitch * m_pitch * m_pitch);
   material.poissonRatio = 0;
   material.youngsModulus = k / m_pitch;
   scene.box(kOrigin, {0, 0, n - 1}, scene.add(material));
   scene.hold(kOrigin, kTurns | 0x03);
   scene.setup().gravity = {0, 0, -m_gravity};
   scene.setup().ground = {true, -0.5 * m_pitch, column.at("k_contact"), 0, 0};
   const auto still = balanceOf(m_bench, scene, {});
   if (!still)
      return still.error();
   const auto bar = Tolerance::relative(m_content.at("tol").at("column_rel"));
   std::vector<double> shortened;
   for (int i = 0; i + 1 < n; ++i)
      shortened.push_back(still->displacement({0, 0, i}).z() - still->displacement({0, 0, i + 1}).z());
   m_findings.compare("column_at_rest.penetration_of_bottom_cell", -still->displacement(kOrigin).z(), bar);
   m_findings.compare("column_at_rest.bond_shortening_bottom_to_top", shortened, Tolerance::each(bar.most));
   m_findings.compare("column_at_rest.top_cell_lowering", -still->displacement({0, 0, n - 1}).z(), bar);
   return {};
}

} // namespace

Status answerContact(const Case &one, const Bench &bench, Findings &findings)
{
   OnGround ground(one, bench, findings);
   const auto answer = [&](const std::string &pattern, const Status &done) {
      if (!done)
         findings.fail(pattern, done.error().message);
   };
   for (std::size_t i = 0; i < one.content.at("drop").size(); ++i)
      answer(fmt::format("drop.{}.*", i), ground.drop(i));
   answer("slide.*", ground.slide());
   for (std::size_t i = 0; i < one.content.at("incline").size(); ++i)
      answer(fmt::format("incline.{}.*", i), ground.incline(i));
   answer("column_at_rest.*", ground.column());
   findings.skip("slide_with_rolling*",
                 "it takes a point of contact below the centre; ours is the face of a cell, which "
                 "does not roll, and the case wants the contact's geometry stated");
   findings.skip("cell_cell_collision*",
                 "cells that are not joined do not touch each other in this solver yet");
   findings.skip("*", "given, not asked");
   return {};
}

} // namespace diatom
