// STL files: read back by a reader of our own, judged by an independent checker, and what happens when
// writing fails.
#include "core/file.h"
#include "io/stl.h"
#include "io/stl_file.h"
#include "support/mesh.h"
#include "support/process.h"
#include "support/scenes.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <sstream>

using namespace diatom;
namespace fs = std::filesystem;

namespace {

/// What a file holds, in its own units.
struct ReadStl
{
   std::vector<test::Triangle<float>> triangles;
   std::vector<test::Corner<float>> normals;
};

ReadStl readBinary(const std::string &bytes)
{
   ReadStl out;
   std::uint32_t count = 0;
   std::memcpy(&count, bytes.data() + 80, 4);
   if (bytes.size() != 84 + std::size_t{50} * count)
      qFatal("the file has %zu bytes for %u triangles", bytes.size(), count);
   for (std::size_t i = 0; i < count; ++i) {
      float numbers[12];
      std::memcpy(numbers, bytes.data() + 84 + 50 * i, sizeof numbers);
      out.normals.push_back({numbers[0], numbers[1], numbers[2]});
      out.triangles.push_back({{{numbers[3], numbers[4], numbers[5]},
                                {numbers[6], numbers[7], numbers[8]},
                                {numbers[9], numbers[10], numbers[11]}}});
   }
   return out;
}

ReadStl readAscii(const std::string &text)
{
   ReadStl out;
   std::istringstream in(text);
   std::vector<test::Corner<float>> corners;
   for (std::string word; in >> word;) {
      if (word != "normal" && word != "vertex")
         continue;
      test::Corner<float> numbers;
      for (float &number : numbers) {
         std::string digits;
         in >> digits;
         number = std::stof(digits);
      }
      (word == "normal" ? out.normals : corners).push_back(numbers);
   }
   for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
      out.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
   return out;
}

std::string bytesOf(const fs::path &file)
{
   auto bytes = readFile(file);
   return bytes ? *std::move(bytes) : "unreadable: " + bytes.error().message;
}

test::Scene blobScene(const std::string &lattice, std::size_t count, unsigned seed)
{
   test::Scene scene(lattice);
   for (const Index i : test::blob(*scene.lattice, count, seed))
      scene.model.root.cells.set(i, {static_cast<MaterialIndex>(1 + floorMod(i.x + i.y, 3)), 0, 0});
   return scene;
}

std::shared_ptr<const PartMaker> makerFor(const test::Scene &scene)
{
   auto maker = PartMaker::make(*test::catalogue(), "", {}, scene.model.lattice.id, Job());
   if (!maker)
      qFatal("%s", maker.error().message.c_str());
   return *std::move(maker);
}

void addLattices()
{
   QTest::addColumn<QString>("lattice");
   for (const std::string &id : test::kLattices)
      QTest::newRow(id.c_str()) << QString::fromStdString(id);
}

/// The checker's answer; null when it cannot run.
nlohmann::json judged(const fs::path &file)
{
   const test::Outcome judge =
       test::run("python3", {QString::fromStdString((test::sharedDir() / "tools" / "stl_check").string()),
                             QString::fromStdString(file.string())});
   return nlohmann::json::parse(judge.out.toStdString(), nullptr, false);
}

} // namespace

class StlTest : public QObject
{
   Q_OBJECT

private slots:
   void binaryFilesReadBackClosedWithTheCellsVolume_data() { addLattices(); }
   void binaryFilesReadBackClosedWithTheCellsVolume();
   void asciiHoldsTheSameNumbersAsBinary_data() { addLattices(); }
   void asciiHoldsTheSameNumbersAsBinary();
   void storedNormalsFollowTheWinding();
   void theUnitScalesTheNumbers();
   void theSameDesignGivesTheSameBytes();
   void everyMaterialGetsAFileOfItsOwn();
   void bricksAreWrittenWithTheirVolume();
   void voxelsAreWrittenInTheDetailAskedFor();
   void anIndependentCheckerAgrees_data() { addLattices(); }
   void anIndependentCheckerAgrees();
   void anIndependentCheckerAgreesOnParts();
   void aFolderThatIsNotThereGivesASentence();
   void failuresKeepTheOldFile();
   void moreTrianglesThanTheFormatCountsAreRefused();
   void designsTooFarOutForSinglePrecisionAreRefused();
   void wrongOptionsAreRefused();

private:
   fs::path path(const char *name) const { return fs::path(m_folder.path().toStdString()) / name; }
   QTemporaryDir m_folder;
};

