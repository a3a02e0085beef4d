// Each cell owns half of each of its bonds: a strain eps of the cell changes the bonds along its terminal
// axis by eps/2.
#include "model/actuation.h"

#include <algorithm>
#include <string>

namespace bonds {

using sdk::Failure;

double Signal::at(double time) const
{
   const double turns = frequency * time + phase, u = turns - std::floor(turns);
   double value = 0;
   if (waveform == 0)
      value = 0.5 * std::sin(2 * 3.14159265358979323846 * u);
   else if (waveform == 1)
      value = u < duty ? 0.5 : -0.5;
   else if (waveform == 2)
      value = inverted ? 0.5 - u : u - 0.5;
   else
      value = u < 0.5 ? 2 * u - 0.5 : 1.5 - 2 * u;
   return amplitude * value;
}

Actuation::Actuation(const sdk::SceneView &scene, const Assembly &assembly)
{
   setSources(scene.channel("source", 6));
   if (!assembly.actuated)
      return;
   const auto actuators = scene.channel("actuator", 5);
   for (std::int64_t i = 0; i < actuators.count(); ++i)
      addDriver(scene, assembly, actuators.where(i), actuators.row(i));
   for (const Share &share : m_shares)
      m_bonds.push_back(share.bond);
   std::sort(m_bonds.begin(), m_bonds.end());
   m_bonds.erase(std::unique(m_bonds.begin(), m_bonds.end()), m_bonds.end());
   for (Share &share : m_shares)
      share.bond = std::lower_bound(m_bonds.begin(), m_bonds.end(), share.bond) - m_bonds.begin();
   if (!active())
      return;
   for (int k = 0; k < 3; ++k) {
      m_initial.d[k].assign(static_cast<std::size_t>(assembly.links), 0);
      m_initial.phi[k].assign(static_cast<std::size_t>(assembly.links), 0);
   }
   for (std::int64_t i = 0; i < assembly.links; ++i)
      m_initial.d[0][i] = assembly.lengthOf(i);
   for (const std::int64_t bond : m_bonds) {
      m_length.push_back(assembly.lengthOf(bond));
      m_accepted.push_back({Vec3{assembly.lengthOf(bond), 0, 0}, Vec3{}});
   }
}

void Actuation::setSources(const sdk::Channel &sources)
{
   m_signals.clear();
   for (std::int64_t i = 0; i < sources.count(); ++i) {
      const double *row = sources.row(i);
      if (!(row[0] >= 0 && row[0] <= 3))
         throw Failure(DIATOM_BAD_INPUT, "source " + std::to_string(i) + " has an unknown waveform");
      m_signals.push_back({static_cast<int>(row[0]), row[1], row[2], row[3], row[5], row[4] != 0});
   }
   for (const Driver &driver : m_drivers)
      if (driver.plus >= static_cast<int>(m_signals.size()) ||
          driver.minus >= static_cast<int>(m_signals.size()))
         throw Failure(DIATOM_UNSUPPORTED, "there are fewer sources than the actuators use");
}

void Actuation::addDriver(const sdk::SceneView &scene, const Assembly &assembly, std::int64_t cell,
                          const double *row)
{
   const int mode = static_cast<int>(row[0]), axis = static_cast<int>(row[1]);
   const Driver driver{row[2], static_cast<int>(row[3]), static_cast<int>(row[4])};
   const int signals = static_cast<int>(m_signals.size());
   if (mode < 0 || mode > 3 || axis < 0 || axis > 2 || driver.plus >= signals || driver.minus >= signals)
      throw Failure(DIATOM_BAD_INPUT,
                    "the actuator " + scene.name(cell) + " has an unknown mode, axis or source");
   const Vec3 unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
   const Vec3 along = unit[axis];
   // The sheet's cells (amoeba.md 1.2): terminals along own x bend about own z, terminals along own z shear
   // along own x.
   const double *q = scene.orientation(cell);
   const Mat3 own = matrix({q[0], q[1], q[2], q[3]});
   const Vec3 terminal = transposed(own, along);
   const double part[3] = {std::abs(terminal.x), std::abs(terminal.y), std::abs(terminal.z)};
   const auto n = std::max_element(part, part + 3) - part;
   const Vec3 next = own * unit[(n + 1) % 3], previous = own * unit[(n + 2) % 3];
   const int number = static_cast<int>(m_drivers.size());
   m_drivers.push_back(driver);
   for (std::int64_t e = assembly.first[cell]; e < assembly.first[cell + 1]; ++e) {
      const std::int64_t bond = assembly.bondsOf[e] / 2;
      const Mat3 frame = assembly.frameOf(bond);
      const double sign = dot(frame.r0, along), length = assembly.lengthOf(bond);
      if (std::abs(sign) < 1 - 1e-6)
         continue;
      Share share{bond, number, {}, {}};
      if (mode == 0)
         share.d.x = length / 2;
      else if (mode == 1)
         share.d = (sign * length / 2) * (frame * next);
      else
         share.phi = (sign / 2) * (frame * (mode == 2 ? previous : along));
      m_shares.push_back(share);
   }
}

std::vector<bool> Actuation::driven(std::int64_t bonds) const
{
   std::vector<bool> out;
   if (active())
      out.resize(static_cast<std::size_t>(bonds));
   for (const std::int64_t bond : m_bonds)
      out[bond] = true;
   return out;
}

void Actuation::setRest(double time, RestShape &rest) const
{
   std::vector<double>::size_type i = 0;
   for (const std::int64_t bond : m_bonds) {
      rest.d[0][bond] = m_length[i++];
      rest.d[1][bond] = rest.d[2][bond] = rest.phi[0][bond] = rest.phi[1][bond] = rest.phi[2][bond] = 0;
   }
   std::vector<double> voltage;
   for (const Signal &signal : m_signals)
      voltage.push_back(signal.at(time));
   const auto volts = [&](int source) { return source < 0 ? 0.0 : voltage[source]; };
   int last = -1;
   double strain = 0;
   for (const Share &share : m_shares) {
      if (share.driver != last) {
         last = share.driver;
         const Driver &driver = m_drivers[last];
         strain = driver.gain * (volts(driver.plus) - volts(driver.minus));
      }
      const std::int64_t bond = m_bonds[share.bond];
      const double d[3] = {share.d.x, share.d.y, share.d.z}, phi[3] = {share.phi.x, share.phi.y, share.phi.z};
      for (int k = 0; k < 3; ++k) {
         rest.d[k][bond] += strain * d[k];
         rest.phi[k][bond] += strain * phi[k];
      }
   }
}

void Actuation::look(const Assembly &assembly, const State &state, std::vector<Relation> &seen) const
{
   seen.clear();
   for (const std::int64_t bond : m_bonds)
      seen.push_back(relationOf(assembly, state, bond));
}

double Actuation::energyChange(const Assembly &assembly, const std::vector<Relation> &seen,
                               const RestShape &rest) const
{
   const auto same = [](Vec3 a, Vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; };
   double change = 0;
   for (std::size_t i = 0; i < m_bonds.size(); ++i) {
      const std::int64_t bond = m_bonds[i];
      const std::array<Vec3, 2> now{rest.separation(bond), rest.turn(bond)};
      if (!same(now[0], m_accepted[i][0]) || !same(now[1], m_accepted[i][1]))
         change += energyGain(seen[i], assembly.constants[bond], m_accepted[i], now);
   }
   return change;
}

void Actuation::accept(const RestShape &rest)
{
   for (std::size_t i = 0; i < m_bonds.size(); ++i)
      m_accepted[i] = {rest.separation(m_bonds[i]), rest.turn(m_bonds[i])};
}

void Actuation::acceptAgain(const Shapes &shapes, RestShape &rest)
{
   m_accepted = shapes;
   for (std::size_t i = 0; i < m_bonds.size(); ++i) {
      const auto &[d, phi] = m_accepted[i];
      const double all[2][3] = {{d.x, d.y, d.z}, {phi.x, phi.y, phi.z}};
      for (int k = 0; k < 3; ++k) {
         rest.d[k][m_bonds[i]] = all[0][k];
         rest.phi[k][m_bonds[i]] = all[1][k];
      }
   }
}

} // namespace bonds
