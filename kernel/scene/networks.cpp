#include "scene/networks.h"

#include "scene/cell_list.h"
#include "scene/problems.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace diatom {

namespace {

constexpr std::uint8_t kAllPorts = 0x3f;
constexpr std::int64_t kMostElectricalCells = 50'000'000;

enum class Part : std::uint8_t { conductor, twoTerminalSource, actuator };

/// A conductor at a terminal of an actuator or of a two-terminal source.
struct Contact
{
   std::int32_t owner = 0, conductor = 0;
   Vec3 direction = Vec3::Zero(); // from the owner, world, unit
   int port = -1;                 // of the owner, in its own frame
};

int portCount(std::uint8_t ports)
{
   int count = 0;
   for (int bit = 0; bit < 6; ++bit)
      count += (ports >> bit) & 1;
   return count;
}

std::uint8_t alongAxis(int axis) { return static_cast<std::uint8_t>(3 << (2 * axis)); }

/// Terminals of an actuator: its own ports where it has chosen some, else the ends of its axis where that
/// tells them.
std::uint8_t actuatorPorts(const Material &material)
{
   const Actuation &does = material.actuation;
   const bool axisTells = does.mode == Actuation::Mode::axial || does.mode == Actuation::Mode::torsion;
   if (does.axisFromWires || material.ports != kAllPorts || !axisTells)
      return material.ports;
   return alongAxis(does.axis);
}

Part partOf(const Material &material)
{
   if (material.role == ElectricalRole::actuator)
      return Part::actuator;
   return material.role == ElectricalRole::source && portCount(material.ports) == 2 ? Part::twoTerminalSource
                                                                                    : Part::conductor;
}

/// World axis of a direction, -1 when it is along none.
int worldAxis(const Vec3 &direction)
{
   for (int axis = 0; axis < 3; ++axis)
      if (std::abs(direction[axis]) > 0.999)
         return axis;
   return -1;
}

class NetworkFinder
{
public:
   NetworkFinder(const Hierarchy &hierarchy, const Setup &setup, const Job &job)
       : m_hierarchy(hierarchy), m_lattice(hierarchy.lattice()), m_setup(setup), m_job(job)
   {}

   Networks find()
   {
      if (!list())
         return std::move(m_result);
      connect();
      attachSources();
      attachActuators();
      checkNets();
      checkPorts();
      return std::move(m_result);
   }

private:
   bool list();
   void connect();
   void join(const JoinedPair &pair, std::vector<JoinedPair> &conducting);
   void attachSources();
   void attachTwoTerminalSource(int source, std::int32_t cell);
   void attachActuators();
   void attachActuator(std::int32_t cell, const std::vector<Contact> &contacts);
   void checkNets();
   void checkPorts();
   bool isBox(std::int32_t cell) const;
   int port(std::int32_t cell, const Vec3 &direction) const;
   std::vector<Contact> contactsOf(std::int32_t cell) const;

   const Material &material(std::int32_t cell) const
   {
      return m_hierarchy.model().material(m_cells.cell[static_cast<std::size_t>(cell)].material);
   }
   Index index(std::int32_t cell) const { return m_cells.index[static_cast<std::size_t>(cell)]; }
   Network &net(int number) { return m_result.nets[static_cast<std::size_t>(number)]; }
   int netOf(std::int32_t cell) const { return m_netOf[static_cast<std::size_t>(cell)]; }
   void report(Problem::Severity severity, const char *kind, std::string text, std::vector<Index> cells)
   {
      if (!cells.empty())
         m_result.problems.push_back({severity, kind, std::move(text), std::move(cells)});
   }

