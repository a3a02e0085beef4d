// Positions, nearest cells, shapes and contacts of the built-in lattices. Reference: the lattice table that
// the programs before Diatom were checked with (counts and volumes recomputed there by separating axes and
// vertex hashing).
#include "lattice/lattice.h"
#include "support/support.h"

#include <QElapsedTimer>

#include <cmath>
#include <map>
#include <numeric>
#include <random>

using namespace diatom;

namespace {

std::shared_ptr<const Lattice> lattice(const std::string &name, double pitch = 1,
                                       std::array<double, 3> aspect = {1, 1, 1})
{
   LatticeSpec spec;
   spec.id = "org.diatom_cad.lattice." + name;
   spec.pitch = pitch;
   spec.aspect = aspect;
   const auto made = Lattice::make(*test::catalogue(), spec, Job());
   if (!made)
      qWarning("%s", made.error().message.c_str());
   return made ? *made : nullptr;
}

/// The nearest centre among all indices within `range` of a guess: slow and obvious.
Index bruteNearest(const Lattice &l, const Vec3 &point, Index guess, int range)
{
   Index best = guess;
   for (int x = -range; x <= range; ++x)
      for (int y = -range; y <= range; ++y)
         for (int z = -range; z <= range; ++z) {
            const Index candidate = guess + Index{x, y, z};
            if ((l.position(candidate) - point).norm() < (l.position(best) - point).norm())
               best = candidate;
         }
   return best;
}

void addLattices()
{
   QTest::addColumn<QString>("name");
   for (const char *name : {"cube", "gik", "octahedron_edge", "kelvin"})
      QTest::newRow(name) << name;
}

} // namespace

class LatticeGeometryTest : public QObject
{
   Q_OBJECT

private slots:
   void cellsAndContactsAreThoseOfTheTable_data();
   void cellsAndContactsAreThoseOfTheTable();
   void linksAreMutualAndTheirFeaturesCoincide_data() { addLattices(); }
   void linksAreMutualAndTheirFeaturesCoincide();
   void nearestOfAPositionIsItsIndex_data() { addLattices(); }
   void nearestOfAPositionIsItsIndex();
   void nearestAgreesWithASearchOverAllCells_data() { addLattices(); }
   void nearestAgreesWithASearchOverAllCells();
   void aPointInsideACellOfASpaceFillingLatticeBelongsToIt();
   void nearestOfTiesIsTheSmallerIndex();
   void nearestOfPointsOutOfRangeIsInRange_data() { addLattices(); }
   void nearestOfPointsOutOfRangeIsInRange();
   void pitchAndAspectScaleSitesAndShapesAlike();
   void acrossFaceFindsTheLinkOfEachFace_data() { addLattices(); }
   void acrossFaceFindsTheLinkOfEachFace();
   void impossiblePitchesAreRefused();
   void aMillionPositionsAreTimed_data() { addLattices(); }
   void aMillionPositionsAreTimed();
};

void LatticeGeometryTest::cellsAndContactsAreThoseOfTheTable_data()
{
   QTest::addColumn<QString>("name");
   QTest::addColumn<QList<int>>("counts"); // V E F, then neighbours by face, edge, vertex, joined, rotations
   QTest::addColumn<double>("volume");
   QTest::addColumn<double>("packing");
   // Rotations: orders of the proper symmetry groups, 24 for the octahedral ones and 8 for a square prism.
   QTest::newRow("cube") << "cube" << QList<int>{8, 12, 6, 6, 12, 8, 6, 24} << 1.0 << 1.0;
   QTest::newRow("gik") << "gik" << QList<int>{8, 12, 6, 6, 12, 8, 2, 8} << 1.28 << 1.0;
   QTest::newRow("octahedron_edge") << "octahedron_edge" << QList<int>{6, 12, 8, 0, 12, 6, 12, 24}
                                    << std::sqrt(2) / 3 << 2.0 / 3;
   QTest::newRow("kelvin") << "kelvin" << QList<int>{24, 36, 14, 6, 0, 0, 6, 24} << 8 * std::sqrt(2) << 0.5;
}

