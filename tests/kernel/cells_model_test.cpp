// Instances against a plain set, and the model's palette, definitions and hash.
#include "cells/model.h"
#include "support/support.h"

#include <random>
#include <set>

using namespace diatom;

namespace {

Hash hashOf(const Instances &instances)
{
   Hasher hasher;
   instances.hash(hasher);
   return hasher.finish();
}

Definition composite(const std::string &id, const std::vector<DefinitionId> &children = {})
{
   Definition definition;
   definition.id = id;
   definition.body.cells.set({0, 0, 0}, {1});
   std::int32_t x = 10;
   for (const DefinitionId child : children)
      definition.body.instances.insert({child, {x += 10, 0, 0}, 0});
   return definition;
}

} // namespace

class CellsModelTest : public QObject
{
   Q_OBJECT

private slots:
   void keepsInstancesAsASetOverRandomEditsAndEveryVersion()
   {
      std::mt19937 random(4);
      Instances instances;
      std::set<Placement> plain;
      std::vector<std::pair<Instances, std::set<Placement>>> versions;
      const auto coordinate = [&] { return static_cast<std::int32_t>(random() % 41) - 20; };
      for (int step = 0; step < 20000; ++step) {
         const Placement p{static_cast<DefinitionId>(1 + random() % 3),
                           {coordinate(), coordinate(), coordinate() / 10},
                           static_cast<std::uint8_t>(random() % 2)};
         // Grows to thousands, then shrinks again, so that chunks split and join.
         const bool insert = random() % 10 < (step < 12000 ? 8U : 3U);
         if (insert)
            QCOMPARE(instances.insert(p), plain.insert(p).second);
         else if (step < 12000 || plain.empty())
            QCOMPARE(instances.erase(p), plain.erase(p) == 1);
         else {
            QVERIFY(instances.erase(*plain.begin()));
            plain.erase(plain.begin());
         }
         QCOMPARE(instances.count(), std::uint64_t{plain.size()});
         if (step % 2000 == 0)
            versions.emplace_back(instances, plain);
      }
      versions.emplace_back(instances, plain);
      for (const auto &[kept, expected] : versions) {
         std::set<Placement> seen;
         kept.visit([&](const Placement &p) { return seen.insert(p).second; });
         QVERIFY(seen == expected);
         std::map<DefinitionId, std::uint64_t> counts;
         Instances afresh;
         for (const Placement &p : expected) {
            QVERIFY(kept.contains(p));
            ++counts[p.definition];
            afresh.insert(p);
         }
         const auto byDefinition = kept.countByDefinition();
         QVERIFY((std::map<DefinitionId, std::uint64_t>(byDefinition.begin(), byDefinition.end())) == counts);
         // Content, not history, decides equality, order and hash.
         QVERIFY(afresh == kept);
         QCOMPARE(hashOf(afresh).text(), hashOf(kept).text());
         afresh.insert({9, {0, 0, 0}, 0});
         QVERIFY(!(afresh == kept));
      }
   }
   void ordersInstancesAlongASpaceFillingCurve()
   {
      Instances instances;
      for (std::int32_t x = -32; x < 32; ++x)
         for (std::int32_t y = -32; y < 32; ++y)
            instances.insert({1, {x, y, 0}, 0});
      double area = 0;
      for (const auto &chunk : instances.chunks()) {
         Box box;
         for (const Placement &p : *chunk)
            box.extend(p.origin);
         area += box.volume();
      }
      // Compact chunks hardly overlap; rows sorted by x would overlap in nothing, shuffled ones 16-fold.
      QVERIFY2(area < 3.0 * 64 * 64, qPrintable(QString::number(area)));
   }
   void refusesCompositesThatWouldContainThemselvesAndNamesTheChain()
   {
      Model model;
      const auto c = model.setDefinition(composite("c"));
      DIATOM_VERIFY_OK(c);
      const auto b = model.setDefinition(composite("b", {*c}));
      DIATOM_VERIFY_OK(b);
      const auto a = model.setDefinition(composite("a", {*b}));
      DIATOM_VERIFY_OK(a);
      const Model before = model;
      const auto cycle = model.setDefinition(composite("c", {*a}));
      QVERIFY(!cycle.ok());
      QVERIFY2(cycle.error().message.find("c > a > b > c") != std::string::npos,
               cycle.error().message.c_str());
      const auto self = model.setDefinition(composite("a", {*a}));
      QVERIFY(!self.ok());
      QVERIFY(self.error().message.find("a > a") != std::string::npos);
      QVERIFY(!model.setDefinition(composite("d", {99})).ok());
      QVERIFY(!model.setDefinition(composite("")).ok());
      QVERIFY(model == before);
      // Replacing keeps the number, so that instances follow.
      const auto again = model.setDefinition(composite("b"));
      DIATOM_VERIFY_OK(again);
      QCOMPARE(*again, *b);
   }
   void refusesToRemoveACompositeThatIsInUse()
   {
      Model model;
      const auto b = model.setDefinition(composite("b"));
      const auto a = model.setDefinition(composite("a", {*b}));
      model.root.instances.insert({*a, {0, 0, 0}, 0});
      QVERIFY(!model.eraseDefinition(*b).ok());
      QVERIFY(!model.eraseDefinition(*a).ok());
      QVERIFY(!model.eraseDefinition(77).ok());
      model.root.instances.erase({*a, {0, 0, 0}, 0});
      DIATOM_VERIFY_OK(model.eraseDefinition(*a));
      DIATOM_VERIFY_OK(model.eraseDefinition(*b));
      QVERIFY(model.definitions.empty());
   }
   void findsAndReplacesMaterialsById()
   {
      Model model;
      Material steel;
      steel.id = "steel";
      Material brass;
      brass.id = "brass";
      QCOMPARE(int(*model.setMaterial(steel)), 1);
      QCOMPARE(int(*model.setMaterial(brass)), 2);
      const Model before = model;
      steel.density = 7850;
      QCOMPARE(int(*model.setMaterial(steel)), 1);
      QCOMPARE(model.material(MaterialIndex{1}).density, 7850.0);
      QCOMPARE(before.material(MaterialIndex{1}).density, 1000.0);
      QCOMPARE(int(model.material("brass")), 2);
      QCOMPARE(int(model.material("lead")), 0);
      QCOMPARE(int(model.material("")), 0);
      QVERIFY(!model.setMaterial(Material()).ok());
   }
   void refusesMoreMaterialsThanACellCanName()
   {
      Model model;
      std::vector<Material> many(65535);
      for (std::size_t n = 0; n < many.size(); ++n)
         many[n].id = "m" + std::to_string(n);
      model.materials = std::make_shared<const std::vector<Material>>(many);
      Material one;
      one.id = "one-more";
      QVERIFY(!model.setMaterial(one).ok());
      one.id = "m7";
      QCOMPARE(int(*model.setMaterial(one)), 8);
   }
   void hashesTheSameWhateverTheNumbersOfDefinitions()
   {
      Model one, two;
      const auto build = [](Model &model, const std::vector<std::string> &order) {
         for (const std::string &id : order)
            QVERIFY(model.setDefinition(composite(id)).ok());
         QVERIFY(
             model.setDefinition(composite("outer", {model.definition("p"), model.definition("q")})).ok());
         for (const char *id : {"p", "q", "outer"})
            model.root.instances.insert({model.definition(id), {1, 2, 3}, 0});
      };
      build(one, {"p", "q"});
      build(two, {"x", "q", "p"});
      QVERIFY(one.hash() != two.hash());
      DIATOM_VERIFY_OK(two.eraseDefinition(two.definition("x")));
      QVERIFY(one.definition("p") != two.definition("p"));
      QCOMPARE(one.hash().text(), two.hash().text());
      two.root.cells.set({0, 0, 0}, {1});
      QVERIFY(one.hash() != two.hash());
      two = one;
      two.lattice.values["height"] = 1.28;
      QVERIFY(one.hash() != two.hash());
   }
};

QTEST_APPLESS_MAIN(CellsModelTest)
#include "cells_model_test.moc"
