#include "softcell/ppu/spe_solver.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "match_orchestration.h"

namespace softcell::ppu {
namespace {

constexpr std::size_t kMostBodiesPerJob = 16;

/// Enough jobs for all SPEs to have some, and few enough to fetch the plan seldom. Says nothing about the
/// result.
std::size_t bodies_per_job(std::size_t bodies, int spes) {
  const std::size_t jobs = 2 * static_cast<std::size_t>(spes);
  return std::clamp<std::size_t>((bodies + jobs - 1) / jobs, 1, kMostBodiesPerJob);
}

/// Nothing when the bodies do not fit a local store.
std::optional<MatchBodies> make_bodies(dma::AddressSpace& memory, const SoftBodyModel& model,
                                       std::size_t count, std::uint32_t arena_bytes) {
  try {
    return MatchBodies(memory, MatchPlan(model.lattice(), *model.plan(), arena_bytes), count);
  } catch (const BodyTooLarge&) {
    return std::nullopt;
  }
}

}  // namespace

struct SpeSolver::Group {
  std::shared_ptr<const SoftBodyModel> model;
  std::optional<MatchBodies> bodies;  ///< nothing: they do not fit a local store
  std::size_t count = 0;
  std::vector<std::size_t> awake;
};

struct SpeSolver::Member {
  SoftBody* body = nullptr;
  Group* group = nullptr;
  std::size_t number = 0;  ///< in the group
  bool stepped = false;    ///< by the jobs under way
};

SpeSolver::SpeSolver(dma::AddressSpace& memory, JobSystem& jobs, const ls_sim::KernelImage& match)
    : memory_(memory),
      jobs_(jobs),
      match_(jobs.place(match)),
      arena_bytes_(match.checked ? spu::kMatchCheckedArenaBytes : spu::kMatchArenaBytes) {
  regroup({});  // a world without soft bodies steps, too
}

SpeSolver::~SpeSolver() = default;

bool SpeSolver::knows(std::span<SoftBody* const> bodies) const {
  return std::equal(members_.begin(), members_.end(), bodies.begin(), bodies.end(),
                    [](const Member& member, const SoftBody* body) {
                      return member.body == body && member.group->model == body->shared_model();
                    });
}

/// Bodies have come or gone: memory is laid out anew, and those that stay take their rotations along.
void SpeSolver::regroup(std::span<SoftBody* const> bodies) {
  std::vector<std::unique_ptr<Group>> groups;
  std::vector<Member> members;
  for (SoftBody* const body : bodies) {
    auto group = std::find_if(groups.begin(), groups.end(),
                              [&](const auto& g) { return g->model == body->shared_model(); });
    if (group == groups.end()) {
      group = groups.insert(group, std::make_unique<Group>());
      (*group)->model = body->shared_model();
    }
    members.push_back({.body = body, .group = group->get(), .number = (*group)->count++, .stepped = false});
  }
  std::size_t jobs = 0;
  for (const auto& group : groups) {
    group->bodies = make_bodies(memory_, *group->model, group->count, arena_bytes_);
    if (group->bodies) jobs += group->count;
  }
  for (const Member& member : members) {
    const auto old = std::find_if(members_.begin(), members_.end(), [&](const Member& known) {
      return known.body == member.body && known.group->model == member.group->model;
    });
    if (old != members_.end() && member.group->bodies)
      member.group->bodies->take_rotations(member.number, *old->group->bodies, old->number);
  }
  chain_.reset();
  chain_ = std::make_unique<JobChain>(jobs_, "soft bodies", jobs);
  groups_ = std::move(groups);
  members_ = std::move(members);
}

void SpeSolver::kick(std::span<SoftBody* const> bodies, float step) {
  if (!knows(bodies)) regroup(bodies);
  step_ = step;
  large_.clear();
  for (const auto& group : groups_) group->awake.clear();
  for (Member& member : members_) {
    const SoftBody& body = *member.body;
    member.stepped = false;
    if (body.asleep()) continue;
    if (!member.group->bodies) {
      large_.push_back(member.body);
      continue;
    }
    member.stepped = true;
    member.group->awake.push_back(member.number);
    std::copy(body.positions().begin(), body.positions().end(),
              member.group->bodies->positions(member.number).begin());
    const std::span<MatchBodies::Vector> velocities = member.group->bodies->velocities(member.number);
    for (std::size_t i = 0; i < velocities.size(); ++i) {
      const Eigen::Vector3f& v = body.velocities()[i];
      velocities[i] = {v.x(), v.y(), v.z(), 0};
    }
  }
  chain_->clear();
  for (const auto& group : groups_) {
    if (group->awake.empty()) continue;
    const SoftBodySettings& settings = group->model->settings();
    group->bodies->add_jobs(
        *chain_, match_,
        {.pull = settings.alpha_of_step(step) / step, .damping = settings.damping_of_step(step)},
        group->awake, bodies_per_job(group->awake.size(), jobs_.spes()));
  }
  if (chain_->size() != 0) chain_->kick();
}

void SpeSolver::finish() {
  for (SoftBody* const body : large_) body->pull(step_);
  chain_->wait();
  if (chain_->size() == 0) return;
  check_jobs(*chain_);
  for (const auto& group : groups_) {
    if (!group->awake.empty() && !group->bodies->take_results().empty())
      throw std::runtime_error("a soft body has positions or velocities that are not finite numbers");
  }
  for (const Member& member : members_) {
    if (!member.stepped) continue;
    const std::span<const MatchBodies::Vector> velocities = member.group->bodies->velocities(member.number);
    for (std::size_t i = 0; i < velocities.size(); ++i)
      member.body->set_velocity(i, {velocities[i].x, velocities[i].y, velocities[i].z});
  }
}

void SpeSolver::drop() { chain_->wait(); }

void SpeSolver::forget(const SoftBody& body) {
  for (const Member& member : members_)
    if (member.body == &body && member.group->bodies) member.group->bodies->reset(member.number);
}

}  // namespace softcell::ppu
