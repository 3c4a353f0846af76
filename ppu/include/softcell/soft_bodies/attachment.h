#pragma once
// Attachments: parts of soft bodies that are held to the world, to rigid bodies or to each other.
//
//     const AttachmentId tyre = soft_bodies.attach(ring, Patch<3>::of_surface(hub, 0.4f), rim);
//     soft_bodies.attach(lamp, Patch<3>::of_surface(top, 0.1f), {.kind = AttachmentKind::kRope, .point = hook});
//
// BulletSoftBodies holds them and solves them with the contacts of each substep.

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace softcell::ppu {

enum class AttachmentKind : std::uint8_t {
  kWeld,   ///< the patch moves with the other side as it lay there when it was attached
  kHinge,  ///< it turns about `point`, in three dimensions about `axis`
  kRope    ///< the middle of the patch is never farther than `length` from the other end
};

/// A part of a soft body. Exactly one of particles, cells and a radius is given.
/// @tparam kDimension  2 or 3
template <int kDimension>
struct Patch {
  using Vector = Eigen::Vector<float, kDimension>;

  std::vector<std::uint32_t> particles = {};  ///< by their numbers
  std::vector<std::uint32_t> cells = {};      ///< by their numbers: all their corners
  Vector centre = Vector::Zero();             ///< metres, in the world
  /// Metres: all of the drawn surface that is not farther from the centre. The corners of its cells are held. In two dimensions all particles.
  float radius = 0;

  /// The particles with these numbers.
  static Patch of_particles(std::vector<std::uint32_t> numbers) { return {.particles = std::move(numbers)}; }
  /// The cells with these numbers, with all their corners.
  static Patch of_cells(std::vector<std::uint32_t> numbers) { return {.cells = std::move(numbers)}; }
  /// What of the drawn surface is within `radius` metres of `centre`.
  static Patch of_surface(const Vector& centre, float radius) { return {.centre = centre, .radius = radius}; }
};

/// How a patch is held. Places are in the world, where things are when they are attached.
/// @tparam kDimension  2 or 3
template <int kDimension>
struct AttachmentSettings {
  using Vector = Eigen::Vector<float, kDimension>;

  AttachmentKind kind = AttachmentKind::kWeld;
  /// Metres: of a hinge, where it is; if nothing is said, the middle of the patch. Of a rope to the world or to a rigid body, its other end; to a
  /// rigid body, if nothing is said, its centre.
  std::optional<Vector> point = {};
  Vector axis = Vector::UnitX();     ///< of a hinge in three dimensions; of any length but 0
  std::optional<float> length = {};  ///< metres, of a rope; if nothing is said, as long as it is now
  float compliance = 0;              ///< m/N: by how much it gives; 0: not at all
  /// N: it breaks when it would have to carry more, and never carries more.
  float break_force = std::numeric_limits<float>::infinity();
  /// Whether the two sides touch each other; if nothing is said, those of ropes do.
  std::optional<bool> touch = {};
};

/// Of an attachment; never given twice by the same coupling.
enum class AttachmentId : std::uint32_t {};

/// What an attachment did in the last substep.
/// @tparam kDimension  2 or 3
template <int kDimension>
struct AttachmentState {
  Eigen::Vector<float, kDimension> force = Eigen::Vector<float, kDimension>::Zero();  ///< N, on the patch
  /// Metres between the middle of the patch and where it is held; of a rope, to its other end.
  float gap = 0;
};

/// Where an attachment holds, as things are now. Metres.
/// @tparam kDimension  2 or 3
template <int kDimension>
struct AttachmentEnds {
  Eigen::Vector<float, kDimension> patch =
      Eigen::Vector<float, kDimension>::Zero();  ///< the middle of what is held
  Eigen::Vector<float, kDimension> other = Eigen::Vector<float, kDimension>::Zero();  ///< where it is held
  float length = 0;                                                                   ///< of a rope
};

/// An attachment that is there no longer.
struct EndedAttachment {
  /// Why it ended.
  enum class Reason : std::uint8_t {
    kBroken,  ///< it would have had to carry more than its break force, or its patch was torn
    kGone     ///< one of its bodies was removed, or became one of another model by an assignment
  };
  AttachmentId id{};
  Reason reason = Reason::kBroken;
};

/// @throws std::invalid_argument  a value is out of its range, or given for another kind; the sentence names it and the range.
template <int kDimension>
void validate(const AttachmentSettings<kDimension>& settings);
extern template void validate(const AttachmentSettings<2>& settings);
extern template void validate(const AttachmentSettings<3>& settings);

}  // namespace softcell::ppu
