// What ContactSolver shares with its worker: which contacts and attachments the worker gets, and in which stages it solves them.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "ppu/contact_solver/contact_solver.h"

namespace softcell::ppu {

/// Whether the worker can solve contacts that this thread has found.
bool ContactSolver::can_hand_to_worker(const ContactGroup& group) const {
  return !group.by_worker && !group.on_held && group.contacts.size() <= ContactWorker::kMostContacts &&
         worker->holds(group.a) && worker->holds(group.b);
}

/// Finds the rigid bodies that the worker would move.
void ContactSolver::find_rigid_sets(std::span<ContactRigid> rigids) {
  rigid_sets_.begin(rigids);
  for (const ContactGroup& group : groups_.with_rigid()) {
    if (!can_hand_to_worker(group)) continue;
    std::uint32_t last = RigidSets::kNone;
    for (const SoftContact& contact : group.contacts) {
      if (rigids[contact.rigid].inverse_mass == 0 || contact.rigid == last) continue;
      rigid_sets_.join(contact.rigid, last == RigidSets::kNone ? contact.rigid : last);
      last = contact.rigid;
    }
  }
  if (has_attachments()) AttachUnits::begin(*attachments, rigid_sets_);
  rigid_sets_.arrange(*worker);
}

/// The worker gets the attachments if it also solves contacts, or if there are many: for a few of them a job takes longer than this thread.
bool ContactSolver::hand_attachments_to_worker(std::size_t rigids) {
  attach_units_.clear();
  if (!has_attachments()) return false;
  const bool with_contacts =
      std::ranges::any_of(groups_.all(), [](const ContactGroup& group) { return group.by_worker; });
  if (!with_contacts && attachments->solved() < kManyAttachments) return false;
  for (std::size_t i = 0; i < attachments->solved(); ++i) {
    const AttachmentSides sides = attachments->sides(i);
    if (!worker->holds(sides.a) || (sides.b != AttachmentSides::kNone && !worker->holds(sides.b)))
      return false;
  }
  if (!attach_units_.write(*attachments, bodies_.size(), rigids, rigid_sets_)) return false;
  worker->hold(attach_units_.units(), static_cast<std::uint32_t>(attachment_iterations()));
  return true;
}

/// Copies contacts to the worker's memory if it can solve them.
void ContactSolver::hand_to_worker(ContactGroup& group, std::span<ContactRigid> rigids, float step) {
  if (!can_hand_to_worker(group)) return;
  const ContactSides sides{&bodies_[group.a], group.with_rigid ? nullptr : &bodies_[group.b], rigids};
  if (group.with_rigid) {
    const auto moving =
        std::find_if(group.contacts.begin(), group.contacts.end(),
                     [&](const SoftContact& contact) { return rigids[contact.rigid].inverse_mass != 0; });
    if (moving != group.contacts.end()) {
      group.rigid_set = rigid_sets_.set_of(moving->rigid);
      if (group.rigid_set == RigidSets::kNone) return;
    }
  }
  group.solved = {worker->room(group.contacts.size()), false, false};
  for (std::size_t i = 0; i < group.contacts.size(); ++i) {
    const SoftContact& contact = group.contacts[i];
    spu::SolveContact& solved = group.solved.contacts[i];
    solved = as_kernels_solve_it(contact, sides, rigids, step);
    if (group.rigid_set != RigidSets::kNone)
      meet_rigid(solved, contact, sides, rigid_sets_.number_in(group.rigid_set, contact.rigid));
    group.solved.pushes = group.solved.pushes || solved.push_velocity > 0;
  }
  group.by_worker = true;
}

/// The pairs of bodies that the worker solves, as units in stages.
void ContactSolver::add_pairs_to(SolveStages& stages) {
  for (std::size_t stage = 0; stage + 1 < order_.stages().size(); ++stage) {
    stages.stages.push_back(static_cast<std::uint32_t>(stages.units.size()));
    for (std::uint32_t unit = order_.stages()[stage]; unit < order_.stages()[stage + 1]; ++unit) {
      stages.units.push_back(static_cast<std::uint32_t>(stages.groups.size()));
      for (std::uint32_t i = order_.units()[unit]; i < order_.units()[unit + 1]; ++i) {
        const ContactGroup& group = groups_[order_.order()[i]];
        if (group.by_worker) stages.groups.push_back(solved_by_worker(group));
      }
    }
  }
}

SolveGroup ContactSolver::solved_by_worker(const ContactGroup& group) const {
  SolveGroup solved{.a = group.a, .contacts = group.solved.contacts, .pushes = group.solved.pushes};
  if (!group.with_rigid) solved.b = group.b;
  if (group.rigid_set != RigidSets::kNone) solved.rigids = rigid_sets_.of(group.rigid_set);
  solved.iterations = static_cast<std::uint32_t>(iterations_of(group, settings));
  return solved;
}

/// Adds groups with rigid bodies that move: one unit for each set of these.
void ContactSolver::add_rigid_sets_to(SolveStages& stages) {
  if (rigid_sets_.sets() == 0) return;
  stages.stages.push_back(static_cast<std::uint32_t>(stages.units.size()));
  for (std::uint32_t set = 0; set < rigid_sets_.sets(); ++set) {
    stages.units.push_back(static_cast<std::uint32_t>(stages.groups.size()));
    of_set_.clear();
    for (ContactGroup& group : groups_.with_rigid())
      if (group.rigid_set == set) of_set_.push_back(&group);
    for_each_turn(of_set_, settings, [&](const ContactGroup& group, int iterations) {
      stages.groups.push_back(solved_by_worker(group));
      stages.groups.back().iterations = static_cast<std::uint32_t>(iterations);
    });
  }
}

/// All units may be solved at the same time.
void ContactSolver::add_attachments_to(SolveStages& stages, bool ends) const {
  stages.stages.push_back(static_cast<std::uint32_t>(stages.units.size()));
  for (std::uint32_t unit = 0; unit < attach_units_.units().size(); ++unit) {
    stages.units.push_back(static_cast<std::uint32_t>(stages.groups.size()));
    stages.groups.push_back({.contacts = {}, .attachments = unit, .ends = ends});
  }
}

/// Adds for each body its contacts with static bodies, and its touched cells.
void ContactSolver::add_bodies_to(SolveStages& stages, float stiffening) {
  constexpr std::size_t kBodiesInUnit = 12;
  stages.stages.push_back(static_cast<std::uint32_t>(stages.units.size()));
  const std::span<const ContactGroup> with_rigid = groups_.with_rigid();
  std::size_t rigid = 0, in_unit = 0;
  for (std::uint32_t i = 0; i < bodies_.size(); ++i) {
    SolveGroup of_body{.a = i, .contacts = {}};
    while (rigid < with_rigid.size() && with_rigid[rigid].a < i) ++rigid;
    if (rigid < with_rigid.size() && with_rigid[rigid].a == i && with_rigid[rigid].by_worker &&
        with_rigid[rigid].rigid_set == RigidSets::kNone)
      of_body = solved_by_worker(with_rigid[rigid]);
    if (stiffening > 0 && worker->holds(i)) of_body.cells = touched_.of(i);
    of_body.stiffening = stiffening;
    if (of_body.contacts.empty() && of_body.cells.empty()) continue;
    if (in_unit++ % kBodiesInUnit == 0)
      stages.units.push_back(static_cast<std::uint32_t>(stages.groups.size()));
    stages.groups.push_back(of_body);
  }
}

/// Gives the worker what it can solve; the rest goes to here_. @return  whether the worker solves attachments
bool ContactSolver::share_with_worker(std::span<ContactRigid> rigids, float step) {
  turns_.weigh(groups_.with_rigid(), bodies_, rigids);
  if (has_attachments()) begin_attachments(rigids, step);
  find_rigid_sets(rigids);
  for (ContactGroup& group : groups_.all()) hand_to_worker(group, rigids, step);
  const bool attachments_by_worker = hand_attachments_to_worker(rigids.size());
  bounce(rigids, step);
  if (!bounces_.empty())
    for (const std::uint32_t i : bounces_.changed())
      if (worker->holds(i)) worker->put(i, bodies_[i].velocities, bodies_[i].pushes);
  rigid_sets_.put();
  for (std::uint32_t i = 0; i < bodies_.size(); ++i)
    if (crushed_.is_crushed(i) && worker->holds(i)) worker->put(i, bodies_[i].velocities, bodies_[i].pushes);
  here_.clear();
  for (const std::uint32_t i : order_.order())
    if (!groups_[i].by_worker) here_.push_back(&groups_[i]);
  add_rigid_groups(rigids);
  prepare_here(rigids);
  touched_.find(bodies_, groups_.all());
  return attachments_by_worker;
}

/// Solves this thread's groups of a round, after contacts between bodies. The worker waits.
void ContactSolver::solve_in_between(std::span<ContactRigid> rigids, float step, int round, float stiffening,
                                     bool with_attachments) {
  iterate_here(std::span(here_).first(here_that_move_), rigids, step);
  if (with_attachments) solve_attachments(rigids, step, round);
  iterate_here(std::span(here_).subspan(here_that_move_), rigids, step);
  if (stiffening == 0) return;
  for (std::uint32_t i = 0; i < bodies_.size(); ++i) {
    if (!worker->holds(i)) touched_.stiffen_those_of(i, bodies_[i], stiffening);
  }
}

/// Makes one chain of jobs for all rounds, unless this thread has to solve something in between.
void ContactSolver::solve_with_worker(std::span<ContactRigid> rigids, float step) {
  const bool attachments_by_worker = share_with_worker(rigids, step);
  const bool attachments_here = has_attachments() && !attachments_by_worker;
  stages_.clear();
  for (int round = 0; round < rounds(); ++round) {
    const bool is_last = round + 1 == rounds();
    const float stiffening = is_last ? 0 : settings.stiffening;
    add_pairs_to(stages_);
    add_rigid_sets_to(stages_);
    if (!here_.empty() || attachments_here) {
      worker->solve(stages_);
      stages_.clear();
      take_from_worker();
      solve_in_between(rigids, step, round, stiffening, attachments_here);
      give_to_worker();
    }
    if (attachments_by_worker) add_attachments_to(stages_, is_last);
    add_bodies_to(stages_, stiffening);
  }
  worker->solve(stages_);
  take_from_worker();
  if (!attachments_by_worker) return;
  worker->read(attach_units_.units());
  attach_units_.read(*attachments);
  attachments->take_back_spin();
}

void ContactSolver::take_from_worker() {
  rigid_sets_.take();
  for (std::uint32_t i = 0; i < bodies_.size(); ++i)
    if (changed_by_worker(i)) worker->take(i, bodies_[i].velocities, bodies_[i].pushes);
}

void ContactSolver::give_to_worker() {
  rigid_sets_.put();
  for (std::uint32_t i = 0; i < bodies_.size(); ++i)
    if (changed_by_worker(i)) worker->put(i, bodies_[i].velocities, bodies_[i].pushes);
}

}  // namespace softcell::ppu
