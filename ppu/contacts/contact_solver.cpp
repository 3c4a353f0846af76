#include "ppu/contacts/contact_solver.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "ppu/contacts/find_contacts.h"
#include "ppu/contacts/obstacle_contacts.h"
#include "ppu/numbers/keep_each_once.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

[[noreturn]] void refuse_to_be_infinite() {
  throw std::runtime_error(
      "a soft body has positions or velocities that are not finite numbers, or passes 1e15 m");
}

/// Also checks numbers that will be squared.
void check_finite(const ContactBody& body) {
  constexpr float kFarthest = 1e15f;  // metres
  bool finite = (body.box.high - body.box.low).cwiseAbs().maxCoeff() < kFarthest;
  for (const Vector3f& end : body.ends) finite = finite && end.cwiseAbs().maxCoeff() < kFarthest;
  if (!finite) refuse_to_be_infinite();
}

/// The mean of a quantity of the anchor's particles, weighted by their shares.
template <typename OfParticle>
Vector3f of_anchor(const Anchor& anchor, const ContactBody& /*body*/, const OfParticle& of_particle) {
  Vector3f sum = Vector3f::Zero();
  for (std::size_t k = 0; k < 8; ++k) sum += anchor.share[k] * of_particle(anchor.particle[k]);
  return sum;
}
/// The kernel's weights are shares times roots of inverse masses.
template <typename OfParticle>
Vector3f of_anchor(const spu::SolveAnchor& anchor, const ContactBody& body, const OfParticle& of_particle) {
  Vector3f sum = Vector3f::Zero();
  for (std::size_t k = 0; k < 8; ++k) {
    const std::size_t particle = anchor.particle[k];
    if (particle >= body.positions.size()) continue;  // the slot of zeros
    sum += anchor.weight[k] * body.model->root_masses[particle] * of_particle(particle);
  }
  return sum;
}

/// Whether supports may hold a rigid body that something presses in a direction: they know nothing of the axes along which its engine does
/// not let it move.
bool moves_freely_along(const ContactRigid& rigid, const Vector3f& direction) {
  constexpr float kNearlyAll = 0.9f;
  if (rigid.inverse_mass == 0) return false;
  return !rigid.held || direction.dot(rigid.held->linear * direction) > kNearlyAll * rigid.inverse_mass;
}

/// From a point to the anchor's place before the step.
Vector3f arm_of(const auto& anchor, const ContactBody& body, const Vector3f& point) {
  return of_anchor(anchor, body, [&](std::size_t i) -> Vector3f { return body.positions[i] - point; });
}
Vector3f velocity_of(const auto& anchor, const ContactBody& body) {
  return of_anchor(anchor, body, [&](std::size_t i) -> Vector3f { return body.velocities[i]; });
}

}  // namespace

Bounds<3> box_of_step(std::span<const Vector3f> positions, std::span<const Vector3f> velocities, float step) {
  SC_ASSERT(!positions.empty() && velocities.size() == positions.size(), "{} velocities of {} particles",
            velocities.size(), positions.size());
  Bounds<3> box{positions[0], positions[0]};
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vector3f end = positions[i] + step * velocities[i];
    box.low = box.low.cwiseMin(positions[i]).cwiseMin(end);
    box.high = box.high.cwiseMax(positions[i]).cwiseMax(end);
  }
  return box;
}

void ContactSolver::remember_crushed(std::uint32_t body) {
  if (crushed_count_ == crushed_.size()) crushed_.emplace_back();
  Crushed& crushed = crushed_[crushed_count_++];
  crushed.body = body;
  crushed.moment = crushed_cells_.moment();
  crushed.pushes.assign(bodies_[body].pushes.begin(), bodies_[body].pushes.end());
}

