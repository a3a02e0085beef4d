#include "render/cell_mesh.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <limits>
#include <memory>
#include <unordered_map>

namespace diatom::render {

namespace {

constexpr int kChunkShift = 5; // chunks of 32^3 cells: culled against the view as one

std::uint64_t brickKey(Index i, int shift)
{
   const auto part = [shift](std::int32_t v) { return std::uint64_t(std::uint32_t(v) >> shift); };
   // 2^32 >> shift needs 28 bits or fewer per axis: mixed, as 84 bits do not fit.
   return (part(i.x) * 0x9e3779b97f4a7c15u) ^ (part(i.y) * 0xc2b2ae3d27d4eb4fu) ^
          (part(i.z) * 0x165667b19e3779f9u);
}

/// Which cells are there: bits in bricks of 16^3, for millions of look-ups close to each other.
class Occupancy
{
   struct Brick
   {
      Index corner;
      std::array<std::uint64_t, 64> bits{};
      std::unique_ptr<Brick> next; // of the same key
   };

   static Index cornerOf(Index i) { return {i.x & ~15, i.y & ~15, i.z & ~15}; }
   static unsigned bitOf(Index i) { return unsigned(((i.x & 15) * 16 + (i.y & 15)) * 16 + (i.z & 15)); }

   std::unordered_map<std::uint64_t, std::unique_ptr<Brick>> m_bricks;
   Brick *m_last = nullptr;

public:
   /// False when it was there already (composites may overlap).
   bool add(Index i)
   {
      const Index corner = cornerOf(i);
      if (!m_last || !(m_last->corner == corner)) {
         auto *place = &m_bricks[brickKey(i, 4)];
         while (*place && !((*place)->corner == corner))
            place = &(*place)->next;
         if (!*place) {
            *place = std::make_unique<Brick>();
            (*place)->corner = corner;
         }
         m_last = place->get();
      }
      std::uint64_t &word = m_last->bits[bitOf(i) / 64];
      const std::uint64_t bit = std::uint64_t{1} << (bitOf(i) % 64);
      const bool fresh = !(word & bit);
      word |= bit;
      return fresh;
   }

   class Reader
   {
   public:
      explicit Reader(const Occupancy &from) : m_from(from) {}
      bool has(Index i)
      {
         const Index corner = cornerOf(i);
         if (!m_known || !(m_corner == corner)) {
            const auto found = m_from.m_bricks.find(brickKey(i, 4));
            m_brick = found == m_from.m_bricks.end() ? nullptr : found->second.get();
            while (m_brick && !(m_brick->corner == corner))
               m_brick = m_brick->next.get();
            m_corner = corner;
            m_known = true;
         }
         return m_brick && (m_brick->bits[bitOf(i) / 64] >> (bitOf(i) % 64) & 1);
      }

