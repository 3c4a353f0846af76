#pragma once
// Attachments: parts of soft bodies that are held to the world, to rigid bodies or to each other.
//
//     const AttachmentId tyre = soft_bodies.attach(ring, Patch<3>::of_surface(hub, 0.4f), rim);
//     soft_bodies.attach(lamp, Patch<3>::of_surface(top, 0.1f), {.kind = AttachmentKind::kRope, .point = hook});
//
// BulletSoftBodies and Box2dSoftBodies have the functions that attach. Attachments are solved together with the
// contacts of each substep; with ContactMethod::kSpheres in a Box2D world before Box2D solves contacts.

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace softcell::ppu {

enum class AttachmentKind : std::uint8_t {
  kWeld,   ///< the patch keeps the place and orientation that it had on the other side when it was attached
  kHinge,  ///< the patch turns about `point`, in three dimensions about `axis`
  kRope    ///< the middle of the patch is never farther than `length` from the other end
};

/// A part of a soft body. Give exactly one of `particles`, `cells` and `radius`.
/// @tparam kDimension  2 or 3
template <int kDimension>
struct Patch {
  using Vector = Eigen::Vector<float, kDimension>;

  std::vector<std::uint32_t> particles = {};  ///< by their numbers
  std::vector<std::uint32_t> cells = {};      ///< by their numbers: all their corners
  Vector centre = Vector::Zero();             ///< metres, in the world
  /// Metres: the patch is all of the drawn surface within this distance from the centre, and the corners of its cells are held. In two
  /// dimensions the patch is all particles within this distance.
  float radius = 0;

  /// The particles with these numbers.
  static Patch of_particles(std::vector<std::uint32_t> numbers) { return {.particles = std::move(numbers)}; }
  /// The cells with these numbers, with all their corners.
  static Patch of_cells(std::vector<std::uint32_t> numbers) { return {.cells = std::move(numbers)}; }
  /// The drawn surface within `radius` metres of `centre`; in two dimensions the particles there.
  static Patch of_surface(const Vector& centre, float radius) { return {.centre = centre, .radius = radius}; }
};

/// How a patch is held. Points and axes are in world coordinates, at the moment when the patch is attached.
/// @tparam kDimension  2 or 3
template <int kDimension>
struct AttachmentSettings {
  using Vector = Eigen::Vector<float, kDimension>;

  AttachmentKind kind = AttachmentKind::kWeld;
  /// Metres, of a hinge or rope. The place of a hinge; without a value, the middle of the patch. The other end of a rope that goes to the
  /// world or to a rigid body; without a value, the rigid body's centre.
  std::optional<Vector> point = {};
  Vector axis = Vector::UnitX();  ///< of a hinge in three dimensions; its length may be any but 0
  /// Metres, of a rope; without a value, the present distance of its ends. A shorter rope pulls its ends together: each comes nearer by up
  /// to a quarter of a cell in a substep, which is 3 m/s with cells of 0.1 m and 120 substeps a second, and its body keeps a part of that
  /// speed. A compliant rope pulls like a spring.
  std::optional<float> length = {};
  float compliance = 0;  ///< m/N: how far a force stretches the attachment; 0: not at all
  /// N: the largest force that the attachment carries. It breaks when it would have to carry more.
  float break_force = std::numeric_limits<float>::infinity();
  /// Whether the two sides touch each other. Without a value, those of ropes do, and those of welds and hinges do not.
  std::optional<bool> touch = {};
};

/// Names an attachment. A coupling never uses a number twice. A default one, 0, names none.
enum class AttachmentId : std::uint32_t {};

/// What an attachment did in the last substep.
/// @tparam kDimension  2 or 3
template <int kDimension>
struct AttachmentState {
  Eigen::Vector<float, kDimension> force = Eigen::Vector<float, kDimension>::Zero();  ///< N, on the patch
  /// Metres between the middle of the patch and the place where it is held; for a rope, to its other end.
  float gap = 0;
};

/// Where an attachment's ends are now, metres.
/// @tparam kDimension  2 or 3
template <int kDimension>
struct AttachmentEnds {
  using Vector = Eigen::Vector<float, kDimension>;

  Vector patch = Vector::Zero();  ///< the middle of the patch
  Vector other = Vector::Zero();  ///< where the patch is held
  float length = 0;               ///< the length of a rope
};

/// An attachment that has ended.
struct EndedAttachment {
  /// Why it ended.
  enum class Reason : std::uint8_t {
    kBroken,  ///< it had to carry more than its break force, or its patch was torn
    /// One of its bodies was removed, a body of another model was assigned to it, or its patch was in a piece that was too small to stay
    /// (Fracture::least_cells).
    kGone
  };
  AttachmentId id{};
  Reason reason = Reason::kBroken;
};

/// @throws std::invalid_argument  a value is out of its range, or a length or point is given for a kind that has none; the message names it
///         and the range.
template <int kDimension>
void validate(const AttachmentSettings<kDimension>& settings);
extern template void validate(const AttachmentSettings<2>& settings);
extern template void validate(const AttachmentSettings<3>& settings);

}  // namespace softcell::ppu
