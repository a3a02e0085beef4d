// Solids become cells: which cells, on every lattice, whatever the surface is like.
#include "io/mesh_faults.h"
#include "io/voxelize.h"
#include "support/meshes.h"
#include "support/support.h"

#include <random>

using namespace diatom;
using namespace diatom::test;

namespace {

std::shared_ptr<const Lattice> latticeOf(const std::string &id, double pitch)
{
   LatticeSpec spec;
   spec.id = id;
   spec.pitch = pitch;
   auto made = Lattice::make(*catalogue(), spec, Job());
   if (!made)
      qFatal("%s", made.error().message.c_str());
   return *std::move(made);
}

const std::string kCube = "org.diatom_cad.lattice.cube";

VoxelizeOptions how(BoundaryRule rule, double fraction = 0.5)
{
   VoxelizeOptions options;
   options.rule = rule;
   options.fraction = fraction;
   options.closed = true;
   return options;
}

CellArray cellsOf(const TriangleMesh &mesh, const Lattice &lattice, const VoxelizeOptions &options,
                  int threads = 0)
{
   Job job;
   job.setThreads(threads);
   auto cells = voxelize(TriangleTree(mesh), lattice, options, job);
   if (!cells)
      qFatal("%s", cells.error().message.c_str());
   return *std::move(cells);
}

/// Of a mesh of one triangle, by Girard's theorem on the planes through the point and each side.
double solidAngle(const Vec3 &point, const TriangleMesh &one)
{
   const Vec3 a = one.vertices[0] - point, b = one.vertices[1] - point, c = one.vertices[2] - point;
   const Vec3 ab = a.cross(b).normalized(), bc = b.cross(c).normalized(), ca = c.cross(a).normalized();
   const auto angle = [](const Vec3 &m, const Vec3 &n) {
      return std::acos(std::clamp(-m.dot(n), -1.0, 1.0));
   };
   const double excess = angle(ca, ab) + angle(ab, bc) + angle(bc, ca) - std::numbers::pi;
   return std::copysign(excess, a.dot(b.cross(c))) / (4 * std::numbers::pi);
}

} // namespace

class IoVoxelizeTest : public QObject
{
   Q_OBJECT
private slots:
   void aBoxIsFilledToItsFaces();
   void windingNumbersAreThoseOfEveryTriangle();
   void aSphereKeepsItsVolumeOnEveryLattice();
   void touchHoldsCentreAndFractionsLieBetween();
   void solidsThatShareAFaceShareNoCell();
   void aBoxWithoutLidIsStillABox();
   void wholeBlocksChangeNothing();
   void largeSolidsAreStoredAsBlocks();
   void overlappingAndNestedSurfacesAreOneSolid();
   void trianglesThatLookTheWrongWayAreTurned();
   void faultsAreCounted();
   void theNearestTriangleIsFound();
   void aPitchTooSmallIsRefused();
   void itCanBeCancelled();
};

/// Faces at cell boundaries: 10 x 4 x 3 cells exactly, whatever the rule.
void IoVoxelizeTest::aBoxIsFilledToItsFaces()
{
   const auto lattice = latticeOf(kCube, 1e-3);
   const TriangleMesh mesh = boxMesh({-0.5e-3, -0.5e-3, -0.5e-3}, {9.5e-3, 3.5e-3, 2.5e-3});
   for (const VoxelizeOptions &options :
        {how(BoundaryRule::centre), how(BoundaryRule::touch), how(BoundaryRule::fraction, 1),
         how(BoundaryRule::fraction, 1.0 / 64)})
   {
      const CellArray cells = cellsOf(mesh, *lattice, options);
      QCOMPARE(cells.count(), 120U);
      QVERIFY(cells.bounds() == (Box{{0, 0, 0}, {9, 3, 2}}));
   }
}

