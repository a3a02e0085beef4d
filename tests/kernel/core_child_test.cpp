// Work in a child process: its result and progress arrive, and its faults are told.
#include "core/child.h"
#include "core/sanitizers.h"
#include "support/support.h"

#include <csignal>
#include <limits>
#include <unistd.h>
#include <vector>

using namespace diatom;

class CoreChildTest : public QObject
{
   Q_OBJECT
private slots:
   void resultsArriveWhole()
   {
      for (const std::size_t size : {0, 1, 70'000, 3'000'000}) {
         std::string sent(size, '\0');
         for (std::size_t k = 0; k < size; ++k)
            sent[k] = static_cast<char>(k % 256);
         const auto got = runInChild([&](const ChildProgress &) { return sent; }, 60, "sending", Job());
         DIATOM_VERIFY_OK(got);
         QVERIFY(*got == sent);
      }
   }

   void progressIsToldOnceAPercent()
   {
      if (!kMayFork)
         QSKIP("the thread sanitizer allows no child, and work in place tells every step itself");
      std::vector<double> told;
      const Job job([&](double fraction, std::string_view what) {
         QCOMPARE(what, std::string_view("counting"));
         told.push_back(fraction);
      });
      const auto got = runInChild(
          [](const ChildProgress &progress) {
             for (int k = 0; k <= 10'000; ++k)
                progress(k / 10'000.0);
             progress(-1); // nothing of these is news
             progress(0.5);
             progress(std::numeric_limits<double>::quiet_NaN());
             progress(7);
             return std::string("\xff done");
          },
          60, "counting", job);
      DIATOM_VERIFY_OK(got);
      QCOMPARE(*got, std::string("\xff done"));
      QCOMPARE(told.size(), std::size_t(101));
      for (std::size_t k = 0; k < told.size(); ++k)
         QVERIFY(std::abs(told[k] - static_cast<double>(k) / 100) < 1e-12); // the same division
   }

   void aCrashCostsAMessage()
   {
      if (!kMayFork)
         QSKIP("the thread sanitizer allows no child");
      const auto crashed = runInChild(
          [](const ChildProgress &) -> std::string {
             std::signal(SIGSEGV, SIG_DFL);
             std::raise(SIGSEGV);
             return "not reached";
          },
          60, "crashing", Job());
      QVERIFY(!crashed);
      QVERIFY2(crashed.error().message.find("crash") != std::string::npos, crashed.error().message.c_str());
      const auto left =
          runInChild([](const ChildProgress &) -> std::string { _exit(0); }, 60, "leaving", Job());
      QVERIFY(!left);
      QCOMPARE(left.error().message, std::string("it ended before it was done"));
   }

   void hangingWorkIsEnded()
   {
      if (!kMayFork)
         QSKIP("the thread sanitizer allows no child");
      const auto hang = [](const ChildProgress &) -> std::string {
         for (;;)
            pause();
      };
      const auto late = runInChild(hang, 0.2, "hanging", Job());
      QVERIFY(!late);
      QVERIFY(late.error().code == ErrorCode::timeLimit);
      Job cancelled;
      cancelled.cancel();
      const auto stopped = runInChild(hang, 60, "hanging", cancelled);
      QVERIFY(!stopped);
      QVERIFY(stopped.error().code == ErrorCode::cancelled);
   }
};

QTEST_APPLESS_MAIN(CoreChildTest)
#include "core_child_test.moc"
