// The planner on minimal scenes: each effect off without cause, on with it, and as the user forces it.
#include "kernel/scene_workbench.h"
#include "scene/effects.h"

#include <QTest>

#include <algorithm>
#include <functional>

using namespace diatom;
using test::Workbench;

namespace {

Effect effectOf(const Workbench &bench, const std::string &name)
{
   const Hierarchy hierarchy = bench.hierarchy();
   const auto effects = planEffects(hierarchy, bench.setup, findNetworks(hierarchy, bench.setup, bench.job));
   const auto found =
       std::find_if(effects.begin(), effects.end(), [&](const Effect &e) { return e.name == name; });
   if (found == effects.end())
      qFatal("no effect %s", name.c_str());
   return *found;
}

Workbench twoCells()
{
   Workbench bench;
   bench.put("plain", {{0, 0, 0}, {1, 0, 0}});
   return bench;
}

void addActuator(Workbench &bench)
{
   bench.put("piezo", {{1, 5, 0}});
   bench.put("wire", {{2, 5, 0}});
   bench.source({0, 5, 0});
   bench.source({3, 5, 0});
}

struct Cause
{
   const char *effect;
   std::function<void(Workbench &)> add;
};

std::vector<Cause> causes()
{
   return {{"damping",
            [](Workbench &bench) {
               Material damped = test::material("damped");
               damped.dampingRatio = 0.1;
               bench.add(damped);
               bench.put("damped", {{0, 1, 0}});
            }},
           {"gravity",
            [](Workbench &bench) {
               bench.setup.gravity = {0, 0, -9.8};
            }},
           {"actuation", addActuator},
           {"ground", [](Workbench &bench) { bench.setup.ground.present = true; }},
           {"friction", [](Workbench &bench) { bench.setup.ground.present = true; }},
           {"drag", [](Workbench &bench) { bench.setup.drag = 2; }},
           {"loads",
            [](Workbench &bench) {
               bench.setup.loads.push_back({Index{0, 0, 0}, {1, 0, 0}, {}});
            }},
           {"orientation", [](Workbench &bench) {
               Material hinge = test::material("hinge");
               hinge.bonds = BondConstants{{80, 80, 80},
                                           {{{0, 80, 80}, {80, 0, 80}, {80, 80, 0}}},
                                           {8e-4, 8e-4, 2e-5},
                                           {8e-4, 8e-4, 8e-4}};
               bench.add(hinge);
               bench.put("hinge", {{0, 1, 0}});
            }}};
}

} // namespace

class SceneEffectsTest : public QObject
{
   Q_OBJECT

private slots:
   void aBareSceneCallsForRotationOnly();
   void eachCauseSwitchesItsEffectOn();
   void anUnusedMaterialIsNoCause();
   void frictionNeedsARoughGround();
   void silentOrUnwiredActuatorsDoNotActuate();
   void theUserMaySwitchOffWhatTheSceneCallsFor();
   void theUserMaySwitchOnWhatContributesNothing();
   void whatThisVersionCannotDoIsNeverOn();
};

void SceneEffectsTest::aBareSceneCallsForRotationOnly()
{
   const Workbench bench = twoCells();
   for (const std::string &name : effectNames()) {
      const Effect effect = effectOf(bench, name);
      QCOMPARE(effect.on, name == "rotation");
      QVERIFY(!effect.why.empty());
      QVERIFY(!effect.forced);
   }
   Workbench single;
   single.put("plain", {{0, 0, 0}});
   QVERIFY(!effectOf(single, "rotation").on);
}

void SceneEffectsTest::eachCauseSwitchesItsEffectOn()
{
   for (const Cause &cause : causes()) {
      Workbench bench = twoCells();
      QVERIFY(!effectOf(bench, cause.effect).on);
      cause.add(bench);
      const Effect effect = effectOf(bench, cause.effect);
      QVERIFY2(effect.on, cause.effect);
      for (const Index cell : effect.evidence)
         QVERIFY(!bench.model.root.cells.at(cell).empty());
   }
   Workbench bench = twoCells();
   addActuator(bench);
   QCOMPARE(effectOf(bench, "actuation").evidence, (std::vector<Index>{{1, 5, 0}}));
}

void SceneEffectsTest::anUnusedMaterialIsNoCause()
{
   Workbench bench = twoCells();
   Material damped = test::material("damped");
   damped.dampingRatio = 0.1;
   bench.add(damped);
   QVERIFY(!effectOf(bench, "damping").on);
   QVERIFY(!effectOf(bench, "actuation").on);
}

void SceneEffectsTest::frictionNeedsARoughGround()
{
   Workbench bench = twoCells();
   bench.setup.ground.present = true;
   bench.setup.ground.friction = 0;
   QVERIFY(effectOf(bench, "ground").on);
   QVERIFY(!effectOf(bench, "friction").on);
   bench.setup.ground.friction = 0.5;
   bench.setup.effects["ground"] = false;
   QVERIFY(!effectOf(bench, "friction").on);
}

void SceneEffectsTest::silentOrUnwiredActuatorsDoNotActuate()
{
   Workbench silent = twoCells();
   addActuator(silent);
   for (Source &source : silent.setup.sources)
      source.amplitude = 0;
   QVERIFY(!effectOf(silent, "actuation").on);
   Workbench unwired = twoCells();
   unwired.put("piezo", {{5, 5, 5}});
   const Effect effect = effectOf(unwired, "actuation");
   QVERIFY(!effect.on);
   QCOMPARE(effect.evidence, (std::vector<Index>{{5, 5, 5}}));
}

void SceneEffectsTest::theUserMaySwitchOffWhatTheSceneCallsFor()
{
   for (const Cause &cause : causes()) {
      Workbench bench = twoCells();
      cause.add(bench);
      bench.setup.effects[cause.effect] = false;
      const Effect effect = effectOf(bench, cause.effect);
      QVERIFY2(!effect.on && effect.forced, cause.effect);
   }
}

void SceneEffectsTest::theUserMaySwitchOnWhatContributesNothing()
{
   for (const char *name : {"damping", "gravity", "actuation", "drag", "loads"}) {
      Workbench bench = twoCells();
      bench.setup.effects[name] = true;
      const Effect effect = effectOf(bench, name);
      QVERIFY2(effect.on && effect.forced, name);
   }
   for (const char *name : {"ground", "friction"}) { // there is no plane to act on
      Workbench bench = twoCells();
      bench.setup.effects[name] = true;
      QVERIFY2(!effectOf(bench, name).on, name);
   }
}

void SceneEffectsTest::whatThisVersionCannotDoIsNeverOn()
{
   for (const char *name : {"electronics", "self-contact", "potential-field"}) {
      Workbench bench = twoCells();
      addActuator(bench);
      bench.setup.effects[name] = true;
      const Effect effect = effectOf(bench, name);
      QVERIFY2(!effect.on && effect.forced, name);
      QVERIFY2(effect.why.find("not available in this version") != std::string::npos, effect.why.c_str());
   }
}

QTEST_APPLESS_MAIN(SceneEffectsTest)
#include "scene_effects_test.moc"
