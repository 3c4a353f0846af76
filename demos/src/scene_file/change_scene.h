#pragma once
// The changes that a user makes to a running scene: another body, one body less, another density. Each changes the scene so that it begins
// at the moment of the change; a new simulation takes it over.

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "save_scene.h"

namespace softcell::demos {

/// The scene in its present state: its parameters, its document and its beginning.
/// @throws std::runtime_error  the scene was made by a program and has no document
Scene scene_now(const Scene& scene, const PresentScene<3>& now);
Scene2d scene_now(const Scene2d& scene, const PresentScene<2>& now);

/// The shapes that need no file, by the names that scene files use.
std::span<const std::string_view> spawned_shapes(int dimension);

/// Size, stiffness and place of a new body.
template <int Dimension>
struct NewBody {
  /// The middle of its box, metres.
  Eigen::Matrix<float, Dimension, 1> middle = Eigen::Matrix<float, Dimension, 1>::Zero();
  float longest_side = 1;  ///< metres
  float alpha = 0.5f;      ///< see ppu::SoftBodySettings
};

/// Adds a soft body that is made as --mesh or --image makes one, undeformed and at rest. The rest of its material is that of the scene's
/// first soft body.
/// @param file  glTF, OBJ, PLY or STL; in 2D PNG
/// @throws std::runtime_error  one sentence: no such file, or the scene would be too large. The scene is then unchanged.
void add_file(Scene& scene, const std::filesystem::path& file, const NewBody<3>& body);
void add_file(Scene2d& scene, const std::filesystem::path& file, const NewBody<2>& body);
/// Adds one of spawned_shapes(). @throws std::runtime_error  the scene would be too large
void add_shape(Scene& scene, std::string_view shape, const NewBody<3>& body);
void add_shape(Scene2d& scene, std::string_view shape, const NewBody<2>& body);

/// Removes a soft body, its attachments, and the events of the script that concern it. @pre there is such a body
void remove_body(Scene& scene, std::size_t body);
void remove_body(Scene2d& scene, std::size_t body);

/// @param density  kg/m^3; in 2D kg/m^2  @pre there is such a body; the density is in the range of scene files
void set_density(Scene& scene, std::size_t body, float density);
void set_density(Scene2d& scene, std::size_t body, float density);

}  // namespace softcell::demos
