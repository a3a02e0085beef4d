#include "document/document.h"

#include "cells/turns.h"
#include "document/json_text.h"

#include <fmt/format.h>

namespace diatom {

Document::Document(std::shared_ptr<const Catalogue> catalogue, Design design)
    : m_catalogue(std::move(catalogue))
{
   m_history.push_back({std::move(design), {}, {}});
}

Result<std::shared_ptr<const Hierarchy>> Document::hierarchy() const
{
   if (m_hierarchyOf == m_now)
      return m_hierarchy;
   const auto &model = design().model;
   std::shared_ptr<const Lattice> lattice;
   if (m_hierarchy && m_hierarchy->model().lattice == model.lattice) {
      lattice = std::shared_ptr<const Lattice>(m_hierarchy, &m_hierarchy->lattice());
   } else {
      auto made = Lattice::make(*m_catalogue, model.lattice, Job());
      if (!made)
         return made.error();
      if (const Status fits = checkTurns(model, **made); !fits)
         return fits.error();
      lattice = *made;
   }
   m_hierarchy = std::make_shared<const Hierarchy>(std::move(lattice), model, m_hierarchy.get());
   m_hierarchyOf = m_now;
   return m_hierarchy;
}

Status Document::run(std::string_view command, const nlohmann::json &arguments, const Job &job)
{
   const auto *entry = findCommand(command);
   if (!entry)
      return Error{ErrorCode::usage,
                   fmt::format("there is no command \"{}\"; `diatom commands` lists them", command)};
   Design next = design();
   const auto view = hierarchy(); // commands that need no lattice work without one
   CommandContext context{next, m_catalogue, job, view ? *view : nullptr};
   auto text = entry->apply(context, arguments);
   if (!text)
      return text.error();
   nlohmann::ordered_json line = {{"command", entry->id}, {"arguments", arguments}};
   m_history.resize(m_now + 1);
   m_history.push_back({std::move(next), std::move(text.value()), jsonLine(line)});
   if (m_saved > m_now)
      m_saved = kNoStep; // what was saved can no longer be reached
   ++m_now;
   if (m_hierarchyOf >= m_now)
      m_hierarchyOf = kNoStep;
   return {};
}

std::string Document::undoText() const { return canUndo() ? m_history[m_now].text : std::string(); }

std::string Document::redoText() const { return canRedo() ? m_history[m_now + 1].text : std::string(); }

bool Document::undo()
{
   if (!canUndo())
      return false;
   --m_now;
   return true;
}

bool Document::redo()
{
   if (!canRedo())
      return false;
   ++m_now;
   return true;
}

std::string Document::log() const
{
   std::string text;
   for (std::size_t step = 1; step <= m_now; ++step)
      text += m_history[step].logLine + '\n';
   return text;
}

Status Document::replay(std::string_view log, const Job &job)
{
   int number = 0;
   while (!log.empty()) {
      const auto end = std::min(log.find('\n'), log.size());
      const auto line = log.substr(0, end);
      log.remove_prefix(std::min(end + 1, log.size()));
      ++number;
      const auto start = line.find_first_not_of(" \t\r");
      if (start == std::string_view::npos || line[start] == '#')
         continue;
      const auto where = fmt::format("line {} of the log", number);
      auto entry = parseJson(line, where);
      if (!entry)
         return entry.error();
      if (!entry->is_object() || !entry->contains("command") || !(*entry)["command"].is_string())
         return Error{
             ErrorCode::unreadable,
             fmt::format("{}: it must be an object with \"command\" and \"arguments\"; correct it", where)};
      const auto arguments = entry->value("arguments", nlohmann::json::object());
      if (const auto done = run((*entry)["command"].get<std::string>(), arguments, job); !done)
         return Error{done.error().code, fmt::format("{}: {}", where, done.error().message)};
      if (job.cancelled())
         return Error{ErrorCode::cancelled, fmt::format("{}: replaying was cancelled", where)};
   }
   return {};
}

} // namespace diatom
