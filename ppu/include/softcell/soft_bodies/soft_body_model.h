#pragma once
// Data that all soft bodies of one kind share: the lattice, its masses, and constants computed from them once.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "softcell/soft_bodies/lattice.h"
#include "softcell/soft_bodies/mesh.h"
#include "softcell/soft_bodies/soft_body_settings.h"

namespace softcell::ppu {

template <int kDimension>
struct Cracks;
struct Embedding;
template <typename Real, int kDimension>
class MatchingPlan;
template <int kDimension>
class RestLattice;

/// The data that bodies of one kind share. No public function changes it, so any thread may read it.
/// @tparam kDimension  2 or 3
template <int kDimension>
class SoftBodyModel {
 public:
  const SoftBodySettings& settings() const { return settings_; }   ///< as passed when the model was made
  const Lattice<kDimension>& lattice() const { return lattice_; }  ///< at rest, in the mesh's own frame
  std::size_t particles() const { return masses_.size(); }         ///< their number
  std::span<const float> masses() const { return masses_; }        ///< kg, of each particle
  float mass() const { return mass_; }                             ///< kg, of the body

  /// Numbers of the outer particles, ascending; a body without contacts has none. With ContactMethod::kSpheres these particles collide;
  /// else what is drawn does.
  ///
  /// In two dimensions a particle is outer if fewer than four cells surround it; in a piece, the next particles behind its cuts are outer,
  /// too. In three dimensions all corners of the cells at the lattice's boundary are outer, so outer particles form two layers. One layer
  /// would keep other things out, but a body that is pressed flat on a floor would push its second layer, which also carries the mesh,
  /// through the first layer and the floor.
  std::span<const std::uint32_t> outer() const { return outer_; }
  std::span<const std::uint32_t> inner() const { return inner_; }  ///< all others, ascending

  /// Radius in metres of the circle or sphere with which an outer particle collides.
  ///
  /// In three dimensions the mesh lies inside its lattice, and every mesh vertex between the eight corners of its cell: while no particle's
  /// centre is below a floor, the mesh is not below it either. The radius only adds distance between the mesh and what it lies on. It is
  /// 0.15 cells for all bodies, as small as contacts work well with; the mesh's lowest point comes to rest that much above the floor, plus
  /// its own distance to the lattice's boundary.
  ///
  /// In two dimensions it is a parameter of make_soft_body_model(). Circles of half a cell, the default, touch each other: nothing gets
  /// between the particles of a body, and other things stop half a cell before the drawn shape. Smaller circles let small things in.
  float contact_radius() const { return contact_radius_in_cells_ * lattice_.spacing; }
  /// Contact radius of one particle, metres. In two dimensions particles at a cut have half of it: no material reaches beyond a cut.
  float contact_radius(std::size_t particle) const {
    return is_at_cut(particle) ? contact_radius() / 2 : contact_radius();
  }
  /// Whether a particle of a piece in two dimensions lies at a cut: fewer cells have it than in the whole.
  bool is_at_cut(std::size_t particle) const { return !at_cut_.empty() && at_cut_[particle]; }
  static constexpr float kContactRadiusInCells = kDimension == 2 ? 0.5f : 0.15f;

  /// Radius in metres of an outer particle's sphere towards particles of other soft bodies. A particle must touch a lattice of equal cells
  /// wherever it arrives, also in the middle of a face: 2 r > s / sqrt(2). Some reserve is needed, because a face gives way: at 0.40 cells
  /// 5 of 30 pairs of balls came to rest inside each other, at 0.45 none.
  float soft_contact_radius() const requires(kDimension == 3) {
    return kSoftContactRadiusInCells * lattice_.spacing;
  }
  static constexpr float kSoftContactRadiusInCells = 0.45f;

  /// The mesh that the model was made from, with its attributes, at rest; empty for a model made from a lattice alone. skinned_mesh.h
  /// deforms it.
  const TriangleMesh& mesh() const requires(kDimension == 3);

  // For solvers and for skinning.

