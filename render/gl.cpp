#include "render/gl.h"

#include <fmt/format.h>

#include <string>

namespace diatom::render {

namespace {

Status compile(GLuint shader, const char *defines, const char *source)
{
   const std::array<const char *, 3> texts{"#version 330 core\n", defines, source};
   glShaderSource(shader, 3, texts.data(), nullptr);
   glCompileShader(shader);
   GLint good = 0;
   glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
   if (good)
      return {};
   std::string log(1000, '\0');
   GLsizei length = 0;
   glGetShaderInfoLog(shader, GLsizei(log.size()), &length, log.data());
   log.resize(static_cast<std::size_t>(length));
   return Error{ErrorCode::unsupported,
                fmt::format("The graphics driver refuses a shader: {} Update the driver, or set "
                            "LIBGL_ALWAYS_SOFTWARE=1 to draw without it.",
                            log)};
}

} // namespace

Status Program::build(const char *defines, const char *vertex, const char *fragment)
{
   m_name = glCreateProgram();
   const GLuint shaders[] = {glCreateShader(GL_VERTEX_SHADER), glCreateShader(GL_FRAGMENT_SHADER)};
   Status status = compile(shaders[0], defines, vertex);
   if (status)
      status = compile(shaders[1], defines, fragment);
   for (const GLuint shader : shaders)
      glAttachShader(m_name, shader);
   glLinkProgram(m_name);
   for (const GLuint shader : shaders)
      glDeleteShader(shader);
   GLint linked = 0;
   glGetProgramiv(m_name, GL_LINK_STATUS, &linked);
   if (status && !linked)
      return Error{ErrorCode::unsupported,
                   "The graphics driver cannot link a shader program; update the driver, or set "
                   "LIBGL_ALWAYS_SOFTWARE=1 to draw without it."};
   return status;
}

Result<bool> Target::ensure(int width, int height, int samples)
{
   if (m_name && width == m_width && height == m_height && samples == m_samples)
      return false;
   release();
   m_width = width;
   m_height = height;
   m_samples = samples;
   glGenFramebuffers(1, &m_name);
   glBindFramebuffer(GL_FRAMEBUFFER, m_name);
   glGenRenderbuffers(2, m_parts.data());
   const GLenum formats[] = {GL_RGBA8, GL_DEPTH24_STENCIL8};
   const GLenum points[] = {GL_COLOR_ATTACHMENT0, GL_DEPTH_STENCIL_ATTACHMENT};
   for (std::size_t i = 0; i < 2; ++i) {
      glBindRenderbuffer(GL_RENDERBUFFER, m_parts[i]);
      glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, formats[i], width, height);
      glFramebufferRenderbuffer(GL_FRAMEBUFFER, points[i], GL_RENDERBUFFER, m_parts[i]);
   }
   if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
      release();
      return Error{
          ErrorCode::unsupported,
          fmt::format("The graphics driver cannot make a picture of {}x{} pixels; ask for a smaller one.",
                      width, height)};
   }
   return true;
}

void Target::release()
{
   if (!m_name)
      return;
   glDeleteFramebuffers(1, &m_name);
   glDeleteRenderbuffers(2, m_parts.data());
   m_name = 0;
}

} // namespace diatom::render