void ContactSolver::take_over(std::span<const BodyInSubstep> bodies, float step) {
  bodies_.resize(bodies.size());
  cells_.resize(bodies.size());
  is_crushed_.resize(bodies.size());
  crushed_count_ = 0;
  // Resizes it now, before bodies refer to it.
  for (const BodyInSubstep& body : bodies)
    nothing_moves_.resize(std::max(nothing_moves_.size(), body.positions.size()));
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const BodyInSubstep& soft = bodies[i];
    ContactBody& body = bodies_[i];
    body.model = soft.model;
    body.positions = soft.positions;
    body.velocities.assign(soft.velocities.begin(), soft.velocities.end());
    body.pushes.assign(body.velocities.size(), Vector3f::Zero());
    body.ends.resize(body.velocities.size());
    body.friction = soft.friction;
    body.restitution = soft.restitution;
    body.box = soft.box;
    body.asleep = soft.asleep;
    body.sides = soft.sides;
    body.sides->begin_substep();
    body.inverse_masses_if_held.clear();
    body.inverse_masses = body.asleep ? std::span<const float>(nothing_moves_).first(body.ends.size())
                                      : body.model->inverse_masses;
    is_crushed_[i] = false;
    bool velocities_changed = false;
    if (!body.asleep) {
      velocities_changed = crushed_cells_.hold(body, step);
      is_crushed_[i] = crushed_cells_.count() > 0;
      if (velocities_changed || is_crushed_[i]) remember_crushed(static_cast<std::uint32_t>(i));
    }
    body.travel.setZero();
    for (std::size_t p = 0; p < body.ends.size(); ++p) {
      const Vector3f way = step * body.velocities[p];
      body.ends[p] = body.positions[p] + way;
      body.travel += way;
    }
    body.travel /= static_cast<float>(body.ends.size());
    if (velocities_changed) {  // since the box was computed
      for (const Vector3f& end : body.ends) {
        body.box.low = body.box.low.cwiseMin(end);
        body.box.high = body.box.high.cwiseMax(end);
      }
    }
    check_finite(body);
    cells_[i].begin(body);
  }
}

/// Finds the particles that rigid bodies cannot push away, however heavy these are. Otherwise each round would give way by no more than the
/// particles' own masses resist.
void ContactSolver::find_held(std::span<const ContactRigid> rigids, float step) {
  if (!has_attachments()) return;
  held_.clear();
  attachments->append_held(rigids, step, held_);
  for (const HeldParticle<3>& held : held_)
    if (!bodies_[held.body].asleep) bodies_[held.body].hold(held.particle, held.velocity, held.most_impulse);
}

bool ContactSolver::may_touch(std::uint32_t a, std::uint32_t b, std::span<const BodyInSubstep> bodies) const {
  if (bodies[a].asleep && bodies[b].asleep) return false;
  if (a == b) return bodies[a].self_contacts && may_touch_itself(bodies_[a]);
  if (!bodies[a].filter.may_touch(bodies[b].filter)) return false;
  return !has_attachments() || !attachments->parts(a, b);
}

/// Pairs of bodies whose boxes overlap, and folded bodies with themselves, in ascending order.
void ContactSolver::find_pairs(std::span<const BodyInSubstep> bodies) {
  by_low_.resize(bodies.size());
  std::iota(by_low_.begin(), by_low_.end(), 0u);
  std::sort(by_low_.begin(), by_low_.end(), [&](std::uint32_t i, std::uint32_t j) {
    return std::pair(bodies_[i].box.low.x(), i) < std::pair(bodies_[j].box.low.x(), j);
  });
  pairs_.clear();
  for (std::size_t i = 0; i < by_low_.size(); ++i) {
    const Bounds<3>& box = bodies_[by_low_[i]].box;
    for (std::size_t j = i; j < by_low_.size() && bodies_[by_low_[j]].box.low.x() <= box.high.x(); ++j) {
      const std::uint32_t a = std::min(by_low_[i], by_low_[j]), b = std::max(by_low_[i], by_low_[j]);
      if (overlap(box, bodies_[by_low_[j]].box) && may_touch(a, b, bodies)) pairs_.emplace_back(a, b);
    }
  }
  std::sort(pairs_.begin(), pairs_.end());
}

ContactSolver::Group& ContactSolver::next_group(std::uint32_t a, std::uint32_t b, bool with_rigid) {
  if (group_count_ == groups_.size()) groups_.emplace_back();
  Group& group = groups_[group_count_++];
  group.a = a, group.b = b, group.with_rigid = with_rigid;
  group.by_worker = group.heavy = group.alternates = group.fast = group.sharp = group.on_held = false;
  group.contacts.clear();
  group.solved = {};
  group.rigid_set = RigidSets::kNone;
  return group;
}

/// Looks for points of both bodies.
void ContactSolver::find_here(Group& group, float step) {
  const ContactBody &a = bodies_[group.a], &b = bodies_[group.b];
  group.fast = group.a != group.b && are_fast(a, b);
  if (group.fast)
    swept_.find(a, b, step, group.contacts);
  else
    find_contacts(a, cells_[group.a], b, cells_[group.b], step, group.contacts);
  if (group.a == group.b) return;
  other_way_.clear();
  if (group.fast)
    swept_.find(b, a, step, other_way_);
  else
    find_contacts(b, cells_[group.b], a, cells_[group.a], step, other_way_);
  for (SoftContact& contact : other_way_) {
    std::swap(contact.a, contact.b);
    contact.normal = -contact.normal;
    group.contacts.push_back(contact);
  }
}

