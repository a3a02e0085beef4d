// The parts plugins through their C table: meshes against the measures they are modelled from, decompositions
// of cells made by hand, and the golden answers of each folder.
#include "support/mesh.h"
#include "support/support.h"

#include <nlohmann/json.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>
#include <random>
#include <set>
#include <utility>

using namespace diatom;

using Json = nlohmann::ordered_json;

namespace {

const std::string kCube = "org.diatom_cad.parts.cube", kGik = "org.diatom_cad.parts.gik",
                  kSnap = "org.diatom_cad.parts.snap_voxel", kGikPieces = "org.diatom_cad.parts.gik_pieces";

struct RawMesh
{
   std::vector<double> xyz;
   std::vector<std::int32_t> corners;

   std::vector<test::Triangle<double>> triangles() const
   {
      std::vector<test::Triangle<double>> out;
      const auto at = [&](std::size_t i) {
         const auto c = static_cast<std::size_t>(corners[i]);
         return test::Corner<double>{xyz[3 * c], xyz[3 * c + 1], xyz[3 * c + 2]};
      };
      for (std::size_t i = 0; i < corners.size(); i += 3)
         out.push_back({at(i), at(i + 1), at(i + 2)});
      return out;
   }
};

struct RawPart
{
   std::int32_t type, length, material;
   std::array<double, 3> position;
   std::array<double, 4> orientation;
   std::vector<std::array<std::int32_t, 3>> covered; // cell indices, sorted
   auto operator<=>(const RawPart &) const = default;
};

/// Cells as a host hands them over, in any order.
struct RawCells
{
   std::vector<std::int32_t> index, site, material, supercell, place;
   std::vector<double> position, orientation;

   std::int32_t count() const { return static_cast<std::int32_t>(site.size()); }
   void add(std::array<std::int32_t, 3> at, std::int32_t cellSite, std::int32_t cellMaterial,
            std::int32_t run, std::int32_t inRun)
   {
      index.insert(index.end(), at.begin(), at.end());
      site.push_back(cellSite);
      material.push_back(cellMaterial);
      supercell.push_back(run);
      place.push_back(inRun);
      for (const std::int32_t i : at)
         position.push_back(i * 1e-3);
      orientation.insert(orientation.end(), {1, 0, 0, 0});
   }
   std::string lattice = "org.diatom_cad.lattice.cube";

   diatom_cells record() const
   {
      return {sizeof(diatom_cells), count(),          1e-3,         index.data(),    site.data(),
              material.data(),      supercell.data(), place.data(), position.data(), orientation.data(),
              lattice.c_str()};
   }
   RawCells shuffled(std::mt19937 &random) const
   {
      std::vector<std::int32_t> order(site.size()), placeOf(site.size());
      std::iota(order.begin(), order.end(), 0);
      std::shuffle(order.begin(), order.end(), random);
      for (std::size_t i = 0; i < order.size(); ++i)
         placeOf[static_cast<std::size_t>(order[i])] = static_cast<std::int32_t>(i);
      RawCells out;
      for (const std::int32_t old : order) {
         const auto o = static_cast<std::size_t>(old);
         out.add({index[3 * o], index[3 * o + 1], index[3 * o + 2]}, site[o], material[o],
                 placeOf[static_cast<std::size_t>(supercell[o])], place[o]);
      }
      return out;
   }
};

Result<std::shared_ptr<const Instance>> create(const std::string &id)
{
   return test::catalogue()->create<diatom_parts>(DIATOM_PARTS_1, id, {}, Job());
}

Result<RawMesh> meshOf(const Instance &parts, int type, int length, int detail, double pitch)
{
   RawMesh mesh;
   const diatom_mesh_sink sink{sizeof sink, &mesh,
                               [](const diatom_mesh_sink *to, std::int64_t vertices, const double *xyz,
                                  std::int64_t triangles, const std::int32_t *corners) -> std::int32_t {
                                  auto &out = *static_cast<RawMesh *>(to->host);
                                  out.xyz.assign(xyz, xyz + 3 * vertices);
                                  out.corners.assign(corners, corners + 3 * triangles);
                                  return DIATOM_OK;
                               }};
   const Status status = parts.call("mesh", Job(), [&](const diatom_call *call) {
      return parts.table<diatom_parts>()->mesh(parts.self(), call, type, length, detail, pitch, &sink);
   });
   if (!status)
      return status.error();
   return mesh;
}

struct PartReceiver
{
   const RawCells &cells;
   std::vector<RawPart> parts;

