// What an author of plugins does with nothing but the installed program and SDK: makes a project of each kind
// in a foreign folder, builds it, runs its tests, installs it for the user, and uses it.
#include "cli/program.h"
#include "core/file.h"

#include <QDir>
#include <QStandardPaths>

#include <cmath>
#include <map>
#include <vector>

using namespace diatom;
using test::Outcome;

namespace {

struct Project
{
   const char *kind, *name, *compiler; // C or C++
   QStringList more;
};

const std::vector<Project> kProjects{{"lattice", "my-lattice", "CXX", {}},
                                     {"lattice", "plain_c", "C", {"--language", "c"}},
                                     {"parts", "my-bricks", "CXX", {}},
                                     {"machine", "my-arm", "CXX", {}},
                                     {"solver", "my-heat", "CXX", {}}};

/// Fails with what the program said when it did not end with 0.
#define DIATOM_VERIFY_RAN(outcome)                                                                           \
   do {                                                                                                      \
      const Outcome ran = (outcome);                                                                         \
      QVERIFY2(ran.exit == 0, (ran.out.right(3000) + ran.err.right(3000)).constData());                      \
   } while (false)

QByteArray textOf(const QString &file)
{
   QFile opened(file);
   return opened.open(QIODevice::ReadOnly) ? opened.readAll() : QByteArray();
}

void put(const QString &file, const QByteArray &text)
{
   QFile opened(file);
   if (!opened.open(QIODevice::WriteOnly) || opened.write(text) != text.size())
      qFatal("cannot write %s", qPrintable(file));
}

/// A word and its number in a line of a program, like the R of "G0 R120.5 C3".
double wordOf(const QByteArray &line, char letter, double otherwise)
{
   for (const QByteArray &word : line.split(' '))
      if (word.startsWith(letter))
         return word.mid(1).toDouble();
   return otherwise;
}

} // namespace

class PluginNewTest : public QObject
{
   Q_OBJECT
private slots:
   void initTestCase();
   void aProjectBuildsAndPassesItsTests_data();
   void aProjectBuildsAndPassesItsTests();
   void theSecondCompilerBuildsThemAll();
   void theUsersFolderHasThem();
   void theLatticesFillAndExport();
   void theBricksCoverEveryCell();
   void theArmReachesWhereThePartsGo();
   void theSolverFindsTheLineOfABar();
   void heatIsRefusedByWhoDoesNotKnowIt();
   void relaxedArithmeticIsRefused();
   void badWishesAreRefused_data();
   void badWishesAreRefused();

private:
   QString path(const char *relative) const { return m_dir.filePath(QString::fromUtf8(relative)); }
   QString project(const Project &p) const { return path("work/") + QString::fromUtf8(p.name); }
   test::Printed diatom(const QStringList &arguments) const
   {
      return {test::run(path("prefix/bin/diatom"), QStringList{"--progress", "none"} + arguments)};
   }

   QTemporaryDir m_dir;
};

void PluginNewTest::initTestCase()
{
   if (!kMayFork)
      QSKIP("this build's sanitizer bears no other processes, in which plugins are checked");
   const QString build = QString::fromStdString(test::binaryDir().string());
   for (const char *component : {"diatom", "sdk"})
      DIATOM_VERIFY_RAN(
          test::run("cmake", {"--install", build, "--prefix", path("prefix"), "--component", component}));
   QVERIFY(QDir().mkpath(path("work")) && QDir().mkpath(path("data")));
   // From here on as on a machine that never saw the source tree.
   for (const char *name : {"DIATOM_PLUGIN_PATH", "DIATOM_SOURCE_DIR", "CMAKE_PREFIX_PATH", "CFLAGS",
                            "CXXFLAGS", "CC", "CXX", "LDFLAGS"})
      qunsetenv(name);
   qputenv("XDG_DATA_HOME", path("data").toUtf8());
   qputenv("XDG_CONFIG_HOME", path("config").toUtf8());
   qputenv("XDG_CACHE_HOME", path("cache").toUtf8());
   qputenv("PATH", path("prefix/bin").toUtf8() + ":" + qgetenv("PATH")); // where find_package() looks as well
}

void PluginNewTest::aProjectBuildsAndPassesItsTests_data()
{
   QTest::addColumn<int>("number");
   for (std::size_t i = 0; i < kProjects.size(); ++i)
      QTest::newRow(kProjects[i].name) << static_cast<int>(i);
}

