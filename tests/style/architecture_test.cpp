// Holds docs/architecture.md against the code: the includes it lists are exactly those there are, each folder
// includes only earlier ones, and the kernel knows nothing of Qt.
#include "core/file.h"
#include "support/support.h"

#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

using namespace diatom;
namespace fs = std::filesystem;

namespace {

using Graph = std::map<std::string, std::set<std::string>>;

/// The folders in the page's order, and what each says it includes.
std::pair<std::vector<std::string>, Graph> pageGraph()
{
   const auto page = readFile(test::sourceDir() / "docs" / "architecture.md");
   std::vector<std::string> order;
   Graph graph;
   std::istringstream lines(page.ok() ? *page : "");
   bool inside = false;
   for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("```")) {
         inside = line == "```includes";
         continue;
      }
      if (!inside)
         continue;
      std::istringstream words(line);
      std::string folder, arrow;
      words >> folder >> arrow;
      order.push_back(folder);
      graph[folder];
      for (std::string included; words >> included;)
         graph[folder].insert(included);
   }
   return {order, graph};
}

/// The listed folder a file of the project belongs to: the longest one that its path starts with.
std::string folderOf(const std::string &path, const std::vector<std::string> &folders)
{
   std::string best;
   for (const std::string &folder : folders)
      if (path.starts_with(folder + "/") && folder.size() > best.size())
         best = folder;
   return best;
}

/// Where an include of a file leads within the project; empty for the system's headers.
std::string resolve(const fs::path &file, const std::string &included)
{
   const fs::path root = test::sourceDir();
   const fs::path candidates[] = {file.parent_path() / included, root / "kernel" / included, root / included,
                                  root / "plugins/sdk/include" / included};
   for (const fs::path &candidate : candidates)
      if (fs::is_regular_file(candidate))
         return fs::relative(fs::canonical(candidate), fs::canonical(root)).string();
   return "";
}

std::vector<fs::path> sources(const std::vector<std::string> &folders)
{
   std::vector<fs::path> found;
   for (const char *top : {"kernel", "plugins", "worker", "plugin_check", "render", "gui", "cli"})
      for (const auto &entry : fs::recursive_directory_iterator(test::sourceDir() / top)) {
         const std::string suffix = entry.path().extension().string();
         if (suffix == ".cpp" || suffix == ".h" || suffix == ".hpp" || suffix == ".c")
            if (!folderOf(fs::relative(entry.path(), test::sourceDir()).string(), folders).empty())
               found.push_back(entry.path());
      }
   return found;
}

std::vector<std::string> includesOf(const fs::path &file)
{
   static const std::regex pattern("^\\s*#\\s*include\\s*[\"<]([^\">]+)[\">]");
   std::vector<std::string> found;
   std::ifstream stream(file);
   std::smatch match;
   for (std::string line; std::getline(stream, line);)
      if (std::regex_search(line, match, pattern))
         found.push_back(match[1]);
   return found;
}

QString text(const std::set<std::string> &folders)
{
   QStringList list;
   for (const std::string &folder : folders)
      list << QString::fromStdString(folder);
   return list.join(" ");
}

} // namespace

class ArchitectureTest : public QObject
{
   Q_OBJECT
private slots:
   void foldersIncludeOnlyEarlierOnes();
   void thePageListsTheIncludesThereAre();
   void theKernelKnowsNoQt();
};

void ArchitectureTest::foldersIncludeOnlyEarlierOnes()
{
   const auto [order, graph] = pageGraph();
   QVERIFY(order.size() > 10);
   std::set<std::string> earlier;
   for (const std::string &folder : order) {
      for (const std::string &included : graph.at(folder))
         QVERIFY2(earlier.contains(included),
                  (folder + " includes " + included + ", which comes later").c_str());
      earlier.insert(folder);
   }
}

void ArchitectureTest::thePageListsTheIncludesThereAre()
{
   const auto [order, graph] = pageGraph();
   Graph real;
   for (const std::string &folder : order)
      real[folder];
   for (const fs::path &file : sources(order)) {
      const std::string from = folderOf(fs::relative(file, test::sourceDir()).string(), order);
      for (const std::string &included : includesOf(file)) {
         const std::string to = folderOf(resolve(file, included), order);
         if (!to.empty() && to != from)
            real[from].insert(to);
      }
   }
   for (const std::string &folder : order)
      if (real.at(folder) != graph.at(folder))
         QFAIL(qPrintable(
             QString("%1 includes \"%2\", docs/architecture.md says \"%3\"")
                 .arg(QString::fromStdString(folder), text(real.at(folder)), text(graph.at(folder)))));
}

void ArchitectureTest::theKernelKnowsNoQt()
{
   static const std::regex qt("^(Q[A-Z]|Qt[A-Z]|q[a-z]+\\.h$)");
   for (const fs::path &file : sources({"kernel", "plugins", "worker", "plugin_check", "render", "cli"}))
      for (const std::string &included : includesOf(file))
         QVERIFY2(!std::regex_search(included, qt), (file.string() + " includes " + included).c_str());
}

QTEST_APPLESS_MAIN(ArchitectureTest)
#include "architecture_test.moc"
