// The cell array against a plain map over random edits, with every version kept.
#include "cells/cell_array.h"
#include "support/support.h"

#include <map>
#include <random>

using namespace diatom;

namespace {

using Plain = std::map<Index, Cell>;

/// One random edit after another, to an array and a map alike.
class Editor
{
public:
   explicit Editor(unsigned seed) : m_random(seed) {}

   void edit(CellArray &array, Plain &plain)
   {
      switch (below(20)) {
      case 0:
         return fill(array, plain, Cell());
      case 1:
      case 2:
         return fill(array, plain, cell());
      case 3:
         return replace(array, plain);
      case 4:
         return write(array, plain);
      case 5:
         if (below(20) == 0) {
            array.clear();
            plain.clear();
         }
         return;
      case 6:
      case 7:
         return eraseExisting(array, plain);
      default:
         for (int k = 0; k < 10; ++k)
            put(array, plain, index(), below(3) == 0 ? Cell() : cell());
      }
   }
   Index index()
   {
      // Clusters around the origin, at far places, at the very limit, and single cells anywhere.
      static constexpr Index kCentres[] = {
          {0, 0, 0}, {100000, -70000, 31}, {-kIndexLimit + 20, kIndexLimit - 20, 0}};
      const int spread = below(2) == 0 ? 5 : 20;
      if (below(60) == 0)
         return {anywhere(), anywhere(), anywhere()};
      const auto near = [&] { return below(2 * spread + 1) - spread; };
      return kCentres[below(8) < 6 ? 0 : 1 + below(2)] + Index{near(), near(), near()};
   }
   int below(int n) { return static_cast<int>(m_random() % static_cast<unsigned>(n)); }

private:
   std::int32_t anywhere()
   {
      return static_cast<std::int32_t>(m_random() % (2U * kIndexLimit + 1)) - kIndexLimit;
   }
   Cell cell()
   {
      // Now and then so many different values that a brick's palette overflows.
      const bool many = below(4) == 0;
      return {static_cast<MaterialIndex>(1 + below(many ? 400 : 4)),
              static_cast<std::uint8_t>(below(many ? 24 : 2)), 0};
   }
   static void put(CellArray &array, Plain &plain, Index i, Cell c)
   {
      array.set(i, c);
      if (c.empty())
         plain.erase(i);
      else
         plain[i] = c;
   }
   Box box()
   {
      const Index low = index();
      if (!inRange(low + Index{20, 20, 20}))
         return {low, low};
      return {low, low + Index{below(20), below(20), below(20)}};
   }
   void fill(CellArray &array, Plain &plain, Cell c)
   {
      const Box b = box();
      array.fill(b, c);
      for (std::int32_t x = b.min.x; x <= b.max.x; ++x)
         for (std::int32_t y = b.min.y; y <= b.max.y; ++y)
            for (std::int32_t z = b.min.z; z <= b.max.z; ++z)
               if (c.empty())
                  plain.erase({x, y, z});
               else
                  plain[{x, y, z}] = c;
   }
   void write(CellArray &array, Plain &plain)
   {
      const Box b = box();
      std::vector<Cell> cells;
      for (std::int32_t x = b.min.x; x <= b.max.x; ++x)
         for (std::int32_t y = b.min.y; y <= b.max.y; ++y)
            for (std::int32_t z = b.min.z; z <= b.max.z; ++z) {
               cells.push_back(below(3) == 0 ? Cell() : cell());
               if (cells.back().empty())
                  plain.erase({x, y, z});
               else
                  plain[{x, y, z}] = cells.back();
            }
      array.write(b, cells);
   }
   void replace(CellArray &array, Plain &plain)
   {
      const auto from = static_cast<MaterialIndex>(1 + below(5));
      const auto to = static_cast<MaterialIndex>(below(8) == 0 ? 0 : 1 + below(5));
      array.replaceMaterial(from, to);
      for (auto it = plain.begin(); it != plain.end();) {
         if (it->second.material == from)
            it->second.material = to;
         it = it->second.empty() ? plain.erase(it) : std::next(it);
      }
   }
   void eraseExisting(CellArray &array, Plain &plain)
   {
      for (int k = 0; k < 30 && !plain.empty(); ++k) {
         auto it = plain.lower_bound(index());
         if (it == plain.end())
            it = plain.begin();
         array.set(it->first, Cell());
         plain.erase(it);
      }
   }