void StlTest::binaryFilesReadBackClosedWithTheCellsVolume()
{
   QFETCH(QString, lattice);
   for (const unsigned seed : {1u, 2u}) {
      const auto scene = blobScene(lattice.toStdString(), 300, seed);
      const auto report = writeStl(scene.hierarchy(), nullptr, {}, path("cells.stl"), Job());
      DIATOM_VERIFY_OK(report);
      const std::string bytes = bytesOf(path("cells.stl"));
      const auto read = readBinary(bytes);
      QCOMPARE(report->triangles, std::uint64_t(read.triangles.size()));
      QCOMPARE(report->bytes, std::uint64_t(bytes.size()));
      QCOMPARE(report->cells, std::uint64_t(300));
      const auto facts = test::meshFacts(read.triangles);
      QVERIFY(facts.closed);
      // Corners lie within 2^6 units and are rounded to 24 bits: 2^-18 of a unit-sized cell, in random
      // directions.
      const double wanted = test::cellVolume(scene.hierarchy()) * 1e9; // mm3
      QVERIFY(std::abs(facts.volume / wanted - 1) < 4e-6);
   }
}

void StlTest::asciiHoldsTheSameNumbersAsBinary()
{
   QFETCH(QString, lattice);
   const auto scene = blobScene(lattice.toStdString(), 100, 3);
   StlOptions ascii;
   ascii.ascii = true;
   const auto text = writeStl(scene.hierarchy(), nullptr, ascii, path("ascii.stl"), Job());
   const auto binary = writeStl(scene.hierarchy(), nullptr, {}, path("binary.stl"), Job());
   DIATOM_VERIFY_OK(text);
   DIATOM_VERIFY_OK(binary);
   const std::string bytes = bytesOf(path("ascii.stl"));
   QVERIFY(bytes.starts_with("solid ") && bytes.ends_with("endsolid diatom\n"));
   QCOMPARE(text->bytes, std::uint64_t(bytes.size()));
   const auto a = readAscii(bytes), b = readBinary(bytesOf(path("binary.stl")));
   QCOMPARE(a.triangles.size(), b.triangles.size());
   QVERIFY(a.triangles == b.triangles);
   QVERIFY(a.normals == b.normals);
}

void StlTest::storedNormalsFollowTheWinding()
{
   const auto scene = blobScene(test::kLattices[3], 50, 5);
   DIATOM_VERIFY_OK(writeStl(scene.hierarchy(), nullptr, {}, path("n.stl"), Job()));
   const auto read = readBinary(bytesOf(path("n.stl")));
   for (std::size_t i = 0; i < read.triangles.size(); ++i) {
      const auto vec = [](const test::Corner<float> &c) { return Vec3(c[0], c[1], c[2]); };
      const auto &t = read.triangles[i];
      const Vec3 normal = (vec(t[1]) - vec(t[0])).cross(vec(t[2]) - vec(t[0])).normalized();
      // Corners of single precision within 30 units turn the normal of a unit triangle by some 10^-6.
      QVERIFY((normal - vec(read.normals[i])).norm() < 1e-5);
      QVERIFY(std::abs(vec(read.normals[i]).norm() - 1) < 1e-6);
   }
}

void StlTest::theUnitScalesTheNumbers()
{
   test::Scene scene(test::kLattices[0], 0.02);
   scene.model.root.cells.set({0, 0, 0}, {1, 0, 0});
   for (const double unit : {1.0, 1e-3, 25.4e-3}) {
      StlOptions options;
      options.unit = unit;
      DIATOM_VERIFY_OK(writeStl(scene.hierarchy(), nullptr, options, path("unit.stl"), Job()));
      const auto facts = test::meshFacts(readBinary(bytesOf(path("unit.stl"))).triangles);
      QVERIFY(std::abs(facts.most[0] - facts.least[0] - 0.02 / unit) <
              2e-6 / unit * 0.02); // single precision
   }
}

