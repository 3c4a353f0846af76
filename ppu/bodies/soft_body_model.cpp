#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "ppu/lattice/embedding.h"
#include "ppu/matching/matching_plan.h"
#include "softcell/soft_bodies/soft_body_model.h"

namespace softcell::ppu {
namespace {

std::vector<bool> corners_of_outer_cells(const Lattice& lattice) {
  const std::vector<bool> on_boundary = outer_particles(lattice);
  std::vector<bool> result = on_boundary;
  for (const auto& cell : lattice.corners) {
    if (std::none_of(cell.begin(), cell.end(), [&](std::uint32_t i) { return on_boundary[i]; })) continue;
    for (const std::uint32_t i : cell) result[i] = true;
  }
  return result;
}

}  // namespace

SoftBodyModel::SoftBodyModel(Lattice lattice, Embedding embedding, const SoftBodySettings& settings)
    : settings_(settings),
      lattice_(std::move(lattice)),
      embedding_(std::make_shared<const Embedding>(std::move(embedding))),
      masses_(particle_masses(lattice_, settings.density)),
      plan_(std::make_shared<MatchingPlan<float>>(lattice_, settings.half_width, masses_)) {
  double mass = 0;
  for (const float m : masses_) mass += m;
  mass_ = static_cast<float>(mass);

  const std::vector<bool> is_outer =
      settings.contacts ? corners_of_outer_cells(lattice_) : std::vector<bool>(lattice_.particles.size());
  for (std::uint32_t i = 0; i < is_outer.size(); ++i) (is_outer[i] ? outer_ : inner_).push_back(i);
}

const TriangleMesh& SoftBodyModel::mesh() const { return embedding_->mesh; }

std::shared_ptr<const SoftBodyModel> make_soft_body_model(const TriangleMesh& mesh,
                                                          const SoftBodySettings& settings) {
  validate(settings);
  validate(mesh);
  Lattice lattice = voxelize(mesh, settings.cell_size);
  Embedding embedding = embed(mesh, lattice);
  return std::shared_ptr<const SoftBodyModel>(
      new SoftBodyModel(std::move(lattice), std::move(embedding), settings));
}

std::shared_ptr<const SoftBodyModel> make_soft_body_model(Lattice lattice, const SoftBodySettings& settings) {
  validate(settings);
  if (lattice.spacing != settings.cell_size) {
    throw std::runtime_error("a soft body's cell_size is " + std::to_string(settings.cell_size) +
                             "; it must be the spacing of the lattice it is made from, " +
                             std::to_string(lattice.spacing));
  }
  return std::shared_ptr<const SoftBodyModel>(new SoftBodyModel(std::move(lattice), {}, settings));
}

}  // namespace softcell::ppu
