// The command table and the edited document: what each command does, refuses and undoes; replay gives the
// same hash.
#include "core/file.h"
#include "document/document.h"
#include "formats/files.h"
#include "scene/networks.h"
#include "tests/kernel/document_run.h"
#include "tests/support/support.h"

#include <random>

using namespace diatom;
using nlohmann::json;

namespace {

Document start(const char *lattice = "cube")
{
   Design design;
   design.model.lattice.id = std::string("org.diatom_cad.lattice.") + lattice;
   Document document(test::catalogue(), design);
   for (const char *id : {"a", "b", "c"})
      if (!document.run("set-material", {{"id", id}}, Job()).ok())
         qFatal("no material");
   return document;
}

std::uint64_t cells(const Document &document) { return (*document.hierarchy())->cells(); }

/// A random command of those that make sense on any lattice; many fail, which must change nothing.
std::pair<std::string, json> randomCommand(std::mt19937 &random)
{
   const auto at = [&random] { return static_cast<int>(random() % 12) - 6; };
   const auto index = [&] { return json{at(), at(), at()}; };
   const auto box = [&] {
      const int x = at(), y = at(), z = at();
      return json{{x, y, z}, {x + int(random() % 3), y + int(random() % 3), z + int(random() % 3)}};
   };
   const std::string material(1, "abc"[random() % 3]);
   switch (random() % 14) {
   case 0:
   case 1:
   case 2:
      return {"place", {{"cell", index()}, {"material", material}}};
   case 3:
      return {"fill", {{"box", box()}, {"material", material}}};
   case 4:
      return {"erase", {{"cell", index()}}};
   case 5:
      return {"paint", {{"cell", index()}, {"material", material}}};
   case 6:
      return {"erase-box", {{"box", box()}}};
   case 7:
      return {"clone", {{"box", box()}, {"to", index()}}};
   case 8:
      return {"move", {{"box", box()}, {"to", index()}}};
   case 9:
      return {"define-composite", {{"id", "u" + std::to_string(random() % 4)}, {"box", box()}}};
   case 10:
      return {"place-composite",
              {{"definition", "u" + std::to_string(random() % 4)},
               {"cell", index()},
               {"rotation", random() % 2 ? random() % 8 : 0}}};
   case 11:
      return {"dissolve", {{"cell", index()}}};
   case 12:
      return {"support", {{"cell", index()}}};
   default:
      return {"replace-material", {{"from", material}, {"to", std::string(1, "abc"[random() % 3])}}};
   }
}

} // namespace

class document_commands_test : public QObject
{
   Q_OBJECT

private slots:
   void undoTextsSayWhatWasDone()
   {
      auto d = start();
      DO("place", R"({"cell": [0,0,0], "material": "a"})");
      QCOMPARE(d.undoText(), std::string("place"));
      DO("fill", R"({"box": [[5,5,0],[7,7,2]], "material": "a"})");
      QCOMPARE(d.undoText(), std::string("fill 3x3x3"));
      QCOMPARE(cells(d), std::uint64_t{28});
      QVERIFY(d.undo());
      QCOMPARE(d.redoText(), std::string("fill 3x3x3"));
      QCOMPARE(cells(d), std::uint64_t{1});
   }

   void aRunIsSetUpInOneStepEach()
   {
      auto d = start();
      const auto before = d.design().hash();
      DO("until", R"({"until_s": 2.5})");
      QCOMPARE(d.design().setup.until, 2.5);
      QCOMPARE(d.undoText(), std::string("length of run"));
      REFUSED("until", R"({"until_s": -1})", "/until_s");
      REFUSED("until", R"({"until_s": "soon"})", "/until_s");
      DO("set-solver", R"({"values": {"integrator": "verlet"}, "step_s": 2e-6})");
      QCOMPARE(std::get<std::string>(d.design().setup.solverValues.at("integrator")), std::string("verlet"));
      QCOMPARE(d.design().setup.step, 2e-6);
      REFUSED("set-solver", R"({"step_s": -2e-6})", "/step_s");
      QVERIFY(d.undo()); // values and step together
      QVERIFY(d.design().setup.solverValues.empty());
      QCOMPARE(d.design().setup.step, 0.0);
      QVERIFY(d.undo());
      QVERIFY(d.design().hash() == before);
   }