void StlTest::theSameDesignGivesTheSameBytes()
{
   const auto scene = blobScene(test::kLattices[2], 200, 8);
   DIATOM_VERIFY_OK(writeStl(scene.hierarchy(), nullptr, {}, path("first.stl"), Job()));
   Job single;
   single.setThreads(1);
   DIATOM_VERIFY_OK(writeStl(scene.hierarchy(), nullptr, {}, path("second.stl"), single));
   QVERIFY(bytesOf(path("first.stl")) == bytesOf(path("second.stl")));
   QVERIFY(!bytesOf(path("first.stl")).starts_with("solid")); // by which readers would take it for ASCII
}

void StlTest::everyMaterialGetsAFileOfItsOwn()
{
   const auto scene = blobScene(test::kLattices[0], 200, 6);
   const auto hierarchy = scene.hierarchy();
   const auto counts = hierarchy.countByMaterial();
   const auto reports = writeStlByMaterial(hierarchy, nullptr, {}, path("out.stl"), Job());
   DIATOM_VERIFY_OK(reports);
   QCOMPARE(reports->size(), std::size_t(3));
   for (std::size_t k = 0; k < 3; ++k) {
      const StlReport &report = (*reports)[k];
      const std::string name = std::string("out.") + "abc"[k] + ".stl";
      QCOMPARE(report.file.string(), path(name.c_str()).string());
      QCOMPARE(report.cells, counts[k + 1]);
      const auto facts = test::meshFacts(readBinary(bytesOf(report.file)).triangles);
      QVERIFY(facts.closed);
      QVERIFY(std::abs(facts.volume - double(counts[k + 1])) <
              4e-6 * double(counts[k + 1])); // single precision
   }
}

void StlTest::bricksAreWrittenWithTheirVolume()
{
   test::Scene scene("org.diatom_cad.lattice.gik", 1.27e-3);
   double wanted = 0;
   for (int length = 1; length <= 9; ++length) {
      for (int k = 0; k < length; ++k) {
         const int joins = (k > 0 ? Cell::kJoinsPrevious : 0) | (k + 1 < length ? Cell::kJoinsNext : 0);
         scene.model.root.cells.set({length, k, 0}, {1, 0, static_cast<std::uint8_t>(joins)});
      }
      wanted += ((1.27 * length - 0.127) * 3.175 - 2 * length * 0.254 * 0.7744) * 0.254; // mm3
   }
   const auto maker = makerFor(scene);
   StlOptions options;
   options.what = StlOptions::What::parts;
   const auto report = writeStl(scene.hierarchy(), maker.get(), options, path("bricks.stl"), Job());
   DIATOM_VERIFY_OK(report);
   QCOMPARE(report->parts, std::uint64_t(9));
   QCOMPARE(report->cells, std::uint64_t(45));
   const auto facts = test::meshFacts(readBinary(bytesOf(path("bricks.stl"))).triangles);
   QVERIFY(facts.manifold);
   // Corners within 16 mm, plates 0.254 mm thick: 2^-21 / 0.254 is 2e-6.
   QVERIFY(std::abs(facts.volume / wanted - 1) < 4e-6);
   QVERIFY(facts.most[1] - facts.least[1] > 1.27 * 9 - 0.128); // even layers run along y
}

