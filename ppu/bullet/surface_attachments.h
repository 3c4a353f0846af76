#pragma once
// The attachments of bodies that touch with their surfaces: the links to objects in Bullet, their islands for sleeping, and how they end.

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "ppu/attachments/attachment_links.h"
#include "ppu/attachments/attachments.h"
#include "ppu/bullet/bullet_obstacles.h"
#include "ppu/bullet/surface_body.h"
#include "ppu/contact_solver/contact_solver.h"
#include "softcell/soft_bodies/attachment.h"

namespace softcell::ppu {

/// Used by the thread that steps the world.
class SurfaceAttachments {
 public:
  explicit SurfaceAttachments(const btDiscreteDynamicsWorld& world) : world_(world) {}

  /// Attaches to the world, or to one of its rigid bodies. @throws std::invalid_argument  as validate(), particles_of() and AttachmentRows;
  /// a rigid body that is not in the world; a rope to the world without a point.
  AttachmentId add(SurfaceBody& body, const Patch<3>& patch, btRigidBody* rigid,
                   const AttachmentSettings<3>& settings);
  /// Attaches to another soft body. @throws as above; it is the same body.
  AttachmentId add(SurfaceBody& body, const Patch<3>& patch, SurfaceBody& other, const Patch<3>& other_patch,
                   const AttachmentSettings<3>& settings);
  /// The soft bodies of an attachment; the second one is null if there is one only.
  /// @throws std::invalid_argument  there is no attachment with that number.
  std::array<const SurfaceBody*, 2> bodies_of(AttachmentId id) const;
  void remove(AttachmentId id);  ///< @throws std::invalid_argument  there is no attachment with that number.
  /// @throws std::invalid_argument  there is no attachment with that number, or it is not to the world.
  void move(AttachmentId id, const Eigen::Vector3f& position, const Eigen::Quaternionf& rotation,
            float seconds);
  std::optional<AttachmentState<3>> state(AttachmentId id) const;
  std::optional<AttachmentEnds<3>> ends(AttachmentId id) const;
  std::vector<EndedAttachment> take_ended() { return links_.take_ended(); }
  /// Removes the attachments of a soft body that is being removed.
  void forget(const SurfaceBody& body);
  using Piece = PieceOfBody<SurfaceBody>;
  /// Moves the attachments of a body that has broken into pieces, of which the body itself is one, to the piece that has all particles of
  /// their patch, each exactly once. If no piece has, they end: their patch has vanished with a piece, or was torn.
  /// @param vanished  as PlannedPieces
  void follow_pieces(const SurfaceBody& body, std::span<const Piece> pieces,
                     std::span<const std::vector<std::uint32_t>> vanished);

  bool empty() const { return links_.empty(); }
  /// Call it before a substep: ends attachments to rigid bodies that have left the world, and wakes bodies that are attached to others that
  /// are awake.
  void begin();
  /// Removes from `near` the obstacles that a body is attached to without touching them.
  void part(const SurfaceBody& body, BulletObstacles& obstacles, std::vector<std::uint32_t>& near) const;
  /// Whether a rigid body and a soft one are attached, directly or through others: they sleep together.
  bool joins(const SurfaceBody& body, const btCollisionObject& object) const;
  /// Whether a soft body is attached to the object.
  bool are_to(const btCollisionObject& object) const;
  /// Begins a substep with its attachments, which it adds. @param bodies  by their numbers in the substep
  void fill(Attachments<3>& attachments, std::span<SurfaceBody* const> bodies, BulletObstacles& obstacles,
            float step);
  /// Call it after a substep: ends attachments that broke, and completes the motion of those that the program moves.
  void end();
  /// Puts an island of attached bodies to sleep when all of it is at rest.
  void let_sleep(const SleepSettings& sleep);

 private:
  struct Link {
    AttachmentId id{};
    SurfaceBody* a = nullptr;
    SurfaceBody* b = nullptr;      // null: a rigid body or the world
    btRigidBody* rigid = nullptr;  // null: the world
    int rigid_number = 0;          // differs for a body that is added later, even at the same address
    bool touch = false;
    AttachmentRows<3> rows;
    HeldPlace<3> hold;
    btTransform pose{};  // of the rigid body, before the last substep
  };
  /// Bodies that are attached to each other, directly or through others.
  struct Island {
    std::vector<SurfaceBody*> bodies;
    std::vector<btRigidBody*> rigids;
    std::vector<Link*> links;
  };

  AttachmentId add(Link link);
  void find_islands();
  static void rouse(const Link& link);
  static bool has_program_moved(Link& link);
  bool is_there(const Link& link) const;
  void end_gone();

  const btDiscreteDynamicsWorld& world_;
  AttachmentLinks<Link> links_;
  std::vector<Island> islands_;
};

}  // namespace softcell::ppu
