// What a plugin warns of in a call that succeeds reaches the user once; what it says of a call that fails is
// in the error.
#include "support/support.h"

#include "plugins/instance.h"
#include "plugins/warnings.h"

#include <thread>

using namespace diatom;

namespace {

Status say(const char *text, std::int32_t level, std::int32_t status)
{
   return guardedCall("someone", "step", Job(), [=](const diatom_call *call) {
      call->report(call, level, text);
      return status;
   });
}

} // namespace

class PluginRemarksTest : public QObject
{
   Q_OBJECT
private slots:
   void init();
   void cleanup() { setPluginWarnings({}); }
   void aWarningOfSuccessIsTold();
   void whatIsNoWarningIsNot();
   void aMutedOneIsNotTold();
   void anotherThreadsIsTold();
   void failuresTellInTheirError();

private:
   std::vector<std::pair<std::string, PluginWarning>> m_told;
};

void PluginRemarksTest::init()
{
   m_told.clear();
   setPluginWarnings(
       [this](const std::string &sentence, PluginWarning kind) { m_told.emplace_back(sentence, kind); });
}

void PluginRemarksTest::aWarningOfSuccessIsTold()
{
   for (int i = 0; i < 3; ++i)
      DIATOM_VERIFY_OK(say("the ice is thin", DIATOM_WARNING, DIATOM_OK));
   QCOMPARE(m_told.size(), std::size_t(1)); // thousands of steps may say it
   QCOMPARE(m_told[0].first, std::string("someone: the ice is thin"));
   QVERIFY(m_told[0].second == PluginWarning::remark);
}

void PluginRemarksTest::whatIsNoWarningIsNot()
{
   DIATOM_VERIFY_OK(say("stepping along", DIATOM_INFO, DIATOM_OK));
   DIATOM_VERIFY_OK(say("kept for the error that the host makes of the result", DIATOM_ERROR, DIATOM_OK));
   QVERIFY(m_told.empty());
}

void PluginRemarksTest::aMutedOneIsNotTold()
{
   {
      const RemarksMuted muted;
      DIATOM_VERIFY_OK(say("the ice is thin", DIATOM_WARNING, DIATOM_OK));
      QVERIFY(m_told.empty());
      warnOfPlugin("someone changed the locale");
      QCOMPARE(m_told.size(), std::size_t(1));
   }
   DIATOM_VERIFY_OK(say("the ice is thin", DIATOM_WARNING, DIATOM_OK));
   QCOMPARE(m_told.size(), std::size_t(2));
}

/// The studio tries settings in the background while a run plays.
void PluginRemarksTest::anotherThreadsIsTold()
{
   const RemarksMuted muted;
   std::thread([] { (void)say("the ice is thin", DIATOM_WARNING, DIATOM_OK); }).join();
   QCOMPARE(m_told.size(), std::size_t(1));
}

void PluginRemarksTest::failuresTellInTheirError()
{
   const Status failed = say("the ice broke", DIATOM_WARNING, DIATOM_BAD_INPUT);
   QVERIFY(!failed);
   QCOMPARE(failed.error().message, std::string("someone (step): the ice broke"));
   QVERIFY(m_told.empty());
}

QTEST_APPLESS_MAIN(PluginRemarksTest)
#include "plugin_remarks_test.moc"
