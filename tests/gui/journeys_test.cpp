// A newcomer's first hour (journeys J1 to J3 of the design): every step by pointer and keys, checked in the
// model, in the words on screen and in the picture.
#include "studio.h"

#include <set>

using namespace diatom;
using namespace diatom::test;

class JourneysTest : public QObject
{
   Q_OBJECT

private slots:
   void seeTheBeamMove();
   void firstCells();
   void aLatticeThatIsNotCubes();
   void aFaceWithoutNeighbourSaysSo();
};

void JourneysTest::seeTheBeamMove()
{
   Studio studio;
   QVERIFY(studio.ready());
   QVERIFY(studio.choose({"menu.file", "menu.samples"}, "file.sample.bending-beam"));
   QTRY_VERIFY(studio.cells() > 10);
   QTRY_VERIFY(studio.window.windowTitle().contains("bending-beam"));
   studio.leave();
   QVERIFY(studio.settle());
   const QImage first = studio.picture();
   auto *legend = studio.window.findChild<gui::LegendWidget *>("legend");
   QVERIFY(!legend->isVisible());

   Index tip;
   studio.window.session().hierarchy()->visit(studio.window.session().hierarchy()->bounds(),
                                              [&](Index i, Cell) {
                                                 if (i.x > tip.x)
                                                    tip = i;
                                                 return true;
                                              });
   const double pitch = studio.window.session().design().model.lattice.pitch;
   const double rest = studio.view().cellPosition(tip).z();
   studio.view().setFocus();
   studio.key(Qt::Key_Space);
   QTRY_VERIFY(studio.window.player().playing());
   QCOMPARE(studio.action("simulate.play")->text(), QString("&Pause"));
   QTRY_VERIFY_WITH_TIMEOUT(
       studio.window.player().frame() && studio.window.player().frame()->frame.time >= 1.0, 120000);
   QTRY_VERIFY(studio.label("status.run").contains("x real time"));
   QVERIFY2(rest - studio.view().cellPosition(tip).z() > 0.5 * pitch,
            qPrintable(QString::number((rest - studio.view().cellPosition(tip).z()) / pitch)));
   QVERIFY(legend->isVisible());
   QVERIFY2(legend->text().contains(QRegularExpression("^displacement \\((mm|um)\\)( [0-9.]+){2,}$")),
            qPrintable(legend->text()));

   studio.key(Qt::Key_Space);
   QTRY_VERIFY(studio.label("status.run").contains("paused"));
   // Whatever was under way when the key was pressed is one slice; from here on time stands still.
   QVERIFY(studio.settle());
   const double stopped = studio.window.player().frame()->frame.time;
   const QImage still = studio.picture();
   QVERIFY(still != first);
   for (int i = 0; i < 3; ++i)
      QVERIFY(studio.settle());
   QCOMPARE(studio.window.player().frame()->frame.time, stopped);

   studio.key(Qt::Key_Backspace);
   QTRY_COMPARE(studio.label("status.run"), QString("at rest"));
   QVERIFY(studio.settle());
   QVERIFY(studio.picture() == first);
   QVERIFY(!legend->isVisible());
   QCOMPARE(studio.view().cellPosition(tip).z(), rest);
}

