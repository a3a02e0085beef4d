// The surface of an assembly: closed to the last bit, without inner walls, by material and through
// composites.
#include "io/surface.h"
#include "support/mesh.h"
#include "support/scenes.h"

#include <algorithm>
#include <cmath>
#include <functional>

using namespace diatom;

namespace {

struct Face
{
   Index cell;
   int face;
   MaterialIndex material;
   std::vector<test::Corner<double>> corners;
   auto operator<=>(const Face &) const = default;
};

/// Every exposed face, sorted.
std::vector<Face> facesOf(const Hierarchy &hierarchy, std::optional<MaterialIndex> material = {},
                          bool between = false)
{
   std::vector<Face> faces;
   const Status status = visitSurface(
       hierarchy, material, between,
       [&](const SurfaceFace &face) {
          Face copy{face.cell, face.face, face.material, {}};
          for (const Vec3 &corner : face.corners)
             copy.corners.push_back({corner.x(), corner.y(), corner.z()});
          faces.push_back(copy);
       },
       Job());
   if (!status)
      qFatal("%s", status.error().message.c_str());
   std::sort(faces.begin(), faces.end());
   return faces;
}

test::MeshFacts factsOf(const std::vector<Face> &faces, const std::function<bool(const Face &)> &wanted)
{
   std::vector<test::Triangle<double>> triangles;
   for (const Face &face : faces)
      if (wanted(face))
         for (std::size_t i = 2; i < face.corners.size(); ++i)
            triangles.push_back({face.corners[0], face.corners[i - 1], face.corners[i]});
   return test::meshFacts(triangles);
}

test::MeshFacts factsOf(const std::vector<Face> &faces)
{
   return factsOf(faces, [](const Face &) { return true; });
}

/// Volumes are sums of a few thousand rounded terms.
bool sameVolume(double got, double wanted) { return std::abs(got / wanted - 1) < 1e-9; }

void addLattices()
{
   QTest::addColumn<QString>("lattice");
   for (const std::string &id : test::kLattices)
      QTest::newRow(id.c_str()) << QString::fromStdString(id);
}

} // namespace

class SurfaceTest : public QObject
{
   Q_OBJECT

private slots:
   void randomBlobsHaveClosedSurfacesOfTheirVolume_data() { addLattices(); }
   void randomBlobsHaveClosedSurfacesOfTheirVolume();
   void hollowSolidsHaveTheirInnerSurfaceToo_data() { addLattices(); }
   void hollowSolidsHaveTheirInnerSurfaceToo();
   void aHollowCubeHasTheFacesOneCounts();
   void fullBlocksAreSkippedAndNothingElse();
   void twoCellsShareNoWall_data() { addLattices(); }
   void twoCellsShareNoWall();
   void everyMaterialHasAClosedSurfaceOfItsOwn_data() { addLattices(); }
   void everyMaterialHasAClosedSurfaceOfItsOwn();
   void nestedCompositesLookLikeTheCellsTheyHold_data() { addLattices(); }
   void nestedCompositesLookLikeTheCellsTheyHold();
   void anAspectScalesTheSurface();
   void surfacesFarFromTheOriginAreStillClosed_data() { addLattices(); }
   void surfacesFarFromTheOriginAreStillClosed();
   void farApartCellsCostNoTime();
   void anEmptyDesignHasNoSurface();
   void aCancelledJobEndsTheWalk();
};

void SurfaceTest::randomBlobsHaveClosedSurfacesOfTheirVolume()
{
   QFETCH(QString, lattice);
   for (const unsigned seed : {1u, 2u, 3u}) {
      test::Scene scene(lattice.toStdString());
      const auto cells = test::blob(*scene.lattice, 400, seed);
      for (const Index i : cells)
         scene.model.root.cells.set(i, {1, 0, 0});
      const auto facts = factsOf(facesOf(scene.hierarchy()));
      QVERIFY2(facts.closed, qPrintable(QString("seed %1").arg(seed)));
      QVERIFY(sameVolume(facts.volume, test::cellVolume(scene.hierarchy())));
   }
}

void SurfaceTest::hollowSolidsHaveTheirInnerSurfaceToo()
{
   QFETCH(QString, lattice);
   test::Scene scene(lattice.toStdString());
   const auto cells = test::hollowBox({-20, -3, 28}, {20, 5, 36}); // across several bricks
   for (const Index i : cells)
      scene.model.root.cells.set(i, {2, 0, 0});
   const auto facts = factsOf(facesOf(scene.hierarchy()));
   QVERIFY(facts.closed);
   QVERIFY(sameVolume(facts.volume, test::cellVolume(scene.hierarchy())));
}

