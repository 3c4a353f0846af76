#include "ppu/contact_solver/contact_search.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "ppu/contacts/find_contacts.h"
#include "ppu/contacts/obstacle_contacts.h"

namespace softcell::ppu {
namespace {

bool may_touch(std::uint32_t a, std::uint32_t b, const ContactSearchTerms& terms) {
  const BodyInSubstep &body = terms.told[a], &other = terms.told[b];
  if (body.asleep && other.asleep) return false;
  if (a == b) return body.self_contacts && may_touch_itself(terms.bodies[a]);
  if (!body.filter.may_touch(other.filter)) return false;
  return terms.attachments == nullptr || !terms.attachments->parts(a, b);
}

/// For contacts that the worker has found.
void hold_by_own_cells(ContactGroup& group, std::span<const ContactBody> bodies) {
  const ContactBody &a = bodies[group.a], &b = bodies[group.b];
  if (!a.model->is_flat() && !b.model->is_flat()) return;
  for (spu::SolveContact& contact : group.solved.contacts) hold_by_own_cells(contact, a, b);
}

}  // namespace

void ContactSearch::find(const ContactSearchTerms& terms, ContactGroups& groups) {
  groups.clear();
  cells_.resize(terms.bodies.size());
  for (std::size_t i = 0; i < cells_.size(); ++i) cells_[i].begin(terms.bodies[i]);
  find_pairs(terms);
  ask_worker(terms);
  find_with_rigid(terms, groups);  // while the worker looks at pairs
  const std::size_t with_rigid = groups.size();
  find_of_pairs(terms, groups);
  groups.put_pairs_first(with_rigid);
}

/// Pairs of bodies whose boxes overlap, and folded bodies with themselves, in ascending order.
void ContactSearch::find_pairs(const ContactSearchTerms& terms) {
  const std::span<const ContactBody> bodies = terms.bodies;
  by_low_.resize(bodies.size());
  std::iota(by_low_.begin(), by_low_.end(), 0u);
  std::sort(by_low_.begin(), by_low_.end(), [&](std::uint32_t i, std::uint32_t j) {
    return std::pair(bodies[i].box.low.x(), i) < std::pair(bodies[j].box.low.x(), j);
  });
  pairs_.clear();
  for (std::size_t i = 0; i < by_low_.size(); ++i) {
    const Bounds<3>& box = bodies[by_low_[i]].box;
    for (std::size_t j = i; j < by_low_.size() && bodies[by_low_[j]].box.low.x() <= box.high.x(); ++j) {
      const std::uint32_t a = std::min(by_low_[i], by_low_[j]), b = std::max(by_low_[i], by_low_[j]);
      if (overlap(box, bodies[by_low_[j]].box) && may_touch(a, b, terms)) pairs_.emplace_back(a, b);
    }
  }
  std::sort(pairs_.begin(), pairs_.end());
}

void ContactSearch::ask_worker(const ContactSearchTerms& terms) {
  asked_.clear();
  if (terms.worker == nullptr) return;
  terms.worker->begin(terms.bodies, terms.step);
  for (const auto& [a, b] : pairs_)
    if (terms.worker->holds(a) && terms.worker->holds(b) &&
        (a == b || !are_fast(terms.bodies[a], terms.bodies[b])))
      asked_.emplace_back(a, b);
  if (!asked_.empty()) terms.worker->find(asked_);
}

void ContactSearch::find_with_rigid(const ContactSearchTerms& terms, ContactGroups& groups) {
  for (std::uint32_t a = 0; a < terms.bodies.size(); ++a) {
    const BodyInSubstep& told = terms.told[a];
    if (told.obstacles.empty()) continue;
    const ContactBody& body = terms.bodies[a];
    ContactGroup& group = groups.append(a, a, true);
    find_contacts({body, cells_[a], terms.obstacles, told.obstacles, terms.rigids, terms.step},
                  group.contacts);
    group.sharp = sharp_contacts_.keep(group.contacts, body);
    for (SoftContact& contact : group.contacts) {
      contact.on_held = terms.rigids[contact.rigid].inverse_mass > 0 && body.holds(contact.a);
      group.on_held = group.on_held || contact.on_held;
    }
    groups.drop_last_if_empty();
  }
}

void ContactSearch::find_of_pairs(const ContactSearchTerms& terms, ContactGroups& groups) {
  const std::span<const FoundContacts> found =
      asked_.empty() ? std::span<const FoundContacts>() : terms.worker->found();
  std::size_t next = 0;
  for (const auto& pair : pairs_) {
    ContactGroup& group = groups.append(pair.first, pair.second, false);
    if (next < asked_.size() && asked_[next] == pair) {
      group.solved = found[next++];
      group.by_worker = !group.solved.by_caller;
    }
    if (group.by_worker)
      hold_by_own_cells(group, terms.bodies);
    else
      find_of_pair(group, terms);
    groups.drop_last_if_empty();
  }
}

/// Looks for points of both bodies.
void ContactSearch::find_of_pair(ContactGroup& group, const ContactSearchTerms& terms) {
  const ContactBody &a = terms.bodies[group.a], &b = terms.bodies[group.b];
  group.fast = group.a != group.b && are_fast(a, b);
  if (group.fast)
    swept_.find(a, b, terms.step, group.contacts);
  else
    find_contacts(a, cells_[group.a], b, cells_[group.b], terms.step, group.contacts);
  if (group.a == group.b) return;
  other_way_.clear();
  if (group.fast)
    swept_.find(b, a, terms.step, other_way_);
  else
    find_contacts(b, cells_[group.b], a, cells_[group.a], terms.step, other_way_);
  for (SoftContact& contact : other_way_) {
    std::swap(contact.a, contact.b);
    contact.normal = -contact.normal;
    group.contacts.push_back(contact);
  }
}

}  // namespace softcell::ppu
