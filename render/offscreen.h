// Pictures without a display: an EGL context without any surface, and PNG files.
#pragma once

#include "core/result.h"
#include "render/renderer.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace diatom::render {

/// RGB rows from the top.
struct Image
{
   int width = 0, height = 0;
   std::vector<std::uint8_t> rgb;
   friend bool operator==(const Image &, const Image &) = default;
};

/// A context of its own, current on the calling thread while it lives; the renderer draws in it.
class Offscreen
{
public:
   /// Errors: no EGL, or a driver without OpenGL 3.3.
   static Result<std::unique_ptr<Offscreen>> make();
   ~Offscreen();

   Renderer &renderer() { return *m_renderer; }
   /// Draws at twice the size and averages: smooth edges, the same on every machine with the same driver.
   Result<Image> picture(const Camera &camera, int width, int height);

private:
   Offscreen();
   struct Context;
   std::unique_ptr<Context> m_context;
   std::unique_ptr<Renderer> m_renderer;
};

/// The picture as a PNG file's bytes.
Result<std::string> encodePng(const Image &image);

} // namespace diatom::render
