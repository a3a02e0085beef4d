// .diatom documents: exact round trips, the same bytes for the same design, and one sentence for every bad
// file.
#include "document/json_text.h"
#include "formats/files.h"
#include "tests/kernel/document_designs.h"
#include "tests/support/support.h"

#include "core/archive.h"
#include "core/file.h"

#include <random>

using namespace diatom;
using test::boundary;
using test::everything;
using test::material;

namespace {

Result<Opened> read(const std::string &bytes) { return readDesign(bytes, "test.diatom", Job()); }

std::string small(const std::string &insert)
{
   return R"({"diatom": 1, "lattice": {"id": "l"}, "materials": [{"id": "a"}, {"id": "b"}])" + insert + "}";
}

} // namespace

class document_format_test : public QObject
{
   Q_OBJECT

private slots:
   void everyFieldSurvivesBothForms()
   {
      for (const auto &[design, packed] : {std::pair{everything(), false}, std::pair{everything(), true},
                                           std::pair{boundary(), false}, std::pair{boundary(), true}})
      {
         const auto bytes = writeDesign(design, packed, Job());
         DIATOM_VERIFY_OK(bytes);
         const auto opened = read(*bytes);
         DIATOM_VERIFY_OK(opened);
         QVERIFY2(opened->notes.empty(), opened->notes.empty() ? "" : opened->notes[0].c_str());
         QCOMPARE(opened->design.name, design.name);
         QVERIFY(*opened->design.model.materials == *design.model.materials);
         QVERIFY(opened->design.model.root == design.model.root);
         QVERIFY(opened->design.setup == design.setup);
         QVERIFY(opened->design == design);
         QCOMPARE(opened->design.hash().text(), design.hash().text());
         const auto again = writeDesign(opened->design, packed, Job());
         DIATOM_VERIFY_OK(again);
         QVERIFY(*again == *bytes);
      }
   }

   void dampingsAndInertiaOfOnesOwnSurviveBothForms()
   {
      Design design = everything();
      auto materials = std::make_shared<std::vector<Material>>(*design.model.materials);
      Material &one = materials->front();
      one.dampings = BondConstants{
          {0.1, 0.2, 0.3}, {{{0, 1, 2}, {3, 0, 5}, {6, 7, 0}}}, {1e-9, 0, 3e-9}, {4e-9, 5e-9, 0}};
      one.inertia = {1.5e-13, 2e-13, 2.5e-13};
      const Hash before = design.hash();
      design.model.materials = materials;
      QVERIFY(design.hash() != before);
      for (const bool packed : {false, true}) {
         const auto opened = read(*writeDesign(design, packed, Job()));
         DIATOM_VERIFY_OK(opened);
         QVERIFY(opened->design == design);
      }
   }

   void theLengthOfARunIsWrittenWhereItIsGiven()
   {
      Design design = boundary();
      QVERIFY(writeDesign(design, false, Job())->find("until_s") == std::string::npos);
      const Hash before = design.hash();
      design.setup.until = 2.5;
      QVERIFY(design.hash() != before);
      const auto opened = read(*writeDesign(design, false, Job()));
      DIATOM_VERIFY_OK(opened);
      QVERIFY(opened->notes.empty());
      QVERIFY(opened->design == design);
   }

   void everyFieldOfTheSetUpTellsInTheHash()
   {
      const Hash whole = boundary().hash();
      const auto differs = [&](auto change) {
         Design changed = boundary();
         change(changed);
         return !(changed.hash() == whole);
      };
      QVERIFY(differs([](Design &d) { d.setup.supports[2].where = Index{2, 0, 0}; }));
      QVERIFY(differs([](Design &d) { d.setup.drives[0].curve[1].value *= 1 + 1e-15; }));
      QVERIFY(differs([](Design &d) { d.setup.drives[1].freedom = 4; }));
      QVERIFY(differs([](Design &d) { d.setup.starts[1].about.reset(); }));
      QVERIFY(differs([](Design &d) { d.setup.starts[0].displacement[0] = 0; }));
      for (const auto change : {+[](Material &m) { m.cellModel = CellModel::bond; },
                                +[](Material &m) { m.poissonCoupling = true; }})
         QVERIFY(differs([&](Design &d) {
            auto palette = *d.model.materials;
            change(palette[0]);
            d.model.materials = std::make_shared<const std::vector<Material>>(palette);
         }));
   }

