#pragma once
// A soft body in a substep's contacts: the data that it shares with its model, and its particles' motion.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "ppu/contacts/known_sides.h"
#include "ppu/surfaces/contact_surface.h"
#include "ppu/surfaces/flat_layer.h"
#include "ppu/surfaces/inner_places.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::ppu {

/// A point of a body: eight particles and their shares, which sum to 1.
struct Anchor {
  static constexpr std::uint32_t kNoCell = ~0u;
  std::uint32_t cell = kNoCell;
  std::array<std::uint32_t, 8> particle{};
  std::array<float, 8> share{};

  Eigen::Vector3f of(std::span<const Eigen::Vector3f> values) const {
    // Number by number: with vectors, GCC packs and unpacks two of three numbers each time, which takes half as long again.
    float x = 0, y = 0, z = 0;
    for (std::size_t k = 0; k < 8; ++k) {
      const Eigen::Vector3f& value = values[particle[k]];
      x += share[k] * value.x();
      y += share[k] * value.y();
      z += share[k] * value.z();
    }
    return {x, y, z};
  }
  void add(std::span<Eigen::Vector3f> values, std::span<const float> inverse_masses,
           const Eigen::Vector3f& impulse) const {
    for (std::size_t k = 0; k < 8; ++k)
      values[particle[k]] += share[k] * inverse_masses[particle[k]] * impulse;
  }
  float share_of(std::uint32_t of) const {
    float sum = 0;
    for (std::size_t k = 0; k < 8; ++k)
      if (particle[k] == of) sum += share[k];
    return sum;
  }
  /// 1/kg: the anchor's own change of velocity by an impulse of 1.
  float mobility(std::span<const float> inverse_masses) const {
    float sum = 0;
    for (std::size_t k = 0; k < 8; ++k) sum += share[k] * share[k] * inverse_masses[particle[k]];
    return sum;
  }
};

/// The place `xi` of a cell.
Anchor anchor_in_cell(const Lattice<3>& lattice, std::uint32_t cell, const Eigen::Vector3f& xi);

/// A point of a body that collides: a point of its surface, or a particle, which is a corner of the first cell that has it.
struct TouchPoint {
  Anchor anchor;
  Eigen::Vector3f xi{0, 0, 0};  ///< in the anchor's cell
  float allowance = 0;          ///< metres: how deep in others it may be
};

/// What contacts need of a model: its lattice, its surface and its particles' masses. Immutable.
class ContactModel {
 public:
  explicit ContactModel(std::shared_ptr<const SoftBodyModel<3>> model);
  /// For a piece of a broken body, in a fraction of the time.
  /// @param whole  made from the model's whole()
  ContactModel(std::shared_ptr<const SoftBodyModel<3>> piece, const ContactModel& whole);
  /// For a model in two dimensions.
  explicit ContactModel(const FlatLayer& layer);
  ContactModel(const ContactModel&) = delete;
  ContactModel& operator=(const ContactModel&) = delete;

  /// Null for a model in two dimensions.
  const std::shared_ptr<const SoftBodyModel<3>>& model() const { return model_; }
  const Lattice<3>& lattice() const { return *lattice_; }
  std::span<const float> masses() const { return masses_; }  ///< kg, of each particle
  float mass() const { return mass_; }                       ///< kg, of the body
  /// Metres: extent of the lattice along the axis along which it is thinnest.
  float thickness() const { return thickness_; }

  bool is_flat() const { return !margin_cells_.empty(); }
  /// Whether a cell is not one of the body's own.
  bool is_margin(std::uint32_t cell) const { return is_flat() && margin_cells_[cell].beside != cell; }
  /// The cell, of the body or of a margin, that contains a place given in cells from the lattice's grid index 0.
  std::optional<std::uint32_t> cell_at(const Eigen::Vector3f& place) const;
  /// The same place as an anchor in one of the body's own cells.
  Anchor held(const Anchor& anchor) const;

