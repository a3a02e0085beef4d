// Every lattice folder against its golden.json: what a lattice once was, documents rely on. Set
// DIATOM_WRITE_GOLDEN=1 to write the files of new lattices anew, and read what changed before committing it.
#include "core/file.h"
#include "core/hash.h"
#include "lattice/lattice.h"
#include "support/support.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <random>

using namespace diatom;
using Json = nlohmann::ordered_json;

namespace {

std::vector<std::filesystem::path> latticeFolders()
{
   std::vector<std::filesystem::path> folders;
   for (const auto &entry : std::filesystem::directory_iterator(test::sourceDir() / "plugins" / "lattices"))
      if (std::filesystem::exists(entry.path() / "plugin.json"))
         folders.push_back(entry.path());
   std::sort(folders.begin(), folders.end());
   return folders;
}

/// In units of 1e-9 of the lattice unit: the same for every compiler, and finer than any mistake.
std::int64_t fixed(double value) { return std::llround(value * 1e9); }

double rounded(double value) { return static_cast<double>(fixed(value)) / 1e9; }

Json positionsOf(const Lattice &l)
{
   // Twenty indices near and far, on both sides of zero; golden.json itself says which.
   Json rows = Json::array();
   std::mt19937 random(1);
   for (int n = 0; n < 20; ++n) {
      const auto pick = [&] { return static_cast<int>(random() % 41) - 20; };
      const int x = pick(), y = pick(), z = pick();
      const Vec3 p = l.position({x, y, z});
      rows.push_back({{"index", {x, y, z}}, {"position", {rounded(p.x()), rounded(p.y()), rounded(p.z())}}});
   }
   return rows;
}

/// Positions and links of the 1000 cells from (-5,-5,-5) to (4,4,4).
std::string blockHash(const Lattice &l)
{
   Hasher hasher;
   for (int x = -5; x < 5; ++x)
      for (int y = -5; y < 5; ++y)
         for (int z = -5; z < 5; ++z) {
            const Index cell{x, y, z};
            const Vec3 p = l.position(cell);
            for (const double coordinate : {p.x(), p.y(), p.z()})
               hasher.add(fixed(coordinate));
            for (const Link &link : l.links(l.site(cell))) {
               const Index other = cell + link.offset;
               for (const std::int32_t value : {other.x, other.y, other.z, link.feature})
                  hasher.add(value);
               hasher.add(link.contact);
               hasher.add(std::uint8_t{link.joined});
            }
         }
   return hasher.finish().text();
}

Json describe(const Lattice &l)
{
   Json sites = Json::array();
   double volume = 0;
   for (int site = 0; site < l.sites(); ++site) {
      std::array<int, 3> counts{};
      int joined = 0;
      for (const Link &link : l.links(site)) {
         ++counts[static_cast<std::size_t>(link.contact)];
         joined += link.joined ? 1 : 0;
      }
      sites.push_back({{"face", counts[0]}, {"edge", counts[1]}, {"vertex", counts[2]}, {"joined", joined}});
      volume += l.shape(site).volume;
   }
   const Shape &shape = l.shape(0);
   Json golden;
   golden["neighbours"] = sites;
   golden["cell"] = {{"vertices", shape.vertices.size()},
                     {"edges", shape.edges.size()},
                     {"faces", shape.faces.size()},
                     {"volume", rounded(shape.volume)}};
   golden["packing"] = rounded(volume / (l.sites() * l.volumePerSite()));
   golden["rotations"] = l.rotations().size();
   golden["positions"] = positionsOf(l);
   golden["block_hash"] = blockHash(l);
   return golden;
}

} // namespace

class LatticesTest : public QObject
{
   Q_OBJECT

private slots:
   void everyLatticeIsAsItWas_data();
   void everyLatticeIsAsItWas();
   void everyLatticeFolderHoldsThreeFiles_data() { everyLatticeIsAsItWas_data(); }
   void everyLatticeFolderHoldsThreeFiles();
   void parametersReachTheLattice();
};

void LatticesTest::everyLatticeIsAsItWas_data()
{
   QTest::addColumn<QString>("folder");
   for (const auto &folder : latticeFolders())
      QTest::newRow(folder.filename().c_str()) << QString::fromStdString(folder.string());
}

void LatticesTest::everyLatticeIsAsItWas()
{
   QFETCH(QString, folder);
   const std::filesystem::path path = folder.toStdString();
   const auto manifest = readManifest(path);
   DIATOM_VERIFY_OK(manifest);
   Json found;
   for (const Provided &provided : manifest->provides) {
      LatticeSpec spec;
      spec.id = provided.id;
      spec.pitch = 1;
      const auto made = Lattice::make(*test::catalogue(), spec, Job());
      DIATOM_VERIFY_OK(made);
      found[provided.id] = describe(**made);
   }
   if (std::getenv("DIATOM_WRITE_GOLDEN")) {
      DIATOM_VERIFY_OK(writeFileAtomic(path / "golden.json", found.dump(1) + "\n"));
      QSKIP("golden.json was written, not compared");
   }
   const auto text = readFile(path / "golden.json");
   DIATOM_VERIFY_OK(text);
   const Json golden = Json::parse(*text);
   for (const auto &[id, expected] : golden.items())
      for (const auto &[key, value] : expected.items())
         QVERIFY2(found.at(id).at(key) == value,
                  (id + " " + key + ": " + found.at(id).at(key).dump() + ", golden " + value.dump()).c_str());
   QCOMPARE(golden.size(), found.size());
}

void LatticesTest::everyLatticeFolderHoldsThreeFiles()
{
   QFETCH(QString, folder);
   const std::filesystem::path path = folder.toStdString();
   std::vector<std::string> names;
   for (const auto &entry : std::filesystem::directory_iterator(path))
      names.push_back(entry.path().filename().string());
   std::sort(names.begin(), names.end());
   std::vector<std::string> expected{path.filename().string() + ".cpp", "golden.json", "plugin.json"};
   std::sort(expected.begin(), expected.end());
   QCOMPARE(names, expected);
}

void LatticesTest::parametersReachTheLattice()
{
   LatticeSpec spec;
   spec.id = "org.diatom_cad.lattice.gik";
   spec.pitch = 1;
   spec.values["height"] = 1.17; // LEGO
   const auto lego = Lattice::make(*test::catalogue(), spec, Job());
   DIATOM_VERIFY_OK(lego);
   QVERIFY(std::abs((*lego)->shape(0).volume - 1.17) < 1e-12);
   QVERIFY(((*lego)->position({0, 0, 10}) - Vec3(0, 0, 11.7)).norm() < 1e-12);
   // At height 1 the cell is a cube, but the lattice still joins up and down only: a brick cannot stand up.
   spec.values["height"] = 1.0;
   const auto square = Lattice::make(*test::catalogue(), spec, Job());
   DIATOM_VERIFY_OK(square);
   QCOMPARE((*square)->shape(0).rotations.size(), std::size_t{24});
   QCOMPARE((*square)->rotations().size(), std::size_t{8});
   spec.values["height"] = 0.0;
   QVERIFY(!Lattice::make(*test::catalogue(), spec, Job()).ok());
}

QTEST_APPLESS_MAIN(LatticesTest)
#include "lattices_test.moc"
