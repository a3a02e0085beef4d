// The camera: rays and projections are each other's inverse, and moves do what they say.
#include "render/camera.h"
#include "support/support.h"

#include <random>

using namespace diatom;
using namespace diatom::render;

namespace {

Camera someCamera(bool orthographic)
{
   Camera camera;
   camera.resize(1280, 800);
   camera.look(ViewDirection::iso);
   const Bounds bounds(Vec3(-0.01, -0.02, 0), Vec3(0.03, 0.01, 0.02));
   camera.setOrthographic(orthographic);
   camera.fit(bounds);
   camera.setReach(bounds);
   return camera;
}

} // namespace

class CameraTest : public QObject
{
   Q_OBJECT

private slots:
   void raysPassThroughThePointsThatAppearThere_data()
   {
      QTest::addColumn<bool>("orthographic");
      QTest::newRow("perspective") << false;
      QTest::newRow("orthographic") << true;
   }

   void raysPassThroughThePointsThatAppearThere()
   {
      QFETCH(bool, orthographic);
      const Camera camera = someCamera(orthographic);
      std::mt19937 random(11);
      std::uniform_real_distribution<double> place(-0.02, 0.03);
      for (int i = 0; i < 200; ++i) {
         const Vec3 point(place(random), place(random), place(random));
         const auto at = camera.project(point);
         QVERIFY(at);
         const Ray ray = camera.ray(*at);
         const Vec3 off = (point - ray.origin).cross(ray.direction);
         // 1e-14 m: rounding of 1e-2 m lengths in double precision through two 4x4 products.
         QVERIFY2(off.norm() < 1e-14, qPrintable(QString::number(off.norm())));
         QVERIFY((point - ray.origin).dot(ray.direction) > 0);
      }
   }

   void fittedBoundsAreWhollyInThePictureFromEverySide()
   {
      const Bounds bounds(Vec3(-0.01, -0.02, 0), Vec3(0.03, 0.01, 0.002));
      for (const char *name : {"iso", "front", "back", "left", "right", "top", "bottom"}) {
         Camera camera;
         camera.resize(640, 480);
         camera.look(*viewDirection(name));
         camera.fit(bounds);
         for (int i = 0; i < 8; ++i) {
            const auto at = camera.project(bounds.corner(static_cast<Bounds::CornerType>(i)));
            QVERIFY(at && at->x() > 0 && at->x() < 640 && at->y() > 0 && at->y() < 480);
         }
      }
      QVERIFY(!viewDirection("sideways"));
   }

   void zoomKeepsWhatIsUnderThePointer()
   {
      Camera camera = someCamera(false);
      const Point at(200, 650);
      // A point at the target's depth: that is what stays.
      const Ray before = camera.ray(at);
      const double depth = camera.distance() / before.direction.dot(-camera.backward());
      const Vec3 point = before.at(depth);
      camera.zoom(3, at);
      QVERIFY((*camera.project(point) - at).norm() < 1e-6); // pixels; far below what is drawn
   }

   void orbitKeepsThePivotInPlaceAndZUp()
   {
      Camera camera = someCamera(false);
      const Vec3 pivot(0.01, 0, 0.01);
      const Point before = *camera.project(pivot);
      camera.orbit(90, -35, pivot);
      QVERIFY((*camera.project(pivot) - before).norm() < 1e-6);
      QVERIFY(std::abs(camera.right().z()) < 1e-15);
      camera.orbit(0, 1e6, pivot); // stops at the pole
      QVERIFY(camera.up().z() >= -1e-12);
   }

   void panMovesThePictureByThePixelsAsked()
   {
      Camera camera = someCamera(true);
      const Vec3 point(0.005, 0.001, 0.003);
      const Point before = *camera.project(point);
      camera.pan(37, -12);
      const Point moved = *camera.project(point) - before;
      QVERIFY((moved - Point(37, -12)).norm() < 1e-6);
   }
};

QTEST_APPLESS_MAIN(CameraTest)
#include "camera_test.moc"
