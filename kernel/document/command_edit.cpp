#include "document/command_edit.h"

#include "scene/where.h"

#include <fmt/format.h>

#include <algorithm>

namespace diatom {

Edit::Edit(CommandContext &context, const char *command, const nlohmann::json &arguments)
    : m_context(context), m_design(context.design), m_log{command, {}, nlohmann::json::object()},
      m_json(arguments.is_null() ? nlohmann::json::object() : arguments), m_arguments(m_json, m_log)
{
   m_arguments.object();
   if (const auto *entry = findCommand(command); entry && m_json.is_object())
      for (const auto &[key, value] : m_json.items()) {
         const auto known = [&name = key](const CommandParameter &p) { return name == p.name; };
         if (std::none_of(entry->parameters.begin(), entry->parameters.end(), known))
            fail(ErrorCode::usage,
                 fmt::format("it has no argument \"{}\"; `diatom commands` lists them", key));
      }
}

void Edit::fail(ErrorCode code, std::string message)
{
   if (!m_log.error)
      m_log.error = Error{code, fmt::format("{}: {}", m_log.name, message)};
}

const Hierarchy *Edit::hierarchy()
{
   if (m_before)
      return m_before.get();
   if (m_context.hierarchy) {
      m_before = m_context.hierarchy;
      return m_before.get();
   }
   auto lattice = Lattice::make(*m_context.catalogue, m_context.design.model.lattice, m_context.job);
   if (!lattice) {
      fail(lattice.error().code, lattice.error().message);
      return nullptr;
   }
   m_before = std::make_shared<const Hierarchy>(*lattice, m_context.design.model);
   return m_before.get();
}

std::shared_ptr<const Hierarchy> Edit::now()
{
   const auto *before = hierarchy();
   if (!before)
      return nullptr;
   return std::make_shared<const Hierarchy>(std::shared_ptr<const Lattice>(m_before, &before->lattice()),
                                            m_design.model, before);
}

MaterialIndex Edit::material(std::string_view key)
{
   const auto place = m_arguments.at(key);
   const auto id = place.text();
   const auto number = m_design.model.material(id);
   if (ok() && (number == 0 || id.empty()))
      fail(ErrorCode::usage, fmt::format("there is no material \"{}\"; add it with set-material", id));
   return number;
}

Box Edit::box(std::string_view key)
{
   const auto place = m_arguments.at(key);
   if (!place.json().is_array() || place.json().size() != 2) {
      place.mustBe("two corners [[x, y, z], [x, y, z]]");
      return {};
   }
   Box box;
   box.extend(place.at(0).index());
   box.extend(place.at(1).index());
   return box;
}

std::vector<Index> Edit::cells()
{
   std::vector<Index> cells;
   if (m_arguments.has("cells")) {
      const auto list = m_arguments.at("cells");
      std::set<Index> seen;
      for (std::size_t i = 0; i < list.size() && ok(); ++i)
         if (const Index cell = list.at(i).index(); seen.insert(cell).second)
            cells.push_back(cell);
      if (cells.empty())
         list.mustBe("a list of at least one index [x, y, z]");
   } else {
      cells.push_back(m_arguments.at("cell").index());
   }
   return cells;
}

std::uint8_t Edit::orientation(Index cell)
{
   if (!m_arguments.has("orientation") || !hierarchy())
      return 0;
   const auto &lattice = hierarchy()->lattice();
   const auto rotations = static_cast<std::int64_t>(lattice.shape(lattice.site(cell)).rotations.size());
   return static_cast<std::uint8_t>(m_arguments.at("orientation").integer(0, rotations - 1));
}

void Edit::pruneSetup()
{
   auto &setup = m_design.setup;
   if (!ok() || (setup.supports.empty() && setup.drives.empty() && setup.loads.empty() &&
                 setup.starts.empty() && setup.fields.empty() && setup.sources.empty()))
      return;
   const auto after = now();
   if (!after)
      return;
   const auto gone = [&after](const auto &item) { return !anyCell(*after, item.where); };
   std::erase_if(setup.supports, gone);
   std::erase_if(setup.drives, gone);
   std::erase_if(setup.loads, gone);
   std::erase_if(setup.starts, gone);
   std::erase_if(setup.fields, gone);
   std::erase_if(setup.sources, [&after](const Source &source) { return after->at(source.cell).empty(); });
}

Result<std::string> Edit::commit(std::string text)
{
   if (ok() && m_context.job.cancelled())
      fail(ErrorCode::cancelled, "cancelled; nothing has changed");
   if (!ok()) {
      // Faults of arguments are faults of the call.
      const auto code = m_log.error->code == ErrorCode::unreadable ? ErrorCode::usage : m_log.error->code;
      return Error{code, m_log.error->message};
   }
   m_context.design = std::move(m_design);
   return text;
}

std::string cellText(Index i) { return fmt::format("[{}, {}, {}]", i.x, i.y, i.z); }

std::string sizeText(const Box &box)
{
   return fmt::format("{}x{}x{}", box.max.x - box.min.x + 1, box.max.y - box.min.y + 1,
                      box.max.z - box.min.z + 1);
}

std::string countText(const char *what, std::size_t cells)
{
   return cells == 1 ? std::string(what) : fmt::format("{} {} cells", what, cells);
}

} // namespace diatom