   void cellsAreWrittenAlikeHoweverTheyCameAbout()
   {
      std::mt19937 random(20261122);
      for (int round = 0; round < 20; ++round) {
         Design one, two;
         (void)one.model.setMaterial(material("a"));
         (void)one.model.setMaterial(material("b"));
         two = one;
         std::map<Index, Cell> plain;
         for (int k = 0; k < 60; ++k) {
            const auto at = [&random] { return static_cast<int>(random() % 50) - 25; };
            Box box;
            box.extend(Index{at(), at(), at()});
            box.extend(box.min + Index{int(random() % 20), int(random() % 20), int(random() % 20)});
            const Cell cell{static_cast<MaterialIndex>(random() % 3), 0, 0};
            one.model.root.cells.fill(box, cell);
            for (int x = box.min.x; x <= box.max.x; ++x)
               for (int y = box.min.y; y <= box.max.y; ++y)
                  for (int z = box.min.z; z <= box.max.z; ++z)
                     plain[{x, y, z}] = cell;
         }
         for (auto at = plain.rbegin(); at != plain.rend(); ++at)
            if (!at->second.empty())
               two.model.root.cells.set(at->first, at->second);
         for (const bool packed : {false, true}) {
            const auto a = writeDesign(one, packed, Job()), b = writeDesign(two, packed, Job());
            DIATOM_VERIFY_OK(a);
            QVERIFY(*a == *b);
            const auto back = read(*a);
            DIATOM_VERIFY_OK(back);
            QVERIFY(back->design.model.root.cells == two.model.root.cells);
         }
      }
   }

   void largeUniformBlocksStaySmall()
   {
      Design design;
      (void)design.model.setMaterial(material("a"));
      design.model.root.cells.fill({{0, 0, 0}, {1023, 1023, 1023}}, {1, 0, 0});
      const auto bytes = writeDesign(design, true, Job());
      DIATOM_VERIFY_OK(bytes);
      QVERIFY(bytes->size() < 2000);
      const auto back = read(*bytes);
      DIATOM_VERIFY_OK(back);
      QCOMPARE(back->design.model.root.cells.count(), std::uint64_t{1} << 30);
   }

