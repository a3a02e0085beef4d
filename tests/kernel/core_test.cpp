// Files that are complete or absent, numbers as text, jobs, hashes.
#include "core/file.h"
#include "core/hash.h"
#include "core/index.h"
#include "core/text.h"
#include "support/support.h"

#include <csignal>
#include <limits>
#include <numeric>
#include <sys/resource.h>
#include <sys/stat.h>

using namespace diatom;
namespace fs = std::filesystem;

class CoreTest : public QObject
{
   Q_OBJECT
private slots:
   void init() { m_dir = std::make_unique<QTemporaryDir>(); }
   void aFileThatIsNotCommittedLeavesTheOldOne();
   void aFullDiskLeavesTheOldFileAndNoOther();
   void aMissingFolderIsASentence();
   void savingThroughALinkKeepsTheLink();
   void savingKeepsThePermissions();
   void largeFilesAreRefusedBeforeReading();
   void numbersBecomeTheShortestText();
   void fixedNumbersHaveNoNegativeZero();
   void onlyWholeNumbersParse();
   void piecesDependOnGrainAlone_data();
   void piecesDependOnGrainAlone();
   void hashesKeepBordersApart();
   void floorDivisionGoesDown();

private:
   fs::path file(const char *name) const { return fs::path(m_dir->path().toStdString()) / name; }
   std::size_t entries() const
   {
      return static_cast<std::size_t>(std::distance(fs::directory_iterator(m_dir->path().toStdString()), {}));
   }
   std::unique_ptr<QTemporaryDir> m_dir;
};

void CoreTest::aFileThatIsNotCommittedLeavesTheOldOne()
{
   DIATOM_VERIFY_OK(writeFileAtomic(file("a"), "old"));
   {
      AtomicFile half(file("a"));
      half.write("new, but nobody says commit");
   }
   QCOMPARE(*readFile(file("a")), std::string("old"));
   QCOMPARE(entries(), std::size_t{1});
}

void CoreTest::aFullDiskLeavesTheOldFileAndNoOther()
{
   DIATOM_VERIFY_OK(writeFileAtomic(file("a"), "old"));
   // A limit on the size of files is as good as a full disk: write() fails in the middle.
   std::signal(SIGXFSZ, SIG_IGN);
   rlimit before{};
   getrlimit(RLIMIT_FSIZE, &before);
   const rlimit small{1 << 16, before.rlim_max};
   setrlimit(RLIMIT_FSIZE, &small);
   const Status failed = writeFileAtomic(file("a"), std::string(1 << 20, 'x'));
   setrlimit(RLIMIT_FSIZE, &before);
   QVERIFY(!failed.ok());
   QVERIFY(failed.error().code == ErrorCode::unwritable);
   QVERIFY(failed.error().message.find(file("a").string()) != std::string::npos);
   QCOMPARE(*readFile(file("a")), std::string("old"));
   QCOMPARE(entries(), std::size_t{1});
}

void CoreTest::aMissingFolderIsASentence()
{
   const Status failed = writeFileAtomic(file("no/such/folder"), "x");
   QVERIFY(!failed.ok());
   QVERIFY(failed.error().message.find("No such file or directory") != std::string::npos);
   const auto unread = readFile(file("absent"));
   QVERIFY(!unread.ok());
   QVERIFY(unread.error().code == ErrorCode::unreadable);
   QVERIFY(!readFile(m_dir->path().toStdString()).ok()); // a folder
}

void CoreTest::savingThroughALinkKeepsTheLink()
{
   DIATOM_VERIFY_OK(writeFileAtomic(file("real"), "old"));
   fs::create_symlink(file("real"), file("link"));
   DIATOM_VERIFY_OK(writeFileAtomic(file("link"), "new"));
   QVERIFY(fs::is_symlink(file("link")));
   QCOMPARE(*readFile(file("real")), std::string("new"));
}

