// Commands on supports, drives, loads, starts and fields. All take the same words for the cells they are on.
#include "document/command_edit.h"
#include "scene/where.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace diatom {

namespace {

constexpr std::size_t kMostHeld = 1'000'000;

/// Arguments "cell", "cells" or "box" (every cell in it), all of which must exist.
std::vector<Index> existingCells(Edit &edit)
{
   std::vector<Index> cells;
   if (!edit.hierarchy())
      return cells;
   if (!edit.arguments().has("box")) {
      cells = edit.cells();
      for (const Index cell : cells)
         if (edit.ok() && edit.hierarchy()->at(cell).empty())
            edit.fail(ErrorCode::invalid, fmt::format("there is no cell at {}", cellText(cell)));
      return cells;
   }
   const Box box = edit.box();
   if (!edit.ok())
      return cells;
   edit.hierarchy()->visit(box, [&](Index i, Cell) {
      cells.push_back(i);
      return cells.size() <= kMostHeld;
   });
   if (cells.empty())
      edit.fail(ErrorCode::invalid, "there are no cells in the box");
   if (cells.size() > kMostHeld)
      edit.fail(
          ErrorCode::invalid,
          fmt::format("there are more than {} cells in the box; name it as a region, or take a smaller one",
                      kMostHeld));
   return cells;
}

constexpr const char *kPlaceKeys[] = {"cell", "cells", "box", "region", "material"};

/// Words for cells contradict each other: none is passed over in silence.
void refuseTwoPlaces(Edit &edit)
{
   const auto given = std::count_if(std::begin(kPlaceKeys), std::end(kPlaceKeys),
                                    [&](const char *key) { return edit.arguments().has(key); });
   if (given > 1)
      edit.fail(ErrorCode::usage, fmt::format("give only one of {}", fmt::join(kPlaceKeys, ", ")));
}

/// Argument "material".
OfMaterial namedMaterial(Edit &edit)
{
   const MaterialIndex material = edit.material("material");
   return edit.ok() ? OfMaterial{edit.model().material(material).id} : OfMaterial();
}

/// What an entry is made on: each cell named, or the region or material as such.
std::vector<Where> places(Edit &edit)
{
   refuseTwoPlaces(edit);
   const auto &given = edit.arguments();
   std::vector<Where> found;
   if (given.has("region"))
      found.emplace_back(edit.box("region"));
   else if (given.has("material"))
      found.emplace_back(namedMaterial(edit));
   if (!found.empty()) {
      if (edit.ok() && edit.hierarchy() && !anyCell(*edit.hierarchy(), found.front()))
         edit.fail(ErrorCode::invalid, fmt::format("there is no cell in the {}", whereText(found.front())));
      return found;
   }
   for (const Index cell : existingCells(edit))
      found.emplace_back(cell);
   return found;
}

/// Entries to remove: those on the named cells, region or material, and those within the named box.
template<typename Item>
std::size_t removeNamed(Edit &edit, std::vector<Item> &items)
{
   refuseTwoPlaces(edit);
   const auto &given = edit.arguments();
   std::vector<Where> named;
   if (given.has("region"))
      named.emplace_back(edit.box("region"));
   else if (given.has("material"))
      named.emplace_back(OfMaterial{given.at("material").identifier()});
   else if (!given.has("box"))
      for (const Index cell : edit.cells())
         named.emplace_back(cell);
   const Box box = given.has("box") ? edit.box() : Box();
   return std::erase_if(items, [&](const Item &item) {
      const auto *cell = std::get_if<Index>(&item.where);
      return (cell && box.contains(*cell)) ||
             std::find(named.begin(), named.end(), item.where) != named.end();
   });
}

/// The entry's own values from the arguments, which also hold words for cells that the entry's reader does
/// not know.
nlohmann::json withoutPlaces(const Edit &edit)
{
   auto values = edit.arguments().json();
   for (const char *key : kPlaceKeys)
      values.erase(key);
   values["cell"] = {0, 0, 0}; // stands for each of the places
   return values;
}

/// Reads an entry with the arguments' values; faults name the command and the argument.
template<typename Item>
Item readValues(Edit &edit, Item (*read)(const JsonPlace &))
{
   if (!edit.ok())
      return {};
   const auto values = withoutPlaces(edit);
   ReadLog log{"", {}, nlohmann::json::object()};
   Item item = read(JsonPlace(values, log));
   if (log.error)
      edit.fail(ErrorCode::usage, log.error->message.substr(log.name.size() + 2));
   return item;
}

/// Puts one entry on each place; it takes the place of entries there that are `same`.
template<typename Item, typename Same>
void putOn(std::vector<Item> &items, const std::vector<Where> &where, const Item &item, bool keep, Same same)
{
   auto sorted = where;
   std::sort(sorted.begin(), sorted.end(), before);
   std::erase_if(items, [&](const Item &old) {
      return same(old) && std::binary_search(sorted.begin(), sorted.end(), old.where, before);
   });
   for (std::size_t i = 0; keep && i < where.size(); ++i) {
      items.push_back(item);
      items.back().where = where[i];
   }
}

constexpr auto kAny = [](const auto &) { return true; };

Result<std::string> support(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "support", arguments);
   const auto where = places(edit);
   const auto item = readValues(edit, readSupport);
   auto &supports = edit.design().setup.supports;
   putOn(supports, where, item, item.fixed != 0, kAny);
   std::stable_sort(supports.begin(), supports.end(),
                    [](const Support &a, const Support &b) { return before(a.where, b.where); });
   return edit.commit(countText("support", where.size()));
}