/// For contacts that the worker has found.
void ContactSolver::hold_by_own_cells(Group& group) {
  const ContactBody &a = bodies_[group.a], &b = bodies_[group.b];
  if (!a.model->is_flat() && !b.model->is_flat()) return;
  for (spu::SolveContact& contact : group.solved.contacts) ppu::hold_by_own_cells(contact, a, b);
}

/// Waits for the worker's results.
void ContactSolver::find_among_bodies(float step) {
  const std::span<const FoundContacts> found =
      asked_.empty() ? std::span<const FoundContacts>() : worker->found();
  std::size_t next = 0;
  for (const auto& pair : pairs_) {
    Group& group = next_group(pair.first, pair.second, false);
    if (next < asked_.size() && asked_[next] == pair) {
      group.solved = found[next++];
      group.by_worker = !group.solved.by_caller;
    }
    if (group.by_worker)
      hold_by_own_cells(group);
    else
      find_here(group, step);
    if (group.size() == 0) --group_count_;
  }
}

void ContactSolver::find_with_rigid(std::span<const BodyInSubstep> bodies,
                                    std::span<const Obstacle> obstacles, std::span<const ContactRigid> rigids,
                                    float step) {
  for (std::uint32_t a = 0; a < bodies_.size(); ++a) {
    if (bodies[a].obstacles.empty()) continue;
    Group& group = next_group(a, a, true);
    find_contacts({bodies_[a], cells_[a], obstacles, bodies[a].obstacles, rigids, step}, group.contacts);
    group.sharp = sharp_contacts_.keep(group.contacts, bodies_[a]);
    for (SoftContact& contact : group.contacts) {
      contact.on_held = rigids[contact.rigid].inverse_mass > 0 && bodies_[a].holds(contact.a);
      group.on_held = group.on_held || contact.on_held;
    }
    if (group.contacts.empty()) --group_count_;
  }
}

/// Orders groups: pairs by ContactOrder; then groups with moving rigid bodies; then those with static ones.
void ContactSolver::put_in_order() {
  pairs_.clear();
  for (std::size_t i = 0; i < pair_groups_; ++i) pairs_.emplace_back(groups_[i].a, groups_[i].b);
  order_.arrange(bodies_, pairs_);
}

/// Pushes that move a body's cells apart must not move it into others.
void ContactSolver::hold_pushes_of_crushed_bodies() {
  for (std::size_t i = 0; i < group_count_; ++i) {
    Group& group = groups_[i];
    if (!is_crushed_[group.a] && !is_crushed_[group.b]) continue;
    for (SoftContact& contact : group.contacts) contact.holds_pushes = true;
    if (!group.by_worker) continue;
    for (spu::SolveContact& contact : group.solved.contacts) hold_pushes(contact);
    group.solved.pushes = true;
  }
}

/// Cells that get their volume back in a slant push their lower corners one way and their upper ones the other. What the body lies on holds
/// it against that by friction, too; a crushed body would crawl over level ground otherwise.
void ContactSolver::hold_pushes_by_friction(const Group& group, std::span<const ContactRigid> rigids) {
  constexpr int kIterations = 3;
  const ContactBody& body = bodies_[group.a];
  for (int i = 0; i < kIterations; ++i)
    for (std::size_t c = 0; c < group.contacts.size(); ++c) {
      const SoftContact& contact = group.contacts[c];
      if (rigids[contact.rigid].inverse_mass != 0) continue;
      const Vector3f impulse = group.whole_impulse(c);
      const float pressing = group.impulse(c);
      const float left = contact.friction * pressing - (impulse - pressing * contact.normal).norm();
      const Vector3f push = contact.a.of(body.pushes);
      const Vector3f along = push - contact.normal.dot(push) * contact.normal;
      const float speed = along.norm(), mobility = contact.a.mobility(body.inverse_masses);
      if (left <= 0 || speed == 0) continue;
      contact.a.add(bodies_[group.a].pushes, body.inverse_masses,
                    -std::min(1 / mobility, left / speed) * along);
    }
}

