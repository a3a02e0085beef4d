// Files of the earlier programs: counts, bounds and set-ups of their published demos, and small files made
// here.
#include "formats/files.h"
#include "tests/support/support.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>

using namespace diatom;

namespace {

struct Demo
{
   const char *file;
   Box bounds;
   std::map<std::string, std::uint64_t> materials;
   std::size_t supports, sources;
   double ground; // lattice index
};

std::uint64_t countOf(const Model &model, const CellArray &cells, const std::string &id)
{
   const auto counts = cells.countByMaterial();
   const auto m = model.material(id);
   return m != 0 && m < counts.size() ? counts[m] : 0;
}

/// Bricks (runs) and cells of a definition with all it contains; placements of the importer are unturned, so
/// this expansion is a plain shift. Overlaps show as a smaller count.
struct Expanded
{
   std::map<Index, Cell> cells;
   int bricks = 0;
};

void expand(const Model &model, DefinitionId id, Index at, Expanded &out)
{
   const auto &body = model.definition(id)->body;
   body.cells.visit([&](Index i, Cell cell) {
      out.cells.emplace(i + at, cell);
      if (!(cell.joins & Cell::kJoinsPrevious))
         ++out.bricks;
      return true;
   });
   body.instances.visit([&](const Placement &p) {
      Q_ASSERT(p.rotation == 0);
      expand(model, p.definition, p.origin + at, out);
      return true;
   });
}

Result<Opened> amoeba(const std::string &assembly, const std::string &sim)
{
   return readDesign(R"({"assembly": {)" + assembly + R"(}, "materials": {}, "emSim": {)" + sim + "}}",
                     "demo.json", Job());
}

} // namespace

class FormatsImportTest : public QObject
{
   Q_OBJECT

private slots:
   /// Counts of the AMOEBA sheet, table 2.3.
   void amoebaDemosHaveTheirCounts()
   {
      DIATOM_NEEDS_SHARED();
      const Demo demos[] = {
          {"BeamBending", {{-14, 0, 0}, {-3, 13, 1}}, {{"fiberGlass", 70}, {"flexure", 70}}, 10, 0, -19},
          {"Bendy",
           {{-17, -3, 0}, {-4, 3, 4}},
           {{"flexureCond", 114},
            {"piezo", 12},
            {"flexure", 6},
            {"brass", 2},
            {"fiberGlass", 2},
            {"signal", 2}},
           0,
           2,
           0},
          {"Gripper",
           {{-11, -1, 0}, {-5, 35, 2}},
           {{"fiberGlass", 363}, {"flexureCond", 40}, {"brass", 20}, {"piezo", 6}, {"signal", 6}},
           0,
           6,
           0},
          {"Locomotion",
           {{-53, 6, 0}, {-12, 9, 2}},
           {{"brass", 48}, {"flexureCond", 16}, {"piezo", 4}, {"signal", 4}},
           0,
           4,
           0},
      };
      for (const auto &demo : demos) {
         const auto opened =
             openDesign(test::sharedDir() / "data/amoeba" / (std::string(demo.file) + ".json"), Job());
         DIATOM_VERIFY_OK(opened);
         QCOMPARE(opened->format, std::string("amoeba"));
         const auto &model = opened->design.model;
         const auto &setup = opened->design.setup;
         std::uint64_t cells = 0;
         for (const auto &[id, count] : demo.materials) {
            QCOMPARE(countOf(model, model.root.cells, id), count);
            cells += count;
         }
         QCOMPARE(model.root.cells.count(), cells);
         QVERIFY(model.root.cells.bounds() == demo.bounds);
         QCOMPARE(model.lattice.pitch, 1e-3);
         QCOMPARE(setup.supports.size(), demo.supports);
         QCOMPARE(setup.sources.size(), demo.sources);
         QVERIFY(setup.gravity == (std::array<double, 3>{0, 0, -9.8}));
         QVERIFY(setup.ground.present);
         QCOMPARE(setup.ground.height, (demo.ground - 0.5) * 1e-3);
         QCOMPARE(setup.ground.friction, 0.5);
         QCOMPARE(setup.step, 10 * 1e-6);
      }
   }

   void amoebaMaterialsHaveTheirStiffnessMassAndRoles()
   {
      DIATOM_NEEDS_SHARED();
      const auto opened = openDesign(test::sharedDir() / "data/amoeba/Bendy.json", Job());
      DIATOM_VERIFY_OK(opened);
      const auto &model = opened->design.model;
      const auto &piezo = model.material(model.material("piezo"));
      QCOMPARE(piezo.youngsModulus, 200 / 1e-3);
      QCOMPARE(piezo.density, 6500.0);
      QVERIFY(piezo.role == ElectricalRole::actuator);
      QCOMPARE(piezo.actuation.strainPerVolt, 0.6);
      QVERIFY(piezo.actuation.axisFromWires);
      // zeta = d / (2 sqrt(k m/2)) of two equal cells, to rounding.
      QVERIFY(std::abs(piezo.dampingRatio - 0.01 / (2 * std::sqrt(200 * 6500e-9 / 2))) < 1e-12);
      QVERIFY(model.material(model.material("signal")).role == ElectricalRole::source);
      QVERIFY(model.material(model.material("flexureCond")).role == ElectricalRole::conductor);
      QCOMPARE(model.material(model.material("flexure")).youngsModulus, 30 / 1e-3);
      const auto &sources = opened->design.setup.sources;
      QCOMPARE(sources[0].frequency, 10.0);
      QCOMPARE(sources[1].phase, 0.5);
   }

