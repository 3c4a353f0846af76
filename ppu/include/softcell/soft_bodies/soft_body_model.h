#pragma once
// What all soft bodies of one make share: lattice, masses, and what is made of them once.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "softcell/soft_bodies/lattice.h"
#include "softcell/soft_bodies/mesh.h"
#include "softcell/soft_bodies/soft_body_settings.h"

namespace softcell::ppu {

struct Embedding;
template <typename Real, int kDimension>
class BasicMatchingPlan;

/// All that bodies of one make share. Immutable; safe to read from any thread.
class SoftBodyModel {
 public:
  const SoftBodySettings& settings() const { return settings_; }
  const Lattice& lattice() const { return lattice_; }
  std::size_t particles() const { return masses_.size(); }
  std::span<const float> masses() const { return masses_; }  ///< kg, of each particle
  float mass() const { return mass_; }                       ///< kg, of the body

  /// Particle numbers, ascending. Outer particles collide, none of a body without contacts: all corners of
  /// the cells at the lattice's boundary, which makes them two deep. One layer would keep things out, but a
  /// body that is pressed flat on a floor would push its second layer, which the mesh hangs on too, through
  /// the first and the floor.
  std::span<const std::uint32_t> outer() const { return outer_; }
  std::span<const std::uint32_t> inner() const { return inner_; }

  /// Radius in metres of the sphere with which an outer particle collides.
  ///
  /// The mesh lies inside its lattice, and every mesh vertex between the eight corners of its cell: while no
  /// particle's centre is below a floor, neither is the mesh. The radius adds nothing but distance between
  /// the mesh and what it lies on. It is as small as contacts work well with, 0.15 cells, the same for all;
  /// the mesh's lowest point comes to rest that much above the floor, plus its own distance to the lattice's
  /// boundary.
  float contact_radius() const { return kContactRadiusInCells * lattice_.spacing; }
  /// The same towards particles of other soft bodies. A particle has to meet a lattice of equal cells
  /// wherever it comes, also in the middle of a face: 2 r > s / sqrt(2), and with something to spare, because
  /// a face gives: at 0.40 cells 5 of 30 pairs of balls came to rest inside each other, at 0.45 none.
  float soft_contact_radius() const { return kSoftContactRadiusInCells * lattice_.spacing; }
  static constexpr float kContactRadiusInCells = 0.15f;
  static constexpr float kSoftContactRadiusInCells = 0.45f;

  /// The mesh that the model was made from, with its attributes, at rest; empty for a model made from a
  /// lattice alone. skinned_mesh.h has it deformed.
  const TriangleMesh& mesh() const;

  // For solvers and for skinning.

  /// The mesh in its lattice; empty for a model made from a lattice alone. For an owner that outlives the
  /// model, alias the pointer: std::shared_ptr<const Embedding>(model, &model->embedding()).
  const Embedding& embedding() const { return *embedding_; }
  /// Constants of its particles and regions.
  const std::shared_ptr<const BasicMatchingPlan<float, 3>>& plan() const { return plan_; }

 private:
  friend std::shared_ptr<const SoftBodyModel> make_soft_body_model(const TriangleMesh&,
                                                                   const SoftBodySettings&);
  friend std::shared_ptr<const SoftBodyModel> make_soft_body_model(Lattice, const SoftBodySettings&);
  SoftBodyModel(Lattice lattice, Embedding embedding, const SoftBodySettings& settings);

  SoftBodySettings settings_;
  Lattice lattice_;
  std::shared_ptr<const Embedding> embedding_;
  std::vector<float> masses_;
  float mass_;
  std::vector<std::uint32_t> outer_, inner_;
  std::shared_ptr<const BasicMatchingPlan<float, 3>> plan_;
};

/// Covers the mesh with a lattice, finds its regions, embeds the mesh. Deterministic.
/// @throws std::runtime_error  as validate() of settings, voxelize(), find_regions() and embed().
/// @throws std::invalid_argument  as validate() of meshes.
std::shared_ptr<const SoftBodyModel> make_soft_body_model(const TriangleMesh& mesh,
                                                          const SoftBodySettings& settings);

/// A model without a mesh. @pre settings.cell_size is the lattice's spacing.
/// @throws std::runtime_error  as validate() and find_regions(), and for another cell size.
std::shared_ptr<const SoftBodyModel> make_soft_body_model(Lattice lattice, const SoftBodySettings& settings);

}  // namespace softcell::ppu
