#include "ppu/spe_bodies/spe_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "ppu/spe_bodies/contact_records.h"
#include "ppu/spe_bodies/find_model.h"
#include "ppu/spe_bodies/match_orchestration.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

constexpr std::size_t kQuadsOfBoxes = sizeof(spu::FindBoxes) / sizeof(spu::FindEnd);
constexpr std::size_t kMostPairs = 4096;                                   // that the SPEs look at in a step
constexpr std::size_t kContactsInRoom = 2 * ContactWorker::kMostContacts;  // in one buffer
constexpr std::size_t kJobsPerSpe = 4;  // for finding: some pairs take longer than others
// Room for contacts: up to 512 tasks get room for the most that a task may find; with many more, each has room for as many as two bodies
// in a heap have in common.
constexpr std::size_t kContactsOfAll = std::size_t{512} * spu::kFindMaxContacts, kLeastContactsOfTask = 48;

/// Empties a chain and reserves room for so many jobs. @pre it has ended
void make_room(JobChain& chain, std::size_t count) {
  chain.clear();
  chain.reserve(count + count / 4);
}

/// Room for the contacts that a job of `tasks` tasks finds, of `all_tasks` in all.
std::size_t contacts_of_job(std::size_t all_tasks, std::size_t tasks) {
  constexpr std::size_t kMost = spu::kFindMaxContacts;
  const std::size_t of_task =
      std::clamp(kContactsOfAll / std::max<std::size_t>(all_tasks, 1), kLeastContactsOfTask, kMost);
  return std::max(tasks * of_task, kMost);
}

spu::SolveVelocity times(float scale, const Vector3f& v, float root = 0) {
  return {scale * v.x(), scale * v.y(), scale * v.z(), root};
}

}  // namespace

SpeContacts::SpeContacts(dma::AddressSpace& memory, JobSystem& jobs, const ContactKernels& kernels)
    : memory_(memory),
      jobs_(jobs),
      contact_find_(jobs.load(kernels.contact_find)),
      contact_solve_(jobs.load(kernels.contact_solve)),
      attachments_(memory, jobs, kernels.attach),
      parts_(memory),
      finding_(jobs, "finding contacts", 1),
      solving_(jobs, "solving contacts", 1) {}

SpeContacts::~SpeContacts() = default;

const SpeContacts::Model* SpeContacts::model_of(const ContactModel& contact) {
  const auto known = models_.find(&contact);
  if (known != models_.end()) return known->second.get();
  std::unique_ptr<Model>& model = models_[&contact];
  if (contact.inverse_masses.size() > spu::kSolveMaxParticles ||
      contact.lattice().cells.size() > spu::kSolveMaxCells)
    return nullptr;
  const FindModel arrays(contact);
  auto made = std::make_unique<Model>();
  made->cells = contact_buffer<spu::FindCell>(memory_, "contact cells", arrays.cells.size(), kSpesOnlyRead);
  made->groups =
      contact_buffer<spu::FindGroup>(memory_, "contact points", arrays.groups.size(), kSpesOnlyRead);
  std::copy(arrays.cells.begin(), arrays.cells.end(), made->cells.span().begin());
  std::copy(arrays.groups.begin(), arrays.groups.end(), made->groups.span().begin());
  for (const float inverse : contact.inverse_masses) {
    made->inverse_root_masses.push_back(std::sqrt(inverse));
    made->root_masses.push_back(1 / std::sqrt(inverse));
  }
  model = std::move(made);
  return model.get();
}

/// Another model may get the same address, so all that is known of places is forgotten.
void SpeContacts::forget(const ContactModel& model) {
  if (models_.erase(&model) > 0) places_.clear();
}