void CoreTest::savingKeepsThePermissions()
{
   DIATOM_VERIFY_OK(writeFileAtomic(file("a"), "old"));
   fs::permissions(file("a"), fs::perms::owner_read | fs::perms::owner_write);
   DIATOM_VERIFY_OK(writeFileAtomic(file("a"), "new"));
   QVERIFY(fs::status(file("a")).permissions() == (fs::perms::owner_read | fs::perms::owner_write));
}

void CoreTest::largeFilesAreRefusedBeforeReading()
{
   DIATOM_VERIFY_OK(writeFileAtomic(file("a"), "0123456789"));
   QVERIFY(readFile(file("a"), 10).ok());
   const auto refused = readFile(file("a"), 9);
   QVERIFY(!refused.ok());
   QVERIFY(refused.error().message.find("larger than the 9 bytes") != std::string::npos);
}

void CoreTest::numbersBecomeTheShortestText()
{
   QCOMPARE(numberText(0.1), std::string("0.1"));
   QCOMPARE(numberText(1e-9), std::string("1e-09"));
   QCOMPARE(numberText(3), std::string("3"));
   for (const double value : {1.0 / 3, 6.02e23, -0.0, 5e-324, 1.7976931348623157e308})
      QCOMPARE(*parseNumber(numberText(value)), value);
}

void CoreTest::fixedNumbersHaveNoNegativeZero()
{
   QCOMPARE(fixedText(-0.0004, 3), std::string("0.000"));
   QCOMPARE(fixedText(-0.0006, 3), std::string("-0.001"));
   QCOMPARE(fixedText(1234.5, 2), std::string("1234.50"));
}

void CoreTest::onlyWholeNumbersParse()
{
   QVERIFY(parseNumber("1.5"));
   for (const char *bad : {"", "1.5x", " 1", "1,5", "nan", "inf", "--1", "1e999"})
      QVERIFY2(!parseNumber(bad), bad);
   QVERIFY(parseInteger("-7") == -7);
   QVERIFY(!parseInteger("7.0"));
}

void CoreTest::piecesDependOnGrainAlone_data()
{
   QTest::addColumn<int>("threads");
   for (const int threads : {1, 2, 7})
      QTest::addRow("%d threads", threads) << threads;
}

void CoreTest::piecesDependOnGrainAlone()
{
   QFETCH(int, threads);
   Job job;
   job.setThreads(threads);
   std::vector<std::int64_t> ends(11, -1);
   std::vector<int> nested(11, 0);
   job.parallelFor(103, 10, [&](std::int64_t begin, std::int64_t end) {
      ends[static_cast<std::size_t>(begin / 10)] = end;
      job.parallelFor(4, 1,
                      [&](std::int64_t, std::int64_t) { ++nested[static_cast<std::size_t>(begin / 10)]; });
   });
   for (std::size_t piece = 0; piece < ends.size(); ++piece) {
      QCOMPARE(ends[piece], std::min<std::int64_t>(103, 10 * static_cast<std::int64_t>(piece) + 10));
      QCOMPARE(nested[piece], 4); // a nested call runs in place, whole
   }
}

void CoreTest::hashesKeepBordersApart()
{
   const auto hashOf = [](std::initializer_list<std::string_view> texts) {
      Hasher hasher;
      for (const std::string_view text : texts)
         hasher.add(text);
      return hasher.finish();
   };
   QVERIFY(hashOf({"ab", "c"}) == hashOf({"ab", "c"}));
   QVERIFY(hashOf({"ab", "c"}) != hashOf({"a", "bc"}));
   QCOMPARE(hashOf({}).text().size(), std::size_t{32});
}

void CoreTest::floorDivisionGoesDown()
{
   for (std::int32_t a = -9; a <= 9; ++a) {
      QCOMPARE(floorDiv(a, 4) * 4 + floorMod(a, 4), a);
      QVERIFY(floorMod(a, 4) >= 0 && floorMod(a, 4) < 4);
   }
}

QTEST_APPLESS_MAIN(CoreTest)
#include "core_test.moc"
