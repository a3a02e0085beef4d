// Plugins that misbehave on purpose: for each, the sentence that the user reads, that the design is as before
// and that the program goes on.
#include "assembly/plan.h"
#include "core/child.h"
#include "core/file.h"
#include "core/sanitizers.h"
#include "plugins/call_watch.h"
#include "plugins/consent.h"
#include "plugins/warnings.h"
#include "scene/simulation.h"
#include "scene/where.h"
#include "support/scenes.h"

#include <clocale>
#include <csignal>
#include <mutex>

using namespace diatom;
namespace fs = std::filesystem;

namespace {

fs::path built(const char *name) { return test::binaryDir() / "tests/plugins/faulty" / name; }

/// Three cubes in a row, the first held, gravity on.
struct Design
{
   test::Scene scene{"org.diatom_cad.lattice.cube"};
   Setup setup;

   Design()
   {
      for (int x = 0; x < 3; ++x)
         scene.model.root.cells.set({x, 0, 0}, Cell{1, 0, 0});
      setup.supports.push_back({Index{0, 0, 0}, kAllFreedoms});
      setup.gravity = {0, 0, -9.81};
   }
   /// All that a file of it would hold, as text to compare.
   std::string content() const
   {
      std::string text = scene.model.lattice.id + std::to_string(scene.model.lattice.pitch);
      const Hierarchy hierarchy = scene.hierarchy();
      hierarchy.visit(hierarchy.bounds(), [&](Index i, Cell cell) {
         text += indexText(i) + std::to_string(cell.material) + ";";
         return true;
      });
      return text + std::to_string(setup.gravity[2]) + std::to_string(setup.supports.size());
   }
};

std::string sentence(const Status &status) { return status.ok() ? "" : status.error().message; }
template<typename T>
std::string sentence(const Result<T> &result)
{
   return result.ok() ? "" : result.error().message;
}

} // namespace

class FaultsTest : public QObject
{
   Q_OBJECT
private slots:
   void init();
   void cleanup();
   void falseAnswers_data();
   void falseAnswers();
   void onTrial_data();
   void onTrial();
   void aRefusedLibraryIsTriedAgainWhenAsked();
   void aVerdictIsForTheFileAsItIs();
   void exceptionsPutItOffForTheSession();
   void aCrashInACallIsRememberedByTheNextStart();
   void whoIgnoresCancelIsNamed();
   void theProcessIsAsBefore();

private:
   fs::path root() const { return m_dir->path().toStdString(); }
   /// A copy of a faulty plugin in a folder of its own.
   fs::path copy(const char *name) const;
   std::shared_ptr<const Catalogue> catalogue(bool tryUnknown = false) const
   {
      return Catalogue::find({root() / "plugins", test::binaryDir() / "plugins"}, tryUnknown);
   }
   std::string verdict(const char *id) const;
   /// What the user reads when one of the false answers is used.
   std::string use(const Catalogue &catalogue, const Design &design, const std::string &kind,
                   const std::string &fault, const Job &job) const;
   std::unique_ptr<QTemporaryDir> m_dir;
};

void FaultsTest::init()
{
   m_dir = std::make_unique<QTemporaryDir>();
   qputenv("XDG_CACHE_HOME", (m_dir->path() + "/cache").toUtf8());
   qputenv("XDG_CONFIG_HOME", (m_dir->path() + "/config").toUtf8());
}

void FaultsTest::cleanup()
{
   setPluginWarnings({});
   setCancelPatience(10);
}

fs::path FaultsTest::copy(const char *name) const
{
   const fs::path to = root() / "plugins" / name;
   fs::create_directories(to.parent_path());
   fs::copy(built(name), to, fs::copy_options::recursive);
   return to;
}

std::string FaultsTest::verdict(const char *id) const
{
   const auto all = catalogue();
   for (const Candidate &candidate : all->candidates())
      if (candidate.manifest.id == id)
         return (candidate.accepted ? "" : "refused: ") + candidate.verdict;
   return "not found";
}

