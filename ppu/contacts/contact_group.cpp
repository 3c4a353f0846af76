#include "ppu/contacts/contact_group.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

// A penetration depth of up to kSlop cells remains; of the rest, a substep removes kPushShare, and no more than kMostPush cells.
constexpr float kSlop = 0.01f, kPushShare = 0.1f, kMostPush = 0.02f;

float mobility(const SoftContact& contact, const ContactSides& sides, const Vector3f& direction) {
  const float own =
      contact.a.mobility(contact.on_held ? sides.a->inverse_masses_if_held : sides.a->inverse_masses);
  if (sides.b != nullptr) return own + contact.b.mobility(sides.b->inverse_masses);
  return own + sides.rigids[contact.rigid].mobility(contact.acts_at, direction);
}

Vector3f relative_velocity(const SoftContact& contact, const ContactSides& sides) {
  const Vector3f a =
      contact.on_held ? sides.a->velocity_if_held(contact.a) : contact.a.of(sides.a->velocities);
  if (sides.b != nullptr) return a - contact.b.of(sides.b->velocities);
  return a - sides.rigids[contact.rigid].velocity_at(contact.acts_at);
}

void apply(const SoftContact& contact, const ContactSides& sides, const Vector3f& impulse) {
  contact.a.add(sides.a->velocities, sides.a->inverse_masses, impulse);
  if (sides.b != nullptr) {
    contact.b.add(sides.b->velocities, sides.b->inverse_masses, -impulse);
    return;
  }
  ContactRigid& rigid = sides.rigids[contact.rigid];
  if (rigid.inverse_mass == 0) return;
  const ContactRigid::Change change =
      rigid.change_by(impulse, Vector3f(contact.acts_at - rigid.centre).cross(impulse));
  rigid.velocity -= change.velocity;
  rigid.spin -= change.spin;
}

/// Velocity that moves the two out of each other, m/s along the normal; 0: they are not deep enough.
float push_velocity(const SoftContact& contact, float spacing, float step) {
  const float excess = contact.depth - kSlop * spacing;
  return excess > 0 ? std::min(kPushShare * excess, kMostPush * spacing) / step : 0.0f;
}

void solve_normal(SoftContact& contact, const ContactSides& sides, float step) {
  const float v = contact.normal.dot(relative_velocity(contact, sides));
  float least = contact.least_velocity;
  // Held particles do not give way to a push: the rigid body itself must come out, as its engine may press it in again in each substep.
  if (contact.on_held && sides.rigids[contact.rigid].inverse_mass > 0)
    least = std::max(least, push_velocity(contact, sides.a->spacing(), step));
  const float wanted = contact.impulse + (least - v) / contact.normal_mobility;
  const float impulse = std::max(0.0f, wanted);
  apply(contact, sides, (impulse - contact.impulse) * contact.normal);
  contact.impulse = impulse;
}

/// Coulomb's law, the same in all directions.
void solve_friction(SoftContact& contact, const ContactSides& sides) {
  const Vector3f v = relative_velocity(contact, sides);
  const Vector3f sliding = v - contact.normal.dot(v) * contact.normal + contact.slide;
  const float speed = sliding.norm();
  const float most = contact.friction * contact.impulse;
  if (most == 0 && contact.friction_impulse.isZero(0)) return;
  Vector3f wanted = contact.friction_impulse;
  if (speed > 0) {
    const float along = mobility(contact, sides, sliding / speed);
    // Neither of two moves that something holds.
    wanted -= along > 0 ? Vector3f(sliding / along) : Vector3f(most / speed * sliding);
  }
  const float length = wanted.norm();
  if (length > most) wanted *= most / length;
  apply(contact, sides, wanted - contact.friction_impulse);
  contact.friction_impulse = wanted;
}

/// Kernels number particles and cells with 16 bits; the highest number says that there is none.
constexpr std::uint32_t kMostOfKernel = std::numeric_limits<std::uint16_t>::max() - 1;

std::uint16_t as_kernels_number_it(std::uint32_t number) {
  SC_ASSERT(number <= kMostOfKernel, "particle or cell {}; kernels number up to {}", number, kMostOfKernel);
  return static_cast<std::uint16_t>(number);
}

std::uint16_t cell_of(const Anchor& anchor) {
  return anchor.cell == Anchor::kNoCell ? spu::kSolveNoCell : as_kernels_number_it(anchor.cell);
}

