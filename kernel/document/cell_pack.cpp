#include "document/cell_pack.h"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <memory>
#include <tuple>

namespace diatom {

namespace {

constexpr std::string_view kMagic = "DIATCEL1";
constexpr std::size_t kFrameBytes = std::size_t{16}
                                    << 20; // of content a frame; the reader refuses larger ones
constexpr int kLevel = 3;
constexpr int kBrick = 16;

using BrickKey = std::tuple<std::int32_t, std::int32_t, std::int32_t>; // z, y, x of the lowest corner
using Brick = std::array<std::uint32_t, kBrick * kBrick * kBrick>;     // x fastest
using Cubes = std::map<BrickKey, std::uint32_t>;                       // of one value

BrickKey keyOf(Index i) { return {i.z, i.y, i.x}; }
Index cornerOf(const BrickKey &key) { return {std::get<2>(key), std::get<1>(key), std::get<0>(key)}; }
std::int32_t down(std::int32_t v, std::int32_t size) { return floorDiv(v, size) * size; }

/// Content split into the largest aligned cubes of one value (edge 16, 32, 64, ...) and bricks of 16^3 mixed
/// cells: one way for any content.
class Splitter
{
public:
   void add(const Box &box, Cell cell)
   {
      if (isCube(box)) {
         m_cubes[box.max.x - box.min.x + 1][keyOf(box.min)] = cell.packed();
         return;
      }
      // The aligned bricks of the box, cut to it.
      for (std::int32_t z = down(box.min.z, kBrick); z <= box.max.z; z += kBrick)
         for (std::int32_t y = down(box.min.y, kBrick); y <= box.max.y; y += kBrick)
            for (std::int32_t x = down(box.min.x, kBrick); x <= box.max.x; x += kBrick)
               addToBrick({x, y, z}, box, cell);
   }

   void finish()
   {
      for (auto brick = m_bricks.begin(); brick != m_bricks.end();) {
         const auto &cells = *brick->second;
         const bool uniform = std::all_of(cells.begin(), cells.end(), [&](auto c) { return c == cells[0]; });
         if (uniform)
            m_cubes[kBrick][brick->first] = cells[0];
         brick = uniform ? m_bricks.erase(brick) : std::next(brick);
      }
      for (auto &[edge, cubes] : m_cubes) // grows at its end while it is walked
         if (edge < (1 << 29))
            joinSiblings(cubes, edge);
   }

   const std::map<std::int32_t, Cubes> &cubes() const { return m_cubes; }
   const std::map<BrickKey, std::unique_ptr<Brick>> &bricks() const { return m_bricks; }

private:
   static bool isCube(const Box &box)
   {
      const std::int64_t n = std::int64_t{box.max.x} - box.min.x + 1;
      const bool cube =
          n == std::int64_t{box.max.y} - box.min.y + 1 && n == std::int64_t{box.max.z} - box.min.z + 1;
      if (!cube || n < kBrick || (n & (n - 1)) != 0)
         return false;
      const auto size = static_cast<std::int32_t>(n);
      return floorMod(box.min.x, size) == 0 && floorMod(box.min.y, size) == 0 &&
             floorMod(box.min.z, size) == 0;
   }

   void addToBrick(Index corner, const Box &box, Cell cell)
   {
      const Index end = corner + Index{kBrick - 1, kBrick - 1, kBrick - 1};
      const Box part{
          {std::max(corner.x, box.min.x), std::max(corner.y, box.min.y), std::max(corner.z, box.min.z)},
          {std::min(end.x, box.max.x), std::min(end.y, box.max.y), std::min(end.z, box.max.z)}};
      if (part.min == corner && part.max == end) {
         m_cubes[kBrick][keyOf(corner)] = cell.packed();
         return;
      }
      auto &brick = m_bricks[keyOf(corner)];
      if (!brick)
         brick = std::make_unique<Brick>();
      for (std::int32_t z = part.min.z - corner.z; z <= part.max.z - corner.z; ++z)
         for (std::int32_t y = part.min.y - corner.y; y <= part.max.y - corner.y; ++y)
            for (std::int32_t x = part.min.x - corner.x; x <= part.max.x - corner.x; ++x)
               (*brick)[(static_cast<std::size_t>(z) * kBrick + static_cast<std::size_t>(y)) * kBrick +
                        static_cast<std::size_t>(x)] = cell.packed();
   }

