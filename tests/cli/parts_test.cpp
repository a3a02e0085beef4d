// `diatom parts FILE`: what a design is made of, counted and weighed, against sums done by hand.
#include "cli/program.h"
#include "core/file.h"

#include <cmath>

using namespace diatom;

namespace {

/// A design of one material of 2000 kg/m3, with a pitch of 10 mm unless told.
QByteArray design(const char *lattice, const char *cells, const char *pitch = "0.01")
{
   return QString(R"({"diatom": 1, "name": "parts",
                      "lattice": {"id": "org.diatom_cad.lattice.%1", "pitch_m": %2},
                      "materials": [{"id": "a", "density_kg_m3": 2000}], "assembly": {"cells": %3}})")
       .arg(lattice, pitch, cells)
       .toUtf8();
}

QJsonObject wayOf(const QJsonArray &lists, const QString &name)
{
   for (const auto &list : lists)
      if (list.toObject()["id"].toString() == "org.diatom_cad.parts." + name)
         return list.toObject();
   return {};
}

} // namespace

class PartsCommandTest : public QObject
{
   Q_OBJECT
private slots:
   void everyWayToMakeADesignIsListed();
   void oneWayCanBePicked();
   void bricksAreCountedByLengthAndWeighed();
   void aWayThatDoesNotSuitIsSaidAndTheOthersListed();
   void partsThatAreMissingAreToldAndNotReplaced();
   void aLatticeWithoutPartsSaysSo();
};

// Two octahedra that share a corner: 2 wire frames, 2 voxels, 6 squares; 1 cross between them and a half
// cross on each of the 10 free corners.
void PartsCommandTest::everyWayToMakeADesignIsListed()
{
   const auto ran = test::diatomRuns({"parts", "-", "--json"},
                                     design("octahedron_vertex", R"([["a", [0, 0, 0], [2, 1, 1]]])"));
   QVERIFY2(ran.exit == 0, ran.err.constData());
   const QJsonArray lists = ran.json().array();
   QCOMPARE(lists.size(), 4);
   QCOMPARE(wayOf(lists, "octahedron_kenny")["parts"].toInt(), 2);
   QCOMPARE(wayOf(lists, "snap_voxel")["parts"].toInt(), 2);
   QCOMPARE(wayOf(lists, "octahedron_squares")["parts"].toInt(), 6);
   const QJsonArray rows = wayOf(lists, "octahedron_crosses")["rows"].toArray();
   QCOMPARE(rows.size(), 2);
   QCOMPARE(rows[0].toObject()["count"].toInt(), 1);
   QCOMPARE(rows[1].toObject()["count"].toInt(), 10);
}

void PartsCommandTest::oneWayCanBePicked()
{
   const auto ran =
       test::diatomRuns({"parts", "-", "--parts", "org.diatom_cad.parts.octahedron_squares", "--json"},
                        design("octahedron_vertex", R"([["a", [0, 0, 0]]])"));
   QVERIFY2(ran.exit == 0, ran.err.constData());
   QCOMPARE(ran.json().array().size(), 1);
   QCOMPARE(ran.json().array()[0].toObject()["parts"].toInt(), 3);
   QVERIFY(test::diatomRuns({"parts", "-", "--parts", "org.diatom_cad.parts.cube"},
                            design("octahedron_vertex", R"([["a", [0, 0, 0]]])"))
               .exit != 0);
}