/// Points near each other move the same particles. The mobility of each point is therefore taken for its share of all their impulses.
void ContactSolver::find_presses(const Group& group, std::span<const ContactRigid> rigids) {
  const ContactBody& body = bodies_[group.a];
  const auto for_each_press = [&](const auto& work) {
    for (const SoftContact& contact : group.contacts)
      if (moves_freely_along(rigids[contact.rigid], contact.normal)) work(contact);
  };
  moved_by_all_.resize(std::max(moved_by_all_.size(), body.velocities.size()));
  for_each_press([&](const SoftContact& contact) {
    for (const std::uint32_t particle : contact.a.particle) moved_by_all_[particle] = 0;
  });
  for_each_press([&](const SoftContact& contact) {
    for (std::size_t k = 0; k < 8; ++k)
      moved_by_all_[contact.a.particle[k]] += contact.a.share[k] * body.inverse_masses[contact.a.particle[k]];
  });
  for_each_press([&](const SoftContact& contact) {
    float mobility = 0;
    for (std::size_t k = 0; k < 8; ++k) mobility += contact.a.share[k] * moved_by_all_[contact.a.particle[k]];
    mobility = std::max(mobility, contact.a.mobility(body.inverse_masses));
    presses_.push_back({contact.rigid, contact.acts_at, contact.normal, 1 / mobility,
                        contact.a.of(body.velocities), contact.friction, body.spacing()});
  });
}

void ContactSolver::find_supports(std::span<ContactRigid> rigids, const RigidLinks& links, float step) {
  presses_.clear();
  if (!links.empty())
    for (std::size_t i = pair_groups_; i < group_count_; ++i) find_presses(groups_[i], rigids);
  supports_.hold(rigids, links, presses_, step);
}

/// Finds out which groups feel what holds the particles that rigid bodies press on, and not the particles' own masses. An attachment that
/// cannot stop them breaks: if it were felt, the particles would keep the impulse that it does not carry. Call it after find_supports().
void ContactSolver::find_who_feels_what_holds(std::span<const ContactRigid> rigids) {
  held_presses_.clear();
  for (std::size_t i = pair_groups_; i < group_count_; ++i)
    if (groups_[i].on_held) add_held_presses(groups_[i]);
  for (std::size_t i = pair_groups_; i < group_count_; ++i) {
    Group& group = groups_[i];
    if (!group.on_held) continue;
    group.on_held = !breaks_what_holds(group, rigids);
    // All contacts with held particles see the same velocities, static ones, too. Otherwise each of two that press on a cell from both
    // sides undoes what it believes that the other has done, and more.
    for (SoftContact& contact : group.contacts)
      contact.on_held = group.on_held && bodies_[group.a].holds(contact.a);
  }
}

/// Adds up the contacts with held particles by rigid bodies.
void ContactSolver::add_held_presses(const Group& group) {
  for (const SoftContact& contact : group.contacts) {
    if (!contact.on_held) continue;
    HeldPress& press = held_press_of(contact.rigid);
    press.points += contact.acts_at;
    press.normals += contact.normal;
    ++press.contacts;
  }
}

/// Whether rigid bodies press more on a soft one than some of the attachments carry that hold it. These will break.
bool ContactSolver::breaks_what_holds(const Group& group, std::span<const ContactRigid> rigids) {
  const ContactBody& body = bodies_[group.a];
  for (HeldPress& press : held_presses_) press.contacts_of_body = 0;
  for (const SoftContact& contact : group.contacts)
    if (contact.on_held) ++held_press_of(contact.rigid).contacts_of_body;
  bool breaks = false;
  for (const SoftContact& contact : group.contacts) {
    const float most = body.most_impulse_if_held(contact.a);
    if (!contact.on_held || std::isinf(most)) continue;
    const float impulse =
        held_press_of(contact.rigid).impulse_to_stop(rigids[contact.rigid], body.velocity_if_held(contact.a));
    breaks = breaks || impulse > most;
    press_on_attachments(group.a, contact.a, impulse);
  }
  return breaks;
}

ContactSolver::HeldPress& ContactSolver::held_press_of(std::uint32_t rigid) {
  const auto press = std::ranges::find(held_presses_, rigid, &HeldPress::rigid);
  return press != held_presses_.end() ? *press : held_presses_.emplace_back(HeldPress{.rigid = rigid});
}