   void placingWhereSomethingIsFails()
   {
      auto d = start();
      DO("place", R"({"cell": [0,0,0], "material": "a"})");
      REFUSED("place", R"({"cell": [0,0,0], "material": "b"})", "[0, 0, 0] is taken");
      REFUSED("place", R"({"cell": [0,0], "material": "b"})", "/cell");
      REFUSED("place", R"({"cell": [0,0,1], "material": "z"})", "no material \"z\"");
      REFUSED("place", R"({"cell": [0,0,1], "material": "a", "colour": 1})", "no argument \"colour\"");
      REFUSED("place", R"({"cell": [0,0,1], "material": "a", "orientation": 24})", "/orientation");
      REFUSED("erase", R"({"cell": [9,9,9]})", "no cell");
      QVERIFY(test::run(d, "explode", "{}").starts_with("there is no command \"explode\""));
   }

   void bricksAreOneThing()
   {
      auto d = start("gik");
      DO("place", R"({"cell": [0,0,0], "material": "a"})"); // even layer: along +y, usual length 4
      DO("place", R"({"cell": [0,0,1], "material": "b", "length": 2})");
      QCOMPARE(cells(d), std::uint64_t{6});
      QVERIFY(!d.design().model.root.cells.at({0, 3, 0}).empty());
      QVERIFY(!d.design().model.root.cells.at({1, 0, 1}).empty());
      REFUSED("place", R"({"cell": [0,-2,0], "material": "a"})", "is taken");
      REFUSED("clone", R"({"box": [[0,0,0],[0,1,0]], "to": [5,0,0]})", "cuts the super-cell");
      REFUSED("clone", R"({"box": [[0,0,0],[0,3,0]], "to": [5,0,1]})", "repeats every");
      DO("paint", R"({"cell": [0,2,0], "material": "c"})");
      QCOMPARE(d.design().model.root.cells.at({0, 0, 0}).material, d.design().model.material("c"));
      DO("erase", R"({"cell": [0,1,0]})");
      QCOMPARE(cells(d), std::uint64_t{2});
      DO("fill", R"({"box": [[0,0,2],[1,5,2]], "material": "a"})");
      QCOMPARE(cells(d), std::uint64_t{14});
      QCOMPARE(int(d.design().model.root.cells.at({1, 3, 2}).joins), int(Cell::kJoinsPrevious));
      QCOMPARE(int(d.design().model.root.cells.at({1, 4, 2}).joins), int(Cell::kJoinsNext));
   }

   void groupingAndDissolvingKeepsEveryCell()
   {
      for (const char *lattice : {"cube", "gik", "octahedron_edge", "kelvin"}) {
         auto d = start(lattice);
         DO("fill", R"({"box": [[0,0,0],[3,3,2]], "material": "a"})");
         const auto before = d.design().model.root;
         const auto count = cells(d);
         DO("define-composite", R"({"id": "u", "box": [[0,0,0],[3,3,2]]})");
         QCOMPARE(cells(d), count);
         QVERIFY(d.design().model.root.cells.empty());
         DO("place-composite", R"({"definition": "u", "cell": [10,0,0]})");
         QCOMPARE(cells(d), 2 * count);
         REFUSED("place-composite", R"({"definition": "u", "cell": [11,0,0]})", "is taken");
         REFUSED("remove-composite", R"({"definition": "u"})", "u");
         REFUSED("paint", R"({"cell": [0,0,0], "material": "b"})", "composite \"u\"");
         DO("erase", R"({"cell": [11,1,0]})");
         DO("dissolve", R"({"cell": [0,0,0]})");
         QVERIFY(d.design().model.root == before);
         DO("remove-composite", R"({"definition": "u"})");
         QVERIFY(d.design().model.definitions.empty());
      }
   }

