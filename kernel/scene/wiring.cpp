#include "scene/wiring.h"

#include <algorithm>
#include <cmath>

namespace diatom {

namespace {

constexpr std::int64_t kMostElectricalCells = 50'000'000;

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

WiringPart partOf(const Material &material)
{
   if (material.role == ElectricalRole::actuator)
      return WiringPart::actuator;
   return material.role == ElectricalRole::source && portCount(material.ports) == 2
              ? WiringPart::twoTerminalSource
              : WiringPart::conductor;
}

/// Materials in use that have a part in the wiring, marked by index.
std::vector<bool> electricalMaterials(const Hierarchy &hierarchy)
{
   const auto &materials = *hierarchy.model().materials;
   const auto counts = hierarchy.countByMaterial();
   std::vector<bool> wanted(materials.size() + 1, false);
   for (std::size_t m = 1; m <= materials.size() && m < counts.size(); ++m)
      wanted[m] =
          counts[m] > 0 && !materials[m - 1].id.empty() && materials[m - 1].role != ElectricalRole::insulator;
   return wanted;
}

class WiringFinder
{
public:
   WiringFinder(const Hierarchy &hierarchy, CellList cells)
       : m_hierarchy(hierarchy), m_lattice(hierarchy.lattice())
   {
      m_wiring.cells = std::move(cells);
   }
   Wiring find(const std::vector<JoinedPair> &pairs);

private:
   void describeCells();
   void meet(const JoinedPair &pair);
   int port(std::size_t cell, const Vec3 &direction) const;
   void numberGroups();

   const Hierarchy &m_hierarchy;
   const Lattice &m_lattice;
   Wiring m_wiring;
   std::vector<JoinedPair> m_conducting;
};

void WiringFinder::describeCells()
{
   const auto count = static_cast<std::size_t>(m_wiring.cells.count());
   for (std::size_t i = 0; i < count; ++i) {
      const Shape &shape = m_lattice.shape(m_lattice.site(m_wiring.cells.index[i]));
      const bool box = shape.faces.size() == 6 && shape.vertices.size() == 8;
      const Material &material = m_hierarchy.model().material(m_wiring.cells.cell[i].material);
      const WiringPart part = partOf(material);
      m_wiring.box.push_back(box);
      m_wiring.part.push_back(part == WiringPart::twoTerminalSource && !box ? WiringPart::conductor : part);
      m_wiring.ports.push_back(part == WiringPart::actuator ? actuatorPorts(material) : material.ports);
   }
   m_wiring.met.assign(count, 0);
}

/// The port a cell has towards a world direction: its number, or -1 where ports have no meaning (not a box,
/// not a face).
int WiringFinder::port(std::size_t cell, const Vec3 &direction) const
{
   if (!m_wiring.box[cell])
      return -1;
   const int site = m_lattice.site(m_wiring.cells.index[cell]);
   const auto orientation = m_wiring.cells.cell[cell].orientation;
   const Quat turned = m_lattice.orientation(site) * m_lattice.shape(site).rotations[orientation];
   const Vec3 local = turned.conjugate() * direction;
   const int axis = axisOfDirection(local);
   return axis < 0 ? -1 : 2 * axis + (local[axis] > 0 ? 1 : 0);
}

void WiringFinder::meet(const JoinedPair &pair)
{
   const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
   const Vec3 direction =
       (m_lattice.position(m_wiring.cells.index[b]) - m_lattice.position(m_wiring.cells.index[a]))
           .normalized();
   const int portA = port(a, direction), portB = port(b, -direction);
   const auto open = [&](std::size_t cell, int number) {
      return pair.withinSupercell || number < 0 || ((m_wiring.ports[cell] >> number) & 1) != 0;
   };
   if (!open(a, portA) || !open(b, portB))
      return;
   if (portA >= 0)
      m_wiring.met[a] = static_cast<std::uint8_t>(m_wiring.met[a] | (1 << portA));
   if (portB >= 0)
      m_wiring.met[b] = static_cast<std::uint8_t>(m_wiring.met[b] | (1 << portB));
   if (m_wiring.part[a] == WiringPart::conductor && m_wiring.part[b] == WiringPart::conductor)
      m_conducting.push_back(pair);
   else if (m_wiring.part[b] == WiringPart::conductor)
      m_wiring.contacts.push_back({pair.a, pair.b, direction, portA});
   else if (m_wiring.part[a] == WiringPart::conductor)
      m_wiring.contacts.push_back({pair.b, pair.a, -direction, portB});
}

void WiringFinder::numberGroups()
{
   const auto smallest = connectedTo(m_wiring.cells.count(), m_conducting);
   m_wiring.group.assign(smallest.size(), -1);
   for (std::size_t i = 0; i < smallest.size(); ++i) {
      if (m_wiring.part[i] != WiringPart::conductor)
         continue;
      int &group = m_wiring.group[static_cast<std::size_t>(smallest[i])];
      if (group < 0)
         group = m_wiring.groups++;
      m_wiring.group[i] = group;
   }
}

Wiring WiringFinder::find(const std::vector<JoinedPair> &pairs)
{
   describeCells();
   for (const JoinedPair &pair : pairs)
      meet(pair);
   std::stable_sort(m_wiring.contacts.begin(), m_wiring.contacts.end(),
                    [](const TerminalContact &a, const TerminalContact &b) { return a.owner < b.owner; });
   numberGroups();
   return std::move(m_wiring);
}

} // namespace

std::vector<TerminalContact> Wiring::contactsOf(std::int32_t cell) const
{
   const auto [begin, end] =
       std::equal_range(contacts.begin(), contacts.end(), TerminalContact{cell, 0, Vec3::Zero(), 0},
                        [](const TerminalContact &a, const TerminalContact &b) { return a.owner < b.owner; });
   return {begin, end};
}

Result<Wiring> findWiring(const Hierarchy &hierarchy, const Job &job)
{
   const auto wanted = electricalMaterials(hierarchy);
   if (std::find(wanted.begin(), wanted.end(), true) == wanted.end())
      return Wiring{};
   auto cells = listCells(hierarchy, wanted, kMostElectricalCells, job);
   if (!cells)
      return cells.error();
   const auto pairs = joinedPairs(hierarchy.lattice(), *cells, job);
   if (!pairs)
      return pairs.error();
   return WiringFinder(hierarchy, *std::move(cells)).find(*pairs);
}

int axisOfDirection(const Vec3 &direction)
{
   for (int axis = 0; axis < 3; ++axis)
      if (std::abs(direction[axis]) > 0.999)
         return axis;
   return -1;
}

} // namespace diatom