   void bothGenerationsOfIdsAndKeysAreRead()
   {
      const char *first = R"("cellsMin": {"x": -1, "y": 0, "z": 5}, "units": "um",
         "sparseCells": [[[{"materialID": "fiberGlass"}, null, {"materialID": "piezo"}]], [[null, null, {"materialID": "brass"}]]])";
      const char *second = R"("cellsMin": {"x": -1, "y": 0, "z": 5}, "units": "um",
         "cells": [[[{"materialID": "insulating"}, null, {"materialID": "actuator"}]], [[null, null, {"materialID": "conductive"}]]])";
      const auto a = amoeba(first, ""), b = amoeba(second, "");
      DIATOM_VERIFY_OK(a);
      DIATOM_VERIFY_OK(b);
      QCOMPARE(a->design.model.lattice.pitch, 1e-6);
      QVERIFY(a->design.model.root.cells == b->design.model.root.cells);
      QCOMPARE(a->design.model.root.cells.at({0, 0, 7}).material, a->design.model.material("brass"));
      for (std::size_t m = 0; m < 3; ++m) {
         auto p = (*a->design.model.materials)[m], q = (*b->design.model.materials)[m];
         q.id = p.id;
         QVERIFY(p == q);
      }
   }

   void zeroesAndFalseAreTakenAtTheirWord()
   {
      const auto opened = amoeba(R"("sparseCells": [[[{"materialID": "brass"}]]])",
                                 R"("gravity": 0, "groundHeight": 0, "friction": false, "dtSolver": 0)");
      DIATOM_VERIFY_OK(opened);
      QVERIFY(opened->design.setup.gravity == (std::array<double, 3>{0, 0, 0}));
      QCOMPARE(opened->design.setup.ground.friction, 0.0);
      QCOMPARE(opened->design.setup.step, 0.0);
   }

   void whatHasNoMeaningIsReported()
   {
      const auto opened =
          amoeba(R"("colour": "red", "numCells": 9, "sparseCells": [[[{"materialID": "mystery"}]]])",
                 R"("fixedIndices": [{"x": 5, "y": 5, "z": 5}], "dtRender": 100)");
      DIATOM_VERIFY_OK(opened);
      std::string notes;
      for (const auto &note : opened->notes)
         notes += note + "\n";
      for (const char *word : {"/assembly/colour", "says 9", "mystery", "fixedIndices/0", "dtRender"})
         QVERIFY2(notes.find(word) != std::string::npos, notes.c_str());
      QVERIFY(opened->design.setup.supports.empty());
   }

   /// DMDesign sheet 5.4: bricks and cells of each definition, fully expanded, without overlaps.
   void theCapacitorHasItsBricks()
   {
      DIATOM_NEEDS_SHARED();
      const auto opened = openDesign(test::sharedDir() / "data/dmdesign/capacitor.json", Job());
      DIATOM_VERIFY_OK(opened);
      QCOMPARE(opened->format, std::string("dmdesign"));
      const auto &model = opened->design.model;
      QCOMPARE(model.lattice.id, std::string("org.diatom_cad.lattice.gik"));
      QCOMPARE(std::get<double>(model.lattice.values.at("height")), 1.28);
      QCOMPARE(model.definitions.size(), std::size_t{3});
      QVERIFY(model.root.cells.empty() && model.root.instances.count() == 0);
      const auto check = [&model](const char *id, int bricks, std::uint64_t cells, Index size) {
         Expanded all;
         expand(model, model.definition(id), {}, all);
         QCOMPARE(all.bricks, bricks);
         QCOMPARE(std::uint64_t{all.cells.size()}, cells);
         Box bounds;
         for (const auto &[index, cell] : all.cells)
            bounds.extend(index);
         QVERIFY(bounds == (Box{{0, 0, 0}, size - Index{1, 1, 1}}));
      };
      check("superc18", 18, 72, {10, 5, 2});
      check("superc30", 36, 144, {10, 10, 2});
      check("superc35", 108, 432, {10, 10, 6});
      const auto &unit = model.definition(model.definition("superc18"))->body.cells;
      QCOMPARE(countOf(model, unit, "brass"), std::uint64_t{48});
      QCOMPARE(countOf(model, unit, "fiberGlass"), std::uint64_t{24});
      QVERIFY(model.material(model.material("brass")).role == ElectricalRole::conductor);
   }

   /// A composite at an odd height turns by -90 degrees about z: its bricks follow the layers they come to
   /// lie in.
   void compositesAtOddHeightsTurn()
   {
      const auto opened =
          readDesign(R"({"assembly": {"cellType": "cube", "connectionType": "gik", "latticeType": "willGik",
         "units": "mm", "scale": 2, "sparseCells": [[[null, {"materialName": "super1"}]]]},
         "materials": {"m": {"name": "M"}, "super1": {"name": "S", "cellsMin": {"x": 0, "y": 0, "z": 0},
         "sparseCells": [[[{"materialName": "m", "length": 3}, null]], [[null, {"materialName": "m", "length": 2}]]]}}})",
                     "gik.json", Job());
      DIATOM_VERIFY_OK(opened);
      const auto &model = opened->design.model;
      QCOMPARE(model.lattice.pitch, 2e-3);
      Expanded all;
      model.root.instances.visit([&](const Placement &p) {
         expand(model, p.definition, p.origin, all);
         return true;
      });
      // Local brick of 3 along +y at (0,0,0) -> world z = 1, along +x from the origin; local brick of 2 along
      // +x at (1,0,1) -> (0,-1) running to -y at z = 2.
      const std::map<Index, int> expected{
          {{0, 0, 1}, 2}, {{1, 0, 1}, 3}, {{2, 0, 1}, 1}, {{0, -2, 2}, 2}, {{0, -1, 2}, 1}};
      QCOMPARE(all.cells.size(), expected.size());
      for (const auto &[index, joins] : expected) {
         QVERIFY(all.cells.contains(index));
         QCOMPARE(int(all.cells.at(index).joins), joins);
      }
   }

   /// DMDesign sheet 1.15: every pair of keys, in both spellings of the application and of the material.
   void everyLatticeOfDmdesignIsRead()
   {
      const std::array<const char *, 3> names[] = {{"cube", "face", "cube"},
                                                   {"cube", "gik", "gik"},
                                                   {"octa", "face", "octahedron_face"},
                                                   {"octa", "edge", "octahedron_edge_flat"},
                                                   {"octa", "edgeRot", "octahedron_edge"},
                                                   {"octa", "vertex", "octahedron_vertex"},
                                                   {"tetra", "stacked", "tetrahedron_stacked"},
                                                   {"tetra", "vertex", "tetrahedron_vertex"},
                                                   {"truncatedCube", "face", "cuboctahedron"},
                                                   {"kelvin", "face", "kelvin"},
                                                   {"hex", "face", "honeycomb"},
                                                   {"hex", "faceRot", "honeycomb_rotated"}};
      for (const auto &[cell, connection, id] : names)
         for (const bool old : {false, true}) {
            nlohmann::json file;
            file["assembly"] = {{"cellType", cell},
                                {"connectionType", connection},
                                {old ? "latticeType" : "applicationType", "default"},
                                {"units", "inches"},
                                {"scale", 2},
                                {"cellsMin", {{"x", -1}, {"y", -1}, {"z", -1}}}};
            const nlohmann::json element{{old ? "materialName" : "materialID", "rigid"}};
            file["assembly"]["sparseCells"] = {{nlohmann::json::array({element})}};
            file["materials"]["rigid"]["name"] = "Rigid";
            const std::string text = file.dump();
            const auto opened = readDesign(text, "dm.json", Job());
            DIATOM_VERIFY_OK(opened);
            const auto &spec = opened->design.model.lattice;
            QCOMPARE(spec.id, "org.diatom_cad.lattice." + std::string(id));
            QCOMPARE(spec.pitch, 2 * 0.0254);
            QVERIFY(!opened->design.model.root.cells.at({-1, -1, -1}).empty());
            DIATOM_VERIFY_OK(Lattice::make(*test::catalogue(), spec, Job()));
         }
   }

   void anAspectRatioOfItsOwnStretchesTheLattice()
   {
      const auto aspectOf = [](double z) {
         nlohmann::json file;
         file["assembly"] = {{"cellType", "octa"},
                             {"connectionType", "edgeRot"},
                             {"aspectRatio", {{"x", 1}, {"y", 1}, {"z", z}}}};
         file["materials"] = nlohmann::json::object();
         const auto opened = readDesign(file.dump(), "dm.json", Job());
         return opened ? opened->design.model.lattice.aspect : std::array<double, 3>{};
      };
      QVERIFY(aspectOf(0.7071) == (std::array<double, 3>{1, 1, 1}));
      const auto tall = aspectOf(std::sqrt(2.0));
      QVERIFY(tall[0] == 1 && tall[1] == 1 && std::abs(tall[2] - 2) < 1e-12);
   }

   void faultsOfImportedFilesNameThePlace()
   {
      const auto wrong = amoeba(R"("sparseCells": [[[{"materialID": 5}]]])", "");
      QVERIFY(!wrong.ok());
      QVERIFY2(wrong.error().message.find("/assembly/sparseCells/0/0/0/materialID") != std::string::npos,
               wrong.error().message.c_str());
      const auto circle = readDesign(
          R"({"materials": {"superA": {"sparseCells": [[[{"materialName": "superA"}]]]}}})", "x", Job());
      QVERIFY(!circle.ok());
      QVERIFY2(circle.error().message.find("contains itself") != std::string::npos,
               circle.error().message.c_str());
   }
};

QTEST_APPLESS_MAIN(FormatsImportTest)
#include "formats_import_test.moc"