void SurfaceTest::aHollowCubeHasTheFacesOneCounts()
{
   test::Scene scene(test::kLattices[0]);
   constexpr int n = 37;
   for (const Index i : test::hollowBox({0, 0, 0}, {n - 1, n - 1, n - 1}))
      scene.model.root.cells.set(i, {1, 0, 0});
   QCOMPARE(facesOf(scene.hierarchy()).size(), std::size_t(6 * n * n + 6 * (n - 2) * (n - 2)));
}

void SurfaceTest::fullBlocksAreSkippedAndNothingElse()
{
   constexpr int n = 70, half = 35; // wide enough for blocks that are full with all that is round them
   test::Scene plain(test::kLattices[0]);
   plain.model.root.cells.fill({{0, 0, 0}, {half - 1, n - 1, n - 1}}, {1, 0, 0});
   plain.model.root.cells.fill({{half, 0, 0}, {n - 1, n - 1, n - 1}}, {2, 0, 0});
   plain.model.root.cells.set({20, 20, 20}, {});
   // An instance far away makes the walk go through the hierarchy instead of the stored runs.
   test::Scene walked = plain;
   Definition dot{"dot", "dot", {}, {}};
   dot.body.cells.set({0, 0, 0}, {3, 0, 0});
   const auto id = walked.model.setDefinition(dot);
   DIATOM_VERIFY_OK(id);
   walked.model.root.instances.insert({*id, Index{500, 0, 0}, 0});
   for (const bool between : {false, true}) {
      const auto faces = facesOf(plain.hierarchy(), {}, between);
      QCOMPARE(faces.size(), std::size_t(6 * n * n + 6 + (between ? 2 * n * n : 0)));
      auto others = facesOf(walked.hierarchy(), {}, between);
      std::erase_if(others, [](const Face &face) { return face.material == 3; });
      QVERIFY(faces == others);
   }
   for (const MaterialIndex material : {MaterialIndex{1}, MaterialIndex{2}})
      QCOMPARE(facesOf(plain.hierarchy(), material).size(),
               std::size_t(2 * n * n + 4 * n * half + (material == 1 ? 6 : 0)));
}

void SurfaceTest::twoCellsShareNoWall()
{
   QFETCH(QString, lattice);
   test::Scene scene(lattice.toStdString());
   for (const Index start : {Index{0, 0, 0}, Index{-1, 31, -1}})
      for (const Link &link : scene.lattice->links(scene.lattice->site(start))) {
         scene.model.root.cells.clear();
         scene.model.root.cells.set(start, {1, 0, 0});
         scene.model.root.cells.set(start + link.offset, {2, 0, 0});
         const auto faces = [&](Index i) {
            return scene.lattice->shape(scene.lattice->site(i)).faces.size();
         };
         const std::size_t one = faces(start), other = faces(start + link.offset);
         QCOMPARE(facesOf(scene.hierarchy()).size(), one + other - (link.contact == Contact::face ? 2 : 0));
         QCOMPARE(facesOf(scene.hierarchy(), {}, true).size(), one + other);
         QCOMPARE(facesOf(scene.hierarchy(), 2).size(), other);
      }
}

void SurfaceTest::everyMaterialHasAClosedSurfaceOfItsOwn()
{
   QFETCH(QString, lattice);
   test::Scene scene(lattice.toStdString());
   std::mt19937 random(77);
   std::array<double, 4> volume{};
   for (const Index i : test::blob(*scene.lattice, 500, 9)) {
      const auto material = static_cast<MaterialIndex>(1 + random() % 3);
      scene.model.root.cells.set(i, {material, 0, 0});
      volume[material] += scene.lattice->shape(scene.lattice->site(i)).volume;
   }
   const auto hierarchy = scene.hierarchy();
   const auto together = facesOf(hierarchy, {}, true);
   for (MaterialIndex material = 1; material <= 3; ++material) {
      const double wanted = volume[material];
      const auto alone = facesOf(hierarchy, material);
      QVERIFY(factsOf(alone).closed);
      QVERIFY(sameVolume(factsOf(alone).volume, wanted));
      const auto within = factsOf(together, [&](const Face &face) { return face.material == material; });
      QVERIFY(within.closed);
      QVERIFY(sameVolume(within.volume, wanted));
   }
}