/// Against the sum over all triangles, each by its solid angle. The tree's error bound is documented as 0.05.
void IoVoxelizeTest::windingNumbersAreThoseOfEveryTriangle()
{
   TriangleMesh mesh = sphereMesh({0, 0, 0}, 1, 5);
   mesh.triangles.resize(mesh.triangles.size() * 3 / 4); // open: values in between
   const TriangleTree tree(mesh);
   std::mt19937 random(7);
   std::uniform_real_distribution<double> at(-1.3, 1.3);
   double worst = 0;
   for (int n = 0; n < 300; ++n) {
      const Vec3 point(at(random), at(random), at(random));
      double exact = 0;
      for (std::int32_t t = 0; t < std::ssize(mesh.triangles); ++t) {
         TriangleMesh one;
         one.vertices = {tree.corners(t)[0], tree.corners(t)[1], tree.corners(t)[2]};
         one.triangles = {{0, 1, 2}};
         exact += solidAngle(point, one);
      }
      worst = std::max(worst, std::abs(tree.winding(point) - exact));
   }
   QVERIFY2(worst < 0.05, qPrintable(QString::number(worst)));
   QVERIFY(worst > 0); // the tree did take its short cut
}

/// Cells times volume per cell site against the volume of the mesh. The boundary of some 5 000 cells is in or
/// out by chance: 3 sqrt(5000) of 33 500 is 0.6 %.
void IoVoxelizeTest::aSphereKeepsItsVolumeOnEveryLattice()
{
   for (const Offer &offer : catalogue()->offers(DIATOM_LATTICE_1)) {
      const auto lattice = latticeOf(offer.provided->id, 1e-3);
      const double radius = 20 * std::cbrt(lattice->volumePerSite());
      const TriangleMesh mesh = sphereMesh({1e-4, -2e-4, 3e-4}, radius, 5);
      const CellArray cells = cellsOf(mesh, *lattice, how(BoundaryRule::centre));
      const double error = static_cast<double>(cells.count()) * lattice->volumePerSite() / volumeOf(mesh) - 1;
      QVERIFY2(std::abs(error) < 0.01,
               qPrintable(QString("%1: %2").arg(offer.provided->id.c_str()).arg(error)));
   }
}

void IoVoxelizeTest::touchHoldsCentreAndFractionsLieBetween()
{
   for (const Offer &offer : catalogue()->offers(DIATOM_LATTICE_1)) {
      const auto lattice = latticeOf(offer.provided->id, 1e-3);
      const TriangleMesh mesh = sphereMesh({1e-4, 2e-4, 0}, 4 * std::cbrt(lattice->volumePerSite()), 2);
      CellArray wider = cellsOf(mesh, *lattice, how(BoundaryRule::touch));
      const CellArray centre = cellsOf(mesh, *lattice, how(BoundaryRule::centre));
      QVERIFY(centre.visit([&](Index i, Cell) { return !wider.at(i).empty(); }));
      for (const double fraction : {1.0 / 64, 0.5, 1.0}) {
         CellArray cells = cellsOf(mesh, *lattice, how(BoundaryRule::fraction, fraction));
         QVERIFY(cells.count() < wider.count());
         QVERIFY(cells.visit([&](Index i, Cell) { return !wider.at(i).empty(); }));
         wider = std::move(cells);
      }
   }
}

/// Centres on the shared face belong to one side.
void IoVoxelizeTest::solidsThatShareAFaceShareNoCell()
{
   const auto lattice = latticeOf(kCube, 1);
   const CellArray low = cellsOf(boxMesh({0, 0, 0}, {5, 5, 5}), *lattice, how(BoundaryRule::centre));
   const CellArray high = cellsOf(boxMesh({5, 0, 0}, {10, 5, 5}), *lattice, how(BoundaryRule::centre));
   QCOMPARE(low.count(), 125U);
   QCOMPARE(high.count(), 125U);
   QVERIFY(low.visit([&](Index i, Cell) { return high.at(i).empty(); }));
}

