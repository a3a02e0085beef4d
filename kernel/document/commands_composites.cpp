// Commands on composites: group into a definition, place, dissolve, forget.
#include "document/command_edit.h"

#include <fmt/format.h>

#include <algorithm>

namespace diatom {

namespace {

/// The lattice's period point at or below an index: a composite may stand there unturned.
Index periodFloor(const Lattice &lattice, Index i)
{
   const auto down = [&](std::int32_t v, std::size_t axis) {
      return floorDiv(v, lattice.period()[axis]) * lattice.period()[axis];
   };
   return {down(i.x, 0), down(i.y, 1), down(i.z, 2)};
}

/// Moves what lies in the box from the root into `body`, relative to `origin`.
void gather(Edit &edit, const Box &box, Index origin, Body &body)
{
   const auto *before = edit.hierarchy();
   auto &root = edit.model().root;
   std::vector<std::pair<Index, Cell>> taken;
   root.cells.visit(box, [&](Index i, Cell cell) {
      taken.emplace_back(i, cell);
      if (cell.joins != 0)
         for (const Index j : before->supercell(i))
            if (!box.contains(j))
               edit.fail(ErrorCode::invalid,
                         fmt::format("the box cuts the super-cell at {}; make it larger", cellText(i)));
      return edit.ok() && !edit.job().cancelled();
   });
   std::vector<Placement> placed;
   before->visit(box, [&](Index i, Cell) {
      if (root.cells.at(i).empty())
         if (const auto found = before->find(i); found && !found->path.empty())
            placed.push_back(found->path.front());
      return !edit.job().cancelled();
   });
   std::sort(placed.begin(), placed.end());
   placed.erase(std::unique(placed.begin(), placed.end()), placed.end());
   for (const auto &[index, cell] : taken) {
      root.cells.set(index, {});
      body.cells.set(index - origin, cell);
   }
   for (auto placement : placed) {
      root.instances.erase(placement);
      placement.origin = placement.origin - origin;
      body.instances.insert(placement);
   }
   if (edit.ok() && taken.empty() && placed.empty())
      edit.fail(ErrorCode::invalid, "there is nothing in the box");
}

Result<std::string> defineComposite(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "define-composite", arguments);
   Definition definition;
   definition.id = edit.arguments().at("id").identifier();
   definition.name = edit.arguments().textOr("name", definition.id);
   if (edit.arguments().has("color"))
      definition.color = edit.arguments().at("color").color();
   const Box box = edit.box();
   if (edit.ok() && edit.model().definition(definition.id) != 0)
      edit.fail(ErrorCode::invalid,
                fmt::format("there is a composite \"{}\" already; choose another id", definition.id));
   if (edit.ok() && edit.hierarchy()) {
      const Index origin = periodFloor(edit.hierarchy()->lattice(), box.min);
      gather(edit, box, origin, definition.body);
      const auto added =
          edit.ok() ? edit.model().setDefinition(definition) : Result<DefinitionId>(DefinitionId{0});
      if (!added)
         edit.fail(added.error().code, added.error().message);
      else if (edit.ok())
         edit.model().root.instances.insert({*added, origin, 0});
   }
   return edit.commit(fmt::format("group {}", definition.id));
}

/// First cell of the placement that something else takes already.
std::optional<Index> collision(Edit &edit, const Placement &placement)
{
   const auto *before = edit.hierarchy();
   Model one = edit.design().model;
   one.root = {};
   one.root.instances.insert(placement);
   const std::shared_ptr<const Lattice> lattice(std::shared_ptr<void>(), &before->lattice());
   const Hierarchy alone(lattice, std::move(one), before);
   const Box bounds = alone.bounds();
   if (!bounds.empty() && (!inRange(bounds.min) || !inRange(bounds.max))) {
      edit.fail(ErrorCode::invalid,
                "the composite would lie outside the index range; place it nearer to the origin");
      return std::nullopt;
   }
   std::optional<Index> hit;
   if (!bounds.empty())
      before->visit(bounds, [&](Index i, Cell) {
         if (!alone.at(i).empty())
            hit = i;
         return !hit.has_value() && !edit.job().cancelled();
      });
   return hit;
}

Result<std::string> placeComposite(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "place-composite", arguments);
   const auto id = edit.arguments().at("definition").text();
   Placement placement{edit.model().definition(id), edit.arguments().at("cell").index(), 0};
   if (edit.ok() && placement.definition == 0)
      edit.fail(ErrorCode::usage,
                fmt::format("there is no composite \"{}\"; make it with define-composite", id));
   if (edit.ok() && edit.hierarchy()) {
      const auto &lattice = edit.hierarchy()->lattice();
      if (edit.arguments().has("rotation"))
         placement.rotation = static_cast<std::uint8_t>(
             edit.arguments()
                 .at("rotation")
                 .integer(0, static_cast<std::int64_t>(lattice.rotations().size()) - 1));
      if (edit.ok() && !lattice.placementAllowed(placement.origin, placement.rotation))
         edit.fail(
             ErrorCode::invalid,
             fmt::format("the lattice does not fit onto itself with rotation {} at {}; the directions of "
                         "its cells differ there",
                         placement.rotation, cellText(placement.origin)));
      if (edit.ok())
         if (const auto hit = collision(edit, placement))
            edit.fail(ErrorCode::invalid,
                      fmt::format("{} is taken; place the composite elsewhere", cellText(*hit)));
      if (edit.ok())
         edit.model().root.instances.insert(placement);
   }
   return edit.commit(fmt::format("place {}", id));
}

