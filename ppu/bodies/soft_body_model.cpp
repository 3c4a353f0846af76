#include "softcell/soft_bodies/soft_body_model.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "ppu/bodies/piece_model.h"
#include "ppu/lattice/embedding.h"
#include "ppu/lattice/locate.h"
#include "ppu/matching/matching_plan.h"
#include "ppu/matching/rest_lattice.h"
#include "softcell/base/assert.h"
#include "softcell/base/text.h"

namespace softcell::ppu {
namespace {

/// Marks all corners of cells that have at least one of some particles.
template <int kDimension>
void add_corners_around(const Lattice<kDimension>& lattice, const std::vector<bool>& particles,
                        std::vector<bool>& added) {
  for (const auto& cell : lattice.corners) {
    if (std::none_of(cell.begin(), cell.end(), [&](std::uint32_t i) { return particles[i]; })) continue;
    for (const std::uint32_t i : cell) added[i] = true;
  }
}

/// Behind a cut, particles collide in two layers: if the small circles at the cuts of two pieces slip past each other, they meet the large
/// ones behind.
std::vector<bool> colliding_particles(const Lattice<2>& lattice, const std::vector<bool>& at_cut) {
  std::vector<bool> result = outer_particles(lattice);
  if (!at_cut.empty()) add_corners_around(lattice, at_cut, result);
  return result;
}

std::vector<bool> colliding_particles(const Lattice<3>& lattice, const std::vector<bool>& /*at_cut*/) {
  const std::vector<bool> on_boundary = outer_particles(lattice);
  std::vector<bool> result = on_boundary;
  add_corners_around(lattice, on_boundary, result);
  return result;
}

/// For each particle of a piece: whether fewer cells have it than in the whole.
std::vector<bool> particles_at_cuts(const Lattice<2>& piece, const Lattice<2>& whole) {
  std::vector<int> lost(piece.particles.size());
  for (std::size_t i = 0; i < lost.size(); ++i)
    for (int k = 0; k < 4; ++k)
      if (find_cell<2>(whole, piece.particles[i] - Eigen::Vector2i(k & 1, k >> 1))) ++lost[i];
  for (const auto& cell : piece.corners)
    for (const std::uint32_t i : cell) --lost[i];
  std::vector<bool> at_cut;
  for (const int cells : lost) at_cut.push_back(cells > 0);
  return at_cut;
}

/// "(0.1, 2, -3)"
template <int kDimension>
std::string place_text(const Eigen::Vector<float, kDimension>& place) {
  std::string text;
  for (const float coordinate : place) text += (text.empty() ? "(" : ", ") + base::shortest(coordinate);
  return text + ")";
}

template <int kDimension>
std::vector<float> strengths_of(const Lattice<kDimension>& lattice,
                                const StrengthField<kDimension>& strength) {
  std::vector<float> strengths;
  for (std::size_t c = 0; strength && c < lattice.cells.size(); ++c) {
    const Eigen::Vector<float, kDimension> middle =
        lattice.origin + lattice.spacing * (lattice.cells[c].template cast<float>().array() + 0.5f).matrix();
    strengths.push_back(strength(middle));
    if (!(strengths.back() >= 0) || !std::isfinite(strengths.back()))
      throw std::runtime_error("the strength of a soft body at " + place_text(middle) + " is " +
                               base::shortest(strengths.back()) + "; it must be 0 or above, and finite");
  }
  return strengths;
}

void check_cell_size(const SoftBodySettings& settings, float spacing) {
  if (spacing != settings.cell_size) {
    throw std::runtime_error("a soft body's cell_size is " + base::shortest(settings.cell_size) +
                             "; it must be the spacing of the lattice it is made from, " +
                             base::shortest(spacing));
  }
}

}  // namespace

template <int kDimension>
SoftBodyModel<kDimension>::SoftBodyModel(Lattice<kDimension> lattice,
                                         std::shared_ptr<const Embedding> embedding,
                                         const SoftBodySettings& settings, float contact_radius_in_cells,
                                         std::shared_ptr<const MatchingPlan<float, kDimension>> plan,
                                         std::vector<bool> at_cut)
    : settings_(settings),
      lattice_(std::move(lattice)),
      embedding_(std::move(embedding)),
      masses_(particle_masses(lattice_, settings.density)),
      contact_radius_in_cells_(contact_radius_in_cells),
      at_cut_(std::move(at_cut)),
      plan_(plan != nullptr
                ? std::move(plan)
                : std::make_shared<MatchingPlan<float, kDimension>>(lattice_, settings.half_width, masses_)) {
  double mass = 0;
  for (const float m : masses_) mass += m;
  mass_ = static_cast<float>(mass);
  SC_ASSERT(masses_.size() == lattice_.particles.size() && mass > 0,
            "{} masses for {} particles, {} kg in all", masses_.size(), lattice_.particles.size(), mass);

  const std::vector<bool> is_outer = settings.contacts ? colliding_particles(lattice_, at_cut_)
                                                       : std::vector<bool>(lattice_.particles.size());
  for (std::uint32_t i = 0; i < is_outer.size(); ++i) (is_outer[i] ? outer_ : inner_).push_back(i);
  SC_ASSERT(outer_.size() + inner_.size() == lattice_.particles.size(),
            "{} outer and {} inner particles of {}", outer_.size(), inner_.size(), lattice_.particles.size());
  if (settings.plasticity) rest_lattice();
}

template <int kDimension>
const std::shared_ptr<const RestLattice<kDimension>>& SoftBodyModel<kDimension>::rest_lattice() const {
  if (particles() > kMaxPlasticParticles) {
    throw std::runtime_error("a plastic soft body has at most " + std::to_string(kMaxPlasticParticles) +
                             " particles; this one has " + std::to_string(particles()) +
                             ": give it larger cells");
  }
  std::call_once(rest_lattice_made_,
                 [this] { rest_lattice_ = std::make_shared<const RestLattice<kDimension>>(lattice_); });
  return rest_lattice_;
}

template <int kDimension>
const TriangleMesh& SoftBodyModel<kDimension>::mesh() const requires(kDimension == 3) {
  SC_ASSERT(embedding_ != nullptr, "a model of {} particles has no embedding", particles());
  return embedding_->mesh;
}

template <int kDimension>
const Cracks<kDimension>& SoftBodyModel<kDimension>::cracks() const {
  std::call_once(cracks_made_, [this] {
    if (cracks_) return;
    if constexpr (kDimension == 3) {
      cracks_ = std::make_shared<const Cracks<3>>(
          no_cracks(embedding_ ? &embedding_->mesh : nullptr, lattice_, strengths_));
    } else {
      cracks_ = std::make_shared<const Cracks<2>>(no_cracks(lattice_, strengths_));
    }
  });
  return *cracks_;
}

template class SoftBodyModel<2>;
template class SoftBodyModel<3>;

struct SoftBodyModelMaker {
  static std::shared_ptr<const SoftBodyModel<3>> make(Lattice<3> lattice, Embedding embedding,
                                                      const SoftBodySettings& settings,
                                                      std::vector<float> strengths) {
    std::shared_ptr<SoftBodyModel<3>> model(
        new SoftBodyModel<3>(std::move(lattice), std::make_shared<const Embedding>(std::move(embedding)),
                             settings, SoftBodyModel<3>::kContactRadiusInCells));
    model->strengths_ = std::move(strengths);
    if (settings.fracture) model->cracks();
    return model;
  }
  /// Whether nothing has come apart: the numbers of particles and cells are the same.
  template <int kDimension>
  static bool is_same(const SoftBodyModel<kDimension>& broken, const Lattice<kDimension>& lattice) {
    return lattice.particles.size() == broken.particles() &&
           lattice.cells.size() == broken.lattice().cells.size();
  }
  template <int kDimension>
  static void follow(const std::shared_ptr<const SoftBodyModel<kDimension>>& broken,
                     CrackedPiece<kDimension> piece, SoftBodyModel<kDimension>& model) {
    model.whole_ = broken->is_piece() ? broken->whole() : broken;
    model.cracks_ = std::make_shared<const Cracks<kDimension>>(std::move(piece.cracks));
  }
  static std::shared_ptr<const SoftBodyModel<3>> make(const std::shared_ptr<const SoftBodyModel<3>>& broken,
                                                      CrackedPiece<3> piece) {
    Lattice<3>& lattice = piece.part.lattice;
    const bool same = is_same(*broken, lattice);
    std::shared_ptr<const Embedding> embedding = broken->embedding_;
    if (!same)
      embedding = std::make_shared<const Embedding>(
          piece.cracks.whole ? embed(piece.mesh.mesh, piece.mesh.places, lattice) : Embedding());
    std::shared_ptr<SoftBodyModel<3>> model(
        new SoftBodyModel<3>(std::move(lattice), std::move(embedding), broken->settings(),
                             SoftBodyModel<3>::kContactRadiusInCells, same ? broken->plan() : nullptr));
    follow(broken, std::move(piece), *model);
    return model;
  }
  static std::shared_ptr<const SoftBodyModel<2>> make(Lattice<2> lattice, const SoftBodySettings& settings,
                                                      float contact_radius_in_cells,
                                                      std::vector<float> strengths) {
    std::shared_ptr<SoftBodyModel<2>> model(
        new SoftBodyModel<2>(std::move(lattice), nullptr, settings, contact_radius_in_cells));
    model->strengths_ = std::move(strengths);
    if (settings.fracture) model->cracks();
    return model;
  }
  static std::shared_ptr<const SoftBodyModel<2>> make(const std::shared_ptr<const SoftBodyModel<2>>& broken,
                                                      CrackedPiece<2> piece) {
    Lattice<2>& lattice = piece.part.lattice;
    const bool same = is_same(*broken, lattice);
    const SoftBodyModel<2>& whole = broken->is_piece() ? *broken->whole() : *broken;
    std::vector<bool> at_cut = particles_at_cuts(lattice, whole.lattice());
    std::shared_ptr<SoftBodyModel<2>> model(new SoftBodyModel<2>(
        std::move(lattice), nullptr, broken->settings(), broken->contact_radius_in_cells_,
        same ? broken->plan() : nullptr, std::move(at_cut)));
    follow(broken, std::move(piece), *model);
    return model;
  }
};

std::shared_ptr<const SoftBodyModel<3>> make_piece_model(
    const std::shared_ptr<const SoftBodyModel<3>>& broken, CrackedPiece<3> piece) {
  SC_ASSERT(broken != nullptr, "a piece of {} cells of no body", piece.part.lattice.cells.size());
  return SoftBodyModelMaker::make(broken, std::move(piece));
}
std::shared_ptr<const SoftBodyModel<2>> make_piece_model(
    const std::shared_ptr<const SoftBodyModel<2>>& broken, CrackedPiece<2> piece) {
  SC_ASSERT(broken != nullptr, "a piece of {} cells of no body", piece.part.lattice.cells.size());
  return SoftBodyModelMaker::make(broken, std::move(piece));
}

std::shared_ptr<const SoftBodyModel<3>> make_soft_body_model(const TriangleMesh& mesh,
                                                             const SoftBodySettings& settings) {
  return make_soft_body_model(mesh, settings, StrengthField<3>());
}

std::shared_ptr<const SoftBodyModel<3>> make_soft_body_model(const TriangleMesh& mesh,
                                                             const SoftBodySettings& settings,
                                                             const StrengthField<3>& strength) {
  validate(settings);
  validate(mesh);
  Lattice<3> lattice = voxelize(mesh, settings.cell_size);
  Embedding embedding = embed(mesh, lattice);
  std::vector<float> strengths = strengths_of<3>(lattice, strength);
  return SoftBodyModelMaker::make(std::move(lattice), std::move(embedding), settings, std::move(strengths));
}

std::shared_ptr<const SoftBodyModel<3>> make_soft_body_model(Lattice<3> lattice,
                                                             const SoftBodySettings& settings) {
  return make_soft_body_model(std::move(lattice), settings, StrengthField<3>());
}

std::shared_ptr<const SoftBodyModel<3>> make_soft_body_model(Lattice<3> lattice,
                                                             const SoftBodySettings& settings,
                                                             const StrengthField<3>& strength) {
  validate(settings);
  check_cell_size(settings, lattice.spacing);
  std::vector<float> strengths = strengths_of<3>(lattice, strength);
  return SoftBodyModelMaker::make(std::move(lattice), {}, settings, std::move(strengths));
}

std::shared_ptr<const SoftBodyModel<2>> make_soft_body_model(Lattice<2> lattice,
                                                             const SoftBodySettings& settings,
                                                             float contact_radius_in_cells) {
  return make_soft_body_model(std::move(lattice), settings, contact_radius_in_cells, StrengthField<2>());
}

std::shared_ptr<const SoftBodyModel<2>> make_soft_body_model(Lattice<2> lattice,
                                                             const SoftBodySettings& settings,
                                                             float contact_radius_in_cells,
                                                             const StrengthField<2>& strength) {
  validate(settings);
  check_cell_size(settings, lattice.spacing);
  if (!(contact_radius_in_cells > 0 && contact_radius_in_cells <= 1)) {
    throw std::runtime_error("a soft body's contact radius is " + base::shortest(contact_radius_in_cells) +
                             " cells; it must be above 0 and at most 1");
  }
  std::vector<float> strengths = strengths_of<2>(lattice, strength);
  return SoftBodyModelMaker::make(std::move(lattice), settings, contact_radius_in_cells,
                                  std::move(strengths));
}

}  // namespace softcell::ppu
