#include "io/voxelize.h"

#include "io/cell_solid.h"
#include "io/index_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace diatom {

namespace {

constexpr std::int32_t kLarge = 512;                   // cells along the largest block that is filled as one
constexpr std::int32_t kBlock = 32;                    // cells along a block that one thread takes
constexpr std::int32_t kSmall = 4;                     // cells along a block that is looked at cell by cell
constexpr std::size_t kBatch = 64;                     // blocks between two looks at progress
constexpr double kMostOpen = 2e10, kMostClosed = 2e12; // cells of the box around the surface
/// Of the cell's radius; a direction that no face of a lattice or of a modelled part lies along.
const Vec3 kHigher = 1e-7 * Vec3(1, 0.7548776662, 0.5698402910);

struct Block
{
   Box box;
   std::vector<Cell> cells; // in order x, y, z; none when all are out
};

/// Calls visit(part) for the parts of the box in blocks that lie on multiples of `size`.
template<typename Visit>
void forBlocks(const Box &box, std::int32_t size, const Visit &visit)
{
   const auto start = [size](std::int32_t v) { return floorDiv(v, size) * size; };
   for (std::int32_t x = start(box.min.x); x <= box.max.x; x += size)
      for (std::int32_t y = start(box.min.y); y <= box.max.y; y += size)
         for (std::int32_t z = start(box.min.z); z <= box.max.z; z += size)
            visit(Box{{std::max(x, box.min.x), std::max(y, box.min.y), std::max(z, box.min.z)},
                      {std::min(x + size - 1, box.max.x), std::min(y + size - 1, box.max.y),
                       std::min(z + size - 1, box.max.z)}});
}

class Voxelizer
{
public:
   Voxelizer(const TriangleTree &tree, const Lattice &lattice, const VoxelizeOptions &options, const Job &job)
       : m_tree(tree), m_lattice(lattice), m_options(options), m_job(job), m_frame(lattice)
   {
      for (int site = 0; site < lattice.sites(); ++site)
         m_solids.emplace_back(lattice, site);
   }

   Result<CellArray> run()
   {
      const auto around = indicesAround();
      if (!around)
         return around.error();
      if (!around->empty())
         descend(*around, kLarge);
      for (std::size_t from = 0; from < m_blocks.size(); from += kBatch) {
         if (m_job.cancelled())
            break;
         const std::size_t count = std::min(kBatch, m_blocks.size() - from);
         m_job.parallelFor(static_cast<std::int64_t>(count), 1, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t k = begin; k < end && !m_job.cancelled(); ++k)
               look(m_blocks[from + static_cast<std::size_t>(k)]);
         });
         for (std::size_t k = from; k < from + count; ++k) {
            Block &block = m_blocks[k];
            if (!block.cells.empty())
               m_cells.write(block.box, block.cells);
            block.cells = {};
         }
         m_job.progress(double(from + count) / double(m_blocks.size()), "filling the mesh with cells");
      }
      if (m_job.cancelled())
         return Error{ErrorCode::cancelled, "filling the mesh with cells was cancelled"};
      return std::move(m_cells);
   }

