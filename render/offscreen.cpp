#include "render/offscreen.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <png.h>

#include <algorithm>

namespace diatom::render {

struct Offscreen::Context
{
   EGLDisplay display = EGL_NO_DISPLAY;
   EGLContext context = EGL_NO_CONTEXT;

   ~Context()
   {
      if (context != EGL_NO_CONTEXT) {
         eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
         eglDestroyContext(display, context);
      }
   }
};

namespace {

Error noContext(const char *what)
{
   return {
       ErrorCode::unsupported,
       fmt::format("Cannot draw without a display: {}; install Mesa's EGL (Debian: libegl1 libgl1-mesa-dri).",
                   what)};
}

} // namespace

Offscreen::Offscreen() : m_context(std::make_unique<Context>()) {}
Offscreen::~Offscreen() = default; // the renderer goes first, while its context is still current

Result<std::unique_ptr<Offscreen>> Offscreen::make()
{
   std::unique_ptr<Offscreen> result(new Offscreen);
   Context &c = *result->m_context;
   if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
      return noContext("EGL has no surfaceless platform");
   c.display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
   if (c.display == EGL_NO_DISPLAY || !eglInitialize(c.display, nullptr, nullptr) ||
       !eglBindAPI(EGL_OPENGL_API))
      return noContext("EGL does not start");
   const EGLint configWish[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                EGL_NONE};
   EGLConfig config = nullptr;
   EGLint configs = 0;
   if (!eglChooseConfig(c.display, configWish, &config, 1, &configs) || configs < 1)
      return noContext("EGL offers no configuration for OpenGL");
   const EGLint contextWish[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 3,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 3,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_NONE};
   c.context = eglCreateContext(c.display, config, EGL_NO_CONTEXT, contextWish);
   if (c.context == EGL_NO_CONTEXT || !eglMakeCurrent(c.display, EGL_NO_SURFACE, EGL_NO_SURFACE, c.context))
      return noContext("the driver has no OpenGL 3.3");
   result->m_renderer = std::make_unique<Renderer>();
   if (Status status = result->m_renderer->start(); !status)
      return status.error();
   return result;
}

Result<Image> Offscreen::picture(const Camera &camera, int width, int height)
{
   GLint largest = 0;
   glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
   if (width < 1 || height < 1 || width > largest || height > largest)
      return Error{ErrorCode::usage,
                   fmt::format("A picture of {}x{} pixels cannot be drawn here; use 1 to {} each way.", width,
                               height, largest)};
   const int factor = 2 * std::max(width, height) <= largest ? 2 : 1;
   Camera sized = camera;
   sized.resize(width, height);
   if (Status status = m_renderer->draw(sized, {factor * width, factor * height, double(factor), 0}); !status)
      return status.error();
   const auto pixels = m_renderer->pixels();
   Image image{width, height, {}};
   image.rgb.resize(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
   const auto f = static_cast<std::size_t>(factor), columns = static_cast<std::size_t>(width);
   for (std::size_t i = 0; i < image.rgb.size(); ++i) {
      const std::size_t channel = i % 3, x = i / 3 % columns, y = i / 3 / columns;
      unsigned sum = 0;
      for (std::size_t dy = 0; dy < f; ++dy)
         for (std::size_t dx = 0; dx < f; ++dx)
            sum += pixels[3 * ((y * f + dy) * columns * f + x * f + dx) + channel];
      image.rgb[i] = static_cast<std::uint8_t>((sum + f * f / 2) / (f * f));
   }
   return image;
}

Result<std::string> encodePng(const Image &image)
{
   png_image header{};
   header.version = PNG_IMAGE_VERSION;
   header.width = static_cast<png_uint_32>(image.width);
   header.height = static_cast<png_uint_32>(image.height);
   header.format = PNG_FORMAT_RGB;
   png_alloc_size_t size = 0;
   std::string bytes;
   if (png_image_write_to_memory(&header, nullptr, &size, 0, image.rgb.data(), 0, nullptr)) {
      bytes.resize(size);
      if (png_image_write_to_memory(&header, bytes.data(), &size, 0, image.rgb.data(), 0, nullptr)) {
         bytes.resize(size);
         return bytes;
      }
   }
   return Error{ErrorCode::internal,
                fmt::format("The picture cannot be written as PNG: {}.", header.message)};
}

} // namespace diatom::render
