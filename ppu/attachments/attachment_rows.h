#pragma once
// The constraints of one attachment. They hold places of a soft body at places of another soft body, or of a frame.
//
// A weld to a frame (a rigid body, or a frame that the program moves) holds each particle of the patch at its place in the frame. Two soft
// bodies have common places: points of the space around both patches, to which each patch contributes a share. The place p of a patch of
// particles with masses m, positions x, mass M and centre c moves with the mean deformation of the patch:
//
//     p = sum w x    w = m/M (1 + r' S^-1 (p - c))    r = x - c    S = sum m/M r r'
//
// so an impulse at p changes each particle's velocity by w/m of it, and the momentum and angular momentum are those of an
// impulse at p. Places at c + L t, with L L' = S and t the corners of a regular simplex with t.t' = -1, do not react to each other's
// impulses. Four of them (in two dimensions three) make a weld, two on its axis (one) a hinge; the middle of the patch is an end of a rope.
//
// All rows of a weld to a rigid body that moves are solved at once: each row measures u = v_particle - v_rigid and applies an impulse of -D
// (u - dv - dw x r), where D is the inverse of its mobility and dv, dw are the change that all rows together give the rigid body: six
// equations.
//
// Rows of places are also solved at once if no rigid body moves: a matrix gives the velocities at places by the impulses at places. It has
// one number for each pair of places, the sum of w_k w_l / m, the same along each axis.
//
// Rows of ropes, and of hinges to rigid bodies, are solved one after the other, together with contacts: sequential impulses [Cat05]. They
// use no warm start: a soft body takes some substeps to feel a load anyway, and the impulses of the last substep would add energy to bodies
// that turn. Pushes, which last one substep and add no energy, remove what is left of an error of position, as they do with the depth of
// contacts.

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "ppu/attachments/attached_body.h"
#include "ppu/attachments/attached_rigid.h"
#include "ppu/attachments/patch_places.h"
#include "ppu/numbers/turning.h"
#include "softcell/soft_bodies/attachment.h"

namespace softcell::ppu {

/// Where a frame is at the substep's beginning and, if only the program moves it, at its end.
template <int kDimension>
struct AttachmentFrame {
  using Vector = Eigen::Vector<float, kDimension>;
  using Matrix = Eigen::Matrix<float, kDimension, kDimension>;
  Vector position = Vector::Zero(), end_position = Vector::Zero();  ///< metres
  Matrix rotation = Matrix::Identity(), end_rotation = Matrix::Identity();

  Vector to_world(const Vector& own) const { return position + rotation * own; }
  Vector to_world_at_end(const Vector& own) const { return end_position + end_rotation * own; }
  Vector to_own(const Vector& world) const { return rotation.transpose() * (world - position); }
  /// Velocity of a place of the frame, m/s, in a substep of `step` seconds.
  Vector velocity_at(const Vector& own, float step) const {
    return (to_world_at_end(own) - to_world(own)) / step;
  }
};

/// A particle of a body whose velocity an attachment determines: a rigid body that presses on the particle feels what holds it.
template <int kDimension>
struct HeldParticle {
  std::uint32_t body = 0, particle = 0;
  Eigen::Vector<float, kDimension> velocity = Eigen::Vector<float, kDimension>::Zero();  ///< m/s
  float most_impulse = std::numeric_limits<float>::infinity();  ///< kg m/s: the attachment breaks above it
  std::uint32_t attachment = 0;                                 ///< its number in the substep
};

template <int kDimension>
class AttachmentRecords;

/// Constraints between a patch of a body, called a, and either a patch of another body or a frame, called b.
template <int kDimension>
class AttachmentRows {
 public:
  using Vector = Eigen::Vector<float, kDimension>;
  using Matrix = Eigen::Matrix<float, kDimension, kDimension>;
  using Rigid = typename AttachedRigid<kDimension>::Rigid;

  /// Attaches two soft bodies.
  /// @throws std::invalid_argument  a patch is too small, or too flat, for this kind of attachment.
  AttachmentRows(const AttachmentSettings<kDimension>& settings, const PatchParticles<kDimension>& a,
                 const PatchParticles<kDimension>& b);
  /// Attaches a soft body to a frame. @throws as above.
  AttachmentRows(const AttachmentSettings<kDimension>& settings, const PatchParticles<kDimension>& a,
                 const AttachmentFrame<kDimension>& frame);

  /// The particles of a patch. @param of_b  of the second body's
  std::span<const std::uint32_t> particles(bool of_b) const { return of_b ? b_.particle : a_.particle; }
  /// Tells that a body has become another one, in which the patch's particles have other numbers. Nothing else of the attachment changes.
  /// @param numbers  one for each of particles()
  void renumber(bool of_b, std::vector<std::uint32_t> numbers);

