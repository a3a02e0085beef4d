// `diatom lattices --json` against the table of lattices in the earlier program's fact sheet (1.1).
#include "cli/program.h"

#include <cmath>

using namespace diatom;

namespace {

const double kRoot2 = std::sqrt(2.0), kRoot3 = std::sqrt(3.0);

QJsonObject rowOf(const QString &name)
{
   static const QJsonDocument printed = test::diatomRuns({"lattices", "--json"}).json();
   for (const auto &row : printed.array())
      if (row.toObject()["id"].toString() == "org.diatom_cad.lattice." + name)
         return row.toObject();
   return {};
}

} // namespace

class LatticesCommandTest : public QObject
{
   Q_OBJECT
private slots:
   void rowsAgreeWithTheTable_data();
   void rowsAgreeWithTheTable();
   void aLatticeOfTwoShapesTellsBoth();
   void theListForPeopleHasARowForEach();
};

void LatticesCommandTest::rowsAgreeWithTheTable_data()
{
   QTest::addColumn<QList<int>>("counts"); // V E F; joined; touching by face, edge, vertex
   QTest::addColumn<double>("volume");
   QTest::addColumn<double>("packing");
   QTest::addColumn<QList<int>>("period"); // indices after which the sheet's rule of parity repeats
   const auto row = [](const char *name, QList<int> counts, double volume, double packing,
                       QList<int> period) { QTest::newRow(name) << counts << volume << packing << period; };
   row("cube", {8, 12, 6, 6, 6, 12, 8}, 1, 1, {1, 1, 1});
   row("gik", {8, 12, 6, 2, 6, 12, 8}, 1.28, 1, {1, 1, 2});
   row("octahedron_face", {6, 12, 8, 2, 2, 6, 12}, kRoot2 / 3, 2.0 / 3, {1, 2, 2});
   row("octahedron_edge_flat", {6, 12, 8, 12, 0, 12, 6}, kRoot2 / 3, 2.0 / 3, {1, 2, 3});
   row("octahedron_edge", {6, 12, 8, 12, 0, 12, 6}, kRoot2 / 3, 2.0 / 3, {1, 1, 2});
   row("octahedron_vertex", {6, 12, 8, 6, 0, 0, 6}, kRoot2 / 3, 1.0 / 6, {1, 1, 1});
   row("tetrahedron_stacked", {4, 6, 4, 14, 1, 0, 13}, kRoot2 / 12, 1.0 / 6, {1, 2, 4});
   row("tetrahedron_vertex", {4, 6, 4, 12, 0, 0, 12}, kRoot2 / 12, 1.0 / 6, {1, 2, 3});
   row("cuboctahedron", {12, 24, 14, 6, 6, 0, 12}, 5 * kRoot2 / 3, 5.0 / 6, {1, 1, 1});
   row("kelvin", {24, 36, 14, 6, 6, 0, 0}, 8 * kRoot2, 0.5, {1, 1, 1});
   row("honeycomb", {12, 18, 8, 8, 8, 12, 0}, 3 * kRoot3 / 2, 1, {1, 2, 1});
   row("honeycomb_rotated", {12, 18, 8, 8, 8, 12, 0}, 3 * kRoot3 / 2, 1, {1, 1, 2});
   row("kelvin_body_centred", {24, 36, 14, 14, 14, 0, 0}, 8 * kRoot2, 1, {1, 1, 2});
   // Unit edges: 16 / (3 sqrt 3).
   row("rhombic_dodecahedron", {14, 24, 12, 12, 12, 0, 6}, 16 / (3 * kRoot3), 1, {1, 1, 2});
   row("octet", {6, 12, 8, 8, 8, 12, 30}, kRoot2 / 3, 1, {1, 1, 6});
}

void LatticesCommandTest::rowsAgreeWithTheTable()
{
   QFETCH(QList<int>, counts);
   QFETCH(double, volume);
   QFETCH(double, packing);
   QFETCH(QList<int>, period);
   const QJsonObject row = rowOf(QTest::currentDataTag());
   QVERIFY(!row.isEmpty());
   const QJsonObject cell = row["cell"].toObject(), touching = row["neighbours"].toObject();
   const QList<int> found{cell["vertices"].toInt(),  cell["edges"].toInt(),    cell["faces"].toInt(),
                          row["joined"].toInt(),     touching["face"].toInt(), touching["edge"].toInt(),
                          touching["vertex"].toInt()};
   QCOMPARE(found, counts);
   // A hundred roundings and the decimal form.
   QVERIFY(std::abs(cell["volume"].toDouble() / volume - 1) < 1e-12);
   QVERIFY(std::abs(row["packing"].toDouble() - packing) < 1e-12);
   for (int k = 0; k < 3; ++k)
      QCOMPARE(row["period"].toArray()[k].toInt(), period[k]);
}

void LatticesCommandTest::aLatticeOfTwoShapesTellsBoth()
{
   const QJsonArray others = rowOf("octet")["others"].toArray();
   QCOMPARE(others.size(), 1);
   QCOMPARE(others[0].toObject()["cell"].toObject()["vertices"].toInt(), 4);
   QCOMPARE(others[0].toObject()["joined"].toInt(), 4);
   QVERIFY(!rowOf("cube").contains("others"));
}

void LatticesCommandTest::theListForPeopleHasARowForEach()
{
   const auto listed = test::diatomRuns({"lattices"});
   QCOMPARE(listed.exit, 0);
   for (const char *text : {"octahedron_vertex", "honeycomb_rotated", "6/12/8, 4/6/4"})
      QVERIFY2(listed.out.contains(text), listed.out.constData());
}

QTEST_APPLESS_MAIN(LatticesCommandTest)
#include "lattices_test.moc"