   static std::int32_t take(const diatom_part_sink *sink, const diatom_part_batch *batch)
   {
      auto &self = *static_cast<PartReceiver *>(sink->host);
      for (std::int64_t i = 0; i < batch->count; ++i) {
         RawPart part{batch->type[i], batch->length[i], batch->material[i], {}, {}, {}};
         std::copy_n(batch->position + 3 * i, 3, part.position.begin());
         std::copy_n(batch->orientation + 4 * i, 4, part.orientation.begin());
         for (std::int64_t k = batch->covered_start[i]; k < batch->covered_start[i + 1]; ++k) {
            const std::int32_t *index = self.cells.index.data() + 3 * batch->covered[k];
            part.covered.push_back({index[0], index[1], index[2]});
         }
         std::sort(part.covered.begin(), part.covered.end());
         self.parts.push_back(part);
      }
      return DIATOM_OK;
   }
};

/// Parts in an order that depends on their content only.
Result<std::vector<RawPart>> decompose(const Instance &parts, const RawCells &cells)
{
   PartReceiver receiver{cells, {}};
   const diatom_part_sink sink{sizeof sink, &receiver, PartReceiver::take};
   const diatom_cells record = cells.record();
   const Status status = parts.call("decompose", Job(), [&](const diatom_call *call) {
      return parts.table<diatom_parts>()->decompose(parts.self(), call, &record, &sink);
   });
   if (!status)
      return status.error();
   std::sort(receiver.parts.begin(), receiver.parts.end());
   return receiver.parts;
}

std::vector<std::string> folders()
{
   std::vector<std::string> names;
   for (const auto &entry : std::filesystem::directory_iterator(test::sourceDir() / "plugins" / "parts"))
      if (std::filesystem::exists(entry.path() / "plugin.json"))
         names.push_back(entry.path().filename().string());
   std::sort(names.begin(), names.end());
   return names;
}

/// What golden.json holds: the catalogue, and facts of the meshes of every type, some lengths and every
/// detail.
Result<Json> describe(const std::string &folder)
{
   const auto parts = create("org.diatom_cad.parts." + folder);
   if (!parts)
      return parts.error();
   const diatom_catalogue *record = nullptr;
   const Status called = (*parts)->call("catalogue", Job(), [&](const diatom_call *call) {
      return (*parts)->table<diatom_parts>()->catalogue((*parts)->self(), call, &record);
   });
   if (!called)
      return called.error();
   Json found{{"id", (*parts)->id()}, {"types", Json::array()}};
   for (std::int32_t i = 0; i < record->types; ++i)
      found["types"].push_back({{"id", record->type_id[i]}, {"share", record->share[i]}});
   found["details"] = record->details;
   found["partial"] = record->partial != 0;
   found["lattices"] = std::vector<std::string>(record->lattice, record->lattice + record->lattices);
   found["meshes"] = Json::array();
   const bool runs = found["lattices"][0] == "org.diatom_cad.lattice.gik";
   const auto rounded = [](double v) { return std::round(v * 1e10) / 1e10 + 0.0; };
   for (std::int32_t type = 0; type < record->types; ++type)
      for (const int length : runs ? std::vector<int>{1, 2, 4, 9} : std::vector<int>{1})
         for (std::int32_t detail = 0; detail < record->details; ++detail) {
            const auto mesh = meshOf(**parts, type, length, detail, 1);
            if (!mesh)
               continue; // strands have a longest
            const auto facts = test::meshFacts(mesh->triangles());
            Json bounds{Json::array(), Json::array()};
            for (std::size_t axis = 0; axis < 3; ++axis) {
               bounds[0].push_back(rounded(facts.least[axis]));
               bounds[1].push_back(rounded(facts.most[axis]));
            }
            found["meshes"].push_back({{"type", type},
                                       {"length", length},
                                       {"detail", detail},
                                       {"vertices", mesh->xyz.size() / 3},
                                       {"triangles", mesh->corners.size() / 3},
                                       {"volume", rounded(facts.volume)},
                                       {"bounds", bounds}});
         }
   return found;
}

/// Bricks of 1 to 4 cells in two layers that cross.
RawCells someBricks()
{
   RawCells cells;
   for (std::int32_t z = -1; z < 1; ++z)
      for (std::int32_t row = 0; row < 4; ++row) {
         const std::int32_t first = cells.count();
         for (std::int32_t i = 0; i <= row; ++i)
            cells.add(z == 0 ? std::array{row, i, z} : std::array{i, row, z}, z == 0 ? 0 : 1, 1 + row % 2,
                      first, i);
      }
   return cells;
}

} // namespace

