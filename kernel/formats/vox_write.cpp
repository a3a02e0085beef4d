#include "formats/vox.h"

#include "formats/vox_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace diatom {

namespace {

constexpr std::int32_t kSide = 256; // cells along a model
constexpr std::size_t kMostModels = 1'000'000;
constexpr std::int32_t kVersion = 150;

void putNumber(std::string &to, std::int32_t value)
{
   for (int k = 0; k < 4; ++k)
      to += static_cast<char>(static_cast<std::uint32_t>(value) >> (8 * k));
}

void putText(std::string &to, std::string_view text)
{
   putNumber(to, static_cast<std::int32_t>(text.size()));
   to += text;
}

void putChunk(std::string &to, std::string_view id, const std::string &content)
{
   to += id;
   putNumber(to, static_cast<std::int32_t>(content.size()));
   putNumber(to, 0);
   to += content;
}

/// Cells of one block of kSide^3.
struct VoxBlock
{
   Box bounds;
   std::string cells; // absolute coordinates within the block, and colour
};

class VoxWriter
{
public:
   VoxWriter(const Design &design, const Hierarchy &hierarchy, std::vector<std::string> &notes,
             const Job &job)
       : m_design(design), m_hierarchy(hierarchy), m_notes(notes), m_job(job)
   {}