  ContactSurface surface;
  std::vector<TouchPoint> touch_points;      ///< ascending by cell
  std::vector<std::uint32_t> first_of_cell;  ///< for each cell its first touch point; then the number of all
  /// For each cell its first touch point that is a particle.
  std::vector<std::uint32_t> first_particle_of_cell;
  /// Of each cell: a place well inside of the body, near the cell (inner_places.h).
  std::vector<CellPlace> inner_places;
  std::vector<float> inverse_masses;       ///< 1/kg, of each particle
  std::vector<float> root_masses;          ///< sqrt(kg), of each particle
  std::vector<std::uint32_t> crack_sides;  ///< of each cell (crack_sides.h); empty: there are no cracks

 private:
  void place_touch_points();
  void weigh();
  void measure_thickness();

  std::shared_ptr<const SoftBodyModel<3>> model_;
  std::shared_ptr<const Lattice<3>> lattice_;
  std::vector<float> own_masses_;  // of a flat body
  std::span<const float> masses_;
  float mass_ = 0;
  float thickness_ = 0;
  std::vector<MarginCell> margin_cells_;  // empty for a body in three dimensions
  std::size_t own_count_ = 0;             // number of the body's own cells, which come first
};

/// A place well inside a body, near one of its cells, in metres. @param positions  of the body's particles
Eigen::Vector3f inner_place(const ContactModel& model, std::uint32_t cell,
                            std::span<const Eigen::Vector3f> positions);

struct ContactBody;

/// Takes a share of the relative motion of the cell's corners off their velocities and keeps momentum and angular momentum. So the whole
/// cell feels at once what a contact does to one corner.
void stiffen(ContactBody& body, std::uint32_t cell, float share);

/// Whether the body may touch itself at the substep's end. It cannot if no particle is farther than `most` (metres) from its place in an
/// undeformed body.
bool may_be_folded(const ContactBody& body, float most);

/// One body in one substep.
struct ContactBody {
  const ContactModel* model = nullptr;
  std::span<const Eigen::Vector3f> positions;  ///< at the substep's beginning
  std::vector<Eigen::Vector3f> velocities;     ///< changed by contacts
  std::vector<Eigen::Vector3f> pushes;         ///< m/s, for this substep only: out of penetration
  std::vector<Eigen::Vector3f> ends;           ///< where particles would be at its end without contacts
  Bounds<3> box{};                             ///< around positions and ends
  Eigen::Vector3f travel{0, 0, 0};             ///< mean displacement from positions to ends, metres
  bool asleep = false;                         ///< contacts do not move it
  std::span<const float> inverse_masses;       ///< 1/kg; all 0 if the body sleeps
  /// As above, and 0 for particles that an attachment holds, so that a rigid body that presses on them feels what holds them. Empty: none
  /// is held.
  std::vector<float> inverse_masses_if_held;
  KnownSides* sides = nullptr;                   ///< of the walls near the body; not null if there are any
  std::vector<Eigen::Vector3f> held_velocities;  ///< m/s, of the held particles
  std::vector<float> held_impulses;              ///< kg m/s: what holds a held particle breaks above it
  float friction = 0.5f;
  float restitution = 0;

  float spacing() const { return model->lattice().spacing; }
  const Lattice<3>& lattice() const { return model->lattice(); }
  /// Holds a particle until the substep's end. @pre the body is awake
  void hold(std::uint32_t particle, const Eigen::Vector3f& velocity, float most_impulse);
  bool holds(std::uint32_t particle) const {
    return !inverse_masses_if_held.empty() && inverse_masses_if_held[particle] == 0;
  }
  /// Whether a held particle has a share in the anchor.
  bool holds(const Anchor& anchor) const;
  /// kg m/s: the least that breaks what holds one of the anchor's particles.
  float most_impulse_if_held(const Anchor& anchor) const;
  /// m/s: the velocity that a rigid body feels if it presses on held particles.
  Eigen::Vector3f velocity_if_held(const Anchor& anchor) const;
};

}  // namespace softcell::ppu