void PartsCommandTest::bricksAreCountedByLengthAndWeighed()
{
   const char *cells = R"([{"run": [0, 0, 0], "step": [0, 1, 0], "length": 4, "material": "a"},
                           {"run": [1, 0, 0], "step": [0, 1, 0], "length": 4, "material": "a"},
                           {"run": [0, 0, 1], "step": [1, 0, 0], "length": 2, "material": "a"}])";
   const auto ran = test::diatomRuns({"parts", "-", "--parts", "org.diatom_cad.parts.gik", "--json"},
                                     design("gik", cells, "0.00127"));
   QVERIFY2(ran.exit == 0, ran.err.constData());
   const QJsonObject list = ran.json().array()[0].toObject();
   const QJsonArray rows = list["rows"].toArray();
   QCOMPARE(rows.size(), 2);
   // Plates of 0.254 mm, ((1.27 L - 0.127) 3.175 - 2 L 0.254 0.7744) mm2: for 2 cells 6.874527.. mm2, for 4
   // 14.152149.. mm2; times 2000 kg/m3.
   const double two = (2.413 * 3.175 - 4 * 0.254 * 0.7744) * 0.254 * 2e-6,
                four = (4.953 * 3.175 - 8 * 0.254 * 0.7744) * 0.254 * 2e-6;
   const double wanted[2][3] = {{2, 1, two}, {4, 2, four}};
   for (int k = 0; k < 2; ++k) {
      const QJsonObject row = rows[k].toObject();
      QCOMPARE(row["length"].toInt(), int(wanted[k][0]));
      QCOMPARE(row["material"].toString(), QString("a"));
      QCOMPARE(row["count"].toInt(), int(wanted[k][1]));
      // Sums of a few hundred terms and the decimal form.
      QVERIFY(std::abs(row["mass_each_kg"].toDouble() / wanted[k][2] - 1) < 1e-11);
   }
   QVERIFY(std::abs(list["mass_kg"].toDouble() / (two + 2 * four) - 1) < 1e-11);
}

void PartsCommandTest::aWayThatDoesNotSuitIsSaidAndTheOthersListed()
{
   // In the layer above the first, where electronic GIK's height tells; LEGO and DNA bricks do not fit.
   const auto ran = test::diatomRuns({"parts", "-"}, design("gik", R"([["a", [0, 0, 1]]])"));
   QVERIFY2(ran.exit == 0, ran.err.constData());
   QVERIFY2(ran.err.contains("1.17") && ran.err.contains("1.08"), ran.err.constData());
   QVERIFY2(ran.out.contains("parts.gik ") && ran.out.contains("all"), ran.out.constData());
   QVERIFY(!ran.out.contains("gik_lego"));
}

void PartsCommandTest::partsThatAreMissingAreToldAndNotReplaced()
{
   QByteArray text = design("gik", R"([["a", [0, 0, 0]]])");
   text.insert(text.lastIndexOf('}'), R"(, "parts": {"id": "org.nobody.parts.wonder", "values": {}})");
   const auto listed = test::diatomRuns({"parts", "-"}, text);
   QVERIFY2(listed.exit == 0, listed.err.constData());
   QVERIFY2(listed.err.contains("org.nobody.parts.wonder") && listed.err.contains("not installed"),
            listed.err.constData());
   const QTemporaryDir folder;
   const QString out = folder.filePath("out.stl");
   const auto exported = test::diatomRuns({"export", "-", out, "--as", "parts"}, text);
   QVERIFY(exported.exit != 0);
   QVERIFY2(exported.err.contains("org.nobody.parts.wonder"), exported.err.constData());
   QVERIFY(!QFile::exists(out));
   // Another way may be asked for by name.
   const auto asked = test::diatomRuns({"export", "-", out, "--as", "parts", "--parts", "gik"}, text);
   QVERIFY2(asked.exit == 0, asked.err.constData());
   QVERIFY(QFile::exists(out));
}

void PartsCommandTest::aLatticeWithoutPartsSaysSo()
{
   const auto ran = test::diatomRuns({"parts", "-"}, design("honeycomb", R"([["a", [0, 0, 0]]])"));
   QVERIFY(ran.exit != 0);
   QVERIFY2(ran.err.contains("honeycomb"), ran.err.constData());
}

QTEST_APPLESS_MAIN(PartsCommandTest)
#include "parts_test.moc"