spu::SolveAnchor as_kernels_solve_it(const Anchor& anchor, std::span<const float> inverse_masses) {
  spu::SolveAnchor result{};
  for (std::size_t k = 0; k < 8; ++k) {
    result.particle[k] = as_kernels_number_it(anchor.particle[k]);
    result.weight[k] = anchor.share[k] * std::sqrt(inverse_masses[anchor.particle[k]]);
  }
  return result;
}

/// Makes the push velocity positive, because the kernel ignores contacts that push with 0 m/s.
void push_at_least_a_bit(spu::SolveContact& contact) {
  constexpr float kAsGoodAsNothing = 1e-20f;  // m/s
  contact.push_velocity = std::max(contact.push_velocity, kAsGoodAsNothing);
}

/// Moves soft bodies only: a rigid one is moved by its engine.
void solve_push(SoftContact& contact, const ContactSides& sides, float step) {
  const float target = push_velocity(contact, sides.a->spacing(), step);
  if (target <= 0 && !contact.holds_pushes) return;
  float v = contact.normal.dot(contact.a.of(sides.a->pushes));
  if (sides.b != nullptr) v -= contact.normal.dot(contact.b.of(sides.b->pushes));
  const float push = std::max(0.0f, contact.push + (target - v) / contact.push_mobility);
  const Vector3f change = (push - contact.push) * contact.normal;
  contact.push = push;
  contact.a.add(sides.a->pushes, sides.a->inverse_masses, change);
  if (sides.b != nullptr) contact.b.add(sides.b->pushes, sides.b->inverse_masses, -change);
}

/// Whether a contact is left to what holds the particles. If the rigid body is static, or its supports or its engine hold it, too, the
/// other particles have to give way, but not if they have too little of a share: an impulse between two that do not move has no limit.
bool is_held_off(const SoftContact& contact, const ContactSides& sides) {
  constexpr float kLeastOfRigid = 1.0f / 64;      // of a free body's mobility: a stack has less than one body
  constexpr float kLeastOfParticles = 1.0f / 16;  // of their mobility without what holds
  if (!contact.on_held) return false;
  const ContactRigid& rigid = sides.rigids[contact.rigid];
  const bool gives_way = rigid.mobility(contact.acts_at, contact.normal) > kLeastOfRigid * rigid.inverse_mass;
  return !gives_way && contact.a.mobility(sides.a->inverse_masses_if_held) <
                           kLeastOfParticles * contact.a.mobility(sides.a->inverse_masses);
}

}  // namespace

void prepare(std::span<SoftContact> contacts, const ContactSides& sides) {
  for (SoftContact& contact : contacts) {
    contact.normal_mobility = mobility(contact, sides, contact.normal);
    if (is_held_off(contact, sides)) contact.normal_mobility = std::numeric_limits<float>::infinity();
    contact.push_mobility = contact.a.mobility(sides.a->inverse_masses);
    if (sides.b != nullptr) contact.push_mobility += contact.b.mobility(sides.b->inverse_masses);
  }
}

spu::SolveContact as_kernels_solve_it(const SoftContact& contact, const ContactSides& sides,
                                      std::span<const ContactRigid> rigids, float step) {
  spu::SolveContact result{};
  result.a = as_kernels_solve_it(contact.a, sides.a->inverse_masses);
  float mobility = contact.a.mobility(sides.a->inverse_masses);
  Vector3f carried = -contact.a.of(sides.a->velocities);
  result.cell_b = spu::kSolveNoCell;
  if (sides.b != nullptr) {
    result.b = as_kernels_solve_it(contact.b, sides.b->inverse_masses);
    mobility += contact.b.mobility(sides.b->inverse_masses);
    carried += contact.b.of(sides.b->velocities);
    result.cell_b = cell_of(contact.b);
  } else {
    carried += rigids[contact.rigid].velocity_at(contact.acts_at);
  }
  result.cell_a = cell_of(contact.a);
  carried -= contact.slide;
  for (int d = 0; d < 3; ++d) {
    result.normal[d] = contact.normal[d];
    result.carried[d] = carried[d];
    result.point[d] = contact.point[d];
  }
  result.least_velocity = contact.least_velocity;
  result.mass = 1 / mobility;
  result.friction = contact.friction;
  result.push_velocity = push_velocity(contact, sides.a->spacing(), step);
  if (contact.holds_pushes) push_at_least_a_bit(result);
  return result;
}