void JourneysTest::firstCells()
{
   Studio studio;
   QVERIFY(studio.ready());
   QVERIFY(studio.choose({"menu.file", "menu.new"}, "file.new.org.diatom_cad.lattice.cube"));
   QTRY_VERIFY(studio.window.session().hierarchy());
   studio.leave();
   QVERIFY(studio.settle());
   const QImage empty = studio.picture();
   const QString emptyHash = studio.window.session().stateHash();
   studio.key(Qt::Key_B);
   studio.key(Qt::Key_1);

   const auto place = [&](const QPointF &at, Index expected, std::uint64_t count) {
      studio.moveTo(at);
      QTRY_VERIFY(studio.view().ghost().visible);
      QVERIFY(studio.view().ghost().cell == expected);
      QVERIFY(studio.settle());
      const QImage ghost = studio.picture();
      studio.click(at);
      QTRY_COMPARE(studio.cells(), count);
      QVERIFY(!studio.window.session().hierarchy()->at(expected).empty());
      QVERIFY(studio.label("status.counts").startsWith(QString::number(count) + " cell"));
      QVERIFY(studio.settle());
      QVERIFY(studio.picture() != ghost);
   };
   // The top of a cube is the face whose neighbour is one up.
   const auto top = [&](Index cell) {
      const Lattice &lattice = studio.window.session().hierarchy()->lattice();
      for (const Link &link : lattice.links(lattice.site(cell)))
         if (link.contact == Contact::face && link.offset == Index{0, 0, 1})
            return *studio.view().screenPos(cell, link.contact, link.feature);
      return QPointF();
   };
   place(*studio.view().screenPosBase({0, 0, 0}), {0, 0, 0}, 1);
   QCOMPARE(studio.action("edit.undo")->text(), QString("&Undo place"));
   place(top({0, 0, 0}), {0, 0, 1}, 2);
   QVERIFY2(studio.label("status.address").startsWith("(0,0,"), qPrintable(studio.label("status.address")));
   place(top({0, 0, 1}), {0, 0, 2}, 3);

   // Elsewhere: 3x3 on the base plane, pulled up to 3.
   studio.drag(*studio.view().screenPosBase({2, -3, 0}), *studio.view().screenPosBase({4, -1, 0}),
               Qt::ShiftModifier);
   QVERIFY(studio.view().builder().region() == (Box{{2, -3, 0}, {4, -1, 0}}));
   QVERIFY(studio.label("hint").startsWith("Region 3x3x1"));
   const QPointF grip = *studio.view().screenPosArrow();
   const QPointF oneUp = *studio.view().screenPos({3, -2, 2}) - *studio.view().screenPos({3, -2, 0});
   studio.drag(grip, grip + oneUp);
   QVERIFY2(studio.label("hint").startsWith("Region 3x3x3"), qPrintable(studio.label("hint")));
   QCOMPARE(studio.cells(), std::uint64_t(3));
   studio.key(Qt::Key_Return);
   QTRY_COMPARE(studio.cells(), std::uint64_t(30));
   QCOMPARE(studio.action("edit.undo")->text(), QString("&Undo fill 3x3x3"));
   studio.leave();
   QVERIFY(studio.settle());
   const QImage full = studio.picture();
   const QString fullHash = studio.window.session().stateHash();

   int undone = 0;
   for (; studio.action("edit.undo")->isEnabled() && undone < 10; ++undone)
      studio.key(Qt::Key_Z, Qt::ControlModifier);
   QCOMPARE(undone, 4);
   QCOMPARE(studio.action("edit.undo")->text(), QString("Nothing to Undo"));
   QCOMPARE(studio.window.session().stateHash(), emptyHash);
   QVERIFY(studio.settle());
   QVERIFY(studio.picture() == empty);
   for (int i = 0; i < 4; ++i)
      studio.key(Qt::Key_Z, Qt::ControlModifier | Qt::ShiftModifier);
   QCOMPARE(studio.action("edit.redo")->text(), QString("Nothing to Redo"));
   QCOMPARE(studio.window.session().stateHash(), fullHash);
   QVERIFY(studio.settle());
   QVERIFY(studio.picture() == full);
}

void JourneysTest::aLatticeThatIsNotCubes()
{
   Studio studio;
   QVERIFY(studio.ready());
   QVERIFY(studio.choose({"menu.file", "menu.new"}, "file.new.org.diatom_cad.lattice.kelvin_body_centred"));
   QTRY_COMPARE(studio.window.session().design().model.lattice.id,
                std::string("org.diatom_cad.lattice.kelvin_body_centred"));
   QVERIFY(studio.settle());
   studio.click(*studio.view().screenPosBase({0, 0, 0}));
   QTRY_COMPARE(studio.cells(), std::uint64_t(1));
   const Index first{};
   QVERIFY(!studio.window.session().hierarchy()->at(first).empty());

   const Lattice &lattice = studio.window.session().hierarchy()->lattice();
   const Shape &shape = lattice.shape(lattice.site(first));
   std::set<Index> neighbours;
   int hexagons = 0, squares = 0;
   for (const Link &link : lattice.links(lattice.site(first)))
      if (link.contact == Contact::face) {
         neighbours.insert(first + link.offset);
         (shape.faces[std::size_t(link.feature)].size() == 6 ? hexagons : squares)++;
      }
   QCOMPARE(hexagons, 8);
   QCOMPARE(squares, 6);

   // A face of so many corners that the pointer can reach, i.e. hovering its middle gives that very port.
   const auto hoverFace = [&](std::size_t corners) {
      for (int face = 0; face < static_cast<int>(shape.faces.size()); ++face) {
         if (shape.faces[std::size_t(face)].size() != corners)
            continue;
         studio.moveTo(*studio.view().screenPos(first, Contact::face, face));
         const gui::Ghost &ghost = studio.view().ghost();
         if (ghost.visible && ghost.cell && ghost.port.cell == first && ghost.port.feature == face)
            return true;
      }
      return false;
   };
   QPointF at;
   std::uint64_t count = 1;
   for (const std::size_t corners : {std::size_t(6), std::size_t(4)}) {
      QVERIFY(hoverFace(corners));
      QCOMPARE(studio.view().ghost().corners, int(corners));
      QVERIFY(neighbours.count(*studio.view().ghost().cell) == 1);
      const Index expected = *studio.view().ghost().cell;
      QVERIFY(studio.label("status.address")
                  .contains(QString("face %1").arg(studio.view().ghost().port.feature)));
      at = *studio.view().screenPos(first, Contact::face, studio.view().ghost().port.feature);
      studio.click(at);
      ++count;
      QTRY_COMPARE(studio.cells(), count);
      QVERIFY(!studio.window.session().hierarchy()->at(expected).empty());
   }

   // The wheel leads on to a face that looks away; its ghost shines through the cells in front of it.
   QVERIFY(hoverFace(6));
   at = *studio.view().screenPos(first, Contact::face, studio.view().ghost().port.feature);
   const Vec3 toEye = studio.view().camera().backward();
   const auto looksAway = [&] {
      const Vec3 out = lattice.position(*studio.view().ghost().port.neighbour) - lattice.position(first);
      return out.normalized().dot(toEye) < -0.5;
   };
   int turns = 0;
   for (; turns < 14 && !looksAway(); ++turns)
      studio.wheel(at, 1, Qt::AltModifier);
   QVERIFY(looksAway());
   const Index hidden = *studio.view().ghost().cell;
   QVERIFY(neighbours.count(hidden) == 1);
   QVERIFY(studio.settle());
   const QImage shown = studio.picture();
   const QPoint middle = (studio.view().screenPos(hidden)->toPoint());
   studio.click(at);
   ++count;
   QTRY_COMPARE(studio.cells(), count);
   QVERIFY(!studio.window.session().hierarchy()->at(hidden).empty());
   // Around the hidden neighbour's middle the picture with the ghost differs from the one without.
   studio.key(Qt::Key_Z, Qt::ControlModifier);
   --count;
   QTRY_COMPARE(studio.cells(), count);
   studio.leave();
   QVERIFY(studio.settle());
   const QImage bare = studio.picture();
   int changed = 0;
   for (int dx = -12; dx <= 12; ++dx)
      for (int dy = -12; dy <= 12; ++dy)
         changed += shown.pixel(middle + QPoint(dx, dy)) != bare.pixel(middle + QPoint(dx, dy));
   QVERIFY2(changed > 60, qPrintable(QString::number(changed)));
}

