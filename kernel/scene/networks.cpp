#include "scene/networks.h"

#include "scene/problems.h"
#include "scene/wiring.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace diatom {

namespace {

/// Puts sources and actuators on the nets and reports what does not fit.
class NetworkFinder
{
public:
   NetworkFinder(const Hierarchy &hierarchy, const Setup &setup, Wiring wiring)
       : m_hierarchy(hierarchy), m_setup(setup), m_wiring(std::move(wiring))
   {}

   Networks find()
   {
      m_result.nets.resize(static_cast<std::size_t>(m_wiring.groups));
      for (std::int32_t cell = 0; cell < m_wiring.cells.count(); ++cell)
         if (netOf(cell) >= 0)
            net(netOf(cell)).cells.push_back(index(cell));
      attachSources();
      attachActuators();
      checkNets();
      checkPorts();
      return std::move(m_result);
   }

private:
   void attachSources();
   void attachTwoTerminalSource(int source, std::int32_t cell);
   void attachActuators();
   void attachActuator(std::int32_t cell);
   void checkNets();
   void checkPorts();

   const Material &material(std::int32_t cell) const
   {
      return m_hierarchy.model().material(m_wiring.cells.cell[static_cast<std::size_t>(cell)].material);
   }
   Index index(std::int32_t cell) const { return m_wiring.cells.index[static_cast<std::size_t>(cell)]; }
   WiringPart part(std::int32_t cell) const { return m_wiring.part[static_cast<std::size_t>(cell)]; }
   Network &net(int number) { return m_result.nets[static_cast<std::size_t>(number)]; }
   int netOf(std::int32_t cell) const { return m_wiring.group[static_cast<std::size_t>(cell)]; }
   void report(Problem::Severity severity, const char *kind, std::string text, std::vector<Index> cells)
   {
      if (!cells.empty())
         m_result.problems.push_back({severity, kind, std::move(text), std::move(cells)});
   }

