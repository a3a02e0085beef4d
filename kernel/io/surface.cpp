#include "io/surface.h"

#include "io/surface_tables.h"

#include <algorithm>
#include <array>
#include <vector>

namespace diatom {

namespace {

constexpr std::int64_t kLeafBlock = 16;                // cells along a block that is expanded
constexpr std::int64_t kBuried = 256;                  // cells along a block worth asking whether it is full
constexpr std::int64_t kWorld = std::int64_t{1} << 31; // the cube that holds every index

/// One block of materials with a border as wide as faces look. 0 = no cell.
class DenseBlock
{
public:
   DenseBlock(const Box &inner, int halo)
       : m_min{inner.min.x - halo, inner.min.y - halo, inner.min.z - halo}, m_max{inner.max.x + halo,
                                                                                  inner.max.y + halo,
                                                                                  inner.max.z + halo}
   {
      m_stepY = std::int64_t{m_max.z} - m_min.z + 1;
      m_stepX = m_stepY * (std::int64_t{m_max.y} - m_min.y + 1);
      m_material.assign(static_cast<std::size_t>(m_stepX * (std::int64_t{m_max.x} - m_min.x + 1)), 0);
   }
   Box box() const { return {m_min, m_max}; }
   void fill(const Box &box, MaterialIndex material)
   {
      Index i;
      for (i.x = box.min.x; i.x <= box.max.x; ++i.x)
         for (i.y = box.min.y; i.y <= box.max.y; ++i.y)
            std::fill_n(&at({i.x, i.y, box.min.z}), std::int64_t{box.max.z} - box.min.z + 1, material);
   }
   MaterialIndex &at(Index i)
   {
      return m_material[static_cast<std::size_t>((i.x - m_min.x) * m_stepX + (i.y - m_min.y) * m_stepY + i.z -
                                                 m_min.z)];
   }

private:
   Index m_min, m_max;
   std::int64_t m_stepX = 0, m_stepY = 0;
   std::vector<MaterialIndex> m_material;
};

class SurfaceScan
{
public:
   SurfaceScan(const Hierarchy &hierarchy, std::optional<MaterialIndex> material, bool betweenMaterials,
               const std::function<void(const SurfaceFace &)> &visit, const Job &job)
       : m_hierarchy(hierarchy), m_lattice(hierarchy.lattice()), m_tables(m_lattice), m_material(material),
         m_between(betweenMaterials), m_visit(visit), m_job(job), m_bounds(hierarchy.bounds()),
         m_rootOnly(hierarchy.model().root.instances.count() == 0)
   {}

   Status run()
   {
      constexpr std::int64_t kLow = -(kWorld / 2);
      if (!descend({kLow, kLow, kLow}, kWorld))
         return Error{ErrorCode::cancelled, "the export was cancelled"};
      return {};
   }

private:
   using Corner = std::array<std::int64_t, 3>;

   /// The part of a block within the bounds; empty when there is none.
   Box clipped(const Corner &low, std::int64_t size) const
   {
      const auto clip = [&](std::int64_t v, std::int32_t least, std::int32_t most) {
         return static_cast<std::int32_t>(std::clamp<std::int64_t>(v, least, most));
      };
      Box box = m_bounds;
      if (box.empty() || low[0] > box.max.x || low[1] > box.max.y || low[2] > box.max.z ||
          low[0] + size <= box.min.x || low[1] + size <= box.min.y || low[2] + size <= box.min.z)
         return {};
      const Index least = box.min, most = box.max;
      box.min = {clip(low[0], least.x, most.x), clip(low[1], least.y, most.y), clip(low[2], least.z, most.z)};
      box.max = {clip(low[0] + size - 1, least.x, most.x), clip(low[1] + size - 1, least.y, most.y),
                 clip(low[2] + size - 1, least.z, most.z)};
      return box;
   }

   bool occupied(const Box &box) const
   {
      return !m_hierarchy.visit(box, [](Index, Cell) { return false; });
   }

   /// Halves the world down to blocks of kLeafBlock, past empty ones. Blocks lie on multiples of their size,
   /// so the order of faces depends on the content only. False when cancelled.
   bool descend(const Corner &low, std::int64_t size)
   {
      const Box box = clipped(low, size);
      if (box.empty())
         return true;
      if (m_job.cancelled())
         return false;
      if (box.volume() > double(kLeafBlock * kLeafBlock * kLeafBlock) && !occupied(box))
         return true;
      if (size <= kBuried && m_tables.allLinked() && buried(box))
         return true;
      if (size <= kLeafBlock)
         return leaf(box);
      const std::int64_t half = size / 2;
      for (int child = 0; child < 8; ++child)
         if (!descend({low[0] + (child & 4 ? half : 0), low[1] + (child & 2 ? half : 0),
                       low[2] + (child & 1 ? half : 0)},
                      half))
            return false;
      return true;
   }