/// In some directions across the normal the rigid body moves more easily than in others; friction is solved as if it moved in all
/// directions as easily as in the easiest one.
void meet_rigid(spu::SolveContact& solved, const SoftContact& contact, const ContactSides& sides,
                std::uint16_t number) {
  const ContactRigid& rigid = sides.rigids[contact.rigid];
  const float own = contact.a.mobility(sides.a->inverse_masses);
  const Vector3f arm = contact.acts_at - rigid.centre, &normal = contact.normal;
  const auto moved_by = [&](const Vector3f& impulse) -> Vector3f {
    const ContactRigid::Change change = rigid.change_by(impulse, arm.cross(impulse));
    return change.velocity + change.spin.cross(arm);
  };
  const Vector3f across = normal.unitOrthogonal(), also_across = normal.cross(across);
  const Vector3f by_across = moved_by(across);
  const float one = across.dot(by_across), other = also_across.dot(moved_by(also_across));
  const float mixed = also_across.dot(by_across), half = 0.5f * (one - other);
  const float most = 0.5f * (one + other) + std::sqrt(half * half + mixed * mixed);
  const Vector3f feels = own * normal + moved_by(normal);
  solved.rigid = {};
  solved.rigid.rigid = number;
  Vector3f::Map(solved.rigid.arm) = arm;
  Vector3f::Map(solved.rigid.feels) = feels;
  solved.rigid.push_mass = own > 0 ? 1 / own : 0;  // 0 of a body that sleeps
  solved.rigid.friction_mass = 1 / (own + most);
  solved.mass = 1 / normal.dot(feels);
}

namespace {

/// The anchor as the kernel has it. The kernel gives none for a body that sleeps: no impulse changes that.
Anchor anchor_of(const ContactBody& body, const spu::SolveAnchor& there, std::uint16_t cell) {
  Anchor anchor;
  anchor.cell = cell;
  for (std::size_t k = 0; k < 8; ++k) {
    anchor.particle[k] = there.particle[k];
    anchor.share[k] = there.weight[k] * body.model->root_masses[there.particle[k]];
  }
  return anchor;
}

}  // namespace

void hold_by_own_cells(spu::SolveContact& contact, const ContactBody& a, const ContactBody& b) {
  float mobility = 0;
  Vector3f carried = Vector3f::Zero();
  const auto hold = [&](spu::SolveAnchor& there, std::uint16_t& cell, const ContactBody& body, float sign) {
    if (body.asleep) return;
    const Anchor own = body.model->held(anchor_of(body, there, cell));
    there = as_kernels_solve_it(own, body.inverse_masses);
    cell = static_cast<std::uint16_t>(own.cell);
    mobility += own.mobility(body.inverse_masses);
    carried += sign * own.of(body.velocities);
  };
  hold(contact.a, contact.cell_a, a, -1);
  hold(contact.b, contact.cell_b, b, 1);
  contact.mass = 1 / mobility;
  for (int d = 0; d < 3; ++d) contact.carried[d] = carried[d];
}

void hold_pushes(SoftContact& contact, const ContactBody& a, const ContactBody* b) {
  contact.holds_pushes = true;
  contact.slide = contact.a.of(a.pushes);
  if (b != nullptr) contact.slide -= contact.b.of(b->pushes);
  contact.slide -= contact.normal.dot(contact.slide) * contact.normal;
}

void hold_pushes(spu::SolveContact& contact, const ContactBody& a, const ContactBody& b) {
  push_at_least_a_bit(contact);
  const Vector3f normal(contact.normal);
  const auto pushed = [](const ContactBody& body, const spu::SolveAnchor& there, std::uint16_t cell) {
    return body.asleep ? Vector3f(Vector3f::Zero()) : anchor_of(body, there, cell).of(body.pushes);
  };
  const Vector3f slide = pushed(a, contact.a, contact.cell_a) - pushed(b, contact.b, contact.cell_b);
  Vector3f::Map(contact.carried) -= slide - normal.dot(slide) * normal;
}

void iterate(std::span<SoftContact> contacts, const ContactSides& sides, float step) {
  for (SoftContact& contact : contacts) {
    solve_normal(contact, sides, step);
    solve_friction(contact, sides);
    solve_push(contact, sides, step);
  }
}

}  // namespace softcell::ppu
