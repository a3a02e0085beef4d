#include "document/cell_text.h"

#include "document/format.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace diatom {

namespace {

using nlohmann::ordered_json;

struct Block
{
   Cell cell;
   Box box;
};

std::int32_t coordinate(const Index &i, int axis) { return axis == 0 ? i.x : axis == 1 ? i.y : i.z; }
std::int32_t &coordinate(Index &i, int axis) { return axis == 0 ? i.x : axis == 1 ? i.y : i.z; }

/// Merges blocks that touch along `axis` and agree in everything else. From single cells, x then y then z
/// gives a partition that depends on the cells only.
void mergeAlong(std::vector<Block> &blocks, int axis)
{
   const int u = (axis + 1) % 3, v = (axis + 2) % 3;
   const auto across = [&](const Block &b) {
      return std::make_tuple(b.cell.packed(), coordinate(b.box.min, v), coordinate(b.box.max, v),
                             coordinate(b.box.min, u), coordinate(b.box.max, u));
   };
   std::sort(blocks.begin(), blocks.end(), [&](const Block &a, const Block &b) {
      const auto ka = across(a), kb = across(b);
      return ka != kb ? ka < kb : coordinate(a.box.min, axis) < coordinate(b.box.min, axis);
   });
   std::size_t kept = 0;
   for (std::size_t i = 0; i < blocks.size(); ++i) {
      if (kept > 0 && across(blocks[kept - 1]) == across(blocks[i]) &&
          coordinate(blocks[kept - 1].box.max, axis) + 1 == coordinate(blocks[i].box.min, axis))
         coordinate(blocks[kept - 1].box.max, axis) = coordinate(blocks[i].box.max, axis);
      else
         blocks[kept++] = blocks[i];
   }
   blocks.resize(kept);
}

struct Run
{
   Index start, step;
   int length = 0;
   Cell cell;
};

/// The run from `start` along `step`; length 0 when it is not one.
Run followRun(CellArray::Reader &reader, Index start, Index step, Cell first)
{
   Run run{start, step, 1, first};
   for (Index i = start + step; inRange(i); i = i + step) {
      const Cell cell = reader.at(i);
      if (!(cell.joins & Cell::kJoinsPrevious) || cell.material != first.material ||
          cell.orientation != first.orientation)
         break;
      ++run.length;
      if (!(cell.joins & Cell::kJoinsNext))
         return run;
   }
   run.length = 0;
   return run;
}

/// Super-cells of one layer. A step is right when the runs along it cover exactly the joined cells of the
/// layer; in a finite layer no wrong one can (the outermost run would have to continue beyond it).
bool runsOfLayer(const CellArray &cells, const std::vector<std::pair<Index, Cell>> &joined,
                 std::vector<Run> &out)
{
   static constexpr Index kSteps[] = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
   CellArray::Reader reader(cells);
   for (const Index step : kSteps) {
      std::vector<Run> runs;
      std::size_t covered = 0;
      bool good = true;
      for (const auto &[index, cell] : joined) {
         if (cell.joins != Cell::kJoinsNext)
            continue;
         runs.push_back(followRun(reader, index, step, cell));
         covered += static_cast<std::size_t>(runs.back().length);
         if (runs.back().length == 0) {
            good = false;
            break;
         }
      }
      if (good && covered == joined.size()) {
         out.insert(out.end(), runs.begin(), runs.end());
         return true;
      }
   }
   return false;
}

ordered_json blockJson(const Block &block, const Model &model)
{
   const auto &box = block.box;
   const auto &id = model.material(block.cell.material).id;
   const ordered_json size = {box.max.x - box.min.x + 1, box.max.y - box.min.y + 1,
                              box.max.z - box.min.z + 1};
   const bool single = box.min == box.max;
   if (block.cell.orientation == 0 && block.cell.joins == 0) {
      auto entry = ordered_json::array({id, indexJson(box.min)});
      if (!single)
         entry.push_back(size);
      return entry;
   }
   ordered_json entry = {{"at", indexJson(box.min)}};
   if (!single)
      entry["size"] = size;
   entry["material"] = id;
   if (block.cell.orientation != 0)
      entry["orientation"] = block.cell.orientation;
   if (block.cell.joins != 0)
      entry["joins"] = block.cell.joins == 3                  ? "both"
                       : block.cell.joins == Cell::kJoinsNext ? "next"
                                                              : "previous";
   return entry;
}

ordered_json runJson(const Run &run, const Model &model)
{
   ordered_json entry = {{"run", indexJson(run.start)},
                         {"step", indexJson(run.step)},
                         {"length", run.length},
                         {"material", model.material(run.cell.material).id}};
   if (run.cell.orientation != 0)
      entry["orientation"] = run.cell.orientation;
   return entry;
}

auto byPlace(Index i) { return std::make_tuple(i.z, i.y, i.x); }

} // namespace