float ContactSolver::HeldPress::impulse_to_stop(const ContactRigid& by, const Vector3f& held_velocity) const {
  const Vector3f point = points / static_cast<float>(contacts), normal = normals.normalized();
  const float mobility = by.mobility(point, normal);
  const float share = static_cast<float>(contacts_of_body) / static_cast<float>(contacts);
  return mobility > 0 ? share * normal.dot(by.velocity_at(point) - held_velocity) / mobility : 0;
}

/// Tells the attachments that hold one of the anchor's particles. @param impulse  kg m/s
void ContactSolver::press_on_attachments(std::uint32_t body, const Anchor& anchor, float impulse) {
  for (const HeldParticle<3>& held : held_)
    if (held.body == body && anchor.share_of(held.particle) != 0)
      attachments->press(held.attachment, impulse > held.most_impulse);
}

void ContactSolver::release_supports() {
  if (supports_.empty()) return;
  for (std::size_t i = pair_groups_; i < group_count_; ++i) {
    const Group& group = groups_[i];
    for (std::size_t c = 0; c < group.contacts.size(); ++c)
      supports_.add_impulse(group.contacts[c].rigid, group.contacts[c].acts_at, -group.whole_impulse(c));
  }
  bounces_.for_each_impulse_on_rigid(
      [&](std::uint32_t rigid, const Vector3f& point, const Vector3f& impulse) {
        supports_.add_impulse(rigid, point, impulse);
      });
  supports_.release();
}

/// Collects contacts of bodies with a restitution, and contacts with sharp things, whether found by the worker or here. Two bodies that
/// pressed on each other in the last substep do not hit each other: their relative motion is deformation.
void ContactSolver::bounce(std::span<ContactRigid> rigids, float step) {
  for (std::size_t i = 0; i < group_count_; ++i) {
    const Group& group = groups_[i];
    const ContactBody &a = bodies_[group.a], &b = bodies_[group.b];
    const bool itself = !group.with_rigid && group.a == group.b;
    if ((!settings.bounces.may_bounce(a.restitution) && !group.fast && !group.sharp) || itself) continue;
    const auto restitution_with = [&](float other) {
      const float both = settings.bounces.restitution_of(a.restitution, other);
      return group.fast ? std::max(both, kFastRestitution) : both;
    };
    BounceContact bounce{.a = group.a};
    if (!group.with_rigid) bounce.b = group.b;
    const auto add = [&](std::uint32_t other, const Vector3f& point, const Vector3f& normal,
                         float least_velocity, float along, float friction, float restitution, float room) {
      const std::array<std::uint32_t, 3> pair{group.a, other, group.with_rigid};
      const bool bounces = restitution > 0 && -along > settings.bounces.least_speed &&
                           !std::binary_search(pressed_.begin(), pressed_.end(), pair);
      bounce.room = bounces ? BounceContact::kNoLimit : room;
      if (!bounces && !bounce.is_sharp()) return;
      bounce.point = point, bounce.normal = normal;
      bounce.gap = -step * least_velocity, bounce.approach = -along;
      bounce.friction = friction, bounce.restitution = std::min(restitution, 1.0f);
      bounces_.add(bounce);
    };
    // Contacts with rigid bodies were found here, even if the worker will solve them.
    if (group.by_worker && !group.with_rigid) {
      for (const spu::SolveContact& contact : group.solved.contacts) {
        const Vector3f normal(contact.normal);
        add(group.b, Vector3f(contact.point), normal, contact.least_velocity,
            -normal.dot(Vector3f(contact.carried)), contact.friction, restitution_with(b.restitution),
            BounceContact::kNoLimit);
      }
      continue;
    }
    for (const SoftContact& contact : group.contacts) {
      Vector3f v = contact.a.of(a.velocities);
      if (group.with_rigid) {
        const ContactRigid& rigid = rigids[contact.rigid];
        v -= rigid.velocity_at(contact.acts_at);
        bounce.rigid = contact.rigid;
        bounce.cell = contact.a.cell;
        add(rigid.number, contact.point, contact.normal, contact.least_velocity, contact.normal.dot(v),
            contact.friction, restitution_with(contact.restitution), contact.room);
      } else {
        v -= contact.b.of(b.velocities);
        add(group.b, contact.point, contact.normal, contact.least_velocity, contact.normal.dot(v),
            contact.friction, restitution_with(b.restitution), contact.room);
      }
    }
  }
  if (!bounces_.empty()) bounces_.solve(bodies_, rigids, settings.bounces, step);
}

