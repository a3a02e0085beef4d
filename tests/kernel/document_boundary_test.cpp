// Commands on supports, drives, loads and starts: what each does on cells, regions and materials, how it is
// undone, and what it refuses.
#include "document/document.h"
#include "formats/files.h"
#include "tests/kernel/document_run.h"
#include "tests/support/support.h"

using namespace diatom;
using nlohmann::json;

namespace {

/// Four cells of "a" along x and, above the first, one of "b".
Document start()
{
   Design design;
   design.model.lattice.id = "org.diatom_cad.lattice.cube";
   Document document(test::catalogue(), design);
   const auto must = [&](const char *command, const char *arguments) {
      if (const auto done = document.run(command, json::parse(arguments), Job()); !done.ok())
         qFatal("%s", done.error().message.c_str());
   };
   must("set-material", R"({"id": "a"})");
   must("set-material", R"({"id": "b"})");
   must("set-material", R"({"id": "unused"})");
   must("fill", R"({"box": [[0,0,0],[3,0,0]], "material": "a"})");
   must("place", R"({"cell": [0,0,1], "material": "b"})");
   return document;
}

} // namespace

class document_boundary_test : public QObject
{
   Q_OBJECT

private slots:
   void everyEntryGoesOnCellsRegionsAndMaterials_data()
   {
      QTest::addColumn<QString>("command");
      QTest::addColumn<QString>("values");
      QTest::newRow("support") << "support"
                               << R"("fixed": ["x", "rz"])";
      QTest::newRow("drive") << "drive"
                             << R"("freedom": "ry", "curve_s_rad": [[0, 0], [1, 0.5]])";
      QTest::newRow("load") << "load"
                            << R"("force_N": [0, 0, 1])";
      QTest::newRow("start") << "start"
                             << R"("velocity_m_s": [0, 2, 0], "about_m": [0, 0, 0])";
   }
   void everyEntryGoesOnCellsRegionsAndMaterials()
   {
      QFETCH(QString, command);
      QFETCH(QString, values);
      auto d = start();
      const auto places = [&]() -> std::vector<Where> {
         std::vector<Where> found;
         const Setup &setup = d.design().setup;
         for (const Support &item : setup.supports)
            found.push_back(item.where);
         for (const Drive &item : setup.drives)
            found.push_back(item.where);
         for (const Load &item : setup.loads)
            found.push_back(item.where);
         for (const Start &item : setup.starts)
            found.push_back(item.where);
         return found;
      };
      const auto with = [&](const char *where) {
         return QString("{%1, %2}").arg(where, values).toStdString();
      };
      const Hash empty = d.design().hash();
      DO(command.toUtf8().constData(), with(R"("cell": [1,0,0])").c_str());
      QCOMPARE(places(), (std::vector<Where>{Index{1, 0, 0}}));
      DO(command.toUtf8().constData(),
         with(R"("cells": [[1,0,0],[2,0,0]])").c_str()); // takes the first's place
      QCOMPARE(places(), (std::vector<Where>{Index{1, 0, 0}, Index{2, 0, 0}}));
      DO(command.toUtf8().constData(), with(R"("box": [[3,0,0],[9,9,9]])").c_str()); // cells of now
      QCOMPARE(places().back(), Where(Index{3, 0, 0}));
      DO(command.toUtf8().constData(), with(R"("region": [[0,0,0],[9,0,0]])").c_str());
      QCOMPARE(places().back(), Where(Box{{0, 0, 0}, {9, 0, 0}}));
      DO(command.toUtf8().constData(), with(R"("material": "b")").c_str());
      QCOMPARE(places().back(), Where(OfMaterial{"b"}));
      QCOMPARE(places().size(), std::size_t{5});
      const auto bytes = writeDesign(d.design(), false, Job());
      DIATOM_VERIFY_OK(bytes);
      const auto reread = readDesign(*bytes, "saved", Job());
      DIATOM_VERIFY_OK(reread);
      QVERIFY(reread->design == d.design());
      for (int k = 0; k < 5; ++k)
         QVERIFY(d.undo());
      QVERIFY(d.design().hash() == empty);

      const QByteArray id = command.toUtf8();
      const auto refused = [&](const char *where, const char *says) {
         const auto message = test::run(d, id.constData(), with(where).c_str());
         QVERIFY2(message.starts_with(id.constData()), message.c_str());
         QVERIFY2(message.find(says) != std::string::npos, message.c_str());
         QVERIFY(d.design().hash() == empty);
      };
      refused(R"("cell": [7,7,7])", "no cell at [7, 7, 7]");
      refused(R"("box": [[7,7,7],[9,9,9]])", "no cells in the box");
      refused(R"("region": [[7,7,7],[9,9,9]])", "no cell in the box (7, 7, 7) to (9, 9, 9)");
      refused(R"("material": "unused")", "no cell in the material unused");
      refused(R"("material": "zinc")", "zinc");
      refused(R"("material": "a", "cell": [0,0,0])", "only one of cell, cells, box, region, material");
   }

