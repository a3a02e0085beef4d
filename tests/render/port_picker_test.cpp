// Ports under rays, on every lattice.
#include "render/face_types.h"
#include "render/port_picker.h"
#include "scenes.h"

#include <set>

using namespace diatom;
using namespace diatom::render;
using namespace diatom::test;

namespace {

Hierarchy oneCell(const std::string &id)
{
   Model model = emptyModel(id);
   model.root.cells.set({0, 0, 0}, Cell{1, 0, 0});
   return Hierarchy(makeLattice(id), model);
}

void latticeColumn()
{
   QTest::addColumn<QString>("lattice");
   for (const std::string &id : latticeIds())
      QTest::newRow(id.c_str()) << QString::fromStdString(id);
}

} // namespace

class PortPickerTest : public QObject
{
   Q_OBJECT

private slots:
   void everyFaceLeadsToTheNeighbourThatTouchesThere_data() { latticeColumn(); }
   void everyFaceLeadsToTheNeighbourThatTouchesThere()
   {
      QFETCH(QString, lattice);
      const Hierarchy hierarchy = oneCell(lattice.toStdString());
      const Lattice &l = hierarchy.lattice();
      const int site = l.site({});
      for (int face = 0; face < static_cast<int>(l.shape(site).faces.size()); ++face) {
         // Straight at a point of the face near its first edge.
         const auto corners = faceCorners(l, {}, face);
         Vec3 middle = Vec3::Zero();
         for (const Vec3 &corner : corners)
            middle += corner / double(corners.size());
         const Vec3 aim = 0.8 * (corners[0] + corners[1]) / 2 + 0.2 * middle;
         const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[1]).normalized();
         const Ray ray{Vec3(aim + 10 * l.radius() * normal), Vec3(-normal)};
         const auto pick = pickPort(hierarchy, ray, 1);
         QVERIFY(pick && pick->hit);
         QCOMPARE(pick->hit->face, face);
         const Link *across = l.acrossFace(site, face);
         if (across) {
            QCOMPARE(pick->port.contact, Contact::face);
            QCOMPARE(pick->port.feature, face);
            QVERIFY(pick->port.neighbour == across->offset);
         } else if (pick->port.neighbour) {
            // An edge or vertex of this very face, held by the lattice's own connection.
            QVERIFY(pick->port.contact != Contact::face);
            for (const Vec3 &end : portOutline(l, pick->port)) {
               double nearest = 1;
               for (const Vec3 &corner : corners)
                  nearest = std::min(nearest, (corner - end).norm());
               QVERIFY(nearest < 1e-12);
            }
         }
      }
   }

   void theWheelReachesEveryFreePortAndComesBack_data() { latticeColumn(); }
   void theWheelReachesEveryFreePortAndComesBack()
   {
      QFETCH(QString, lattice);
      const Hierarchy hierarchy = oneCell(lattice.toStdString());
      const auto ports = portsOf(hierarchy, {});
      int wanted = 0; // across faces, and wherever the lattice joins
      for (const Link &link : hierarchy.lattice().links(hierarchy.lattice().site({})))
         wanted += link.contact == Contact::face || link.joined;
      QCOMPARE(ports.size(), static_cast<std::size_t>(wanted));
      std::set<Index> reached;
      Port port = ports[0];
      for (std::size_t i = 0; i < ports.size(); ++i) {
         port = cyclePort(hierarchy, port, 1);
         reached.insert(*port.neighbour);
      }
      QVERIFY(port == ports[0]);
      QCOMPARE(reached.size(), ports.size());
      QVERIFY(cyclePort(hierarchy, cyclePort(hierarchy, port, 1), -1) == port);
   }

   void theBasePlaneOffersTheCellAboveEveryPoint_data() { latticeColumn(); }
   void theBasePlaneOffersTheCellAboveEveryPoint()
   {
      QFETCH(QString, lattice);
      const Hierarchy empty(makeLattice(lattice.toStdString()), emptyModel(lattice.toStdString()));
      const Lattice &l = empty.lattice();
      for (int x = -7; x <= 7; ++x)
         for (int y = -7; y <= 7; ++y) {
            const Index wanted{x, y, 0};
            const Vec3 above = l.position(wanted);
            const auto pick = pickPort(empty, {Vec3(above + Vec3(0, 0, 0.1)), Vec3(0, 0, -1)}, 1);
            QVERIFY(pick && pick->port.base && !pick->hit);
            QVERIFY(pick->port.cell == wanted);
         }
      QVERIFY(!pickPort(empty, {Vec3(0, 0, 0.1), Vec3(0, 0, 1)}, 1)); // away from it
      QVERIFY(!pickPort(empty, {Vec3(0, 0, 0.1), Vec3(1, 0, 0)}, 1)); // along it
   }

   void addressesReadAsInTheStatusBar()
   {
      Port port;
      port.cell = {4, 2, -7};
      port.feature = 9;
      QCOMPARE(port.text(), std::string("(4,2,-7) face 9"));
      port.contact = Contact::edge;
      QCOMPARE(port.text(), std::string("(4,2,-7) edge 9"));
      port.base = true;
      QCOMPARE(port.text(), std::string("(4,2,-7) base plane"));
   }
};

QTEST_APPLESS_MAIN(PortPickerTest)
#include "port_picker_test.moc"