   /// Eight equal neighbours that fill a cube of twice the size become that cube.
   void joinSiblings(Cubes &cubes, std::int32_t size)
   {
      std::map<BrickKey, std::pair<int, std::uint32_t>> parents; // how many equal children
      for (const auto &[key, value] : cubes) {
         const Index i = cornerOf(key);
         const BrickKey parent = keyOf({down(i.x, 2 * size), down(i.y, 2 * size), down(i.z, 2 * size)});
         const auto [entry, made] = parents.try_emplace(parent, 0, value);
         if (entry->second.second == value)
            ++entry->second.first;
      }
      for (const auto &[parent, content] : parents) {
         if (content.first != 8)
            continue;
         const Index corner = cornerOf(parent);
         for (int child = 0; child < 8; ++child)
            cubes.erase(keyOf(corner + Index{child & 1, (child >> 1) & 1, child >> 2} * size));
         m_cubes[2 * size][parent] = content.second;
      }
   }

   std::map<std::int32_t, Cubes> m_cubes; // by edge length
   std::map<BrickKey, std::unique_ptr<Brick>> m_bricks;
};

class FrameWriter
{
public:
   template<typename T>
   void add(T value)
   {
      for (std::size_t byte = 0; byte < sizeof value; ++byte)
         m_content.push_back(static_cast<char>(static_cast<std::make_unsigned_t<T>>(value) >> (8 * byte)));
   }
   void add(Index i)
   {
      add(i.x);
      add(i.y);
      add(i.z);
   }
   /// Between two records: a frame ends where it is full.
   Status record() { return m_content.size() >= kFrameBytes - sizeof(Brick) - 64 ? flush() : Status(); }
   Status flush()
   {
      std::string packed(ZSTD_compressBound(m_content.size()), '\0');
      const auto size =
          ZSTD_compress(packed.data(), packed.size(), m_content.data(), m_content.size(), kLevel);
      if (ZSTD_isError(size))
         return Error{ErrorCode::internal, fmt::format("packing cells failed: {}", ZSTD_getErrorName(size))};
      m_bytes.append(packed.data(), size);
      m_content.clear();
      return {};
   }
   std::string take() { return std::move(m_bytes); }

private:
   std::string m_bytes{kMagic}, m_content;
};

class FrameReader
{
public:
   explicit FrameReader(std::string_view bytes) : m_bytes(bytes) {}

   /// False at the end of the bytes or after a fault.
   bool more()
   {
      if (m_at < m_content.size())
         return true;
      return error.empty() && !m_bytes.empty() && nextFrame();
   }
   std::uint32_t word()
   {
      if (m_content.size() - m_at < 4) {
         error = "a record is cut short";
         m_at = m_content.size();
         return 0;
      }
      std::uint32_t value = 0;
      for (int byte = 0; byte < 4; ++byte)
         value |= std::uint32_t{static_cast<std::uint8_t>(m_content[m_at++])} << (8 * byte);
      return value;
   }
   Index index()
   {
      const auto x = word(), y = word(), z = word();
      return {static_cast<std::int32_t>(x), static_cast<std::int32_t>(y), static_cast<std::int32_t>(z)};
   }

   std::string error;

private:
   bool nextFrame()
   {
      const auto packed = ZSTD_findFrameCompressedSize(m_bytes.data(), m_bytes.size());
      const auto size = ZSTD_getFrameContentSize(m_bytes.data(), m_bytes.size());
      if (ZSTD_isError(packed) || size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN ||
          size > kFrameBytes)
      {
         error = "a block is cut short or is not one of ours";
         return false;
      }
      m_content.resize(size);
      m_at = 0;
      const auto got = ZSTD_decompress(m_content.data(), m_content.size(), m_bytes.data(), packed);
      if (ZSTD_isError(got) || got != size) {
         error = "a block is damaged";
         m_content.clear();
         return false;
      }
      m_bytes.remove_prefix(packed);
      return size > 0 || (!m_bytes.empty() && nextFrame());
   }

