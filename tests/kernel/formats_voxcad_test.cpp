// VoxCAD's files in and out: cells, palette, sizes and what physics they carry; broken files do no harm.
#include "core/base64.h"
#include "formats/voxcad.h"
#include "support/scenes.h"

#include <random>

using namespace diatom;
using namespace diatom::test;

namespace {

const std::string kCube = "org.diatom_cad.lattice.cube";

/// As VoxCAD writes it: a 3 x 2 x 2 block, soft but for one stiff corner, on a floor, held at x = 0.
std::string bar(const std::string &packing = "ASCII_READABLE", const std::string &first = "122111",
                const std::string &second = "000100")
{
   return R"(<?xml version="1.0" encoding="ISO-8859-1"?>
<VXA Version="1.0">
<Simulator><Damping><BondDampingZ>0.25</BondDampingZ></Damping>
<StopCondition><StopConditionType>2</StopConditionType><StopConditionValue>1.5</StopConditionValue></StopCondition></Simulator>
<Environment><Fixed_Regions><NumFixed>1</NumFixed><FRegion><PrimType>0</PrimType><X>0</X><Y>0</Y><Z>0</Z><dX>0.01</dX>
<dY>1</dY><dZ>1</dZ><DOF_Fixed>7</DOF_Fixed></FRegion><FRegion><X>0</X><Y>0</Y><Z>0</Z><dX>0.34</dX><dY>1</dY><dZ>1</dZ>
<DOF_Fixed>63</DOF_Fixed></FRegion></Fixed_Regions>
<Gravity><GravEnabled>1</GravEnabled><GravAcc>-9.81</GravAcc><FloorEnabled>1</FloorEnabled></Gravity></Environment>
<VXC Version="0.94"><Lattice><Lattice_Dim>0.002</Lattice_Dim><X_Dim_Adj>1</X_Dim_Adj><Y_Dim_Adj>1</Y_Dim_Adj>
<Z_Dim_Adj>1.5</Z_Dim_Adj></Lattice><Voxel><Vox_Name>BOX</Vox_Name></Voxel>
<Palette><Material ID="1"><MatType>0</MatType><Name>Soft</Name><Display><Red>1</Red><Green>0</Green><Blue>0.2</Blue></Display>
<Mechanical><MatModel>0</MatModel><Elastic_Mod>5e6</Elastic_Mod><Density>1100</Density><Poissons_Ratio>0.4</Poissons_Ratio>
<CTE>0.01</CTE><uStatic>0.8</uStatic></Mechanical></Material>
<Material ID="2"><Name>Stiff</Name><Mechanical><Elastic_Mod>2e9</Elastic_Mod></Mechanical></Material></Palette>
<Structure Compression=")" +
          packing +
          R"("><X_Voxels>3</X_Voxels><Y_Voxels>2</Y_Voxels><Z_Voxels>2</Z_Voxels><Data><Layer><![CDATA[)" +
          first + "]]></Layer><Layer><![CDATA[" + second + R"(]]></Layer></Data></Structure></VXC></VXA>)";
}

Opened opened(const std::string &bytes)
{
   auto read = readDesign(bytes, "test.vxa", Job());
   if (!read)
      qFatal("%s", read.error().message.c_str());
   return *std::move(read);
}

} // namespace

class FormatsVoxcadTest : public QObject
{
   Q_OBJECT
private slots:
   void cellsMaterialsAndWorldAreRead();
   void packedLayersAreRead();
   void whatIsWrittenComesBack_data();
   void whatIsWrittenComesBack();
   void faultsAreNamedWithTheirPlace_data();
   void faultsAreNamedWithTheirPlace();
   void brokenFilesDoNoHarm();
   void base64IsThatOfTheStandard();
};

void FormatsVoxcadTest::cellsMaterialsAndWorldAreRead()
{
   const Opened read = opened(bar());
   QCOMPARE(read.format, std::string("vxa"));
   const Model &model = read.design.model;
   QCOMPARE(model.lattice.pitch, 0.002);
   QVERIFY(model.lattice.aspect == (std::array<double, 3>{1, 1, 1.5}));
   const MaterialIndex soft = model.material("material-1"), stiff = model.material("material-2");
   QCOMPARE(model.material(soft).name, std::string("Soft"));
   QCOMPARE(model.material(soft).youngsModulus, 5e6);
   QCOMPARE(model.material(soft).density, 1100.0);
   QCOMPARE(model.material(soft).poissonRatio, 0.4);
   QCOMPARE(model.material(soft).dampingRatio, 0.25);
   QVERIFY(model.material(soft).color == (std::array<std::uint8_t, 3>{255, 0, 51}));
   QCOMPARE(model.root.cells.count(), 7U);
   QCOMPARE(model.root.cells.at({0, 0, 0}).material, soft);
   QCOMPARE(model.root.cells.at({1, 0, 0}).material, stiff); // x runs first
   QCOMPARE(model.root.cells.at({2, 0, 0}).material, stiff);
   QCOMPARE(model.root.cells.at({0, 1, 1}).material, soft);
   const Setup &setup = read.design.setup;
   QCOMPARE(setup.gravity[2], -9.81);
   QVERIFY(setup.ground.present);
   QCOMPARE(setup.ground.friction, 0.8);
   QCOMPARE(setup.ground.height, -0.0015);
   QCOMPARE(setup.until, 1.5);
   QCOMPARE(setup.supports.size(), std::size_t(1)); // the thin region holds no centre
   QVERIFY(setup.supports[0].where == Where(Box{{0, 0, 0}, {0, 1, 1}}));
   QCOMPARE(setup.supports[0].fixed, kAllFreedoms);
   QVERIFY(std::any_of(read.notes.begin(), read.notes.end(),
                       [](const std::string &note) { return note.find("CTE") != std::string::npos; }));
}

void FormatsVoxcadTest::packedLayersAreRead()
{
   const std::string first{1, 2, 2, 1, 1, 1}, second{0, 0, 0, 1, 0, 0};
   QVERIFY(opened(bar("BASE64", toBase64(first), toBase64(second))).design.model.root.cells ==
           opened(bar()).design.model.root.cells);
   // zlib's own output for these two layers, made with Python's zlib.
   QVERIFY(opened(bar("ZLIB", "eJxjZGJiZGQEAAAkAAk=", "eJxjYGBgZGAAAAAJAAI=")).design.model.root.cells ==
           opened(bar()).design.model.root.cells);
}

void FormatsVoxcadTest::whatIsWrittenComesBack_data()
{
   QTest::addColumn<bool>("world");
   QTest::newRow("vxc") << false;
   QTest::newRow("vxa") << true;
}

void FormatsVoxcadTest::whatIsWrittenComesBack()
{
   QFETCH(bool, world);
   Scene scene(kCube, 3e-3);
   unsigned n = 0;
   for (const Index i : blob(*scene.lattice, 500, 9))
      scene.model.root.cells.set(i, {static_cast<MaterialIndex>(1 + n++ % 3), 0, 0});
   const Index low = scene.model.root.cells.bounds().min;
   Design design;
   design.model = scene.model;
   design.setup.gravity = {0, 0, -1.62};
   design.setup.supports = {{Box{low, low + Index{0, 3, 2}}, 0x0f}};
   std::vector<std::string> notes;
   const auto bytes = writeVoxcad(design, scene.hierarchy(), world, notes, Job());
   DIATOM_VERIFY_OK(bytes);
   const Opened read = opened(*bytes);
   QCOMPARE(read.format, std::string(world ? "vxa" : "vxc"));
   QCOMPARE(read.design.model.lattice.pitch, 3e-3);
   QCOMPARE(read.design.model.root.cells.count(), 500U);
   QVERIFY(scene.model.root.cells.visit([&](Index i, Cell cell) {
      const Cell there = read.design.model.root.cells.at(i - low);
      return !there.empty() &&
             read.design.model.material(there.material).name == scene.model.material(cell.material).name;
   }));
   QCOMPARE(read.design.setup.gravity[2], world ? -1.62 : 0);
   QCOMPARE(read.design.setup.supports.size(), std::size_t(world ? 1 : 0));
   if (world) {
      QVERIFY(read.design.setup.supports[0].where == Where(Box{{0, 0, 0}, {0, 3, 2}}));
      QCOMPARE(read.design.setup.supports[0].fixed, std::uint8_t(0x0f));
   } else {
      QVERIFY(std::any_of(notes.begin(), notes.end(), [](const std::string &note) {
         return note.find("supports") != std::string::npos;
      }));
   }
}

void FormatsVoxcadTest::faultsAreNamedWithTheirPlace_data()
{
   QTest::addColumn<QString>("from");
   QTest::addColumn<QString>("to");
   QTest::addColumn<QString>("says");
   QTest::newRow("short layer") << "122111"
                                << "12211"
                                << "layer 1 does not hold 6 voxels";
   QTest::newRow("unknown material") << "122111"
                                     << "132111"
                                     << "material 3";
   QTest::newRow("missing layer") << "<Layer><![CDATA[000100]]></Layer>"
                                  << ""
                                  << "1 layers, but 2";
   QTest::newRow("no number") << "<Lattice_Dim>0.002"
                              << "<Lattice_Dim>nan"
                              << "Lattice_Dim";
   QTest::newRow("negative") << "<Elastic_Mod>5e6"
                             << "<Elastic_Mod>-1"
                             << "Elastic_Mod";
   QTest::newRow("packing") << "ASCII_READABLE"
                            << "RAR"
                            << "RAR";
   QTest::newRow("too many") << "<X_Voxels>3"
                             << "<X_Voxels>3000000"
                             << "X_Voxels";
   QTest::newRow("shifted rows") << "</Lattice>"
                                 << "<X_Line_Offset>0.5</X_Line_Offset></Lattice>"
                                 << "shifted";
   QTest::newRow("cut off") << "</VXA>"
                            << "</V"
                            << "no XML";
}

void FormatsVoxcadTest::faultsAreNamedWithTheirPlace()
{
   QFETCH(QString, from);
   QFETCH(QString, to);
   QFETCH(QString, says);
   QString text = QString::fromStdString(bar());
   QVERIFY(text.contains(from));
   const auto read = readDesign(text.replace(from, to).toStdString(), "bad.vxa", Job());
   QVERIFY(!read);
   const QString message = QString::fromStdString(read.error().message);
   QVERIFY2(message.startsWith("bad.vxa: byte ") && message.contains(says), qPrintable(message));
}

void FormatsVoxcadTest::brokenFilesDoNoHarm()
{
   const std::string whole = bar();
   std::mt19937 random(2);
   int refused = 0;
   for (int n = 0; n < 5'000; ++n) {
      std::string broken = whole;
      for (int k = 0; k < 3; ++k)
         broken[random() % broken.size()] = static_cast<char>(random());
      const auto read = readDesign(broken, "broken.vxa", Job());
      refused += read.ok() ? 0 : 1;
   }
   QVERIFY(refused > 1000); // most of the text is structure
}

/// The vectors of RFC 4648, section 10.
void FormatsVoxcadTest::base64IsThatOfTheStandard()
{
   const std::pair<const char *, const char *> vectors[] = {{"", ""},
                                                            {"f", "Zg=="},
                                                            {"fo", "Zm8="},
                                                            {"foo", "Zm9v"},
                                                            {"foob", "Zm9vYg=="},
                                                            {"fooba", "Zm9vYmE="},
                                                            {"foobar", "Zm9vYmFy"}};
   for (const auto &[bytes, text] : vectors) {
      QCOMPARE(toBase64(bytes), std::string(text));
      QCOMPARE(fromBase64(text).value(), std::string(bytes));
   }
   for (const char *bad : {"Zg=", "Z===", "Zg==Zg==", "Z!==", "Zm9"})
      QVERIFY(!fromBase64(bad));
}

QTEST_APPLESS_MAIN(FormatsVoxcadTest)
#include "formats_voxcad_test.moc"
