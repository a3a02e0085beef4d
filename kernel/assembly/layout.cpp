// Laying a job out on a machine: which feeder holds what, where the assembly stands, whether all of it is in
// range.
#include "assembly/program.h"
#include "core/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

namespace diatom {

namespace {

/// A unit quaternion as whole numbers, the same for q and -q.
using Turn = std::array<std::int64_t, 4>;

Turn turnOf(const Quat &q)
{
   Turn turn{std::llround(q.w() * 1e6), std::llround(q.x() * 1e6), std::llround(q.y() * 1e6),
             std::llround(q.z() * 1e6)};
   const auto first = std::find_if(turn.begin(), turn.end(), [](std::int64_t v) { return v != 0; });
   if (first != turn.end() && *first < 0)
      for (std::int64_t &v : turn)
         v = -v;
   return turn;
}

struct Kind
{
   MaterialIndex material;
   int type, length;
   Turn turn;
   friend auto operator<=>(const Kind &, const Kind &) = default;
};

Kind kindOf(const Part &part) { return {part.material, part.type, part.length, turnOf(part.orientation)}; }

/// Extent of the cells of each site about their centres.
struct Extents
{
   std::vector<Vec3> low, high;

   explicit Extents(const Lattice &lattice)
   {
      for (int site = 0; site < lattice.sites(); ++site) {
         low.push_back(Vec3::Constant(std::numeric_limits<double>::max()));
         high.push_back(-low.back());
         for (const Vec3 &corner : lattice.corners(site)) {
            low.back() = low.back().cwiseMin(corner);
            high.back() = high.back().cwiseMax(corner);
         }
      }
   }
};

class LayoutMaker
{
public:
   LayoutMaker(const Hierarchy &hierarchy, const Decomposition &parts,
               const diatom_machine_description &machine)
       : m_hierarchy(hierarchy), m_lattice(hierarchy.lattice()), m_parts(parts), m_machine(machine),
         m_motion(machine), m_extents(m_lattice)
   {
      m_corner = Vec3::Constant(std::numeric_limits<double>::max());
      for (const Index cell : parts.covered)
         m_corner = m_corner.cwiseMin(m_lattice.position(cell) + m_extents.low[siteOf(cell)]);
   }

   Result<Layout> make(const AssemblyPlan &plan)
   {
      if (Status status = assignFeeders(plan); !status)
         return status.error();
      m_layout.feederTop = std::numeric_limits<double>::lowest();
      for (const std::int64_t part : plan.order)
         add(part);
      for (std::size_t f = 0; f < m_layout.stocks.size(); ++f)
         m_layout.feederTop =
             std::max(m_layout.feederTop, m_machine.feeder_position[3 * f + 2] + m_layout.stocks[f].tallest);
      for (std::size_t i = 0; i < m_layout.placings.size(); ++i)
         if (Status status = checkReach(i); !status)
            return status.error();
      return std::move(m_layout);
   }

private:
   std::size_t siteOf(Index cell) const { return static_cast<std::size_t>(m_lattice.site(cell)); }

   Status assignFeeders(const AssemblyPlan &plan)
   {
      for (const std::int64_t part : plan.order) {
         DIATOM_CHECK(part >= 0 && part < static_cast<std::int64_t>(m_parts.parts.size()));
         m_feeder.try_emplace(kindOf(m_parts.parts[static_cast<std::size_t>(part)]), 0);
      }
      const auto kinds = static_cast<std::int64_t>(m_feeder.size());
      if (kinds > m_machine.feeders)
         return Error{
             ErrorCode::invalid,
             fmt::format(
                 "the assembly needs {} kinds of part (of one material, size and direction each: {}), "
                 "but the machine has {} feeders: give it more feeders or use fewer materials",
                 kinds, kindsText(), m_machine.feeders)};
      std::int32_t next = 0;
      for (auto &[kind, feeder] : m_feeder) {
         feeder = next++;
         m_layout.stocks.push_back({labelOf(kind), 0, 0});
      }
      return {};
   }

   std::string labelOf(const Kind &kind) const
   {
      std::string label = m_hierarchy.model().material(kind.material).id;
      if (m_parts.types.size() > 1)
         label += " " + m_parts.types[static_cast<std::size_t>(kind.type)].id;
      if (kind.length > 1)
         label += fmt::format(" of length {}", kind.length);
      int turns = 0, mine = 0;
      for (const auto &[other, feeder] : m_feeder)
         if (std::tie(other.material, other.type, other.length) ==
             std::tie(kind.material, kind.type, kind.length)) {
            ++turns;
            mine = other == kind ? turns : mine;
         }
      return turns > 1 ? label + fmt::format(" direction {}", mine) : label;
   }

   std::string kindsText() const
   {
      constexpr int kMostNamed = 6;
      std::string text;
      int named = 0;
      for (const auto &[kind, feeder] : m_feeder) {
         if (named++ == kMostNamed)
            return text + ", ...";
         text += (text.empty() ? "" : ", ") + labelOf(kind);
      }
      return text;
   }

   void add(std::int64_t number)
   {
      const Part &part = m_parts.parts[static_cast<std::size_t>(number)];
      Placing placing;
      placing.part = number;
      placing.feeder = m_feeder.at(kindOf(part));
      Stock &stock = m_layout.stocks[static_cast<std::size_t>(placing.feeder)];
      placing.turn = stock.parts++;
      double bottom = std::numeric_limits<double>::max(), top = std::numeric_limits<double>::lowest();
      for (std::int64_t i = part.firstCell; i < part.firstCell + part.cells; ++i) {
         const Index cell = m_parts.covered[static_cast<std::size_t>(i)];
         const double z = m_lattice.position(cell).z();
         bottom = std::min(bottom, z + m_extents.low[siteOf(cell)].z());
         top = std::max(top, z + m_extents.high[siteOf(cell)].z());
      }
      placing.height = top - bottom;
      stock.tallest = std::max(stock.tallest, placing.height);
      placing.target = Eigen::Map<const Vec3>(m_machine.origin) +
                       Vec3(part.position.x(), part.position.y(), bottom) - m_corner;
      m_layout.placings.push_back(placing);
      const Index first = m_parts.covered[static_cast<std::size_t>(part.firstCell)];
      m_layout.partFeeder.push_back(placing.feeder);
      m_layout.partIndex.insert(m_layout.partIndex.end(), {first.x, first.y, first.z});
   }

   Status checkReach(std::size_t i) const
   {
      const Placing &placing = m_layout.placings[i];
      const std::string out = m_motion.outside(placing.target);
      if (out.empty())
         return {};
      const std::int32_t *index = &m_layout.partIndex[3 * i];
      return Error{
          ErrorCode::invalid,
          fmt::format("the part at ({}, {}, {}) would need the machine's axis {}: move the machine's origin "
                      "or use a larger machine",
                      index[0], index[1], index[2], out)};
   }

   const Hierarchy &m_hierarchy;
   const Lattice &m_lattice;
   const Decomposition &m_parts;
   const diatom_machine_description &m_machine;
   Motion m_motion;
   Extents m_extents;
   Vec3 m_corner; // least corner of the assembly
   std::map<Kind, std::int32_t> m_feeder;
   Layout m_layout;
};

} // namespace

Result<Layout> layOut(const Hierarchy &hierarchy, const Decomposition &parts, const AssemblyPlan &plan,
                      const diatom_machine_description &machine)
{
   return LayoutMaker(hierarchy, parts, machine).make(plan);
}

} // namespace diatom
