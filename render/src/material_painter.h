#pragma once
// Programs for materials: one for each combination of textures and the like, made when it is first drawn.

#include <Eigen/Core>
#include <array>
#include <memory>

#include "gl_objects.h"
#include "softcell/render/material.h"

namespace softcell::render {

class MeshStore;

class MaterialPainter {
 public:
  /// @param sun  one of the two ways in which shaders.h has sunlight; outlives this, as `gl` does
  /// @param frame_binding  of the uniform block
  MaterialPainter(const GladGLContext& gl, const char* sun, GLuint frame_binding)
      : gl_(gl), sun_(sun), frame_binding_(frame_binding) {}

  /// Binds the program and the textures of a material. @pre the context is current; the textures exist
  /// @param opacity  0..1, of the whole mesh
  void use(const Material& material, const MeshStore& meshes, const Eigen::Matrix4f& pose,
           const Eigen::Matrix3f& normal_matrix, float opacity);

  /// Whether what is drawn covers pixels by its alpha.
  static bool covers_by_alpha(const Material& material) { return material.alpha_mode != AlphaMode::kOpaque; }

 private:
  struct Program;
  Program& program(const Material& material);

  const GladGLContext& gl_;
  const char* sun_;
  GLuint frame_binding_;
  static constexpr std::size_t kKinds = 96;
  std::array<std::shared_ptr<Program>, kKinds> programs_;
};

}  // namespace softcell::render