   std::mt19937 m_random;
};

Box boundsOf(const Plain &plain)
{
   Box box;
   for (const auto &[i, cell] : plain)
      box.extend(i);
   return box;
}

Hash hashOf(const CellArray &array)
{
   Hasher hasher;
   array.hash(hasher);
   return hasher.finish();
}

CellArray built(const Plain &plain)
{
   CellArray array;
   for (const auto &[i, cell] : plain)
      array.set(i, cell);
   return array;
}

QString difference(const CellArray &array, const Plain &plain)
{
   if (array.count() != plain.size())
      return QStringLiteral("count %1, expected %2").arg(array.count()).arg(plain.size());
   if (array.bounds() != boundsOf(plain))
      return QStringLiteral("bounds are not tight");
   Plain seen;
   array.visit([&](Index i, Cell cell) { return seen.emplace(i, cell).second; });
   if (seen != plain)
      return QStringLiteral("visit gives other cells");
   std::vector<std::uint64_t> counts(1);
   for (const auto &[i, cell] : plain) {
      counts.resize(std::max(counts.size(), cell.material + std::size_t{1}));
      ++counts[cell.material];
   }
   if (array.countByMaterial() != counts)
      return QStringLiteral("counts by material differ");
   CellArray::Reader reader(array);
   for (const auto &[i, cell] : plain)
      for (const Index step : {Index{0, 0, 0}, Index{0, 0, 1}, Index{-1, 0, 0}}) {
         const auto expected = plain.find(i + step);
         const Cell want = expected == plain.end() ? Cell() : expected->second;
         if (inRange(i + step) && (array.at(i + step) != want || reader.at(i + step) != want))
            return QStringLiteral("at(%1, %2, %3) differs").arg(i.x).arg(i.y).arg(i.z);
      }
   return {};
}

} // namespace