void StlTest::voxelsAreWrittenInTheDetailAskedFor()
{
   test::Scene scene("org.diatom_cad.lattice.octahedron_edge");
   for (int x = 0; x < 3; ++x)
      scene.model.root.cells.set({x, 0, 0}, {static_cast<MaterialIndex>(1 + x % 2), 0, 0});
   const auto maker = makerFor(scene);
   StlOptions options;
   options.what = StlOptions::What::parts;
   for (int detail = -1; detail < maker->details(); ++detail) {
      options.detail = detail;
      const auto mesh = maker->mesh(0, 1, detail < 0 ? maker->details() - 1 : detail, 1e-3, Job());
      DIATOM_VERIFY_OK(mesh);
      const auto report = writeStl(scene.hierarchy(), maker.get(), options, path("voxels.stl"), Job());
      DIATOM_VERIFY_OK(report);
      QCOMPARE(report->triangles, std::uint64_t(3 * mesh->triangles.size()));
      QVERIFY(test::meshFacts(readBinary(bytesOf(path("voxels.stl"))).triangles).closed);
   }
   options.material = 2;
   const auto one = writeStl(scene.hierarchy(), maker.get(), options, path("voxels.stl"), Job());
   DIATOM_VERIFY_OK(one);
   QCOMPARE(one->parts, std::uint64_t(1));
}

void StlTest::anIndependentCheckerAgrees()
{
   DIATOM_NEEDS_SHARED();
   QFETCH(QString, lattice);
   const auto scene = blobScene(lattice.toStdString(), 500, 12);
   DIATOM_VERIFY_OK(writeStl(scene.hierarchy(), nullptr, {}, path("judged.stl"), Job()));
   const auto verdict = judged(path("judged.stl"));
   if (!verdict.is_object())
      QSKIP("python3 is not there to run stl_check");
   // Cells of a blob also meet along single edges, where four triangles share one: watertight, not "closed".
   QVERIFY2(verdict["watertight"].get<bool>(), verdict.dump().c_str());
   for (const char *fault :
        {"boundary_edges", "flipped_edges", "unbalanced_edges", "duplicate_triangles", "degenerate_triangles",
         "wrong_normals", "zero_normals", "coincident_opposite_pairs"})
      QVERIFY2(verdict[fault].get<int>() == 0, fault);
   const double wanted = test::cellVolume(scene.hierarchy()) * 1e9;
   QVERIFY(std::abs(verdict["volume"].get<double>() / wanted - 1) < 4e-6); // single precision
   // A convex block without single edges is closed in the strict sense.
   test::Scene block(lattice.toStdString());
   block.model.root.cells.fill({{-2, -2, -2}, {3, 3, 3}}, {1, 0, 0});
   DIATOM_VERIFY_OK(writeStl(block.hierarchy(), nullptr, {}, path("block.stl"), Job()));
   const auto solid = judged(path("block.stl"));
   QVERIFY(solid["watertight"].get<bool>());
   if (lattice.endsWith("cube") || lattice.endsWith("gik") || lattice.endsWith("kelvin"))
      QVERIFY2(solid["closed"].get<bool>(), solid.dump().c_str());
}

void StlTest::anIndependentCheckerAgreesOnParts()
{
   DIATOM_NEEDS_SHARED();
   test::Scene scene("org.diatom_cad.lattice.octahedron_edge");
   scene.model.root.cells.set({0, 0, 0}, {1, 0, 0});
   scene.model.root.cells.set({4, 0, 1}, {1, 0, 0});
   const auto maker = makerFor(scene);
   StlOptions options;
   options.what = StlOptions::What::parts;
   DIATOM_VERIFY_OK(writeStl(scene.hierarchy(), maker.get(), options, path("parts.stl"), Job()));
   const auto verdict = judged(path("parts.stl"));
   if (!verdict.is_object())
      QSKIP("python3 is not there to run stl_check");
   QVERIFY2(verdict["closed"].get<bool>(), verdict.dump().c_str());
   QCOMPARE(verdict["shells"].get<int>(), 2);
   QCOMPARE(verdict["inward_shells"].get<int>(), 0);
   QCOMPARE(verdict["wrong_normals"].get<int>(), 0);
}

void StlTest::aFolderThatIsNotThereGivesASentence()
{
   const auto scene = blobScene(test::kLattices[0], 5, 1);
   const fs::path file = path("no such folder") / "out.stl";
   const auto report = writeStl(scene.hierarchy(), nullptr, {}, file, Job());
   QVERIFY(!report);
   QCOMPARE(report.error().code, ErrorCode::unwritable);
   QVERIFY(report.error().message.find("no such folder") != std::string::npos);
   QVERIFY(!fs::exists(file));
}

