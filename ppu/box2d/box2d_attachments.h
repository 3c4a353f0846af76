#pragma once
// The attachments of soft bodies in a Box2D world. For bodies that touch with circles they are solved after the solver and before Box2D's
// step, so Box2D's contacts come after them; for bodies that touch with their drawn edges they are solved together with contacts.

#include <box2d/b2_body.h>
#include <box2d/b2_world.h>

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ppu/attachments/attachment_links.h"
#include "ppu/attachments/attachments.h"
#include "ppu/box2d/box2d_body.h"
#include "ppu/box2d/box2d_filter.h"
#include "ppu/box2d/rest.h"
#include "softcell/soft_bodies/attachment.h"

namespace softcell::ppu {

/// Used by the thread that steps the world.
class Box2dAttachments {
 public:
  /// @param soft_body_of  the soft body that a b2Body is a particle of; null: none
  /// @param filter        asks may_touch(); must outlive this object
  Box2dAttachments(b2World& world, std::function<Box2dBody*(const b2Body&)> soft_body_of, Box2dFilter& filter)
      : world_(world), soft_body_of_(std::move(soft_body_of)), filter_(filter) {}
  Box2dAttachments(const Box2dAttachments&) = delete;
  Box2dAttachments& operator=(const Box2dAttachments&) = delete;

  /// Attaches to the world, or to one of its rigid bodies. @throws std::invalid_argument  as Box2dSoftBodies::attach().
  AttachmentId add(Box2dBody& body, const Patch<2>& patch, b2Body* rigid,
                   const AttachmentSettings<2>& settings);
  /// Attaches to another soft body. @throws as above.
  AttachmentId add(Box2dBody& body, const Patch<2>& patch, Box2dBody& other, const Patch<2>& other_patch,
                   const AttachmentSettings<2>& settings);
  void remove(AttachmentId id);  ///< @throws std::invalid_argument  there is no attachment with that number.
  /// @throws std::invalid_argument  there is no attachment with that number, or it is not to the world.
  void move(AttachmentId id, const Eigen::Vector2f& position, float angle, float seconds);
  /// The world's origin has moved: attachments to the world move with it. @param by  metres, added to all positions
  void shift(const Eigen::Vector2f& by);
  std::optional<AttachmentState<2>> state(AttachmentId id) const;
  std::optional<AttachmentEnds<2>> ends(AttachmentId id) const;
  std::vector<EndedAttachment> take_ended() { return links_.take_ended(); }
  /// Whether two bodies may collide as far as attachments are concerned.
  bool may_touch(const b2Body& a, const b2Body& b) const;
  /// Whether an attachment keeps a body that Box2D does not know of from colliding with a rigid one.
  bool parts(const Box2dBody& body, const b2Body& rigid) const;
  using Piece = PieceOfBody<Box2dBody>;
  /// Moves the attachments of a body that has broken into pieces, of which the body itself is one, to the piece that has all particles of
  /// their patch, each exactly once. If no piece has, they end: their patch has vanished with a piece, or was torn.
  /// @param vanished  as PlannedPieces
  void follow_pieces(const Box2dBody& body, std::span<const Piece> pieces,
                     std::span<const std::vector<std::uint32_t>> vanished);
  /// Removes the attachments of a soft body that is being removed.
  void forget(const Box2dBody& body);
  /// Whether the program still moves a place in the world to which the body is attached.
  bool is_being_moved(const Box2dBody& body) const;
  /// Adds what attachments connect, except what has vanished. Ends those to rigid bodies that have.
  void append_neighbours(SoftNeighbours& neighbours);

  struct RigidInStep {
    std::uint32_t number;  ///< that the caller gives it
    b2Transform pose;      ///< at the step's begin
  };
  /// Begins a step, after the solver of bodies. @param in_step_of  of a rigid body
  /// @return  the attachments to be solved, with soft bodies by their indices; call end() afterwards
  std::span<const AttachmentInStep<2>> begin(std::span<const std::unique_ptr<Box2dBody>> bodies,
                                             const std::function<RigidInStep(b2Body&)>& in_step_of,
                                             float step);
  /// Ends attachments that had to carry too much.
  void end();
  /// Does a step without contacts, from begin() to end(): changes velocities, and moves particles to correct the rest of position errors.
  void solve(std::span<const std::unique_ptr<Box2dBody>> bodies, float step);

 private:
  struct Link {
    AttachmentId id{};
    Box2dBody* a = nullptr;
    Box2dBody* b = nullptr;   // null: a rigid body or the world
    b2Body* rigid = nullptr;  // null: the world
    bool touch = false;
    AttachmentRows<2> rows;
    HeldPlace<2> hold;
    b2Transform pose{b2Vec2_zero, b2Rot(0)};  // of the rigid body, if there is one, when a step last began
  };
  /// A soft body in one step.
  struct InStep {
    std::vector<Eigen::Vector2f> velocities, pushes;  // m/s; velocities with this step's gravity
    std::vector<float> inverse_masses;
  };

  AttachmentId add(Link link);
  static std::uint32_t index_of(const Box2dBody* body, std::span<const std::unique_ptr<Box2dBody>> bodies);
  void end_gone();
  /// Wakes the bodies of a link that has ended, and lets them collide.
  void release(const Link& link);
  void refilter(const Link& link);
  static void wake(const Link& link);
  /// Wakes sleepers that are attached to something which is awake or has moved, those attached to these, and so on.
  void wake_disturbed();
  bool holds(const Box2dBody& body) const;
  void lay_out(const Box2dBody& body, InStep& in_step, float step) const;
  void finish(Box2dBody& body, const InStep& in_step, float step) const;
  std::uint32_t number_of(b2Body& rigid, float step);
  void move_rigids(float step) const;

  b2World& world_;
  std::function<Box2dBody*(const b2Body&)> soft_body_of_;
  Box2dFilter& filter_;
  AttachmentLinks<Link> links_;
  // For one step:
  std::vector<AttachmentInStep<2>> to_solve_;
  Attachments<2> attachments_;
  std::vector<InStep> in_step_;
  std::vector<AttachedBody<2>> bodies_;
  std::vector<AttachedRigid2d> rigids_;
  std::vector<b2Body*> rigid_bodies_;
};

}  // namespace softcell::ppu