/// Without its lid a tall box winds by more than a half around all but the points just below the lid.
void IoVoxelizeTest::aBoxWithoutLidIsStillABox()
{
   const auto lattice = latticeOf(kCube, 1);
   TriangleMesh mesh = boxMesh({-0.5, -0.5, -0.5}, {9.5, 9.5, 29.5});
   std::erase_if(mesh.triangles, [&](const auto &t) {
      return std::all_of(t.begin(), t.end(), [&](auto v) { return mesh.vertices[std::size_t(v)].z() > 29; });
   });
   QCOMPARE(mesh.triangles.size(), 10U);
   QCOMPARE(findFaults(mesh).open, 4U);
   VoxelizeOptions options = how(BoundaryRule::centre);
   options.closed = false;
   const CellArray cells = cellsOf(mesh, *lattice, options);
   // A point under the middle of the open square of side 10 sees it under half of space or less.
   QVERIFY(cells.count() > 2900 && cells.count() <= 3000);
   QVERIFY(cells.bounds() == (Box{{0, 0, 0}, {9, 9, 29}}));
}

void IoVoxelizeTest::wholeBlocksChangeNothing()
{
   const auto lattice = latticeOf("org.diatom_cad.lattice.octahedron_edge", 1e-3);
   TriangleMesh mesh = sphereMesh({0, 0, 0}, 12e-3, 3);
   addBox(mesh, {10e-3, -3e-3, -3e-3}, {40e-3, 3e-3, 4e-3});
   for (const BoundaryRule rule : {BoundaryRule::centre, BoundaryRule::touch, BoundaryRule::fraction}) {
      VoxelizeOptions slow = how(rule);
      slow.closed = false;
      const CellArray cells = cellsOf(mesh, *lattice, how(rule), 1);
      QVERIFY(cells.count() > 9'000);
      QVERIFY(cells == cellsOf(mesh, *lattice, how(rule), 3));
      QVERIFY(cells == cellsOf(mesh, *lattice, slow, 2));
   }
}

/// Only the skin is looked at.
void IoVoxelizeTest::largeSolidsAreStoredAsBlocks()
{
   const auto lattice = latticeOf(kCube, 1e-3);
   const CellArray cells = cellsOf(boxMesh({0.5e-3, 0.5e-3, 0.5e-3}, {300.5e-3, 300.5e-3, 300.5e-3}),
                                   *lattice, how(BoundaryRule::centre));
   QCOMPARE(cells.count(), 27'000'000U);
   QVERIFY(cells.bytes() < 8'000'000); // 6 * 19^2 bricks of the skin at 16^3 numbers of one bit, and the tree
}

void IoVoxelizeTest::overlappingAndNestedSurfacesAreOneSolid()
{
   const auto lattice = latticeOf(kCube, 1);
   TriangleMesh mesh = boxMesh({-0.5, -0.5, -0.5}, {9.5, 9.5, 9.5});
   addBox(mesh, {4.5, -0.5, -0.5}, {14.5, 9.5, 9.5});
   QCOMPARE(cellsOf(mesh, *lattice, how(BoundaryRule::centre)).count(), 1500U);
   // A cavity: an inner surface that looks inward.
   TriangleMesh hollow = boxMesh({-0.5, -0.5, -0.5}, {9.5, 9.5, 9.5});
   TriangleMesh inner = boxMesh({1.5, 1.5, 1.5}, {7.5, 7.5, 7.5});
   for (auto &triangle : inner.triangles)
      hollow.triangles.push_back({triangle[0] + 8, triangle[2] + 8, triangle[1] + 8});
   hollow.vertices.insert(hollow.vertices.end(), inner.vertices.begin(), inner.vertices.end());
   QCOMPARE(orientTriangles(hollow), 0U);
   QCOMPARE(cellsOf(hollow, *lattice, how(BoundaryRule::centre)).count(), 784U);
}

void IoVoxelizeTest::trianglesThatLookTheWrongWayAreTurned()
{
   TriangleMesh inward = sphereMesh({0, 0, 0}, 1, 2);
   const double volume = volumeOf(inward);
   for (auto &triangle : inward.triangles)
      std::swap(triangle[0], triangle[1]);
   QCOMPARE(orientTriangles(inward), inward.triangles.size());
   QVERIFY(std::abs(volumeOf(inward) / volume - 1) < 1e-12); // the same sum in another order

   TriangleMesh mixed = sphereMesh({0, 0, 0}, 1, 2);
   for (std::size_t k = 0; k < mixed.triangles.size(); k += 3)
      std::swap(mixed.triangles[k][0], mixed.triangles[k][1]);
   QVERIFY(findFaults(mixed).opposed > 0);
   QCOMPARE(orientTriangles(mixed), (mixed.triangles.size() + 2) / 3);
   QVERIFY(findFaults(mixed).closed());
   QVERIFY(std::abs(volumeOf(mixed) / volume - 1) < 1e-12);
}

void IoVoxelizeTest::faultsAreCounted()
{
   TriangleMesh mesh = boxMesh({0, 0, 0}, {1, 1, 1});
   QVERIFY(findFaults(mesh).closed());
   QVERIFY(findFaults(mesh).text().empty());
   // The same box with corners of its own for every triangle, as STL has them.
   TriangleMesh soup;
   for (const auto &triangle : mesh.triangles) {
      for (const auto corner : triangle)
         soup.vertices.push_back(mesh.vertices[std::size_t(corner)]);
      const auto n = static_cast<std::int32_t>(soup.vertices.size());
      soup.triangles.push_back({n - 3, n - 2, n - 1});
   }
   QVERIFY(findFaults(soup).closed());
   mesh.triangles.push_back({0, 1, 1});
   QCOMPARE(findFaults(mesh).flat, 1U);
   QVERIFY(findFaults(mesh).closed());
   mesh.triangles.pop_back();
   mesh.triangles.erase(mesh.triangles.begin());
   QCOMPARE(findFaults(mesh).open, 3U);
   QVERIFY(findFaults(mesh).text().find("3 open edges") != std::string::npos);
   // A fin on an edge.
   TriangleMesh fin = boxMesh({0, 0, 0}, {1, 1, 1});
   fin.vertices.emplace_back(-1, -1, 0.5);
   fin.triangles.push_back({0, 1, 8});
   QCOMPARE(findFaults(fin).uneven, 1U);
   QCOMPARE(findFaults(fin).open, 2U);
}

void IoVoxelizeTest::theNearestTriangleIsFound()
{
   const TriangleMesh mesh = sphereMesh({0, 0, 0}, 1, 3);
   const TriangleTree tree(mesh);
   double sagitta = 0;
   for (std::int32_t t = 0; t < std::ssize(mesh.triangles); ++t)
      sagitta = std::max(sagitta, 1 - std::sqrt(squaredDistance({0, 0, 0}, tree.corners(t))));
   std::mt19937 random(3);
   std::uniform_real_distribution<double> at(-2, 2);
   for (int n = 0; n < 200; ++n) {
      const Vec3 point(at(random), at(random), at(random));
      double least = 1e300;
      std::int32_t wanted = -1;
      for (std::int32_t t = 0; t < std::ssize(mesh.triangles); ++t)
         if (const double d = squaredDistance(point, tree.corners(t)); d < least) {
            least = d;
            wanted = t;
         }
      QCOMPARE(tree.nearest(point), wanted);
      // The sphere itself is nearer or farther by the sagitta of a facet at most.
      QVERIFY(std::abs(std::sqrt(least) - std::abs(point.norm() - 1)) < sagitta + 1e-12);
   }
}

void IoVoxelizeTest::aPitchTooSmallIsRefused()
{
   const auto lattice = latticeOf(kCube, 1e-9);
   const TriangleMesh mesh = boxMesh({0, 0, 0}, {1, 1, 1});
   const auto cells = voxelize(TriangleTree(mesh), *lattice, how(BoundaryRule::centre), Job());
   QVERIFY(!cells);
   QVERIFY2(cells.error().message.find("larger pitch") != std::string::npos, cells.error().message.c_str());
}

void IoVoxelizeTest::itCanBeCancelled()
{
   const auto lattice = latticeOf(kCube, 1e-3);
   Job *running = nullptr;
   Job job([&](double, std::string_view) { running->cancel(); });
   running = &job;
   VoxelizeOptions options = how(BoundaryRule::centre);
   options.closed = false;
   const auto cells = voxelize(TriangleTree(sphereMesh({0, 0, 0}, 0.2, 2)), *lattice, options, job);
   QVERIFY(!cells);
   QCOMPARE(cells.error().code, ErrorCode::cancelled);
}

QTEST_APPLESS_MAIN(IoVoxelizeTest)
#include "io_voxelize_test.moc"
