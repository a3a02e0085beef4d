// Composites on a lattice: where their cells land, which placements are allowed, and how cells turn with
// them.
#include "support/lattices.h"

#include <algorithm>
#include <cmath>
#include <random>

using namespace diatom;

namespace {

constexpr unsigned kSeed = 7;

Index randomIndex(std::mt19937_64 &random, int range)
{
   std::uniform_int_distribution<int> pick(-range, range);
   return {pick(random), pick(random), pick(random)};
}

const Link *linkBetween(const Lattice &l, Index from, Index to)
{
   const auto links = l.links(l.site(from));
   const auto found =
       std::find_if(links.begin(), links.end(), [&](const Link &k) { return k.offset == to - from; });
   return found == links.end() ? nullptr : &*found;
}

void addLattices()
{
   QTest::addColumn<QString>("name");
   QTest::addColumn<QList<double>>("aspect");
   for (const std::string &name : test::latticeNames()) {
      const auto text = QString::fromStdString(name);
      QTest::newRow(name.c_str()) << text << QList<double>{1, 1, 1};
      QTest::newRow((name + " stretched").c_str()) << text << QList<double>{1, 1, 1.3};
      QTest::newRow((name + " oblong").c_str()) << text << QList<double>{1, 1.2, 0.9};
   }
}

std::shared_ptr<const Lattice> fetchedLattice()
{
   const QString *name = static_cast<const QString *>(QTest::qData("name", QMetaType::QString));
   const auto *aspect =
       static_cast<const QList<double> *>(QTest::qData("aspect", qMetaTypeId<QList<double>>()));
   return test::namedLattice(name->toStdString(), 1e-3, {aspect->at(0), aspect->at(1), aspect->at(2)});
}

} // namespace

class LatticePlacementTest : public QObject
{
   Q_OBJECT

private slots:
   void initTestCase() { qInfo("seed %u", kSeed); }
   void unplaceUndoesPlace_data() { addLattices(); }
   void unplaceUndoesPlace();
   void placementsKeepContactsAndShapes_data() { addLattices(); }
   void placementsKeepContactsAndShapes();
   void rotationsFormAGroupAndPlacementsCompose_data() { addLattices(); }
   void rotationsFormAGroupAndPlacementsCompose();
   void cellsTurnWithTheirComposite_data() { addLattices(); }
   void cellsTurnWithTheirComposite();
   void theIdentityIsFirstAndMovesOnly_data() { addLattices(); }
   void theIdentityIsFirstAndMovesOnly();
   void bricksTurnByAQuarterBetweenLayers();
   void brickStepsFollowTheLayers();
   void rotationsAreNumberedAsDocumented();
};

void LatticePlacementTest::unplaceUndoesPlace()
{
   const auto l = fetchedLattice();
   QVERIFY(l);
   std::mt19937_64 random(kSeed);
   for (int n = 0; n < 20000; ++n) {
      const Index origin = randomIndex(random, 1000), local = randomIndex(random, 1000);
      const int r = static_cast<int>(random() % l->rotations().size());
      if (!l->placementAllowed(origin, r))
         continue;
      QVERIFY(l->unplace(origin, r, l->place(origin, r, local)) == local);
      QVERIFY(l->place(origin, r, Index{}) == origin);
   }
   // Far out, where a map through positions has the fewest digits to spare; a step along one axis may be up
   // to four along another.
   const Index far{(1 << 29) - 3, -(1 << 29) + 1, (1 << 29) - 2};
   for (int r = 0; r < static_cast<int>(l->rotations().size()); ++r)
      if (l->placementAllowed(far, r))
         QVERIFY(l->unplace(far, r, l->place(far, r, {1 << 26, 77, -(1 << 26)})) ==
                 (Index{1 << 26, 77, -(1 << 26)}));
}

void LatticePlacementTest::placementsKeepContactsAndShapes()
{
   const auto l = fetchedLattice();
   QVERIFY(l);
   std::mt19937_64 random(kSeed);
   int allowed = 0;
   for (int n = 0; n < 4000; ++n) {
      const Index origin = randomIndex(random, 100), local = randomIndex(random, 100);
      const int r = static_cast<int>(random() % l->rotations().size());
      if (!l->placementAllowed(origin, r))
         continue;
      ++allowed;
      const Mat3 turn = l->rotations()[static_cast<std::size_t>(r)].toRotationMatrix();
      const Index world = l->place(origin, r, local);
      // The centre lands where the documentation says, not merely nearest to it.
      const Vec3 expected = l->position(origin) + turn * (l->position(local) - l->position({}));
      QVERIFY((l->position(world) - expected).norm() < 1e-9 * l->radius());
      for (const Link &link : l->links(l->site(local))) {
         const Link *there = linkBetween(*l, world, l->place(origin, r, local + link.offset));
         QVERIFY(there);
         QVERIFY(there->contact == link.contact && there->joined == link.joined);
      }
      for (const Vec3 &corner : l->corners(l->site(local))) {
         const auto corners = l->corners(l->site(world));
         QVERIFY(std::any_of(corners.begin(), corners.end(),
                             [&](const Vec3 &c) { return (turn * corner - c).norm() < 1e-9 * l->radius(); }));
      }
   }
   QVERIFY(allowed > 800); // a quarter and more of the placements, whatever the lattice
}