std::string FaultsTest::use(const Catalogue &plugins, const Design &design, const std::string &kind,
                            const std::string &fault, const Job &job) const
{
   const Values values{{"fault", fault}};
   const Hierarchy hierarchy = design.scene.hierarchy();
   if (kind == "lattice") {
      LatticeSpec spec;
      spec.id = "test.false.lattice";
      spec.values = values;
      return sentence(Lattice::make(plugins, spec, job));
   }
   if (kind == "parts") {
      const auto maker =
          PartMaker::make(plugins, "test.false.parts", values, design.scene.lattice->spec().id, job);
      return maker.ok() ? sentence((*maker)->decompose(hierarchy, job)) : sentence(maker);
   }
   if (kind == "mesh") {
      const auto maker =
          PartMaker::make(plugins, "test.false.parts", values, design.scene.lattice->spec().id, job);
      return maker.ok() ? sentence((*maker)->mesh(0, 1, 0, 1e-3, job)) : sentence(maker);
   }
   if (kind == "machine")
      return sentence(Machine::make(plugins, "test.false.machine", values, job));
   Setup setup = design.setup;
   setup.solver = "test.false.solver";
   auto scene = Scene::build(hierarchy, setup, job);
   if (!scene)
      return sentence(scene);
   auto run = Simulation::start(std::shared_ptr<const Catalogue>(&plugins, [](const Catalogue *) {}),
                                *std::move(scene), setup, values, job);
   if (!run)
      return sentence(run);
   if (const Status status = (*run)->advance(1e-2, job); !status)
      return sentence(status);
   return sentence((*run)->frame(job));
}

void FaultsTest::falseAnswers_data()
{
   QTest::addColumn<QString>("kind");
   QTest::addColumn<QString>("fault");
   QTest::addColumn<QString>("expected");
   const auto row = [](const char *kind, const char *fault, const char *expected) {
      QTest::newRow(qPrintable(QString("%1: %2").arg(kind, fault))) << kind << fault << expected;
   };
   row("lattice", "", ""); // the same code without a fault is taken
   row("lattice", "not finite", "not finite");
   row("lattice", "counts", "sites");
   row("lattice", "tiling", "joins features that do not meet");
   row("lattice", "one way", "link 0 of site 0 is not mutual");
   row("lattice", "limits", "the longest -3");
   row("lattice", "throws", "the motif is lost");
   row("parts", "", "");
   row("parts", "not finite", "the part for the cell at 0 0 0 is at a place that is not finite");
   row("parts", "misses one", "the cell at 0 0 0 is covered by no part");
   row("parts", "covers twice", "the cell at 0 0 0 is covered more than once");
   row("parts", "index", "covers a cell that does not exist");
   row("parts", "type", "is of type 5, which is not in the catalogue");
   row("parts", "throws", "the saw broke");
   row("parts", "memory", "out of memory");
   row("mesh", "", "a mesh without a volume");
   row("machine", "", "");
   row("machine", "limits", "Y");
   row("machine", "not finite", "X");
   row("solver", "not finite", "its output 'position' is not a number at cell (1, 0, 0)");
   row("solver", "counts", "has 2 rows of 3 numbers where the scene has 3 cells");
   row("solver", "limits", "has -5 rows");
   row("solver", "state", "in a state 99 that does not exist");
   row("solver", "time", "at a time or count that is not one");
   row("solver", "throws", "the wheel came off");
}

void FaultsTest::falseAnswers()
{
   QFETCH(QString, kind);
   QFETCH(QString, fault);
   QFETCH(QString, expected);
   copy("false_answers");
   const Design design;
   const std::string before = design.content();
   const Job job;
   const auto plugins = catalogue();
   const std::string said = use(*plugins, design, kind.toStdString(), fault.toStdString(), job);
   QVERIFY2(expected.isEmpty() ? said.empty() : said.find(expected.toStdString()) != std::string::npos,
            said.c_str());
   QVERIFY2(said.empty() || said.find("test.false") != std::string::npos, said.c_str()); // who it was
   QCOMPARE(design.content(), before);
}

