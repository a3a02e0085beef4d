#include "render/renderer.h"

#include "render/cell_pass.h"
#include "render/gl.h"
#include "render/overlay_pass.h"
#include "render/shaders.h"
#include "render/surface_pass.h"

#include <algorithm>
#include <string_view>

namespace diatom::render {

double shade(const Vec3 &n)
{
   return 0.50 + 0.13 * n.z() + 0.40 * std::max(n.dot(Vec3(0.331, -0.662, 0.672)), 0.0) +
          0.13 * std::max(n.dot(Vec3(-0.696, 0.398, 0.597)), 0.0);
}

struct Renderer::Self
{
   CellPass cells;
   OverlayPass overlays;
   SurfacePass surface, references;
   Program background;
   VertexArray nothing;
   Batch boxes, grid, ghost, lines, screenFill, screenLines;
   Target scene, whole, flat; // cells and grid; with the overlay; without multisampling
   Rgba low{0xc6, 0xce, 0xd6, 255}, high{0xf0, 0xf3, 0xf6, 255};
   std::vector<SolidBox> boxList;
   std::vector<Line> gridList;
   bool stale = true, upload = true;
   Camera camera;
   Picture picture;

   void drawBackground();
   /// About an anchor, to clip space.
   Eigen::Matrix4f transformAbout(const Vec3 &anchor) const;
   void drawScene(const Eigen::Matrix4f &transform);
   void drawOverlay(const Eigen::Matrix4f &transform);
};

Renderer::Renderer() : m_self(std::make_unique<Self>()) {}
Renderer::~Renderer() = default;

Status Renderer::start()
{
   if (epoxy_gl_version() < 33)
      return Error{ErrorCode::unsupported, "Drawing needs OpenGL 3.3; update the graphics driver, or set "
                                           "LIBGL_ALWAYS_SOFTWARE=1 to draw without it."};
   if (Status status = m_self->cells.start(); !status)
      return status;
   if (Status status = m_self->overlays.start(); !status)
      return status;
   if (Status status = m_self->surface.start(); !status)
      return status;
   if (Status status = m_self->references.start(); !status)
      return status;
   return m_self->background.build("", kBackgroundVertex, kBackgroundFragment);
}

std::string Renderer::device() const
{
   const auto *text = glGetString(GL_RENDERER);
   return text ? reinterpret_cast<const char *>(text) : "";
}

bool Renderer::software() const
{
   const std::string name = device();
   return name.find("llvmpipe") != std::string::npos || name.find("softpipe") != std::string::npos ||
          name.find("SwiftShader") != std::string::npos;
}

void Renderer::setCells(const CellMesh &mesh)
{
   m_self->cells.setCells(mesh);
   m_self->stale = m_self->upload = true; // the anchor may have moved
}

void Renderer::setColors(std::span<const Rgba> bySlot)
{
   m_self->cells.setColors(bySlot);
   m_self->stale = true;
}

void Renderer::setPoses(std::span<const float> position, std::span<const float> turn)
{
   m_self->cells.setPoses(position, turn);
   m_self->stale = true;
}

void Renderer::setBoxes(std::span<const SolidBox> boxes)
{
   m_self->boxList.assign(boxes.begin(), boxes.end());
   m_self->stale = m_self->upload = true;
}

void Renderer::setSurface(const Surface &surface)
{
   m_self->surface.setSurface(surface);
   m_self->stale = true;
}

void Renderer::setReferences(const Surface &surface)
{
   m_self->references.setSurface(surface);
   m_self->stale = true;
}

void Renderer::setGrid(std::span<const Line> lines)
{
   m_self->gridList.assign(lines.begin(), lines.end());
   m_self->stale = m_self->upload = true;
}

void Renderer::setBackground(Rgba low, Rgba high)
{
   m_self->low = low;
   m_self->high = high;
   m_self->stale = true;
}

void Renderer::setOverlay(const Overlay &overlay)
{
   const Vec3 &anchor = m_self->cells.anchor();
   OverlayPass &pass = m_self->overlays;
   pass.setPolygons(m_self->ghost, overlay.ghost, anchor);
   pass.setLines(m_self->lines, overlay.lines, anchor);
   pass.setPolygons(m_self->screenFill, overlay.screenFill, Vec3::Zero());
   pass.setLines(m_self->screenLines, overlay.screenLines, Vec3::Zero());
}

void Renderer::Self::drawBackground()
{
   const auto vector = [](Rgba c) { return Eigen::Vector3f(Eigen::Vector3f(c.r, c.g, c.b) / 255.0f); };
   background.use();
   background.set("low", vector(low));
   background.set("high", vector(high));
   nothing.bind();
   glDisable(GL_DEPTH_TEST);
   glDrawArrays(GL_TRIANGLES, 0, 3);
}

Eigen::Matrix4f Renderer::Self::transformAbout(const Vec3 &anchor) const
{
   Mat4 model = Mat4::Identity();
   model.block<3, 1>(0, 3) = anchor;
   return (camera.projection() * camera.view() * model).cast<float>();
}

void Renderer::Self::drawScene(const Eigen::Matrix4f &transform)
{
   glDisable(GL_BLEND);
   glDepthMask(GL_TRUE);
   glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
   glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
   drawBackground();
   if (upload) {
      overlays.setBoxes(boxes, boxList, cells.anchor());
      overlays.setLines(grid, gridList, cells.anchor());
      upload = false;
   }
   glEnable(GL_DEPTH_TEST);
   glDepthFunc(GL_LESS);
   const auto lineWidth = static_cast<float>(0.9 * picture.scale);
   cells.draw(camera, transform, lineWidth);
   overlays.drawBoxes(boxes, transform, lineWidth);
   surface.draw(transformAbout(surface.anchor()), lineWidth);
   references.drawTranslucent(transformAbout(references.anchor()), 0.35f);
   glEnable(GL_BLEND);
   glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
   glDepthMask(GL_FALSE);
   overlays.drawLines(grid, transform, float(picture.width), float(picture.height), 1);
}

void Renderer::Self::drawOverlay(const Eigen::Matrix4f &transform)
{
   const auto width = float(picture.width), height = float(picture.height);
   glEnable(GL_BLEND);
   glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
   glEnable(GL_DEPTH_TEST);
   glDepthMask(GL_FALSE);
   glEnable(GL_CULL_FACE);
   glDepthFunc(GL_GREATER); // what lies behind the cells shines through
   overlays.drawPolygons(ghost, transform, 0.35f);
   glDisable(GL_CULL_FACE);
   overlays.drawLines(lines, transform, width, height, 0.35f);
   glEnable(GL_CULL_FACE);
   glDepthFunc(GL_LEQUAL);
   glEnable(GL_POLYGON_OFFSET_FILL); // a tint on a cell lies in the very planes of its faces
   glPolygonOffset(-1, -1);
   overlays.drawPolygons(ghost, transform, 1);
   glDisable(GL_POLYGON_OFFSET_FILL);
   glDisable(GL_CULL_FACE);
   overlays.drawLines(lines, transform, width, height, 1);

   glDisable(GL_DEPTH_TEST);
   Eigen::Matrix4f screen = Eigen::Matrix4f::Identity();
   screen(0, 0) = static_cast<float>(2 * picture.scale / picture.width);
   screen(1, 1) = static_cast<float>(-2 * picture.scale / picture.height);
   screen(0, 3) = -1;
   screen(1, 3) = 1;
   overlays.drawPolygons(screenFill, screen, 1);
   overlays.drawLines(screenLines, screen, width, height, 1);
   glDepthMask(GL_TRUE);
   glBindVertexArray(0);
   glUseProgram(0);
}

Status Renderer::draw(const Camera &camera, const Picture &picture)
{
   Self &self = *m_self;
   bool fresh = false;
   for (Target *target : {&self.scene, &self.whole}) {
      const auto made = target->ensure(picture.width, picture.height, picture.samples);
      if (!made)
         return made.error();
      fresh = fresh || *made;
   }
   if (const auto made = self.flat.ensure(picture.width, picture.height, 0); !made)
      return made.error();
   if (self.picture.scale != picture.scale)
      self.upload = true;
   self.stale = self.stale || fresh || !(camera == self.camera);
   self.camera = camera;
   self.picture = picture;
   self.overlays.setScale(static_cast<float>(picture.scale));

   const Eigen::Matrix4f transform = self.transformAbout(self.cells.anchor());
   glViewport(0, 0, picture.width, picture.height);
   glDisable(GL_SCISSOR_TEST);
   if (self.stale) {
      glBindFramebuffer(GL_FRAMEBUFFER, self.scene.name());
      self.drawScene(transform);
      self.stale = false;
   }
   const auto copy = [&](GLuint from, GLuint to, GLbitfield what) {
      glBindFramebuffer(GL_READ_FRAMEBUFFER, from);
      glBindFramebuffer(GL_DRAW_FRAMEBUFFER, to);
      glBlitFramebuffer(0, 0, picture.width, picture.height, 0, 0, picture.width, picture.height, what,
                        GL_NEAREST);
   };
   copy(self.scene.name(), self.whole.name(),
        GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
   glBindFramebuffer(GL_FRAMEBUFFER, self.whole.name());
   self.drawOverlay(transform);
   copy(self.whole.name(), self.flat.name(), GL_COLOR_BUFFER_BIT);
   return {};
}

void Renderer::copyTo(unsigned framebuffer) const
{
   const Picture &p = m_self->picture;
   glBindFramebuffer(GL_READ_FRAMEBUFFER, m_self->flat.name());
   glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
   glBlitFramebuffer(0, 0, p.width, p.height, 0, 0, p.width, p.height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
   glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
}

std::vector<std::uint8_t> Renderer::pixels() const
{
   const auto width = static_cast<std::size_t>(m_self->picture.width),
              height = static_cast<std::size_t>(m_self->picture.height);
   std::vector<std::uint8_t> rows(3 * width * height), result(rows.size());
   glBindFramebuffer(GL_READ_FRAMEBUFFER, m_self->flat.name());
   glPixelStorei(GL_PACK_ALIGNMENT, 1);
   glReadPixels(0, 0, m_self->picture.width, m_self->picture.height, GL_RGB, GL_UNSIGNED_BYTE, rows.data());
   for (std::size_t y = 0; y < height; ++y)
      std::copy_n(rows.begin() + std::ptrdiff_t(3 * width * (height - 1 - y)), 3 * width,
                  result.begin() + std::ptrdiff_t(3 * width * y));
   return result;
}

std::uint64_t Renderer::facesDrawn() const { return m_self->cells.facesDrawn(); }

} // namespace diatom::render