/// Remembers them for the bounces of the next substep.
void ContactSolver::remember_who_presses(std::span<const ContactRigid> rigids) {
  pressed_.clear();
  for (std::size_t i = 0; i < group_count_; ++i) {
    const Group& group = groups_[i];
    if (!settings.bounces.may_bounce(bodies_[group.a].restitution)) continue;
    const auto remember = [&](std::size_t c, float impulse) {
      if (!(impulse > 0)) return;
      const std::uint32_t other = group.with_rigid ? rigids[group.contacts[c].rigid].number : group.b;
      const std::array<std::uint32_t, 3> pair{group.a, other, group.with_rigid};
      if (pressed_.empty() || pressed_.back() != pair) pressed_.push_back(pair);
    };
    for (std::size_t c = 0; c < group.size(); ++c) remember(c, group.impulse(c));
  }
  std::sort(pressed_.begin(), pressed_.end());
}

void ContactSolver::find_touched_cells() {
  touched_.resize(bodies_.size());
  // Most cells are touched at several points. Room for each cell twice is enough.
  const auto add = [&](std::uint32_t body, std::uint32_t cell) {
    std::vector<std::uint32_t>& cells = touched_[body];
    if (cells.size() == cells.capacity()) keep_each_once(cells);
    cells.push_back(cell);
  };
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    touched_[i].clear();
    touched_[i].reserve(2 * bodies_[i].lattice().cells.size());
  }
  for (std::size_t i = 0; i < group_count_; ++i) {
    const Group& group = groups_[i];
    const auto touch = [&](std::uint32_t cell_a, std::uint32_t cell_b) {
      add(group.a, cell_a);
      if (!group.with_rigid) add(group.b, cell_b);
    };
    if (group.by_worker)
      for (const spu::SolveContact& contact : group.solved.contacts) touch(contact.cell_a, contact.cell_b);
    else
      for (const SoftContact& contact : group.contacts) touch(contact.a.cell, contact.b.cell);
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (bodies_[i].asleep) touched_[i].clear();
    keep_each_once(touched_[i]);
  }
}

void ContactSolver::stiffen_touched_cells() {
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    for (const std::uint32_t cell : touched_[i]) stiffen(bodies_[i], cell, settings.stiffening);
}

void ContactSolver::step(std::span<const BodyInSubstep> bodies, std::span<const Obstacle> obstacles,
                         std::span<ContactRigid> rigids, const RigidLinks& links, float step) {
  take_over(bodies, step);
  find_held(rigids, step);
  group_count_ = 0;
  bounces_.clear();
  find_pairs(bodies);
  asked_.clear();
  if (worker != nullptr) {
    worker->begin(bodies_, step);
    for (const auto& [a, b] : pairs_)
      if (worker->holds(a) && worker->holds(b) && (a == b || !are_fast(bodies_[a], bodies_[b])))
        asked_.emplace_back(a, b);
    if (!asked_.empty()) worker->find(asked_);
  }
  // Runs while the worker looks at pairs. The groups found here are moved behind those of pairs afterwards.
  find_with_rigid(bodies, obstacles, rigids, step);
  const std::size_t rigid_groups = group_count_;
  find_among_bodies(step);
  pair_groups_ = group_count_ - rigid_groups;
  const auto groups = groups_.begin();
  std::rotate(groups, groups + std::ptrdiff_t(rigid_groups), groups + std::ptrdiff_t(group_count_));
  put_in_order();
  hold_pushes_of_crushed_bodies();
  find_supports(rigids, links, step);
  find_who_feels_what_holds(rigids);
  if (group_count_ != 0 || has_attachments()) {
    if (worker != nullptr)
      solve_with_worker(rigids, step);
    else
      solve_here(rigids, step);
    for (std::size_t i = pair_groups_; i < group_count_; ++i)
      if (is_crushed_[groups_[i].a]) hold_pushes_by_friction(groups_[i], rigids);
  }
  take_back_lost_spin(step);
  release_supports();
  remember_who_presses(rigids);
}

void ContactSolver::iterate_here(std::span<Group* const> groups, std::span<ContactRigid> rigids, float step) {
  for_each_turn(groups, [&](Group& group, int iterations) {
    const ContactSides sides{&bodies_[group.a], group.with_rigid ? nullptr : &bodies_[group.b], rigids};
    for (int i = 0; i < iterations; ++i) iterate(group.contacts, sides, step);
  });
}

