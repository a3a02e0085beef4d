// Which faces and cells are drawn.
#include "render/cell_mesh.h"
#include "render/color_map.h"
#include "render/composite_boxes.h"
#include "scenes.h"

#include <set>
#include <tuple>

using namespace diatom;
using namespace diatom::render;
using namespace diatom::test;

class CellMeshTest : public QObject
{
   Q_OBJECT

private slots:
   void drawsExactlyTheFacesThatNoCellCovers_data()
   {
      QTest::addColumn<QString>("lattice");
      for (const std::string &id : latticeIds())
         QTest::newRow(id.c_str()) << QString::fromStdString(id);
   }

   void drawsExactlyTheFacesThatNoCellCovers()
   {
      QFETCH(QString, lattice);
      const auto made = makeLattice(lattice.toStdString());
      QVERIFY(made);
      const Hierarchy hierarchy(made, randomModel(lattice.toStdString(), 6, 0.7, 7));
      const auto mesh = buildCellMesh(hierarchy, Job());
      DIATOM_VERIFY_OK(mesh);

      // By brute force: every cell, every face, one question to the hierarchy each.
      std::set<std::tuple<Index, int>> expected;
      std::set<Index> cells;
      hierarchy.visit(hierarchy.bounds(), [&](Index i, Cell) {
         const int site = made->site(i);
         for (int f = 0; f < static_cast<int>(made->shape(site).faces.size()); ++f) {
            const Link *link = made->acrossFace(site, f);
            if (link && !hierarchy.at(i + link->offset).empty())
               continue;
            expected.insert({i, f});
            cells.insert(i);
         }
         return true;
      });
      QVERIFY(expected.size() > 100);

      std::set<std::tuple<Index, int>> drawn;
      for (std::size_t t = 0; t < mesh->types.types.size(); ++t)
         for (std::size_t c = 0; c < mesh->chunks.size(); ++c) {
            const std::size_t run = t * mesh->chunks.size() + c;
            for (std::uint32_t k = mesh->start[run]; k < mesh->start[run + 1]; ++k) {
               const Index cell = mesh->cells[mesh->faces[k]];
               QCOMPARE(made->site(cell), mesh->types.types[t].site);
               drawn.insert({cell, mesh->types.types[t].face});
            }
         }
      QCOMPARE(mesh->exposedFaces(), std::uint64_t(expected.size()));
      QVERIFY(drawn == expected);
      QCOMPARE(mesh->cells.size(), cells.size()); // buried cells have no slot
   }

   void aMovingSceneKeepsAllFacesOfTheCellsThatShow()
   {
      const std::string id = LatticeSpec{}.id;
      Model model = emptyModel(id);
      model.root.cells.fill({{0, 0, 0}, {4, 4, 4}}, Cell{1, 0, 0});
      const auto mesh = buildCellMesh(Hierarchy(makeLattice(id), model), Job(), 1000, Covered::keptOnSurface);
      DIATOM_VERIFY_OK(mesh);
      QCOMPARE(mesh->cells.size(), std::size_t(125 - 27)); // the inner 3x3x3 stays away
      QCOMPARE(mesh->exposedFaces(), std::uint64_t(98 * 6));
   }

   void doesNotDependOnTheNumberOfThreads()
   {
      const std::string id = LatticeSpec{}.id;
      const Hierarchy hierarchy(makeLattice(id), randomModel(id, 20, 0.8, 3));
      Job one, many;
      one.setThreads(1);
      many.setThreads(4);
      const auto a = buildCellMesh(hierarchy, one), b = buildCellMesh(hierarchy, many);
      DIATOM_VERIFY_OK(a);
      DIATOM_VERIFY_OK(b);
      QVERIFY(a->faces == b->faces && a->start == b->start && a->position == b->position);
   }

