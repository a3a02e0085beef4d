#include "document/commands.h"

#include "document/command_edit.h"

#include <algorithm>
#include <string>

namespace diatom {

namespace {

std::vector<Command> allCommands()
{
   std::vector<Command> all;
   for (const auto part : {kCellCommands, kRegionCommands, kCompositeCommands, kMaterialCommands,
                           kBoundaryCommands, kSetupCommands, kReferenceCommands})
      all.insert(all.end(), part.begin(), part.end());
   return all;
}

} // namespace

std::span<const Command> commands()
{
   static const auto all = allCommands();
   return all;
}

const Command *findCommand(std::string_view id)
{
   const auto all = commands();
   const auto found =
       std::find_if(all.begin(), all.end(), [id](const Command &command) { return id == command.id; });
   return found == all.end() ? nullptr : &*found;
}

} // namespace diatom