/// Solves groups in the same order as a worker would, and then those that are left.
void ContactSolver::solve_here(std::span<ContactRigid> rigids, float step) {
  bounce(rigids, step);
  here_.clear();
  for (const std::uint32_t i : order_.order()) here_.push_back(&groups_[i]);
  weigh_rigid_groups(rigids);
  add_rigid_groups(rigids);
  prepare_here(rigids);
  find_touched_cells();
  const std::span<Group* const> moving = std::span(here_).first(here_that_move_);
  for (int round = 0; round < rounds(); ++round) {
    if (round > 0) stiffen_touched_cells();
    iterate_here(moving, rigids, step);
    solve_attachments(rigids, step, round);
    iterate_here(std::span(here_).subspan(here_that_move_), rigids, step);
  }
}

/// Each round solves what contacts have left. The last one limits pushes before contacts push for the last time, so that contacts push
/// against the limited ones.
void ContactSolver::solve_attachments(std::span<ContactRigid> rigids, float step, int round) {
  if (!has_attachments()) return;
  if (round == 0) begin_attachments(rigids, step);
  attachments->iterate(attachment_iterations());
  if (round + 1 == rounds()) attachments->finish();
}

void ContactSolver::begin_attachments(std::span<ContactRigid> rigids, float step) {
  attached_.clear();
  for (ContactBody& body : bodies_)
    attached_.push_back(
        {body.positions, body.velocities, body.pushes, body.inverse_masses, body.spacing(), body.asleep});
  attachments->begin(attached_, rigids, step);
}

void ContactSolver::weigh_rigid_groups(std::span<const ContactRigid> rigids) {
  // As a share of the soft bodies' mass. In one iteration, a lighter rigid body passes on little of one soft body's impulse to another.
  constexpr float kLight = 0.2f;
  touched_rigids_.assign(rigids.size(), {});
  for (std::size_t i = pair_groups_; i < group_count_; ++i) {
    const float mass = bodies_[groups_[i].a].model->mass();
    for (const SoftContact& contact : groups_[i].contacts) {
      if (rigids[contact.rigid].inverse_mass == 0) continue;
      TouchedRigid& touched = touched_rigids_[contact.rigid];
      if (touched.first == TouchedRigid::kNobody)
        touched = {.first = i, .by_several = false, .lightest = mass};
      if (touched.first != i) touched.by_several = true;
      touched.lightest = std::min(touched.lightest, mass);
    }
  }
  for (std::size_t i = pair_groups_; i < group_count_; ++i) {
    Group& group = groups_[i];
    for (const SoftContact& contact : group.contacts) {
      const float inverse_mass = rigids[contact.rigid].inverse_mass;
      const TouchedRigid& touched = touched_rigids_[contact.rigid];
      if (inverse_mass == 0) continue;
      group.heavy = group.heavy || inverse_mass * bodies_[group.a].model->mass() < 1;
      group.alternates =
          group.alternates ||
          (touched.by_several && (contact.on_held || kLight * inverse_mass * touched.lightest > 1));
    }
  }
}

/// Groups with moving rigid bodies come before groups with static ones.
void ContactSolver::add_rigid_groups(std::span<const ContactRigid> rigids) {
  const auto with_moving = [&](const Group& group) {
    return std::any_of(group.contacts.begin(), group.contacts.end(),
                       [&](const SoftContact& contact) { return rigids[contact.rigid].inverse_mass != 0; });
  };
  for (const bool moving : {true, false}) {
    for (std::size_t i = pair_groups_; i < group_count_; ++i)
      if (!groups_[i].by_worker && with_moving(groups_[i]) == moving) here_.push_back(&groups_[i]);
    if (moving) here_that_move_ = here_.size();
  }
}

void ContactSolver::prepare_here(std::span<ContactRigid> rigids) {
  for (Group* const group : here_)
    prepare(group->contacts, {&bodies_[group->a], group->with_rigid ? nullptr : &bodies_[group->b], rigids});
}

/// Finds out which bodies touch nothing rigid, nor any that does: together these keep their angular momentum.
void ContactSolver::find_free_bodies() {
  find_islands(islands_);
  is_free_.assign(bodies_.size(), true);
  for (std::size_t g = pair_groups_; g < group_count_; ++g) is_free_[islands_.find(groups_[g].a)] = false;
  for (std::uint32_t i = 0; i < bodies_.size(); ++i)  // attachments hold some
    if (!bodies_[i].inverse_masses_if_held.empty()) is_free_[islands_.find(i)] = false;
  for (std::uint32_t i = 0; i < bodies_.size(); ++i) is_free_[i] = is_free_[islands_.find(i)];
}