/// Sets the places of all bodies. @return  whether places in memory are the same as in the step before
bool SpeContacts::find_places(std::size_t& state, std::size_t& velocities) {
  bool same = places_.size() == bodies_.size();
  places_.resize(bodies_.size());
  std::size_t all_particles = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Model* const model = model_of(*bodies_[i].model);
    same = same && places_[i].model == model;
    places_[i] = {model, state, velocities, all_particles};
    if (model == nullptr) continue;
    const std::size_t particles = bodies_[i].ends.size();
    all_particles += particles;
    state += (model->cells.size() + 3) / 4 * kQuadsOfBoxes + 2 * particles;
    velocities += spu::solve_slots(static_cast<std::uint32_t>(particles)) + particles;
  }
  return same;
}

void SpeContacts::begin(std::span<const ContactBody> bodies, float step) {
  finding_.wait();  // of a substep that failed before it called found()
  bodies_ = bodies;
  step_ = step;
  room_ = used_ = 0;
  end_boxes_.resize(bodies.size());
  std::size_t state = 0, velocities = 0;
  const bool same = find_places(state, velocities);
  if (!same) pairs_.clear(bodies.size());  // before anything may throw
  started_.clear();
  make_room(memory_, "bodies in contact", state_, state);
  make_room(memory_, "velocities in contact", velocities_, velocities);
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    if (!holds(i)) continue;
    write_particles(i, same);
    write_boxes(i);
  }
}

std::size_t SpeContacts::ends_of(std::uint32_t body) const {
  return places_[body].state + (places_[body].model->cells.size() + 3) / 4 * kQuadsOfBoxes;
}

/// @param was_there  the body was at the same place in memory in the step before, so its way is known
void SpeContacts::write_particles(std::uint32_t i, bool was_there) {
  const ContactBody& body = bodies_[i];
  const Model& model = *places_[i].model;
  const std::size_t count = body.ends.size();
  spu::FindEnd* const ends = state_.data() + ends_of(i);
  auto* const begins = reinterpret_cast<spu::FindBegin*>(ends + count);
  Vector3f least = Vector3f::Constant(std::numeric_limits<float>::max()), most = -least;
  for (std::size_t p = 0; p < count; ++p) {
    const Vector3f &x = body.positions[p], &end = body.ends[p];
    begins[p] = {x.x(), x.y(), x.z(), body.asleep ? 0.0f : model.inverse_root_masses[p]};
    // Number by number: reading a whole quadword right after writing its four parts would wait for the store buffer.
    const Vector3f way(end.x() - ends[p].x, end.y() - ends[p].y, end.z() - ends[p].z);
    least = least.cwiseMin(way);
    most = most.cwiseMax(way);
    ends[p] = {end.x(), end.y(), end.z(), 0};
  }
  if (was_there) pairs_.add_way(i, least, most);
  spu::SolveVelocity* const start = velocities_.data() + start_of(i);
  for (std::size_t p = 0; p < count; ++p)
    start[p] = times(model.root_masses[p], body.velocities[p], model.root_masses[p]);
  std::fill(velocities_.data() + places_[i].velocities, start, spu::SolveVelocity{});
  started_.insert(started_.end(), body.velocities.begin(), body.velocities.end());
}

std::size_t SpeContacts::start_of(std::uint32_t body) const {
  return places_[body].velocities + spu::solve_slots(static_cast<std::uint32_t>(bodies_[body].ends.size()));
}

/// The boxes of the cells and of the whole body.
void SpeContacts::write_boxes(std::uint32_t i) {
  using Row = Eigen::Array4f;
  const Model& model = *places_[i].model;
  const spu::FindEnd* const ends = state_.data() + ends_of(i);
  auto* const all_boxes = reinterpret_cast<spu::FindBoxes*>(state_.data() + places_[i].state);
  const std::span<const spu::FindCell> cells = model.cells.span();
  Row lowest = Row::Constant(std::numeric_limits<float>::max()), highest = -lowest;
  for (std::size_t c = 0; c < (cells.size() + 3) / 4 * 4; ++c) {
    const auto& corner = cells[std::min(c, cells.size() - 1)].corner;
    Row low = Row::Map(&ends[corner[0]].x), high = low;
    for (std::size_t k = 1; k < 8; ++k) {
      const Row x = Row::Map(&ends[corner[k]].x);
      low = low.min(x);
      high = high.max(x);
    }
    lowest = lowest.min(low);
    highest = highest.max(high);
    set_box(all_boxes[c / 4], c % 4, low, high);
  }
  end_boxes_[i] = {lowest.head<3>(), highest.head<3>()};
}