/// Joins of a cell after its super-cell was turned: a run may now be read from its other end.
std::uint8_t turnedJoins(const Lattice &lattice, const Placement &placement, Index local, Cell cell,
                         Index world)
{
   if (cell.joins == 0 || placement.rotation == 0)
      return cell.joins;
   const Index next = lattice.place(placement.origin, placement.rotation,
                                    local + lattice.supercellStep(lattice.site(local)));
   if (next == world + lattice.supercellStep(lattice.site(world)))
      return cell.joins;
   return static_cast<std::uint8_t>(((cell.joins & Cell::kJoinsNext) ? Cell::kJoinsPrevious : 0) |
                                    ((cell.joins & Cell::kJoinsPrevious) ? Cell::kJoinsNext : 0));
}

Result<std::string> dissolve(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "dissolve", arguments);
   const Index cell = edit.arguments().at("cell").index();
   const auto *before = edit.ok() ? edit.hierarchy() : nullptr;
   const auto found = before ? before->find(cell) : std::nullopt;
   if (before && (!found || found->path.empty()))
      edit.fail(ErrorCode::invalid, fmt::format("there is no composite at {}", cellText(cell)));
   std::string name;
   if (edit.ok() && found) {
      const auto &lattice = before->lattice();
      const auto placement = found->path.front();
      const auto *definition = edit.model().definition(placement.definition);
      name = definition->id;
      auto &root = edit.model().root;
      root.instances.erase(placement);
      definition->body.cells.visit([&](Index local, Cell content) {
         const Index world = lattice.place(placement.origin, placement.rotation, local);
         content.joins = turnedJoins(lattice, placement, local, content, world);
         content.orientation = static_cast<std::uint8_t>(
             lattice.turnedOrientation(local, placement.rotation, content.orientation));
         root.cells.set(world, content);
         return !edit.job().cancelled();
      });
      definition->body.instances.visit([&](const Placement &nested) {
         root.instances.insert(
             {nested.definition, lattice.place(placement.origin, placement.rotation, nested.origin),
              static_cast<std::uint8_t>(lattice.compose(placement.rotation, nested.rotation))});
         return true;
      });
   }
   return edit.commit(fmt::format("dissolve {}", name));
}

Result<std::string> removeComposite(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "remove-composite", arguments);
   const auto id = edit.arguments().at("definition").text();
   const auto number = edit.model().definition(id);
   if (edit.ok() && number == 0)
      edit.fail(ErrorCode::usage, fmt::format("there is no composite \"{}\"", id));
   if (edit.ok())
      if (const auto erased = edit.model().eraseDefinition(number); !erased)
         edit.fail(erased.error().code, erased.error().message);
   return edit.commit(fmt::format("remove {}", id));
}

constexpr CommandParameter kDefine[] = {
    {"id", "text", true, "id of the new composite"},
    {"box", "box", true, "two opposite corners of what to group"},
    {"name", "text", false, "name for people"},
    {"color", "text", false, "like #cda4f3"},
};
constexpr CommandParameter kPlaceComposite[] = {
    {"definition", "text", true, "id of the composite"},
    {"cell", "index", true, "where its own cell [0, 0, 0] goes"},
    {"rotation", "number", false, "rotation number of the lattice"},
};
constexpr CommandParameter kAtCell[] = {{"cell", "index", true, "any of its cells"}};
constexpr CommandParameter kDefinition[] = {{"definition", "text", true, "id of the composite"}};

constexpr Command kCompositeTable[] = {
    {"define-composite", "Group into composite",
     "Makes a composite of what is in a box and puts an instance there.", kDefine, defineComposite},
    {"place-composite", "Place composite", "Puts an instance of a composite where nothing is.",
     kPlaceComposite, placeComposite},
    {"dissolve", "Dissolve composite", "Replaces an instance by its content, one level deep.", kAtCell,
     dissolve},
    {"remove-composite", "Remove composite", "Forgets a definition that is used nowhere.", kDefinition,
     removeComposite},
};

} // namespace

const std::span<const Command> kCompositeCommands = kCompositeTable;

} // namespace diatom