void JourneysTest::aFaceWithoutNeighbourSaysSo()
{
   Studio studio;
   QVERIFY(studio.ready());
   // On the simple cubic Kelvin lattice squares meet and hexagons face holes.
   QVERIFY(studio.choose({"menu.file", "menu.new"}, "file.new.org.diatom_cad.lattice.kelvin"));
   QTRY_COMPARE(studio.window.session().design().model.lattice.id,
                std::string("org.diatom_cad.lattice.kelvin"));
   QVERIFY(studio.settle());
   studio.click(*studio.view().screenPosBase({0, 0, 0}));
   QTRY_COMPARE(studio.cells(), std::uint64_t(1));
   const auto hierarchy = studio.window.session().hierarchy(); // keeps the lattice alive through edits
   const auto &faces = hierarchy->lattice().shape(0).faces;
   const auto hoverFace = [&](std::size_t corners) -> std::optional<QPointF> {
      for (int face = 0; face < static_cast<int>(faces.size()); ++face) {
         if (faces[std::size_t(face)].size() != corners)
            continue;
         const QPointF at = *studio.view().screenPos({}, Contact::face, face);
         studio.moveTo(at);
         const gui::Ghost &ghost = studio.view().ghost();
         if (ghost.visible && ghost.port.cell == Index{} && !ghost.port.base && ghost.port.feature == face)
            return at;
      }
      return std::nullopt;
   };
   const auto hexagon = hoverFace(6);
   QVERIFY(hexagon);
   QCOMPARE(studio.view().ghost().corners, 6);
   QVERIFY(!studio.view().ghost().cell);
   QCOMPARE(studio.label("hint"), QString("no neighbour here"));
   QVERIFY(studio.settle());
   const QImage hatched = studio.picture();
   studio.click(*hexagon);
   QVERIFY(studio.settle());
   QCOMPARE(studio.cells(), std::uint64_t(1));
   studio.leave();
   QVERIFY(studio.settle());
   QVERIFY(studio.picture() != hatched);

   const auto square = hoverFace(4);
   QVERIFY(square);
   QCOMPARE(studio.view().ghost().corners, 4);
   QCOMPARE(studio.label("status.address"),
            QString("(0,0,0) face %1").arg(studio.view().ghost().port.feature));
   const Index expected = *studio.view().ghost().cell;
   studio.click(*square);
   QTRY_COMPARE(studio.cells(), std::uint64_t(2));
   QVERIFY(!studio.window.session().hierarchy()->at(expected).empty());
}

QTEST_MAIN(JourneysTest)
#include "journeys_test.moc"