   const Hierarchy &m_hierarchy;
   const Lattice &m_lattice;
   const Setup &m_setup;
   const Job &m_job;
   CellList m_cells;                  // conductors, sources and actuators
   std::vector<Part> m_part;          // per cell
   std::vector<std::uint8_t> m_ports; // per cell: open ones, own frame
   std::vector<std::uint8_t> m_met;   // per cell: ports that meet another one
   std::vector<int> m_netOf;          // per cell, -1 = none
   std::vector<Contact> m_contacts;   // sorted by owner
   std::vector<JoinedPair> m_pairs;
   std::vector<Index> m_floating, m_ambiguous, m_slanted, m_shorted;
   Networks m_result;
};

bool NetworkFinder::list()
{
   const auto &materials = *m_hierarchy.model().materials;
   std::vector<bool> wanted(materials.size() + 1, false);
   const auto counts = m_hierarchy.countByMaterial();
   bool any = false;
   for (std::size_t m = 1; m <= materials.size(); ++m) {
      const bool used = m < counts.size() && counts[m] > 0;
      wanted[m] = used && !materials[m - 1].id.empty() && materials[m - 1].role != ElectricalRole::insulator;
      any = any || wanted[m];
   }
   if (!any && m_setup.sources.empty())
      return false;
   auto cells = listCells(m_hierarchy, wanted, kMostElectricalCells, m_job);
   auto pairs =
       cells ? joinedPairs(m_lattice, *cells, m_job) : Result<std::vector<JoinedPair>>(cells.error());
   if (!pairs) {
      m_result.problems.push_back({Problem::Severity::error,
                                   "not-examined",
                                   "the wiring was not examined: " + pairs.error().message,
                                   {}});
      return false;
   }
   m_cells = std::move(*cells);
   m_pairs = std::move(*pairs);
   for (std::int32_t i = 0; i < m_cells.count(); ++i) {
      const Part part = partOf(material(i));
      m_part.push_back(part == Part::twoTerminalSource && !isBox(i) ? Part::conductor : part);
      m_ports.push_back(m_part.back() == Part::actuator ? actuatorPorts(material(i)) : material(i).ports);
   }
   m_met.assign(m_part.size(), 0);
   return true;
}

bool NetworkFinder::isBox(std::int32_t cell) const
{
   const Shape &shape = m_lattice.shape(m_lattice.site(index(cell)));
   return shape.faces.size() == 6 && shape.vertices.size() == 8;
}

/// The port a cell has towards a world direction: its number, or -1 where ports have no meaning (not a box,
/// not a face).
int NetworkFinder::port(std::int32_t cell, const Vec3 &direction) const
{
   if (!isBox(cell))
      return -1;
   const int site = m_lattice.site(index(cell));
   const auto orientation = m_cells.cell[static_cast<std::size_t>(cell)].orientation;
   const Quat turned = m_lattice.orientation(site) * m_lattice.shape(site).rotations[orientation];
   const Vec3 local = turned.conjugate() * direction;
   const int axis = worldAxis(local);
   return axis < 0 ? -1 : 2 * axis + (local[axis] > 0 ? 1 : 0);
}

void NetworkFinder::join(const JoinedPair &pair, std::vector<JoinedPair> &conducting)
{
   const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
   const Vec3 direction =
       (m_lattice.position(m_cells.index[b]) - m_lattice.position(m_cells.index[a])).normalized();
   const int portA = port(pair.a, direction), portB = port(pair.b, -direction);
   const auto open = [&](std::size_t cell, int number) {
      return pair.withinSupercell || number < 0 || ((m_ports[cell] >> number) & 1) != 0;
   };
   if (!open(a, portA) || !open(b, portB))
      return;
   if (portA >= 0)
      m_met[a] = static_cast<std::uint8_t>(m_met[a] | (1 << portA));
   if (portB >= 0)
      m_met[b] = static_cast<std::uint8_t>(m_met[b] | (1 << portB));
   if (m_part[a] == Part::conductor && m_part[b] == Part::conductor)
      conducting.push_back(pair);
   else if (m_part[b] == Part::conductor)
      m_contacts.push_back({pair.a, pair.b, direction, portA});
   else if (m_part[a] == Part::conductor)
      m_contacts.push_back({pair.b, pair.a, -direction, portB});
}

void NetworkFinder::connect()
{
   std::vector<JoinedPair> conducting;
   for (const JoinedPair &pair : m_pairs)
      join(pair, conducting);
   std::stable_sort(m_contacts.begin(), m_contacts.end(),
                    [](const Contact &a, const Contact &b) { return a.owner < b.owner; });

   const auto smallest = connectedTo(m_cells.count(), conducting);
   m_netOf.assign(smallest.size(), -1);
   for (std::size_t i = 0; i < smallest.size(); ++i) {
      if (m_part[i] != Part::conductor)
         continue;
      const auto first = static_cast<std::size_t>(smallest[i]);
      if (m_netOf[first] < 0) {
         m_netOf[first] = static_cast<int>(m_result.nets.size());
         m_result.nets.emplace_back();
      }
      m_netOf[i] = m_netOf[first];
      net(m_netOf[i]).cells.push_back(m_cells.index[i]);
   }
}

std::vector<Contact> NetworkFinder::contactsOf(std::int32_t cell) const
{
   const auto [begin, end] =
       std::equal_range(m_contacts.begin(), m_contacts.end(), Contact{cell, 0, Vec3::Zero(), 0},
                        [](const Contact &a, const Contact &b) { return a.owner < b.owner; });
   return {begin, end};
}

void NetworkFinder::attachSources()
{
   std::vector<Index> misplaced, silent;
   std::vector<bool> given(m_part.size(), false);
   for (std::size_t k = 0; k < m_setup.sources.size(); ++k) {
      const Index where = m_setup.sources[k].cell;
      const auto cell = static_cast<std::int32_t>(m_cells.find(where));
      if (cell < 0 || m_part[static_cast<std::size_t>(cell)] == Part::actuator) {
         if (inRange(where) && !m_hierarchy.at(where).empty())
            misplaced.push_back(where);
         continue;
      }
      given[static_cast<std::size_t>(cell)] = true;
      if (m_part[static_cast<std::size_t>(cell)] == Part::twoTerminalSource)
         attachTwoTerminalSource(static_cast<int>(k), cell);
      else
         net(netOf(cell)).sources.push_back(static_cast<int>(k));
   }
   for (std::int32_t cell = 0; cell < m_cells.count(); ++cell)
      if (material(cell).role == ElectricalRole::source && !given[static_cast<std::size_t>(cell)])
         silent.push_back(index(cell));
   report(
       Problem::Severity::error, "source-not-conductive",
       fmt::format(
           "a source is set on a cell that does not conduct: {}; make it a source or conductor cell, or move "
           "the source",
           cellsText(misplaced)),
       misplaced);
   report(Problem::Severity::warning, "source-without-signal",
          fmt::format("a source cell has no signal: {}; give it a waveform, or it stays at 0 V",
                      cellsText(silent)),
          silent);
}

void NetworkFinder::attachTwoTerminalSource(int source, std::int32_t cell)
{
   int plus = -1, minus = -1;
   for (const Contact &contact : contactsOf(cell)) {
      // The port of the higher number is +: of an opposite pair that is the one towards the + axis.
      const bool higher = (m_ports[static_cast<std::size_t>(cell)] >> (contact.port + 1)) == 0;
      (higher ? plus : minus) = netOf(contact.conductor);
   }
   const std::string where = cellText(index(cell));
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
   for (std::int32_t cell = 0; cell < m_cells.count(); ++cell)
      if (m_part[static_cast<std::size_t>(cell)] == Part::actuator)
         attachActuator(cell, contactsOf(cell));
   report(Problem::Severity::error, "floating-actuator",
          fmt::format(
              "an actuator has an open terminal and stays passive: {}; put conductors on two opposite faces",
              cellsText(m_floating)),
          m_floating);
   report(
       Problem::Severity::error, "ambiguous-actuator",
       fmt::format(
           "conductors do not meet an actuator on exactly two opposite faces, so that it stays passive: {}; "
           "remove the others",
           cellsText(m_ambiguous)),
       m_ambiguous);
   report(Problem::Severity::error, "slanted-actuator",
          fmt::format("the terminals of an actuator lie along no axis, which solvers cannot drive: {}; wire "
                      "it along x, y "
                      "or z",
                      cellsText(m_slanted)),
          m_slanted);
   report(
       Problem::Severity::error, "shorted-actuator",
       fmt::format(
           "both terminals of an actuator are on one net, so that it stays passive: {}; interrupt the wire "
           "between them, or use an actuator that takes its axis from its wires",
           cellsText(m_shorted)),
       m_shorted);
}

void NetworkFinder::attachActuator(std::int32_t cell, const std::vector<Contact> &contacts)
{
   if (contacts.size() < 2) {
      m_floating.push_back(index(cell));
      return;
   }
   if (contacts.size() > 2 || contacts[0].direction.dot(contacts[1].direction) > -0.999) {
      m_ambiguous.push_back(index(cell));
      return;
   }
   const int axis = worldAxis(contacts[0].direction);
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
                            cellsText(drivers)),
                drivers);
      else if (drivers.size() > 1)
         report(
             Problem::Severity::error, "two-sources",
             fmt::format("{} sources drive one net: {}; keep one of them or interrupt the wire between them",
                         drivers.size(), cellsText(drivers)),
             drivers);
      else if (!drivers.empty() && drivers == one.cells && one.actuators.empty())
         report(
             Problem::Severity::warning, "open-source",
             fmt::format("the source at {} touches no conductor; wire it or remove it", cellsText(drivers)),
             drivers);
      else if (drivers.empty() && !one.actuators.empty())
         report(Problem::Severity::warning, "net-without-source",
                fmt::format("the net at {} feeds {} actuators but has no source, so that it stays at 0 V; "
                            "put a source on it",
                            cellText(one.cells.front()), one.actuators.size()),
                one.cells);
   }
}

void NetworkFinder::checkPorts()
{
   std::vector<Index> blind;
   for (std::size_t i = 0; i < m_part.size(); ++i)
      if (m_part[i] == Part::conductor && m_ports[i] != kAllPorts && (m_ports[i] & ~m_met[i]) != 0 &&
          isBox(static_cast<std::int32_t>(i)))
         blind.push_back(m_cells.index[i]);
   report(
       Problem::Severity::warning, "port-facing-nothing",
       fmt::format("a conductor has a port that meets no other port: {}; turn the cell or continue the wire",
                   cellsText(blind)),
       blind);
}

} // namespace

Networks findNetworks(const Hierarchy &hierarchy, const Setup &setup, const Job &job)
{
   return NetworkFinder(hierarchy, setup, job).find();
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
