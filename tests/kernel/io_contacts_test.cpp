// Surfaces with indices are 2-manifolds whatever touches at edges and corners, and the contacts are counted.
#include "io/solid_mesh.h"
#include "io/split_contacts.h"
#include "support/mesh.h"
#include "support/scenes.h"

#include <cmath>

using namespace diatom;

namespace {

void addLattices()
{
   QTest::addColumn<QString>("lattice");
   for (const std::string &id : test::kLattices)
      QTest::newRow(id.c_str()) << QString::fromStdString(id);
}

SolidMesh solidOf(const test::Scene &scene)
{
   auto mesh = cellSolid(scene.hierarchy(), {}, Job());
   if (!mesh)
      qFatal("%s", mesh.error().message.c_str());
   return *std::move(mesh);
}

SolidMesh cubesAt(const std::vector<Index> &cells)
{
   test::Scene scene(test::kLattices[0]);
   for (const Index i : cells)
      scene.model.root.cells.set(i, {1, 0, 0});
   return solidOf(scene);
}

QString faultOf(const SolidMesh &mesh)
{
   return QString::fromStdString(test::manifoldFault(mesh.triangles, mesh.vertices.size()));
}

} // namespace

class ContactsTest : public QObject
{
   Q_OBJECT

private slots:
   void cubesThatTouchAreCountedAndParted_data();
   void cubesThatTouchAreCountedAndParted();
   void everyArrangementOfCubesRoundACornerIsAManifold();
   void blobsAreManifoldsOfTheirVolume_data() { addLattices(); }
   void blobsAreManifoldsOfTheirVolume();
   void checkersTouchEverywhere();
   void anOpenSurfaceIsRefusedWithThePlace();
};

void ContactsTest::cubesThatTouchAreCountedAndParted_data()
{
   QTest::addColumn<QVector<int>>("cells");
   QTest::addColumn<int>("edges");
   QTest::addColumn<int>("corners");
   QTest::addColumn<int>("vertices");
   // Vertices: 8 a cube, 12 for two that share a face.
   QTest::newRow("alone") << QVector<int>{0, 0, 0} << 0 << 0 << 8;
   QTest::newRow("sharing a face") << QVector<int>{0, 0, 0, 1, 0, 0} << 0 << 0 << 12;
   QTest::newRow("sharing an edge") << QVector<int>{0, 0, 0, 1, 1, 0} << 1 << 0 << 16;
   QTest::newRow("sharing a corner") << QVector<int>{0, 0, 0, 1, 1, 1} << 0 << 1 << 16;
   QTest::newRow("an edge two long") << QVector<int>{0, 0, 0, 0, 0, 1, 1, 1, 0, 1, 1, 1} << 2 << 0 << 24;
   QTest::newRow("three in a step") << QVector<int>{0, 0, 0, 1, 1, 0, 2, 0, 0} << 2 << 0 << 24;
}

void ContactsTest::cubesThatTouchAreCountedAndParted()
{
   QFETCH(QVector<int>, cells);
   QFETCH(int, edges);
   QFETCH(int, corners);
   QFETCH(int, vertices);
   std::vector<Index> at;
   for (int i = 0; i + 2 < cells.size(); i += 3)
      at.push_back({cells[i], cells[i + 1], cells[i + 2]});
   const auto mesh = cubesAt(at);
   QCOMPARE(faultOf(mesh), QString());
   QCOMPARE(mesh.edgeContacts, std::uint64_t(edges));
   QCOMPARE(mesh.vertexContacts, std::uint64_t(corners));
   QCOMPARE(mesh.vertices.size(), std::size_t(vertices));
}

void ContactsTest::everyArrangementOfCubesRoundACornerIsAManifold()
{
   // All 255 ways to fill the 8 places round a corner: among them every way edges and corners can touch
   // there, and those where an edge's pieces stay joined at an end.
   for (int filled = 1; filled < 256; ++filled) {
      std::vector<Index> cells;
      for (int k = 0; k < 8; ++k)
         if (filled >> k & 1)
            cells.push_back({k & 1, k >> 1 & 1, k >> 2 & 1});
      const auto mesh = cubesAt(cells);
      QVERIFY2(faultOf(mesh).isEmpty(), qPrintable(QString("%1: %2").arg(filled).arg(faultOf(mesh))));
      const double volume = double(cells.size()) * 1e-9;
      QVERIFY(std::abs(volumeOf(mesh) - volume) < 1e-15 * volume * 100); // a hundred rounded terms
   }
   // And 3000 of the 2^27 ways to fill 3 x 3 x 3 places, spread by Fibonacci hashing.
   for (std::uint32_t n = 1; n < 3000; ++n) {
      const std::uint32_t filled = (n * 2654435761u) & 0x7ff'ffff;
      std::vector<Index> cells;
      for (int k = 0; k < 27; ++k)
         if (filled >> k & 1)
            cells.push_back({k % 3, k / 3 % 3, k / 9});
      const auto mesh = cubesAt(cells);
      QVERIFY2(faultOf(mesh).isEmpty(), qPrintable(QString("%1: %2").arg(filled).arg(faultOf(mesh))));
   }
}

void ContactsTest::blobsAreManifoldsOfTheirVolume()
{
   QFETCH(QString, lattice);
   for (const unsigned seed : {1u, 2u, 3u}) {
      test::Scene scene(lattice.toStdString());
      for (const Index i : test::blob(*scene.lattice, 500, seed))
         scene.model.root.cells.set(i, {static_cast<MaterialIndex>(1 + floorMod(i.x, 3)), 0, 0});
      const auto mesh = solidOf(scene);
      QVERIFY2(faultOf(mesh).isEmpty(), qPrintable(faultOf(mesh)));
      QCOMPARE(mesh.materials.size(), mesh.triangles.size());
      // Sums of a few thousand rounded terms.
      QVERIFY(std::abs(volumeOf(mesh) / test::cellVolume(scene.hierarchy()) - 1) < 1e-9);
      const auto again = solidOf(scene);
      QVERIFY(mesh.triangles == again.triangles && mesh.vertices == again.vertices);
   }
}

void ContactsTest::checkersTouchEverywhere()
{
   // Every other cube of n^3: inside, each edge is shared by two cubes; corners are ends of such edges.
   constexpr int n = 6;
   std::vector<Index> cells;
   for (int k = 0; k < n * n * n; ++k)
      if ((k % n + k / n % n + k / (n * n)) % 2 == 0)
         cells.push_back({k % n, k / n % n, k / (n * n)});
   const auto mesh = cubesAt(cells);
   QCOMPARE(faultOf(mesh), QString());
   QCOMPARE(mesh.edgeContacts, std::uint64_t(3 * n * (n - 1) * (n - 1)));
   QCOMPARE(mesh.vertexContacts, std::uint64_t(0));
   QCOMPARE(mesh.vertices.size(), 8 * cells.size());
}

void ContactsTest::anOpenSurfaceIsRefusedWithThePlace()
{
   auto mesh = cubesAt({{3, 0, 0}});
   mesh.triangles.pop_back();
   mesh.materials.pop_back();
   const Status split = splitContacts(mesh);
   QVERIFY(!split);
   QVERIFY2(split.error().message.find("0.00") != std::string::npos, split.error().message.c_str());
}

QTEST_APPLESS_MAIN(ContactsTest)
#include "io_contacts_test.moc"