   void turnedCompositesDissolveToWhatTheyShowed()
   {
      for (const char *lattice : {"cube", "gik", "octahedron_edge"}) {
         auto d = start(lattice);
         DO("fill", R"({"box": [[0,0,0],[4,1,1]], "material": "a"})");
         DO("define-composite", R"({"id": "u", "box": [[0,0,0],[4,1,1]]})");
         int placed = 0;
         for (int rotation = 0; rotation < 48; ++rotation) {
            if (!d.run("place-composite", {{"definition", "u"}, {"cell", {40, 0, 0}}, {"rotation", rotation}},
                       Job())
                     .ok())
               continue;
            ++placed;
            std::map<Index, Cell> shown, kept;
            (*d.hierarchy())->visit({{20, -40, -40}, {60, 40, 40}}, [&](Index i, Cell c) {
               shown[i] = c;
               return true;
            });
            DO("dissolve", R"({"cell": [40,0,0]})");
            (*d.hierarchy())->visit({{20, -40, -40}, {60, 40, 40}}, [&](Index i, Cell c) {
               kept[i] = c;
               return true;
            });
            QCOMPARE(shown.size(), std::size_t(20));
            QCOMPARE(kept.size(), shown.size());
            for (const auto &[index, cell] : kept) {
               QCOMPARE(cell.orientation, shown[index].orientation);
               QCOMPARE((*d.hierarchy())->supercell(index).size() > 1, cell.joins != 0);
            }
            d.undo();
            d.undo();
         }
         QVERIFY(placed >= 2);
      }
   }

   void theSetUpFollowsTheCells()
   {
      auto d = start();
      DO("set-material", R"({"id": "s", "role": "source"})");
      DO("fill", R"({"box": [[0,0,0],[3,0,0]], "material": "a"})");
      DO("place", R"({"cell": [4,0,0], "material": "s"})");
      DO("support", R"({"box": [[0,0,0],[1,5,5]], "fixed": ["x", "rz"]})");
      DO("load", R"({"cell": [3,0,0], "force_N": [0,0,-0.012]})");
      DO("source", R"({"cell": [4,0,0], "waveform": "square", "frequency_Hz": 20})");
      DO("source", R"({"cell": [4,0,0], "duty": 0.25})");
      QCOMPARE(d.design().setup.sources.size(), std::size_t{1});
      QCOMPARE(d.design().setup.sources[0].frequency, 20.0);
      QCOMPARE(d.design().setup.sources[0].duty, 0.25);
      QCOMPARE(int(d.design().setup.supports[1].fixed), 0x21);
      REFUSED("source", R"({"cell": [0,0,0]})", "not a source");
      REFUSED("support", R"({"cell": [9,9,9]})", "no cell");
      REFUSED("source", R"({"cell": [4,0,0], "duty": 7})", "/duty");
      DO("erase-box", R"({"box": [[0,0,0],[0,0,0]]})");
      DO("erase", R"({"cells": [[4,0,0],[3,0,0]]})");
      QCOMPARE(d.design().setup.supports.size(), std::size_t{1});
      QVERIFY(d.design().setup.sources.empty() && d.design().setup.loads.empty());
      REFUSED("remove-material", R"({"id": "a"})", "2 cells are made of it");
      DO("remove-material", R"({"id": "b"})");
      DO("set-material", R"({"id": "a", "density_kg_m3": 2000})");
      DO("set-material", R"({"id": "a", "youngs_modulus_Pa": 5e6})");
      QCOMPARE(d.design().model.material(d.design().model.material("a")).density, 2000.0);
   }

   void anotherLatticeTakesPlainCellsOnly()
   {
      auto d = start();
      DO("place", R"({"cell": [0,0,0], "material": "a"})");
      DO("set-lattice", R"({"id": "kelvin", "pitch_m": 0.002})");
      QCOMPARE(d.design().model.lattice.pitch, 0.002);
      REFUSED("set-lattice", R"({"id": "penrose"})", "penrose");
      DO("define-composite", R"({"id": "u", "box": [[0,0,0],[0,0,0]]})");
      REFUSED("set-lattice", R"({"id": "cube"})", "do not carry over");
   }