class PartsPluginTest : public QObject
{
   Q_OBJECT

private slots:
   void everyPluginGivesItsGoldenAnswers_data();
   void everyPluginGivesItsGoldenAnswers();
   void everyMeshIsClosedOutwardAndScalesWithThePitch_data();
   void everyMeshIsClosedOutwardAndScalesWithThePitch();
   void noMeshOverlapsItself_data() { everyMeshIsClosedOutwardAndScalesWithThePitch_data(); }
   void noMeshOverlapsItself();
   void newPartsHaveTheVolumesOfTheirMeasures();
   void gikBricksOfAnyLengthHaveTheVolumeOfTheirDrawing();
   void gikSlotsAreWhereTheCellsAre();
   void gikPiecesOfARunMakeUpItsBrick();
   void coarseSnapVoxelHasTheVolumeOfTheSheet();
   void fineSnapVoxelStaysInItsCellButForThePeg();
   void fineSnapVoxelsPegGoesIntoTheSocketAbove();
   void oneBrickIsMadeOfEachRun();
   void theOrderOfTheCellsDoesNotMatter_data();
   void theOrderOfTheCellsDoesNotMatter();
   void aBrickOfTwoMaterialsIsRefusedWithItsCells();
   void meshesThatDoNotExistAreRefused();
};

void PartsPluginTest::everyPluginGivesItsGoldenAnswers_data()
{
   QTest::addColumn<QString>("folder");
   for (const std::string &name : folders())
      QTest::newRow(name.c_str()) << QString::fromStdString(name);
}

void PartsPluginTest::everyPluginGivesItsGoldenAnswers()
{
   QFETCH(QString, folder);
   const auto path = test::sourceDir() / "plugins" / "parts" / folder.toStdString() / "golden.json";
   const auto found = describe(folder.toStdString());
   DIATOM_VERIFY_OK(found);
   if (std::getenv("DIATOM_WRITE_GOLDEN")) {
      std::ofstream(path) << found->dump(1) << "\n";
      QSKIP("golden.json was written, not compared");
   }
   std::ifstream file(path);
   QVERIFY(file.good());
   const auto golden = Json::parse(file);
   for (const char *key : {"id", "types", "details", "partial", "lattices"})
      QVERIFY2(found->at(key) == golden.at(key), key);
   QCOMPARE(found->at("meshes").size(), golden.at("meshes").size());
   for (std::size_t i = 0; i < golden.at("meshes").size(); ++i) {
      const auto &wanted = golden["meshes"][i], &mesh = found->at("meshes")[i];
      for (const char *key : {"type", "length", "detail", "vertices", "triangles"})
         QVERIFY2(mesh.at(key) == wanted.at(key), key);
      // Golden numbers have ten digits.
      QVERIFY(std::abs(mesh["volume"].get<double>() - wanted["volume"].get<double>()) < 1e-9);
      for (std::size_t side = 0; side < 2; ++side)
         for (std::size_t axis = 0; axis < 3; ++axis)
            QVERIFY(std::abs(mesh["bounds"][side][axis].get<double>() -
                             wanted["bounds"][side][axis].get<double>()) < 1e-9);
   }
}