spu::FindBody SpeContacts::find_body(std::uint32_t i) {
  const Model& model = *places_[i].model;
  spu::FindBody body{};
  body.cells_ea = model.cells.ea().value;
  body.groups_ea = model.groups.ea().value;
  body.state_ea = state_.ea(places_[i].state).value;
  body.cell_count = static_cast<std::uint32_t>(model.cells.size());
  body.group_count = static_cast<std::uint32_t>(model.groups.size());
  body.particle_count = static_cast<std::uint32_t>(bodies_[i].ends.size());
  body.spacing = bodies_[i].spacing();
  for (int d = 0; d < 3; ++d) body.middle[d] = 0.5f * (end_boxes_[i].low[d] + end_boxes_[i].high[d]);
  return body;
}

spu::FindTask SpeContacts::find_task(std::uint32_t a, std::uint32_t b) {
  spu::FindTask task{};
  task.a = find_body(a);
  task.b = find_body(b);
  for (int d = 0; d < 3; ++d) {
    task.low[d] = std::max(end_boxes_[a].low[d], end_boxes_[b].low[d]);
    task.high[d] = std::min(end_boxes_[a].high[d], end_boxes_[b].high[d]);
  }
  task.step = step_;
  task.inverse_step = 1 / step_;
  task.friction = bodies_[a].friction * bodies_[b].friction;
  task.itself = a == b ? 1 : 0;
  task.candidate_count = spu::kFindUnknown;
  return task;
}

/// Appends the tasks of a pair, if the boxes of both bodies overlap.
SpeContacts::Asked SpeContacts::ask(std::uint32_t a, std::uint32_t b) {
  // Compares the boxes at the end of the substep: they overlap less than boxes around the bodies' ways.
  if (!(end_boxes_[a].low.array() <= end_boxes_[b].high.array()).all() ||
      !(end_boxes_[b].low.array() <= end_boxes_[a].high.array()).all())
    return {};
  spu::FindTask task = find_task(a, b);
  const bool with_cracks = a == b && !bodies_[a].model->crack_sides.empty();  // the kernel ignores cracks
  if (tasks_.size() >= kMostPairs || with_cracks) return {.by_caller = true};
  if (spu::find_bytes(task) > spu::kFindMaxBytes) return ask_in_parts({a, b}, task);
  const CandidatePairs::Known& known =
      pairs_.of({a, b}, std::min(bodies_[a].spacing(), bodies_[b].spacing()));
  if (known.overflows && a != b) return ask_in_parts({a, b}, task);
  if (known.count == 0) return {};
  task.margin = known.margin;
  task.candidate_count = known.count;
  known_of_task_.push_back(static_cast<std::uint32_t>(pairs_.known().size() - 1));
  tasks_.push_back(task);
  return {.first = static_cast<std::uint32_t>(tasks_.size() - 1), .count = 1};
}

FindParts::Body SpeContacts::parts_body(std::uint32_t i) const {
  const Model& model = *places_[i].model;
  const std::size_t count = bodies_[i].ends.size();
  const spu::FindEnd* const ends = state_.data() + ends_of(i);
  return {.cells = model.cells.span(),
          .groups = model.groups.span(),
          .boxes = reinterpret_cast<const spu::FindBoxes*>(state_.data() + places_[i].state),
          .ends = {ends, count},
          .begins = {reinterpret_cast<const spu::FindBegin*>(ends + count), count}};
}

