// Find Balance in the studio: where a beam comes to rest, what a plugin's solver of another physics says of
// each cell, and what has no balance.
#include "studio.h"

#include <map>

using namespace diatom;
using namespace diatom::test;

namespace {

class BalanceStudio : public Studio
{
public:
   BalanceStudio()
       : Studio(Catalogue::find({test::binaryDir() / "tests/plugins/solvers", test::binaryDir() / "plugins"}))
   {}
   bool openBeam()
   {
      return ready() && choose({"menu.file", "menu.samples"}, "file.sample.bending-beam") &&
             QTest::qWaitFor([&] { return window.windowTitle().contains("bending-beam") && !window.busy(); },
                             20000);
   }
   bool find()
   {
      view().setFocus();
      key(Qt::Key_B, Qt::ControlModifier);
      return QTest::qWaitFor([&] { return !window.busy(); }, test::kPatience);
   }
   std::map<Index, Vec3> places()
   {
      std::map<Index, Vec3> found;
      const auto hierarchy = window.session().hierarchy();
      hierarchy->visit(hierarchy->bounds(), [&](Index i, Cell) {
         found[i] = view().cellPosition(i);
         return true;
      });
      return found;
   }
   QString message() { return window.findChild<gui::MessageBar *>("messageBar")->text(); }
   gui::LegendWidget &legend() { return *window.findChild<gui::LegendWidget *>("legend"); }
};

} // namespace

class BalanceTest : public QObject
{
   Q_OBJECT

private slots:
   void aBeamSagsUntilAnEdit();
   void anotherPhysicsColoursItsCells();
   void whatIsNotHeldHasNone();
};

void BalanceTest::aBeamSagsUntilAnEdit()
{
   BalanceStudio studio;
   QVERIFY(studio.openBeam());
   const auto rest = studio.places();
   QVERIFY(studio.find());
   QVERIFY2(studio.message().startsWith("In balance the cells lie up to"), qPrintable(studio.message()));
   QCOMPARE(studio.label("status.run"), QString("in balance"));
   QVERIFY(studio.settle());
   double largest = 0;
   for (const auto &[cell, place] : studio.places())
      largest = std::max(largest, (place - rest.at(cell)).norm());
   const double told = studio.message().section(' ', 7, 7).toDouble() * 1e-3;
   QVERIFY2(largest > 1e-3 && std::abs(told - largest) < 1e-3 * largest, // four digits are told
            qPrintable(QString("%1 %2").arg(told).arg(largest)));
   QVERIFY(studio.legend().isVisible() && studio.legend().text().startsWith("displacement"));
   QVERIFY(studio.action("simulate.reset")->isEnabled());
   if (qEnvironmentVariableIsSet("DIATOM_PICTURES"))
      studio.window.grab().save(qEnvironmentVariable("DIATOM_PICTURES") + "/balance.png");
   QVERIFY(studio.window.session().run("set-name", {{"name", "other"}}));
   QTRY_COMPARE(studio.label("status.run"), QString("at rest"));
   QVERIFY(studio.settle());
   QVERIFY(studio.places() == rest);
   QVERIFY(!studio.legend().isVisible());
}

void BalanceTest::anotherPhysicsColoursItsCells()
{
   BalanceStudio studio;
   QVERIFY(studio.openBeam());
   QVERIFY(studio.window.session().run("set-solver", {{"id", "org.example.solver.distance"}}));
   const QImage before = studio.picture();
   const auto rest = studio.places();
   QVERIFY(studio.find());
   // Of a row of cells held at one end the last one is as many bonds away as it has cells before it.
   const int farthest = rest.rbegin()->first.x;
   QCOMPARE(studio.message(), QString("In balance: distance from 0 to %1.").arg(farthest));
   QVERIFY2(studio.legend().text().startsWith("distance 0"), qPrintable(studio.legend().text()));
   QVERIFY(studio.settle());
   QVERIFY(studio.picture() != before);
   QVERIFY(studio.places() == rest);
   if (qEnvironmentVariableIsSet("DIATOM_PICTURES"))
      studio.window.grab().save(qEnvironmentVariable("DIATOM_PICTURES") + "/distance.png");
   studio.key(Qt::Key_Backspace);
   QTRY_COMPARE(studio.label("status.run"), QString("at rest"));
}

void BalanceTest::whatIsNotHeldHasNone()
{
   BalanceStudio studio;
   QVERIFY(studio.openBeam());
   const auto &supports = studio.window.session().design().setup.supports;
   QVERIFY(!supports.empty());
   Design loose = studio.window.session().design();
   loose.setup.supports.clear();
   studio.window.session().take({loose, "diatom", {}}, {});
   QVERIFY(studio.find());
   QVERIFY2(studio.message().startsWith("there is no static balance: "), qPrintable(studio.message()));
   QCOMPARE(studio.label("status.run"), QString("at rest"));
}

QTEST_MAIN(BalanceTest)
#include "balance_test.moc"
