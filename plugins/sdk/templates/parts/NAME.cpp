// Bricks: cubes packed greedily into boxes of one material, one cell high, one or two wide and up to
// `longest` long. Cells are taken in order of layer, row and column; each that is still free becomes the
// lowest corner of the largest brick that fits there. Odd layers are laid across, so that joints do not lie
// over each other.
#include <diatom/parts.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

using namespace diatom::sdk;

namespace {

struct Brick
{
   std::int32_t length = 1, width = 1;
};

/// Largest first, of equal ones the longer; a part type each.
std::vector<Brick> bricksUpTo(std::int32_t longest)
{
   std::vector<Brick> bricks;
   for (std::int32_t width = 1; width <= 2; ++width)
      for (std::int32_t length = width; length <= longest; ++length)
         bricks.push_back({length, width});
   std::sort(bricks.begin(), bricks.end(), [](const Brick &a, const Brick &b) {
      return std::tuple(a.length * a.width, a.length) > std::tuple(b.length * b.width, b.length);
   });
   return bricks;
}

/// The cells by layer, row and column, whatever order the host lists them in.
class Packing
{
public:
   Packing(const diatom_cells &cells, const std::vector<Brick> &bricks)
       : m_cells(cells), m_bricks(bricks), m_order(static_cast<std::size_t>(cells.count)),
         m_used(static_cast<std::size_t>(cells.count), false)
   {
      for (std::size_t i = 0; i < m_order.size(); ++i)
         m_order[i] = static_cast<std::int64_t>(i);
      std::sort(m_order.begin(), m_order.end(),
                [&](std::int64_t a, std::int64_t b) { return key(index(a)) < key(index(b)); });
   }

   void run(const Call &call, PartList &parts)
   {
      for (std::size_t n = 0; n < m_order.size(); ++n) {
         pollEvery(call, static_cast<std::int64_t>(n));
         if (!m_used[static_cast<std::size_t>(m_order[n])])
            placeLargest(m_order[n], parts);
      }
   }

private:
   using At = std::array<std::int32_t, 3>;
   static std::tuple<std::int32_t, std::int32_t, std::int32_t> key(const At &at)
   {
      return {at[2], at[1], at[0]};
   }
   At index(std::int64_t cell) const
   {
      const std::int32_t *i = m_cells.index + 3 * cell;
      return {i[0], i[1], i[2]};
   }

   /// The cell at an index, -1 when there is none.
   std::int64_t find(const At &at) const
   {
      const auto found =
          std::lower_bound(m_order.begin(), m_order.end(), at, [&](std::int64_t cell, const At &wanted) {
             return key(index(cell)) < key(wanted);
          });
      return found != m_order.end() && index(*found) == at ? *found : -1;
   }

   /// The free cells of a brick with its lowest corner at `cell`; none when it does not fit.
   std::vector<std::int64_t> room(std::int64_t cell, const Brick &brick, bool alongY) const
   {
      std::vector<std::int64_t> covered;
      for (std::int32_t across = 0; across < brick.width; ++across)
         for (std::int32_t along = 0; along < brick.length; ++along) {
            At at = index(cell);
            at[alongY ? 1 : 0] += along;
            at[alongY ? 0 : 1] += across;
            const std::int64_t found = find(at);
            if (found < 0 || m_used[static_cast<std::size_t>(found)] ||
                m_cells.material[found] != m_cells.material[cell])
               return {};
            covered.push_back(found);
         }
      return covered;
   }

   void placeLargest(std::int64_t cell, PartList &parts)
   {
      const bool odd = (index(cell)[2] & 1) != 0;
      for (std::size_t type = 0; type < m_bricks.size(); ++type)
         for (const bool alongY : {odd, !odd}) {
            const auto covered = room(cell, m_bricks[type], alongY);
            if (covered.empty())
               continue;
            for (const std::int64_t one : covered)
               m_used[static_cast<std::size_t>(one)] = true;
            place(static_cast<std::int32_t>(type), covered,
                  alongY && m_bricks[type].length > m_bricks[type].width, parts);
            return;
         }
   }

   /// In the middle of its cells; along y it is turned by a quarter.
   void place(std::int32_t type, const std::vector<std::int64_t> &covered, bool turned, PartList &parts) const
   {
      const Xyz first = cellPosition(m_cells, covered.front()), last = cellPosition(m_cells, covered.back());
      Xyz middle{};
      for (std::size_t axis = 0; axis < 3; ++axis)
         middle[axis] = (first[axis] + last[axis]) / 2;
      const Wxyz turn = turned ? Wxyz{std::sqrt(0.5), 0, 0, std::sqrt(0.5)} : Wxyz{1, 0, 0, 0};
      parts.add(type, 1, m_cells.material[covered.front()], middle, turn, covered);
   }

   const diatom_cells &m_cells;
   const std::vector<Brick> &m_bricks;
   std::vector<std::int64_t> m_order; // cells, sorted
   std::vector<bool> m_used;          // by cell
};

PartMesh box(double length, double width, double height)
{
   PartMesh mesh;
   for (int corner = 0; corner < 8; ++corner)
      mesh.vertex((corner & 1 ? length : -length) / 2, (corner & 2 ? width : -width) / 2,
                  (corner & 4 ? height : -height) / 2);
   mesh.quad(0, 4, 6, 2);
   mesh.quad(1, 3, 7, 5);
   mesh.quad(0, 1, 5, 4);
   mesh.quad(2, 6, 7, 3);
   mesh.quad(0, 2, 3, 1);
   mesh.quad(4, 5, 7, 6);
   return mesh;
}

PartSet bricks(const Values &values)
{
   const auto all = bricksUpTo(static_cast<std::int32_t>(values.number("longest")));
   PartSet set;
   for (const Brick &brick : all) {
      const std::string size = std::to_string(brick.length) + "x" + std::to_string(brick.width);
      set.kinds.push_back({"brick_" + size, "Brick " + size, 1});
   }
   set.lattices = {"org.diatom_cad.lattice.cube"};
   set.mesh = [all](const MeshRequest &request) {
      const Brick &brick = all[static_cast<std::size_t>(request.type)];
      return box(brick.length * request.pitch, brick.width * request.pitch, request.pitch);
   };
   set.decompose = [all](const Call &call, const diatom_cells &cells, PartList &parts) {
      Packing(cells, all).run(call, parts);
   };
   return set;
}

} // namespace

DIATOM_PARTS(bricks)