void PartsPluginTest::everyMeshIsClosedOutwardAndScalesWithThePitch_data()
{
   QTest::addColumn<QString>("id");
   QTest::addColumn<int>("type");
   QTest::addColumn<int>("length");
   QTest::addColumn<int>("detail");
   for (const std::string &folder : folders()) {
      const auto found = describe(folder);
      if (!found)
         qFatal("%s", found.error().message.c_str());
      for (const auto &mesh : found->at("meshes"))
         QTest::addRow("%s %d, length %d, detail %d", folder.c_str(), mesh["type"].get<int>(),
                       mesh["length"].get<int>(), mesh["detail"].get<int>())
             << QString::fromStdString("org.diatom_cad.parts." + folder) << mesh["type"].get<int>()
             << mesh["length"].get<int>() << mesh["detail"].get<int>();
   }
}

void PartsPluginTest::everyMeshIsClosedOutwardAndScalesWithThePitch()
{
   QFETCH(QString, id);
   QFETCH(int, type);
   QFETCH(int, length);
   QFETCH(int, detail);
   const auto parts = create(id.toStdString());
   DIATOM_VERIFY_OK(parts);
   const auto unit = meshOf(**parts, type, length, detail, 1),
              scaled = meshOf(**parts, type, length, detail, 0.05);
   DIATOM_VERIFY_OK(unit);
   DIATOM_VERIFY_OK(scaled);
   const auto facts = test::meshFacts(unit->triangles()), small = test::meshFacts(scaled->triangles());
   QVERIFY(facts.manifold);
   QVERIFY(small.manifold);
   QVERIFY(facts.volume > 0);
   // Volume goes with the cube of the pitch; the tolerance is the rounding of a few hundred terms.
   QVERIFY(std::abs(small.volume / (facts.volume * 0.05 * 0.05 * 0.05) - 1) < 1e-12);
}

// How often the surface goes round a point, by the solid angles of its triangles: 0 outside and 1 inside
// unless the surface passes through itself.
void PartsPluginTest::noMeshOverlapsItself()
{
   QFETCH(QString, id);
   QFETCH(int, type);
   QFETCH(int, length);
   QFETCH(int, detail);
   const auto parts = create(id.toStdString());
   DIATOM_VERIFY_OK(parts);
   const auto mesh = meshOf(**parts, type, length, detail, 1);
   DIATOM_VERIFY_OK(mesh);
   const auto triangles = mesh->triangles();
   const auto facts = test::meshFacts(triangles);
   std::mt19937 random(11);
   for (int n = 0; n < 300; ++n) {
      Eigen::Vector3d point;
      for (int axis = 0; axis < 3; ++axis)
         point[axis] = std::uniform_real_distribution<double>(
             facts.least[static_cast<std::size_t>(axis)], facts.most[static_cast<std::size_t>(axis)])(random);
      double angle = 0;
      for (const auto &triangle : triangles) { // Van Oosterom and Strackee 1983
         const Eigen::Vector3d a = Eigen::Vector3d(triangle[0].data()) - point,
                               b = Eigen::Vector3d(triangle[1].data()) - point,
                               c = Eigen::Vector3d(triangle[2].data()) - point;
         angle += 2 * std::atan2(a.dot(b.cross(c)), a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                                                        b.dot(c) * a.norm() + c.dot(a) * b.norm());
      }
      const double turns = angle / (4 * std::acos(-1.0));
      QVERIFY(std::abs(turns) < 1e-6 || std::abs(turns - 1) < 1e-6);
   }
}

