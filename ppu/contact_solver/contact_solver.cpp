#include "ppu/contact_solver/contact_solver.h"

#include <algorithm>
#include <cstddef>

#include "ppu/contact_solver/given_spin.h"
#include "ppu/contacts/finite_bodies.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

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

void ContactSolver::step(std::span<const BodyInSubstep> bodies, std::span<const Obstacle> obstacles,
                         std::span<ContactRigid> rigids, const RigidLinks& links, float step) {
  take_over(bodies, step);
  if (has_attachments()) held_presses_.hold(bodies_, *attachments, rigids, step);
  search_.find({bodies, bodies_, obstacles, rigids, has_attachments() ? attachments : nullptr, worker, step},
               groups_);
  pairs_.clear();
  for (const ContactGroup& group : groups_.of_pairs()) pairs_.emplace_back(group.a, group.b);
  order_.arrange(bodies_, pairs_);
  crushed_.hold_pushes(groups_.all(), bodies_);
  find_supports(rigids, links, step);
  if (has_attachments()) held_presses_.choose(groups_.with_rigid(), bodies_, *attachments, rigids);
  bounces_.clear();
  if (!groups_.empty() || has_attachments()) {
    if (worker != nullptr)
      solve_with_worker(rigids, step);
    else
      solve_here(rigids, step);
  }
  take_back_lost_spin(step);
  release_supports();
  hits_.remember_who_presses(groups_.all(), bodies_, rigids, settings.bounces);
}

void ContactSolver::take_over(std::span<const BodyInSubstep> bodies, float step) {
  bodies_.resize(bodies.size());
  crushed_.begin(bodies.size());
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
    const bool velocities_changed = !body.asleep && crushed_.hold(static_cast<std::uint32_t>(i), body, step);
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
  }
}

void ContactSolver::find_supports(std::span<ContactRigid> rigids, const RigidLinks& links, float step) {
  presses_.clear();
  if (!links.empty())
    for (const ContactGroup& group : groups_.with_rigid()) presses_.add(group, bodies_[group.a], rigids);
  supports_.hold(rigids, links, presses_.all(), step);
}

void ContactSolver::release_supports() {
  if (supports_.empty()) return;
  for (const ContactGroup& group : groups_.with_rigid())
    for (std::size_t c = 0; c < group.contacts.size(); ++c)
      supports_.add_impulse(group.contacts[c].rigid, group.contacts[c].acts_at, -group.whole_impulse(c));
  bounces_.for_each_impulse_on_rigid(
      [&](std::uint32_t rigid, const Vector3f& point, const Vector3f& impulse) {
        supports_.add_impulse(rigid, point, impulse);
      });
  supports_.release();
}

void ContactSolver::bounce(std::span<ContactRigid> rigids, float step) {
  hits_.add_to(bounces_, groups_.all(), bodies_, rigids, settings.bounces, step);
  if (!bounces_.empty()) bounces_.solve(bodies_, rigids, settings.bounces, step);
}

/// Solves groups in the same order as a worker would, and then those that are left.
void ContactSolver::solve_here(std::span<ContactRigid> rigids, float step) {
  bounce(rigids, step);
  here_.clear();
  for (const std::uint32_t i : order_.order()) here_.push_back(&groups_[i]);
  turns_.weigh(groups_.with_rigid(), bodies_, rigids);
  add_rigid_groups(rigids);
  prepare_here(rigids);
  touched_.find(bodies_, groups_.all());
  const std::span<ContactGroup* const> moving = std::span(here_).first(here_that_move_);
  for (int round = 0; round < rounds(); ++round) {
    if (round > 0)
      for (std::size_t i = 0; i < bodies_.size(); ++i)
        touched_.stiffen_those_of(i, bodies_[i], settings.stiffening);
    iterate_here(moving, rigids, step);
    solve_attachments(rigids, step, round);
    iterate_here(std::span(here_).subspan(here_that_move_), rigids, step);
  }
}

/// Groups with moving rigid bodies come before groups with static ones.
void ContactSolver::add_rigid_groups(std::span<const ContactRigid> rigids) {
  const auto with_moving = [&](const ContactGroup& group) {
    return std::any_of(group.contacts.begin(), group.contacts.end(),
                       [&](const SoftContact& contact) { return rigids[contact.rigid].inverse_mass != 0; });
  };
  for (const bool moving : {true, false}) {
    for (ContactGroup& group : groups_.with_rigid())
      if (!group.by_worker && with_moving(group) == moving) here_.push_back(&group);
    if (moving) here_that_move_ = here_.size();
  }
}

void ContactSolver::prepare_here(std::span<ContactRigid> rigids) {
  for (ContactGroup* const group : here_)
    prepare(group->contacts, {&bodies_[group->a], group->with_rigid ? nullptr : &bodies_[group->b], rigids});
}

void ContactSolver::iterate_here(std::span<ContactGroup* const> groups, std::span<ContactRigid> rigids,
                                 float step) {
  for_each_turn(groups, settings, [&](ContactGroup& group, int iterations) {
    const ContactSides sides{&bodies_[group.a], group.with_rigid ? nullptr : &bodies_[group.b], rigids};
    for (int i = 0; i < iterations; ++i) iterate(group.contacts, sides, step);
  });
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

/// Finds out which bodies touch nothing rigid, nor any that does: together these keep their angular momentum.
void ContactSolver::find_free_bodies() {
  find_islands(islands_);
  is_free_.assign(bodies_.size(), true);
  for (const ContactGroup& group : groups_.with_rigid()) is_free_[islands_.find(group.a)] = false;
  for (std::uint32_t i = 0; i < bodies_.size(); ++i)  // attachments hold some
    if (!bodies_[i].inverse_masses_if_held.empty()) is_free_[islands_.find(i)] = false;
  for (std::uint32_t i = 0; i < bodies_.size(); ++i) is_free_[i] = is_free_[islands_.find(i)];
}

/// Of pairs of soft bodies, and of crushed ones that are free. Rigid and sleeping bodies are not counted here.
void ContactSolver::take_back_lost_spin(float step) {
  lost_spin_.begin(bodies_.size());
  for (const ContactGroup& group : groups_.of_pairs()) {
    if (bodies_[group.a].asleep || bodies_[group.b].asleep) continue;
    const Eigen::Vector3d given = given_spin(group, bodies_, step);
    if (!given.allFinite()) refuse_to_be_infinite();  // velocities overflowed in this step
    lost_spin_.add(bodies_, group.a, group.b, given);
  }
  if (crushed_.change_spin()) {
    find_free_bodies();
    crushed_.add_lost_spin(lost_spin_, bodies_, is_free_, step);
  }
  lost_spin_.take_back(bodies_);
}

void ContactSolver::find_islands(DisjointSets& islands) const {
  islands.reset(bodies_.size());
  for (const ContactGroup& group : groups_.of_pairs()) {
    for (std::size_t c = 0; c < group.size(); ++c) {
      if (!(group.impulse(c) > 0)) continue;
      islands.unite(group.a, group.b);
      break;
    }
  }
}

void ContactSolver::append_contacts(std::vector<PressingContact>& contacts) const {
  for (const ContactGroup& group : groups_.all()) {
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