/// Sums up pairs of soft bodies, and crushed ones that are free. Rigid and sleeping bodies are not counted here. A push moves particles
/// together with their momenta.
void ContactSolver::take_back_lost_spin(float step) {
  using Eigen::Vector3d;
  lost_spin_.begin(bodies_.size());
  for (std::size_t g = 0; g < pair_groups_; ++g) {
    const Group& group = groups_[g];
    const ContactBody &a = bodies_[group.a], &b = bodies_[group.b];
    if (a.asleep || b.asleep) continue;
    Vector3d given = Vector3d::Zero();
    const auto add = [&](const auto& contact, const Vector3f& point, const Vector3f& normal,
                         const Vector3f& friction_impulse) {
      const Vector3f impulse = contact.impulse * normal + friction_impulse;
      if (!impulse.isZero(0)) {
        const Vector3f apart = arm_of(contact.a, a, point) - arm_of(contact.b, b, point);
        given += apart.cast<double>().cross(impulse.cast<double>());
      }
      if (contact.push != 0) {
        const Vector3f against = velocity_of(contact.a, a) - velocity_of(contact.b, b);
        given += double{step * contact.push} * normal.cast<double>().cross(against.cast<double>());
      }
    };
    if (group.by_worker) {
      for (const spu::SolveContact& contact : group.solved.contacts)
        add(contact, Vector3f(contact.point), Vector3f(contact.normal), Vector3f(contact.friction_impulse));
    } else {
      for (const SoftContact& contact : group.contacts)
        add(contact, contact.point, contact.normal, contact.friction_impulse);
    }
    if (!given.allFinite()) refuse_to_be_infinite();  // velocities overflowed in this step
    lost_spin_.add(bodies_, group.a, group.b, given);
  }
  if (crushed_count_ > 0) find_free_bodies();
  for (const Crushed& crushed : std::span(crushed_).first(crushed_count_)) {
    if (!is_free_[crushed.body]) continue;
    const ContactBody& body = bodies_[crushed.body];
    Vector3d given = crushed.moment;
    for (std::size_t p = 0; p < crushed.pushes.size(); ++p) {
      const Vector3d moved = double{step} * crushed.pushes[p].cast<double>();
      given += double{body.model->masses()[p]} * moved.cross(body.velocities[p].cast<double>());
    }
    if (!given.allFinite()) refuse_to_be_infinite();
    lost_spin_.add(bodies_, crushed.body, crushed.body, given);
  }
  lost_spin_.take_back(bodies_);
}

void ContactSolver::find_islands(DisjointSets& islands) const {
  islands.reset(bodies_.size());
  for (std::size_t g = 0; g < pair_groups_; ++g) {
    const Group& group = groups_[g];
    for (std::size_t c = 0; c < group.size(); ++c) {
      if (!(group.impulse(c) > 0)) continue;
      islands.unite(group.a, group.b);
      break;
    }
  }
}

void ContactSolver::append_contacts(std::vector<PressingContact>& contacts) const {
  for (std::size_t i = 0; i < group_count_; ++i) {
    const Group& group = groups_[i];
    const auto append = [&](float impulse, std::uint32_t rigid, const Vector3f& point,
                            const Vector3f& normal) {
      if (impulse > 0)
        contacts.push_back({group.a, group.b, group.with_rigid, rigid, point, normal, impulse});
    };
    for (std::size_t c = 0; c < group.size(); ++c) {
      if (group.by_worker && !group.with_rigid) {
        const spu::SolveContact& contact = group.solved.contacts[c];
        append(contact.impulse, 0, Vector3f(contact.point), Vector3f(contact.normal));
      } else {  // contacts with rigid bodies were found here, even if the worker has solved them
        const SoftContact& contact = group.contacts[c];
        const Vector3f on_rigid = contact.point - contact.above * contact.normal;
        append(group.impulse(c), contact.rigid, group.with_rigid ? on_rigid : contact.point, contact.normal);
      }
    }
  }
  bounces_.for_each_impulse([&](const BounceContact& bounce, float impulse) {
    const bool with_rigid = bounce.b == BounceContact::kNobody;
    contacts.push_back({bounce.a, with_rigid ? bounce.a : bounce.b, with_rigid, bounce.rigid, bounce.point,
                        bounce.normal, impulse});
  });
}

}  // namespace softcell::ppu
