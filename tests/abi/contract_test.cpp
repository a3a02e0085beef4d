// The C contract stays as released: headers that compile alone, the list of each release, the debug data of
// the anchor library, files that never change. And each of these checks can fail: headers broken on purpose
// are caught by name.
#include "abi/contract.h"

#include "core/file.h"

#include <QCryptographicHash>
#include <QStandardPaths>

using namespace diatom;
using namespace diatom::test::abi;
namespace fs = std::filesystem;

namespace {

/// Compiled against `include`, every list there is: one for each release.
QString freezeFaults(const fs::path &include, const Compiler &compiler)
{
   QString faults;
   int lists = 0;
   for (const auto &entry : fs::directory_iterator(abiDir()))
      if (entry.path().filename().string().starts_with("freeze_") && entry.path().extension() == ".c") {
         faults += freezeFault(include, compiler, entry.path());
         ++lists;
      }
   return lists > 0 ? faults : "there are no lists";
}

/// The snapshot of the newest release.
fs::path newestSnapshot() { return abiDir() / "snapshot_1_0.abi"; }

QString standardsFault(const fs::path &include, const Compiler &compiler)
{
   QString fault;
   for (const char *standard : {"c11", "c++17", "c++20"})
      fault += headersFault(include, compiler, standard, headerNames(include));
   return fault;
}

/// Files of releases that are there with other bytes, or not there, as `list` has them: "sha256  path".
QStringList changedFiles(const fs::path &root, const QByteArray &list)
{
   QStringList changed;
   for (const QByteArray &line : list.split('\n')) {
      if (line.isEmpty())
         continue;
      const QString name = QString::fromUtf8(line.mid(66));
      QFile file(text(root) + "/" + name);
      const bool same =
          file.open(QIODevice::ReadOnly) &&
          QCryptographicHash::hash(file.readAll(), QCryptographicHash::Sha256).toHex() == line.left(64);
      if (!same)
         changed << name;
   }
   return changed;
}

bool hasAbidiff() { return !QStandardPaths::findExecutable("abidiff").isEmpty(); }

} // namespace

class ContractTest : public QObject
{
   Q_OBJECT
private slots:
   void headersCompileAlone_data() { compilerRows(); }
   void headersCompileAlone();
   void listsOfReleasesHold_data() { compilerRows(); }
   void listsOfReleasesHold();
   void snapshotHolds_data() { compilerRows(); }
   void snapshotHolds();
   void releasedFilesAreAsReleased();
   void everyTypeIsInTheListAndTheAnchor();
   void aBrokenContractIsCaughtByName_data();
   void aBrokenContractIsCaughtByName();
   void whatMayGrowMayGrow();
   void aSecondExportIsCaught();
   void aChangedReleaseFileIsCaught();

private:
   static void compilerRows()
   {
      QTest::addColumn<int>("compiler");
      const auto all = compilers();
      for (std::size_t i = 0; i < all.size(); ++i)
         QTest::newRow(qPrintable(all[i].name)) << static_cast<int>(i);
   }
};

void ContractTest::headersCompileAlone()
{
   QFETCH(int, compiler);
   const Compiler with = compilers()[static_cast<std::size_t>(compiler)];
   QVERIFY(headerNames(currentHeaders()).size() >= 5);
   QCOMPARE(standardsFault(currentHeaders(), with), QString());
}

void ContractTest::listsOfReleasesHold()
{
   QFETCH(int, compiler);
   QCOMPARE(freezeFaults(currentHeaders(), compilers()[static_cast<std::size_t>(compiler)]), QString());
}

void ContractTest::snapshotHolds()
{
   if (!hasAbidiff())
      QSKIP("abidiff (abigail-tools) is not installed");
   QFETCH(int, compiler);
   const QString fault =
       snapshotFault(currentHeaders(), compilers()[static_cast<std::size_t>(compiler)], newestSnapshot());
   QVERIFY2(fault.isEmpty(), qPrintable("A minor release that adds to the contract stores a new snapshot "
                                        "(tests/abi/take_snapshot); nothing else may change it.\n" +
                                        fault));
}

void ContractTest::releasedFilesAreAsReleased()
{
   const auto list = readFile(abiDir() / "frozen.sha256");
   DIATOM_VERIFY_OK(list);
   QVERIFY(!list->empty());
   QCOMPARE(changedFiles(abiDir(), QByteArray::fromStdString(*list)), QStringList());
}