   const Hierarchy &m_hierarchy;
   const Setup &m_setup;
   Wiring m_wiring;
   std::vector<Index> m_floating, m_ambiguous, m_slanted, m_shorted;
   Networks m_result;
};

void NetworkFinder::attachSources()
{
   std::vector<Index> misplaced, silent;
   std::vector<bool> given(m_wiring.part.size(), false);
   for (std::size_t k = 0; k < m_setup.sources.size(); ++k) {
      const Index where = m_setup.sources[k].cell;
      const auto cell = static_cast<std::int32_t>(m_wiring.cells.find(where));
      if (cell < 0 || part(cell) == WiringPart::actuator) {
         if (inRange(where) && !m_hierarchy.at(where).empty())
            misplaced.push_back(where);
         continue;
      }
      given[static_cast<std::size_t>(cell)] = true;
      if (part(cell) == WiringPart::twoTerminalSource)
         attachTwoTerminalSource(static_cast<int>(k), cell);
      else
         net(netOf(cell)).sources.push_back(static_cast<int>(k));
   }
   for (std::int32_t cell = 0; cell < m_wiring.cells.count(); ++cell)
      if (material(cell).role == ElectricalRole::source && !given[static_cast<std::size_t>(cell)])
         silent.push_back(index(cell));
   report(
       Problem::Severity::error, "source-not-conductive",
       fmt::format(
           "a source is set on a cell that does not conduct: {}; make it a source or conductor cell, or move "
           "the source",
           indicesText(misplaced)),
       misplaced);
   report(Problem::Severity::warning, "source-without-signal",
          fmt::format("a source cell has no signal: {}; give it a waveform, or it stays at 0 V",
                      indicesText(silent)),
          silent);
}

void NetworkFinder::attachTwoTerminalSource(int source, std::int32_t cell)
{
   int plus = -1, minus = -1;
   for (const TerminalContact &contact : m_wiring.contactsOf(cell)) {
      // The port of the higher number is +: of an opposite pair that is the one towards the + axis.
      const bool higher = (m_wiring.ports[static_cast<std::size_t>(cell)] >> (contact.port + 1)) == 0;
      (higher ? plus : minus) = netOf(contact.conductor);
   }
   const std::string where = indexText(index(cell));
   if (plus >= 0 && plus == minus) {
      report(Problem::Severity::error, "source-shorted",
             fmt::format("both terminals of the source at {} are on one net; interrupt the wire between them",
                         where),
             {index(cell)});
      return;
   }
   if (plus < 0 || minus < 0)
      report(
          Problem::Severity::warning, "open-source",
          fmt::format("a terminal of the source at {} touches no conductor; wire it or turn the cell", where),
          {index(cell)});
   if (plus >= 0)
      net(plus).sources.push_back(source);
   if (minus >= 0)
      net(minus).returns.push_back(source);
}

void NetworkFinder::attachActuators()
{
   for (std::int32_t cell = 0; cell < m_wiring.cells.count(); ++cell)
      if (part(cell) == WiringPart::actuator)
         attachActuator(cell);
   report(Problem::Severity::error, "floating-actuator",
          fmt::format(
              "an actuator has an open terminal and stays passive: {}; put conductors on two opposite faces",
              indicesText(m_floating)),
          m_floating);
   report(
       Problem::Severity::error, "ambiguous-actuator",
       fmt::format(
           "conductors do not meet an actuator on exactly two opposite faces, so that it stays passive: {}; "
           "remove the others",
           indicesText(m_ambiguous)),
       m_ambiguous);
   report(Problem::Severity::error, "slanted-actuator",
          fmt::format("the terminals of an actuator lie along no axis, which solvers cannot drive: {}; wire "
                      "it along x, y "
                      "or z",
                      indicesText(m_slanted)),
          m_slanted);
   report(
       Problem::Severity::error, "shorted-actuator",
       fmt::format(
           "both terminals of an actuator are on one net, so that it stays passive: {}; interrupt the wire "
           "between them, or use an actuator that takes its axis from its wires",
           indicesText(m_shorted)),
       m_shorted);
}

void NetworkFinder::attachActuator(std::int32_t cell)
{
   const auto contacts = m_wiring.contactsOf(cell);
   if (contacts.size() < 2) {
      m_floating.push_back(index(cell));
      return;
   }
   if (contacts.size() > 2 || contacts[0].direction.dot(contacts[1].direction) > -0.999) {
      m_ambiguous.push_back(index(cell));
      return;
   }
   const int axis = axisOfDirection(contacts[0].direction);
   if (axis < 0) {
      m_slanted.push_back(index(cell));
      return;
   }
   const bool firstIsPlus = contacts[0].direction[axis] > 0;
   const int minus = netOf(contacts[firstIsPlus ? 1 : 0].conductor);
   const int plus = netOf(contacts[firstIsPlus ? 0 : 1].conductor);
   if (minus == plus && !material(cell).actuation.axisFromWires) {
      m_shorted.push_back(index(cell));
      return;
   }
   m_result.actuators.push_back({index(cell), axis, minus, plus});
   net(minus).actuators.push_back(index(cell));
   if (plus != minus)
      net(plus).actuators.push_back(index(cell));
}

void NetworkFinder::checkNets()
{
   for (const Network &one : m_result.nets) {
      std::vector<Index> drivers;
      for (const auto *list : {&one.sources, &one.returns})
         for (const int source : *list)
            drivers.push_back(m_setup.sources[static_cast<std::size_t>(source)].cell);
      std::sort(drivers.begin(), drivers.end());
      if (!one.sources.empty() && !one.returns.empty())
         report(Problem::Severity::error, "opposite-polarity",
                fmt::format("sources drive one net with opposite polarity: {}; separate them",
                            indicesText(drivers)),
                drivers);
      else if (drivers.size() > 1)
         report(
             Problem::Severity::error, "two-sources",
             fmt::format("{} sources drive one net: {}; keep one of them or interrupt the wire between them",
                         drivers.size(), indicesText(drivers)),
             drivers);
      else if (!drivers.empty() && drivers == one.cells && one.actuators.empty())
         report(
             Problem::Severity::warning, "open-source",
             fmt::format("the source at {} touches no conductor; wire it or remove it", indicesText(drivers)),
             drivers);
      else if (drivers.empty() && !one.actuators.empty())
         report(Problem::Severity::warning, "net-without-source",
                fmt::format("the net at {} feeds {} actuators but has no source, so that it stays at 0 V; "
                            "put a source on it",
                            indexText(one.cells.front()), one.actuators.size()),
                one.cells);
   }
}

void NetworkFinder::checkPorts()
{
   std::vector<Index> blind;
   for (std::size_t i = 0; i < m_wiring.part.size(); ++i)
      if (m_wiring.part[i] == WiringPart::conductor && m_wiring.ports[i] != kAllPorts &&
          (m_wiring.ports[i] & ~m_wiring.met[i]) != 0 && m_wiring.box[i])
         blind.push_back(m_wiring.cells.index[i]);
   report(
       Problem::Severity::warning, "port-facing-nothing",
       fmt::format("a conductor has a port that meets no other port: {}; turn the cell or continue the wire",
                   indicesText(blind)),
       blind);
}

} // namespace

Networks findNetworks(const Hierarchy &hierarchy, const Setup &setup, const Job &job)
{
   auto wiring = findWiring(hierarchy, job);
   if (wiring)
      return NetworkFinder(hierarchy, setup, *std::move(wiring)).find();
   Networks none;
   none.problems.push_back({Problem::Severity::error,
                            "not-examined",
                            "the wiring was not examined: " + wiring.error().message,
                            {}});
   return none;
}

double sourceVoltage(const Source &source, double time)
{
   constexpr double kPi = 3.14159265358979323846;
   const double turns = source.frequency * time + source.phase;
   const double u = turns - std::floor(turns);
   double value = 0;
   switch (source.waveform) {
   case Waveform::sine:
      value = 0.5 * std::sin(2 * kPi * u);
      break;
   case Waveform::square:
      value = u < source.duty ? 0.5 : -0.5;
      break;
   case Waveform::saw:
      value = source.inverted ? 0.5 - u : u - 0.5;
      break;
   case Waveform::triangle:
      value = u < 0.5 ? 2 * u - 0.5 : 1.5 - 2 * u;
      break;
   }
   return value * source.amplitude;
}

double netVoltage(const Network &net, const Setup &setup, double time)
{
   const int source = net.source();
   if (source < 0)
      return 0;
   const double volts = sourceVoltage(setup.sources[static_cast<std::size_t>(source)], time);
   return net.inverted() ? -volts : volts;
}

} // namespace diatom
