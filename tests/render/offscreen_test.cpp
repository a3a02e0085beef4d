// Pictures drawn without a display.
#include "render/design_overlay.h"
#include "render/offscreen.h"
#include "render/scene_view.h"
#include "scenes.h"

using namespace diatom;
using namespace diatom::render;
using namespace diatom::test;

namespace {

std::shared_ptr<const Hierarchy> block(const std::string &id)
{
   return std::make_shared<const Hierarchy>(makeLattice(id), randomModel(id, 3, 0.6, 5));
}

Camera cameraFor(const SceneView &view)
{
   Camera camera;
   camera.resize(320, 240);
   camera.look(ViewDirection::iso);
   camera.setReach(view.reach());
   camera.fit(view.bounds());
   return camera;
}

std::size_t different(const Image &a, const Image &b)
{
   std::size_t count = 0;
   for (std::size_t i = 0; i < a.rgb.size(); i += 3)
      count += !std::equal(a.rgb.begin() + long(i), a.rgb.begin() + long(i) + 3, b.rgb.begin() + long(i));
   return count;
}

Image draw(Offscreen &screen, SceneView &view, const Camera &camera, const Overlay &overlay = {})
{
   view.upload(screen.renderer());
   screen.renderer().setOverlay(overlay);
   auto image = screen.picture(camera, 320, 240);
   if (!image.ok())
      qFatal("%s", image.error().message.c_str());
   return *image;
}

} // namespace

class OffscreenTest : public QObject
{
   Q_OBJECT

private slots:
   void everyLatticeIsDrawnTheSameEachTime_data()
   {
      QTest::addColumn<QString>("lattice");
      for (const std::string &id : latticeIds())
         QTest::newRow(id.c_str()) << QString::fromStdString(id);
   }

   void everyLatticeIsDrawnTheSameEachTime()
   {
      QFETCH(QString, lattice);
      const auto hierarchy = block(lattice.toStdString());
      Image first;
      for (int round = 0; round < 2; ++round) {
         auto screen = Offscreen::make();
         DIATOM_VERIFY_OK(screen);
         SceneView empty, view;
         empty.setDesign(nullptr, false, false);
         view.setDesign(hierarchy, false, false);
         const Camera camera = cameraFor(view);
         const Image background = draw(**screen, empty, camera);
         const Image image = draw(**screen, view, camera);
         // A fitted block covers well over a tenth of the picture, and not all of it.
         const std::size_t covered = different(image, background);
         QVERIFY2(covered > 7680 && covered < 76800, qPrintable(QString::number(covered)));
         if (round == 0)
            first = image;
         else
            QCOMPARE(different(first, image), std::size_t(0));
      }
   }

   void facesTurnedAwayAreNotHandedToTheDriver()
   {
      auto screen = Offscreen::make();
      DIATOM_VERIFY_OK(screen);
      SceneView view;
      Model model = emptyModel(LatticeSpec{}.id);
      model.root.cells.fill({{0, 0, 0}, {9, 9, 9}}, Cell{1, 0, 0});
      view.setDesign(std::make_shared<const Hierarchy>(makeLattice(LatticeSpec{}.id), model), false, false);
      QCOMPARE(view.faces(), std::uint64_t(600));
      draw(**screen, view, cameraFor(view));
      QCOMPARE((*screen)->renderer().facesDrawn(), std::uint64_t(300)); // three of six sides
   }

   void posesMoveCellsAndRestReturnsTheFirstPicture()
   {
      auto screen = Offscreen::make();
      DIATOM_VERIFY_OK(screen);
      const auto hierarchy = block(LatticeSpec{}.id);
      SceneView view;
      view.setDesign(hierarchy, false, true);
      const Camera camera = cameraFor(view);
      const Image rest = draw(**screen, view, camera);

      auto moment = std::make_shared<Moment>();
      std::vector<Index> indices;
      hierarchy->visit(hierarchy->bounds(), [&](Index i, Cell) {
         indices.push_back(i);
         return true;
      });
      std::sort(indices.begin(), indices.end());
      for (const Index i : indices) {
         const Vec3 at = hierarchy->lattice().position(i) + Vec3(0, 0, 1e-3);
         moment->frame.position.insert(moment->frame.position.end(), at.data(), at.data() + 3);
         moment->frame.rotation.insert(moment->frame.rotation.end(), {1, 0, 0, 0});
         moment->values.push_back(1e-3);
      }
      moment->highest = 1e-3;
      moment->indices = std::make_shared<const std::vector<Index>>(indices);
      view.setFrame(moment, false);
      const Vec3 lifted = view.position(indices[0]) - hierarchy->lattice().position(indices[0]);
      QVERIFY((lifted - Vec3(0, 0, 1e-3)).norm() < 1e-15);
      const Image moved = draw(**screen, view, camera);
      QVERIFY(different(rest, moved) > 3000);
      view.setFrame(moment, true);
      QVERIFY(different(moved, draw(**screen, view, camera)) > 3000);
      view.setFrame(nullptr, true);
      QCOMPARE(different(rest, draw(**screen, view, camera)), std::size_t(0));
   }

   void overlaysComeAndGoWithoutATrace()
   {
      auto screen = Offscreen::make();
      DIATOM_VERIFY_OK(screen);
      const auto hierarchy = block(LatticeSpec{}.id);
      SceneView view;
      view.setDesign(hierarchy, false, true);
      const Camera camera = cameraFor(view);
      const Image plain = draw(**screen, view, camera);
      Overlay ghost, legend;
      addGhost(ghost, hierarchy->lattice(), {0, 0, 5}, {60, 120, 190, 170}, {30, 110, 220, 255});
      addLegend(legend, camera, lengthLegend("displacement", 2e-3), {0, 0, 0, 255});
      QVERIFY(different(plain, draw(**screen, view, camera, ghost)) > 50);
      QVERIFY(different(plain, draw(**screen, view, camera, legend)) > 1000);
      QCOMPARE(different(plain, draw(**screen, view, camera)), std::size_t(0));
   }

   void picturesBecomePngFilesOfTheirSize()
   {
      const Image image{3, 2, std::vector<std::uint8_t>(18, 200)};
      const auto png = encodePng(image);
      DIATOM_VERIFY_OK(png);
      QVERIFY(png->substr(1, 3) == "PNG");
      QCOMPARE(int(std::uint8_t((*png)[19])),
               3); // width and height in the header chunk (PNG specification 11.2.2)
      QCOMPARE(int(std::uint8_t((*png)[23])), 2);
   }

   void picturesTooLargeAreRefusedWithASentence()
   {
      auto screen = Offscreen::make();
      DIATOM_VERIFY_OK(screen);
      const auto image = (*screen)->picture(Camera(), 1 << 20, 10);
      QVERIFY(!image.ok());
      QVERIFY(image.error().message.find("cannot be drawn") != std::string::npos);
   }
};

QTEST_APPLESS_MAIN(OffscreenTest)
#include "offscreen_test.moc"