void PluginNewTest::aProjectBuildsAndPassesItsTests()
{
   QFETCH(int, number);
   const Project &p = kProjects[static_cast<std::size_t>(number)];
   const QString folder = project(p), build = folder + "/build";
   const auto made =
       diatom(QStringList{"plugin", "new", p.kind, p.name, "--dir", path("work"), "--json"} + p.more);
   QVERIFY2(made.exit == 0, made.err.constData());
   QCOMPARE(made.object()["id"].toString(), QString("org.example.%1.%2").arg(p.kind, p.name));
   QVERIFY2(made.err.contains("cmake --install build"), made.err.constData());
   DIATOM_VERIFY_RAN(test::run(
       "cmake",
       {"-S", folder, "-B", build,
        QString("-DCMAKE_%1_COMPILER=%2").arg(p.compiler, QByteArray(p.compiler) == "C" ? "gcc" : "g++")}));
   DIATOM_VERIFY_RAN(test::run("cmake", {"--build", build, "-j", "2"}));
   const QByteArray cache = textOf(build + "/CMakeCache.txt");
   QVERIFY(cache.contains("DiatomSdk_DIR:PATH=" + path("prefix").toUtf8()));
   QVERIFY(!cache.contains(qgetenv("DIATOM_BINARY_DIR")));
   const Outcome tests = test::run("ctest", {"--test-dir", build, "--output-on-failure", "--no-tests=error"});
   QVERIFY2(tests.exit == 0, tests.out.constData());
   DIATOM_VERIFY_RAN(test::run("cmake", {"--install", build}));
   DIATOM_VERIFY_RAN(
       test::run(path("prefix/bin/diatom"), {"plugins", "trust", made.object()["id"].toString()}));
}

void PluginNewTest::theSecondCompilerBuildsThemAll()
{
   if (QStandardPaths::findExecutable("clang++").isEmpty())
      QSKIP("clang++ is not installed");
   QByteArray all = "cmake_minimum_required(VERSION 3.25)\nproject(all LANGUAGES C CXX)\nenable_testing()\n";
   for (const Project &p : kProjects)
      all += "add_subdirectory(../" + QByteArray(p.name) + " " + p.name + ")\n";
   QVERIFY(QDir().mkpath(path("work/all")));
   put(path("work/all/CMakeLists.txt"), all);
   const QString build = path("work/all/build");
   DIATOM_VERIFY_RAN(
       test::run("cmake", {"-S", path("work/all"), "-B", build, "-DCMAKE_CXX_COMPILER=clang++",
                           "-DCMAKE_C_COMPILER=clang", "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror",
                           "-DCMAKE_C_FLAGS=-Wall -Wextra -Werror"}));
   DIATOM_VERIFY_RAN(test::run("cmake", {"--build", build, "-j", "2"}));
   const Outcome tests = test::run("ctest", {"--test-dir", build, "--output-on-failure", "--no-tests=error"});
   QVERIFY2(tests.exit == 0, tests.out.constData());
}

void PluginNewTest::theUsersFolderHasThem()
{
   std::map<QString, QString> folders;
   for (const auto &row : diatom({"plugins", "--json"}).json().array())
      if (row.toObject()["verdict"].toString() == "ok")
         folders[row.toObject()["id"].toString()] = row.toObject()["folder"].toString();
   for (const Project &p : kProjects) {
      const QString id = QString("org.example.%1.%2").arg(p.kind, p.name);
      const QString kind = QByteArray(p.kind) == "parts" ? "parts" : QString(p.kind) + "s";
      QCOMPARE(folders[id], path("data/diatom/plugins/1/") + kind + "/" + p.name);
   }
   // Those of ours come from beside the program.
   QCOMPARE(folders["org.diatom_cad.lattice.cube"], path("prefix/lib/diatom/plugins/1/lattices/cube"));
}

