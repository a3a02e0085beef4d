// Cutting the cells of a scene: the same stuff, held, led and loaded alike; and what cannot be cut is
// refused.
#include "kernel/scene_workbench.h"
#include "scene/scene.h"
#include "study/refine.h"

#include <QTest>

#include <cmath>

using namespace diatom;
using test::Workbench;

namespace {

Workbench bar()
{
   Workbench bench;
   bench.block("plain", {{0, 0, 0}, {5, 0, 0}});
   bench.setup.supports = {{Index{0, 0, 0}, 0x3f}};
   bench.setup.loads = {{Index{5, 0, 0}, {0, 3, 0}, {}}, {Box{{1, 0, 0}, {2, 0, 0}}, {1, 0, 0}, {}}};
   return bench;
}

Result<RefinedScene> cut(const Workbench &bench, int times)
{
   return refineScene(std::make_shared<const Hierarchy>(bench.hierarchy()), bench.setup, *test::catalogue(),
                      times, bench.job);
}

double totalForce(const Scene &scene, std::size_t axis)
{
   double sum = 0;
   for (std::int64_t k = 0; k < scene.view().channels; ++k) {
      const diatom_channel &channel = scene.view().channel[k];
      for (std::int64_t row = 0; std::string_view(channel.name) == "force" && row < channel.count; ++row)
         sum += channel.values[6 * static_cast<std::size_t>(row) + axis];
   }
   return sum;
}

} // namespace

class StudyRefineTest : public QObject
{
   Q_OBJECT

private slots:
   void aCutSceneHasTheSameMassForcesAndPlace();
   void aResolutionOfOneIsTheSceneItself();
   void whatCannotBeCutIsRefusedWithTheReason();
};

void StudyRefineTest::aCutSceneHasTheSameMassForcesAndPlace()
{
   const Workbench bench = bar();
   const Hierarchy whole = bench.hierarchy();
   for (const int times : {2, 3}) {
      const auto fine = cut(bench, times);
      DIATOM_VERIFY_OK(fine);
      QCOMPARE(fine->hierarchy->cells(), whole.cells() * static_cast<std::uint64_t>(times * times * times));
      // Sums of a few hundred numbers.
      QVERIFY(std::abs(fine->hierarchy->mass().mass / whole.mass().mass - 1) < 1e-12);
      const auto scene = Scene::build(*fine->hierarchy, fine->setup, bench.job);
      DIATOM_VERIFY_OK(scene);
      QVERIFY(std::abs(totalForce(**scene, 1) - 3) < 1e-12);
      QVERIFY(std::abs(totalForce(**scene, 0) - 2) < 1e-12); // one newton on each of two cells
      QCOMPARE((*scene)->cellsIn(fine->setup.supports.front().where).size(),
               static_cast<std::size_t>(times * times * times));
   }
}

void StudyRefineTest::aResolutionOfOneIsTheSceneItself()
{
   const Workbench bench = bar();
   const auto same = cut(bench, 1);
   DIATOM_VERIFY_OK(same);
   QVERIFY(same->setup == bench.setup);
}

void StudyRefineTest::whatCannotBeCutIsRefusedWithTheReason()
{
   Workbench turned = bar();
   turned.setup.drives = {{Index{5, 0, 0}, 3, {{0, 0}, {1, 0.1}}}};
   Workbench wired = bar();
   wired.source({6, 0, 0});
   for (const Workbench &bench : {turned, wired}) {
      const auto fine = cut(bench, 2);
      QVERIFY(!fine);
      QVERIFY(fine.error().code == ErrorCode::unsupported);
   }
   QVERIFY(!cut(bar(), 0));
}

QTEST_APPLESS_MAIN(StudyRefineTest)
#include "study_refine_test.moc"