void LatticePlacementTest::rotationsFormAGroupAndPlacementsCompose()
{
   const auto l = fetchedLattice();
   QVERIFY(l);
   const auto count = static_cast<int>(l->rotations().size());
   std::mt19937_64 random(kSeed);
   for (int a = 0; a < count; ++a) {
      QCOMPARE(l->compose(a, l->inverse(a)), 0);
      for (int b = 0; b < count; ++b) {
         const Quat product =
             l->rotations()[static_cast<std::size_t>(a)] * l->rotations()[static_cast<std::size_t>(b)];
         const Quat &listed = l->rotations()[static_cast<std::size_t>(l->compose(a, b))];
         QVERIFY(std::abs(product.dot(listed)) > 1 - 1e-12);
      }
   }
   // A composite inside a composite: outer (o, a) of inner (p, b) is the placement (place(o, a, p), a b).
   for (int n = 0; n < 5000; ++n) {
      const Index o = randomIndex(random, 50), p = randomIndex(random, 50), cell = randomIndex(random, 50);
      const int a = static_cast<int>(random() % static_cast<unsigned>(count));
      const int b = static_cast<int>(random() % static_cast<unsigned>(count));
      if (!l->placementAllowed(o, a) || !l->placementAllowed(p, b))
         continue;
      const Index both = l->place(o, a, p);
      QVERIFY(l->placementAllowed(both, l->compose(a, b)));
      QVERIFY(l->place(o, a, l->place(p, b, cell)) == l->place(both, l->compose(a, b), cell));
   }
}

void LatticePlacementTest::cellsTurnWithTheirComposite()
{
   const auto l = fetchedLattice();
   QVERIFY(l);
   std::mt19937_64 random(kSeed);
   for (int n = 0; n < 5000; ++n) {
      const Index origin = randomIndex(random, 20), local = randomIndex(random, 20);
      const int r = static_cast<int>(random() % l->rotations().size());
      if (!l->placementAllowed(origin, r))
         continue;
      const int site = l->site(local), landed = l->site(l->place(origin, r, local));
      const auto &turns = l->shape(site).rotations;
      const int o = static_cast<int>(random() % turns.size());
      const int turned = l->turnedOrientation(local, r, o);
      QCOMPARE(turned, l->turnedOrientation(origin, local, r, o));
      // World orientation before the placement, then turned by it; and the one that the number stands for.
      const Quat before = l->orientation(site) * turns[static_cast<std::size_t>(o)];
      const Quat expected = l->rotations()[static_cast<std::size_t>(r)] * before;
      const Quat after = l->orientation(landed) * turns[static_cast<std::size_t>(turned)];
      QVERIFY(std::abs(expected.dot(after)) > 1 - 1e-12);
   }
}

void LatticePlacementTest::theIdentityIsFirstAndMovesOnly()
{
   const auto l = fetchedLattice();
   QVERIFY(l);
   QVERIFY(l->rotations()[0].isApprox(Quat::Identity()));
   QVERIFY(l->placementAllowed({}, 0));
   for (int site = 0; site < l->sites(); ++site)
      for (int o = 0; o < static_cast<int>(l->shape(site).rotations.size()); ++o)
         QCOMPARE(l->turnedOrientation(test::siteIndex(*l, site), 0, o), o);
}

void LatticePlacementTest::bricksTurnByAQuarterBetweenLayers()
{
   const auto l = test::namedLattice("gik");
   QVERIFY(l);
   QCOMPARE(l->rotations().size(), std::size_t{8});
   for (int r = 0; r < 8; ++r) {
      // Where the rotation takes the x axis decides: along x it keeps brick directions, along y it swaps
      // them.
      const Vec3 x = l->rotations()[static_cast<std::size_t>(r)] * Vec3::UnitX();
      const bool swaps = std::abs(x.y()) > 0.5;
      for (int z = -5; z <= 5; ++z) {
         const bool odd = z % 2 != 0;
         QCOMPARE(l->placementAllowed({3, -2, z}, r), odd == swaps);
      }
   }
}

void LatticePlacementTest::brickStepsFollowTheLayers()
{
   const auto l = test::namedLattice("gik");
   QVERIFY(l && l->hasSupercells());
   for (int z = -3; z <= 3; ++z) {
      const int site = l->site({0, 0, z});
      QVERIFY((l->supercellStep(site) == (z % 2 == 0 ? Index{0, 1, 0} : Index{1, 0, 0})));
      // A brick's own x axis is its length.
      const Vec3 along = l->orientation(site) * Vec3::UnitX();
      const Vec3 step =
          (l->position({z % 2 == 0 ? 0 : 1, z % 2 == 0 ? 1 : 0, z}) - l->position({0, 0, z})).normalized();
      QVERIFY((along - step).norm() < 1e-12);
   }
   QCOMPARE(l->supercellLongest(), 0);
   QCOMPARE(l->supercellDefault(), 4);
   QVERIFY(!test::namedLattice("cube")->hasSupercells());
}

void LatticePlacementTest::rotationsAreNumberedAsDocumented()
{
   // Documents store these numbers: turns about z by 0, 90, 180, 270 degrees come first on every square
   // lattice.
   for (const char *name : {"cube", "gik", "octahedron_edge", "octahedron_vertex", "cuboctahedron", "kelvin",
                            "kelvin_body_centred", "rhombic_dodecahedron"})
   {
      const auto l = test::namedLattice(name);
      QVERIFY(l);
      for (int r = 0; r < 4; ++r) {
         const Quat expected(Eigen::AngleAxisd(r * std::acos(-1.0) / 2, Vec3::UnitZ()));
         QVERIFY(std::abs(expected.dot(l->rotations()[static_cast<std::size_t>(r)])) > 1 - 1e-12);
         QVERIFY(std::abs(expected.dot(l->shape(0).rotations[static_cast<std::size_t>(r)])) > 1 - 1e-12);
      }
   }
}

QTEST_APPLESS_MAIN(LatticePlacementTest)
#include "lattice_placement_test.moc"
