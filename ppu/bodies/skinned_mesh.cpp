#include "softcell/soft_bodies/skinned_mesh.h"

#include <stdexcept>
#include <string>
#include <utility>

#include "ppu/lattice/embedding.h"
#include "ppu/reference/trilinear.h"

namespace softcell::ppu {

void skin(const SoftBody<3>& body, std::span<Eigen::Vector3f> positions, std::span<Eigen::Vector3f> normals) {
  const Embedding& embedding = body.model().embedding();
  const std::size_t vertices = embedding.slot_of_vertex.size();
  if (positions.size() != vertices || normals.size() != vertices) {
    throw std::invalid_argument("a mesh of " + std::to_string(vertices) +
                                " vertices cannot be skinned into " + std::to_string(positions.size()) +
                                " positions and " + std::to_string(normals.size()) + " normals");
  }
  const std::span<const Eigen::Vector3f> particles = body.positions();
  std::array<Eigen::Vector3f, 8> corners;
  for (const SkinPart& part : embedding.parts) {
    for (std::uint32_t g = part.first_group; g < part.first_group + part.group_count; ++g) {
      const spu::SkinGroup& group = embedding.groups[g];
      if (group.continues[0] == 0) {
        for (std::size_t k = 0; k < 8; ++k) corners[k] = particles[part.particle(group.corner[k])];
      }
      for (std::uint32_t lane = 0; lane < 4; ++lane) {
        const std::uint32_t vertex = embedding.vertex_of_slot[4 * g + lane];
        const SurfacePoint<float> point = evaluate_trilinear<float>(
            {group.xi[lane], group.eta[lane], group.zeta[lane]},
            {group.normal_x[lane], group.normal_y[lane], group.normal_z[lane]}, corners);
        positions[vertex] = point.position;
        normals[vertex] = point.normal;
      }
    }
  }
}

SkinnedMesh::SkinnedMesh(std::shared_ptr<const SoftBodyModel<3>> model)
    : model_(std::move(model)), positions_(model_->mesh().positions), normals_(model_->mesh().normals) {}

void SkinnedMesh::update(const SoftBody<3>& body) {
  if (body.shared_model() != model_)
    throw std::invalid_argument("a skinned mesh was given a body of another model than its own");
  skin(body, positions_, normals_);
}

}  // namespace softcell::ppu