private:
   /// Indices of all cells that may meet the solid.
   Result<Box> indicesAround() const
   {
      const auto bounds = m_tree.mesh().bounds();
      if (bounds.isEmpty())
         return Box{};
      const auto range = m_frame.indices(bounds);
      double volume = 1;
      bool fits = true;
      for (std::size_t axis = 0; axis < 3; ++axis) {
         volume *= range.max[axis] - range.min[axis] + 1;
         fits = fits && range.min[axis] >= -kIndexLimit && range.max[axis] <= kIndexLimit;
      }
      if (!fits || volume > (m_options.closed ? kMostClosed : kMostOpen))
         return Error{
             ErrorCode::invalid,
             fmt::format("the mesh is {:.3g} x {:.3g} x {:.3g} m, which takes some {:.1g} cells of this "
                         "pitch; choose a larger pitch or the right unit",
                         bounds.sizes().x(), bounds.sizes().y(), bounds.sizes().z(), volume)};
      const auto index = [](const std::array<double, 3> &at) {
         return Index{static_cast<std::int32_t>(at[0]), static_cast<std::int32_t>(at[1]),
                      static_cast<std::int32_t>(at[2])};
      };
      return Box{index(range.min), index(range.max)};
   }

   /// Whether all cells of the box are alike: nothing of a closed surface is near.
   bool alike(const Box &box) const
   {
      return m_options.closed && m_tree.visitNear(m_frame.space(box), [](std::int32_t) { return false; });
   }

   bool isInside(const Vec3 &point) const
   {
      return m_tree.winding(point + m_lattice.radius() * kHigher) > 0.5;
   }

   /// Splits the box into blocks for the threads; those that are alike are filled as a whole.
   void descend(const Box &box, std::int32_t size)
   {
      forBlocks(box, size, [&](const Box &part) {
         if (m_job.cancelled())
            return;
         if (!m_options.materialAt && alike(part)) {
            if (isInside(m_lattice.position(part.min)))
               m_cells.fill(part, {m_options.material, 0, 0});
         } else if (size == kBlock) {
            m_blocks.push_back({part, {}});
         } else {
            descend(part, size / 4);
         }
      });
   }

   void look(Block &block) const
   {
      const Box &whole = block.box;
      const std::size_t sizeY = std::size_t{1} + static_cast<std::size_t>(whole.max.y - whole.min.y),
                        sizeZ = std::size_t{1} + static_cast<std::size_t>(whole.max.z - whole.min.z);
      std::vector<std::int32_t> triangles;
      forBlocks(whole, kSmall, [&](const Box &part) {
         std::optional<bool> all;
         if (alike(part))
            all = isInside(m_lattice.position(part.min));
         if ((all && !*all) || m_job.cancelled())
            return;
         triangles.clear();
         if (!all && m_options.rule != BoundaryRule::centre)
            m_tree.visitNear(m_frame.space(part), [&](std::int32_t triangle) {
               triangles.push_back(triangle);
               return true;
            });
         forBlocks(part, 1, [&](const Box &one) {
            const Index cell = one.min;
            const Vec3 centre = m_lattice.position(cell);
            if (!(all ? *all : belongs(cell, centre, triangles)))
               return;
            const MaterialIndex material =
                m_options.materialAt ? m_options.materialAt(cell, centre) : m_options.material;
            if (material == 0)
               return;
            if (block.cells.empty())
               block.cells.resize(static_cast<std::size_t>(whole.volume()));
            const Index at = cell - whole.min;
            block.cells[(static_cast<std::size_t>(at.x) * sizeY + static_cast<std::size_t>(at.y)) * sizeZ +
                        static_cast<std::size_t>(at.z)] = {material, 0, 0};
         });
      });
   }

   bool belongs(Index cell, const Vec3 &centre, const std::vector<std::int32_t> &triangles) const
   {
      if (m_options.rule == BoundaryRule::centre || !isCut(cell, centre, triangles))
         return isInside(centre);
      if (m_options.rule == BoundaryRule::touch)
         return true;
      const auto &samples = m_solids[static_cast<std::size_t>(m_lattice.site(cell))].samples();
      const auto inside = std::count_if(samples.begin(), samples.end(),
                                        [&](const Vec3 &sample) { return isInside(centre + sample); });
      return static_cast<double>(inside) >= m_options.fraction * static_cast<double>(samples.size());
   }

   bool isCut(Index cell, const Vec3 &centre, const std::vector<std::int32_t> &triangles) const
   {
      const CellSolid &solid = m_solids[static_cast<std::size_t>(m_lattice.site(cell))];
      return std::any_of(triangles.begin(), triangles.end(), [&](std::int32_t triangle) {
         auto corners = m_tree.corners(triangle);
         for (Vec3 &corner : corners)
            corner -= centre;
         return solid.entered(corners);
      });
   }

   const TriangleTree &m_tree;
   const Lattice &m_lattice;
   const VoxelizeOptions &m_options;
   const Job &m_job;
   IndexFrame m_frame;
   std::vector<CellSolid> m_solids; // per site
   std::vector<Block> m_blocks;
   CellArray m_cells;
};

} // namespace

Result<CellArray> voxelize(const TriangleTree &tree, const Lattice &lattice, const VoxelizeOptions &options,
                           const Job &job)
{
   if (options.rule == BoundaryRule::fraction && !(options.fraction > 0 && options.fraction <= 1))
      return Error{ErrorCode::usage, "the fraction of a cell that must be inside is above 0 and at most 1"};
   return Voxelizer(tree, lattice, options, job).run();
}

} // namespace diatom