void SurfaceTest::nestedCompositesLookLikeTheCellsTheyHold()
{
   QFETCH(QString, lattice);
   test::Scene nested(lattice.toStdString()), flat(lattice.toStdString());
   const auto period = nested.lattice->period();
   // Steps by whole periods keep every site what it is on all lattices.
   const Index stepX{2 * period[0], 0, 0}, stepZ{0, 0, 2 * period[2]};
   Definition inner{"inner", "inner", {}, {}};
   for (const Index i : test::hollowBox({0, 0, 0}, {1, 2, 1}))
      inner.body.cells.set(i, {1, 0, 0});
   const auto innerId = nested.model.setDefinition(inner);
   DIATOM_VERIFY_OK(innerId);
   Definition outer{"outer", "outer", {}, {}};
   for (int k = 0; k < 5; ++k)
      outer.body.instances.insert({*innerId, stepX * k, 0});
   const auto outerId = nested.model.setDefinition(outer);
   DIATOM_VERIFY_OK(outerId);
   for (int k = -2; k < 3; ++k)
      nested.model.root.instances.insert({*outerId, stepZ * k, 0});
   nested.model.root.cells.set({-1, 0, 0}, {2, 0, 0}); // touches a composite
   const auto hierarchy = nested.hierarchy();
   hierarchy.visit(hierarchy.bounds(), [&](Index i, Cell cell) {
      flat.model.root.cells.set(i, cell);
      return true;
   });
   QCOMPARE(flat.model.root.cells.count(), hierarchy.cells());
   const auto faces = facesOf(hierarchy);
   QVERIFY(faces == facesOf(flat.hierarchy()));
   QVERIFY(factsOf(faces).closed);
}

void SurfaceTest::anAspectScalesTheSurface()
{
   test::Scene scene(test::kLattices[2]);
   scene.model.lattice.aspect = {1, 2, 0.5};
   auto stretched = Lattice::make(*test::catalogue(), scene.model.lattice, Job());
   DIATOM_VERIFY_OK(stretched);
   const double plain = scene.lattice->shape(0).volume;
   scene.lattice = *stretched;
   for (const Index i : test::blob(*scene.lattice, 100, 4))
      scene.model.root.cells.set(i, {1, 0, 0});
   const auto facts = factsOf(facesOf(scene.hierarchy()));
   QVERIFY(facts.closed);
   QVERIFY(sameVolume(facts.volume, 100 * plain)); // 1 * 2 * 0.5
}

void SurfaceTest::surfacesFarFromTheOriginAreStillClosed()
{
   QFETCH(QString, lattice);
   for (const Index start :
        {Index{1'000'000, -1'000'000, 1'000'000}, Index{kIndexLimit - 3, -kIndexLimit + 3, kIndexLimit - 3}})
   {
      test::Scene scene(lattice.toStdString());
      for (const Index i : test::blob(*scene.lattice, 200, 5, start))
         scene.model.root.cells.set(i, {1, 0, 0});
      const auto facts = factsOf(facesOf(scene.hierarchy()));
      QVERIFY(facts.closed);
      // At 10^9 cells a coordinate is good to 10^-7 of a cell: corners of 200 cells, hence 10^-5.
      QVERIFY(std::abs(facts.volume / test::cellVolume(scene.hierarchy()) - 1) < 1e-5);
   }
}

void SurfaceTest::farApartCellsCostNoTime()
{
   test::Scene scene(test::kLattices[0]);
   for (const int x : {-kIndexLimit, 0, kIndexLimit})
      scene.model.root.cells.set({x, -x, x}, {1, 0, 0});
   QElapsedTimer timer;
   timer.start();
   QCOMPARE(facesOf(scene.hierarchy()).size(), std::size_t(18));
   QVERIFY(timer.elapsed() < 2000); // walking the 10^28 places between them would never end
}

void SurfaceTest::anEmptyDesignHasNoSurface()
{
   const test::Scene scene(test::kLattices[0]);
   QVERIFY(facesOf(scene.hierarchy()).empty());
}

void SurfaceTest::aCancelledJobEndsTheWalk()
{
   test::Scene scene(test::kLattices[0]);
   scene.model.root.cells.fill({{0, 0, 0}, {99, 99, 99}}, {1, 0, 0});
   Job job;
   std::size_t faces = 0;
   const Status status = visitSurface(
       scene.hierarchy(), {}, false,
       [&](const SurfaceFace &) {
          ++faces;
          job.cancel();
       },
       job);
   QVERIFY(!status);
   QCOMPARE(status.error().code, ErrorCode::cancelled);
   QVERIFY(faces < 60000 / 2);
}

QTEST_APPLESS_MAIN(SurfaceTest)
#include "io_surface_test.moc"