void PartsPluginTest::newPartsHaveTheVolumesOfTheirMeasures()
{
   const auto volumeOf = [](const char *name, int type, int length, int detail) {
      const auto parts = create(std::string("org.diatom_cad.parts.") + name);
      const auto mesh = parts ? meshOf(**parts, type, length, detail, 1) : parts.error();
      return mesh ? test::meshFacts(mesh->triangles()).volume : 0.0;
   };
   // Tolerances: rounding of a few thousand terms. Worked out from the measures of dmdesign.md section 2 and
   // those that the plugins add, part by part.
   const double s = std::sqrt(0.5), rounding = 1e-11;
   // Square: |x| + |y| between inner and outer, less the four corners beyond the reach, less two slots
   // outside and two inside.
   const double t = 0.06, inner = s - 0.1, outer = s + t, middle = (s + inner) / 2;
   const double ring = 2 * outer * outer - 2 * inner * inner - 4 * t * t;
   const double outerSlot = t * (s - middle), innerSlot = t * (middle - inner) + t * t / 4;
   QVERIFY(std::abs(volumeOf("octahedron_squares", 0, 1, 0) - t * (ring - 2 * outerSlot - 2 * innerSlot)) <
           rounding);
   // Cross: four struts between |x| + |y| = inner and outer within [t / 2, s] by [0, s] of a quarter.
   const double h = t / 2;
   const double cut = h * (s - inner) + h * h / 2; // nearer than t / 2 to the other node
   QVERIFY(std::abs(volumeOf("octahedron_crosses", 0, 1, 0) -
                    4 * t * ((outer * outer / 2 - t * t) - inner * inner / 2 - cut)) < rounding);
   QVERIFY(std::abs(volumeOf("octahedron_crosses", 1, 1, 0) - volumeOf("octahedron_crosses", 0, 1, 0) / 2) <
           rounding);
   // LEGO: box, cavity, stud and hole; a polygon of n corners for each circle.
   const double pi = std::acos(-1.0);
   for (const int length : {1, 2, 4})
      for (const int detail : {0, 1}) {
         const int n = detail ? 64 : 12;
         const auto disc = [&](double d) { return n * d * d / 8 * std::sin(2 * pi / n); };
         const double along = 8.2 * (length - 1) + 7.79;
         const double wanted = along * 7.79 * 9.58 - (along - 3.02) * (7.79 - 3.02) * 8.49 +
                               length * (disc(4.88) * 1.88 - disc(2.66) * 0.66);
         QVERIFY(std::abs(volumeOf("gik_lego", 0, length, detail) - wanted / (8.2 * 8.2 * 8.2)) < rounding);
         // DNA block: as much plug as socket.
         QVERIFY(std::abs(volumeOf("gik_dna_blocks", 0, length, detail) - (length - 0.05) * 0.95 * 1.03) <
                 rounding);
      }
   QVERIFY(std::abs(volumeOf("gik_dna_strands", 0, 1, 0) - 0.2 * 0.2 * 16 * 0.135) < rounding);
   QVERIFY(std::abs(volumeOf("gik_dna_strands", 0, 2, 0) - (2 * 0.04 * 16 * 0.135 + 0.6 * 0.4 * 0.135)) <
           rounding);
}

void PartsPluginTest::gikBricksOfAnyLengthHaveTheVolumeOfTheirDrawing()
{
   const auto parts = create(kGik);
   DIATOM_VERIFY_OK(parts);
   const double mm = 1e-3;
   for (int length = 1; length <= 9; ++length) {
      const auto mesh = meshOf(**parts, 0, length, 1, 1.27 * mm);
      DIATOM_VERIFY_OK(mesh);
      const auto facts = test::meshFacts(mesh->triangles());
      // dmdesign.md section 2: 1.27 L - 0.127 long, 3.175 high, 0.254 thick, less two slots of 0.254 x 0.7744
      // per cell. Tolerances are rounding: a few hundred terms, and one or two operations.
      const double wanted = ((1.27 * length - 0.127) * 3.175 - 2 * length * 0.254 * 0.7744) * 0.254;
      QVERIFY(std::abs(facts.volume / (mm * mm * mm) / wanted - 1) < 1e-12);
      QVERIFY(std::abs(facts.most[0] - facts.least[0] - (1.27 * length - 0.127) * mm) < 1e-15);
      QVERIFY(std::abs(facts.most[1] - facts.least[1] - 0.254 * mm) < 1e-15);
      QVERIFY(std::abs(facts.most[2] - facts.least[2] - 3.175 * mm) < 1e-15);
      QVERIFY(std::abs(facts.least[0] + 0.5715 * mm) < 1e-15); // the origin is the first cell's centre
   }
}

