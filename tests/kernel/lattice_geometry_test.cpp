// Positions, nearest cells, shapes and contacts of the built-in lattices, against geometry and slow searches;
// lattice_sheet_test.cpp has the tables.
#include "support/lattices.h"

#include <QElapsedTimer>

#include <cmath>
#include <map>
#include <numeric>
#include <random>

using namespace diatom;

namespace {

/// The nearest centre, by looking at every cell whose centre can be that near: slow and obvious.
class Search
{
public:
   explicit Search(const Lattice &l) : m_lattice(l)
   {
      const auto period = l.period();
      double shift = 0;
      for (int site = 0; site < l.sites(); ++site)
         for (int k = 0; k < 3; ++k) {
            Index step;
            (k == 0 ? step.x : k == 1 ? step.y : step.z) = period[static_cast<std::size_t>(k)];
            m_basis.col(k) = (l.position(step) - l.position({})) / period[static_cast<std::size_t>(k)];
            const Index i = test::siteIndex(l, site);
            shift = std::max(shift, (l.position(i) - m_basis * Vec3(i.x, i.y, i.z)).norm());
         }
      // Site 0's cells alone leave no point farther from a centre than half the diagonal of a period.
      double farthest = 0;
      for (int k = 0; k < 3; ++k)
         farthest += 0.5 * period[static_cast<std::size_t>(k)] * m_basis.col(k).norm();
      const Mat3 inverse = m_basis.inverse();
      for (int k = 0; k < 3; ++k)
         m_range[k] = static_cast<int>(std::ceil((farthest + shift) * inverse.row(k).norm())) + 1;
   }
   double distance(const Vec3 &point) const
   {
      const Vec3 steps = m_basis.inverse() * point;
      const Index near{static_cast<int>(std::lround(steps.x())), static_cast<int>(std::lround(steps.y())),
                       static_cast<int>(std::lround(steps.z()))};
      double least = std::numeric_limits<double>::infinity();
      for (int x = -m_range[0]; x <= m_range[0]; ++x)
         for (int y = -m_range[1]; y <= m_range[1]; ++y)
            for (int z = -m_range[2]; z <= m_range[2]; ++z)
               least = std::min(least, (m_lattice.position(near + Index{x, y, z}) - point).norm());
      return least;
   }

private:
   const Lattice &m_lattice;
   Mat3 m_basis = Mat3::Zero();
   int m_range[3]{};
};

void addLattices()
{
   QTest::addColumn<QString>("name");
   for (const std::string &name : test::latticeNames())
      QTest::newRow(name.c_str()) << QString::fromStdString(name);
}

} // namespace

