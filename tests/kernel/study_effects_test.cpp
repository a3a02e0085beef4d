// What effects cost: one that is absent or switched off leaves every bit as it is. Times are told, not
// judged.
#include "scene/effects.h"
#include "study/effects_study.h"
#include "support/support.h"

#include <QTest>

#include <algorithm>

using namespace diatom;

class StudyEffectsTest : public QObject
{
   Q_OBJECT

private slots:
   void initTestCase();
   void effectsThatAreRuledOutOrAddNothingLeaveEveryBit();
   void everyEffectHasARow();
   void aDesignsOwnEffectsAreStudied();

private:
   EffectsStudy m_study;
};

void StudyEffectsTest::initTestCase()
{
   QVERIFY2(test::catalogue()->offer(DIATOM_SOLVER_1, Setup().solver), "the bond solver was not built");
   const Job job;
   EffectsRequest brief;
   brief.turns = 1;
   brief.turnSeconds = 2e-3;
   auto study = studyEffects(test::catalogue(), brief, job);
   DIATOM_VERIFY_OK(study);
   m_study = *std::move(study);
}

void StudyEffectsTest::effectsThatAreRuledOutOrAddNothingLeaveEveryBit()
{
   for (const EffectRow &row : m_study.rows) {
      if (row.ruledOut)
         QVERIFY2(row.ruledOut->sameBits, (row.effect + " switched off").c_str());
      if (row.forcedOn)
         QVERIFY2(row.forcedOn->sameBits, (row.effect + " switched on for nothing").c_str());
   }
}

void StudyEffectsTest::everyEffectHasARow()
{
   for (const std::string &name : effectNames())
      QVERIFY2(std::any_of(m_study.rows.begin(), m_study.rows.end(),
                           [&](const EffectRow &row) { return row.effect == name; }),
               name.c_str());
   const std::string csv = effectsCsv(m_study);
   QCOMPARE(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')), m_study.rows.size() + 1);
}

void StudyEffectsTest::aDesignsOwnEffectsAreStudied()
{
   Design design;
   Material stuff;
   stuff.id = "stuff";
   stuff.dampingRatio = 0.1;
   const auto index = design.model.setMaterial(stuff);
   DIATOM_VERIFY_OK(index);
   design.model.root.cells.fill({{0, 0, 0}, {5, 1, 1}}, Cell{*index, 0, 0});
   design.setup.supports = {{Index{0, 0, 0}, kAllFreedoms}};
   design.setup.gravity = {0, 0, -9.81};
   const Job job;
   EffectsRequest brief;
   brief.turns = 1;
   brief.turnSeconds = 1e-3;
   const auto study = studyEffectsOf(test::catalogue(), design, brief, job);
   DIATOM_VERIFY_OK(study);
   for (const char *name : {"damping", "gravity", "rotation"})
      QVERIFY2(std::any_of(study->rows.begin(), study->rows.end(),
                           [&](const EffectRow &row) { return row.effect == name && row.calledFor; }),
               name);
}

QTEST_APPLESS_MAIN(StudyEffectsTest)
#include "study_effects_test.moc"
