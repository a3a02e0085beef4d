// What pulls at a scene at a time, and how it is changed between two balances.
#include "equilibrium/balance.h"

#include <cmath>
#include <string>

namespace bonds {

using sdk::Failure;

namespace {

Vec3 mixed(Vec3 a, Vec3 b, double f) { return a + f * (b - a); }

void mix(const Column &a, const Column &b, double f, Column &out)
{
   out.resize(std::max(a.size(), b.size()));
   for (std::size_t i = 0; i < out.size(); ++i) {
      const double from = i < a.size() ? a[i] : 0, to = i < b.size() ? b[i] : 0;
      out[i] = from + f * (to - from);
   }
}

} // namespace

Loading blend(const Loading &a, const Loading &b, double f)
{
   Loading out;
   out.gravity = mixed(a.gravity, b.gravity, f);
   mix(a.force, b.force, f, out.force);
   mix(a.driven, b.driven, f, out.driven);
   for (int k = 0; k < 3; ++k) {
      mix(a.rest.d[k], b.rest.d[k], f, out.rest.d[k]);
      mix(a.rest.phi[k], b.rest.phi[k], f, out.rest.phi[k]);
   }
   return out;
}

void Balance::setLoads(const sdk::Channel &loads)
{
   m_force.assign(static_cast<std::size_t>(6 * m_assembly.cells), 0);
   for (std::int64_t i = 0; i < loads.count(); ++i)
      for (int k = 0; k < 6; ++k)
         m_force[6 * loads.where(i) + k] += loads.row(i)[k];
}

void Balance::apply(std::span<const diatom_channel> channels)
{
   for (const diatom_channel &channel : channels) {
      const std::string_view name = channel.name;
      if (name == "force" && m_assembly.hasLoads)
         setLoads(sdk::findChannel(channels, name, 6, m_assembly.cells));
      else if (name == "source")
         m_actuation.setSources(sdk::findChannel(channels, name, 6, -1));
      else if (name == "curve")
         m_supports.setCurves(channels);
      else if (name == "gravity" && m_assembly.hasGravity && channel.count == 1)
         std::copy_n(sdk::findChannel(channels, name, 3, -1).row(0), 3, m_assembly.gravity.begin());
      else
         throw Failure(DIATOM_UNSUPPORTED, "a change of \"" + std::string(name) + "\" needs a new run");
   }
}

Loading Balance::loadingAt(double time) const
{
   Loading out;
   if (m_assembly.hasGravity)
      out.gravity = {m_assembly.gravity[0], m_assembly.gravity[1], m_assembly.gravity[2]};
   out.force = m_force;
   if (m_actuation.active()) {
      out.rest = m_actuation.shape();
      m_actuation.setRest(time, out.rest);
   }
   out.driven = m_supports.targets(time);
   return out;
}

Loading Balance::unloaded(const State &state) const
{
   Loading out;
   out.force.assign(m_force.size(), 0);
   if (m_actuation.active())
      out.rest = m_actuation.shape();
   for (const Driven &driven : m_supports.driven()) {
      const Vec3 u = state.displacementOf(driven.cell), turn = state.turnVectorOf(driven.cell);
      const double at[6] = {u.x, u.y, u.z, turn.x, turn.y, turn.z};
      out.driven.push_back(at[driven.freedom]);
   }
   return out;
}

} // namespace bonds