SpeContacts::Asked SpeContacts::ask_in_parts(const Pair& pair, const spu::FindTask& whole) {
  const auto [a, b] = pair;
  const std::size_t first_part = parts_.size();
  const Bounds<3> common{Vector3f(whole.low[0], whole.low[1], whole.low[2]),
                         Vector3f(whole.high[0], whole.high[1], whole.high[2])};
  if (a == b || !parts_.add(parts_body(a), parts_body(b), common)) return {.by_caller = true};
  const std::size_t count = parts_.size() - first_part, first = tasks_.size();
  tasks_.resize(first + count, whole);
  known_of_task_.resize(first + count, kWhole);
  return {.first = static_cast<std::uint32_t>(first),
          .count = static_cast<std::uint32_t>(count),
          .first_part = static_cast<std::uint32_t>(first_part)};
}

void SpeContacts::find(std::span<const Pair> pairs) {
  tasks_.clear();
  asked_.clear();
  known_of_task_.clear();
  parts_.clear();
  pairs_.begin_step();
  for (const auto& [a, b] : pairs) asked_.push_back(ask(a, b));
  pairs_.end_step();
  parts_.write();
  for (const Asked& asked : asked_)
    for (std::uint32_t i = 0; i < asked.count && asked.first_part != kWhole; ++i)
      parts_.describe(asked.first_part + i, tasks_[asked.first + i].a, tasks_[asked.first + i].b);
  const std::size_t tasks = tasks_.size();
  make_room_for_candidates();
  make_room(memory_, "tasks of finding contacts", find_tasks_, tasks);
  make_room(memory_, "results of finding contacts", results_, tasks);
  for (std::size_t i = 0; i < tasks; ++i) {
    if (tasks_[i].margin > 0) {
      const std::size_t slot = pairs_.known()[known_of_task_[i]].slot;
      tasks_[i].candidates_ea = candidates_.ea(slot * spu::kFindMaxCandidates).value;
    }
    find_tasks_[i] = tasks_[i];
  }
  const std::size_t most_jobs = kJobsPerSpe * static_cast<std::size_t>(jobs_.spes());
  tasks_of_job_ = (tasks + most_jobs - 1) / most_jobs;
  room_of_job_ = contacts_of_job(tasks, tasks_of_job_);
  const std::size_t job_count = tasks == 0 ? 0 : (tasks + tasks_of_job_ - 1) / tasks_of_job_;
  make_room(memory_, "contacts found", contacts_, job_count * room_of_job_);
  make_room(memory_, "jobs of finding contacts", find_jobs_, job_count);
  make_room(finding_, job_count);
  for (std::size_t j = 0; j < job_count; ++j) {
    const std::size_t first = j * tasks_of_job_;
    add_find_job(j, {.task = first,
                     .tasks = std::min(tasks_of_job_, tasks - first),
                     .contacts = contacts_.ea(j * room_of_job_),
                     .room = room_of_job_});
  }
  if (job_count != 0) finding_.kick();
}

/// Keeps the content.
void SpeContacts::make_room_for_candidates() {
  const std::size_t count = pairs_.slots() * spu::kFindMaxCandidates;
  if (count <= candidates_.size()) return;
  auto more = contact_buffer<spu::FindCandidate>(memory_, "candidates of contacts", count + count / 4);
  std::copy(candidates_.span().begin(), candidates_.span().end(), more.span().begin());
  candidates_ = std::move(more);
}

