// Files of the earlier programs out and in again: the same cells, composites and supports.
#include "core/file.h"
#include "formats/earlier_programs.h"
#include "formats/files.h"
#include "formats/foreign.h"
#include "support/scenes.h"

using namespace diatom;
using namespace diatom::test;

namespace {

struct Case
{
   Opened opened;
   std::shared_ptr<const Lattice> lattice;
   Hierarchy hierarchy() const { return Hierarchy(lattice, opened.design.model); }
};

Case open(const std::string &bytes, const char *name)
{
   auto read = readDesign(bytes, name, Job());
   if (!read)
      qFatal("%s", read.error().message.c_str());
   Case result{*std::move(read), nullptr};
   result.lattice = Lattice::make(*catalogue(), result.opened.design.model.lattice, Job()).value();
   return result;
}

Case openFile(const std::filesystem::path &file)
{
   return open(readFile(file).value(), file.filename().c_str());
}

/// Every logical cell with the id of its material and how it joins.
std::map<Index, std::pair<std::string, int>> cellsOf(const Case &one)
{
   std::map<Index, std::pair<std::string, int>> cells;
   const Hierarchy hierarchy = one.hierarchy();
   hierarchy.visit(hierarchy.bounds(), [&](Index i, Cell cell) {
      cells[i] = {one.opened.design.model.material(cell.material).id, cell.joins};
      return true;
   });
   return cells;
}

std::string written(const Case &one, const char *format)
{
   std::vector<std::string> notes;
   auto bytes = foreignFormat(format, {})->write(one.opened.design, one.hierarchy(), notes, Job());
   if (!bytes)
      qFatal("%s", bytes.error().message.c_str());
   return *std::move(bytes);
}

} // namespace

class FormatsExportTest : public QObject
{
   Q_OBJECT
private slots:
   void filesOfAmoebaComeBackAsTheyWere();
   void theCapacitorComesBackWithItsComposites();
   void bricksOfEveryLengthComeBack();
   void everyLatticeOfDmdesignComesBack();
   void othersMaterialsBecomeAmoebas();
   void whatAProgramDoesNotHaveIsRefused();
   void formatsAreToldByNameOrSuffix();
};

void FormatsExportTest::filesOfAmoebaComeBackAsTheyWere()
{
   DIATOM_NEEDS_SHARED();
   for (const char *name : {"BeamBending.json", "Bendy.json", "Gripper.json", "Locomotion.json"}) {
      const Case first = openFile(sharedDir() / "data" / "amoeba" / name);
      const Case second = open(written(first, "amoeba"), name);
      QVERIFY2(cellsOf(first) == cellsOf(second), name);
      const Setup &a = first.opened.design.setup, &b = second.opened.design.setup;
      QVERIFY2(a.supports == b.supports, name);
      QVERIFY2(a.sources == b.sources, name);
      QCOMPARE(b.step, a.step);
      QCOMPARE(b.ground.present, a.ground.present);
      // Half a cell is added and taken again.
      QVERIFY(std::abs(b.ground.height - a.ground.height) < 1e-15);
      QCOMPARE(b.ground.friction > 0, a.ground.friction > 0);
      for (std::size_t k = 0; k < 3; ++k)
         QVERIFY(std::abs(b.gravity[k] - a.gravity[k]) < 1e-12);
   }
}

void FormatsExportTest::theCapacitorComesBackWithItsComposites()
{
   DIATOM_NEEDS_SHARED();
   const Case first = openFile(sharedDir() / "data" / "dmdesign" / "capacitor.json");
   const Case second = open(written(first, "dmdesign"), "capacitor.json");
   const Model &a = first.opened.design.model, &b = second.opened.design.model;
   QVERIFY(a.lattice == b.lattice);
   QCOMPARE(b.definitions.size(), a.definitions.size());
   QVERIFY(!a.definitions.empty());
   for (const auto &[number, definition] : a.definitions) {
      const Definition *other = b.definition(b.definition(definition->id));
      QVERIFY2(other, definition->id.c_str());
      QCOMPARE(other->body.cells.count(), definition->body.cells.count());
      QVERIFY(definition->body.cells.visit([&](Index i, Cell cell) {
         const Cell there = other->body.cells.at(i);
         return there.joins == cell.joins && b.material(there.material).id == a.material(cell.material).id;
      }));
      std::size_t placed = 0;
      definition->body.instances.visit([&](const Placement &placement) {
         Placement moved = placement;
         moved.definition = b.definition(a.definition(placement.definition)->id);
         placed += other->body.instances.contains(moved) ? 1 : 0;
         return true;
      });
      QCOMPARE(placed, definition->body.instances.count());
      QCOMPARE(other->body.instances.count(), definition->body.instances.count());
   }
}

