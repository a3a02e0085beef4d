// A document being edited: the design, its undo history by value, and the log of commands that made it.
#pragma once

#include "core/job.h"
#include "core/result.h"
#include "document/commands.h"
#include "document/design.h"
#include "plugins/catalogue.h"

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace diatom {

/// One thread. Snapshots (design()) are values and may go anywhere.
class Document
{
public:
   Document(std::shared_ptr<const Catalogue> catalogue, Design design);

   const Design &design() const { return m_history[m_now].design; }
   const std::shared_ptr<const Catalogue> &catalogue() const { return m_catalogue; }
   /// Current lattice and hierarchy; made anew after each change, sharing what did not change. Errors when
   /// the lattice is not installed.
   Result<std::shared_ptr<const Hierarchy>> hierarchy() const;

   /// Runs a command of the table. On failure nothing has changed.
   Status run(std::string_view command, const nlohmann::json &arguments, const Job &job);

   bool canUndo() const { return m_now > 0; }
   bool canRedo() const { return m_now + 1 < m_history.size(); }
   std::string undoText() const; // "fill 3x3x3", "" when there is none
   std::string redoText() const;
   bool undo();
   bool redo();

   /// One JSON object per line, {"command": ..., "arguments": {...}}: the commands that led from the opened
   /// design to the current one, undone ones left out.
   std::string log() const;
   /// Runs a log. Errors name the line.
   Status replay(std::string_view log, const Job &job);

   bool modified() const { return m_saved != m_now; }
   void markSaved() { m_saved = m_now; }

private:
   struct Step
   {
      Design design;
      std::string text, logLine;
   };
   std::shared_ptr<const Catalogue> m_catalogue;
   std::vector<Step> m_history;
   std::size_t m_now = 0, m_saved = 0;
   mutable std::shared_ptr<const Hierarchy> m_hierarchy; // of step m_hierarchyOf, or of one that is gone
   mutable std::size_t m_hierarchyOf = kNoStep;
   static constexpr std::size_t kNoStep = static_cast<std::size_t>(-1);
};

} // namespace diatom
