// The plugin host: manifests, discovery, loading, the guard, and what it says about plugins that misbehave.
#include "core/file.h"
#include "plugins/catalogue.h"
#include "support/support.h"

#include <cfenv>
#include <clocale>
#include <limits>

using namespace diatom;
namespace fs = std::filesystem;

namespace {

fs::path faultyFolder() { return test::binaryDir() / "tests" / "plugins" / "faulty" / "misbehaving"; }

/// A plugin folder of its own under `root`, as a copy of the misbehaving one with its manifest edited.
fs::path copyPlugin(const fs::path &root, const char *name, const std::string &from = "",
                    const std::string &to = "")
{
   fs::path folder = root / name;
   fs::create_directories(folder);
   fs::copy(faultyFolder(), folder, fs::copy_options::recursive | fs::copy_options::overwrite_existing);
   if (!from.empty()) {
      std::string json = *readFile(folder / "plugin.json");
      const std::size_t at = json.find(from);
      json.replace(at, from.size(), to);
      (void)writeFileAtomic(folder / "plugin.json", json);
   }
   return folder;
}

std::string createError(const Catalogue &catalogue, const char *id, const Values &values = {})
{
   const Job job;
   const auto made = catalogue.create<diatom_lattice>(DIATOM_LATTICE_1, id, values, job);
   return made.ok() ? "" : made.error().message;
}

} // namespace

class PluginsTest : public QObject
{
   Q_OBJECT
private slots:
   void init() { m_dir = std::make_unique<QTemporaryDir>(); }
   void everyCandidateHasAVerdict();
   void brokenManifestsAreNamed_data();
   void brokenManifestsAreNamed();
   void ofTwoVersionsTheHigherIsUsed();
   void oneFolderReachedTwiceIsOneCandidate();
   void relativeSearchFoldersAreIgnored();
   void aHalfUpdatedInstallIsRefused();
   void aFileThatIsNoPluginIsRefused();
   void faultsBecomeSentences_data();
   void faultsBecomeSentences();
   void parametersAreCompletedAndChecked();
   void floatingPointModeAndLocaleSurvive();

private:
   fs::path root() const { return m_dir->path().toStdString(); }
   std::unique_ptr<QTemporaryDir> m_dir;
};

void PluginsTest::everyCandidateHasAVerdict()
{
   copyPlugin(root(), "good");
   fs::create_directories(root() / "bad");
   DIATOM_VERIFY_OK(writeFileAtomic(root() / "bad" / "plugin.json", "{ nonsense"));
   fs::create_directories(root() / "no-manifest");
   const auto catalogue = Catalogue::find({root()});
   QCOMPARE(catalogue->candidates().size(), std::size_t{2});
   QVERIFY(!catalogue->candidates()[0].accepted);
   QVERIFY(catalogue->candidates()[0].verdict.find("not valid JSON") != std::string::npos);
   QVERIFY(catalogue->candidates()[1].accepted);
   QCOMPARE(catalogue->offers(DIATOM_LATTICE_1).size(), std::size_t{7});
   QVERIFY(catalogue->offer(DIATOM_LATTICE_1, "test.echo"));
   QVERIFY(!catalogue->offer(DIATOM_LATTICE_1, "test.echoes"));
}

void PluginsTest::brokenManifestsAreNamed_data()
{
   QTest::addColumn<QString>("from");
   QTest::addColumn<QString>("to");
   QTest::addColumn<QString>("expected");
   QTest::newRow("missing id") << "\"id\": \"test.misbehaving\","
                               << ""
                               << "/id is missing";
   QTest::newRow("wrong type") << "\"version\": \"1.0.0\""
                               << "\"version\": 1"
                               << "/version must be text";
   QTest::newRow("newer schema") << "\"schema\": 1"
                                 << "\"schema\": 2"
                                 << "/schema is 2";
   QTest::newRow("newer major") << "\"major\": 1"
                                << "\"major\": 2"
                                << "interface 2";
   QTest::newRow("needs newer minor") << "\"needs\": 0"
                                      << "\"needs\": 9"
                                      << "needs plugin interface 1.9";
   QTest::newRow("path") << "\"misbehaving.so\""
                         << "\"../evil.so\""
                         << "own folder";
   QTest::newRow("no library") << "\"misbehaving.so\""
                               << "\"missing.so\""
                               << "missing.so is not there";
   QTest::newRow("default outside") << "\"default\": 1.5"
                                    << "\"default\": 7"
                                    << "parameters/0";
}

void PluginsTest::brokenManifestsAreNamed()
{
   QFETCH(QString, from);
   QFETCH(QString, to);
   QFETCH(QString, expected);
   copyPlugin(root(), "edited", from.toStdString(), to.toStdString());
   const auto catalogue = Catalogue::find({root()});
   QCOMPARE(catalogue->candidates().size(), std::size_t{1});
   QVERIFY(!catalogue->candidates()[0].accepted);
   const QString verdict = QString::fromStdString(catalogue->candidates()[0].verdict);
   QVERIFY2(verdict.contains(expected), qPrintable(verdict));
}

