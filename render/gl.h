// OpenGL objects that free themselves, and shader programs with errors as values. For the .cpp files of
// render/ only.
#pragma once

#include "core/result.h"
#include "core/vec.h"

#include <epoxy/gl.h>

#include <array>
#include <span>
#include <utility>

namespace diatom::render {

/// A buffer; holds its name until destroyed with the context current.
class Buffer
{
public:
   Buffer() { glGenBuffers(1, &m_name); }
   ~Buffer() { glDeleteBuffers(1, &m_name); }
   Buffer(const Buffer &) = delete;
   Buffer &operator=(const Buffer &) = delete;
   GLuint name() const { return m_name; }
   template<typename T>
   void fill(std::span<const T> data, GLenum usage = GL_STATIC_DRAW)
   {
      glBindBuffer(GL_ARRAY_BUFFER, m_name);
      glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(data.size_bytes()), data.data(), usage);
   }

private:
   GLuint m_name = 0;
};

/// A buffer that shaders read by element number.
class TextureBuffer
{
public:
   TextureBuffer() { glGenTextures(1, &m_texture); }
   ~TextureBuffer() { glDeleteTextures(1, &m_texture); }
   TextureBuffer(const TextureBuffer &) = delete;
   TextureBuffer &operator=(const TextureBuffer &) = delete;
   template<typename T>
   void fill(std::span<const T> data, GLenum format)
   {
      m_buffer.fill(data, GL_DYNAMIC_DRAW);
      glBindTexture(GL_TEXTURE_BUFFER, m_texture);
      glTexBuffer(GL_TEXTURE_BUFFER, format, m_buffer.name());
   }
   void bind(int unit) const
   {
      glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
      glBindTexture(GL_TEXTURE_BUFFER, m_texture);
   }

private:
   Buffer m_buffer;
   GLuint m_texture = 0;
};

class VertexArray
{
public:
   VertexArray() { glGenVertexArrays(1, &m_name); }
   ~VertexArray() { glDeleteVertexArrays(1, &m_name); }
   VertexArray(const VertexArray &) = delete;
   VertexArray &operator=(const VertexArray &) = delete;
   void bind() const { glBindVertexArray(m_name); }

private:
   GLuint m_name = 0;
};

/// Where an attribute begins, as the API takes it: bytes from the start of the bound buffer.
inline const void *bufferOffset(std::size_t bytes)
{
   return reinterpret_cast<const void *>(bytes); // NOLINT(performance-no-int-to-ptr)
}

/// Floats of a vertex: attribute `number`, `count` floats from byte `offset` of every `stride` bytes.
inline void floatAttribute(GLuint number, GLint count, GLsizei stride, std::size_t offset)
{
   glEnableVertexAttribArray(number);
   glVertexAttribPointer(number, count, GL_FLOAT, GL_FALSE, stride, bufferOffset(offset));
}

class Program
{
public:
   Program() = default;
   ~Program() { glDeleteProgram(m_name); }
   Program(const Program &) = delete;
   Program &operator=(const Program &) = delete;

   /// `defines` goes in front of both sources, behind the version line.
   Status build(const char *defines, const char *vertex, const char *fragment);
   void use() const { glUseProgram(m_name); }
   GLint place(const char *uniform) const { return glGetUniformLocation(m_name, uniform); }
   void set(const char *uniform, const Eigen::Matrix4f &m) const
   {
      glUniformMatrix4fv(place(uniform), 1, GL_FALSE, m.data());
   }
   void set(const char *uniform, const Eigen::Vector3f &v) const
   {
      glUniform3fv(place(uniform), 1, v.data());
   }
   void set(const char *uniform, float x, float y) const { glUniform2f(place(uniform), x, y); }
   void set(const char *uniform, float x) const { glUniform1f(place(uniform), x); }
   void set(const char *uniform, int x) const { glUniform1i(place(uniform), x); }

private:
   GLuint m_name = 0;
};

/// Colour and depth to draw into, kept until the size changes.
class Target
{
public:
   ~Target() { release(); }
   Target() = default;
   Target(const Target &) = delete;
   Target &operator=(const Target &) = delete;
   /// True when it was made anew and is therefore empty.
   Result<bool> ensure(int width, int height, int samples);
   GLuint name() const { return m_name; }

private:
   void release();
   GLuint m_name = 0;
   std::array<GLuint, 2> m_parts{};
   int m_width = 0, m_height = 0, m_samples = -1;
};

} // namespace diatom::render
