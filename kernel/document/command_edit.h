// What the commands share: reading arguments, the lattice and hierarchy to edit on, and leaving nothing half
// done.
#pragma once

#include "document/commands.h"
#include "document/format.h"

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace diatom {

/// One run of a command. Edits a copy of the design; commit() puts it in place.
class Edit
{
public:
   Edit(CommandContext &context, const char *command, const nlohmann::json &arguments);

   /// The arguments, as a place whose faults name command and argument.
   const JsonPlace &arguments() const { return m_arguments; }
   bool ok() const { return m_log.ok(); }
   void fail(ErrorCode code, std::string message);

   Design &design() { return m_design; }
   Model &model() { return m_design.model; }
   const Job &job() const { return m_context.job; }
   const Catalogue &catalogue() const { return *m_context.catalogue; }
   /// Of the design before the edit. Null after a fault (the lattice is not installed).
   const Hierarchy *hierarchy();
   /// Of the design as edited so far.
   std::shared_ptr<const Hierarchy> now();

   /// Argument "material": a known one, or a fault.
   MaterialIndex material(std::string_view key);
   /// Argument "box" or of another name: [[x, y, z], [x, y, z]], both corners inside.
   Box box(std::string_view key = "box");
   /// Arguments "cell" or "cells".
   std::vector<Index> cells();
   /// Argument "orientation", a rotation number of the cell's shape.
   std::uint8_t orientation(Index cell);

   /// Removes supports, drives, loads, starts, fields and sources whose cells are gone.
   void pruneSetup();

   /// The result of apply(): the first fault, else puts the design in place and returns the undo text.
   Result<std::string> commit(std::string text);

private:
   CommandContext &m_context;
   Design m_design;
   ReadLog m_log;
   nlohmann::json m_json;
   JsonPlace m_arguments;
   std::shared_ptr<const Hierarchy> m_before;
};

std::string cellText(Index i);                              // "[1, 2, 3]"
std::string sizeText(const Box &box);                       // "3x3x3"
std::string countText(const char *what, std::size_t cells); // "place" for one, "place 5 cells"

// The commands, by subject.
extern const std::span<const Command> kCellCommands, kRegionCommands, kCompositeCommands, kMaterialCommands,
    kBoundaryCommands, kSetupCommands, kReferenceCommands;

} // namespace diatom