class CellArrayTest : public QObject
{
   Q_OBJECT

private slots:
   void agreesWithAPlainMapOverRandomEditsAndKeepsEveryVersion_data()
   {
      QTest::addColumn<unsigned>("seed");
      for (unsigned seed = 1; seed <= 6; ++seed)
         QTest::addRow("seed %u", seed) << seed;
   }
   void agreesWithAPlainMapOverRandomEditsAndKeepsEveryVersion()
   {
      QFETCH(unsigned, seed);
      Editor editor(seed);
      CellArray array;
      Plain plain;
      std::vector<std::pair<CellArray, Plain>> versions;
      for (int step = 0; step < 250; ++step) {
         if (step % 5 == 0)
            versions.emplace_back(array, plain);
         editor.edit(array, plain);
         if (step % 10 == 0)
            QCOMPARE(difference(array, plain), QString());
      }
      // Undo of everything: each version kept on the way is as it was, and equal to the same content built
      // afresh.
      while (!versions.empty()) {
         const auto &[kept, expected] = versions.back();
         QCOMPARE(difference(kept, expected), QString());
         const CellArray afresh = built(expected);
         QVERIFY(kept == afresh);
         QCOMPARE(hashOf(kept).text(), hashOf(afresh).text());
         array = kept;
         versions.pop_back();
      }
      QVERIFY(array.empty());
      QCOMPARE(array.bytes(), 0ULL);
      QCOMPARE(hashOf(array).text(), hashOf(CellArray()).text());
   }
   void givesOneTreeForOneContentHoweverItCameAbout()
   {
      // The same 40^3 block: as a fill, cell by cell backwards, and carved out of a larger one.
      const Box box{{-7, 3, -20}, {32, 42, 19}};
      CellArray filled, single, carved;
      filled.fill(box, {2});
      for (std::int32_t x = box.max.x; x >= box.min.x; --x)
         for (std::int32_t y = box.max.y; y >= box.min.y; --y)
            for (std::int32_t z = box.max.z; z >= box.min.z; --z)
               single.set({x, y, z}, {2});
      carved.fill({{-300, -300, -300}, {300, 300, 300}}, {1});
      carved.fill(box, {2});
      carved.replaceMaterial(1, 0);
      for (const CellArray *other : {&single, &carved}) {
         QVERIFY(*other == filled);
         QCOMPARE(hashOf(*other).text(), hashOf(filled).text());
         std::vector<Index> a, b;
         filled.visit([&](Index i, Cell) { return a.push_back(i), true; });
         other->visit([&](Index i, Cell) { return b.push_back(i), true; });
         QVERIFY(a == b);
      }
      single.set({0, 5, 0}, {3});
      QVERIFY(!(single == filled));
      QVERIFY(hashOf(single) != hashOf(filled));
      single.set({0, 5, 0}, {2});
      QVERIFY(single == filled);
      QVERIFY(single.bytes() < filled.bytes() * 11 / 10); // palettes may keep room for one more
   }
   void storesLargeBlocksAsOneValue()
   {
      CellArray array;
      array.fill({{0, 0, 0}, {255, 255, 255}}, {1});
      QCOMPARE(array.count(), std::uint64_t{1} << 24);
      // 16.8 million cells; a few nodes of 64 references each, far below one byte a brick of 4096 cells.
      QVERIFY2(array.bytes() < 200000, qPrintable(QString::number(array.bytes())));
      std::uint64_t sum = 0, blocks = 0;
      array.visitBlocks(array.bounds(), [&](const Box &b, Cell) {
         sum += static_cast<std::uint64_t>(b.volume());
         ++blocks;
         return true;
      });
      QCOMPARE(sum, array.count());
      QVERIFY(blocks < 3000); // 4096 bricks, of which the middle ones are joined
   }
   void countsMoreCellsThanSixtyFourBitsHoldAsTheLargestNumber()
   {
      // One whole block of side 2^30: 2^90 cells.
      constexpr Index kLow{-715827872, -715827872, -715827872}, kHigh{357913951, 357913951, 357913951};
      CellArray array;
      array.fill({kLow, kHigh}, {9});
      QCOMPARE(array.count(), ~std::uint64_t{0});
      QVERIFY(array.bounds() == (Box{kLow, kHigh}));
      const CellArray whole = array;
      array.set({1, 2, 3}, Cell());
      QVERIFY(array.at({1, 2, 3}).empty());
      QCOMPARE(int(array.at({1, 2, 4}).material), 9);
      QCOMPARE(array.count(), ~std::uint64_t{0});
      QVERIFY(array.bounds() == (Box{kLow, kHigh}));
      array.set({1, 2, 3}, {9});
      QVERIFY(array == whole);
      array.fill({kLow, kHigh}, Cell());
      QVERIFY(array.empty());
   }
   void ignoresIndicesOutOfRange()
   {
      CellArray array;
      array.set({kIndexLimit + 1, 0, 0}, {1});
      array.set({0, std::numeric_limits<std::int32_t>::min(), 0}, {1});
      QVERIFY(array.empty());
      array.fill({{kIndexLimit, 0, 0}, {std::numeric_limits<std::int32_t>::max(), 0, 0}}, {1});
      QCOMPARE(array.count(), 1ULL);
      QVERIFY(array.at({std::numeric_limits<std::int32_t>::max(), 0, 0}).empty());
   }
   void visitsOnlyTheBoxAndStopsWhenTold()
   {
      Editor editor(77);
      CellArray array;
      Plain plain;
      for (int step = 0; step < 100; ++step)
         editor.edit(array, plain);
      for (int k = 0; k < 50; ++k) {
         Box box;
         box.extend(editor.index());
         box.extend(editor.index());
         Plain expected, seen, blocks;
         for (const auto &[i, cell] : plain)
            if (box.contains(i))
               expected[i] = cell;
         array.visit(box, [&](Index i, Cell cell) { return seen.emplace(i, cell).second; });
         array.visitBlocks(box, [&](const Box &b, Cell cell) {
            for (std::int32_t x = b.min.x; x <= b.max.x; ++x)
               for (std::int32_t y = b.min.y; y <= b.max.y; ++y)
                  for (std::int32_t z = b.min.z; z <= b.max.z; ++z)
                     blocks[{x, y, z}] = cell;
            return true;
         });
         QVERIFY(seen == expected);
         QVERIFY(blocks == expected);
      }
      std::uint64_t n = 0;
      QVERIFY(!array.visit([&](Index, Cell) { return ++n < 5; }));
      QCOMPARE(n, std::min<std::uint64_t>(5, array.count()));
   }
   void sharesWhatAnEditDoesNotTouch()
   {
      CellArray array;
      for (std::int32_t x = 0; x < 64; ++x)
         for (std::int32_t y = 0; y < 64; ++y)
            for (std::int32_t z = 0; z < 64; ++z)
               array.set({x, y, z}, {static_cast<MaterialIndex>(1 + (x + y + z) % 3)});
      const CellArray before = array;
      array.set({5, 5, 5}, before.at({5, 5, 5})); // changes nothing, copies nothing
      QVERIFY(array.root().same(before.root()));
      array.set({5, 5, 5}, {7});
      QVERIFY(!array.root().same(before.root()));
      QCOMPARE(int(before.at({5, 5, 5}).material), 1);
      QCOMPARE(int(array.at({5, 5, 5}).material), 7);
   }
};

QTEST_APPLESS_MAIN(CellArrayTest)
#include "cells_array_test.moc"