   std::string_view m_bytes;
   std::string m_content;
   std::size_t m_at = 0;
};

bool brickInRange(Index corner)
{
   const auto fits = [](std::int32_t v) { return v >= -kIndexLimit - 1 && v <= kIndexLimit; };
   return fits(corner.x) && fits(corner.y) && fits(corner.z);
}

/// Puts one record's cells in place; the fault in words, or nothing.
std::string place(CellArray &cells, const Box &box, std::uint32_t packed, std::size_t materials)
{
   const Cell cell = Cell::unpacked(packed);
   if (cell.empty() || cell.material > materials || cell.joins > 3 || !inRange(box.min))
      return fmt::format("the cell at [{}, {}, {}] has material {} of {}", box.min.x, box.min.y, box.min.z,
                         cell.material, materials);
   if (box.min == box.max)
      cells.set(box.min, cell);
   else
      cells.fill(box, cell);
   return {};
}

std::string readBrick(FrameReader &in, CellArray &cells, Index corner, std::size_t materials)
{
   Brick brick;
   for (auto &cell : brick)
      cell = in.word();
   std::string fault = in.error;
   std::size_t i = 0;
   for (std::int32_t z = 0; z < kBrick; ++z)
      for (std::int32_t y = 0; y < kBrick; ++y)
         for (std::int32_t x = 0; x < kBrick && fault.empty(); ++x, ++i)
            if (const Index at = corner + Index{x, y, z}; brick[i] != 0)
               fault = place(cells, {at, at}, brick[i], materials);
   return fault;
}

} // namespace

Result<std::string> packCells(const CellArray &cells, const Job &job)
{
   if (cells.empty())
      return std::string(kMagic);
   Splitter split;
   cells.visitBlocks(cells.bounds(), [&](const Box &box, Cell cell) {
      split.add(box, cell);
      return !job.cancelled();
   });
   split.finish();
   if (job.cancelled())
      return Error{ErrorCode::cancelled, "packing cells was cancelled"};
   if (split.bricks().size() > CellBudget::kBricks)
      return Error{ErrorCode::invalid,
                   fmt::format("one body has more than {} bricks of single cells, more than a document may "
                               "hold; split it into composites",
                               CellBudget::kBricks)};
   FrameWriter out;
   for (const auto &[edge, cubes] : split.cubes())
      for (const auto &[key, value] : cubes) {
         out.add(static_cast<std::uint32_t>(edge));
         out.add(cornerOf(key));
         out.add(value);
         if (const auto done = out.record(); !done)
            return done.error();
      }
   for (const auto &[key, brick] : split.bricks()) {
      out.add(std::uint32_t{0});
      out.add(cornerOf(key));
      for (const auto cell : *brick)
         out.add(cell);
      if (const auto done = out.record(); !done)
         return done.error();
   }
   if (const auto done = out.flush(); !done)
      return done.error();
   return out.take();
}

Result<CellArray> unpackCells(std::string_view bytes, std::size_t materials, CellBudget &budget,
                              const Job &job)
{
   const auto refuse = [](std::string why) { return Error{ErrorCode::unreadable, std::move(why)}; };
   if (!bytes.starts_with(kMagic))
      return refuse("it does not begin as packed cells do");
   CellArray cells;
   FrameReader in(bytes.substr(kMagic.size()));
   while (in.more()) {
      if (job.cancelled())
         return Error{ErrorCode::cancelled, "opening was cancelled"};
      const auto edge = in.word();
      const Index corner = in.index();
      const auto size =
          static_cast<std::int32_t>(edge == 0 ? kBrick : std::min(edge, std::uint32_t{1} << 30));
      const bool aligned = (size & (size - 1)) == 0 && size >= kBrick && floorMod(corner.x, size) == 0 &&
                           floorMod(corner.y, size) == 0 && floorMod(corner.z, size) == 0;
      // A brick at the lower border begins one index beyond it; its cells are checked one by one.
      const bool near = edge == 0 ? brickInRange(corner) : inRange(corner);
      const Index end = near ? corner + Index{size - 1, size - 1, size - 1} : corner;
      if (!in.error.empty() || !aligned || !near || !inRange(end))
         return refuse(in.error.empty() ? "a block lies where none can" : in.error);
      const Box box{corner, end};
      // One value costs about as much as one brick at most, however large the cube is.
      if (!budget.take({corner, corner}))
         return refuse(fmt::format("it holds more than {} bricks", CellBudget::kBricks));
      if (!cells.visit(box, [](Index, Cell) { return false; }))
         return refuse(fmt::format("the block at [{}, {}, {}] is given twice", corner.x, corner.y, corner.z));
      const auto fault =
          edge == 0 ? readBrick(in, cells, corner, materials) : place(cells, box, in.word(), materials);
      if (!fault.empty() || !in.error.empty())
         return refuse(fault.empty() ? in.error : fault);
   }
   if (!in.error.empty())
      return refuse(in.error);
   return cells;
}

} // namespace diatom