void PartsPluginTest::gikSlotsAreWhereTheCellsAre()
{
   const auto parts = create(kGik);
   DIATOM_VERIFY_OK(parts);
   const auto mesh = meshOf(**parts, 0, 5, 1, 1.27);
   DIATOM_VERIFY_OK(mesh);
   std::set<long> walls; // where triangles look along x, in units of 1e-4
   for (const auto &t : mesh->triangles())
      if (t[0][0] == t[1][0] && t[1][0] == t[2][0])
         walls.insert(std::lround(t[0][0] * 1e4));
   std::set<long> wanted = {-5715, 5 * 12700 - 6985}; // the ends
   for (int cell = 0; cell < 5; ++cell) {
      wanted.insert(12700 * cell - 1270);
      wanted.insert(12700 * cell + 1270);
   }
   QVERIFY(walls == wanted);
}

namespace {

/// Volume and bounds of the placed parts that cover a run, by its first cell's row: layer and the index
/// across it.
std::map<std::array<std::int32_t, 2>, test::MeshFacts> runsAsMade(const Instance &parts,
                                                                  const std::vector<RawPart> &placed)
{
   std::map<std::array<std::int32_t, 2>, std::vector<test::Triangle<double>>> solids;
   for (const RawPart &part : placed) {
      const auto mesh = meshOf(parts, part.type, part.length, 1, 1e-3);
      if (!mesh)
         qFatal("%s", mesh.error().message.c_str());
      const double w = part.orientation[0], z = part.orientation[3]; // turns about z only
      const double c = w * w - z * z, s = 2 * w * z;
      const auto &first = part.covered.front();
      auto &solid = solids[{first[2], first[2] % 2 == 0 ? first[0] : first[1]}];
      for (auto triangle : mesh->triangles()) {
         for (auto &corner : triangle)
            corner = {part.position[0] + c * corner[0] - s * corner[1],
                      part.position[1] + s * corner[0] + c * corner[1], part.position[2] + corner[2]};
         solid.push_back(triangle);
      }
   }
   std::map<std::array<std::int32_t, 2>, test::MeshFacts> facts;
   for (const auto &[row, solid] : solids)
      facts[row] = test::meshFacts(solid);
   return facts;
}

} // namespace

void PartsPluginTest::gikPiecesOfARunMakeUpItsBrick()
{
   const auto bricks = create(kGik), pieces = create(kGikPieces);
   DIATOM_VERIFY_OK(bricks);
   DIATOM_VERIFY_OK(pieces);
   const RawCells cells = someBricks();
   const auto whole = decompose(**bricks, cells), cut = decompose(**pieces, cells);
   DIATOM_VERIFY_OK(whole);
   DIATOM_VERIFY_OK(cut);
   QCOMPARE(cut->size(), cells.site.size());
   const auto wanted = runsAsMade(**bricks, *whole), got = runsAsMade(**pieces, *cut);
   QCOMPARE(got.size(), wanted.size());
   for (const auto &[row, brick] : wanted) {
      const auto &made = got.at(row);
      QVERIFY(std::abs(made.volume / brick.volume - 1) < 1e-12); // rounding of some hundred terms
      for (std::size_t axis = 0; axis < 3; ++axis) {
         QVERIFY(std::abs(made.least[axis] - brick.least[axis]) < 1e-15); // of lengths of some 1e-3
         QVERIFY(std::abs(made.most[axis] - brick.most[axis]) < 1e-15);
      }
   }
}

