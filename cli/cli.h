// What the commands of the command line share: catalogue, opening files, progress, output, exit codes.
#pragma once

#include "cells/hierarchy.h"
#include "core/job.h"
#include "formats/files.h"
#include "plugins/catalogue.h"

#include <nlohmann/json.hpp>

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace diatom::cli {

/// Exit codes of desktop.md section 2.
enum Exit {
   kDone = 0,
   kFailed = 1,
   kUsage = 2,
   kUnreadable = 3,
   kUnwritable = 4,
   kCheckFailed = 5,
   kUnstable = 6,
   kTimeLimit = 7,
   kInterrupted = 130
};

/// Options every command has, and the services it uses. One per process.
class Context
{
public:
   Context();

   bool json = false;
   int threads = 0;
   std::string progress = "auto";          // auto, line, json, none
   std::vector<std::string> pluginFolders; // searched before the default ones
   bool isolate = false;                   // solvers run in a process of their own

   /// Reports on stderr as `progress` says; cancelled by Ctrl+C (a second one kills).
   Job &job() { return *m_job; }
   std::shared_ptr<const Catalogue> catalogue();
   /// Where catalogue() looks: --plugins, then the default folders.
   std::vector<PluginFolder> searchFolders() const;

   /// A file with its notes told. On failure prints the error and sets `exit`.
   std::optional<Opened> read(const std::string &file);
   /// A file opened with its lattice and hierarchy. On failure prints the error and sets `exit`.
   struct Input
   {
      Opened opened;
      std::shared_ptr<const Lattice> lattice;
      std::shared_ptr<const Hierarchy> hierarchy;
   };
   std::unique_ptr<Input> open(const std::string &file);
   /// The lattice and hierarchy of a design; null after printing the error and setting `exit`.
   std::unique_ptr<Input> prepare(Opened opened);

   /// Prints the error on stderr and sets `exit` by its code.
   void fail(const Error &error);
   /// Words for people, on stderr.
   void note(std::string_view text) const;
   /// Data, on stdout: the object with --json, else "key: value" lines.
   void print(const nlohmann::ordered_json &object) const;
   /// A list of objects: an array with --json, else aligned columns with a heading.
   void printTable(const nlohmann::ordered_json &rows) const;

   int exit = kDone;

private:
   std::unique_ptr<Job> m_job;
   std::shared_ptr<const Catalogue> m_catalogue;
};

int exitCode(ErrorCode code);

/// Each adds one sub-command to the application; it runs as the sub-command's callback and sets context.exit.
using AddCommand = void (*)(CLI::App &app, Context &context);

/// The full id of an installed thing given in full or by its last word ("gcode"); as given when there is no
/// or more than one such thing, so that the catalogue says what there is.
std::string fullId(const Catalogue &catalogue, const char *interface, const std::string &given);

/// Splits "name=value" options into plugin values; numbers where they read as numbers. Null on a missing '='.
Result<Values> parseValues(const std::vector<std::string> &options);

} // namespace diatom::cli