void LatticeGeometryTest::cellsAndContactsAreThoseOfTheTable()
{
   QFETCH(QString, name);
   QFETCH(QList<int>, counts);
   QFETCH(double, volume);
   QFETCH(double, packing);
   const auto l = lattice(name.toStdString());
   QVERIFY(l);
   for (int site = 0; site < l->sites(); ++site) {
      const Shape &shape = l->shape(site);
      std::map<Contact, int> contacts;
      int joined = 0;
      for (const Link &link : l->links(site)) {
         ++contacts[link.contact];
         joined += link.joined;
      }
      const QList<int> found{static_cast<int>(shape.vertices.size()),
                             static_cast<int>(shape.edges.size()),
                             static_cast<int>(shape.faces.size()),
                             contacts[Contact::face],
                             contacts[Contact::edge],
                             contacts[Contact::vertex],
                             joined,
                             static_cast<int>(shape.rotations.size())};
      QCOMPARE(found, counts);
      // Sums of at most a hundred products of numbers near 1: far below 1e-12.
      QVERIFY(std::abs(shape.volume - volume) < 1e-12 * volume);
      QVERIFY(std::abs(shape.volume / l->volumePerSite() - packing) < 1e-12);
   }
   QCOMPARE(static_cast<int>(l->rotations().size()), counts.back());
   QVERIFY(l->rotations()[0].isApprox(Quat::Identity()));
}

void LatticeGeometryTest::linksAreMutualAndTheirFeaturesCoincide()
{
   QFETCH(QString, name);
   const auto l = lattice(name.toStdString(), 1e-3, {1, 1, 1});
   QVERIFY(l);
   // The corners of a feature, each rounded to a millionth of the pitch: corners either coincide or are far
   // apart.
   const auto corners = [&](Index cell, const Link &link) {
      const Shape &shape = l->shape(l->site(cell));
      std::vector<int> numbers{link.feature};
      if (link.contact == Contact::face)
         numbers = shape.faces[static_cast<std::size_t>(link.feature)];
      if (link.contact == Contact::edge)
         numbers.assign(shape.edges[static_cast<std::size_t>(link.feature)].begin(),
                        shape.edges[static_cast<std::size_t>(link.feature)].end());
      std::vector<std::array<long long, 3>> points;
      for (const int n : numbers) {
         const Vec3 p = l->position(cell) + l->corners(l->site(cell))[static_cast<std::size_t>(n)];
         points.push_back({std::llround(p.x() * 1e9), std::llround(p.y() * 1e9), std::llround(p.z() * 1e9)});
      }
      std::sort(points.begin(), points.end());
      return points;
   };
   for (const Index cell : {Index{0, 0, 0}, Index{3, -4, 1}, Index{-7, 2, -5}, Index{1, 1, 8}})
      for (const Link &link : l->links(l->site(cell))) {
         const Index other = cell + link.offset;
         const auto back = l->links(l->site(other));
         const auto reverse = std::find_if(back.begin(), back.end(), [&](const Link &b) {
            return b.offset == Index{} - link.offset && b.contact == link.contact && b.joined == link.joined;
         });
         QVERIFY(reverse != back.end());
         QCOMPARE(corners(cell, link), corners(other, *reverse));
      }
}

