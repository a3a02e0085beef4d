// MagicaVoxel's files in and out: cells, colours and poses survive; broken files do no harm.
#include "formats/vox.h"
#include "formats/vox_format.h"
#include "support/scenes.h"

#include <random>

using namespace diatom;
using namespace diatom::test;

namespace {

const std::string kCube = "org.diatom_cad.lattice.cube";

/// The design of a scene, as bytes of a .vox file.
std::string voxOf(const Scene &scene)
{
   Design design;
   design.model = scene.model;
   std::vector<std::string> notes;
   auto bytes = writeVox(design, scene.hierarchy(), notes, Job());
   if (!bytes)
      qFatal("%s", bytes.error().message.c_str());
   return *std::move(bytes);
}

Opened opened(const std::string &bytes)
{
   auto read = readDesign(bytes, "test.vox", Job());
   if (!read)
      qFatal("%s", read.error().message.c_str());
   return *std::move(read);
}

void put(std::string &to, std::initializer_list<std::int32_t> values)
{
   for (const std::int32_t value : values)
      for (int k = 0; k < 4; ++k)
         to += static_cast<char>(static_cast<std::uint32_t>(value) >> (8 * k));
}

void putText(std::string &to, const std::string &text)
{
   put(to, {static_cast<std::int32_t>(text.size())});
   to += text;
}

std::string chunk(const std::string &id, const std::string &content)
{
   std::string bytes = id;
   put(bytes, {static_cast<std::int32_t>(content.size()), 0});
   return bytes + content;
}

std::string fileOf(const std::string &chunks)
{
   std::string bytes = "VOX ";
   put(bytes, {150});
   bytes += "MAIN";
   put(bytes, {0, static_cast<std::int32_t>(chunks.size())});
   return bytes + chunks;
}

/// A bar of 3 x 2 x 1 cells with one of another colour at its origin.
std::string bar()
{
   std::string size, cells;
   put(size, {3, 2, 1});
   put(cells, {6});
   for (int x = 0; x < 3; ++x)
      for (int y = 0; y < 2; ++y)
         cells += {static_cast<char>(x), static_cast<char>(y), 0, static_cast<char>(x + y == 0 ? 7 : 200)};
   return chunk("SIZE", size) + chunk("XYZI", cells);
}

std::string transformation(std::int32_t node, std::int32_t child,
                           std::initializer_list<std::pair<std::string, std::string>> frame)
{
   std::string content;
   put(content, {node, 0, child, -1, -1, 1, static_cast<std::int32_t>(frame.size())});
   for (const auto &[key, value] : frame) {
      putText(content, key);
      putText(content, value);
   }
   return chunk("nTRN", content);
}

std::string shape(std::int32_t node, std::int32_t model)
{
   std::string content;
   put(content, {node, 0, 1, model, 0});
   return chunk("nSHP", content);
}

} // namespace

class FormatsVoxTest : public QObject
{
   Q_OBJECT
private slots:
   void cellsAndColoursComeBack();
   void modelsAreSplitAt256();
   void numbersOfColoursAreKept();
   void compositesAreWrittenAsTheirCells();
   void modelsAreTurnedAndShifted();
   void filesWithoutAPaletteHaveTheUsualColours();
   void otherLatticesAreRefused();
   void brokenFilesAreRefused();
};

void FormatsVoxTest::cellsAndColoursComeBack()
{
   Scene scene(kCube);
   unsigned n = 0;
   for (const Index i : blob(*scene.lattice, 700, 5, {-20, 3, 1000}))
      scene.model.root.cells.set(i, {static_cast<MaterialIndex>(1 + n++ % 3), 0, 0});
   const Opened read = opened(voxOf(scene));
   QCOMPARE(read.format, std::string("vox"));
   QCOMPARE(read.design.model.root.cells.count(), 700U);
   QVERIFY(scene.model.root.cells.visit([&](Index i, Cell cell) {
      const Cell there = read.design.model.root.cells.at(i);
      return !there.empty() &&
             read.design.model.material(there.material).color == scene.model.material(cell.material).color;
   }));
}

void FormatsVoxTest::modelsAreSplitAt256()
{
   Scene scene(kCube);
   scene.model.root.cells.fill({{-300, -1, 0}, {299, 1, 2}}, {1, 0, 0});
   const std::string bytes = voxOf(scene);
   std::size_t models = 0;
   for (auto at = bytes.find("SIZE"); at != std::string::npos; at = bytes.find("SIZE", at + 1))
      ++models;
   QCOMPARE(models, std::size_t(8)); // cut at x = -256, 0 and 256, and at y = 0
   const CellArray cells = opened(bytes).design.model.root.cells;
   QCOMPARE(cells.count(), 600U * 3 * 3);
   QVERIFY(cells.bounds() == (Box{{-300, -1, 0}, {299, 1, 2}}));
}

void FormatsVoxTest::numbersOfColoursAreKept()
{
   const Opened first = opened(fileOf(bar()));
   QCOMPARE(first.design.model.root.cells.at({0, 0, 0}).material, first.design.model.material("color-7"));
   QCOMPARE(first.design.model.root.cells.at({2, 1, 0}).material, first.design.model.material("color-200"));
   Scene scene(kCube);
   scene.model = first.design.model;
   const Opened second = opened(voxOf(scene));
   QCOMPARE(second.design.model.root.cells.at({0, 0, 0}).material, second.design.model.material("color-7"));
   QVERIFY(second.design.model.material("color-200") != 0);
}

