#include "ppu/bullet/surface_attachments.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "ppu/attachments/attachment_patch.h"
#include "ppu/bullet/may_move.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

constexpr float kMovesFrom = 0.05f;  // m/s and rad/s, of kinematic bodies

AttachmentFrame<3> frame_of(const btTransform& pose) {
  AttachmentFrame<3> frame;
  frame.position = frame.end_position = to_eigen(pose.getOrigin());
  frame.rotation = frame.end_rotation = to_eigen(pose.getBasis());
  return frame;
}

bool is_moved_by_bullet(const btRigidBody& rigid) { return !rigid.isStaticOrKinematicObject(); }

/// Also for kinematic bodies.
bool is_slow(const btRigidBody& rigid, float speed) {
  return velocity_of(rigid).length2() < speed * speed && spin_of(rigid).length2() < speed * speed;
}

template <typename T>
bool contains(const std::vector<T*>& list, const void* item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}

}  // namespace

AttachmentId SurfaceAttachments::add(SurfaceBody& body, const Patch<3>& patch, btRigidBody* rigid,
                                     const AttachmentSettings<3>& settings) {
  validate(settings);
  AttachmentSettings<3> full = settings;
  const PatchParticles<3> particles = particles_of(patch, body.soft(), body.contact());
  AttachmentFrame<3> frame;
  int number = 0;
  if (rigid != nullptr) {
    if (rigid->getBroadphaseHandle() == nullptr ||
        world_.getCollisionObjectArray().findLinearSearch(rigid) == world_.getCollisionObjectArray().size())
      throw std::invalid_argument("the rigid body of an attachment is not in this world");
    number = rigid->getBroadphaseHandle()->m_uniqueId;
    frame = frame_of(rigid->getWorldTransform());
    if (settings.kind == AttachmentKind::kRope && !full.point) full.point = frame.position;
  } else {
    frame = frame_in_world(full, particles);
  }
  return add(Link{.a = &body,
                  .rigid = rigid,
                  .rigid_number = number,
                  .touch = touches(full),
                  .rows = AttachmentRows<3>(full, particles, frame),
                  .hold = {.frame = frame, .goal = frame.position},
                  .pose = rigid != nullptr ? rigid->getWorldTransform() : btTransform::getIdentity()});
}

AttachmentId SurfaceAttachments::add(SurfaceBody& body, const Patch<3>& patch, SurfaceBody& other,
                                     const Patch<3>& other_patch, const AttachmentSettings<3>& settings) {
  validate(settings);
  if (&body == &other) throw std::invalid_argument("a soft body cannot be attached to itself");
  return add(Link{.a = &body,
                  .b = &other,
                  .touch = touches(settings),
                  .rows = AttachmentRows<3>(settings, particles_of(patch, body.soft(), body.contact()),
                                            particles_of(other_patch, other.soft(), other.contact())),
                  .hold = {},
                  .pose = btTransform::getIdentity()});
}

AttachmentId SurfaceAttachments::add(Link link) {
  end_gone();
  const Link& added = links_.add(std::move(link));
  rouse(added);
  find_islands();
  return added.id;
}

std::array<const SurfaceBody*, 2> SurfaceAttachments::bodies_of(AttachmentId id) const {
  const Link& link = links_.at(id);
  return {link.a, link.b};
}

void SurfaceAttachments::remove(AttachmentId id) {
  end_gone();
  rouse(links_.at(id));
  links_.take([&](const Link& link) { return link.id == id; });
  find_islands();
}

void SurfaceAttachments::move(AttachmentId id, const Eigen::Vector3f& position,
                              const Eigen::Quaternionf& rotation, float seconds) {
  Link& link = links_.to_world(id);
  if (!position.allFinite() || !rotation.coeffs().allFinite() || !(rotation.norm() > 0))
    throw std::invalid_argument(
        "an attachment is moved to a place that is not finite, or turned by a rotation of length 0");
  link.hold.move(position, rotation.normalized(), seconds);
  rouse(link);
}

std::optional<AttachmentState<3>> SurfaceAttachments::state(AttachmentId id) const {
  if (const Link* const link = links_.find(id)) return link->rows.state();
  return std::nullopt;
}