class LatticeGeometryTest : public QObject
{
   Q_OBJECT

private slots:
   void cellsKeepTheRotationsOfTheirSymmetry_data();
   void cellsKeepTheRotationsOfTheirSymmetry();
   void latticesBeyondTheSheetFillSpace_data();
   void latticesBeyondTheSheetFillSpace();
   void linksAreMutualAndTheirFeaturesCoincide_data() { addLattices(); }
   void linksAreMutualAndTheirFeaturesCoincide();
   void nearestOfAPositionIsItsIndex_data() { addLattices(); }
   void nearestOfAPositionIsItsIndex();
   void nearestAgreesWithASearchOverAllCells_data() { addLattices(); }
   void nearestAgreesWithASearchOverAllCells();
   void aPointInsideACellOfASpaceFillingLatticeBelongsToIt_data();
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

void LatticeGeometryTest::cellsKeepTheRotationsOfTheirSymmetry_data()
{
   QTest::addColumn<QList<int>>("cell"); // per shape, in order of sites
   QTest::addColumn<int>("composites");
   // Orders of the proper symmetry groups: 24 octahedral, 12 tetrahedral or hexagonal, 8 of a square prism.
   // About half its height a tetrahedron keeps the 3 about its own axis; its layers add three half turns.
   // Octahedra in columns keep the 6 of a triangular antiprism, and the half turn between layers doubles
   // them.
   QTest::newRow("cube") << QList<int>{24} << 24;
   QTest::newRow("gik") << QList<int>{8} << 8;
   QTest::newRow("octahedron_face") << QList<int>{24} << 12;
   QTest::newRow("octahedron_edge_flat") << QList<int>{24} << 24;
   QTest::newRow("octahedron_edge") << QList<int>{24} << 24;
   QTest::newRow("octahedron_vertex") << QList<int>{24} << 24;
   QTest::newRow("tetrahedron_stacked") << QList<int>{3} << 12;
   QTest::newRow("tetrahedron_vertex") << QList<int>{12} << 12;
   QTest::newRow("cuboctahedron") << QList<int>{24} << 24;
   QTest::newRow("kelvin") << QList<int>{24} << 24;
   QTest::newRow("kelvin_body_centred") << QList<int>{24} << 24;
   QTest::newRow("honeycomb") << QList<int>{12} << 12;
   QTest::newRow("honeycomb_rotated") << QList<int>{12} << 12;
   QTest::newRow("rhombic_dodecahedron") << QList<int>{24} << 24;
   QTest::newRow("octet") << QList<int>{24, 12} << 24;
}

void LatticeGeometryTest::cellsKeepTheRotationsOfTheirSymmetry()
{
   QFETCH(QList<int>, cell);
   QFETCH(int, composites);
   const auto l = test::namedLattice(QTest::currentDataTag());
   QVERIFY(l);
   std::vector<const Shape *> shapes;
   for (int site = 0; site < l->sites(); ++site)
      if (std::find(shapes.begin(), shapes.end(), &l->shape(site)) == shapes.end())
         shapes.push_back(&l->shape(site));
   QList<int> found;
   for (const Shape *shape : shapes)
      found.append(static_cast<int>(shape->rotations.size()));
   QCOMPARE(found, cell);
   QCOMPARE(static_cast<int>(l->rotations().size()), composites);
   QVERIFY(l->rotations()[0].isApprox(Quat::Identity()));
}

void LatticeGeometryTest::latticesBeyondTheSheetFillSpace_data()
{
   QTest::addColumn<QList<int>>("counts"); // of site 1: V E F, joined, face, edge, vertex
   QTest::newRow("kelvin_body_centred") << QList<int>{24, 36, 14, 14, 14, 0, 0};
   // Two cells meet at each of the 6 corners where four edges meet.
   QTest::newRow("rhombic_dodecahedron") << QList<int>{14, 24, 12, 12, 12, 0, 6};
   // At a corner 6 octahedra and 8 tetrahedra meet, at an edge two of each. A tetrahedron: 4 corners, each
   // with 7 other tetrahedra, of which 3 by edges counted at two corners, and 6 octahedra, 3 by its faces.
   QTest::newRow("octet") << QList<int>{4, 6, 4, 4, 4, 6, 4 * 4 + 4 * 3};
}

void LatticeGeometryTest::latticesBeyondTheSheetFillSpace()
{
   QFETCH(QList<int>, counts);
   const auto l = test::namedLattice(QTest::currentDataTag());
   QVERIFY(l);
   double filled = 0;
   for (int site = 0; site < l->sites(); ++site) {
      filled += l->shape(site).volume;
      for (const auto &[a, b] : l->shape(site).edges) // unit edges
         QVERIFY(std::abs((l->shape(site).vertices[static_cast<std::size_t>(a)] -
                           l->shape(site).vertices[static_cast<std::size_t>(b)])
                              .norm() -
                          1) < 1e-12);
   }
   QVERIFY(std::abs(filled / (l->volumePerSite() * l->sites()) - 1) < 1e-12);
   std::map<Contact, int> contacts;
   int joined = 0;
   for (const Link &link : l->links(1)) {
      ++contacts[link.contact];
      joined += link.joined;
   }
   const Shape &shape = l->shape(1);
   const QList<int> found{static_cast<int>(shape.vertices.size()),
                          static_cast<int>(shape.edges.size()),
                          static_cast<int>(shape.faces.size()),
                          joined,
                          contacts[Contact::face],
                          contacts[Contact::edge],
                          contacts[Contact::vertex]};
   QCOMPARE(found, counts);
}

void LatticeGeometryTest::linksAreMutualAndTheirFeaturesCoincide()
{
   QFETCH(QString, name);
   const auto l = test::namedLattice(name.toStdString(), 1e-3, {1, 1, 1});
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
   const auto l = test::namedLattice(name.toStdString(), 1.27e-3);
   QVERIFY(l);
   // Perturbed by a fifth of the distance to the nearest other centre, in all directions: still the same
   // cell.
   double closest = std::numeric_limits<double>::infinity();
   for (int site = 0; site < l->sites(); ++site)
      for (const Link &link : l->links(site)) {
         const Index i = test::siteIndex(*l, site);
         closest = std::min(closest, (l->position(i + link.offset) - l->position(i)).norm());
      }
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

// DIATOM_LONG_TESTS=1 takes a million points per lattice.
void LatticeGeometryTest::nearestAgreesWithASearchOverAllCells()
{
   QFETCH(QString, name);
   const auto l = test::namedLattice(name.toStdString());
   QVERIFY(l);
   constexpr unsigned kSeed = 20240607;
   qInfo("seed %u", kSeed);
   std::mt19937_64 random(kSeed);
   std::uniform_real_distribution<double> within(-1000, 1000);
   const Search search(*l);
   const int points = qEnvironmentVariableIsSet("DIATOM_LONG_TESTS") ? 1000000 : 10000;
   for (int n = 0; n < points; ++n) {
      const Vec3 point(within(random), within(random), within(random));
      const Index found = l->nearest(point);
      // Distances of numbers up to 1000 are good to 1e-13.
      QVERIFY((l->position(found) - point).norm() < search.distance(point) + 1e-11);
      QVERIFY(l->nearest(l->position(found)) == found);
   }
}

void LatticeGeometryTest::aPointInsideACellOfASpaceFillingLatticeBelongsToIt_data()
{
   QTest::addColumn<QString>("name");
   // Octet cells are not the regions nearest to their centres: octahedra are larger than their tetrahedra.
   for (const char *name :
        {"gik", "honeycomb", "honeycomb_rotated", "kelvin_body_centred", "rhombic_dodecahedron"})
      QTest::newRow(name) << name;
}

void LatticeGeometryTest::aPointInsideACellOfASpaceFillingLatticeBelongsToIt()
{
   QFETCH(QString, name);
   const auto l = test::namedLattice(name.toStdString());
   QVERIFY(l);
   for (const Index i : {Index{4, -3, 7}, Index{-1, 2, -6}})
      for (const Vec3 &corner : l->corners(l->site(i)))
         QVERIFY(l->nearest(l->position(i) + 0.999 * corner) == i);
}

void LatticeGeometryTest::nearestOfTiesIsTheSmallerIndex()
{
   const auto cube = test::namedLattice("cube", 1e-3);
   QVERIFY(cube);
   for (int i = -50; i < 50; ++i) {
      QVERIFY((cube->nearest({(i + 0.5) * 1e-3, 0, 0}) == Index{i, 0, 0}));
      QVERIFY((cube->nearest({(i + 0.5) * 1e-3, (i + 0.5) * 1e-3, (i + 0.5) * 1e-3}) == Index{i, i, i}));
   }
   // Half way between two layers of octahedra, where the centre of a shared edge is as far from four cells.
   const auto octahedra = test::namedLattice("octahedron_edge");
   QVERIFY(octahedra);
   QVERIFY((octahedra->nearest(0.5 * (octahedra->position({0, 0, 0}) + octahedra->position({1, 1, 1}))) ==
            Index{0, 0, 0}));
}

void LatticeGeometryTest::nearestOfPointsOutOfRangeIsInRange()
{
   QFETCH(QString, name);
   const auto l = test::namedLattice(name.toStdString());
   QVERIFY(l);
   const double infinity = std::numeric_limits<double>::infinity(),
                nan = std::numeric_limits<double>::quiet_NaN();
   for (const double far : {1e10, 1e300, infinity}) {
      const Index high = l->nearest({far, 0, far}), low = l->nearest({-far, -far, 0});
      // In the outermost period: which of its sites reaches farthest is the lattice's affair.
      const auto period = l->period();
      const auto limit = [](std::int32_t v, int steps) { return std::abs(v) > kIndexLimit - steps; };
      QVERIFY(inRange(high) && high.x > 0 && limit(high.x, period[0]) && high.z > 0 &&
              limit(high.z, period[2]));
      QVERIFY(inRange(low) && low.x < 0 && limit(low.x, period[0]) && low.y < 0 && limit(low.y, period[1]));
   }
   QVERIFY(inRange(l->nearest({nan, nan, nan})));
}

void LatticeGeometryTest::pitchAndAspectScaleSitesAndShapesAlike()
{
   for (const std::string &name : test::latticeNames()) {
      const auto unit = test::namedLattice(name), scaled = test::namedLattice(name, 2e-3, {1, 1.5, 0.75});
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
   QCOMPARE(test::namedLattice("cube", 1, {1, 1.5, 0.75})->rotations().size(), std::size_t{4});
   QCOMPARE(test::namedLattice("cube", 1, {1, 1, 0.75})->rotations().size(), std::size_t{8});
   QCOMPARE(test::namedLattice("octahedron_edge", 1, {1, 1, 0.75})->rotations().size(), std::size_t{8});
   // Bricks 1.5 times as wide as long no longer fit when turned by a quarter.
   QCOMPARE(test::namedLattice("gik", 1, {1, 1.5, 1})->rotations().size(), std::size_t{4});
}

void LatticeGeometryTest::acrossFaceFindsTheLinkOfEachFace()
{
   QFETCH(QString, name);
   const auto l = test::namedLattice(name.toStdString());
   QVERIFY(l);
   const auto cornersOf = [&](Index cell, const std::vector<int> &face) {
      std::vector<std::array<long long, 3>> points; // in millionths
      for (const int n : face) {
         const Vec3 p = l->position(cell) + l->corners(l->site(cell))[static_cast<std::size_t>(n)];
         points.push_back({std::llround(p.x() * 1e6), std::llround(p.y() * 1e6), std::llround(p.z() * 1e6)});
      }
      std::sort(points.begin(), points.end());
      return points;
   };
   for (int site = 0; site < l->sites(); ++site)
      for (int face = 0; face < static_cast<int>(l->shape(site).faces.size()); ++face) {
         // A cell meets the face when one of its own faces has the same corners.
         const Index home = test::siteIndex(*l, site);
         const auto wanted = cornersOf(home, l->shape(site).faces[static_cast<std::size_t>(face)]);
         std::vector<Index> beyond;
         for (int x = -2; x <= 2; ++x)
            for (int y = -2; y <= 2; ++y)
               for (int z = -5; z <= 5; ++z) {
                  const Index other = home + Index{x, y, z};
                  const auto &faces = l->shape(l->site(other)).faces;
                  if (other != home && std::any_of(faces.begin(), faces.end(), [&](const auto &f) {
                         return cornersOf(other, f) == wanted;
                      }))
                     beyond.push_back(other);
               }
         QVERIFY(beyond.size() <= 1);
         const Link *link = l->acrossFace(site, face);
         QCOMPARE(link != nullptr, !beyond.empty());
         if (link)
            QVERIFY(home + link->offset == beyond.front());
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
   const auto l = test::namedLattice(name.toStdString(), 1e-3);
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