   Box widened(const Box &box) const
   {
      const int halo = m_tables.halo();
      return {{box.min.x - halo, box.min.y - halo, box.min.z - halo},
              {box.max.x + halo, box.max.y + halo, box.max.z + halo}};
   }

   /// Whether the root's own cells, which show above all others, fill the box and its surroundings.
   bool buried(const Box &box)
   {
      const Box around = widened(box);
      double filled = 0;
      MaterialIndex first = 0;
      bool same = true;
      m_hierarchy.model().root.cells.visitBlocks(around, [&](const Box &part, Cell cell) {
         first = first == 0 ? cell.material : first;
         same = exists(cell.material) && (!m_between || cell.material == first);
         filled += part.volume();
         return same;
      });
      if (!same || filled < around.volume())
         return false;
      m_done += static_cast<std::uint64_t>(box.volume());
      return true;
   }

   /// The materials of a block. 0 when no cell lies within the box.
   std::uint64_t gather(const Box &box, DenseBlock &block)
   {
      std::uint64_t inside = 0;
      if (m_rootOnly) { // stored runs, much faster than cell by cell
         m_hierarchy.model().root.cells.visitBlocks(block.box(), [&](const Box &part, Cell cell) {
            block.fill(part, cell.material);
            inside += part.intersects(box) ? 1 : 0;
            return true;
         });
         return inside;
      }
      m_hierarchy.visit(block.box(), [&](Index i, Cell cell) {
         MaterialIndex &material = block.at(i);
         // Where several cells overlap, the one the hierarchy shows.
         material = material == 0 || material == cell.material ? cell.material : m_hierarchy.at(i).material;
         inside += box.contains(i) ? 1 : 0;
         return true;
      });
      return inside;
   }

   bool leaf(const Box &box)
   {
      DenseBlock block(box, m_tables.halo());
      if (gather(box, block) == 0)
         return true;
      Index i;
      for (i.x = box.min.x; i.x <= box.max.x; ++i.x)
         for (i.y = box.min.y; i.y <= box.max.y; ++i.y)
            for (i.z = box.min.z; i.z <= box.max.z; ++i.z)
               if (const MaterialIndex material = block.at(i); exists(material)) {
                  cell(i, material, block);
                  ++m_done;
               }
      m_job.progress(static_cast<double>(m_done) /
                         static_cast<double>(std::max<std::uint64_t>(m_hierarchy.cells(), 1)),
                     "finding the surface");
      return !m_job.cancelled();
   }

   bool exists(MaterialIndex material) const
   {
      return material != 0 && (!m_material || material == *m_material);
   }

   void cell(Index i, MaterialIndex material, DenseBlock &block)
   {
      const auto &faces = m_tables.faces(m_lattice.site(i));
      for (std::size_t face = 0; face < faces.size(); ++face) {
         const FaceTable &table = faces[face];
         if (table.linked) {
            const MaterialIndex other = block.at(i + table.across);
            if (exists(other) && !(m_between && other != material))
               continue;
         }
         m_corners.clear();
         for (const CornerOwner &corner : table.corners)
            m_corners.push_back(m_tables.corner(i, corner));
         m_visit({i, static_cast<int>(face), material, m_corners});
      }
   }

   const Hierarchy &m_hierarchy;
   const Lattice &m_lattice;
   SurfaceTables m_tables;
   std::optional<MaterialIndex> m_material;
   bool m_between;
   const std::function<void(const SurfaceFace &)> &m_visit;
   const Job &m_job;
   Box m_bounds;
   bool m_rootOnly;
   std::uint64_t m_done = 0;
   std::vector<Vec3> m_corners;
};

} // namespace

Status visitSurface(const Hierarchy &hierarchy, std::optional<MaterialIndex> material, bool betweenMaterials,
                    const std::function<void(const SurfaceFace &)> &visit, const Job &job)
{
   return SurfaceScan(hierarchy, material, betweenMaterials, visit, job).run();
}

} // namespace diatom
