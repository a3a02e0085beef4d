// Meshes shown beside the cells: kept by documents and commands, read in place, told when missing.
#include "core/file.h"
#include "document/document.h"
#include "formats/files.h"
#include "formats/reference_meshes.h"
#include "io/mesh_read.h"
#include "support/support.h"
#include "tests/kernel/document_run.h"

using namespace diatom;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

// A triangle of 1, 2 and 3 along x, y and z.
constexpr const char *kTriangle = "v 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 2 3\n";

Document cubes()
{
   Design design;
   design.model.lattice.id = "org.diatom_cad.lattice.cube";
   return Document(test::catalogue(), design);
}

} // namespace

class FormatsReferenceTest : public QObject
{
   Q_OBJECT
private slots:
   void commandsAddChangeAndRemove()
   {
      Document document = cubes();
      const Hash before = document.design().hash();
      DIATOM_VERIFY_OK(document.run("reference-mesh", {{"name", "hand"}, {"file", "hand.obj"}}, Job()));
      QVERIFY(document.design().hash() != before);
      DIATOM_VERIFY_OK(document.run("reference-mesh",
                                    {{"name", "hand"}, {"position_m", {1, 2, 3}}, {"shown", false}}, Job()));
      QCOMPARE(document.design().referenceMeshes.size(), std::size_t(1));
      const ReferenceMesh &hand = document.design().referenceMeshes.front();
      QCOMPARE(hand.file, (fs::current_path() / "hand.obj").string()); // what is not given stays
      QVERIFY(hand.position == Vec3(1, 2, 3) && !hand.shown && hand.unit == 0);
      DIATOM_VERIFY_OK(document.run("remove-reference-mesh", {{"name", "hand"}}, Job()));
      QVERIFY(document.design().hash() == before);
      QVERIFY(document.undo());
      QCOMPARE(document.design().referenceMeshes.size(), std::size_t(1));
   }

   void commandsRefuseWhatMakesNoSense()
   {
      Document document = cubes();
      const auto refused = [&](const char *command, const json &arguments) {
         const Status status = document.run(command, arguments, Job());
         return status ? std::string("accepted") : status.error().message;
      };
      QCOMPARE(refused("remove-reference-mesh", {{"name", "hand"}}),
               std::string("remove-reference-mesh: there is no reference mesh \"hand\""));
      QVERIFY(refused("reference-mesh", {{"name", "hand"}}).find("file") != std::string::npos);
      QVERIFY(refused("reference-mesh", {{"name", ""}, {"file", "a.stl"}}).find("name") != std::string::npos);
      QVERIFY(refused("reference-mesh", {{"name", "a"}, {"file", "a.stl"}, {"unit_m", -1}}).find("unit_m") !=
              std::string::npos);
      QVERIFY(document.design().referenceMeshes.empty());
   }

   void documentsKeepThem()
   {
      Document document = cubes();
      DIATOM_VERIFY_OK(document.run(
          "reference-mesh",
          {{"name", "hand"}, {"file", "meshes/hand.obj"}, {"unit_m", 0.0254}, {"position_m", {0, 0, 0.5}}},
          Job()));
      DIATOM_VERIFY_OK(document.run("reference-mesh",
                                    {{"name", "table"}, {"file", "/table.stl"}, {"shown", false}}, Job()));
      const auto bytes = writeDesign(document.design(), false, Job());
      DIATOM_VERIFY_OK(bytes);
      const auto again = readDesign(*bytes, "again.diatom", Job());
      DIATOM_VERIFY_OK(again);
      QVERIFY(again->notes.empty());
      QVERIFY(again->design.referenceMeshes == document.design().referenceMeshes);
      QVERIFY(again->design.hash() == document.design().hash());

      json twice = json::parse(*bytes);
      twice["reference_meshes"].push_back(twice["reference_meshes"][0]);
      const auto refused = readDesign(twice.dump(), "twice.diatom", Job());
      QVERIFY(!refused);
      QCOMPARE(refused.error().message,
               std::string("twice.diatom: /reference_meshes/2/name: there are two reference meshes \"hand\"; "
                           "rename one"));
   }

   void theyAreFoundWhereverTheDocumentIsSaved()
   {
      const QTemporaryDir folder;
      const fs::path root = folder.path().toStdString();
      fs::create_directories(root / "designs/meshes");
      fs::create_directories(root / "elsewhere");
      Document document = cubes();
      const std::string mesh = (root / "designs/meshes/hand.obj").string();
      DIATOM_VERIFY_OK(document.run("reference-mesh", {{"name", "hand"}, {"file", mesh}}, Job()));
      const auto inFile = [](const fs::path &file) {
         const auto text = readFile(file);
         return text ? json::parse(*text)["reference_meshes"][0]["file"].get<std::string>() : "unreadable";
      };
      const fs::path near = root / "designs/a.diatom", far = root / "elsewhere/a.diatom";
      DIATOM_VERIFY_OK(saveDesign(document.design(), near, Job()));
      QCOMPARE(inFile(near), std::string("meshes/hand.obj")); // the folder may be moved as a whole
      const auto opened = openDesign(near, Job());
      DIATOM_VERIFY_OK(opened);
      QCOMPARE(opened->design.referenceMeshes[0].file, mesh);
      DIATOM_VERIFY_OK(saveDesign(opened->design, far, Job()));
      QCOMPARE(inFile(far), mesh);
      fs::rename(root / "designs", root / "moved");
      const auto moved = openDesign(root / "moved/a.diatom", Job());
      DIATOM_VERIFY_OK(moved);
      QCOMPARE(moved->design.referenceMeshes[0].file, (root / "moved/meshes/hand.obj").string());
      QVERIFY(moved->design.hash() == document.design().hash()); // the same design at another place
   }

   void theyAreReadInPlace()
   {
      if (!canReadMeshes())
         QSKIP("this build reads no meshes (libassimp-dev)");
      const QTemporaryDir folder;
      const fs::path path = folder.path().toStdString();
      DIATOM_VERIFY_OK(writeFileAtomic(path / "corner.obj", kTriangle));
      const std::string corner = (path / "corner.obj").string();
      const std::vector<ReferenceMesh> references = {
          {"inches", corner, 0.0254, {10, 20, 30}, true},
          {"custom", corner, 0, {0, 0, 0}, true},
          {"hidden", corner, 0, {0, 0, 0}, false},
          {"gone", (path / "gone.obj").string(), 0, {0, 0, 0}, true}};
      const auto loaded = loadReferenceMeshes(references, Job());
      DIATOM_VERIFY_OK(loaded);
      QCOMPARE(loaded->meshes.size(), std::size_t(2));
      // Rounding of one product and one sum.
      const auto inches = loaded->meshes[0].bounds(), custom = loaded->meshes[1].bounds();
      QVERIFY((inches.max() - Vec3(10.0254, 20.0508, 30.0762)).norm() <
              1e-6); // vertices come in single precision
      QVERIFY((inches.min() - Vec3(10, 20, 30)).norm() < 1e-6);
      QVERIFY((custom.max() - Vec3(1e-3, 2e-3, 3e-3)).norm() < 1e-9); // millimetres by custom
      QCOMPARE(loaded->notes.size(), std::size_t(1));
      QVERIFY(loaded->notes[0].starts_with("the reference mesh \"gone\" is not shown: "));
      QVERIFY(loaded->notes[0].find("gone.obj") != std::string::npos);
   }
};

QTEST_APPLESS_MAIN(FormatsReferenceTest)
#include "formats_reference_test.moc"