/// Libraries that are turned away before they run here, or let in with a word about them.
void FaultsTest::onTrial_data()
{
   QTest::addColumn<QString>("plugin");
   QTest::addColumn<QString>("thing");
   QTest::addColumn<bool>("refused");
   QTest::addColumn<QString>("expected");
   QTest::newRow("crashes") << "crashes"
                            << "test.crashes" << true << "it crashed when it was tried";
   QTest::newRow("hangs") << "hangs"
                          << "test.hangs" << true << "it hung when it was tried (5 s)";
   QTest::newRow("eats memory") << "eats_memory"
                                << "test.eats_memory" << true << "it crashed when it was tried";
   QTest::newRow("leaves threads") << "litters"
                                   << "test.litters.thread" << false << "leaves threads running";
   QTest::newRow("leaves files") << "litters"
                                 << "test.litters.file" << false << "leaves files open";
   QTest::newRow("changes folder") << "litters"
                                   << "test.litters.directory" << false << "changed the working directory";
   QTest::newRow("catches signals") << "litters"
                                    << "test.litters.signal" << false << "catches the signals of crashes";
   QTest::newRow("flushes") << "misbehaving"
                            << "test.flushes" << false
                            << "test.flushes (create) changed the floating-point mode";
   QTest::newRow("locale") << "misbehaving"
                           << "test.locale" << false << "test.locale (create) changed the locale";
}

void FaultsTest::onTrial()
{
   if (!kMayFork)
      QSKIP("no child process can be made under the thread sanitizer");
   QFETCH(QString, plugin);
   QFETCH(QString, thing);
   QFETCH(bool, refused);
   QFETCH(QString, expected);
   if (plugin == "eats_memory" && !kMayLimitMemory)
      QSKIP("memory is not limited under the address sanitizer");
   copy(plugin.toLatin1());
   const std::string id = "test." + plugin.toStdString();
   QCOMPARE(verdict(id.c_str()), std::string("ok")); // nothing is loaded to list it
   const auto tried = catalogue(true);
   const std::string said = verdict(id.c_str()); // now from what is remembered
   QVERIFY2(said.find(expected.toStdString()) != std::string::npos, said.c_str());
   QCOMPARE(said.starts_with("refused: "), refused);
   if (refused) {
      QVERIFY2(said.find("`diatom plugins retry " + id + "`") != std::string::npos, said.c_str());
      const auto made = tried->create<diatom_lattice>(DIATOM_LATTICE_1, thing.toStdString(), {}, Job());
      QVERIFY(!made.ok());
      QVERIFY2(made.error().message.find(expected.toStdString()) != std::string::npos,
               made.error().message.c_str());
   }
}

void FaultsTest::aRefusedLibraryIsTriedAgainWhenAsked()
{
   if (!kMayFork)
      QSKIP("no child process can be made under the thread sanitizer");
   copy("crashes");
   // At first use, without a listing before.
   const auto made = catalogue()->create<diatom_lattice>(DIATOM_LATTICE_1, "test.crashes", {}, Job());
   QVERIFY(!made.ok());
   QVERIFY2(made.error().message.find("it crashed when it was tried") != std::string::npos,
            made.error().message.c_str());
   QVERIFY(verdict("test.crashes").starts_with("refused: "));
   const auto retried = retryPlugins(*catalogue(), "test.crashes");
   DIATOM_VERIFY_OK(retried);
   QCOMPARE(retried->size(), std::size_t{1});
   QCOMPARE(verdict("test.crashes"), std::string("ok"));
   catalogue(true);
   QVERIFY(verdict("test.crashes").starts_with("refused: "));
   QVERIFY(!retryPlugins(*catalogue(), "test.absent").ok());
}

void FaultsTest::aVerdictIsForTheFileAsItIs()
{
   if (!kMayFork)
      QSKIP("no child process can be made under the thread sanitizer");
   const fs::path folder = copy("crashes");
   catalogue(true);
   QVERIFY(verdict("test.crashes").starts_with("refused: "));
   // The same bytes with another time are the same library; another one is not.
   fs::last_write_time(folder / "crashes.so", fs::file_time_type::clock::now() + std::chrono::hours(1));
   QVERIFY(verdict("test.crashes").starts_with("refused: "));
   DIATOM_VERIFY_OK(writeFileAtomic(folder / "crashes.so", "mended"));
   QCOMPARE(verdict("test.crashes"), std::string("ok"));
   // A damaged cache knows nothing and does no harm.
   DIATOM_VERIFY_OK(
       writeFileAtomic(root() / "cache/diatom/plugin_verdicts.json", "{\"schema\":1,\"libraries\":[3"));
   QCOMPARE(verdict("test.crashes"), std::string("ok"));
}