ordered_json cellsText(const CellArray &cells, const Model &model)
{
   std::vector<Block> blocks;
   std::map<std::int32_t, std::vector<std::pair<Index, Cell>>> joinedByLayer;
   cells.visit([&](Index i, Cell cell) {
      if (cell.joins == 0)
         blocks.push_back({cell, Box{i, i}});
      else
         joinedByLayer[i.z].emplace_back(i, cell);
      return true;
   });
   std::vector<Run> runs;
   for (const auto &[z, joined] : joinedByLayer)
      if (!runsOfLayer(cells, joined, runs))
         for (const auto &[index, cell] : joined)
            blocks.push_back({cell, Box{index, index}});
   for (int axis = 0; axis < 3; ++axis)
      mergeAlong(blocks, axis);
   std::sort(blocks.begin(), blocks.end(), [](const Block &a, const Block &b) {
      return std::make_pair(a.cell.packed(), byPlace(a.box.min)) <
             std::make_pair(b.cell.packed(), byPlace(b.box.min));
   });
   std::sort(runs.begin(), runs.end(),
             [](const Run &a, const Run &b) { return byPlace(a.start) < byPlace(b.start); });
   auto list = ordered_json::array();
   for (const auto &block : blocks)
      list.push_back(blockJson(block, model));
   for (const auto &run : runs)
      list.push_back(runJson(run, model));
   return list;
}

bool CellBudget::take(const Box &box)
{
   const auto brick = [](std::int32_t v) { return std::int64_t{floorDiv(v, 16)}; };
   const std::int64_t x0 = brick(box.min.x), x1 = brick(box.max.x), y0 = brick(box.min.y),
                      y1 = brick(box.max.y), z0 = brick(box.min.z), z1 = brick(box.max.z);
   m_touched += double(x1 - x0 + 1) * double(y1 - y0 + 1) * double(z1 - z0 + 1);
   if (m_touched > kWhole)
      return false;
   const auto whole = [](std::int64_t b, std::int32_t low, std::int32_t high) {
      return b * 16 >= low && b * 16 + 15 <= high;
   };
   for (std::int64_t x = x0; x <= x1; ++x)
      for (std::int64_t y = y0; y <= y1; ++y)
         for (std::int64_t z = z0; z <= z1; ++z) {
            // A brick that is filled whole is stored as one value. Equal keys of different bricks only make
            // it cheaper.
            if (whole(x, box.min.x, box.max.x) && whole(y, box.min.y, box.max.y) &&
                whole(z, box.min.z, box.max.z))
               continue;
            m_bricks.insert(static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15ULL ^
                            static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4fULL ^
                            static_cast<std::uint64_t>(z) * 0x165667b19e3779f9ULL);
            if (m_bricks.size() > kBricks)
               return false;
         }
   return true;
}

MaterialNames materialNames(const Model &model)
{
   MaterialNames names;
   for (std::size_t i = 0; i < model.materials->size(); ++i)
      if (const auto &id = (*model.materials)[i].id; !id.empty())
         names.emplace(id, static_cast<MaterialIndex>(i + 1));
   return names;
}

namespace {

class CellReader
{
public:
   CellReader(const MaterialNames &materials, CellBudget &budget) : m_materials(materials), m_budget(budget)
   {}

   void entry(const JsonPlace &entry)
   {
      if (entry.json().is_array())
         brief(entry);
      else if (entry.has("run"))
         run(entry);
      else if (entry.object())
         block(entry);
   }
   CellArray take() { return std::move(m_cells); }

private:
   MaterialIndex material(const JsonPlace &place)
   {
      const auto id = place.text();
      const auto found = m_materials.find(id);
      if (found != m_materials.end())
         return found->second;
      place.fail(fmt::format("there is no material \"{}\"; add it to /materials or name another", id));
      return 0;
   }