void LatticeGeometryTest::nearestOfAPositionIsItsIndex()
{
   QFETCH(QString, name);
   const auto l = lattice(name.toStdString(), 1.27e-3);
   QVERIFY(l);
   // Perturbed by a fifth of the distance to the nearest other centre, in all directions: still the same
   // cell.
   double closest = std::numeric_limits<double>::infinity();
   for (const Link &link : l->links(0))
      closest = std::min(closest, (l->position(link.offset) - l->position({})).norm());
   for (int x = -6; x <= 6; ++x)
      for (int y = -6; y <= 6; ++y)
         for (int z = -6; z <= 6; ++z) {
            const Index i{x, y, z};
            QVERIFY(l->nearest(l->position(i)) == i);
            for (int corner = 0; corner < 8; ++corner) {
               const Vec3 shift(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
               QVERIFY(l->nearest(l->position(i) + 0.2 * closest * shift) == i);
            }
         }
   for (const Index i :
        {Index{kIndexLimit, -kIndexLimit, kIndexLimit}, Index{1000000007, -999999937, 12345677}})
      QVERIFY(l->nearest(l->position(i)) == i);
}

void LatticeGeometryTest::nearestAgreesWithASearchOverAllCells()
{
   QFETCH(QString, name);
   const auto l = lattice(name.toStdString());
   QVERIFY(l);
   constexpr unsigned kSeed = 20240607;
   qInfo("seed %u", kSeed);
   std::mt19937_64 random(kSeed);
   std::uniform_real_distribution<double> within(-1000, 1000);
   for (int n = 0; n < 1000000; ++n) {
      const Vec3 point(within(random), within(random), within(random));
      const Index found = l->nearest(point);
      // No touching or next-nearest neighbour is nearer: enough for all points, since the centres' cells are
      // convex.
      const double distance = (l->position(found) - point).norm();
      for (const Link &link : l->links(l->site(found)))
         if ((l->position(found + link.offset) - point).norm() < distance * (1 - 1e-12))
            QFAIL("a touching neighbour is nearer");
      if (n % 100 == 0) // the full search, 11^3 cells, for every hundredth
         QVERIFY((l->position(bruteNearest(*l, point, found, 5)) - point).norm() > distance * (1 - 1e-12));
   }
}

void LatticeGeometryTest::aPointInsideACellOfASpaceFillingLatticeBelongsToIt()
{
   const auto l = lattice("gik");
   QVERIFY(l);
   const Index i{4, -3, 7};
   for (const Vec3 &corner : l->corners(l->site(i)))
      QVERIFY(l->nearest(l->position(i) + 0.999 * corner) == i);
}

void LatticeGeometryTest::nearestOfTiesIsTheSmallerIndex()
{
   const auto cube = lattice("cube", 1e-3);
   QVERIFY(cube);
   for (int i = -50; i < 50; ++i) {
      QVERIFY((cube->nearest({(i + 0.5) * 1e-3, 0, 0}) == Index{i, 0, 0}));
      QVERIFY((cube->nearest({(i + 0.5) * 1e-3, (i + 0.5) * 1e-3, (i + 0.5) * 1e-3}) == Index{i, i, i}));
   }
   // Half way between two layers of octahedra, where the centre of a shared edge is as far from four cells.
   const auto octahedra = lattice("octahedron_edge");
   QVERIFY(octahedra);
   QVERIFY((octahedra->nearest(0.5 * (octahedra->position({0, 0, 0}) + octahedra->position({1, 1, 1}))) ==
            Index{0, 0, 0}));
}

void LatticeGeometryTest::nearestOfPointsOutOfRangeIsInRange()
{
   QFETCH(QString, name);
   const auto l = lattice(name.toStdString());
   QVERIFY(l);
   const double infinity = std::numeric_limits<double>::infinity(),
                nan = std::numeric_limits<double>::quiet_NaN();
   for (const double far : {1e10, 1e300, infinity}) {
      const Index high = l->nearest({far, 0, far}), low = l->nearest({-far, -far, 0});
      QVERIFY(inRange(high) && high.x == kIndexLimit && high.z == kIndexLimit);
      QVERIFY(inRange(low) && low.x == -kIndexLimit && low.y == -kIndexLimit);
   }
   QVERIFY(inRange(l->nearest({nan, nan, nan})));
}

void LatticeGeometryTest::pitchAndAspectScaleSitesAndShapesAlike()
{
   for (const char *name : {"cube", "gik", "octahedron_edge", "kelvin"}) {
      const auto unit = lattice(name), scaled = lattice(name, 2e-3, {1, 1.5, 0.75});
      QVERIFY(unit && scaled);
      const Vec3 scale = 2e-3 * Vec3(1, 1.5, 0.75);
      for (const Index i : {Index{0, 0, 0}, Index{2, -3, 5}, Index{-1, 1, -4}}) {
         // Two roundings per product: a few units in the last place.
         QVERIFY((scaled->position(i) - scale.cwiseProduct(unit->position(i))).norm() < 1e-15);
         const int site = unit->site(i);
         for (std::size_t n = 0; n < unit->corners(site).size(); ++n)
            QVERIFY((scaled->corners(site)[n] - scale.cwiseProduct(unit->corners(site)[n])).norm() < 1e-15);
      }
      QVERIFY(std::abs(scaled->shape(0).volume / (unit->shape(0).volume * scale.prod()) - 1) < 1e-12);
      QCOMPARE(scaled->links(0).size(), unit->links(0).size());
   }
   // Three different edges leave the four rotations of a box; two equal ones eight, but turned octahedra need
   // the equal axes to be those of their square.
   QCOMPARE(lattice("cube", 1, {1, 1.5, 0.75})->rotations().size(), std::size_t{4});
   QCOMPARE(lattice("cube", 1, {1, 1, 0.75})->rotations().size(), std::size_t{8});
   QCOMPARE(lattice("octahedron_edge", 1, {1, 1, 0.75})->rotations().size(), std::size_t{8});
   // Bricks 1.5 times as wide as long no longer fit when turned by a quarter.
   QCOMPARE(lattice("gik", 1, {1, 1.5, 1})->rotations().size(), std::size_t{4});
}

void LatticeGeometryTest::acrossFaceFindsTheLinkOfEachFace()
{
   QFETCH(QString, name);
   const auto l = lattice(name.toStdString());
   QVERIFY(l);
   for (int site = 0; site < l->sites(); ++site)
      for (int face = 0; face < static_cast<int>(l->shape(site).faces.size()); ++face) {
         // The mirror image of the centre in the face's plane is the neighbour's centre if one meets the
         // face.
         const auto &numbers = l->shape(site).faces[static_cast<std::size_t>(face)];
         Vec3 middle = Vec3::Zero();
         for (const int n : numbers)
            middle += l->corners(site)[static_cast<std::size_t>(n)] / static_cast<double>(numbers.size());
         const Index home{0, 0, site};
         const Index beyond = l->nearest(l->position(home) + 2 * middle);
         const bool meets = (l->position(beyond) - l->position(home) - 2 * middle).norm() < 1e-9 &&
                            name != QString("octahedron_edge");
         const Link *link = l->acrossFace(site, face);
         QCOMPARE(link != nullptr, meets);
         if (link)
            QVERIFY(home + link->offset == beyond);
      }
}

void LatticeGeometryTest::impossiblePitchesAreRefused()
{
   const double nan = std::numeric_limits<double>::quiet_NaN();
   for (const double pitch : {0.0, -1e-3, nan, 1e300}) {
      LatticeSpec spec;
      spec.pitch = pitch;
      QVERIFY(!Lattice::make(*test::catalogue(), spec, Job()).ok());
   }
   LatticeSpec spec;
   spec.aspect = {1, nan, 1};
   const auto made = Lattice::make(*test::catalogue(), spec, Job());
   QVERIFY(!made.ok());
   QVERIFY(made.error().message.find("aspect") != std::string::npos);
}

void LatticeGeometryTest::aMillionPositionsAreTimed()
{
   QFETCH(QString, name);
   const auto l = lattice(name.toStdString(), 1e-3);
   QVERIFY(l);
   std::vector<Index> indices;
   for (int n = 0; n < 1000000; ++n)
      indices.push_back({n % 100, n / 100 % 100, n / 10000});
   std::vector<double> xyz(3 * indices.size());
   QElapsedTimer timer;
   timer.start();
   l->positions(indices, xyz, Job());
   const double positions = 1e-6 * static_cast<double>(timer.nsecsElapsed());
   timer.start();
   std::size_t same = 0;
   for (std::size_t n = 0; n < indices.size(); ++n)
      same += l->nearest({xyz[3 * n], xyz[3 * n + 1], xyz[3 * n + 2]}) == indices[n];
   const double nearest = 1e-6 * static_cast<double>(timer.nsecsElapsed());
   qInfo("benchmark: 1e6 positions %.2f ms, 1e6 nearest %.1f ms", positions, nearest);
   QCOMPARE(same, indices.size());
}

QTEST_APPLESS_MAIN(LatticeGeometryTest)
#include "lattice_geometry_test.moc"