void FaultsTest::exceptionsPutItOffForTheSession()
{
   copy("false_answers");
   const Design design;
   const auto plugins = catalogue();
   for (int i = 0; i < 3; ++i) {
      const std::string said = use(*plugins, design, "parts", "throws", Job());
      QVERIFY2(said.find("the saw broke") != std::string::npos, said.c_str());
   }
   const std::string said = use(*plugins, design, "parts", "", Job());
   QVERIFY2(said.find("test.false_answers failed inside 3 times and is off") != std::string::npos,
            said.c_str());
   QCOMPARE(use(*catalogue(), design, "parts", "", Job()), std::string()); // another start
}

void FaultsTest::aCrashInACallIsRememberedByTheNextStart()
{
   if (!kMayFork)
      QSKIP("no child process can be made under the thread sanitizer");
   copy("false_answers");
   const Design design;
   // The program, as a child so that it may crash: create works, motif does not.
   const auto crashed = runInChild(
       [&](const ChildProgress &) {
          std::signal(SIGSEGV, SIG_DFL); // not the handler of the test's framework
          return use(*catalogue(), design, "lattice", "crash", Job());
       },
       60, "crashing", Job());
   QVERIFY2(!crashed.ok(), "it was meant to crash");
   const std::string said = verdict("test.false_answers");
   QVERIFY2(said.find("refused: test.false.lattice crashed Diatom in its function motif") !=
                std::string::npos,
            said.c_str());
   QVERIFY(retryPlugins(*catalogue(), "test.false_answers").ok());
   QCOMPARE(verdict("test.false_answers"), std::string("ok"));
}

void FaultsTest::whoIgnoresCancelIsNamed()
{
   copy("false_answers");
   const Design design;
   const auto plugins = catalogue();
   const fs::path released = root() / "released"; // the plugin goes on until it is there
   std::mutex mutex;
   std::string warned;
   setPluginWarnings([&](const std::string &text, PluginWarning) {
      const std::lock_guard lock(mutex);
      warned += text;
      (void)writeFileAtomic(released, "told");
   });
   setCancelPatience(0.5); // a user's 10 s are only a number
   Job *running = nullptr;
   Job job([&](double, std::string_view what) {
      if (what == "sawing")
         running->cancel();
   });
   running = &job;
   const std::string said =
       use(*plugins, design, "parts", "goes on until there is " + released.string(), job);
   setPluginWarnings({});
   const std::lock_guard lock(mutex);
   QVERIFY2(warned.find("test.false.parts (decompose) has not answered to cancel for 0.5 s") !=
                std::string::npos,
            (warned + said).c_str());
}

/// What a plugin changes while it is used is put back, and the user is told who it was.
void FaultsTest::theProcessIsAsBefore()
{
   copy("litters");
   copy("misbehaving");
   const auto plugins = catalogue();
   const auto use = [&](const char *id) {
      return sentence(plugins->create<diatom_lattice>(DIATOM_LATTICE_1, id, {}, Job()));
   };
   QCOMPARE(use("test.echo").substr(0, 9), std::string("test.echo")); // loaded: the trial is over
   std::string warned;
   setPluginWarnings([&](const std::string &text, PluginWarning) { warned += text + "\n"; });
   const fs::path folder = fs::current_path();
   const std::string locale = std::setlocale(LC_ALL, nullptr);
   volatile double smallest = std::numeric_limits<double>::denorm_min();
   for (const char *id : {"test.litters.directory", "test.locale", "test.flushes"})
      QCOMPARE(use(id), std::string());
   QCOMPARE(fs::current_path(), folder);
   QCOMPARE(std::string(std::setlocale(LC_ALL, nullptr)), locale);
   QVERIFY(smallest * 3 > 0); // with flush-to-zero this product is 0
   for (const char *expected :
        {"test.litters.directory (create) changed the working directory",
         "test.locale (create) changed the locale", "test.flushes (create) changed the floating-point mode"})
      QVERIFY2(warned.find(expected) != std::string::npos, warned.c_str());
}

QTEST_APPLESS_MAIN(FaultsTest)
#include "faults_test.moc"
