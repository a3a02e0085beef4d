// Plugins in the studio: the question before one of the user's own folder runs, the list of all, what they
// did that they must not.
#include "studio.h"

#include "core/file.h"
#include "core/sanitizers.h"
#include "scene/simulation.h"
#include "support/scenes.h"

#include <QMessageBox>
#include <QPushButton>
#include <QTimer>
#include <QTreeWidget>

#include "gui/plugin_consent.h"
#include "gui/plugin_dialog.h"

using namespace diatom;
using namespace diatom::test;
namespace fs = std::filesystem;

namespace {

constexpr const char *kLattice = "test.unruly.lattice";

} // namespace

class PluginsTest : public QObject
{
   Q_OBJECT

private slots:
   void init();
   void trustedItIsThereAndNotAskedAgain();
   void declinedItIsNotThereAndNotAskedAgain();
   void aChangedLibraryIsAskedAbout();
   void theListShowsVerdictsAndTrusts();
   void outsideSolversRunApart();
   void warningsAreShownOverTheView();

private:
   fs::path folder() const { return fs::path(m_dir->path().toStdString()) / "data/diatom/plugins/1/unruly"; }
   /// Finds plugins as the studio does when it starts; clicks `button` on each question. How many there were.
   int start(const char *button);
   static bool has(const Catalogue &catalogue)
   {
      return catalogue.offer(DIATOM_LATTICE_1, kLattice) != nullptr;
   }

   std::unique_ptr<QTemporaryDir> m_dir;
   std::shared_ptr<const Catalogue> m_found;
};

void PluginsTest::init()
{
   m_dir = std::make_unique<QTemporaryDir>();
   for (const char *kind : {"data", "config", "cache"})
      qputenv(qPrintable(QString("XDG_%1_HOME").arg(QString(kind).toUpper())),
              (m_dir->path() + "/" + kind).toUtf8());
   qputenv("MESA_SHADER_CACHE_DISABLE", "true"); // it would be kept below the folder that goes
   fs::create_directories(folder().parent_path());
   fs::copy(test::binaryDir() / "tests/plugins/faulty/unruly", folder(), fs::copy_options::recursive);
}

int PluginsTest::start(const char *button)
{
   int asked = 0;
   QTimer look;
   connect(&look, &QTimer::timeout, this, [&] {
      auto *box = qobject_cast<QMessageBox *>(QApplication::activeModalWidget());
      if (!box || !box->isVisible())
         return;
      ++asked;
      QTest::mouseClick(box->findChild<QPushButton *>(QString::fromUtf8(button)), Qt::LeftButton);
   });
   look.start(20);
   QSettings remembered(m_dir->filePath("studio.ini"), QSettings::IniFormat);
   m_found = gui::askForConsent(gui::findPlugins(), remembered);
   return asked;
}

void PluginsTest::trustedItIsThereAndNotAskedAgain()
{
   QVERIFY(!has(*gui::findPlugins()));
   QCOMPARE(start("pluginConsent.use"), 1);
   QVERIFY(has(*m_found));
   QCOMPARE(start("pluginConsent.decline"), 0);
   QVERIFY(has(*m_found));
}

void PluginsTest::declinedItIsNotThereAndNotAskedAgain()
{
   QCOMPARE(start("pluginConsent.decline"), 1);
   QVERIFY(!has(*m_found));
   QCOMPARE(start("pluginConsent.use"), 0);
   QVERIFY(!has(*m_found));
}

void PluginsTest::aChangedLibraryIsAskedAbout()
{
   QCOMPARE(start("pluginConsent.use"), 1);
   const auto library = readFile(folder() / "unruly.so");
   DIATOM_VERIFY_OK(library);
   DIATOM_VERIFY_OK(writeFileAtomic(folder() / "unruly.so", *library + std::string("\0", 1)));
   QVERIFY(!has(*gui::findPlugins()));
   QCOMPARE(start("pluginConsent.decline"), 1);
   QVERIFY(!has(*m_found));
}

void PluginsTest::theListShowsVerdictsAndTrusts()
{
   Studio studio(gui::findPlugins());
   QVERIFY(studio.ready());
   QVERIFY(studio.choose({"menu.help"}, "help.plugins"));
   auto *dialog = studio.window.findChild<gui::PluginDialog *>();
   QVERIFY(dialog && QTest::qWaitForWindowExposed(dialog));
   auto *list = dialog->findChild<QTreeWidget *>("plugins.list");
   auto *trust = dialog->findChild<QPushButton *>("plugins.trust");
   QVERIFY(list->topLevelItemCount() > 20);
   QVERIFY(!trust->isEnabled());
   const auto rows = list->findItems("Unruly", Qt::MatchExactly);
   QCOMPARE(rows.size(), 1);
   QCOMPARE(rows.front()->text(2), "Lattice, Parts, Machine, Solver");
   QVERIFY(rows.front()->text(3).contains("it lies in your own plugin folder"));
   list->scrollToItem(rows.front());
   QTest::mouseClick(list->viewport(), Qt::LeftButton, {}, list->visualItemRect(rows.front()).center());
   QVERIFY(trust->isEnabled());
   if (qEnvironmentVariableIsSet("DIATOM_PICTURES"))
      dialog->grab().save(qEnvironmentVariable("DIATOM_PICTURES") + "/plugins.png");
   QTest::mouseClick(trust, Qt::LeftButton);
   QVERIFY(dialog->findChild<QLabel *>("plugins.words")->text().contains("started again"));
   QVERIFY(has(*gui::findPlugins()));
}

void PluginsTest::outsideSolversRunApart()
{
   if (!kMayFork)
      QSKIP("this build's sanitizer bears no other processes");
   QCOMPARE(start("pluginConsent.use"), 1);
   test::Scene cubes(LatticeSpec().id);
   for (int x = 0; x < 3; ++x)
      cubes.model.root.cells.set({x, 0, 0}, Cell{1, 0, 0});
   Setup setup;
   setup.solver = "test.unruly.solver";
   auto scene = diatom::Scene::build(cubes.hierarchy(), setup, Job());
   DIATOM_VERIFY_OK(scene);
   qputenv("DIATOM_TEST_FAULT", "solver.exits"); // the process that it runs in
   const auto run = Simulation::start(m_found, *std::move(scene), setup, {}, Job());
   qunsetenv("DIATOM_TEST_FAULT");
   QVERIFY(!run);
   QVERIFY2(run.error().message.find("test.unruly.solver") != std::string::npos, run.error().message.c_str());
   qInfo("%s", run.error().message.c_str());
}

void PluginsTest::warningsAreShownOverTheView()
{
   Studio studio;
   QVERIFY(studio.ready());
   studio.window.warn("it did what it must not");
   QCOMPARE(studio.window.findChild<gui::MessageBar *>("messageBar")->text(), "it did what it must not");
}

QTEST_MAIN(PluginsTest)
#include "plugins_test.moc"