std::optional<AttachmentEnds<3>> SurfaceAttachments::ends(AttachmentId id) const {
  const Link* const link = links_.find(id);
  if (link == nullptr || (link->rigid != nullptr && !is_there(*link))) return std::nullopt;
  return link->rows.ends(
      link->a->soft().positions(),
      link->b != nullptr ? link->b->soft().positions() : std::span<const Eigen::Vector3f>(),
      link->rigid != nullptr ? frame_of(link->rigid->getWorldTransform()) : link->hold.frame);
}

void SurfaceAttachments::forget(const SurfaceBody& body) {
  end_gone();
  if (links_.end_those_of(body, rouse)) find_islands();
}

void SurfaceAttachments::follow_pieces(const SurfaceBody& body, std::span<const Piece> pieces,
                                       std::span<const std::vector<std::uint32_t>> vanished) {
  if (links_.empty()) return;
  links_.follow_pieces(body, pieces, vanished, rouse);
  find_islands();  // also for links that have moved to a piece
}

void SurfaceAttachments::rouse(const Link& link) {
  link.a->rouse();
  if (link.b != nullptr) link.b->rouse();
  if (link.rigid != nullptr) link.rigid->activate();
}

/// Does not read the body before the world has confirmed it, as it may have been deleted.
bool SurfaceAttachments::is_there(const Link& link) const {
  const btCollisionObjectArray& objects = world_.getCollisionObjectArray();
  if (objects.findLinearSearch(link.rigid) == objects.size()) return false;
  const btBroadphaseProxy* const proxy = link.rigid->getBroadphaseHandle();
  return proxy != nullptr && proxy->m_uniqueId == link.rigid_number;
}

/// Must be called before anything else reads the rigid bodies of attachments.
void SurfaceAttachments::end_gone() {
  if (links_.end_gone([&](const Link& link) { return is_there(link); }, rouse)) find_islands();
}

/// Bodies that are attached to the same static body do not form an island.
void SurfaceAttachments::find_islands() {
  for (const Island& island : islands_)
    for (SurfaceBody* const body : island.bodies) body->set_attached(false);
  islands_.clear();
  for (const auto& link : links_) {
    const bool by_rigid = link->rigid != nullptr && may_move(*link->rigid);
    Island island{.bodies = {link->a}, .rigids = {}, .links = {link.get()}};
    if (link->b != nullptr) island.bodies.push_back(link->b);
    if (by_rigid) island.rigids.push_back(link->rigid);
    for (auto other = islands_.begin(); other != islands_.end();) {
      const bool joined =
          contains(other->bodies, link->a) || (link->b != nullptr && contains(other->bodies, link->b)) ||
          (by_rigid && !link->rigid->isKinematicObject() && contains(other->rigids, link->rigid));
      if (!joined) {
        ++other;
        continue;
      }
      const auto join = [](auto& to, const auto& from) {
        for (auto* const item : from)
          if (!contains(to, item)) to.push_back(item);
      };
      join(island.bodies, other->bodies);
      join(island.rigids, other->rigids);
      join(island.links, other->links);
      other = islands_.erase(other);
    }
    islands_.push_back(std::move(island));
  }
  for (const Island& island : islands_)
    for (SurfaceBody* const body : island.bodies) body->set_attached(true);
}

/// Whether the program has given a static or kinematic body another place since the last call.
bool SurfaceAttachments::has_program_moved(Link& link) {
  if (link.rigid == nullptr || is_moved_by_bullet(*link.rigid)) return false;
  const btTransform before = std::exchange(link.pose, link.rigid->getWorldTransform());
  return !(before == link.pose);
}