void PluginNewTest::theLatticesFillAndExport()
{
   struct Block
   {
      QString name;
      double cellVolume; // in cubes of the edge
      qint64 triangles;  // of the surface of 4 x 4 x 4 cells
   };
   // Elongated dodecahedra: a layer has 24 inner hexagons and 49 rhombi to the next, so that 64 * 4 - 2 * 4 *
   // 24 hexagons of four triangles and 64 * 8 - 2 * 3 * 49 rhombi of two are left. Prisms: a layer has 12
   // inner walls within rows and 6 between them, so that 4 * (16 * 3 - 2 * 18) walls of two triangles and 2 *
   // 16 ends are left.
   const std::vector<Block> blocks{{"my-lattice", 8.0 / 3 * (2 / std::sqrt(3.0) + 1), 64 * 4 + 218 * 2},
                                   {"plain_c", std::sqrt(3.0) / 4, 48 * 2 + 32}};
   for (const auto &[name, volume, triangles] : blocks) {
      const QString design = path("work/") + name + "/tests/block.diatom", mesh = path("work/block.stl");
      const QJsonObject info = diatom({"info", design, "--json"}).object();
      QCOMPARE(info["cells"].toInt(), 64);
      // 1000 kg/m3 of cells 1 mm to the edge; rounding of some products.
      const double mass = 64 * volume * 1e-9 * 1000;
      QVERIFY(std::abs(info["mass_kg"].toDouble() - mass) < 1e-12 * mass);
      DIATOM_VERIFY_RAN(diatom({"export", design, mesh}));
      const QByteArray stl = textOf(mesh);
      QCOMPARE((stl.size() - 84) / 50, triangles);
   }
}

void PluginNewTest::theBricksCoverEveryCell()
{
   const QString design = path("work/big.diatom");
   put(design,
       R"({"diatom": 1, "lattice": {"id": "org.diatom_cad.lattice.cube"}, "materials": [{"id": "a"}, {"id": "b"}],
      "assembly": {"cells": [["a", [0, 0, 0], [23, 17, 5]], ["b", [23, 3, 0], [2, 5, 4]], ["a", [-5, -9, 2]]]}})");
   // The host refuses a cell that is covered twice or not at all.
   const auto listed = diatom({"parts", design, "--parts", "org.example.parts.my-bricks", "--json"});
   QVERIFY2(listed.exit == 0, listed.err.constData());
   const QJsonObject list = listed.json().array().first().toObject();
   QCOMPARE(list["cells_left"].toInt(), 0);
   int cells = 0, parts = 0;
   for (const auto &row : list["rows"].toArray()) {
      const QStringList size = row.toObject()["type"].toString().mid(6).split('x');
      cells += row.toObject()["count"].toInt() * size[0].toInt() * size[1].toInt();
      parts += row.toObject()["count"].toInt();
   }
   QCOMPARE(cells, 23 * 17 * 5 + 2 * 5 * 4 + 1);
   // At most eight cells to a brick; greedy packing of these blocks stays within a half more than that.
   QVERIFY(parts >= cells / 8 && parts <= cells / 8 * 3 / 2);
   QCOMPARE(
       listed.out,
       diatom({"--threads", "1", "parts", design, "--parts", "org.example.parts.my-bricks", "--json"}).out);
}

void PluginNewTest::theArmReachesWhereThePartsGo()
{
   const auto program =
       diatom({"plan", project(kProjects[3]) + "/tests/three.diatom", "--machine", "my-arm", "-o", "-"});
   QVERIFY2(program.exit == 0, program.err.constData());
   // Forward kinematics at each opening of the gripper: cells of 10 mm, the assembly's corner at (150, -50,
   // 0) mm.
   const double expected[3][3] = {{155, -45, 0}, {165, -45, 0}, {155, -45, 10}};
   double r = 0, z = 0, c = 0, a = 0;
   int placed = -1; // the heading opens the gripper as well
   for (const QByteArray &line : program.out.split('\n')) {
      r = wordOf(line, 'R', r);
      z = wordOf(line, 'Z', z);
      c = wordOf(line, 'C', c);
      a = wordOf(line, 'A', a);
      if (line != "M65 P0" || ++placed == 0)
         continue;
      QVERIFY(placed <= 3);
      const double *at = expected[placed - 1], turn = c * std::acos(-1.0) / 180;
      // Programs have 1e-3 mm and 1e-4 degrees, at a reach of 170 mm: half of each, together less than 1.5e-3
      // mm.
      QVERIFY(std::abs(r * std::cos(turn) - at[0]) < 1.5e-3 && std::abs(r * std::sin(turn) - at[1]) < 1.5e-3);
      QCOMPARE(z, at[2]);
      QCOMPARE(a, -c); // the part keeps its direction
   }
   QCOMPARE(placed, 3);
   const auto refused =
       diatom({"plan", project(kProjects[3]) + "/tests/three.diatom", "--machine", "my-arm", "--set",
               "origin_x=0.001", "--set", "origin_y=0.001", "-o", path("work/no.ngc")});
   QVERIFY(refused.exit != 0);
   QVERIFY2(refused.err.contains("from the column, which reaches from 80.0 to 400.0 mm"),
            refused.err.constData());
}

