// diatom-plugin-check: each check passes on a plugin that keeps the contract and fails on the same plugin
// once it breaks that one rule; plugins that cannot be loaded, crash or hang are told; runs can be repeated.
#include "core/sanitizers.h"
#include "support/process.h"
#include "support/support.h"

#include <QDir>
#include <QFile>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <QTemporaryDir>

#include <vector>

using namespace diatom;

namespace {

constexpr int kPassed = 0, kWarned = 1, kFailed = 2, kCannotLoad = 3, kUsage = 4;

QString folderOf(const char *faulty)
{
   return QString::fromStdString((test::binaryDir() / "tests/plugins/faulty" / faulty).string());
}

/// In a process where a crash is a crash: AddressSanitizer would end it with a report and an exit code.
test::Outcome check(const QString &folder, const QStringList &words, const QByteArray &fault = {})
{
   qputenv("DIATOM_TEST_FAULT", fault);
   qputenv("DIATOM_TEST_SLOWDOWN", QByteArray::number(kSlowdown));
   qputenv("ASAN_OPTIONS", "allocator_may_return_null=1:handle_segv=0");
   const auto program = QString::fromStdString((test::binaryDir() / "bin/diatom-plugin-check").string());
   return test::run(program, QStringList{folder} + words);
}

/// A rule that the plugin "unruly" breaks when it is told to, and what is said of it.
struct Broken
{
   QString check, fault, said;
   int exit = kFailed;
   bool measuresMemory = false;
};

std::vector<Broken> brokenRules()
{
   std::vector<Broken> rules{
       {"module.loads", "module.loads", "loading it takes", kWarned},
       {"module.interfaces", "module.interfaces", "an interface that there is not"},
       {"module.ids", "module.ids", "answers as if it did"},
       {"lattice.repeats", "lattice.prints", "it prints, which belongs to the program alone: made one"},
       {"lattice.repeats", "lattice.exits", "it ended the process (exit code 0)"},
       {"lattice.parameters", "lattice.parameters", "with height=2: "},
       {"lattice.contacts", "lattice.contacts", "touch, and no link says so"},
       {"parts.parameters", "parts.parameters", "its catalogue of parts is broken"},
       {"parts.coverage", "parts.coverage", "is covered by no part"},
       {"parts.order", "parts.order", "the same cells in another order give other parts"},
       {"parts.older_host", "parts.older_host", "it crashed (Segmentation fault)"},
       {"parts.meshes", "parts.meshes", "detail 0: "},
       {"parts.cancel", "parts.cancel", "look at cancelled()", kWarned},
       {"machine.parameters", "machine.parameters", "cannot be used"},
       {"machine.programs", "machine.programs", "where a number belongs"},
       {"machine.reach", "machine.reach", "numbers that are none"},
       {"machine.long", "machine.long", "too many parts"},
       {"machine.cancel", "machine.cancel", "look at cancelled()", kWarned},
       {"solver.abilities", "solver.abilities", "it names no physics"},
       {"solver.parameters", "solver.parameters", "is not a number at cell (0, 0, 0)"},
       {"solver.life", "solver.life", "each step leaves", kFailed, true},
       {"solver.estimate", "solver.estimate", "it said 0 kB and took", kFailed, true},
       {"solver.repeats", "solver.repeats", "asked twice, it answers differently"},
       {"solver.threads", "solver.number_of_threads", "threads it answers differently"},
       {"solver.worker", "solver.worker", "in a process of its own it answers differently"},
       {"solver.reads", "solver.reads", "read in pieces"},
       {"solver.state", "solver.state", "after its state was loaded it goes on differently"},
       {"solver.bad_numbers", "solver.bad_numbers", "answers with numbers that are none"},
       {"solver.cancel", "solver.cancel", "it did not end within 2 s"},
       {"solver.known", "solver.known", "where g t^2 / 2 is"}};
   for (const QString kind : {"lattice", "parts", "machine"}) {
      const auto add = [&](const char *check, const char *said, bool measuresMemory = false) {
         rules.push_back({kind + check, kind + check, said, kFailed, measuresMemory});
      };
      add(".life", "created and destroyed it leaves", true);
      add(".repeats", "differently");
      add(".threads", "asked by 8 threads at once");
      add(".scratch", "it crashed");
      add(".records", "the record has another size");
   }
   return rules;
}

} // namespace

class ConformanceTest : public QObject
{
   Q_OBJECT

private slots:
   void initTestCase();
   void everyCheckPassesWhereNothingIsBroken();
   void everyCheckFailsWhereItsRuleIsBroken_data();
   void everyCheckFailsWhereItsRuleIsBroken();
   void everyCheckHasARowOrAReason();
   void pluginsThatCannotBeLoaded_data();
   void pluginsThatCannotBeLoaded();
   void moreExportsThanOneAreTold();
   void misuseIsTold();
   void reportsAreJson();
};

void ConformanceTest::initTestCase()
{
   if (!kMayFork)
      QSKIP("this build's sanitizer bears no other processes");
}

