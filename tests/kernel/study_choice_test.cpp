// Settings chosen for an asked accuracy: that they meet it, that nothing tried is cheaper, and what is told.
#include "kernel/study_scene.h"
#include "study/accuracy_choice.h"

#include <QTest>

#include <algorithm>
#include <cmath>

using namespace diatom;
using test::cantilever;
using test::subjectOf;

namespace {

ChoiceRequest within(double error)
{
   ChoiceRequest request;
   request.until = 0.05;
   request.error = error;
   request.quantity = parseQuantity("0,11,0:z").value();
   request.budget = 0.5;
   return request;
}

} // namespace

class StudyChoiceTest : public QObject
{
   Q_OBJECT

private slots:
   void initTestCase();
   void theChosenSettingsMeetTheAskedError();
   void theChosenSettingsAreTheCheapestOfThoseThatMeetIt();
   void aTighterAskTakesAShorterStep();
   void whatIsFixedIsNotChosen();
   void anAskBeyondReasonIsRefusedWithTheReason();
   void aMissingCellIsRefused();
   void aCancelEndsTheSearch();
};

void StudyChoiceTest::initTestCase()
{
   QVERIFY2(test::catalogue()->offer(DIATOM_SOLVER_1, Setup().solver), "the bond solver was not built");
}

void StudyChoiceTest::theChosenSettingsMeetTheAskedError()
{
   const Subject subject = subjectOf(cantilever());
   const Job job;
   for (const double asked : {1e-2, 1e-3}) {
      const ChoiceRequest request = within(asked);
      const auto choice = chooseForAccuracy(subject, request, job);
      DIATOM_VERIFY_OK(choice);
      const SettingOption &best = choice->best();
      QVERIFY(best.step > 0);
      QVERIFY(best.error.how != Knowledge::unknown);
      const std::int64_t samples = 20;
      const auto perSample =
          static_cast<std::int64_t>(std::ceil(request.until / static_cast<double>(samples) / best.step));
      const auto run =
          runTrial(subject, best.values, *request.quantity, request.until, samples, perSample, job);
      // Fourth order at an eighth of the step: its own error is some 1e-6 of what is asked.
      const auto exact = runTrial(subject, {{"integrator", std::string("rk4")}}, *request.quantity,
                                  request.until, samples, 8 * perSample, job);
      DIATOM_VERIFY_OK(run);
      DIATOM_VERIFY_OK(exact);
      const double actual = largestDifference(run->curve, exact->curve, request.until) /
                            largestValue(exact->curve, request.until);
      qInfo("asked %.1e, told %.2e, actual %.2e: %s, step %.2e s", asked, best.error.value, actual,
            best.setting.c_str(), best.step);
      QVERIFY(actual <= asked);
   }
}

void StudyChoiceTest::theChosenSettingsAreTheCheapestOfThoseThatMeetIt()
{
   const Job job;
   const auto choice = chooseForAccuracy(subjectOf(cantilever()), within(1e-3), job);
   DIATOM_VERIFY_OK(choice);
   QVERIFY(choice->candidates.size() > 1);
   for (const SettingOption &one : choice->candidates) {
      if (one.step > 0)
         QVERIFY(one.seconds.value >= choice->best().seconds.value);
      else
         QVERIFY2(!one.note.empty(), one.setting.c_str());
   }
   QVERIFY(!choice->why.empty());
}

void StudyChoiceTest::aTighterAskTakesAShorterStep()
{
   const Job job;
   ChoiceRequest loose = within(1e-2), tight = within(1e-5);
   loose.fixed = tight.fixed = {{"integrator", std::string("verlet")}};
   const auto a = chooseForAccuracy(subjectOf(cantilever()), loose, job),
              b = chooseForAccuracy(subjectOf(cantilever()), tight, job);
   DIATOM_VERIFY_OK(a);
   DIATOM_VERIFY_OK(b);
   QVERIFY(b->best().step < a->best().step);
}

void StudyChoiceTest::whatIsFixedIsNotChosen()
{
   const Job job;
   ChoiceRequest request = within(1e-2);
   request.fixed = {{"integrator", std::string("rk4")}};
   const auto choice = chooseForAccuracy(subjectOf(cantilever()), request, job);
   DIATOM_VERIFY_OK(choice);
   for (const SettingOption &one : choice->candidates)
      QCOMPARE(std::get<std::string>(one.values.at("integrator")), std::string("rk4"));
}

void StudyChoiceTest::anAskBeyondReasonIsRefusedWithTheReason()
{
   const Job job;
   ChoiceRequest request = within(1e-14); // below what double precision holds over some thousand steps
   request.fixed = {{"integrator", std::string("semi_implicit")}};
   const auto choice = chooseForAccuracy(subjectOf(cantilever()), request, job);
   QVERIFY(!choice);
   QVERIFY(choice.error().code == ErrorCode::invalid);
   QVERIFY(choice.error().message.find("semi_implicit") != std::string::npos);
}

void StudyChoiceTest::aMissingCellIsRefused()
{
   const Job job;
   ChoiceRequest request = within(1e-2);
   request.quantity = parseQuantity("5,5,5:z").value();
   const auto choice = chooseForAccuracy(subjectOf(cantilever()), request, job);
   QVERIFY(!choice);
   QVERIFY(choice.error().code == ErrorCode::usage);
}

void StudyChoiceTest::aCancelEndsTheSearch()
{
   Job job;
   job.cancel();
   const auto choice = chooseForAccuracy(subjectOf(cantilever()), within(1e-2), job);
   QVERIFY(!choice);
   QVERIFY(choice.error().code == ErrorCode::cancelled);
}

QTEST_APPLESS_MAIN(StudyChoiceTest)
#include "study_choice_test.moc"