void FormatsExportTest::bricksOfEveryLengthComeBack()
{
   const Case tower = openFile(samplesDir() / "capacitor-tower.diatom");
   QVERIFY(cellsOf(tower).size() > 100);
   QVERIFY(cellsOf(tower) == cellsOf(open(written(tower, "dmdesign"), "tower.json")));
   QCOMPARE(open(written(tower, "dmdesign"), "tower.json").opened.design.model.lattice.pitch,
            tower.opened.design.model.lattice.pitch);
}

void FormatsExportTest::everyLatticeOfDmdesignComesBack()
{
   int lattices = 0;
   for (const Offer &offer : catalogue()->offers(DIATOM_LATTICE_1)) {
      Scene scene(offer.provided->id, 2.5e-9);
      unsigned n = 0;
      for (const Index i : blob(*scene.lattice, 60, 4, {-5, 7, -3}))
         scene.model.root.cells.set(i, {static_cast<MaterialIndex>(1 + n++ % 3), 0, 0});
      Case one{{}, scene.lattice};
      one.opened.design.model = scene.model;
      std::vector<std::string> notes;
      const auto bytes = writeDmdesign(one.opened.design, one.hierarchy(), notes, Job());
      if (!bytes) {
         QCOMPARE(bytes.error().code, ErrorCode::unsupported);
         continue;
      }
      ++lattices;
      const Case other = open(*bytes, "blob.json");
      QCOMPARE(other.opened.design.model.lattice.id, offer.provided->id);
      QVERIFY(std::abs(other.opened.design.model.lattice.pitch / 2.5e-9 - 1) < 1e-14);
      QVERIFY(other.opened.design.model.lattice.aspect == (std::array<double, 3>{1, 1, 1}));
      QVERIFY2(cellsOf(one) == cellsOf(other), offer.provided->id.c_str());
   }
   QCOMPARE(lattices, 12); // all that the program had
}

void FormatsExportTest::othersMaterialsBecomeAmoebas()
{
   Scene scene("org.diatom_cad.lattice.cube");
   Material source = scene.model.material(3);
   source.role = ElectricalRole::source;
   DIATOM_VERIFY_OK(scene.model.setMaterial(source));
   for (int k = 0; k < 3; ++k)
      scene.model.root.cells.set({k, 0, 0}, {static_cast<MaterialIndex>(k + 1), 0, 0});
   Case one{{}, scene.lattice};
   one.opened.design.model = scene.model;
   one.opened.design.setup.supports = {{OfMaterial{"b"}}};
   std::vector<std::string> notes;
   const auto bytes = writeAmoeba(one.opened.design, one.hierarchy(), notes, Job());
   DIATOM_VERIFY_OK(bytes);
   const Case other = open(*bytes, "three.json");
   const auto cells = cellsOf(other);
   QCOMPARE(cells.at({0, 0, 0}).first, std::string("fiberGlass"));
   QCOMPARE(cells.at({2, 0, 0}).first, std::string("signal"));
   QCOMPARE(other.opened.design.setup.supports.size(), std::size_t(1));
   QVERIFY(other.opened.design.setup.supports[0].where == Where(Index{1, 0, 0}));
   QVERIFY(std::any_of(notes.begin(), notes.end(), [](const std::string &note) {
      return note.find("c as signal") != std::string::npos;
   }));
}

void FormatsExportTest::whatAProgramDoesNotHaveIsRefused()
{
   std::vector<std::string> notes;
   Scene kelvin("org.diatom_cad.lattice.kelvin");
   Case one{{}, kelvin.lattice};
   one.opened.design.model = kelvin.model;
   QVERIFY(!writeAmoeba(one.opened.design, one.hierarchy(), notes, Job()));
   Scene cube("org.diatom_cad.lattice.cube");
   cube.model.root.cells.set({0, 0, 0}, {1, 5, 0});
   Case two{{}, cube.lattice};
   two.opened.design.model = cube.model;
   const auto turned = writeDmdesign(two.opened.design, two.hierarchy(), notes, Job());
   QVERIFY(!turned);
   QVERIFY2(turned.error().message.find("(0, 0, 0)") != std::string::npos, turned.error().message.c_str());
   two.opened.design.model.root.cells.set({0, 0, 0}, {1, 0, 0});
   two.opened.design.model.root.cells.set({1000, 1000, 1000}, {1, 0, 0});
   QVERIFY(!writeDmdesign(two.opened.design, two.hierarchy(), notes, Job())); // 10^9 places
   QVERIFY(!writeAmoeba(two.opened.design, two.hierarchy(), notes, Job()));
}

void FormatsExportTest::formatsAreToldByNameOrSuffix()
{
   QCOMPARE(foreignFormat("", "a.vox")->name, "vox");
   QCOMPARE(foreignFormat("", "a.vxa")->name, "vxa");
   QVERIFY(!foreignFormat("", "a.json")); // of which program?
   QCOMPARE(foreignFormat("amoeba", "a.json")->name, "amoeba");
   QVERIFY(!foreignFormat("", "a.diatom"));
   QVERIFY(!foreignFormat("word", "a.vox"));
}

QTEST_APPLESS_MAIN(FormatsExportTest)
#include "formats_export_test.moc"
