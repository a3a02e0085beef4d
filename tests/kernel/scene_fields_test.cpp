// Fields and properties: inputs of solvers of other physics, from the file to what a solver is given.
#include "document/format.h"
#include "kernel/scene_workbench.h"
#include "scene/fields.h"
#include "scene/problems.h"
#include "scene/scene.h"
#include "support/support.h"

#include <cmath>
#include <string_view>

using namespace diatom;
using test::Workbench;

namespace {

Workbench row()
{
   Workbench bench;
   bench.put("plain", {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
   bench.setup.fields = {{Box{{0, 0, 0}, {1, 0, 0}}, "temperature", {300}},
                         {Index{1, 0, 0}, "temperature", {310}},
                         {Index{2, 0, 0}, "flux", {1, 2, 3}}};
   return bench;
}

const diatom_channel *channelOf(const Scene &scene, std::string_view name)
{
   for (std::int64_t k = 0; k < scene.view().channels; ++k)
      if (name == scene.view().channel[k].name)
         return &scene.view().channel[k];
   return nullptr;
}

/// The first problem's kind of a set-up with this one field more; "" without any.
std::string fault(const Field &field)
{
   Workbench bench = row();
   bench.setup.fields.push_back(field);
   const auto problems = findSetupProblems(bench.hierarchy(), bench.setup);
   return problems.empty() ? "" : problems.front().kind;
}

Material readBack(const char *text, ReadLog &log)
{
   const auto json = nlohmann::json::parse(text);
   return readMaterial(JsonPlace(json, log));
}

} // namespace

class SceneFieldsTest : public QObject
{
   Q_OBJECT
private slots:
   void everyEntryIsARowInOrder();
   void aFieldIsAnEffectThatCanBeSwitchedOff();
   void badFieldsAreToldWithTheirPlace();
   void propertiesAreColumnsWithGaps();
   void aPropertyMayNotHaveANameOfOurs();
   void fieldsAreWrittenAndReadBack();
};

void SceneFieldsTest::everyEntryIsARowInOrder()
{
   const Workbench bench = row();
   const auto scene = Scene::build(bench.hierarchy(), bench.setup, bench.job, Analysis::statics);
   DIATOM_VERIFY_OK(scene);
   const diatom_channel *temperature = channelOf(**scene, "temperature"), *flux = channelOf(**scene, "flux");
   QVERIFY(temperature && flux);
   QCOMPARE(temperature->count, std::int64_t{3});
   QCOMPARE(temperature->stride, std::int64_t{1});
   // Cell 1 has two rows, that of the later entry last.
   const std::int64_t where[] = {0, 1, 1};
   const double values[] = {300, 300, 310};
   QVERIFY(std::equal(where, where + 3, temperature->where) &&
           std::equal(values, values + 3, temperature->values));
   QCOMPARE(flux->stride, std::int64_t{3});
   QCOMPARE(flux->values[2], 3.0);
}

void SceneFieldsTest::aFieldIsAnEffectThatCanBeSwitchedOff()
{
   Workbench bench = row();
   bench.setup.effects["temperature"] = false;
   const auto scene = Scene::build(bench.hierarchy(), bench.setup, bench.job, Analysis::statics);
   DIATOM_VERIFY_OK(scene);
   QVERIFY(!channelOf(**scene, "temperature"));
   QVERIFY(channelOf(**scene, "flux"));
   for (const Effect &effect : (*scene)->effects())
      if (effect.name == "flux") {
         QVERIFY(effect.on && effectIsForSolver(effect.name) && !effectIsMechanical(effect.name));
         QCOMPARE(effect.why, std::string("one value is set on cell (2, 0, 0)"));
      }
   bench.setup.effects = {{"pressure", true}}; // neither an effect nor a field
   QVERIFY(!Scene::build(bench.hierarchy(), bench.setup, bench.job, Analysis::statics).ok());
}

void SceneFieldsTest::badFieldsAreToldWithTheirPlace()
{
   QCOMPARE(fault({Index{0, 0, 0}, "temperature", {1}}), std::string());
   QCOMPARE(fault({Index{0, 0, 0}, "temperature", {1, 2}}), std::string("bad-field")); // one value elsewhere
   QCOMPARE(fault({Index{0, 0, 0}, "heat", {}}), std::string("bad-field"));
   QCOMPARE(fault({Index{0, 0, 0}, "", {1}}), std::string("bad-field"));
   QCOMPARE(fault({Index{0, 0, 0}, "heat", {std::nan("")}}), std::string("bad-field"));
   for (const char *taken : {"fixed", "gravity", "poisson", "source"})
      QCOMPARE(fault({Index{0, 0, 0}, taken, {1}}), std::string("bad-field"));
   QCOMPARE(fault({Index{9, 9, 9}, "heat", {1}}), std::string("field-without-cell"));
}

void SceneFieldsTest::propertiesAreColumnsWithGaps()
{
   Workbench bench = row();
   Material copper = test::material("copper");
   copper.properties = {{"thermal_conductivity", 400}};
   bench.add(copper);
   bench.put("copper", {{3, 0, 0}});
   const auto scene = Scene::build(bench.hierarchy(), bench.setup, bench.job);
   DIATOM_VERIFY_OK(scene);
   const diatom_scene &view = (*scene)->view();
   QCOMPARE(std::string(view.property_name[view.properties - 1]), std::string("thermal_conductivity"));
   const auto last = [&](std::int64_t cell) {
      return view.property[(view.cell_material[cell] + std::int64_t{1}) * view.properties - 1];
   };
   QCOMPARE(last(3), 400.0);
   QVERIFY(std::isnan(last(0)));
   QCOMPARE(view.property[view.cell_material[3] * std::int64_t{view.properties}],
            copper.density); // still the first
}

void SceneFieldsTest::aPropertyMayNotHaveANameOfOurs()
{
   ReadLog good{"file", {}, nlohmann::json::object()}, bad = good;
   QCOMPARE(readBack(R"({"id": "a", "properties": {"heat": 2}})", good).properties.at("heat"), 2.0);
   QVERIFY(good.ok());
   readBack(R"({"id": "a", "properties": {"density": 2}})", bad);
   QVERIFY(!bad.ok() && bad.error->message.find("/properties/density") != std::string::npos);
}

void SceneFieldsTest::fieldsAreWrittenAndReadBack()
{
   Design design;
   const Workbench bench = row();
   design.model = bench.model;
   design.setup = bench.setup;
   const auto written = designJson(design, nullptr, bench.job);
   DIATOM_VERIFY_OK(written);
   ReadLog log{"file", {}, nlohmann::json::object()};
   const Design read = readDesignJson(nlohmann::json::parse(written->dump()), {}, log, bench.job);
   QVERIFY2(log.ok(), log.ok() ? "" : log.error->message.c_str());
   QVERIFY(log.unknown.empty());
   QVERIFY(read.setup == design.setup);
}

QTEST_APPLESS_MAIN(SceneFieldsTest)
#include "scene_fields_test.moc"