Result<std::string> unsupport(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "unsupport", arguments);
   if (removeNamed(edit, edit.design().setup.supports) == 0)
      edit.fail(ErrorCode::invalid, "none of these cells is supported");
   return edit.commit("release");
}

Result<std::string> drive(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "drive", arguments);
   const auto where = places(edit);
   const auto item = readValues(edit, readDrive);
   putOn(edit.design().setup.drives, where, item, true,
         [&](const Drive &old) { return old.freedom == item.freedom; });
   return edit.commit(countText("drive", where.size()));
}

Result<std::string> undrive(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "undrive", arguments);
   if (removeNamed(edit, edit.design().setup.drives) == 0)
      edit.fail(ErrorCode::invalid, "none of these cells is driven");
   return edit.commit("stop driving");
}

Result<std::string> load(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "load", arguments);
   const auto where = places(edit);
   const auto item = readValues(edit, readLoad);
   const bool keep = item.force != std::array<double, 3>{} || item.moment != std::array<double, 3>{};
   putOn(edit.design().setup.loads, where, item, keep, kAny);
   return edit.commit(countText("load", where.size()));
}

Result<std::string> start(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "start", arguments);
   const auto where = places(edit);
   auto item = readValues(edit, readStart);
   item.where = Index();
   putOn(edit.design().setup.starts, where, item, item != Start{}, kAny);
   return edit.commit(countText("start", where.size()));
}

Result<std::string> field(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "field", arguments);
   const auto where = places(edit);
   const auto item = readValues(edit, readField);
   putOn(edit.design().setup.fields, where, item, true,
         [&](const Field &old) { return old.name == item.name; });
   return edit.commit(countText("field", where.size()));
}

Result<std::string> unfield(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "unfield", arguments);
   if (removeNamed(edit, edit.design().setup.fields) == 0)
      edit.fail(ErrorCode::invalid, "no field is set on any of these cells");
   return edit.commit("remove field");
}

#define DIATOM_PLACES                                                                                        \
   {"cell", "index", false, "which cell; or one of the next four"},                                          \
       {"cells", "cells", false, "several cells"}, {"box", "box", false, "every cell that is in a box now"}, \
       {"region", "box", false, "a box as such, with what is placed in it later"},                           \
   {                                                                                                         \
      "material", "material", false, "every cell of a material"                                              \
   }

constexpr CommandParameter kSupport[] = {
    DIATOM_PLACES,
    {"fixed", "list", false, "of x, y, z, rx, ry, rz; default all; none removes the support"},
};
constexpr CommandParameter kPlaces[] = {DIATOM_PLACES};
constexpr CommandParameter kDrive[] = {
    DIATOM_PLACES,
    {"freedom", "text", true, "x, y, z, rx, ry or rz"},
    {"curve_s_m", "list", false, "of [time, displacement] for x, y and z"},
    {"curve_s_rad", "list", false, "of [time, turn] for rx, ry and rz"},
};
constexpr CommandParameter kLoad[] = {
    DIATOM_PLACES,
    {"force_N", "list", false, "on each cell along x, y and z; without force and moment the load is removed"},
    {"moment_N_m", "list", false, "on each cell about x, y and z"},
};
constexpr CommandParameter kStart[] = {
    DIATOM_PLACES,
    {"displacement_m", "list", false, "since rest; without any value the start is removed"},
    {"turn_rad", "list", false, "since rest, about x, y and z"},
    {"velocity_m_s", "list", false, "along x, y and z"},
    {"spin_rad_s", "list", false, "about x, y and z"},
    {"about_m", "list", false, "point that the cells turn and spin about as one body"},
};

constexpr CommandParameter kField[] = {
    DIATOM_PLACES,
    {"name", "text", true, "what it is, as the solver calls it"},
    {"values", "list", true, "numbers of each of the cells"},
};

constexpr Command kBoundaryTable[] = {
    {"support", "Support cells", "Holds cells at rest, in all or some of their freedoms.", kSupport, support},
    {"unsupport", "Release cells", "Removes supports.", kPlaces, unsupport},
    {"drive", "Drive cells", "Moves a freedom of cells along a curve over time.", kDrive, drive},
    {"undrive", "Stop driving cells", "Removes drives.", kPlaces, undrive},
    {"load", "Load cells", "Puts a constant force and moment on each of the cells.", kLoad, load},
    {"start", "Start cells", "Sets where cells start and how fast.", kStart, start},
    {"field", "Set a field", "Sets numbers that a solver of other physics takes by name, as a temperature.",
     kField, field},
    {"unfield", "Remove fields", "Removes what was set by field.", kPlaces, unfield},
};

} // namespace

const std::span<const Command> kBoundaryCommands = kBoundaryTable;

} // namespace diatom