void ConformanceTest::everyCheckPassesWhereNothingIsBroken()
{
   const auto outcome = check(folderOf("unruly"), {"--seed", "1"});
   QVERIFY2(outcome.exit == kPassed, outcome.out + outcome.err);
   QVERIFY2(outcome.out.contains(", 0 with warnings, 0 failed"), outcome.out);
}

void ConformanceTest::everyCheckFailsWhereItsRuleIsBroken_data()
{
   QTest::addColumn<QString>("name");
   QTest::addColumn<QString>("fault");
   QTest::addColumn<QString>("said");
   QTest::addColumn<int>("exit");
   for (const Broken &one : brokenRules())
      if (!(kAddressSanitizer && one.measuresMemory))
         QTest::newRow(qPrintable(one.fault)) << one.check << one.fault << one.said << one.exit;
}

void ConformanceTest::everyCheckFailsWhereItsRuleIsBroken()
{
   QFETCH(QString, name);
   QFETCH(QString, fault);
   QFETCH(QString, said);
   QFETCH(int, exit);
   const QStringList seconds = fault == "solver.cancel" ? QStringList{"--seconds", "2"} : QStringList();
   const auto outcome =
       check(folderOf("unruly"), QStringList{"--seed", "1", "--only", name} + seconds, fault.toUtf8());
   QVERIFY2(outcome.exit == exit, outcome.out + outcome.err);
   QVERIFY2(outcome.out.contains(said.toUtf8()), outcome.out);
}

void ConformanceTest::everyCheckHasARowOrAReason()
{
   QStringList known{"module.exports",   // has a test of its own below
                     "machine.locale",   // needs a locale with a comma, which a bare machine has not
                     "lattice.inverse"}; // the kernel's own sums, on what its guard has let through
   for (const Broken &one : brokenRules())
      known << one.check;
   const auto listed = check(folderOf("unruly"), {"--list"});
   QCOMPARE(listed.exit, kPassed);
   for (const QByteArray &line : listed.out.trimmed().split('\n')) {
      const QString name = line.left(line.indexOf(' '));
      QVERIFY2(known.contains(name), qPrintable(name + " is broken by no plugin of the tests"));
   }
}

void ConformanceTest::pluginsThatCannotBeLoaded_data()
{
   QTest::addColumn<QString>("folder");
   QTest::addColumn<QString>("said");
   QTest::newRow("crashes") << folderOf("crashes") << "it crashed (Segmentation fault)";
   QTest::newRow("hangs") << folderOf("hangs") << "it did not end within 2 s";
}

void ConformanceTest::pluginsThatCannotBeLoaded()
{
   QFETCH(QString, folder);
   QFETCH(QString, said);
   const auto outcome = check(folder, {"--seconds", "2"});
   QVERIFY2(outcome.exit == kCannotLoad, outcome.out + outcome.err);
   QVERIFY2(outcome.out.contains(said.toUtf8()), outcome.out);
}

void ConformanceTest::moreExportsThanOneAreTold()
{
   QTemporaryDir dir;
   QVERIFY(QDir(dir.path()).mkpath("plugin"));
   const QString folder = dir.filePath("plugin");
   QVERIFY(QFile::copy(folderOf("unruly") + "/plugin.json", folder + "/plugin.json"));
   QFile source(dir.filePath("more.c"));
   QVERIFY(source.open(QIODevice::WriteOnly));
   source.write("int helper(void) { return 1; }\n");
   source.close();
   const auto built =
       test::run("cc", {"-shared", "-fPIC", dir.filePath("more.c"), "-o", folder + "/unruly.so"});
   QVERIFY2(built.exit == 0, built.err);
   // Not a plugin at all; the check of exports does not need one.
   const auto outcome = check(folder, {"--in-process", "module.exports"});
   QVERIFY2(outcome.exit == kFailed && outcome.out.contains("it exports helper"), outcome.out + outcome.err);
   const auto loaded = check(folder, {});
   QVERIFY2(loaded.exit == kCannotLoad && loaded.out.contains("exports no diatom_module_v1"), loaded.out);
}

void ConformanceTest::misuseIsTold()
{
   const auto nothing = check("/nowhere", {});
   QCOMPARE(nothing.exit, kCannotLoad);
   QVERIFY2(nothing.err.contains("name the folder that holds plugin.json"), nothing.err);
   const auto unknown = check(folderOf("unruly"), {"--only", "no.such"});
   QCOMPARE(unknown.exit, kUsage);
   QVERIFY2(unknown.err.contains("--list names them"), unknown.err);
}

void ConformanceTest::reportsAreJson()
{
   const auto outcome =
       check(folderOf("unruly"), {"--seed", "7", "--only", "lattice", "--json"}, "lattice.contacts");
   QCOMPARE(outcome.exit, kFailed);
   const QJsonObject report = QJsonDocument::fromJson(outcome.out).object();
   QCOMPARE(report["plugin"].toString(), "test.unruly");
   QCOMPARE(report["seed"].toInt(), 7);
   QCOMPARE(report["failures"].toInt(), 1);
   for (const QJsonValue &one : report["checks"].toArray())
      QCOMPARE(one["verdict"].toString() == "FAILED", one["check"].toString() == "lattice.contacts");
}

QTEST_APPLESS_MAIN(ConformanceTest)
#include "conformance_test.moc"