void PartsPluginTest::coarseSnapVoxelHasTheVolumeOfTheSheet()
{
   const auto parts = create(kSnap);
   DIATOM_VERIFY_OK(parts);
   const auto mesh = meshOf(**parts, 0, 1, 0, 1);
   DIATOM_VERIFY_OK(mesh);
   // dmdesign.md section 2: struts 0.1 square, blocks 0.1 x 0.1 x 0.1414, reach 0.6571. A strut's middle line
   // runs from block side to block side: sqrt(2) (reach - 0.05 - 0.0707).
   const double block = 0.1 * std::sqrt(2.0), strut = std::sqrt(2.0) * (0.6571 - 0.05 - block / 2);
   const double scale = 0.706 / 0.6571;
   const double wanted = (6 * 0.01 * block + 12 * 0.01 * strut) * scale * scale * scale;
   QVERIFY(std::abs(test::meshFacts(mesh->triangles()).volume - wanted) < 1e-14); // rounding only
}

void PartsPluginTest::fineSnapVoxelStaysInItsCellButForThePeg()
{
   const auto parts = create(kSnap);
   DIATOM_VERIFY_OK(parts);
   const auto mesh = meshOf(**parts, 0, 1, 1, 1);
   DIATOM_VERIFY_OK(mesh);
   int outside = 0;
   for (std::size_t i = 0; i < mesh->xyz.size(); i += 3) {
      const double x = mesh->xyz[i], y = mesh->xyz[i + 1], z = mesh->xyz[i + 2];
      // Along the axes through the nodes, the planes between a cell and its twelve neighbours across edges
      // are |u| + |v| = sqrt(1/2) and so on.
      const double u = std::abs(x + y) * std::sqrt(0.5), v = std::abs(y - x) * std::sqrt(0.5),
                   w = std::abs(z);
      const double edge = std::sqrt(0.5) + 1e-12; // rounding
      if (u + v > edge || v + w > edge || u + w > edge) {
         ++outside;
         QVERIFY(z > std::sqrt(0.5) && std::max(u, v) < 0.035); // only the peg on top
      }
   }
   QCOMPARE(outside, 16); // the peg's four upper rings
}

void PartsPluginTest::fineSnapVoxelsPegGoesIntoTheSocketAbove()
{
   const auto parts = create(kSnap);
   DIATOM_VERIFY_OK(parts);
   const auto mesh = meshOf(**parts, 0, 1, 1, 1);
   DIATOM_VERIFY_OK(mesh);
   // Rings of the peg and, moved up by two layers (sqrt 2), of the socket: place on the axis, half width.
   using Rings = std::vector<std::pair<double, double>>;
   Rings peg, socket;
   for (std::size_t i = 0; i < mesh->xyz.size(); i += 12) { // four corners a ring
      const double z = mesh->xyz[i + 2];
      const double half = std::hypot(mesh->xyz[i], mesh->xyz[i + 1]) / std::sqrt(2.0);
      if (half < 0.049 && z > 0.6)
         peg.emplace_back(z, half);
      else if (half < 0.049 && z < -0.5)
         socket.emplace_back(z + std::sqrt(2.0), half);
   }
   QCOMPARE(peg.size(), std::size_t(5));
   QCOMPARE(socket.size(), std::size_t(5));
   const auto at = [](const Rings &rings, double z) {
      for (std::size_t i = 1; i < rings.size(); ++i)
         if (rings[i - 1].first <= z && z < rings[i].first)
            return rings[i - 1].second + (rings[i].second - rings[i - 1].second) * (z - rings[i - 1].first) /
                                             (rings[i].first - rings[i - 1].first);
      return -1.0;
   };
   double narrowest = 1, widest = 0;
   for (int level = 1; socket.front().first + 1e-4 * level < peg.back().first; ++level) {
      const double z = socket.front().first + 1e-4 * level;
      QVERIFY(at(peg, z) > 0 && at(socket, z) > 0);
      QVERIFY(at(socket, z) - at(peg, z) > 0.001); // snapped in, nothing overlaps
      narrowest = std::min(narrowest, at(socket, z));
      widest = std::max(widest, at(peg, z));
   }
   QVERIFY(widest > narrowest);                     // it has to be pushed through: it snaps
   QVERIFY(peg.back().first < socket.back().first); // and does not touch the bottom
}