   void facesAreFlatOutwardAndHaveEdgeCoordinatesThatReachOneOnTheRim()
   {
      for (const std::string &id : latticeIds()) {
         const auto lattice = makeLattice(id);
         for (const FaceType &type : faceTypes(*lattice).types) {
            QVERIFY(type.fan.size() >= 3);
            for (const auto &corner : type.fan) {
               QVERIFY(type.normal.dot(corner.position) > 0); // convex about the origin
               // A corner lies on two edges; the middle of a fan on none. 1e-5: single precision.
               const auto size = corner.edge.cwiseAbs();
               const int onRim = static_cast<int>((size.array() > 1 - 1e-5f).count());
               QVERIFY2(size.maxCoeff() < 1 + 1e-5f || type.fan.size() == 3, id.c_str());
               QVERIFY(onRim >= 1 || size.maxCoeff() == 0);
            }
         }
      }
   }

   void refusesMoreCellsThanAllowedWithoutExpandingThem()
   {
      const std::string id = LatticeSpec{}.id;
      Model model = emptyModel(id);
      model.root.cells.fill({{0, 0, 0}, {9999, 9999, 9999}}, Cell{1, 0, 0}); // 10^12 cells
      const Hierarchy hierarchy(makeLattice(id), model);
      const auto mesh = buildCellMesh(hierarchy, Job(), 1000);
      QVERIFY(!mesh.ok());
      QVERIFY(mesh.error().message.find("hierarchy view") != std::string::npos);
      const auto boxes = blockBoxes(hierarchy.lattice(), model, 100);
      QVERIFY(!boxes.empty() && boxes.size() <= 100);
   }

   void compositesBecomeBoxesAroundTheirCells()
   {
      const std::string id = LatticeSpec{}.id;
      Model model = emptyModel(id);
      Definition definition;
      definition.id = "bar";
      definition.body.cells.fill({{0, 0, 0}, {3, 0, 0}}, Cell{1, 0, 0});
      const auto number = model.setDefinition(definition);
      DIATOM_VERIFY_OK(number);
      model.root.instances.insert({*number, {10, 0, 0}, 0});
      model.root.instances.insert({*number, {10, 4, 0}, 0});
      const auto lattice = makeLattice(id);
      const auto boxes = compositeBoxes(*lattice, model);
      QCOMPARE(boxes.size(), std::size_t(2));
      for (const SolidBox &box : boxes) {
         Bounds bounds;
         for (int i = 0; i < 8; ++i)
            bounds.extend(box.centre + box.axes * Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
         bool inside = true;
         const double y = std::round(box.centre.y() / lattice->spec().pitch);
         for (int x = 10; x <= 13; ++x)
            inside = inside && bounds.contains(lattice->position({x, static_cast<std::int32_t>(y), 0}));
         QVERIFY(inside);
      }
   }

   void theColourMapGetsLighterAllTheWay()
   {
      // Relative luminance (ITU-R BT.709 weights on linear light).
      const auto luminance = [](Rgba c) {
         const auto linear = [](double v) { return std::pow(v / 255, 2.2); };
         return 0.2126 * linear(c.r) + 0.7152 * linear(c.g) + 0.0722 * linear(c.b);
      };
      for (int i = 0; i < 32; ++i)
         QVERIFY(luminance(fieldColor((i + 1) / 32.0)) > luminance(fieldColor(i / 32.0)));
      QCOMPARE(fieldColor(-5), fieldColor(0));
      QCOMPARE(fieldColor(7), fieldColor(1));
      QCOMPARE(fieldColor(std::nan("")), (Rgba{128, 128, 128, 255}));
   }

   void legendsHaveRoundNumbersWithinTheRange()
   {
      const Legend legend = lengthLegend("displacement", 3.27e-3);
      QCOMPARE(legend.title, std::string("displacement (mm)"));
      QCOMPARE(legend.texts, (std::vector<std::string>{"0", "1", "2", "3"}));
      QCOMPARE(lengthLegend("d", 12e-6).texts, (std::vector<std::string>{"0", "5", "10"}));
      QCOMPARE(lengthLegend("d", 0.12e-6).texts.back(), std::string("0.10"));
      QCOMPARE(lengthLegend("d", 0).texts, (std::vector<std::string>{"0"}));
   }
};

QTEST_APPLESS_MAIN(CellMeshTest)
#include "cell_mesh_test.moc"