/// Repeats tasks that found no room because of the other tasks of their jobs, each in a job of its own. The result must not depend on which
/// tasks share a job, as that depends on the number of SPEs.
void SpeContacts::find_again() {
  const auto is_left = [&](std::size_t task) { return results_[task].overflow == spu::kFindJobIsFull; };
  std::size_t count = 0;
  for (std::size_t i = 0; i < tasks_.size(); ++i) count += is_left(i) ? 1 : 0;
  if (count == 0) return;
  constexpr std::size_t kRoom = spu::kFindMaxContacts;
  make_room(memory_, "contacts found again", more_contacts_, count * kRoom);
  make_room(memory_, "jobs of finding contacts", find_jobs_, count);
  make_room(finding_, count);
  std::size_t job = 0;
  for (std::size_t i = 0; i < tasks_.size(); ++i) {
    if (!is_left(i)) continue;
    found_by_task_[i] = more_contacts_.span().subspan(job * kRoom, kRoom);
    add_find_job(job, {.task = i, .tasks = 1, .contacts = more_contacts_.ea(job * kRoom), .room = kRoom});
    ++job;
  }
  finding_.kick();
  finding_.wait();
  check_jobs(finding_);
}

void SpeContacts::add_find_job(std::size_t number, const FindPart& part) {
  spu::FindJob& job = find_jobs_[number];
  job = {};
  job.tasks_ea = find_tasks_.ea(part.task).value;
  job.results_ea = results_.ea(part.task).value;
  job.contacts_ea = part.contacts.value;
  job.task_count = static_cast<std::uint32_t>(part.tasks);
  job.contacts_room = static_cast<std::uint32_t>(part.room);
  finding_.add({.image = contact_find_, .argp = find_jobs_.ea(number)});
}

std::span<const FoundContacts> SpeContacts::found() {
  if (finding_.size() != 0) {
    finding_.wait();
    check_jobs(finding_);
  }
  found_by_task_.resize(tasks_.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < tasks_.size(); ++i) {
    if (i % tasks_of_job_ == 0) next = i / tasks_of_job_ * room_of_job_;
    found_by_task_[i] = contacts_.span().subspan(next);
    next += results_[i].count;
  }
  find_again();
  for (std::size_t i = 0; i < tasks_.size(); ++i) {
    found_by_task_[i] = found_by_task_[i].first(results_[i].count);
    if (known_of_task_[i] == kWhole) continue;
    CandidatePairs::Known& known = pairs_.known()[known_of_task_[i]];
    known.count = results_[i].candidate_count;
    known.overflows = results_[i].overflow != 0;
  }
  found_.clear();
  for (const Asked& asked : asked_) {
    if (asked.first_part != kWhole) {
      found_.push_back(found_in_parts(asked));
      continue;
    }
    FoundContacts& found = found_.emplace_back();
    found.by_caller = asked.by_caller;
    if (asked.count == 0) continue;
    const spu::FindResult& result = results_[asked.first];
    found.by_caller = result.overflow != 0;
    found.contacts = found_by_task_[asked.first];
    found.pushes = result.pushes != 0;
  }
  return found_;
}

/// Puts the contacts of all parts of a pair one after the other.
FoundContacts SpeContacts::found_in_parts(const Asked& asked) {
  FoundContacts found;
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < asked.count; ++i) {
    const spu::FindResult& result = results_[asked.first + i];
    found.by_caller = found.by_caller || result.overflow != 0;
    found.pushes = found.pushes || result.pushes != 0;
    count += result.count;
  }
  found.by_caller = found.by_caller || count > kMostContacts;
  if (found.by_caller || count == 0) return found;
  found.contacts = room(count);
  auto next = found.contacts.begin();
  for (std::uint32_t i = 0; i < asked.count; ++i) {
    for (const spu::SolveContact& contact : found_by_task_[asked.first + i]) {
      *next = contact;
      parts_.restore(asked.first_part + i, *next++);
    }
  }
  return found;
}

std::span<spu::SolveContact> SpeContacts::room(std::size_t contacts) {
  SC_ASSERT(contacts <= kMostContacts, "{} contacts in a group", contacts);
  if (used_ + contacts > kContactsInRoom) ++room_, used_ = 0;
  if (room_ == rooms_.size())
    rooms_.push_back(contact_buffer<spu::SolveContact>(memory_, "contacts of the PPU", kContactsInRoom));
  used_ += contacts;
  return rooms_[room_].span().subspan(used_ - contacts, contacts);
}

