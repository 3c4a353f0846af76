#pragma once
// The surface of a soft body as floats, to be drawn: the mesh that its model was made from, deformed with the body. Vertices and indices
// are in the order of the original mesh.
//
//     SkinnedMesh skin(body.shared_model());             // once for each body
//     ...
//     skin.update(body);                                 // after each step
//     upload(skin.positions(), skin.normals());          // one of each for every vertex of skin.mesh()
//     draw(skin.mesh().triangles);                       // skin.mesh() also has texture coordinates, colours, parts
//
// The calling thread does the work, also for a body that SPEs step. With SpeSkinner (spe_bodies/spe_skinner.h) the SPEs do it, one frame
// late.

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "softcell/soft_bodies/soft_body.h"

namespace softcell::ppu {

/// Computes the present positions and normals of the vertices of body.model().mesh().
///
///   x = sum_k N_k x_k            n = normalize(cof(F) N)
///
/// with x_k the eight particles around the vertex, N_k their trilinear weights, F the cell's deformation at
/// the vertex and N the normal of the mesh as given. Where a cell is pressed flat, n is N.
///
/// @param positions  metres, world; one for each vertex of the mesh
/// @param normals    unit length, world; one for each vertex of the mesh
/// @throws std::invalid_argument  a span has another size.
/// Any thread, while nobody changes the body.
void skin(const SoftBody<3>& body, std::span<Eigen::Vector3f> positions, std::span<Eigen::Vector3f> normals);

/// The mesh of body.model() in the body's rest shape, with all its attributes: the shape of a plastic body without loads. Bodies of a model
/// made from this mesh have the dents from the beginning. @pre the model has a mesh
TriangleMesh rest_mesh(const SoftBody<3>& body);

/// A deformed mesh with memory of its own. Used by one thread at a time.
class SkinnedMesh {
 public:
  /// The original mesh, around the model's own origin. A model without a mesh has no vertices. @pre the model is not null
  explicit SkinnedMesh(std::shared_ptr<const SoftBodyModel<3>> model);

  /// Computes positions and normals of the body as it is now. Allocates nothing.
  /// @throws std::invalid_argument  the body has another model.
  void update(const SoftBody<3>& body);

  std::span<const Eigen::Vector3f> positions() const { return positions_; }  ///< metres, of each vertex
  std::span<const Eigen::Vector3f> normals() const { return normals_; }      ///< unit vectors, of each vertex

  /// The mesh at rest. The deformed one has the same triangles, texture coordinates, colours and parts.
  const TriangleMesh& mesh() const { return model_->mesh(); }

 private:
  std::shared_ptr<const SoftBodyModel<3>> model_;
  std::vector<Eigen::Vector3f> positions_, normals_;
};

}  // namespace softcell::ppu
