// diatom do, commands, replay: the editing commands of the studio, from the command line.
#include "cli/commands.h"

#include "core/file.h"
#include "core/text.h"
#include "document/document.h"
#include "document/json_text.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace diatom::cli {

namespace {

struct EditOptions
{
   std::string file, command, log, out;
   std::vector<std::string> arguments;
};

/// "1,2,3" as [1, 2, 3]; null when it is not numbers.
nlohmann::json numberList(std::string_view text)
{
   auto list = nlohmann::json::array();
   while (true) {
      const auto comma = std::min(text.find(','), text.size());
      const auto number = parseNumber(text.substr(0, comma));
      if (!number)
         return nullptr;
      list.push_back(*number);
      if (comma == text.size())
         return list;
      text.remove_prefix(comma + 1);
   }
}

/// A value as it is easiest to type: "1,2,3" for an index, "0,0,0:2,2,2" for a box, else JSON, else text.
nlohmann::json argumentValue(const std::string &text)
{
   if (const auto colon = text.find(':'); colon != std::string::npos) {
      auto low = numberList(std::string_view(text).substr(0, colon)),
           high = numberList(std::string_view(text).substr(colon + 1));
      if (!low.is_null() && !high.is_null())
         return nlohmann::json::array({std::move(low), std::move(high)});
   }
   if (text.find(',') != std::string::npos)
      if (auto list = numberList(text); !list.is_null())
         return list;
   const bool json = !text.empty() && (text[0] == '[' || text[0] == '{' || text == "true" ||
                                       text == "false" || parseNumber(text));
   if (json)
      if (auto value = parseJson(text, "argument"))
         return std::move(*value);
   return text;
}

Result<nlohmann::json> argumentsOf(const std::vector<std::string> &words)
{
   auto arguments = nlohmann::json::object();
   for (const auto &word : words) {
      if (word.starts_with('{')) {
         auto value = parseJson(word, "arguments");
         if (!value)
            return Error{ErrorCode::usage, value.error().message};
         arguments.update(*value);
         continue;
      }
      const auto equals = word.find('=');
      if (equals == 0 || equals == std::string::npos)
         return Error{ErrorCode::usage,
                      fmt::format("\"{}\": arguments are name=value or a JSON object", word)};
      arguments[word.substr(0, equals)] = argumentValue(word.substr(equals + 1));
   }
   return arguments;
}

/// The document to edit; "new" starts an empty one.
std::unique_ptr<Document> openDocument(Context &context, const std::string &file)
{
   Design design;
   if (file != "new") {
      auto opened = openDesign(file, context.job());
      if (!opened) {
         context.fail(opened.error());
         return nullptr;
      }
      for (const auto &text : opened->notes)
         context.note(text);
      design = std::move(opened->design);
   }
   return std::make_unique<Document>(context.catalogue(), std::move(design));
}

void save(Context &context, const Document &document, const std::string &out)
{
   if (const auto saved = saveDesign(document.design(), out, context.job()); !saved)
      context.fail(saved.error());
   else if (out != "-")
      context.print({{"hash", document.design().hash().text()}, {"file", out}});
}

void runCommand(Context &context, const EditOptions &options)
{
   const auto arguments = argumentsOf(options.arguments);
   if (!arguments) {
      context.fail(arguments.error());
      return;
   }
   const auto document = openDocument(context, options.file);
   if (!document)
      return;
   if (const auto done = document->run(options.command, *arguments, context.job()); !done)
      context.fail(done.error());
   else
      save(context, *document, options.out);
}

void replay(Context &context, const EditOptions &options)
{
   const auto log = readFile(options.log);
   if (!log) {
      context.fail(log.error());
      return;
   }
   const auto document = openDocument(context, options.file);
   if (!document)
      return;
   if (const auto done = document->replay(*log, context.job()); !done)
      context.fail({done.error().code, fmt::format("{}: {}", options.log, done.error().message)});
   else
      save(context, *document, options.out);
}

void listCommands(Context &context)
{
   auto rows = nlohmann::ordered_json::array();
   for (const Command &command : commands()) {
      std::string parameters;
      for (const auto &p : command.parameters)
         parameters += fmt::format("{}{}{}", parameters.empty() ? "" : " ", p.name, p.required ? "" : "?");
      nlohmann::ordered_json row = {
          {"command", command.id}, {"arguments", parameters}, {"does", command.help}};
      if (context.json) {
         row["text"] = command.text;
         row["parameters"] = nlohmann::ordered_json::array();
         for (const auto &p : command.parameters)
            row["parameters"].push_back(
                {{"name", p.name}, {"kind", p.kind}, {"required", p.required}, {"help", p.help}});
      }
      rows.push_back(std::move(row));
   }
   context.printTable(rows);
}

constexpr const char *kFileHelp = "the design to change, or `new` for an empty one";

} // namespace

void addDo(CLI::App &app, Context &context)
{
   const auto options = std::make_shared<EditOptions>();
   auto *single = app.add_subcommand("do", "Run one editing command on a design");
   single->add_option("FILE", options->file, kFileHelp)->required();
   single->add_option("COMMAND", options->command, "one that `diatom commands` lists")->required();
   single->add_option("ARGUMENTS", options->arguments,
                      "name=value (1,2,3 an index, 0,0,0:2,2,2 a box) or a JSON object");
   single->add_option("-o,--output", options->out, "the .diatom document to write")->required();
   single->callback([&context, options] { runCommand(context, *options); });

   auto *log = app.add_subcommand("replay", "Run a log of editing commands on a design");
   log->add_option("FILE", options->file, kFileHelp)->required();
   log->add_option("LOG", options->log, "one {\"command\", \"arguments\"} a line; lines with # are remarks")
       ->required();
   log->add_option("-o,--output", options->out, "the .diatom document to write")->required();
   log->callback([&context, options] { replay(context, *options); });

   app.add_subcommand("commands", "List the editing commands")->callback([&context] {
      listCommands(context);
   });
}

} // namespace diatom::cli
