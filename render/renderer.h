// Draws a scene with OpenGL 3.3 into whatever context is current: a window's or one without any display. The
// scene is kept as a picture with depth, so that moving a ghost or a selection never draws the cells again.
#pragma once

#include "core/result.h"
#include "render/camera.h"
#include "render/cell_mesh.h"
#include "render/composite_boxes.h"
#include "render/lines.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace diatom::render {

struct Surface;

/// Brightness of a face by its outward normal, 0 to about 1.
double shade(const Vec3 &normal);

/// All calls with one and the same context current, the destructor included.
class Renderer
{
public:
   Renderer();
   ~Renderer();

   /// Compiles the shaders. Errors: the driver is too old.
   Status start();
   /// "llvmpipe (...)", and whether this is a processor drawing without a graphics card.
   std::string device() const;
   bool software() const;

   /// Faces at rest; colours are grey until setColors().
   void setCells(const CellMesh &mesh);
   void setColors(std::span<const Rgba> bySlot);
   /// Poses of a running simulation by slot: x y z 0 about the mesh's anchor, and turns since rest w x y z.
   /// Empty: rest.
   void setPoses(std::span<const float> position, std::span<const float> turn);
   void setBoxes(std::span<const SolidBox> boxes);
   /// Drawn beside cells and boxes; one without corners is none.
   void setSurface(const Surface &surface);
   /// Drawn over the scene, translucent: what is designed against.
   void setReferences(const Surface &surface);
   void setGrid(std::span<const Line> lines);
   void setBackground(Rgba low, Rgba high);
   void setOverlay(const Overlay &overlay);

   /// What to draw into: size in device pixels, device pixels per logical one.
   struct Picture
   {
      int width = 0, height = 0;
      double scale = 1;
      int samples = 0;
   };
   /// Draws the scene if anything changed and the overlay on it; the result stays in memory of this object.
   Status draw(const Camera &camera, const Picture &picture);
   /// Copies the last picture to a framebuffer, or to memory as RGB rows from the top.
   void copyTo(unsigned framebuffer) const;
   std::vector<std::uint8_t> pixels() const;
   /// Faces handed to the driver for the last scene, for figures and tests.
   std::uint64_t facesDrawn() const;

private:
   struct Self;
   std::unique_ptr<Self> m_self;
};

} // namespace diatom::render