std::span<spu::SolveRigid> SpeContacts::rigid_room(std::size_t rigids) {
  make_room(memory_, "rigid bodies in contact", rigids_, rigids);
  return rigids_.span().first(rigids);
}

dma::EffectiveAddress SpeContacts::ea_of(const spu::SolveRigid* rigid) const {
  SC_ASSERT(rigid >= rigids_.data() && rigid < rigids_.data() + rigids_.size(),
            "a rigid body that is not in the room for {}", rigids_.size());
  return rigids_.ea(static_cast<std::size_t>(rigid - rigids_.data()));
}

void SpeContacts::hold(std::span<const AttachUnit> units, std::uint32_t iterations) {
  attachments_.hold(
      units, iterations,
      [&](std::uint32_t body) {
        return SpeAttachments::Place{velocities_.ea(places_[body].velocities),
                                     static_cast<std::uint32_t>(bodies_[body].ends.size())};
      },
      [&](const spu::SolveRigid* rigid) { return ea_of(rigid); });
}

dma::EffectiveAddress SpeContacts::ea_of(const spu::SolveContact* contact) const {
  const auto within = [&](const dma::Buffer<spu::SolveContact>& buffer) {
    return !buffer.empty() && contact >= buffer.data() && contact < buffer.data() + buffer.size();
  };
  for (const dma::Buffer<spu::SolveContact>* found : {&contacts_, &more_contacts_})
    if (within(*found)) return found->ea(static_cast<std::size_t>(contact - found->data()));
  const auto room = std::find_if(rooms_.begin(), rooms_.end(), within);
  SC_ASSERT(room != rooms_.end(), "contacts that are in none of {} buffers", rooms_.size());
  return room->ea(static_cast<std::size_t>(contact - room->data()));
}

/// Splits contacts into several tasks, one after the other, if there are more than a local store has room for.
void SpeContacts::write_tasks(const SolveGroup& group) {
  std::span<spu::SolveContact> rest = group.contacts;
  do {
    const auto part = rest.first(std::min<std::size_t>(rest.size(), spu::kSolveMaxContacts));
    rest = rest.subspan(part.size());
    solve_tasks_[tasks_used_++] = solve_task(group, part, rest.empty());
  } while (!rest.empty());
}

/// @param last  this task also stiffens cells
spu::SolveTask SpeContacts::solve_task(const SolveGroup& group, std::span<const spu::SolveContact> contacts,
                                       bool last) {
  spu::SolveTask task{};
  const auto particles = [&](std::uint32_t body) {
    return static_cast<std::uint32_t>(bodies_[body].ends.size());
  };
  task.a_ea = velocities_.ea(places_[group.a].velocities).value;
  task.a_count = particles(group.a);
  task.a_sleeps = bodies_[group.a].asleep ? 1 : 0;
  if (group.b != SolveGroup::kNobody) {
    task.b_ea = velocities_.ea(places_[group.b].velocities).value;
    task.b_count = particles(group.b);
    task.b_sleeps = bodies_[group.b].asleep ? 1 : 0;
  }
  task.contact_count = static_cast<std::uint32_t>(contacts.size());
  if (task.contact_count != 0) task.contacts_ea = ea_of(contacts.data()).value;
  if (!group.rigids.empty()) {
    task.rigids_ea = ea_of(group.rigids.data()).value;
    task.rigid_count = static_cast<std::uint32_t>(group.rigids.size());
  }
  task.iterations = group.iterations;
  task.pushes = group.pushes ? 1 : 0;
  if (last && !group.cells.empty()) {
    task.cells_ea = cells_.ea(cells_used_).value;
    task.cell_count = static_cast<std::uint32_t>(group.cells.size());
    task.positions_ea = state_.ea(ends_of(group.a) + task.a_count).value;
    const std::span<const spu::FindCell> cells = places_[group.a].model->cells.span();
    for (const std::uint32_t cell : group.cells)
      std::copy_n(cells[cell].corner, 8, cells_[cells_used_++].particle);
    task.start_ea = velocities_.ea(start_of(group.a)).value;
    task.stiffening = group.stiffening;
    task.inverse_spacing = 1 / bodies_[group.a].spacing();
  }
  return task;
}