void PartsPluginTest::oneBrickIsMadeOfEachRun()
{
   const auto parts = create(kGik);
   DIATOM_VERIFY_OK(parts);
   const RawCells cells = someBricks();
   const auto bricks = decompose(**parts, cells);
   DIATOM_VERIFY_OK(bricks);
   QCOMPARE(bricks->size(), std::size_t(8));
   for (const RawPart &brick : *bricks) {
      QCOMPARE(std::size_t(brick.length), brick.covered.size());
      const auto &first = brick.covered.front();
      for (std::size_t axis = 0; axis < 3; ++axis)
         QCOMPARE(brick.position[axis], first[axis] * 1e-3);
      // Even layers run along +y: local x turned by 90 degrees about z.
      QCOMPARE(brick.orientation[0], first[2] == 0 ? std::sqrt(0.5) : 1.0);
      QCOMPARE(brick.orientation[3], first[2] == 0 ? std::sqrt(0.5) : 0.0);
   }
}

void PartsPluginTest::theOrderOfTheCellsDoesNotMatter_data()
{
   QTest::addColumn<QString>("id");
   for (const std::string &id : {kCube, kGik, kGikPieces, kSnap})
      QTest::newRow(id.c_str()) << QString::fromStdString(id);
}

void PartsPluginTest::theOrderOfTheCellsDoesNotMatter()
{
   QFETCH(QString, id);
   const auto parts = create(id.toStdString());
   DIATOM_VERIFY_OK(parts);
   const RawCells cells = someBricks();
   const auto wanted = decompose(**parts, cells);
   DIATOM_VERIFY_OK(wanted);
   std::mt19937 random(20240531);
   for (int round = 0; round < 5; ++round) {
      const RawCells other = cells.shuffled(random);
      const auto got = decompose(**parts, other);
      DIATOM_VERIFY_OK(got);
      QVERIFY(*got == *wanted);
   }
}

void PartsPluginTest::aBrickOfTwoMaterialsIsRefusedWithItsCells()
{
   const auto parts = create(kGik);
   DIATOM_VERIFY_OK(parts);
   RawCells cells;
   cells.add({5, -3, 0}, 0, 1, 0, 0);
   cells.add({5, -2, 0}, 0, 2, 0, 1);
   const auto bricks = decompose(**parts, cells);
   QVERIFY(!bricks);
   QVERIFY(bricks.error().message.find("5 -3 0") != std::string::npos);
   QVERIFY(bricks.error().message.find("5 -2 0") != std::string::npos);
}

void PartsPluginTest::meshesThatDoNotExistAreRefused()
{
   const auto parts = create(kGik);
   DIATOM_VERIFY_OK(parts);
   QVERIFY(!meshOf(**parts, 1, 1, 0, 1));
   QVERIFY(!meshOf(**parts, -1, 1, 0, 1));
   QVERIFY(!meshOf(**parts, 0, 0, 0, 1));
   QVERIFY(!meshOf(**parts, 0, 1, 7, 1));
   QVERIFY(!meshOf(**parts, 0, 1, 0, 0));
   QVERIFY(!meshOf(**parts, 0, 1, 0, std::nan("")));
   QVERIFY(!meshOf(**parts, 0, 2'000'000'000, 0, 1));
}

QTEST_APPLESS_MAIN(PartsPluginTest)
#include "parts_test.moc"
