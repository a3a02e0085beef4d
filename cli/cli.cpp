#include "cli/cli.h"

#include "cells/turns.h"
#include "core/text.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>

namespace diatom::cli {

namespace {

/// The job Ctrl+C cancels. A signal handler can reach nothing but a global; set once, before the handler is
/// installed.
Job *interruptible = nullptr;

void onInterrupt(int signal)
{
   interruptible->cancel();
   std::signal(signal, SIG_DFL); // the second one kills
}

double secondsNow()
{
   return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Draws progress on stderr: one redrawn line on a terminal, else a line every five seconds, or JSON lines.
class ProgressPrinter
{
public:
   explicit ProgressPrinter(const std::string &mode) : m_mode(mode) {}
   ~ProgressPrinter() { clear(); }

   void show(double fraction, std::string_view what)
   {
      const bool redraw = m_mode == "auto" && ::isatty(STDERR_FILENO) != 0;
      const double now = secondsNow();
      if (m_mode == "none" || now - m_last < (redraw ? 0.1 : m_mode == "json" ? 0.5 : 5.0))
         return;
      m_last = now;
      const double percent = 100 * std::clamp(fraction, 0.0, 1.0);
      if (m_mode == "json")
         fmt::print(stderr, "{}\n", nlohmann::json{{"progress", fraction}, {"what", what}}.dump());
      else if (redraw)
         fmt::print(stderr, "\r\033[K{} {:.0f} %", what, percent);
      else
         fmt::print(stderr, "{} {:.0f} %\n", what, percent);
      m_drawn = redraw;
   }

   void clear()
   {
      if (m_drawn)
         fmt::print(stderr, "\r\033[K");
      m_drawn = false;
   }

private:
   const std::string &m_mode;
   double m_last = secondsNow(); // nothing is shown for what takes less than the first interval
   bool m_drawn = false;
};

std::string scalarText(const nlohmann::ordered_json &value)
{
   if (value.is_string())
      return value.get<std::string>();
   if (value.is_number_float())
      return numberText(value.get<double>());
   return value.dump();
}

/// "key: value" lines; nested objects get dotted keys, lists of objects are numbered.
void printLines(const nlohmann::ordered_json &value, const std::string &prefix)
{
   if (value.is_object()) {
      for (const auto &[key, member] : value.items())
         printLines(member, prefix.empty() ? key : fmt::format("{}.{}", prefix, key));
      return;
   }
   if (value.is_array() && !value.empty() && value.front().is_object()) {
      for (std::size_t i = 0; i < value.size(); ++i)
         printLines(value[i], fmt::format("{}.{}", prefix, i));
      return;
   }
   fmt::print("{}: {}\n", prefix, scalarText(value));
}

} // namespace

int exitCode(ErrorCode code)
{
   switch (code) {
   case ErrorCode::usage:
      return kUsage;
   case ErrorCode::unreadable:
      return kUnreadable;
   case ErrorCode::unwritable:
      return kUnwritable;
   case ErrorCode::cancelled:
      return kInterrupted;
   case ErrorCode::unstable:
      return kUnstable;
   case ErrorCode::timeLimit:
      return kTimeLimit;
   case ErrorCode::invalid:
   case ErrorCode::unsupported:
   case ErrorCode::internal:
      return kFailed;
   }
   return kFailed;
}

Context::Context()
{
   auto printer = std::make_shared<ProgressPrinter>(progress);
   m_job = std::make_unique<Job>(
       [printer](double fraction, std::string_view what) { printer->show(fraction, what); });
   interruptible = m_job.get();
   std::signal(SIGINT, onInterrupt);
   std::signal(SIGPIPE, SIG_IGN); // a closed pipe is a write error, told in a sentence
}

std::shared_ptr<const Catalogue> Context::catalogue()
{
   m_job->setThreads(threads);
   if (!m_catalogue)
      m_catalogue = Catalogue::find(searchFolders(), false, isolate ? Isolate::all : Isolate::outside);
   return m_catalogue;
}

std::vector<PluginFolder> Context::searchFolders() const
{
   std::vector<PluginFolder> folders(pluginFolders.begin(), pluginFolders.end());
   for (auto &folder : defaultPluginFolders())
      folders.push_back(std::move(folder));
   return folders;
}

std::optional<Opened> Context::read(const std::string &file)
{
   auto opened = openDesign(file, *m_job);
   if (!opened) {
      fail(opened.error());
      return std::nullopt;
   }
   for (const std::string &text : opened->notes)
      note(text);
   return *std::move(opened);
}

std::unique_ptr<Context::Input> Context::open(const std::string &file)
{
   auto opened = read(file);
   return opened ? prepare(*std::move(opened)) : nullptr;
}

std::unique_ptr<Context::Input> Context::prepare(Opened opened)
{
   auto lattice = Lattice::make(*catalogue(), opened.design.model.lattice, *m_job);
   if (!lattice) {
      fail(lattice.error());
      return nullptr;
   }
   if (const Status fits = checkTurns(opened.design.model, **lattice); !fits) {
      fail(fits.error());
      return nullptr;
   }
   auto input = std::make_unique<Input>();
   input->lattice = *lattice;
   input->hierarchy = std::make_shared<const Hierarchy>(*lattice, opened.design.model);
   input->opened = std::move(opened);
   return input;
}

void Context::fail(const Error &error)
{
   exit = exitCode(error.code);
   fmt::print(stderr, "diatom: {}\n", error.message);
}

void Context::note(std::string_view text) const { fmt::print(stderr, "{}\n", text); }

void Context::print(const nlohmann::ordered_json &object) const
{
   if (json)
      fmt::print("{}\n", object.dump(2));
   else
      printLines(object, "");
}

void Context::printTable(const nlohmann::ordered_json &rows) const
{
   if (json) {
      fmt::print("{}\n", rows.dump(2));
      return;
   }
   if (rows.empty())
      return;
   std::vector<std::string> heading; // rows may have columns of their own
   for (const auto &row : rows)
      for (const auto &[key, member] : row.items())
         if (std::find(heading.begin(), heading.end(), key) == heading.end())
            heading.push_back(key);
   std::vector<std::vector<std::string>> lines{heading};
   lines.reserve(rows.size() + 1);
   for (const auto &row : rows) {
      std::vector<std::string> line;
      line.reserve(heading.size());
      for (const std::string &key : heading)
         line.push_back(row.contains(key) ? scalarText(row[key]) : "");
      lines.push_back(std::move(line));
   }
   for (const auto &line : lines) {
      std::string text;
      for (std::size_t column = 0; column < line.size(); ++column) {
         std::size_t width = 0;
         for (const auto &other : lines)
            width = std::max(width, other[column].size());
         text += column + 1 == line.size() ? line[column] : fmt::format("{:{}}  ", line[column], width);
      }
      fmt::print("{}\n", text);
   }
}

std::string fullId(const Catalogue &catalogue, const char *interface, const std::string &given)
{
   if (catalogue.offer(interface, given))
      return given;
   std::string found;
   for (const Offer &offer : catalogue.offers(interface))
      if (offer.provided->id.ends_with("." + given)) {
         if (!found.empty())
            return given;
         found = offer.provided->id;
      }
   return found.empty() ? given : found;
}

Result<Values> parseValues(const std::vector<std::string> &options)
{
   Values values;
   for (const std::string &option : options) {
      const std::size_t equals = option.find('=');
      if (equals == std::string::npos || equals == 0)
         return Error{ErrorCode::usage, fmt::format("\"{}\" is not of the form name=value", option)};
      const std::string text = option.substr(equals + 1);
      if (const auto number = parseNumber(text))
         values[option.substr(0, equals)] = *number;
      else
         values[option.substr(0, equals)] = text;
   }
   return values;
}

} // namespace diatom::cli