void SpeContacts::solve(const SolveStages& stages) {
  if (stages.groups.empty()) return;
  std::size_t cells = 0, tasks = 0;
  for (const SolveGroup& group : stages.groups) {
    cells += group.cells.size();
    tasks += group.contacts.size() / spu::kSolveMaxContacts + 1;
  }
  cells_used_ = tasks_used_ = 0;
  make_room(memory_, "cells to be stiffened", cells_, cells);
  make_room(memory_, "tasks of solving contacts", solve_tasks_, tasks);
  make_room(memory_, "jobs of solving contacts", solve_jobs_, stages.units.size());
  make_room(solving_, stages.units.size());
  std::size_t stage = 0;
  for (std::size_t u = 0; u < stages.units.size(); ++u) {
    for (; stage < stages.stages.size() && stages.stages[stage] == u; ++stage) solving_.sync();
    const std::size_t first = stages.units[u];
    const std::size_t end = u + 1 < stages.units.size() ? stages.units[u + 1] : stages.groups.size();
    if (first == end) continue;
    const auto groups = std::span(stages.groups).subspan(first, end - first);
    if (groups[0].attachments != SolveGroup::kNoAttachments) {
      solving_.add(attachments_.job(groups[0].attachments, groups[0].ends));
      continue;
    }
    solve_jobs_[u] = {};
    solve_jobs_[u].tasks_ea = solve_tasks_.ea(tasks_used_).value;
    const std::size_t before = tasks_used_;
    for (const SolveGroup& group : groups) write_tasks(group);
    solve_jobs_[u].task_count = static_cast<std::uint32_t>(tasks_used_ - before);
    solving_.add({.image = contact_solve_, .argp = solve_jobs_.ea(u)});
  }
  solving_.kick();
  solving_.wait();
  check_jobs(solving_);
}

void SpeContacts::take(std::uint32_t body, std::span<Vector3f> velocities, std::span<Vector3f> pushes) const {
  SC_ASSERT(body < places_.size() && places_[body].model != nullptr, "body {} of {} is not stepped by SPEs",
            body, places_.size());
  const std::size_t count = velocities.size();
  const spu::SolveVelocity* const changes = velocities_.data() + places_[body].velocities;
  const spu::SolveVelocity* const pushed = changes + count + 1;
  const Vector3f* const started = started_.data() + places_[body].particles;
  const std::vector<float>& by = places_[body].model->inverse_root_masses;
  for (std::size_t p = 0; p < count; ++p) {
    velocities[p] = started[p] + by[p] * Vector3f(changes[p].x, changes[p].y, changes[p].z);
    pushes[p] = by[p] * Vector3f(pushed[p].x, pushed[p].y, pushed[p].z);
  }
}

void SpeContacts::put(std::uint32_t body, std::span<const Vector3f> velocities,
                      std::span<const Vector3f> pushes) {
  SC_ASSERT(body < places_.size() && places_[body].model != nullptr, "body {} of {} is not stepped by SPEs",
            body, places_.size());
  const std::size_t count = velocities.size();
  spu::SolveVelocity* const changes = velocities_.data() + places_[body].velocities;
  const Vector3f* const started = started_.data() + places_[body].particles;
  const std::vector<float>& roots = places_[body].model->root_masses;
  for (std::size_t p = 0; p < count; ++p) {
    changes[p] = times(roots[p], velocities[p] - started[p]);
    changes[count + 1 + p] = times(roots[p], pushes[p]);
  }
}

}  // namespace softcell::ppu