   void savingKeepsTheOldFileWhenItFails()
   {
      QTemporaryDir dir;
      const std::filesystem::path file = dir.filePath("d.diatom").toStdString();
      DIATOM_VERIFY_OK(saveDesign(everything(), file, Job()));
      const auto first = readFile(file);
      Job cancelled;
      cancelled.cancel();
      Design large = everything();
      for (int i = 0; i < 300'000; ++i)
         large.model.root.cells.set({i % 100, i / 100 % 100, 2 * (i / 10000) + 100}, {1, 0, 0});
      QVERIFY(!saveDesign(large, file, cancelled).ok());
      QVERIFY(*readFile(file) == *first);
      DIATOM_VERIFY_OK(openDesign(file, Job()));
      const auto nowhere = saveDesign(large, dir.filePath("no/such/folder.diatom").toStdString(), Job());
      QVERIFY(!nowhere.ok());
      QCOMPARE(nowhere.error().code, ErrorCode::unwritable);
   }

   void unknownKeysAreKeptAndWrittenBack()
   {
      const auto text = small(R"(, "later": {"x": [1, 2.5, "z"]}, "simulation": {"wind": 3, "drag_1_s": 1})");
      const auto opened = read(text);
      DIATOM_VERIFY_OK(opened);
      QCOMPARE(opened->notes.size(), std::size_t{2});
      const auto bytes = writeDesign(opened->design, false, Job());
      DIATOM_VERIFY_OK(bytes);
      const auto json = nlohmann::json::parse(*bytes);
      QVERIFY(json["later"] == nlohmann::json::parse(R"({"x": [1, 2.5, "z"]})"));
      QVERIFY(json["simulation"]["wind"] == 3);
      const auto again = read(*bytes);
      DIATOM_VERIFY_OK(again);
      QVERIFY(again->design == opened->design);
   }

   void badDocumentsGetOneSentenceWithThePlace_data()
   {
      QTest::addColumn<QByteArray>("text");
      QTest::addColumn<QByteArray>("says");
      const auto row = [](const char *name, const std::string &text, const char *says) {
         QTest::newRow(name) << QByteArray(text.data(), static_cast<int>(text.size())) << QByteArray(says);
      };
      row("empty", "", "empty");
      row("garbage", std::string(100, '\x93'), "byte 1");
      row("truncated", R"({"diatom": 1, "lattice": {)", "complete JSON");
      row("deep", "{\"diatom\":" + std::string(2'000'000, '['), "64 levels");
      row("newer", R"({"diatom": 2, "lattice": 7})", "newer version");
      row("version of a wrong type", R"({"diatom": "one"})", "/diatom");
      row("no lattice", R"({"diatom": 1, "materials": []})", "/lattice");
      row("other json", R"({"a": 1})", "no design");
      row("wrong type", small(R"(, "simulation": {"drag_1_s": "fast"})"), "/simulation/drag_1_s");
      row("not finite", small(R"(, "simulation": {"drag_1_s": 1e999})"), "1e999");
      row("negative density",
          R"({"diatom":1,"lattice":{"id":"l"},"materials":[{"id":"a","density_kg_m3":-1}]})",
          "/materials/0/density_kg_m3");
      row("two materials", R"({"diatom":1,"lattice":{"id":"l"},"materials":[{"id":"a"},{"id":"a"}]})",
          "two materials");
      row("unknown material", small(R"(, "assembly": {"cells": [["c", [0,0,0]]]})"), "/assembly/cells/0/0");
      row("cell twice", small(R"(, "assembly": {"cells": [["a", [0,0,0], [2,2,2]], ["b", [1,1,1]]]})"),
          "[1, 1, 1] is given twice");
      row("out of range", small(R"(, "assembly": {"cells": [["a", [4000000000,0,0]]]})"),
          "/assembly/cells/0/1/0");
      row("not whole", small(R"(, "assembly": {"cells": [["a", [0.5,0,0]]]})"), "whole number");
      row("enormous", small(R"(, "assembly": {"cells": [["a", [0,0,0], [1000000000, 1000000000, 1]]]})"),
          "bricks");
      row("unknown composite", small(R"(, "assembly": {"instances": [["u", [0,0,0]]]})"),
          "no composite \"u\"");
      row("itself",
          small(
              R"(, "definitions": [{"id":"u","instances":[["v",[0,0,0]]]},{"id":"v","instances":[["u",[0,0,0]]]}])"),
          "contains itself");
      row("nowhere", small(R"(, "simulation": {"supports": [{"fixed": ["x"]}]})"),
          "/simulation/supports/0/cell");
      row("in two ways", small(R"(, "simulation": {"loads": [{"cell": [0,0,0], "material": "a"}]})"),
          "/simulation/loads/0: is on more than one of cell, box and material");
      row("box the wrong way round", small(R"(, "simulation": {"supports": [{"box": [[1,0,0],[0,5,5]]}]})"),
          "/simulation/supports/0/box");
      row("box of one corner", small(R"(, "simulation": {"supports": [{"box": [[1,0,0]]}]})"), "two corners");
      row("on an unknown material", small(R"(, "simulation": {"starts": [{"material": "zinc"}]})"),
          "/simulation/starts/0/material: there is no material \"zinc\"");
      row("freedom of no name", small(R"(, "simulation": {"drives": [{"cell": [0,0,0], "freedom": "w"}]})"),
          "/simulation/drives/0/freedom");
      row("no curve", small(R"(, "simulation": {"drives": [{"cell": [0,0,0], "freedom": "x"}]})"),
          "/simulation/drives/0/curve_s_m");
      row("curve of another kind",
          small(
              R"(, "simulation": {"drives": [{"cell": [0,0,0], "freedom": "rx", "curve_s_rad": [[0,0]], "curve_s_m": [[0,0]]}]})"),
          "does not fit the freedom rx");
      row("curve without points",
          small(R"(, "simulation": {"drives": [{"cell": [0,0,0], "freedom": "x", "curve_s_m": []}]})"),
          "has no points");
      row("curve back in time",
          small(
              R"(, "simulation": {"drives": [{"cell": [0,0,0], "freedom": "x", "curve_s_m": [[0,0],[1,2],[0.5,3]]}]})"),
          "0.5 s follows 1 s");
      row("cell model of no name",
          R"({"diatom":1,"lattice":{"id":"l"},"materials":[{"id":"a","cell_model":"jelly"}]})",
          "/materials/0/cell_model");
      row("packed elsewhere", small(R"(, "assembly": {"cells": {"packed": "cells/assembly"}})"),
          "not in the file");
      auto packed = *writeDesign(everything(), true, Job());
      row("cut zip", packed.substr(0, packed.size() / 2), "cut short or damaged");
      row("zip of something else", *writeArchive({{"a.txt", "hello"}}), "document.json");
      packed[packed.size() / 3] = static_cast<char>(packed[packed.size() / 3] ^ 0x55);
      row("damaged zip", packed, "damaged");
   }
   void badDocumentsGetOneSentenceWithThePlace()
   {
      QFETCH(QByteArray, text);
      QFETCH(QByteArray, says);
      const auto opened = read(text.toStdString());
      QVERIFY(!opened.ok());
      const QByteArray message = QByteArray::fromStdString(opened.error().message);
      QCOMPARE(opened.error().code, ErrorCode::unreadable);
      QVERIFY2(message.startsWith("test.diatom: "), message.constData());
      QVERIFY2(message.contains(says), message.constData());
      QVERIFY2(message.size() < 400 && !message.contains('\n'), message.constData());
   }

   void packedCellsOutOfPlaceAreRefused()
   {
      const std::string head = R"({"diatom": 1, "lattice": {"id": "l"}, "materials": [{"id": "a"}],
                                   "assembly": {"cells": {"packed": "c"}}})";
      for (const std::string &cells :
           {std::string(), std::string("DIATCEL2"), std::string("DIATCEL1garbage")}) {
         const auto opened = read(*writeArchive({{"document.json", head}, {"c", cells}}));
         QVERIFY(!opened.ok());
         QVERIFY(opened.error().message.find("/assembly/cells: the packed cells") != std::string::npos);
      }
   }

   void damagedBytesNeverCrash()
   {
      const unsigned seed = 7;
      qInfo("seed %u", seed);
      std::mt19937 random(seed);
      for (const bool packed : {false, true}) {
         const auto good = *writeDesign(everything(), packed, Job());
         for (int round = 0; round < 400; ++round) {
            auto bad = good;
            for (unsigned k = 0; k < 1 + random() % 4; ++k)
               bad[random() % bad.size()] = static_cast<char>(random());
            if (random() % 4 == 0)
               bad.resize(random() % bad.size());
            const auto opened = read(bad);
            if (!opened.ok())
               QVERIFY(!opened.error().message.empty());
         }
      }
   }

   void theExampleOfTheManualIsADesign()
   {
      const auto text = readFile(test::sourceDir() / "docs/file-format.md");
      DIATOM_VERIFY_OK(text);
      const std::size_t begin = text->find("```json\n"), end = text->find("\n```\n", begin);
      QVERIFY(begin != std::string::npos && end != std::string::npos);
      const auto opened = read(text->substr(begin + 8, end - begin - 8));
      DIATOM_VERIFY_OK(opened);
      QVERIFY(opened->notes.empty()); // every key is known
      const Setup &setup = opened->design.setup;
      QCOMPARE(setup.supports.size(), std::size_t{2});
      QCOMPARE(setup.drives.size(), std::size_t{2});
      QVERIFY(setup.starts[0].about.has_value());
   }

   void filesOfVersionOneStayReadable()
   {
      int files = 0;
      for (const auto &entry : std::filesystem::directory_iterator(test::sourceDir() / "tests/files/v1")) {
         if (entry.path().extension() != ".diatom")
            continue;
         ++files;
         const auto opened = openDesign(entry.path(), Job());
         DIATOM_VERIFY_OK(opened);
         const auto expected = readFile(entry.path().string() + ".hash");
         DIATOM_VERIFY_OK(expected);
         QCOMPARE(opened->design.hash().text() + "\n", *expected);
         const auto bytes = readFile(entry.path());
         const auto again = writeDesign(opened->design, bytes->starts_with("PK"), Job());
         DIATOM_VERIFY_OK(again);
         const auto reread = read(*again);
         DIATOM_VERIFY_OK(reread);
         QVERIFY(reread->design == opened->design);
      }
      QVERIFY(files >= 3);
   }

   /// DIATOM_WRITE_FIXTURES=1 writes the fixtures anew, which only a new version of the format may do.
   void everythingIsWrittenAsInItsFixture()
   {
      const auto folder = test::sourceDir() / "tests/files/v1";
      if (std::getenv("DIATOM_WRITE_FIXTURES"))
         for (const auto &[name, design] :
              {std::pair{"everything.diatom", everything()},
               std::pair{"everything_packed.diatom", everything()}, std::pair{"boundary.diatom", boundary()}})
         {
            const bool packed = std::string_view(name).find("packed") != std::string_view::npos;
            DIATOM_VERIFY_OK(writeFileAtomic(folder / name, *writeDesign(design, packed, Job())));
            DIATOM_VERIFY_OK(
                writeFileAtomic(folder / (std::string(name) + ".hash"), design.hash().text() + "\n"));
         }
      // The packed one is compared by content elsewhere: another zstd may compress otherwise.
      QVERIFY(*writeDesign(everything(), false, Job()) == *readFile(folder / "everything.diatom"));
      QVERIFY(*writeDesign(boundary(), false, Job()) == *readFile(folder / "boundary.diatom"));
   }
};

QTEST_APPLESS_MAIN(document_format_test)
#include "document_format_test.moc"