void ContractTest::everyTypeIsInTheListAndTheAnchor()
{
   const auto list = readFile(abiDir() / "freeze_1_0.c"), anchor = readFile(abiDir() / "anchor.c");
   DIATOM_VERIFY_OK(list);
   DIATOM_VERIFY_OK(anchor);
   int types = 0;
   for (const QString &header : headerNames(currentHeaders()))
      for (const QString &type : structsOf(currentHeaders(), header)) {
         const bool listed = list->find("(" + type.toStdString() + ",") != std::string::npos;
         const bool anchored = anchor->find("(" + type.toStdString() + ")") != std::string::npos;
         QVERIFY2(listed && anchored, qPrintable(type));
         ++types;
      }
   QVERIFY(types >= 26); // as many as release 1.0 has
}

/// What is done to a copy of the headers, which check must see it, and the words it must say.
void ContractTest::aBrokenContractIsCaughtByName_data()
{
   QTest::addColumn<QString>("header");
   QTest::addColumn<QString>("from");
   QTest::addColumn<QString>("to");
   QTest::addColumn<QString>("list");     // what the list of the release says; "" = it is blind to this
   QTest::addColumn<QString>("snapshot"); // what abidiff says; "" = blind
   QTest::addColumn<QString>("alone");    // what the headers alone say; "" = they compile
   const auto row = [](const char *name, const char *header, const char *from, const char *to,
                       const char *list, const char *snapshot, const char *alone = "") {
      QTest::newRow(name) << header << from << to << list << snapshot << alone;
   };
   row("a field in the middle", "lattice", "const double *offset; ",
       "int64_t inserted; const double *offset;", "diatom_motif.offset has moved",
       "'int64_t inserted', at offset");
   row("two fields of one type change places", "solver", "double bytes;\n   double step_seconds;",
       "double step_seconds;\n   double bytes;", "diatom_estimate.bytes has moved", "step_seconds");
   row("a field of another type", "solver", "double tolerance;", "int64_t tolerance;",
       "diatom_step_request.tolerance has another type", "'double tolerance' changed");
   row("a field that is no longer constant", "parts", "const int32_t *share;", "int32_t *share;",
       "diatom_catalogue.share has another type", "");
   row("a field removed at the end", "machine", "const char *suffix;", "", "suffix", "const char* suffix");
   row("a changed parameter", "solver", "int64_t output, int64_t first", "int64_t output, int32_t first",
       "diatom_solver.read has another type", "parameter 4 of type");
   row("an added parameter", "lattice", "const diatom_motif **motif);",
       "const diatom_motif **motif, int32_t);", "diatom_lattice.motif has another type", "motif");
   row("another type of answer", "core", "int32_t (*cancelled)", "int64_t (*cancelled)",
       "diatom_call.cancelled has another type", "cancelled");
   row("a function removed", "machine",
       "int32_t (*describe)(void *self, const diatom_call *call,\n                       const "
       "diatom_machine_description **machine);",
       "", "describe", "describe");
   row("a function added to a table", "lattice", "void (*destroy)(void *self); ",
       "void (*destroy)(void *self); void (*more)(void *self);", "diatom_lattice has another size", "more");
   row("a status that means something else", "core", "DIATOM_CANCELLED 1", "DIATOM_CANCELLED 9",
       "DIATOM_CANCELLED has another value", "");
   row("two statuses change places", "core", "DIATOM_OK 0\n#define DIATOM_CANCELLED 1",
       "DIATOM_OK 1\n#define DIATOM_CANCELLED 0", "DIATOM_OK has another value", "");
   row("a constant removed", "machine", "#define DIATOM_OP_PAUSE 7", "#define DIATOM_OP_WAIT 7",
       "DIATOM_OP_PAUSE", "");
   row("another text of an id", "parts", "DIATOM_PARTS_1 \"diatom.parts/1\"",
       "DIATOM_PARTS_1 \"diatom.parts/2\"", "DIATOM_PARTS_1 has another text", "");
   row("hidden padding", "solver", "int64_t iterations;", "int32_t more; int64_t iterations;",
       "diatom_step_result.iterations has moved", "'int32_t more'", "iterations");
   row("a header that needs another", "lattice", "#include \"core.h\"", "", "", "", "unknown type name");
   row("what C11 has not", "core", "int32_t (*cancelled)", "bool (*cancelled)", "bool", "bool", "bool");
}