   void randomEditsUndoRedoAndReplay_data()
   {
      QTest::addColumn<QString>("lattice");
      for (const char *lattice : {"cube", "gik", "octahedron_edge", "kelvin"})
         QTest::newRow(lattice) << QString(lattice);
   }
   void randomEditsUndoRedoAndReplay()
   {
      QFETCH(QString, lattice);
      const unsigned seed = 11;
      qInfo("seed %u", seed);
      std::mt19937 random(seed);
      auto d = start(qPrintable(lattice));
      const auto opened = Document(test::catalogue(), d.design());
      d = Document(test::catalogue(), d.design());
      std::vector<Hash> hashes{d.design().hash()};
      int done = 0, refused = 0;
      for (int k = 0; k < 250; ++k) {
         const auto [command, arguments] = randomCommand(random);
         const auto before = d.design();
         if (d.run(command, arguments, Job()).ok()) {
            ++done;
            hashes.push_back(d.design().hash());
            QVERIFY2(d.hierarchy().ok(), command.c_str());
         } else {
            ++refused;
            QVERIFY2(d.design() == before, command.c_str());
         }
      }
      QVERIFY2(done > 50 && refused > 10, qPrintable(QString("%1 done, %2 refused").arg(done).arg(refused)));
      const auto log = d.log();
      auto again = opened;
      DIATOM_VERIFY_OK(again.replay(log, Job()));
      QCOMPARE(again.design().hash().text(), d.design().hash().text());
      QVERIFY(again.design() == d.design());
      const auto bytes = writeDesign(d.design(), false, Job());
      DIATOM_VERIFY_OK(bytes);
      const auto reread = readDesign(*bytes, "saved", Job());
      DIATOM_VERIFY_OK(reread);
      QVERIFY(reread->design == d.design());
      for (std::size_t k = hashes.size(); k-- > 0;) {
         QVERIFY(d.design().hash() == hashes[k]);
         QCOMPARE(d.undo(), k > 0);
      }
      QVERIFY(d.log().empty());
      for (std::size_t k = 1; k < hashes.size(); ++k) {
         QVERIFY(d.redo());
         QVERIFY(d.design().hash() == hashes[k]);
      }
      QVERIFY(!d.redo());
   }

   void aNewEditForgetsWhatWasUndone()
   {
      auto d = start();
      d.markSaved();
      QVERIFY(!d.modified());
      DO("place", R"({"cell": [0,0,0], "material": "a"})");
      QVERIFY(d.modified());
      d.markSaved();
      d.undo();
      QVERIFY(d.modified());
      DO("place", R"({"cell": [1,0,0], "material": "a"})");
      QVERIFY(d.modified() && !d.canRedo());
      QCOMPARE(cells(d), std::uint64_t{1});
      QVERIFY((*d.hierarchy())->at({0, 0, 0}).empty());
   }

   void aBrokenLogNamesItsLine()
   {
      auto d = start();
      const auto status = d.replay(
          "# remark\n{\"command\": \"set-name\", \"arguments\": {\"name\": \"n\"}}\n{\"command\": \"fly\"}\n",
          Job());
      QVERIFY(!status.ok());
      QVERIFY2(status.error().message.find("line 3") == 0, status.error().message.c_str());
   }

   void everyCommandRefusesWrongArgumentsWithASentence()
   {
      for (const auto &command : commands())
         for (const char *arguments :
              {"null", "[]", "7", R"({"cell": "x", "box": 1, "id": [], "material": {}, "to": null})",
               R"({"nonsense": 1})"})
         {
            auto d = start();
            const auto before = d.design().hash();
            const auto message = test::run(d, command.id, arguments);
            if (message.empty())
               QVERIFY(std::string(arguments) == "null"); // those with no required argument
            else
               QVERIFY2(message.starts_with(command.id) && d.design().hash() == before, message.c_str());
         }
   }

   void samplesAreWhatTheirLogsMake()
   {
      int samples = 0;
      for (const auto &entry : std::filesystem::directory_iterator(test::samplesDir())) {
         if (entry.path().extension() != ".diatom")
            continue;
         ++samples;
         const auto opened = openDesign(entry.path(), Job());
         DIATOM_VERIFY_OK(opened);
         QVERIFY2(opened->notes.empty(), entry.path().c_str());
         const Document document(test::catalogue(), opened->design);
         DIATOM_VERIFY_OK(document.hierarchy());
         QVERIFY((*document.hierarchy())->cells() > 10);
         const auto networks = findNetworks(**document.hierarchy(), opened->design.setup, Job());
         QVERIFY2(networks.problems.empty(),
                  networks.problems.empty() ? "" : networks.problems[0].text.c_str());
         auto log = entry.path();
         const auto text = readFile(log.replace_extension(".log"));
         DIATOM_VERIFY_OK(text);
         Document made(test::catalogue(), Design());
         DIATOM_VERIFY_OK(made.replay(*text, Job()));
         QVERIFY2(made.design() == opened->design, entry.path().c_str());
      }
      QVERIFY(samples >= 8);
   }
};

QTEST_APPLESS_MAIN(document_commands_test)
#include "document_commands_test.moc"