void FormatsVoxTest::compositesAreWrittenAsTheirCells()
{
   Scene scene(kCube);
   Definition definition;
   definition.id = "pair";
   definition.body.cells.set({0, 0, 0}, {1, 0, 0});
   definition.body.cells.set({1, 0, 0}, {2, 0, 0});
   const auto id = scene.model.setDefinition(definition);
   DIATOM_VERIFY_OK(id);
   for (int k = 0; k < 5; ++k) {
      Placement placement;
      placement.definition = *id;
      placement.origin = {0, 3 * k, 0};
      scene.model.root.instances.insert(placement);
   }
   const CellArray cells = opened(voxOf(scene)).design.model.root.cells;
   QCOMPARE(cells.count(), 10U);
   QVERIFY(!cells.at({1, 12, 0}).empty());
}

/// By hand: a quarter turn about z takes x to y and y to -x; the model's middle (1, 1, 0) goes to the shift.
void FormatsVoxTest::modelsAreTurnedAndShifted()
{
   // Row 0 is (0, -1, 0): column 1, negative; row 1 is (1, 0, 0): column 0.
   const int quarter = 1 | (0 << 2) | (1 << 4);
   std::string group;
   put(group, {1, 0, 2, 2, 4});
   const std::string bytes =
       fileOf(bar() + transformation(0, 1, {{"_t", "100 0 0"}}) + chunk("nGRP", group) +
              transformation(2, 3, {{"_t", "0 10 5"}}) + shape(3, 0) +
              transformation(4, 5, {{"_t", "0 -10 0"}, {"_r", std::to_string(quarter)}}) + shape(5, 0));
   const Opened read = opened(bytes);
   const CellArray &cells = read.design.model.root.cells;
   QCOMPARE(cells.count(), 12U);
   const MaterialIndex seven = read.design.model.material("color-7");
   // Shifted alone: cell (0,0,0) lies at (-1,-1,0) from the middle.
   QCOMPARE(cells.at({99, 9, 5}).material, seven);
   QVERIFY(!cells.at({101, 10, 5}).empty());
   // Turned: cell (0,0,0), from (-1,-1) to (0,0) about the middle, becomes (0,-1) to (1,0).
   QCOMPARE(cells.at({100, -11, 0}).material, seven);
   // Cell (2,1,0), from (1,0) to (2,1), becomes (-1,1) to (0,2).
   QVERIFY(!cells.at({99, -9, 0}).empty());
   std::string hidden;
   put(hidden, {0, 1});
   putText(hidden, "_hidden");
   putText(hidden, "1");
   put(hidden, {1, -1, -1, 1, 0});
   const Opened none = opened(fileOf(bar() + chunk("nTRN", hidden) + shape(1, 0)));
   QCOMPARE(none.design.model.root.cells.count(), 0U);
   QVERIFY(std::any_of(none.notes.begin(), none.notes.end(),
                       [](const std::string &note) { return note.find("hidden") != std::string::npos; }));
}

/// The program's own list: number 1 is white, 7 the second of the second row of blues, 255 the darkest grey.
void FormatsVoxTest::filesWithoutAPaletteHaveTheUsualColours()
{
   const vox::Palette palette = vox::defaultPalette();
   QVERIFY(palette[1] == (std::array<std::uint8_t, 3>{0xff, 0xff, 0xff}));
   QVERIFY(palette[2] == (std::array<std::uint8_t, 3>{0xff, 0xff, 0xcc}));
   QVERIFY(palette[7] == (std::array<std::uint8_t, 3>{0xff, 0xcc, 0xff}));
   QVERIFY(palette[215] == (std::array<std::uint8_t, 3>{0x00, 0x00, 0x33}));
   QVERIFY(palette[216] == (std::array<std::uint8_t, 3>{0xee, 0x00, 0x00}));
   QVERIFY(palette[236] == (std::array<std::uint8_t, 3>{0x00, 0x00, 0xee}));
   QVERIFY(palette[255] == (std::array<std::uint8_t, 3>{0x11, 0x11, 0x11}));
}

void FormatsVoxTest::otherLatticesAreRefused()
{
   Scene scene("org.diatom_cad.lattice.kelvin");
   scene.model.root.cells.set({0, 0, 0}, {1, 0, 0});
   Design design;
   design.model = scene.model;
   std::vector<std::string> notes;
   const auto bytes = writeVox(design, scene.hierarchy(), notes, Job());
   QVERIFY(!bytes);
   QCOMPARE(bytes.error().code, ErrorCode::unsupported);
}

void FormatsVoxTest::brokenFilesAreRefused()
{
   const std::string whole = fileOf(bar() + transformation(0, 1, {{"_t", "100 0 0"}}) + shape(1, 0));
   const std::size_t all = opened(whole).design.model.root.cells.count();
   QCOMPARE(all, std::size_t(6));
   for (std::size_t length = 4; length < whole.size(); ++length) {
      const auto read = readDesign(whole.substr(0, length), "cut.vox", Job());
      if (!read)
         QVERIFY2(read.error().message.starts_with("cut.vox: "), read.error().message.c_str());
   }
   std::mt19937 random(11);
   for (int n = 0; n < 20'000; ++n) {
      std::string broken = whole;
      for (int k = 0; k < 3; ++k)
         broken[8 + random() % (broken.size() - 8)] = static_cast<char>(random());
      const auto read = readDesign(broken, "broken.vox", Job());
      if (!read)
         QVERIFY(read.error().code == ErrorCode::unreadable || read.error().code == ErrorCode::cancelled);
   }
   // A scene that contains itself.
   std::string group;
   put(group, {1, 0, 2, 0, 0});
   const auto endless =
       readDesign(fileOf(bar() + transformation(0, 1, {}) + chunk("nGRP", group)), "endless.vox", Job());
   QVERIFY(!endless);
}

QTEST_APPLESS_MAIN(FormatsVoxTest)
#include "formats_vox_test.moc"
