#include "softcell/soft_bodies/skinned_mesh.h"

#include <stdexcept>
#include <string>
#include <utility>

#include "ppu/lattice/embedding.h"
#include "ppu/reference/skin_slots.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

namespace {

/// @param particles  their positions
void skin(const Embedding& embedding, std::span<const Eigen::Vector3f> particles,
          std::span<Eigen::Vector3f> positions, std::span<Eigen::Vector3f> normals) {
  const std::size_t vertices = embedding.slot_of_vertex.size();
  if (positions.size() != vertices || normals.size() != vertices) {
    throw std::invalid_argument("a mesh of " + std::to_string(vertices) +
                                " vertices cannot be skinned into " + std::to_string(positions.size()) +
                                " positions and " + std::to_string(normals.size()) + " normals");
  }
  SC_ASSERT(embedding.vertex_of_slot.size() == 4 * embedding.groups.size(), "{} slots in {} groups of four",
            embedding.vertex_of_slot.size(), embedding.groups.size());
  for (const SkinPart& part : embedding.parts) {
    for_each_slot(
        embedding, part, [&](std::uint32_t particle) { return particles[particle]; },
        [&](std::uint32_t slot, const SurfacePoint<float>& point) {
          const std::uint32_t vertex = embedding.vertex_of_slot[slot];
          positions[vertex] = point.position;
          normals[vertex] = point.normal;
        });
  }
}

}  // namespace

void skin(const SoftBody<3>& body, std::span<Eigen::Vector3f> positions, std::span<Eigen::Vector3f> normals) {
  skin(body.model().embedding(), body.positions(), positions, normals);
}

TriangleMesh rest_mesh(const SoftBody<3>& body) {
  TriangleMesh mesh = body.model().mesh();
  SC_ASSERT(!mesh.positions.empty(), "a body of {} particles has no mesh in its rest shape",
            body.positions().size());
  const std::vector<Eigen::Vector3f> rest = body.rest_positions();
  // A mesh may have no normals.
  std::vector<Eigen::Vector3f> normals(mesh.positions.size());
  skin(body.model().embedding(), rest, mesh.positions, normals);
  if (!mesh.normals.empty()) mesh.normals = std::move(normals);
  return mesh;
}

SkinnedMesh::SkinnedMesh(std::shared_ptr<const SoftBodyModel<3>> model)
    : model_((SC_ASSERT(model != nullptr, "a skinned mesh without a model"), std::move(model))),
      positions_(model_->mesh().positions),
      normals_(model_->mesh().normals) {}

void SkinnedMesh::update(const SoftBody<3>& body) {
  if (body.shared_model() != model_)
    throw std::invalid_argument("a skinned mesh was given a body of another model than its own");
  skin(body, positions_, normals_);
}

}  // namespace softcell::ppu
