// diatom plugin new: a project for a plugin of one's own, from the templates that come with the SDK.
#include "cli/commands.h"
#include "core/file.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <memory>

namespace diatom::cli {

namespace {

namespace fs = std::filesystem;

struct NewPlugin
{
   std::string kind, name, folder = ".", language = "c++", id;
};

/// Beside the program, installed or in a source tree (build/<preset>/bin).
Result<fs::path> templateFolder(const std::string &name)
{
   std::error_code error;
   const fs::path bin = fs::read_symlink("/proc/self/exe", error).parent_path();
   for (const char *place : {"../share/diatom/templates", "../../../plugins/sdk/templates"})
      if (const fs::path found = bin / place / name; fs::is_directory(found, error))
         return found;
   return Error{ErrorCode::unsupported, "the templates for plugins are not installed; install the SDK "
                                        "(diatom-sdk), or run cmake --install with "
                                        "--component sdk"};
}

/// "" or the rest of a sentence. The name is a folder, a CMake target and the last word of an id.
std::string nameFault(const std::string &name)
{
   constexpr std::size_t kLongest = 64;
   constexpr std::array<const char *, 9> kTargets{
       "all",     "clean", "depend", "edit_cache", "help", "install", "list_install_components",
       "package", "test"};
   const auto plain = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
   };
   if (name.size() > kLongest || !std::all_of(name.begin(), name.end(), plain) || name[0] < 'a' ||
       name[0] > 'z' || name.back() == '-' || name.back() == '_')
      return fmt::format(
          "must be a lower-case letter and then up to {} of a-z, 0-9, - and _, like my-lattice",
          kLongest - 1);
   if (std::find(kTargets.begin(), kTargets.end(), name) != kTargets.end())
      return "means something to CMake already; choose another";
   return {};
}

std::string idFault(const std::string &id)
{
   const auto plain = [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '_' || c == '-';
   };
   const bool sound = std::all_of(id.begin(), id.end(), plain) && id.find('.') != std::string::npos &&
                      id.front() != '.' && id.back() != '.' && id.find("..") == std::string::npos &&
                      id.size() <= 200;
   return sound
              ? ""
              : "must be words of letters, digits, - and _ with dots between, like org.example.lattice.mine";
}

/// "my-lattice" as people write it: "My lattice".
std::string titleOf(std::string name)
{
   std::replace_if(
       name.begin(), name.end(), [](char c) { return c == '-' || c == '_'; }, ' ');
   name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
   return name;
}

using Words = std::array<std::pair<std::string, std::string>, 3>;

std::string filled(std::string text, const Words &words)
{
   for (const auto &[word, value] : words)
      for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos; at += value.size())
         text.replace(at, word.size(), value);
   return text;
}

/// Every file of the template with its words filled in; a file called NAME is called by the plugin's.
Result<std::vector<std::string>> writeProject(const fs::path &from, const fs::path &to,
                                              const std::string &name, const Words &words)
{
   std::vector<fs::path> files;
   std::error_code error;
   for (fs::recursive_directory_iterator entry(from, error), end; !error && entry != end;
        entry.increment(error))
      if (entry->is_regular_file(error))
         files.push_back(entry->path());
   std::sort(files.begin(), files.end());
   std::vector<std::string> written;
   for (const fs::path &file : files) {
      const auto text = readFile(file);
      if (!text)
         return text.error();
      fs::path relative = file.lexically_relative(from);
      if (relative.stem() == "NAME")
         relative.replace_filename(name + relative.extension().string());
      if (const Status made = makeFolder((to / relative).parent_path()); !made)
         return made.error();
      if (const Status done = writeFileAtomic(to / relative, filled(*text, words)); !done)
         return done.error();
      written.push_back(relative.string());
   }
   return written;
}

void makeProject(const NewPlugin &wanted, Context &context)
{
   if (const std::string fault = nameFault(wanted.name); !fault.empty())
      return context.fail({ErrorCode::usage, fmt::format("the name \"{}\" {}", wanted.name, fault)});
   if (wanted.language == "c" && wanted.kind != "lattice")
      return context.fail(
          {ErrorCode::usage, fmt::format("there is no template in C for {}, only for a lattice; leave "
                                         "--language out",
                                         wanted.kind)});
   const std::string id =
       wanted.id.empty() ? fmt::format("org.example.{}.{}", wanted.kind, wanted.name) : wanted.id;
   if (const std::string fault = idFault(id); !fault.empty())
      return context.fail({ErrorCode::usage, fmt::format("the id \"{}\" {}", id, fault)});
   const fs::path folder = fs::path(wanted.folder) / wanted.name;
   std::error_code ignored;
   if (fs::exists(fs::symlink_status(folder, ignored)))
      return context.fail({ErrorCode::unwritable,
                           fmt::format("{} is there already; choose another name, or another place with "
                                       "--dir",
                                       folder.lexically_normal().string())});
   const auto from = templateFolder(wanted.kind + (wanted.language == "c" ? "-c" : ""));
   if (!from)
      return context.fail(from.error());
   const auto files =
       writeProject(*from, folder, wanted.name,
                    {{{"@NAME@", wanted.name}, {"@ID@", id}, {"@TITLE@", titleOf(wanted.name)}}});
   if (!files)
      return context.fail(files.error());
   const std::string shown = folder.lexically_normal().string();
   context.print({{"id", id}, {"folder", shown}, {"files", *files}});
   context.note(
       fmt::format("Next:\n  cd {}\n  cmake -B build && cmake --build build\n  ctest --test-dir build\n"
                   "  cmake --install build     into your plugin folder\n"
                   "  diatom plugins trust {}   lets it run; diatom plugins lists it\n"
                   "README.md says more, and plugin.json has the id, which you may want to change first.",
                   shown, id));
}

} // namespace

void addPlugin(CLI::App &app, Context &context)
{
   CLI::App *command = app.add_subcommand("plugin", "Make plugins of your own");
   command->require_subcommand(1);
   const auto wanted = std::make_shared<NewPlugin>();
   CLI::App *make = command->add_subcommand("new", "Write a complete project for a plugin, with tests");
   make->add_option("KIND", wanted->kind, "What it provides: lattice, parts, machine or solver")
       ->required()
       ->check(CLI::IsMember({"lattice", "parts", "machine", "solver"}));
   make->add_option("NAME", wanted->name, "Its name, like my-lattice: the project's folder is called by it")
       ->required();
   make->add_option("--dir", wanted->folder, "Folder to make the project's folder in (default: here)");
   make->add_option("--language", wanted->language, "c++, or c for a lattice in C alone")
       ->check(CLI::IsMember({"c++", "c"}));
   make->add_option("--id", wanted->id, "Its id, reverse domain (default: org.example.KIND.NAME)");
   make->footer("Example:\n  diatom plugin new lattice my-lattice --id com.mydomain.lattice.mine");
   make->callback([wanted, &context] { makeProject(*wanted, context); });
}

} // namespace diatom::cli