   private:
      const Occupancy &m_from;
      const Brick *m_brick = nullptr;
      Index m_corner;
      bool m_known = false;
   };
};

struct Listed
{
   Index index;
   MaterialIndex material;
};

/// Bit f set: face f of the cell has nothing in front of it.
std::vector<std::uint64_t> exposedFaces(const Lattice &lattice, const std::vector<Listed> &cells,
                                        const Occupancy &occupancy, const Job &job)
{
   struct Across
   {
      bool any = false;
      Index offset;
   };
   std::vector<std::vector<Across>> across(static_cast<std::size_t>(lattice.sites()));
   for (int site = 0; site < lattice.sites(); ++site)
      for (std::size_t face = 0; face < lattice.shape(site).faces.size(); ++face) {
         const Link *link = lattice.acrossFace(site, static_cast<int>(face));
         across[static_cast<std::size_t>(site)].push_back(link ? Across{true, link->offset} : Across{});
      }
   std::vector<std::uint64_t> masks(cells.size());
   job.parallelFor(static_cast<std::int64_t>(cells.size()), 1 << 15,
                   [&](std::int64_t begin, std::int64_t end) {
                      // One reader per direction, as each walks through bricks of its own.
                      std::vector<Occupancy::Reader> readers(64, Occupancy::Reader(occupancy));
                      for (std::int64_t c = begin; c < end; ++c) {
                         const Index index = cells[static_cast<std::size_t>(c)].index;
                         const auto &faces = across[static_cast<std::size_t>(lattice.site(index))];
                         std::uint64_t mask = 0;
                         for (std::size_t f = 0; f < faces.size() && f < 64; ++f)
                            if (!faces[f].any || !readers[f].has(index + faces[f].offset))
                               mask |= std::uint64_t{1} << f;
                         masks[static_cast<std::size_t>(c)] = mask;
                      }
                   });
   return masks;
}

/// Gives every cell with an exposed face a slot and a chunk.
std::vector<std::uint32_t> fillSlots(CellMesh &mesh, const Lattice &lattice, const std::vector<Listed> &cells,
                                     const std::vector<std::uint64_t> &masks,
                                     std::vector<std::uint64_t> &slotMask)
{
   std::vector<std::uint32_t> chunkOf;
   std::unordered_map<std::uint64_t, std::uint32_t> chunks; // a shared key only makes a chunk larger
   const auto radius = static_cast<float>(lattice.radius());
   for (std::size_t c = 0; c < cells.size(); ++c) {
      if (!masks[c])
         continue;
      const Vec3 world = lattice.position(cells[c].index);
      const Eigen::Vector3f at = (world - mesh.anchor).cast<float>();
      const auto [chunk, fresh] = chunks.try_emplace(brickKey(cells[c].index, kChunkShift),
                                                     static_cast<std::uint32_t>(mesh.chunks.size()));
      if (fresh)
         mesh.chunks.emplace_back();
      mesh.chunks[chunk->second].extend(at - Eigen::Vector3f::Constant(radius));
      mesh.chunks[chunk->second].extend(at + Eigen::Vector3f::Constant(radius));
      mesh.bounds.extend(world - Vec3::Constant(lattice.radius()));
      mesh.bounds.extend(world + Vec3::Constant(lattice.radius()));
      mesh.cells.push_back(cells[c].index);
      mesh.material.push_back(cells[c].material);
      mesh.position.insert(mesh.position.end(), {at.x(), at.y(), at.z(), 0.0f});
      chunkOf.push_back(chunk->second);
      slotMask.push_back(masks[c]);
   }
   return chunkOf;
}

/// Counting sort of the faces by (type, chunk).
void sortFaces(CellMesh &mesh, const Lattice &lattice, const std::vector<std::uint32_t> &chunkOf,
               const std::vector<std::uint64_t> &slotMask)
{
   const std::size_t chunks = mesh.chunks.size();
   mesh.start.assign(mesh.types.types.size() * chunks + 1, 0);
   const auto eachFace = [&](auto &&act) {
      for (std::size_t slot = 0; slot < slotMask.size(); ++slot) {
         const auto first = static_cast<std::size_t>(
             mesh.types.start[static_cast<std::size_t>(lattice.site(mesh.cells[slot]))]);
         for (std::uint64_t mask = slotMask[slot]; mask; mask &= mask - 1)
            act(slot, (first + static_cast<std::size_t>(std::countr_zero(mask))) * chunks + chunkOf[slot]);
      }
   };
   eachFace([&](std::size_t, std::size_t run) { ++mesh.start[run + 1]; });
   for (std::size_t run = 1; run < mesh.start.size(); ++run)
      mesh.start[run] += mesh.start[run - 1];
   mesh.faces.resize(mesh.start.back());
   std::vector<std::uint32_t> next(mesh.start.begin(), mesh.start.end() - 1);
   eachFace([&](std::size_t slot, std::size_t run) {
      mesh.faces[next[run]++] = static_cast<std::uint32_t>(slot);
   });
}

} // namespace

Bounds worldBounds(const Lattice &lattice, const Box &box)
{
   Bounds bounds;
   if (box.empty())
      return bounds;
   // Affine up to the offsets of the sites, which one period in each direction covers.
   for (int corner = 0; corner < 8; ++corner)
      for (int site = 0; site < lattice.sites(); ++site) {
         const auto period = lattice.period();
         const Index shift{site / (period[1] * period[2]), site / period[2] % period[1], site % period[2]};
         const auto pick = [](bool high, std::int32_t low, std::int32_t top, std::int32_t step) {
            return high ? std::max(low, top - step) : std::min(top, low + step);
         };
         const Index at{pick(corner & 1, box.min.x, box.max.x, shift.x),
                        pick(corner & 2, box.min.y, box.max.y, shift.y),
                        pick(corner & 4, box.min.z, box.max.z, shift.z)};
         bounds.extend(lattice.position(at));
      }
   const Vec3 margin = Vec3::Constant(lattice.radius());
   return Bounds(bounds.min() - margin, bounds.max() + margin);
}

Result<CellMesh> buildCellMesh(const Hierarchy &hierarchy, const Job &job, std::uint64_t limit,
                               Covered covered)
{
   const Lattice &lattice = hierarchy.lattice();
   if (hierarchy.cells() > limit)
      return Error{
          ErrorCode::unsupported,
          fmt::format("The assembly has {} cells, more than the {} that can be drawn one by one; use the "
                      "hierarchy view.",
                      hierarchy.cells(), limit)};
   CellMesh mesh;
   mesh.types = faceTypes(lattice);
   const Box box = hierarchy.bounds();
   if (box.empty()) {
      mesh.start.assign(1, 0);
      return mesh;
   }
   const Bounds bounds = worldBounds(lattice, box);
   mesh.anchor = bounds.center();

   std::vector<Listed> cells;
   cells.reserve(hierarchy.cells());
   Occupancy occupancy;
   const bool whole = hierarchy.visit(box, [&](Index i, Cell cell) {
      if (occupancy.add(i))
         cells.push_back({i, cell.material});
      return (cells.size() & 0xffff) != 0 || !job.cancelled();
   });
   if (!whole || job.cancelled())
      return Error{ErrorCode::cancelled, "Preparing the picture was cancelled."};
   auto masks = exposedFaces(lattice, cells, occupancy, job);
   if (covered == Covered::keptOnSurface)
      for (std::size_t c = 0; c < cells.size(); ++c)
         if (const std::size_t faces = lattice.shape(lattice.site(cells[c].index)).faces.size(); masks[c])
            masks[c] = faces < 64 ? (std::uint64_t{1} << faces) - 1 : ~std::uint64_t{0};
   std::vector<std::uint64_t> slotMask;
   const auto chunkOf = fillSlots(mesh, lattice, cells, masks, slotMask);
   sortFaces(mesh, lattice, chunkOf, slotMask);
   return mesh;
}

} // namespace diatom::render