   void anEntryWithoutValuesIsRemoved()
   {
      auto d = start();
      DO("load", R"({"material": "a", "force_N": [0, 0, 1]})");
      DO("load", R"({"material": "a"})");
      QVERIFY(d.design().setup.loads.empty());
      DO("start", R"({"cell": [0,0,0], "spin_rad_s": [0, 0, 1]})");
      DO("start", R"({"cell": [0,0,0]})");
      QVERIFY(d.design().setup.starts.empty());
      DO("support", R"({"region": [[0,0,0],[3,3,3]]})");
      DO("unsupport", R"({"region": [[0,0,0],[3,3,3]]})");
      QVERIFY(d.design().setup.supports.empty());
      REFUSED("unsupport", R"({"cell": [0,0,0]})", "none of these cells is supported");
   }

   void aCellIsDrivenInEachFreedomByOneCurve()
   {
      auto d = start();
      DO("drive", R"({"cell": [3,0,0], "freedom": "x", "curve_s_m": [[0,0],[1,0.001]]})");
      DO("drive", R"({"cell": [3,0,0], "freedom": "rz", "curve_s_rad": [[0,0],[1,1]]})");
      DO("drive", R"({"cell": [3,0,0], "freedom": "x", "curve_s_m": [[0,0.002]]})");
      const auto &drives = d.design().setup.drives;
      QCOMPARE(drives.size(), std::size_t{2});
      QCOMPARE(drives[0].freedom, 5);
      QCOMPARE(drives[1].curve, (Curve{{0, 0.002}}));
      REFUSED("drive", R"({"cell": [3,0,0], "freedom": "x"})", "curve_s_m");
      REFUSED("drive", R"({"cell": [3,0,0], "freedom": "x", "curve_s_rad": [[0,0]]})", "curve_s_m");
      REFUSED("drive", R"({"cell": [3,0,0], "freedom": "up", "curve_s_m": [[0,0]]})", "/freedom");
      REFUSED("drive", R"({"cell": [3,0,0], "freedom": "x", "curve_s_m": [[1,0],[0,0]]})", "do not ascend");
      REFUSED("undrive", R"({"cell": [0,0,0]})", "none of these cells is driven");
      DO("undrive", R"({"box": [[3,0,0],[3,0,0]]})");
      QVERIFY(d.design().setup.drives.empty());
   }

   void entriesGoWithTheLastOfTheirCells()
   {
      auto d = start();
      DO("support", R"({"material": "b"})");
      DO("load", R"({"region": [[2,0,0],[3,0,0]], "force_N": [1,0,0]})");
      DO("erase", R"({"cell": [3,0,0]})");
      QCOMPARE(d.design().setup.loads.size(), std::size_t{1});
      DO("erase", R"({"cells": [[2,0,0],[0,0,1]]})");
      QVERIFY(d.design().setup.loads.empty() && d.design().setup.supports.empty());
      QVERIFY(d.undo());
      QVERIFY(!d.design().setup.loads.empty() && !d.design().setup.supports.empty());
   }

   void aRegionTakesWhatIsPlacedInItLater()
   {
      auto d = start();
      DO("support", R"({"region": [[0,0,0],[0,9,0]]})");
      DO("place", R"({"cell": [0,1,0], "material": "a"})");
      QCOMPARE(d.design().setup.supports, (std::vector<Support>{{Box{{0, 0, 0}, {0, 9, 0}}, kAllFreedoms}}));
   }

   void theModelOfCellsIsAMatterOfTheirMaterial()
   {
      auto d = start();
      DO("set-material", R"({"id": "a", "cell_model": "solid"})");
      DO("set-material", R"({"id": "b", "cell_model": "block", "poisson_coupling": true})");
      const Model &model = d.design().model;
      QVERIFY(model.material(model.material("a")).cellModel == CellModel::solid);
      QVERIFY(model.material(model.material("b")).poissonCoupling);
      REFUSED("set-material", R"({"id": "a", "cell_model": "foam"})", "/cell_model");
   }
};

QTEST_APPLESS_MAIN(document_boundary_test)
#include "document_boundary_test.moc"