  /// The mesh in its lattice; empty for a model made from a lattice alone. For an owner that outlives the
  /// model, alias the pointer: std::shared_ptr<const Embedding>(model, &model->embedding()).
  const Embedding& embedding() const requires(kDimension == 3) { return *embedding_; }
  /// Constants of its particles and regions.
  const std::shared_ptr<const MatchingPlan<float, kDimension>>& plan() const { return plan_; }
  /// Data with which plastic bodies of this model flow. The first call makes it, which takes 6 ms for 1,000 particles; a model with a
  /// plasticity in its settings has it from the beginning.
  /// @throws std::runtime_error  the model has too many particles for plastic bodies; the message says how many it may have.
  const std::shared_ptr<const RestLattice<kDimension>>& rest_lattice() const;
  /// Where the model's bodies can break, and where they are broken. The first call makes it, which takes some milliseconds; a model with a
  /// fracture in its settings has it from the beginning.
  const Cracks<kDimension>& cracks() const;
  /// Whether this is the model of a piece of a broken body (fracture.h).
  bool is_piece() const { return whole_ != nullptr; }
  /// The model of the body before it first broke; null if this is not the model of a piece.
  const std::shared_ptr<const SoftBodyModel>& whole() const { return whole_; }

 private:
  friend struct SoftBodyModelMaker;
  SoftBodyModel(Lattice<kDimension> lattice, std::shared_ptr<const Embedding> embedding,
                const SoftBodySettings& settings, float contact_radius_in_cells,
                std::shared_ptr<const MatchingPlan<float, kDimension>> plan = nullptr,
                std::vector<bool> at_cut = {});

  SoftBodySettings settings_;
  Lattice<kDimension> lattice_;
  std::shared_ptr<const Embedding> embedding_;  // null in two dimensions
  std::vector<float> masses_;
  float mass_;
  float contact_radius_in_cells_;
  std::vector<bool> at_cut_;  // of each particle; empty: none is
  std::vector<std::uint32_t> outer_, inner_;
  std::shared_ptr<const MatchingPlan<float, kDimension>> plan_;
  mutable std::once_flag rest_lattice_made_;
  mutable std::shared_ptr<const RestLattice<kDimension>> rest_lattice_;
  std::vector<float> strengths_;  // of each cell; empty: 1
  std::shared_ptr<const SoftBodyModel> whole_;
  mutable std::once_flag cracks_made_;
  mutable std::shared_ptr<const Cracks<kDimension>> cracks_;
};

extern template class SoftBodyModel<2>;
extern template class SoftBodyModel<3>;

/// Covers the mesh with a lattice, finds its regions, embeds the mesh. Deterministic.
/// @throws std::runtime_error  as validate() of settings, voxelize(), find_regions() and embed().
/// @throws std::invalid_argument  as validate() of meshes.
std::shared_ptr<const SoftBodyModel<3>> make_soft_body_model(const TriangleMesh& mesh,
                                                             const SoftBodySettings& settings);

/// The strength of the material at a place of the mesh or lattice at rest (metres): a factor for the limits of SoftBodySettings::fracture.
/// 0 or above, and finite. An empty function is 1 everywhere.
/// @tparam kDimension  2 or 3
template <int kDimension>
using StrengthField = std::function<float(const Eigen::Vector<float, kDimension>&)>;

/// The same for a body that breaks more easily in some places: the strength of a cell is that of its middle.
/// @throws std::runtime_error  as above; a strength out of range.
std::shared_ptr<const SoftBodyModel<3>> make_soft_body_model(const TriangleMesh& mesh,
                                                             const SoftBodySettings& settings,
                                                             const StrengthField<3>& strength);

/// A model without a mesh.
/// @throws std::runtime_error  as validate() and find_regions(); a cell size that is not the lattice's
///         spacing.
std::shared_ptr<const SoftBodyModel<3>> make_soft_body_model(Lattice<3> lattice,
                                                             const SoftBodySettings& settings);
/// The same for a body that breaks more easily in some places: the strength of a cell is that of its middle.
/// @throws std::runtime_error  as above; a strength out of range.
std::shared_ptr<const SoftBodyModel<3>> make_soft_body_model(Lattice<3> lattice,
                                                             const SoftBodySettings& settings,
                                                             const StrengthField<3>& strength);

/// A model in two dimensions.
/// @param contact_radius_in_cells  above 0 and at most 1.
/// @throws std::runtime_error  as above; a contact radius out of range.
std::shared_ptr<const SoftBodyModel<2>> make_soft_body_model(
    Lattice<2> lattice, const SoftBodySettings& settings,
    float contact_radius_in_cells = SoftBodyModel<2>::kContactRadiusInCells);

/// The same for a body that breaks more easily in some places: the strength of a cell is that of its middle.
/// @throws std::runtime_error  as above; a strength out of range.
std::shared_ptr<const SoftBodyModel<2>> make_soft_body_model(Lattice<2> lattice,
                                                             const SoftBodySettings& settings,
                                                             float contact_radius_in_cells,
                                                             const StrengthField<2>& strength);

}  // namespace softcell::ppu
