// The one table of editing commands. Menus, keys, undo texts, the command line, scripts and the log all use
// it.
#pragma once

#include "cells/hierarchy.h"
#include "core/job.h"
#include "core/result.h"
#include "document/design.h"
#include "plugins/catalogue.h"

#include <nlohmann/json.hpp>

#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace diatom {

/// A parameter of a command: name, kind ("index", "box", "material", "number", "text", "cells", ...), whether
/// it must be given, and one line of help.
struct CommandParameter
{
   const char *name, *kind;
   bool required;
   const char *help;
};

/// What a command sees: the design to change and the lattice it lives on.
struct CommandContext
{
   Design &design;
   std::shared_ptr<const Catalogue> catalogue;
   const Job &job;
   /// Of the design as it is before the command; null = the command makes its own when it needs one.
   std::shared_ptr<const Hierarchy> hierarchy = nullptr;
};

/// One editing command.
struct Command
{
   const char *id;   // "place", "fill", "erase", ...
   const char *text; // for menus: "Place cell"
   const char *help; // one sentence
   std::span<const CommandParameter> parameters;
   /// Changes the design or leaves it as it was and fails. The result is the undo text: "place", "fill
   /// 3x3x3".
   Result<std::string> (*apply)(CommandContext &context, const nlohmann::json &arguments);
};

/// All commands, in menu order.
std::span<const Command> commands();
/// Null when unknown.
const Command *findCommand(std::string_view id);

} // namespace diatom