void PluginsTest::ofTwoVersionsTheHigherIsUsed()
{
   copyPlugin(root(), "a-newer", "\"version\": \"1.0.0\"", "\"version\": \"1.10.0\"");
   copyPlugin(root(), "b-older", "\"version\": \"1.0.0\"", "\"version\": \"1.9.0\"");
   const auto catalogue = Catalogue::find({root()});
   QVERIFY(catalogue->candidates()[0].accepted);
   QVERIFY(!catalogue->candidates()[1].accepted);
   QVERIFY(catalogue->candidates()[1].verdict.find("version 1.10.0") != std::string::npos);
}

void PluginsTest::oneFolderReachedTwiceIsOneCandidate()
{
   copyPlugin(root(), "good");
   const auto catalogue = Catalogue::find({root(), root() / ".." / root().filename()});
   QCOMPARE(catalogue->candidates().size(), std::size_t{1});
}

void PluginsTest::relativeSearchFoldersAreIgnored()
{
   qputenv("DIATOM_PLUGIN_PATH", "plugins:/nowhere/else:.");
   const auto folders = defaultPluginFolders();
   QCOMPARE(folders.front().path, fs::path("/nowhere/else"));
   for (const PluginFolder &folder : folders)
      QVERIFY(folder.path.is_absolute());
}

void PluginsTest::aHalfUpdatedInstallIsRefused()
{
   copyPlugin(root(), "half", "Breaks the", "Breaks a");
   const auto catalogue = Catalogue::find({root()});
   const std::string error = createError(*catalogue, "test.echo");
   QVERIFY2(error.find("half-updated install") != std::string::npos, error.c_str());
}

void PluginsTest::aFileThatIsNoPluginIsRefused()
{
   const fs::path folder = copyPlugin(root(), "text");
   DIATOM_VERIFY_OK(writeFileAtomic(folder / "misbehaving.so", "this is not a library"));
   const auto catalogue = Catalogue::find({root()});
   const std::string error = createError(*catalogue, "test.echo");
   QVERIFY2(error.find("cannot be loaded") != std::string::npos, error.c_str());
}

void PluginsTest::faultsBecomeSentences_data()
{
   QTest::addColumn<QString>("id");
   QTest::addColumn<QString>("expected");
   QTest::newRow("throws") << "test.throws"
                           << "let an exception out";
   QTest::newRow("refuses") << "test.refuses"
                            << "the moon is not full";
   QTest::newRow("makes nothing") << "test.makes_nothing"
                                  << "made nothing";
   QTest::newRow("unknown status") << "test.unknown_status"
                                   << "unknown status";
   QTest::newRow("not installed") << "test.absent"
                                  << "nothing installed provides test.absent";
}

void PluginsTest::faultsBecomeSentences()
{
   QFETCH(QString, id);
   QFETCH(QString, expected);
   const auto catalogue = Catalogue::find({faultyFolder().parent_path()});
   const std::string error = createError(*catalogue, id.toLatin1());
   QVERIFY2(error.find(expected.toStdString()) != std::string::npos, error.c_str());
   const Job job;
   const auto promised = catalogue->create<diatom_parts>(DIATOM_PARTS_1, "test.promised", {}, job);
   QVERIFY(!promised.ok());
   QVERIFY(promised.error().message.find("its library has none") != std::string::npos);
}

void PluginsTest::parametersAreCompletedAndChecked()
{
   const auto catalogue = Catalogue::find({faultyFolder().parent_path()});
   const auto says = [&](const Values &values, const char *expected) {
      const std::string error = createError(*catalogue, "test.echo", values);
      if (error.find(expected) == std::string::npos)
         qWarning("%s", error.c_str());
      return error.find(expected) != std::string::npos;
   };
   QVERIFY(says({}, "1.500000 3.000000 fast"));
   QVERIFY(says({{"height", 0.25}, {"mode", std::string("slow")}}, "0.250000 3.000000 slow"));
   QVERIFY(says({{"height", 3.0}}, "must lie between 0 and 2"));
   QVERIFY(says({{"height", std::numeric_limits<double>::quiet_NaN()}}, "must lie between"));
   QVERIFY(says({{"count", 2.5}}, "whole number"));
   QVERIFY(says({{"mode", std::string("sideways")}}, "one of: fast, slow"));
   QVERIFY(says({{"mode", 1.0}}, "must be a text"));
   QVERIFY(says({{"widht", 1.0}}, "no parameter named \"widht\""));
}

void PluginsTest::floatingPointModeAndLocaleSurvive()
{
   const auto catalogue = Catalogue::find({faultyFolder().parent_path()});
   volatile double smallest = std::numeric_limits<double>::denorm_min();
   const std::string before = std::setlocale(LC_ALL, nullptr);
   QCOMPARE(createError(*catalogue, "test.flushes"), std::string());
   QVERIFY(smallest * 3 > 0); // with flush-to-zero this product is 0
   QCOMPARE(createError(*catalogue, "test.locale"), std::string());
   QCOMPARE(std::string(std::setlocale(LC_ALL, nullptr)), before);
}

QTEST_APPLESS_MAIN(PluginsTest)
#include "plugins_test.moc"