void PluginNewTest::theSolverFindsTheLineOfABar()
{
   const QString bar = project(kProjects[4]) + "/tests/bar.diatom", links = path("work/links.csv"),
                 state = path("work/state.csv");
   const auto solved = diatom({"solve", bar, "--json", "--tolerance", "1e-12", "--probe", "3,0,0:temperature",
                               "--links", links, "--state", state});
   QVERIFY2(solved.exit == 0, solved.err.constData());
   // From 400 K to 300 K over ten equal links; 1e-12 of the heat in a link is 1e-11 K in each of ten at most.
   QVERIFY(std::abs(solved.object()["probes"].toObject()["3,0,0:temperature"].toDouble() - 370) < 1e-9);
   const auto lines = textOf(links).trimmed().split('\n');
   QCOMPARE(lines.size(), 11);
   QCOMPARE(lines[0], QByteArray("i,j,k,to i,to j,to k,link_heat (W)"));
   for (int n = 1; n <= 10; ++n) {
      QVERIFY(lines[n].startsWith(QByteArray::number(n - 1) + ",0,0," + QByteArray::number(n) + ",0,0,"));
      // 10 K times 0.5 W/(m K) times (1 mm)2 over 1 mm.
      QVERIFY(std::abs(lines[n].split(',').last().toDouble() - 5e-3) < 1e-12);
   }
   QVERIFY(textOf(state).startsWith("i,j,k,material,temperature (K),supplied (W)\n"));
   const auto unknown = diatom({"solve", bar, "--probe", "3,0,0:strain"});
   QVERIFY(unknown.exit != 0);
   QVERIFY2(unknown.err.contains("strain"), unknown.err.constData());
}

void PluginNewTest::heatIsRefusedByWhoDoesNotKnowIt()
{
   const QString bar = project(kProjects[4]) + "/tests/bar.diatom";
   const auto refused = diatom({"simulate", bar, "--solver", "bonds", "--until", "1e-6"});
   QVERIFY(refused.exit != 0);
   QVERIFY2(refused.err.contains("the scene calls for 'temperature'") &&
                refused.err.contains("--effects -temperature"),
            refused.err.constData());
   DIATOM_VERIFY_RAN(
       diatom({"simulate", bar, "--solver", "bonds", "--until", "1e-6", "--effects", "-temperature"}));
}

void PluginNewTest::relaxedArithmeticIsRefused()
{
   for (const char *flags : {"-DCMAKE_CXX_FLAGS=-ffast-math", "-DCMAKE_CXX_FLAGS_RELEASE=-Ofast"}) {
      const auto refused = test::run("cmake", {"-S", project(kProjects[0]), "-B", path("work/fast"), flags,
                                               "-DCMAKE_BUILD_TYPE=Release"});
      QVERIFY(refused.exit != 0);
      QVERIFY2(refused.err.simplified().contains("would change the results of Diatom itself"),
               refused.err.constData());
   }
}

void PluginNewTest::badWishesAreRefused_data()
{
   QTest::addColumn<QStringList>("words");
   QTest::addColumn<QString>("sentence");
   QTest::newRow("kind") << QStringList{"shape", "a"} << "shape";
   QTest::newRow("upper case") << QStringList{"lattice", "Mine"} << "lower-case letter";
   QTest::newRow("path") << QStringList{"lattice", "../mine"} << "lower-case letter";
   QTest::newRow("target") << QStringList{"lattice", "test"} << "means something to CMake";
   QTest::newRow("language") << QStringList{"solver", "fast", "--language", "c"} << "only for a lattice";
   QTest::newRow("id") << QStringList{"solver", "fast", "--id", "fast"} << "org.example";
   QTest::newRow("existing") << QStringList{"lattice", "my-lattice"}
                             << "is there already; choose another name";
}

void PluginNewTest::badWishesAreRefused()
{
   QFETCH(QStringList, words);
   QFETCH(QString, sentence);
   const auto entries = [&] { return QDir(path("work")).entryList(); };
   const QStringList before = entries();
   const auto refused = diatom(QStringList{"plugin", "new"} + words + QStringList{"--dir", path("work")});
   QVERIFY(refused.exit != 0);
   QVERIFY2(refused.err.contains(sentence.toUtf8()), refused.err.constData());
   QCOMPARE(entries(), before);
}

QTEST_APPLESS_MAIN(PluginNewTest)
#include "plugin_new_test.moc"