   Result<std::string> run()
   {
      if (const Status status = check(); !status)
         return status.error();
      if (const Status status = chooseColors(); !status)
         return status.error();
      if (const Status status = collect(); !status)
         return status.error();
      tellLosses();
      std::string chunks;
      putModels(chunks);
      putScene(chunks);
      putPalette(chunks);
      if (chunks.size() > 0x7fff'ffff)
         return Error{ErrorCode::invalid, "a .vox file holds at most 2 GB; write a part of the design"};
      std::string file(kVoxStart);
      putNumber(file, kVersion);
      file += "MAIN";
      putNumber(file, 0);
      putNumber(file, static_cast<std::int32_t>(chunks.size()));
      return file + chunks;
   }

private:
   Status check() const
   {
      const LatticeSpec &lattice = m_design.model.lattice;
      if (lattice.id != LatticeSpec().id)
         return Error{ErrorCode::unsupported,
                      fmt::format("a .vox file holds cubes only, this design is on {}; export a mesh instead",
                                  lattice.id)};
      if (m_hierarchy.bounds().empty())
         return Error{ErrorCode::invalid, "there are no cells to write"};
      return {};
   }

   /// Numbers of earlier .vox files are kept; others take the free ones in turn.
   Status chooseColors()
   {
      const auto counts = m_hierarchy.countByMaterial();
      m_color.assign(counts.size(), 0);
      std::array<bool, 256> taken{};
      for (std::size_t m = 1; m < counts.size(); ++m) {
         const int wanted = counts[m] > 0 ? vox::colorOf(materialAt(m).id) : 0;
         if (wanted > 0 && !taken[static_cast<std::size_t>(wanted)]) {
            m_color[m] = wanted;
            taken[static_cast<std::size_t>(wanted)] = true;
         }
      }
      int next = 1;
      for (std::size_t m = 1; m < counts.size(); ++m) {
         if (counts[m] == 0 || m_color[m] != 0)
            continue;
         while (next < 256 && taken[static_cast<std::size_t>(next)])
            ++next;
         if (next == 256)
            return Error{ErrorCode::unsupported,
                         "a .vox file has 255 colours, this design has more materials in use"};
         m_color[m] = next++;
      }
      return {};
   }

   const Material &materialAt(std::size_t m) const
   {
      return m_design.model.material(static_cast<MaterialIndex>(m));
   }

   Status collect()
   {
      bool spread = false;
      const std::uint64_t all = m_hierarchy.cells();
      std::uint64_t seen = 0;
      m_hierarchy.visit(m_hierarchy.bounds(), [&](Index i, Cell cell) {
         const Index block{floorDiv(i.x, kSide), floorDiv(i.y, kSide), floorDiv(i.z, kSide)};
         VoxBlock &into = m_blocks[block];
         into.bounds.extend(i);
         for (const auto value : {floorMod(i.x, kSide), floorMod(i.y, kSide), floorMod(i.z, kSide),
                                  std::int32_t{m_color[cell.material]}})
            into.cells += static_cast<char>(value);
         m_turned = m_turned || cell.orientation != 0;
         spread = m_blocks.size() > kMostModels;
         if (++seen % (1 << 20) == 0)
            m_job.progress(static_cast<double>(seen) / static_cast<double>(all), "writing cells");
         return !spread && !m_job.cancelled();
      });
      if (m_job.cancelled())
         return Error{ErrorCode::cancelled, "writing was cancelled"};
      if (spread)
         return Error{ErrorCode::invalid,
                      "the cells are spread over more models than a .vox file should hold"};
      return {};
   }

   void tellLosses()
   {
      const Model &model = m_design.model;
      m_notes.push_back("a .vox file keeps cells and colours; sizes and physics of materials are lost");
      if (m_turned)
         m_notes.push_back("orientations of cells are lost");
      if (!model.definitions.empty())
         m_notes.push_back("composites were written as plain cells");
   }

   void putModels(std::string &to) const
   {
      for (const auto &[block, content] : m_blocks) {
         const Index low = content.bounds.min, size = content.bounds.max - low + Index{1, 1, 1};
         std::string chunk;
         for (const std::int32_t side : {size.x, size.y, size.z})
            putNumber(chunk, side);
         putChunk(to, "SIZE", chunk);
         chunk.clear();
         putNumber(chunk, static_cast<std::int32_t>(content.cells.size() / 4));
         const std::array<std::int32_t, 3> from{floorMod(low.x, kSide), floorMod(low.y, kSide),
                                                floorMod(low.z, kSide)};
         for (std::size_t k = 0; k < content.cells.size(); ++k) {
            const auto byte = static_cast<std::uint8_t>(content.cells[k]);
            chunk += static_cast<char>(k % 4 < 3 ? byte - from[k % 4] : byte);
         }
         putChunk(to, "XYZI", chunk);
      }
   }

   void putScene(std::string &to) const
   {
      const auto transformation = [&](std::int32_t node, std::int32_t child, const std::string &shift) {
         std::string chunk;
         putNumber(chunk, node);
         putNumber(chunk, 0); // attributes
         putNumber(chunk, child);
         putNumber(chunk, -1); // reserved
         putNumber(chunk, -1); // layer
         putNumber(chunk, 1);  // frames
         putNumber(chunk, shift.empty() ? 0 : 1);
         if (!shift.empty()) {
            putText(chunk, "_t");
            putText(chunk, shift);
         }
         putChunk(to, "nTRN", chunk);
      };
      transformation(0, 1, {});
      std::string group;
      putNumber(group, 1);
      putNumber(group, 0);
      putNumber(group, static_cast<std::int32_t>(m_blocks.size()));
      for (std::size_t k = 0; k < m_blocks.size(); ++k)
         putNumber(group, static_cast<std::int32_t>(2 + 2 * k));
      putChunk(to, "nGRP", group);
      std::int32_t model = 0;
      for (const auto &[block, content] : m_blocks) {
         const std::int32_t node = 2 + 2 * model;
         const Index low = content.bounds.min, size = content.bounds.max - low + Index{1, 1, 1};
         transformation(node, node + 1,
                        fmt::format("{} {} {}", low.x + size.x / 2, low.y + size.y / 2, low.z + size.z / 2));
         std::string shape;
         for (const std::int32_t value : {node + 1, 0, 1, model, 0})
            putNumber(shape, value);
         putChunk(to, "nSHP", shape);
         ++model;
      }
   }

   void putPalette(std::string &to) const
   {
      vox::Palette palette = vox::defaultPalette();
      for (std::size_t m = 1; m < m_color.size(); ++m)
         if (m_color[m] != 0)
            palette[static_cast<std::size_t>(m_color[m])] = materialAt(m).color;
      std::string chunk;
      for (std::size_t k = 1; k <= 256; ++k) {
         const auto color = k < 256 ? palette[k] : std::array<std::uint8_t, 3>{};
         for (const std::uint8_t channel : color)
            chunk += static_cast<char>(channel);
         chunk += static_cast<char>(k < 256 ? 0xff : 0);
      }
      putChunk(to, "RGBA", chunk);
   }

   const Design &m_design;
   const Hierarchy &m_hierarchy;
   std::vector<std::string> &m_notes;
   const Job &m_job;
   std::vector<int> m_color; // per material
   std::map<Index, VoxBlock> m_blocks;
   bool m_turned = false;
};

} // namespace

Result<std::string> writeVox(const Design &design, const Hierarchy &hierarchy,
                             std::vector<std::string> &notes, const Job &job)
{
   return VoxWriter(design, hierarchy, notes, job).run();
}

} // namespace diatom
