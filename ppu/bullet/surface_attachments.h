#pragma once
// The attachments of bodies that touch with their surfaces: what they are attached to in Bullet, what sleeps together, and how they end.

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "ppu/bullet/bullet_obstacles.h"
#include "ppu/bullet/surface_body.h"
#include "ppu/contacts/attachment_links.h"
#include "ppu/contacts/attachments.h"
#include "ppu/contacts/contact_stage.h"
#include "softcell/soft_bodies/attachment.h"

namespace softcell::ppu {

/// Used by the thread that steps the world.
class SurfaceAttachments {
 public:
  explicit SurfaceAttachments(const btDiscreteDynamicsWorld& world) : world_(world) {}

  /// To the world, or to a rigid body of it. @throws std::invalid_argument  as validate(), particles_of() and AttachmentRows; a rigid
  /// body that is not in the world; a rope to the world without a point.
  AttachmentId add(SurfaceBody& body, const Patch<3>& patch, btRigidBody* rigid,
                   const AttachmentSettings<3>& settings);
  /// To another soft body. @throws as above; it is the same body.
  AttachmentId add(SurfaceBody& body, const Patch<3>& patch, SurfaceBody& other, const Patch<3>& other_patch,
                   const AttachmentSettings<3>& settings);
  void remove(AttachmentId id);  ///< @throws std::invalid_argument  there is none of that number.
  /// @throws std::invalid_argument  there is none of that number, or it is none to the world.
  void move(AttachmentId id, const Eigen::Vector3f& position, const Eigen::Quaternionf& rotation,
            float seconds);
  std::optional<AttachmentState<3>> state(AttachmentId id) const;
  std::optional<AttachmentEnds<3>> ends(AttachmentId id) const;
  std::vector<EndedAttachment> take_ended();
  /// A soft body goes, and its attachments with it.
  void forget(const SurfaceBody& body);
  using Piece = PieceOfBody<SurfaceBody>;
  /// A body has fallen into pieces, of which it is one itself. Its attachments go on with the piece that has all particles of their patch,
  /// each of them once. Where none has, they end: their patch has vanished with a piece, or was torn.
  /// @param vanished  as PlannedPieces
  void follow_pieces(const SurfaceBody& body, std::span<const Piece> pieces,
                     std::span<const std::vector<std::uint32_t>> vanished);

  bool empty() const { return links_.empty(); }
  /// Before a substep: ends those to rigid bodies that are no longer in the world, and wakes what is attached to what is awake.
  void begin();
  /// Takes what a body is attached to, and does not touch, off what it may meet.
  void part(const SurfaceBody& body, BulletObstacles& obstacles, std::vector<std::uint32_t>& near) const;
  /// Whether a rigid body is attached to what the soft one is, directly or not: they sleep together.
  bool joins(const SurfaceBody& body, const btCollisionObject& object) const;
  /// Whether a soft body is attached to it.
  bool are_to(const btCollisionObject& object) const;
  /// The attachments of the substep. @param bodies  by their numbers in it
  void fill(Attachments<3>& attachments, std::span<SurfaceBody* const> bodies, BulletObstacles& obstacles,
            float step);
  /// After it: those that broke end, and what the program moves has moved.
  void end(float step);
  /// Puts what is attached to each other to sleep when all of it is at rest.
  void let_sleep(const SleepSettings& sleep);

 private:
  /// Where the world holds a link, and where the program moves that to.
  struct Hold {
    AttachmentFrame<3> frame{};  // at the substep's beginning
    Eigen::Vector3f goal_position{0, 0, 0};
    Eigen::Quaternionf rotation{1, 0, 0, 0}, goal_rotation{1, 0, 0, 0};
    float seconds = 0;   // until it is there
    bool moves = false;  // it is not there yet

    void advance(float step);
  };
  struct Link {
    AttachmentId id{};
    SurfaceBody* a = nullptr;
    SurfaceBody* b = nullptr;      // null: a rigid body or the world
    btRigidBody* rigid = nullptr;  // null: the world
    int rigid_number = 0;          // another for a body that is added later, even at the same address
    bool touch = false;
    AttachmentRows<3> rows;
    Hold hold;
  };
  /// What is attached to each other, directly or not.
  struct Island {
    std::vector<SurfaceBody*> bodies;
    std::vector<btRigidBody*> rigids;
    std::vector<const Link*> links;
  };

  AttachmentId add(Link link);
  template <class Which>
  void end_links(EndedAttachment::Reason reason, const Which& which);
  void find_islands();
  static void rouse(const Link& link);
  bool is_there(const Link& link) const;
  void end_gone();

  const btDiscreteDynamicsWorld& world_;
  AttachmentLinks<Link> links_;
  std::vector<Island> islands_;
  std::vector<EndedAttachment> ended_;
};

}  // namespace softcell::ppu