void ContractTest::aBrokenContractIsCaughtByName()
{
   QFETCH(QString, header);
   QFETCH(QString, from);
   QFETCH(QString, to);
   QFETCH(QString, list);
   QFETCH(QString, snapshot);
   QFETCH(QString, alone);
   const QTemporaryDir folder;
   const fs::path include = folder.path().toStdString();
   fs::copy(currentHeaders(), include, fs::copy_options::recursive);
   const fs::path broken = include / "diatom/abi" / (header.toStdString() + ".h");
   std::string source = *readFile(broken);
   const std::size_t at = source.find(from.toStdString());
   QVERIFY2(at != std::string::npos, "the test looks for text that the header no longer has");
   source.replace(at, std::size_t(from.size()), to.toStdString());
   DIATOM_VERIFY_OK(writeFileAtomic(broken, source));

   // Blind where nothing is expected: said too, so that the table tells what each check is good for.
   const auto says = [](const QString &fault, const QString &expected) {
      return expected.isEmpty() ? fault.isEmpty() : fault.contains(expected);
   };
   for (const Compiler &compiler : compilers()) {
      const QString listed = freezeFaults(include, compiler);
      QVERIFY2(says(listed, list), qPrintable(compiler.name + ", list: " + listed));
      const QString headers = headersFault(include, compiler, "c11", {header});
      QVERIFY2(says(headers, alone), qPrintable(compiler.name + ", headers alone: " + headers));
   }
   if (hasAbidiff()) {
      const QString seen = snapshotFault(include, compilers().front(), newestSnapshot());
      QVERIFY2(says(seen, snapshot), qPrintable("snapshot: " + seen));
   }
   QVERIFY(!list.isEmpty() || !snapshot.isEmpty() || !alone.isEmpty());
}

/// A field at the end of a record and a new constant are what a minor release may add: the list lets them
/// pass; abidiff tells of the field, so that the snapshot is renewed.
void ContractTest::whatMayGrowMayGrow()
{
   const QTemporaryDir folder;
   const fs::path include = folder.path().toStdString();
   fs::copy(currentHeaders(), include, fs::copy_options::recursive);
   const fs::path grown = include / "diatom/abi/lattice.h";
   std::string source = *readFile(grown);
   const std::string last = "} diatom_motif;";
   source.replace(source.find(last), last.size(),
                  "const double *grown;\n} diatom_motif;\n#define DIATOM_CONTACT_NEW 3");
   DIATOM_VERIFY_OK(writeFileAtomic(grown, source));
   for (const Compiler &compiler : compilers()) {
      QCOMPARE(freezeFaults(include, compiler), QString());
      QCOMPARE(standardsFault(include, compiler), QString());
      if (hasAbidiff())
         QVERIFY(snapshotFault(include, compiler, newestSnapshot()).contains("grown"));
   }
}

void ContractTest::aSecondExportIsCaught()
{
   if (QStandardPaths::findExecutable("nm").isEmpty())
      QSKIP("nm (binutils) is not installed");
   const QTemporaryDir folder;
   const QString library = folder.filePath("two.so");
   const test::Outcome built =
       test::run(compilers().front().c, {"-shared", "-fPIC", "-x", "c", "-", "-o", library},
                 "int diatom_module_v1 = 1; int leaked_helper(void) { return 2; }\n");
   QCOMPARE(complaint(built), QString());
   const QString fault = exportsFault(library.toStdString());
   QVERIFY2(fault.contains("leaked_helper"), qPrintable(fault));
}

void ContractTest::aChangedReleaseFileIsCaught()
{
   const QTemporaryDir folder;
   const fs::path copy = folder.path().toStdString();
   fs::copy(abiDir(), copy, fs::copy_options::recursive);
   const QByteArray list = QByteArray::fromStdString(*readFile(abiDir() / "frozen.sha256"));
   QCOMPARE(changedFiles(copy, list), QStringList());
   std::string source = *readFile(copy / "freeze_1_0.c");
   source.erase(source.find("AT(diatom_motif, offset"),
                source.find("AT(diatom_motif, orientation") - source.find("AT(diatom_motif, offset"));
   DIATOM_VERIFY_OK(writeFileAtomic(copy / "freeze_1_0.c", source));
   QCOMPARE(changedFiles(copy, list), QStringList{"freeze_1_0.c"});
   fs::remove(copy / "freeze_1_0.c");
   QCOMPARE(changedFiles(copy, list), QStringList{"freeze_1_0.c"});
}

QTEST_APPLESS_MAIN(ContractTest)
#include "contract_test.moc"
