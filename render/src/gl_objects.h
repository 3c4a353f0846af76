#pragma once
// OpenGL objects that delete themselves.

#include <glad/gl.h>

#include <cstddef>
#include <initializer_list>
#include <utility>

#include "softcell/base/assert.h"

namespace softcell::render {

/// A place in the buffer that is bound, as OpenGL takes it.
// NOLINTNEXTLINE(performance-no-int-to-ptr)
inline const void* buffer_offset(std::size_t bytes) { return reinterpret_cast<const void*>(bytes); }

/// Owns one GL name. Destroyed with its context current.
class GlObject {
 public:
  using Destroy = void (*)(const GladGLContext&, GLuint);

  GlObject() = default;
  GlObject(const GladGLContext& gl, GLuint name, Destroy destroy) : gl_(&gl), name_(name), destroy_(destroy) {
    SC_ASSERT(destroy != nullptr, "GL object {} has no function that deletes it", name);
  }
  ~GlObject() {
    if (name_ != 0) destroy_(*gl_, name_);
  }
  GlObject(GlObject&& other) noexcept
      : gl_(other.gl_), name_(std::exchange(other.name_, 0)), destroy_(other.destroy_) {}
  GlObject& operator=(GlObject&& other) noexcept {
    std::swap(gl_, other.gl_);
    std::swap(name_, other.name_);
    std::swap(destroy_, other.destroy_);
    return *this;
  }

  GLuint name() const { return name_; }

 private:
  const GladGLContext* gl_ = nullptr;
  GLuint name_ = 0;
  Destroy destroy_ = nullptr;
};

GlObject make_buffer(const GladGLContext& gl);
GlObject make_vertex_array(const GladGLContext& gl);
GlObject make_texture(const GladGLContext& gl);
GlObject make_renderbuffer(const GladGLContext& gl);
GlObject make_framebuffer(const GladGLContext& gl);

/// Compiles and links; a shader is its parts in order.
/// @throws std::runtime_error  with the driver's log.
GlObject make_program(const GladGLContext& gl, std::initializer_list<const char*> vertex_parts,
                      std::initializer_list<const char*> fragment_parts);

/// A vertex shader alone, whose output `captured` goes into the buffer bound for transform feedback.
/// @throws std::runtime_error  with the driver's log.
GlObject make_capturing_program(const GladGLContext& gl, std::initializer_list<const char*> vertex_parts,
                                const char* captured);

}  // namespace softcell::render