  /// The two sides in a substep. b is null if b is a frame; rigid is null if only the program moves the frame.
  struct Sides {
    AttachedBody<kDimension> a;
    const AttachedBody<kDimension>* b = nullptr;
    const AttachmentFrame<kDimension>* frame = nullptr;
    Rigid* rigid = nullptr;
  };
  /// Appends the particles of a that a weld without compliance holds to a frame that impulses do not move; for other attachments none.
  /// Call it before begin(). @param rigid  null: only the program moves the frame
  void append_held(std::uint32_t a, const AttachmentFrame<kDimension>& frame, const Rigid* rigid, float step,
                   std::vector<HeldParticle<kDimension>>& held);
  /// Begins a substep. The sides must stay in place until finish().
  void begin(const Sides& sides, float step);
  /// Whether one iteration gives the final result, as long as nothing else changes the sides.
  bool is_direct() const { return is_direct_; }
  /// One iteration. @return  the largest velocity error of a row, squared (m/s)^2
  float iterate();
  /// Ends the substep after the last iteration.
  void finish();
  /// Removes the angular momentum that an attachment has added by error. The error has two causes. The ends of a compliant attachment are
  /// apart, so if they also move sideways, its two impulses do not lie on one line. And particles that follow a rigid body are pushed while
  /// they move. The function turns the patches of soft bodies, but no rigid body. Call it after finish() of all attachments, or after a
  /// kernel.
  /// @param agrees  whether no other attachment of body a contradicts this one. Attachments that contradict each other push again and
  ///                again, and each push would count
  void take_back_spin(bool agrees);
  /// Whether the ends were apart at the substep's beginning, as happens when attachments contradict each other.
  bool is_apart() const;
  bool takes_back_spin() const;

  /// A rigid body presses on held particles as on a wall. An attachment that breaks as it carries more than expected carries all of it in
  /// that substep, as the particles would fly away with the rest. Call it after append_held(), which begins a substep.
  /// @param breaks  the attachment breaks at the substep's end, whatever it carries
  void press(bool breaks) {
    is_pressed_ = true;
    breaks_off_ = breaks_off_ || breaks;
  }
  /// Whether the impulse after the last iteration of the last substep exceeds the break force, or press() said so.
  bool broke() const { return broke_ || breaks_off_; }
  const AttachmentState<kDimension>& state() const { return state_; }
  /// @param a, b  positions of the bodies' particles  @param frame  used if b is empty
  AttachmentEnds<kDimension> ends(std::span<const Vector> a, std::span<const Vector> b,
                                  const AttachmentFrame<kDimension>& frame) const;

 private:
  friend class AttachmentRecords<kDimension>;

  using Place = PatchPlace;
  using Side = PatchPlaces<kDimension>;
  using Axial = turning::Axial<kDimension>;
  bool pushes_soft_body_only() const;
  Axial spin_of_pushes() const;
  struct Row {
    Place a, b;
    Vector own = Vector::Zero();      // in the frame
    float share = 1;                  // weight among rows in the patch's middle
    Vector impulse = Vector::Zero();  // kg m/s, on a

    // Of this substep:
    Vector point = Vector::Zero();                 // metres: b's place
    Vector carried = Vector::Zero();               // m/s: b's velocity, if only the program moves b
    Vector error = Vector::Zero();                 // m/s: the error of position, over the step
    Matrix inverse_mobility = Matrix::Identity();  // kg, softness included
    float push_mobility = 0;                       // 1/kg
    // For ropes:
    Vector along = Vector::Zero();  // unit length, from b to a
    float most = 0;                 // m/s, upper limit of the velocity of a against b along it
    float mobility = 0;   // 1/kg, with softness; for a weld to a rigid body: without the rigid body's own
    float push_most = 0;  // m/s
    float push = 0;       // kg m/s
  };
  double share_taken_back(const Row& row, const Vector& apart) const;

  void add_row(const Vector& point, const PatchParticles<kDimension>& a, const PatchParticles<kDimension>* b,
               const AttachmentFrame<kDimension>* frame);
  void add_places_in_common(const PatchParticles<kDimension>& a, const PatchParticles<kDimension>& b);
  void add_hinge(const PatchParticles<kDimension>& a, const PatchParticles<kDimension>* b,
                 const AttachmentFrame<kDimension>* frame);
  /// @return  metres, from the place where b holds it to a's place
  Vector begin_row(Row& row);
  void begin_weld_to_rigid();
  void begin_rope(Row& row, const Vector& apart);
  float most_push(const AttachedBody<kDimension>& body) const;  // m/s, of a particle
  float most_of_error(float mobility) const;
  Vector relative_velocity(const Row& row) const;
  Vector relative_push(const Row& row) const;
  void apply(const Row& row, const Vector& impulse);
  void apply_push(const Row& row, const Vector& impulse);
  float solve(Row& row);
  void begin_places();
  float solve_places();
  float solve_weld_to_rigid();
  void solve_push(const Row& row);
  float solve_rope(Row& row);
  void keep_below_break_force();
  bool carries_all() const { return is_pressed_ && !breaks_off_; }
  void limit_pushes(const Side& side, const AttachedBody<kDimension>& body) const;
  Vector carried_impulse() const;

  AttachmentSettings<kDimension> settings_;
  float length_ = 0;  // of a rope
  Side a_, b_;
  std::vector<Row> rows_;
  Sides sides_;
  float step_ = 0;      // seconds
  float softness_ = 0;  // 1/kg: compliance of a row over the step squared
  bool pushes_ = false;
  bool broke_ = false;
  bool is_pressed_ = false;
  bool breaks_off_ = false;
  bool is_direct_ = false;
  bool with_rigid_at_once_ = false;
  bool places_at_once_ = false;
  // For places: the inverse of their mobilities, with softness and without. kg
  using Places = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, 0, kDimension + 1, kDimension + 1>;
  Places inverse_of_places_, inverse_of_pushes_;
  // For a weld to a rigid body that moves: the sums of D and D r, and the inverse of the matrix that remains for its spin.
  float sum_ = 0;
  Vector sum_of_arms_ = Vector::Zero();
  Eigen::Matrix<float, AttachedRigid<kDimension>::kAxes, AttachedRigid<kDimension>::kAxes> inverse_inertia_;
  AttachmentState<kDimension> state_;
};

extern template class AttachmentRows<2>;
extern template class AttachmentRows<3>;

}  // namespace softcell::ppu
