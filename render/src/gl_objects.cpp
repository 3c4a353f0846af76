#include "gl_objects.h"

#include <array>
#include <stdexcept>
#include <string>

#include "softcell/base/assert.h"

namespace softcell::render {
namespace {

GlObject compile(const GladGLContext& gl, GLenum kind, std::initializer_list<const char*> parts) {
  GlObject shader(gl, gl.CreateShader(kind),
                  [](const GladGLContext& g, GLuint name) { g.DeleteShader(name); });
  gl.ShaderSource(shader.name(), static_cast<GLsizei>(parts.size()), parts.begin(), nullptr);
  gl.CompileShader(shader.name());
  GLint compiled = 0;
  gl.GetShaderiv(shader.name(), GL_COMPILE_STATUS, &compiled);
  if (compiled == 0) {
    std::array<char, 2000> log{};
    gl.GetShaderInfoLog(shader.name(), static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw std::runtime_error(std::string("OpenGL does not compile a shader: ") + log.data());
  }
  return shader;
}

GlObject new_program(const GladGLContext& gl) {
  return {gl, gl.CreateProgram(), [](const GladGLContext& g, GLuint name) { g.DeleteProgram(name); }};
}

void link(const GladGLContext& gl, const GlObject& program, std::initializer_list<GLuint> shaders) {
  SC_ASSERT(program.name() != 0, "no program for {} shaders; is the context current?", shaders.size());
  for (const GLuint shader : shaders) gl.AttachShader(program.name(), shader);
  gl.LinkProgram(program.name());
  GLint linked = 0;
  gl.GetProgramiv(program.name(), GL_LINK_STATUS, &linked);
  if (linked == 0) {
    std::array<char, 2000> log{};
    gl.GetProgramInfoLog(program.name(), static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw std::runtime_error(std::string("OpenGL does not link a program: ") + log.data());
  }
  for (const GLuint shader : shaders) gl.DetachShader(program.name(), shader);
}

/// Makes one object by OpenGL's functions that make and delete several.
template <auto kGenerate, auto kDelete>
GlObject make_object(const GladGLContext& gl) {
  GLuint name = 0;
  (gl.*kGenerate)(1, &name);
  return {gl, name, [](const GladGLContext& g, GLuint n) { (g.*kDelete)(1, &n); }};
}

}  // namespace

GlObject make_buffer(const GladGLContext& gl) {
  return make_object<&GladGLContext::GenBuffers, &GladGLContext::DeleteBuffers>(gl);
}
GlObject make_vertex_array(const GladGLContext& gl) {
  return make_object<&GladGLContext::GenVertexArrays, &GladGLContext::DeleteVertexArrays>(gl);
}
GlObject make_texture(const GladGLContext& gl) {
  return make_object<&GladGLContext::GenTextures, &GladGLContext::DeleteTextures>(gl);
}
GlObject make_renderbuffer(const GladGLContext& gl) {
  return make_object<&GladGLContext::GenRenderbuffers, &GladGLContext::DeleteRenderbuffers>(gl);
}
GlObject make_framebuffer(const GladGLContext& gl) {
  return make_object<&GladGLContext::GenFramebuffers, &GladGLContext::DeleteFramebuffers>(gl);
}

GlObject make_program(const GladGLContext& gl, std::initializer_list<const char*> vertex_parts,
                      std::initializer_list<const char*> fragment_parts) {
  const GlObject vertex = compile(gl, GL_VERTEX_SHADER, vertex_parts);
  const GlObject fragment = compile(gl, GL_FRAGMENT_SHADER, fragment_parts);
  GlObject program = new_program(gl);
  link(gl, program, {vertex.name(), fragment.name()});
  return program;
}

GlObject make_capturing_program(const GladGLContext& gl, std::initializer_list<const char*> vertex_parts,
                                const char* captured) {
  const GlObject vertex = compile(gl, GL_VERTEX_SHADER, vertex_parts);
  GlObject program = new_program(gl);
  gl.TransformFeedbackVaryings(program.name(), 1, &captured, GL_INTERLEAVED_ATTRIBS);
  link(gl, program, {vertex.name()});
  return program;
}

}  // namespace softcell::render
