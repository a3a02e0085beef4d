// diatom verify as a user calls it: the shipped cases, and those beside the project where they are.
#include "cli/program.h"

#include <QDir>

using namespace diatom;
using test::diatomRuns;

namespace {

QStringList casesIn(const std::filesystem::path &folder, const QStringList &names = {"*.json"})
{
   QStringList files;
   const QDir dir(QString::fromStdString(folder.string()));
   for (const QString &name : dir.entryList(names, QDir::Files, QDir::Name))
      files << dir.filePath(name);
   return files;
}

/// "ID: PATH" of everything that failed.
QStringList failures(const QJsonObject &report)
{
   QStringList out;
   for (const auto &one : report["cases"].toArray())
      for (const auto &value : one.toObject()["values"].toArray())
         if (value.toObject()["verdict"] == "FAIL")
            out << one.toObject()["id"].toString() + ": " + value.toObject()["path"].toString();
   return out;
}

int tally(const QJsonObject &report, const char *key) { return report["tally"].toObject()[key].toInt(-1); }

} // namespace

class VerifyTest : public QObject
{
   Q_OBJECT

private slots:
   void shippedCasesPass();
   void casesBesideTheProjectPass_data();
   void casesBesideTheProjectPass();
   void laterFormsAreCountedApart();
   void failuresSetTheExitCodeAndAreShown();
   void formsAreListed();
   void wrongCallsAreTold();
};

/// All of them, since they are small; nothing may be left out.
void VerifyTest::shippedCasesPass()
{
   const QStringList files = casesIn(test::sourceDir() / "resources" / "verification");
   QVERIFY(files.size() >= 6);
   const auto run = diatomRuns(QStringList{"verify", "--json"} + files);
   const QJsonObject report = run.object();
   QVERIFY2(run.exit == 0, qPrintable(failures(report).join('\n') + run.err));
   QVERIFY(tally(report, "pass") >= 60);
   QCOMPARE(tally(report, "fail"), 0);
   QCOMPARE(tally(report, "not_computed"), 0);
   QCOMPARE(report["cases"].toArray().size(), files.size());
}

/// The least number of values that pass: a form that no longer computes something is seen.
void VerifyTest::casesBesideTheProjectPass_data()
{
   QTest::addColumn<int>("pass");
   QTest::newRow("c01-single-bond") << 402;
   QTest::newRow("c01-bond-invariants") << 4;
   QTest::newRow("c02-cantilever-iso") << 96;
   QTest::newRow("c02-cantilever-aniso") << 96;
}

void VerifyTest::casesBesideTheProjectPass()
{
   DIATOM_NEEDS_SHARED();
   QFETCH(int, pass);
   const QString name = QString::fromUtf8(QTest::currentDataTag()) + ".json";
   const QStringList files = casesIn(test::sharedDir() / "validation", {name});
   QCOMPARE(files.size(), 1);
   const auto run = diatomRuns(QStringList{"verify", "--json"} + files);
   const QJsonObject report = run.object();
   QVERIFY2(run.exit == 0, qPrintable(failures(report).join('\n') + run.err));
   QVERIFY2(tally(report, "pass") >= pass, qPrintable(QString::number(tally(report, "pass"))));
   QCOMPARE(tally(report, "not_of_this_solver_yet"), 0);
}

void VerifyTest::laterFormsAreCountedApart()
{
   DIATOM_NEEDS_SHARED();
   const auto run =
       diatomRuns(QStringList{"verify", "--json"} +
                  casesIn(test::sharedDir() / "validation", {"c11-*.json", "c12-*.json", "c15-*.json"}));
   QCOMPARE(run.exit, 0);
   const QJsonObject report = run.object();
   QCOMPARE(report["cases"].toArray().size(), 4);
   QCOMPARE(tally(report, "pass"), 0);
   QVERIFY(tally(report, "not_of_this_solver_yet") > 50);
}

void VerifyTest::failuresSetTheExitCodeAndAreShown()
{
   QFile file(QString::fromStdString(
       (test::sourceDir() / "resources" / "verification" / "hanging-chain.json").string()));
   QVERIFY(file.open(QIODevice::ReadOnly));
   QJsonObject one = QJsonDocument::fromJson(file.readAll()).object();
   QJsonArray quantities = one["quantities"].toArray();
   QJsonObject first = quantities[0].toObject();
   first["expected"] = 1.0;
   quantities[0] = first;
   one["quantities"] = quantities;
   const QByteArray text = QJsonDocument(one).toJson();
   const auto run = diatomRuns({"verify", "-", "--summary"}, text);
   QCOMPARE(run.exit, 5);
   QVERIFY(run.out.contains("quantities.0.expected: computed"));
   QVERIFY(run.out.contains("FAIL"));
   QVERIFY(!run.out.contains("quantities.1.expected"));
   QVERIFY(diatomRuns({"verify", "-", "--markdown"}, text).out.contains("| FAIL |"));
}

void VerifyTest::formsAreListed()
{
   const auto run = diatomRuns({"verify", "--list", "--json"});
   QCOMPARE(run.exit, 0);
   QStringList later;
   for (const auto &row : run.json().array())
      if (row.toObject()["solver"] != "yes")
         later << row.toObject()["form"].toString();
   QCOMPARE(later,
            (QStringList{"circuits", "circuit-verdicts", "potential-field", "electromechanical-chain"}));
}

void VerifyTest::wrongCallsAreTold()
{
   QCOMPARE(diatomRuns({"verify"}).exit, 2);
   QCOMPARE(diatomRuns({"verify", "nowhere.json"}).exit, 3);
   const auto run = diatomRuns({"verify", "-"}, "{}");
   QCOMPARE(run.exit, 3);
   QVERIFY(run.err.contains("verification-cases.md"));
}

QTEST_APPLESS_MAIN(VerifyTest)
#include "verify_test.moc"