   void put(const JsonPlace &place, const Box &box, Cell cell)
   {
      if (!place.ok())
         return;
      if (!m_budget.take(box)) {
         place.fail(fmt::format(
             "with these cells the design needs more than {} bricks of memory; split it into composites",
             CellBudget::kBricks));
         return;
      }
      Index there;
      const auto found = [&there](Index i, Cell) {
         there = i;
         return false;
      };
      if (!m_cells.visit(box, found))
         place.fail(
             fmt::format("cell [{}, {}, {}] is given twice; remove one of them", there.x, there.y, there.z));
      else if (box.min == box.max)
         m_cells.set(box.min, cell);
      else
         m_cells.fill(box, cell);
   }

   static Box box(const JsonPlace &start, const JsonPlace *size)
   {
      const Index low = start.index();
      const Index n = size ? size->index() : Index{1, 1, 1};
      if (size && (n.x < 1 || n.y < 1 || n.z < 1))
         size->mustBe("a size [nx, ny, nz] of at least 1 each");
      const Index high{low.x + n.x - 1, low.y + n.y - 1, low.z + n.z - 1};
      if (!inRange(high))
         start.fail("the box reaches beyond the index range; make it smaller");
      return {low, high};
   }

   void brief(const JsonPlace &entry)
   {
      const auto n = entry.size();
      if (n != 2 && n != 3) {
         entry.mustBe("[material, [x, y, z]] or [material, [x, y, z], [nx, ny, nz]]");
         return;
      }
      const Cell cell{material(entry.at(0)), 0, 0};
      const auto start = entry.at(1);
      if (n == 3) {
         const auto size = entry.at(2);
         put(entry, box(start, &size), cell);
      } else {
         put(entry, box(start, nullptr), cell);
      }
   }

   static void only(const JsonPlace &entry, std::initializer_list<std::string_view> keys)
   {
      for (const auto &[key, value] : entry.json().items())
         if (std::find(keys.begin(), keys.end(), key) == keys.end())
            entry.fail(fmt::format("has an unknown key \"{}\"; remove it", key));
   }

   std::uint8_t orientation(const JsonPlace &entry)
   {
      return entry.has("orientation") ? static_cast<std::uint8_t>(entry.at("orientation").integer(0, 255))
                                      : std::uint8_t{0};
   }

   void block(const JsonPlace &entry)
   {
      only(entry, {"at", "size", "material", "orientation", "joins"});
      Cell cell{material(entry.at("material")), orientation(entry), 0};
      if (entry.has("joins"))
         cell.joins = static_cast<std::uint8_t>(entry.at("joins").word({"previous", "next", "both"}) + 1);
      const auto start = entry.at("at"), size = entry.at("size");
      put(entry, box(start, entry.has("size") ? &size : nullptr), cell);
   }

   void run(const JsonPlace &entry)
   {
      only(entry, {"run", "step", "length", "material", "orientation"});
      const Index start = entry.at("run").index(), step = entry.at("step").index();
      const auto length = static_cast<std::int32_t>(entry.at("length").integer(1, 100'000));
      const auto what = material(entry.at("material"));
      const auto turned = orientation(entry);
      const auto small = [](std::int32_t v) { return v >= -1000 && v <= 1000; };
      if (step == Index{} || !small(step.x) || !small(step.y) || !small(step.z))
         entry.at("step").mustBe("a step like [0, 1, 0]");
      for (std::int32_t k = 0; k < length && entry.ok(); ++k) {
         const Index i = start + step * k;
         if (!inRange(i))
            entry.fail("the run reaches beyond the index range; make it shorter");
         const auto joins = (k > 0 ? Cell::kJoinsPrevious : 0) | (k + 1 < length ? Cell::kJoinsNext : 0);
         put(entry, {i, i}, {what, turned, static_cast<std::uint8_t>(joins)});
      }
   }

   const MaterialNames &m_materials;
   CellBudget &m_budget;
   CellArray m_cells;
};

} // namespace

CellArray readCells(const JsonPlace &list, const MaterialNames &materials, CellBudget &budget)
{
   CellReader reader(materials, budget);
   const auto count = list.size();
   for (std::size_t i = 0; i < count && list.ok(); ++i)
      reader.entry(list.at(i));
   return reader.take();
}

} // namespace diatom