void SurfaceAttachments::begin() {
  end_gone();
  for (const Island& island : islands_) {
    bool moved = false;
    for (Link* const link : island.links) moved |= has_program_moved(*link);
    const bool awake = moved ||
                       std::any_of(island.bodies.begin(), island.bodies.end(),
                                   [](const auto* body) { return !body->soft().asleep(); }) ||
                       std::any_of(island.rigids.begin(), island.rigids.end(),
                                   [&](const auto* rigid) {
                                     if (!island.bodies.empty())
                                       island.bodies.front()->see(rigid->getWorldArrayIndex());
                                     return rigid->isActive() &&
                                            (is_moved_by_bullet(*rigid) || !is_slow(*rigid, kMovesFrom));
                                   }) ||
                       (!island.bodies.empty() && island.bodies.front()->notices_a_change());
    if (!awake) continue;
    // What the program moves, however slowly, takes along bodies that would otherwise fall asleep.
    for (SurfaceBody* const body : island.bodies)
      if (moved || body->soft().asleep()) body->rouse();
    for (btRigidBody* const rigid : island.rigids)
      if (!rigid->isActive()) rigid->activate();
  }
}

void SurfaceAttachments::part(const SurfaceBody& body, BulletObstacles& obstacles,
                              std::vector<std::uint32_t>& near) const {
  for (const auto& link : links_) {
    if (link->a != &body || link->rigid == nullptr || link->touch) continue;
    std::erase_if(near, [&](std::uint32_t obstacle) {
      return obstacles.objects()[obstacles.obstacles()[obstacle].rigid] == link->rigid;
    });
  }
}

bool SurfaceAttachments::joins(const SurfaceBody& body, const btCollisionObject& object) const {
  return std::any_of(islands_.begin(), islands_.end(), [&](const Island& island) {
    return contains(island.bodies, &body) && contains(island.rigids, btRigidBody::upcast(&object));
  });
}

bool SurfaceAttachments::are_to(const btCollisionObject& object) const {
  return std::ranges::any_of(links_, [&](const auto& link) { return link->rigid == &object; });
}

void SurfaceAttachments::fill(Attachments<3>& attachments, std::span<SurfaceBody* const> bodies,
                              BulletObstacles& obstacles, float step) {
  attachments.clear();
  const auto number_of = [&](const SurfaceBody* body) {
    const auto found = std::find(bodies.begin(), bodies.end(), body);
    SC_ASSERT(found != bodies.end(), "an attached body is none of {}", bodies.size());
    return static_cast<std::uint32_t>(found - bodies.begin());
  };
  for (const auto& link : links_) {
    link->hold.begin(step);
    AttachmentInStep<3> in_step{
        .rows = &link->rows, .a = number_of(link->a), .frame = link->hold.frame, .touch = link->touch};
    if (link->b != nullptr) {
      in_step.b = number_of(link->b);
    } else if (link->rigid != nullptr) {
      in_step.rigid = obstacles.rigid_of(*link->rigid);
      in_step.frame = frame_of(obstacles.pose_of(*link->rigid));
    }
    attachments.add(in_step);
  }
}

void SurfaceAttachments::end() {
  for (const auto& link : links_) link->hold.end();
  if (links_.end_broken(rouse)) find_islands();
}

void SurfaceAttachments::let_sleep(const SleepSettings& sleep) {
  end_gone();  // the program's callbacks may have removed bodies in this substep
  for (const Island& island : islands_) {
    const bool rest = std::all_of(island.bodies.begin(), island.bodies.end(),
                                  [&](const auto* body) {
                                    return body->soft().asleep() || body->may_fall_asleep(sleep);
                                  }) &&
                      std::all_of(island.rigids.begin(), island.rigids.end(),
                                  [&](const auto* rigid) {
                                    return is_slow(*rigid, sleep.speed) &&
                                           (!is_moved_by_bullet(*rigid) ||
                                            rigid->getActivationState() != DISABLE_DEACTIVATION);
                                  }) &&
                      std::none_of(island.links.begin(), island.links.end(),
                                   [](const Link* link) { return link->hold.moves; });
    if (!rest) continue;
    for (SurfaceBody* const body : island.bodies)
      if (!body->soft().asleep()) body->fall_asleep_with_others();
    for (btRigidBody* const rigid : island.rigids) {
      if (!is_moved_by_bullet(*rigid)) continue;
      rigid->setLinearVelocity({0, 0, 0});
      rigid->setAngularVelocity({0, 0, 0});
      rigid->forceActivationState(ISLAND_SLEEPING);
    }
  }
}

}  // namespace softcell::ppu
