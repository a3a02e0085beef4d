// The twelve lattices of the earlier program against its fact sheet: table 1.1 and the neighbour lists by
// parity of 1.3 to 1.13, written out here as they stand there.
#include "support/lattices.h"

#include <cmath>
#include <map>

using namespace diatom;

namespace {

using Steps = std::vector<std::array<int, 3>>;
using Plane = std::vector<std::array<int, 2>>;

Steps at(int dz, const Plane &plane)
{
   Steps steps;
   for (const auto &[dx, dy] : plane)
      steps.push_back({dx, dy, dz});
   return steps;
}

Steps operator+(Steps a, const Steps &b)
{
   a.insert(a.end(), b.begin(), b.end());
   return a;
}

/// The six neighbours in a layer whose odd rows are shifted by minus half a step: N6(p) of the sheet.
Plane n6(int p)
{
   return p == 0 ? Plane{{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}}
                 : Plane{{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {-1, 1}, {-1, -1}};
}

const Steps kFaces{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
const Steps kEdges{{1, 1, 0},  {1, -1, 0},  {-1, 1, 0}, {-1, -1, 0}, {1, 0, 1},  {1, 0, -1},
                   {-1, 0, 1}, {-1, 0, -1}, {0, 1, 1},  {0, 1, -1},  {0, -1, 1}, {0, -1, -1}};
const Steps kCorners{{1, 1, 1},  {1, 1, -1},  {1, -1, 1},  {1, -1, -1},
                     {-1, 1, 1}, {-1, 1, -1}, {-1, -1, 1}, {-1, -1, -1}};

struct Neighbours
{
   Steps face, edge, vertex;
};

/// By parity p of the row and layer m of three, of the sheet's tables.
struct Stacked
{
   Plane up, down;
   Steps vertex;
};

// 1.5
const Stacked kOctahedra[2][3] = {
    {{{{-1, 0}, {0, 0}, {0, 1}},
      {{0, 0}, {0, 1}, {1, 1}},
      {{-1, 0, -1}, {1, 0, -1}, {0, 2, -1}, {-1, 1, 1}, {1, 1, 1}, {0, -1, 1}}},
     {{{0, 0}, {1, 0}, {1, 1}},
      {{0, 0}, {1, -1}, {1, 0}},
      {{0, -1, -1}, {2, -1, -1}, {1, 1, -1}, {0, 1, 1}, {2, 1, 1}, {1, -1, 1}}},
     {{{0, -1}, {0, 0}, {1, -1}},
      {{-1, 0}, {0, -1}, {0, 0}},
      {{-1, -1, -1}, {1, -1, -1}, {0, 1, -1}, {-1, 0, 1}, {1, 0, 1}, {0, -2, 1}}}},
    {{{{-1, 0}, {-1, 1}, {0, 0}},
      {{-1, 1}, {0, 0}, {0, 1}},
      {{-1, 0, -1}, {1, 0, -1}, {0, 2, -1}, {-2, 1, 1}, {0, 1, 1}, {-1, -1, 1}}},
     {{{0, 0}, {0, 1}, {1, 0}},
      {{0, -1}, {0, 0}, {1, 0}},
      {{-1, -1, -1}, {1, -1, -1}, {0, 1, -1}, {-1, 1, 1}, {1, 1, 1}, {0, -1, 1}}},
     {{{-1, -1}, {0, -1}, {0, 0}},
      {{-1, -1}, {-1, 0}, {0, 0}},
      {{-2, -1, -1}, {0, -1, -1}, {-1, 1, -1}, {-1, 0, 1}, {1, 0, 1}, {0, -2, 1}}}}};

// 1.11
const Stacked kTetrahedra[2][3] = {{{{{-1, 0}, {0, -1}, {0, 0}}, {{0, -1}, {0, 0}, {1, -1}}, {}},
                                    {{{0, 0}, {1, -1}, {1, 0}}, {{0, 0}, {1, 0}, {1, 1}}, {}},
                                    {{{0, 0}, {0, 1}, {1, 1}}, {{-1, 0}, {0, 0}, {0, 1}}, {}}},
                                   {{{{-1, -1}, {-1, 0}, {0, 0}}, {{-1, -1}, {0, -1}, {0, 0}}, {}},
                                    {{{0, -1}, {0, 0}, {1, 0}}, {{0, 0}, {0, 1}, {1, 0}}, {}},
                                    {{{-1, 1}, {0, 0}, {0, 1}}, {{-1, 0}, {-1, 1}, {0, 0}}, {}}}};

Neighbours neighboursOf(const std::string &name, Index i)
{
   const int p = floorMod(i.y, 2), q = floorMod(i.z, 2), m = floorMod(i.z, 3);
   const Steps layer = at(0, n6(p)), column{{0, 0, 1}, {0, 0, -1}};
   if (name == "cube" || name == "gik")
      return {kFaces, kEdges, kCorners};
   if (name == "octahedron_face")
      return {column, layer, at(1, n6(p)) + at(-1, n6(p))};
   if (name == "octahedron_edge_flat") {
      const Stacked &s = kOctahedra[p][m];
      return {{}, layer + at(1, s.up) + at(-1, s.down), s.vertex};
   }
   if (name == "octahedron_edge") {
      const Plane odd{{-1, -1}, {-1, 0}, {0, -1}, {0, 0}}, even{{0, 0}, {0, 1}, {1, 0}, {1, 1}};
      return {{},
              at(0, {{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) + at(1, q ? odd : even) + at(-1, q ? odd : even),
              at(0, {{1, 1}, {1, -1}, {-1, 1}, {-1, -1}}) + Steps{{0, 0, 2}, {0, 0, -2}}};
   }
   if (name == "octahedron_vertex")
      return {{}, {}, kFaces};
   if (name == "tetrahedron_stacked") {
      const int toBase = q == 0 ? -1 : 1;
      return {{{0, 0, toBase}}, {}, Steps{{0, 0, -toBase}} + layer + at(toBase, n6(p))};
   }
   if (name == "tetrahedron_vertex") {
      const Stacked &s = kTetrahedra[p][m];
      return {{}, {}, layer + at(1, s.up) + at(-1, s.down)};
   }
   if (name == "cuboctahedron")
      return {kFaces, {}, kEdges};
   if (name == "kelvin")
      return {kFaces, {}, {}};
   if (name == "honeycomb")
      return {layer + column, at(1, n6(p)) + at(-1, n6(p)), {}};
   if (name == "honeycomb_rotated") {
      const int side = q == 0 ? 1 : -1;
      const Steps around{{0, 0, 1}, {0, 0, -1}, {0, 0, 2}, {0, 0, -2}, {side, 0, 1}, {side, 0, -1}};
      Steps edge;
      for (const auto &[x, y, z] : around)
         for (const int dy : {-1, 1})
            edge.push_back({x, dy, z});
      return {around + Steps{{0, 1, 0}, {0, -1, 0}}, edge, {}};
   }
   return {};
}

const double kA = std::sqrt(2.0), kRow = std::sqrt(3.0) / 2, kLayer = 2 / std::sqrt(6.0);

/// Shift of a cell against index times pitch, in lattice units: the rules of 1.4 to 1.11.
Vec3 shiftOf(const std::string &name, Index i)
{
   const int p = floorMod(i.y, 2), q = floorMod(i.z, 2), m = floorMod(i.z, 3);
   const Vec3 row(p ? -0.5 : 0, 0, 0);
   if (name == "octahedron_face" || name == "tetrahedron_stacked")
      return row;
   if (name == "octahedron_edge_flat" || name == "tetrahedron_vertex") {
      const double sign = name == "octahedron_edge_flat" ? -1 : 1;
      const Vec3 layer[] = {{0, 0, 0}, {0.5, sign / (2 * std::sqrt(3)), 0}, {0, sign / std::sqrt(3), 0}};
      return row + layer[m];
   }
   if (name == "octahedron_edge")
      return q ? Vec3(-0.5, -0.5, 0) : Vec3(0, 0, 0);
   if (name == "honeycomb")
      return std::sqrt(3.0) * row;
   if (name == "honeycomb_rotated")
      return q ? Vec3(-1.5, 0, 0) : Vec3(0, 0, 0);
   return Vec3::Zero();
}

void addRows()
{
   // Table 1.1: pitch; V E F; volume, packing; neighbours by the named connection; touching by face, edge and
   // vertex.
   QTest::addColumn<QList<double>>("pitch");
   QTest::addColumn<QList<int>>("counts"); // V E F, joined, face, edge, vertex
   QTest::addColumn<double>("volume");
   QTest::addColumn<double>("packing");
   const double octahedron = kA / 3, tetrahedron = kA / 12, prism = 3 * std::sqrt(3) / 2;
   const auto row = [](const char *name, QList<double> pitch, QList<int> counts, double volume,
                       double packing) { QTest::newRow(name) << pitch << counts << volume << packing; };
   row("cube", {1, 1, 1}, {8, 12, 6, 6, 6, 12, 8}, 1, 1);
   row("gik", {1, 1, 1.28}, {8, 12, 6, 2, 6, 12, 8}, 1.28, 1);
   row("octahedron_face", {1, kRow, kLayer}, {6, 12, 8, 2, 2, 6, 12}, octahedron, 2.0 / 3);
   row("octahedron_edge_flat", {1, kRow, kLayer}, {6, 12, 8, 12, 0, 12, 6}, octahedron, 2.0 / 3);
   row("octahedron_edge", {1, 1, kA / 2}, {6, 12, 8, 12, 0, 12, 6}, octahedron, 2.0 / 3);
   row("octahedron_vertex", {kA, kA, kA}, {6, 12, 8, 6, 0, 0, 6}, octahedron, 1.0 / 6);
   row("tetrahedron_stacked", {1, kRow, kLayer}, {4, 6, 4, 14, 1, 0, 13}, tetrahedron, 1.0 / 6);
   row("tetrahedron_vertex", {1, kRow, kLayer}, {4, 6, 4, 12, 0, 0, 12}, tetrahedron, 1.0 / 6);
   row("cuboctahedron", {kA, kA, kA}, {12, 24, 14, 6, 6, 0, 12}, 5 * kA / 3, 5.0 / 6);
   row("kelvin", {2 * kA, 2 * kA, 2 * kA}, {24, 36, 14, 6, 6, 0, 0}, 8 * kA, 0.5);
   row("honeycomb", {std::sqrt(3), 1.5, 1}, {12, 18, 8, 8, 8, 12, 0}, prism, 1);
   row("honeycomb_rotated", {3, 1, kRow}, {12, 18, 8, 8, 8, 12, 0}, prism, 1);
}

const Index kNear[2] = {{-7, -7, -7}, {6, 6, 6}}; // every class of parity, on both sides of zero

template<typename Act>
void eachNear(Act act)
{
   for (int x = kNear[0].x; x <= kNear[1].x; ++x)
      for (int y = kNear[0].y; y <= kNear[1].y; ++y)
         for (int z = kNear[0].z; z <= kNear[1].z; ++z)
            act(Index{x, y, z});
}

} // namespace

class LatticeSheetTest : public QObject
{
   Q_OBJECT

private slots:
   void cellsPackingAndContactsAreThoseOfTheTable_data() { addRows(); }
   void cellsPackingAndContactsAreThoseOfTheTable();
   void positionsFollowPitchAndParity_data() { addRows(); }
   void positionsFollowPitchAndParity();
   void neighboursAreThoseListedByParity_data() { addRows(); }
   void neighboursAreThoseListedByParity();
   void oddLayersOfOctahedraOnFacesAreTurned();
   void tetrahedraStandByLayerOfFour();
   void gikHeightsAreThoseOfTheApplications();
};

void LatticeSheetTest::cellsPackingAndContactsAreThoseOfTheTable()
{
   QFETCH(QList<int>, counts);
   QFETCH(double, volume);
   QFETCH(double, packing);
   const auto l = test::namedLattice(QTest::currentDataTag());
   QVERIFY(l);
   for (int site = 0; site < l->sites(); ++site) {
      const Shape &shape = l->shape(site);
      std::map<Contact, int> contacts;
      int joined = 0;
      for (const Link &link : l->links(site)) {
         ++contacts[link.contact];
         joined += link.joined;
      }
      const auto count = [](const auto &list) { return static_cast<int>(list.size()); };
      const QList<int> found{
          count(shape.vertices),   count(shape.edges),      count(shape.faces),       joined,
          contacts[Contact::face], contacts[Contact::edge], contacts[Contact::vertex]};
      QCOMPARE(found, counts);
      // Sums of at most a hundred products of numbers near 1.
      QVERIFY(std::abs(shape.volume - volume) < 1e-12 * volume);
      QVERIFY(std::abs(shape.volume / l->volumePerSite() - packing) < 1e-12);
      const bool gik = std::string(QTest::currentDataTag()) == "gik";
      for (const auto &[a, b] : shape.edges) {
         const double length =
             (shape.vertices[static_cast<std::size_t>(a)] - shape.vertices[static_cast<std::size_t>(b)])
                 .norm();
         QVERIFY(std::abs(length - 1) < 1e-12 || (gik && std::abs(length - 1.28) < 1e-12));
      }
   }
}

void LatticeSheetTest::positionsFollowPitchAndParity()
{
   QFETCH(QList<double>, pitch);
   const auto l = test::namedLattice(QTest::currentDataTag());
   QVERIFY(l);
   int wrong = 0;
   eachNear([&](Index i) {
      const Vec3 expected =
          Vec3(i.x * pitch[0], i.y * pitch[1], i.z * pitch[2]) + shiftOf(QTest::currentDataTag(), i);
      wrong += (l->position(i) - expected).norm() > 1e-12; // a few roundings of numbers near 10
   });
   QCOMPARE(wrong, 0);
}

void LatticeSheetTest::neighboursAreThoseListedByParity()
{
   const auto l = test::namedLattice(QTest::currentDataTag());
   QVERIFY(l);
   eachNear([&](Index i) {
      std::map<Index, Contact> expected, found;
      const Neighbours listed = neighboursOf(QTest::currentDataTag(), i);
      const auto put = [&](const Steps &steps, Contact contact) {
         for (const auto &[x, y, z] : steps)
            expected[{x, y, z}] = contact;
      };
      put(listed.face, Contact::face);
      put(listed.edge, Contact::edge);
      put(listed.vertex, Contact::vertex);
      for (const Link &link : l->links(l->site(i)))
         found[link.offset] = link.contact;
      if (expected != found)
         QFAIL(qPrintable(QString("neighbours of %1 %2 %3").arg(i.x).arg(i.y).arg(i.z)));
   });
}

void LatticeSheetTest::oddLayersOfOctahedraOnFacesAreTurned()
{
   const auto l = test::namedLattice("octahedron_face");
   QVERIFY(l);
   eachNear([&](Index i) {
      // 1.4: the top triangle has a corner at -y, in odd layers at +y.
      const Vec3 corner(0, (floorMod(i.z, 2) ? 1 : -1) / std::sqrt(3), 1 / std::sqrt(6));
      const auto corners = l->corners(l->site(i));
      QVERIFY(std::any_of(corners.begin(), corners.end(),
                          [&](const Vec3 &v) { return (v - corner).norm() < 1e-12; }));
   });
}

void LatticeSheetTest::tetrahedraStandByLayerOfFour()
{
   const auto l = test::namedLattice("tetrahedron_stacked");
   QVERIFY(l);
   eachNear([&](Index i) {
      // 1.8: base down, up, down, up with a corner of it at +y, -y, -y, +y.
      const int m = floorMod(i.z, 4);
      const double base = (m % 2 ? 1 : -1) / std::sqrt(6), y = (m == 0 || m == 3 ? 1 : -1) / std::sqrt(3);
      const auto corners = l->corners(l->site(i));
      for (const Vec3 &wanted : {Vec3(0, y, base), Vec3(0, 0, -base)})
         QVERIFY(std::any_of(corners.begin(), corners.end(),
                             [&](const Vec3 &v) { return (v - wanted).norm() < 1e-12; }));
   });
}

void LatticeSheetTest::gikHeightsAreThoseOfTheApplications()
{
   for (const double height : {1.28, 1.17, 1.08, 1.0, 2.5}) { // electronic, LEGO, DNA, default, any
      LatticeSpec spec;
      spec.id = "org.diatom_cad.lattice.gik";
      spec.pitch = 1;
      spec.values["height"] = height;
      const auto l = Lattice::make(*test::catalogue(), spec, Job());
      DIATOM_VERIFY_OK(l);
      QVERIFY(std::abs((*l)->shape(0).volume - height) < 1e-12);
      QVERIFY(((*l)->position({3, -4, -5}) - Vec3(3, -4, -5 * height)).norm() < 1e-12);
      QCOMPARE((*l)->links(0).size(), std::size_t{26});
   }
}

QTEST_APPLESS_MAIN(LatticeSheetTest)
#include "lattice_sheet_test.moc"