void StlTest::failuresKeepTheOldFile()
{
   const auto scene = blobScene(test::kLattices[0], 500, 1);
   DIATOM_VERIFY_OK(writeFileAtomic(path("old.stl"), "the old file"));
   Job cancelled;
   cancelled.cancel();
   const auto report = writeStl(scene.hierarchy(), nullptr, {}, path("old.stl"), cancelled);
   QVERIFY(!report);
   QCOMPARE(report.error().code, ErrorCode::cancelled);
   QCOMPARE(bytesOf(path("old.stl")), std::string("the old file"));
   // A folder in the place of the file cannot be replaced, and stays.
   fs::create_directories(path("folder.stl"));
   const auto onto = writeStl(scene.hierarchy(), nullptr, {}, path("folder.stl"), Job());
   QVERIFY(!onto);
   QCOMPARE(onto.error().code, ErrorCode::unwritable);
   QVERIFY(fs::is_directory(path("folder.stl")));
   for (const auto &entry : fs::directory_iterator(m_folder.path().toStdString()))
      QVERIFY2(!entry.path().filename().string().starts_with("."), "a temporary file was left behind");
}

void StlTest::moreTrianglesThanTheFormatCountsAreRefused()
{
   DIATOM_VERIFY_OK(writeFileAtomic(path("many.stl"), "the old file"));
   for (const bool ascii : {false, true})
      for (const int triangles : {10, 11}) {
         StlFile file(path(triangles > 10 ? "many.stl" : "few.stl"), ascii, 1e-3, 0, 10);
         for (int i = 0; i < triangles; ++i)
            file.triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
         const Status status = file.commit();
         QCOMPARE(status.ok(), triangles == 10);
         if (!status)
            QVERIFY(status.error().message.find("11 triangles") != std::string::npos);
      }
   QCOMPARE(bytesOf(path("many.stl")), std::string("the old file"));
}

void StlTest::designsTooFarOutForSinglePrecisionAreRefused()
{
   for (const int x : {1'000'000, -100'000'000}) {
      test::Scene scene(test::kLattices[0]);
      scene.model.root.cells.set({0, x, 0}, {1, 0, 0});
      const auto report = writeStl(scene.hierarchy(), nullptr, {}, path("far.stl"), Job());
      QVERIFY(!report);
      QVERIFY(report.error().message.find("origin") != std::string::npos);
   }
   test::Scene near(test::kLattices[0]);
   near.model.root.cells.set({0, 500'000, 0}, {1, 0, 0});
   DIATOM_VERIFY_OK(writeStl(near.hierarchy(), nullptr, {}, path("near.stl"), Job()));
   QVERIFY(test::meshFacts(readBinary(bytesOf(path("near.stl"))).triangles).manifold);
}

void StlTest::wrongOptionsAreRefused()
{
   const auto scene = blobScene(test::kLattices[0], 5, 1);
   const auto maker = makerFor(scene);
   StlOptions unit, parts, detail;
   unit.unit = 0;
   parts.what = detail.what = StlOptions::What::parts;
   detail.detail = 5;
   QCOMPARE(writeStl(scene.hierarchy(), nullptr, unit, path("x.stl"), Job()).error().code, ErrorCode::usage);
   QCOMPARE(writeStl(scene.hierarchy(), nullptr, parts, path("x.stl"), Job()).error().code, ErrorCode::usage);
   QCOMPARE(writeStl(scene.hierarchy(), maker.get(), detail, path("x.stl"), Job()).error().code,
            ErrorCode::usage);
   QCOMPARE(writeStlByMaterial(scene.hierarchy(), nullptr, {}, "-", Job()).error().code, ErrorCode::usage);
   QVERIFY(!fs::exists(path("x.stl")));
}

QTEST_GUILESS_MAIN(StlTest)
#include "io_stl_test.moc"
