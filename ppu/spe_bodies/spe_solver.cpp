#include "softcell/spe_bodies/spe_solver.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <span>
#include <stdexcept>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "ppu/spe_bodies/match_bodies.h"
#include "ppu/spe_bodies/match_orchestration.h"
#include "ppu/spe_bodies/strain_looks.h"
#include "ppu/spe_bodies/tiled_memory.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

constexpr std::size_t kMostBodiesPerJob = 16;

/// Enough jobs to occupy all SPEs, and few enough that the plan is seldom fetched. Does not affect the result.
std::size_t bodies_per_job(std::size_t bodies, int spes) {
  const std::size_t jobs = 2 * static_cast<std::size_t>(spes);
  return std::clamp<std::size_t>((bodies + jobs - 1) / jobs, 1, kMostBodiesPerJob);
}

template <int kDimension>
MatchSettings settings_of(const SoftBody<kDimension>& body, float step) {
  const SoftBodySettings& settings = body.settings();
  return {.pull = settings.alpha_of_step(step) / step, .damping = settings.damping_of_step(step)};
}

/// Whether the body needs a plan of its own.
template <int kDimension>
bool needs_own_plan(const SoftBody<kDimension>& body) {
  return body.settings().plasticity.has_value() || body.has_own_rest();
}

const ls_sim::KernelImage& whole(const MatchKernels<2>& kernels) { return kernels.match_2d; }
const ls_sim::KernelImage& whole(const MatchKernels<3>& kernels) { return kernels.match; }
JobImage place_tiles(JobSystem&, const MatchKernels<2>&) { return {}; }
JobImage place_tiles(JobSystem& jobs, const MatchKernels<3>& kernels) {
  return jobs.load(kernels.match_tiles);
}

std::span<const Eigen::Vector2f> as_the_kernel_reads_them(const SoftBody<2>& body) {
  return body.positions();
}
std::span<const Eigen::Vector4f> as_the_kernel_reads_them(const SoftBody<3>& body) {
  return body.padded_positions();
}

MatchPlan2d plan_of(const SoftBodyModel<2>& model, bool /*checked*/) {
  return {model.lattice(), *model.plan()};
}
MatchPlan plan_of(const SoftBodyModel<3>& model, bool checked) {
  return {model.lattice(), *model.plan(), checked ? spu::kMatchCheckedArenaBytes : spu::kMatchArenaBytes};
}

/// Null: bodies of the model are too large even for tiles. There is no kernel for tiles in two dimensions.
std::shared_ptr<const TilePlan> tiles_of(const SoftBodyModel<2>& /*model*/, bool /*checked*/) {
  return nullptr;
}
std::shared_ptr<const TilePlan> tiles_of(const SoftBodyModel<3>& model, bool checked) {
  const std::uint32_t arena_bytes = checked ? spu::kTileCheckedArenaBytes : spu::kTileArenaBytes;
  try {
    return std::make_shared<const TilePlan>(model.lattice(), *model.plan(), TileShape{}, arena_bytes);
  } catch (const BodyTooLarge&) {
    return nullptr;
  }
}

}  // namespace

/// What the SPEs step bodies of a model with: one plan, or the other, or neither. (Tiles exist only in three dimensions.)
template <int kDimension>
struct SpeSolver<kDimension>::Plans {
  std::shared_ptr<const SoftBodyModel<kDimension>> model;
  std::shared_ptr<const typename MatchKernel<kDimension>::Plan> whole;
  std::shared_ptr<const TilePlan> tiles;
};

/// Where one body will lie: in `bodies`, or in `tiled`, or nowhere.
template <int kDimension>
struct SpeSolver<kDimension>::Place {
  std::shared_ptr<const Plans> plans;
  std::shared_ptr<MatchBodies<kDimension>> bodies;
  std::unique_ptr<TiledMemory> tiled;
};

/// The bodies of one model: all in `bodies`, or each in tiles with memory of its own, or neither. A body that may have its own rest shape
/// is a group by itself, because the plan contains the rest shape.
template <int kDimension>
struct SpeSolver<kDimension>::Group {
  std::shared_ptr<const SoftBodyModel<kDimension>> model;
  bool own_plan = false;
  std::vector<Body*> members;
  std::shared_ptr<const Plans> plans;
  std::shared_ptr<MatchBodies<kDimension>> bodies;
  std::shared_ptr<StrainLooks<kDimension>> looks;  // null: not needed yet, or the PPU looks
  std::vector<std::size_t> awake;
  std::vector<MatchSettings> settings;  // of the awake ones
};

template <int kDimension>
struct SpeSolver<kDimension>::Member {
  Body* body = nullptr;
  Group* group = nullptr;
  std::size_t number = 0;              ///< in the group
  std::unique_ptr<TiledMemory> tiled;  ///< of a group in tiles
  bool stepped = false;                ///< by the jobs under way
  std::uint32_t seen_rest = 0;         ///< SoftBody::rest_revision() of the plan's rest shape; 0: the model's

  bool fits_spes() const { return group->bodies || tiled; }
};

/// The layout of memory before the one that is being made.
template <int kDimension>
struct SpeSolver<kDimension>::Known {
  using Model = SoftBodyModel<kDimension>;

  std::unordered_map<const Body*, Member*> members;
  std::unordered_map<const Model*, std::shared_ptr<const Plans>> plans;  // known ones, and new ones
  std::unordered_map<const Model*, Place> places;                        // prepared ahead

  /// The same body in this layout, or null.
  Member* find(const Member& member) const {
    const auto old = members.find(member.body);
    return old != members.end() && old->second->group->model == member.group->model ? old->second : nullptr;
  }
};

template <int kDimension>
SpeSolver<kDimension>::SpeSolver(dma::AddressSpace& memory, JobSystem& jobs,
                                 const MatchKernels<kDimension>& kernels)
    : memory_(memory),
      jobs_(jobs),
      match_(jobs.load(whole(kernels))),
      match_tiles_(place_tiles(jobs, kernels)),
      checked_(whole(kernels).checked),
      chain_(jobs, "soft bodies", 1) {
  if (kernels.strain != nullptr) strain_ = jobs.load(*kernels.strain);
  regroup({});  // so that a world without soft bodies can step, too
}

template <int kDimension>
SpeSolver<kDimension>::~SpeSolver() = default;

template <int kDimension>
bool SpeSolver<kDimension>::knows(std::span<Body* const> bodies) const {
  return std::equal(members_.begin(), members_.end(), bodies.begin(), bodies.end(),
                    [](const Member& member, const Body* body) {
                      return member.body == body && member.group->model == body->shared_model() &&
                             member.group->own_plan == needs_own_plan(*body);
                    });
}

/// Making plans takes a while, so each model's plans are made once.
template <int kDimension>
void SpeSolver<kDimension>::find_place(Group& group, Known& known) {
  SC_ASSERT(group.model != nullptr && !group.members.empty(), "a group of {} bodies {} a model",
            group.members.size(), group.model ? "with" : "without");
  std::shared_ptr<const Plans>& plans = known.plans[group.model.get()];
  if (!plans) plans = std::make_shared<const Plans>(plans_of(group.model));
  group.plans = plans;
  if (const auto old = known.members.find(group.members.front()); old != known.members.end()) {
    const Group& same = *old->second->group;
    if (same.model == group.model && same.own_plan == group.own_plan && same.members == group.members) {
      group.bodies = same.bodies;
      group.looks = same.looks;
    }
  }
  if (!plans->whole || group.bodies) return;
  const auto made = known.places.find(group.model.get());
  if (made != known.places.end() && made->second.bodies && group.members.size() == 1)
    group.bodies = std::move(made->second.bodies);
  else
    group.bodies = std::make_shared<MatchBodies<kDimension>>(memory_, *plans->whole, group.members.size());
}

/// Chooses how a model is stepped: as a whole if it fits, else in tiles, else by the PPU.
template <int kDimension>
auto SpeSolver<kDimension>::plans_of(const std::shared_ptr<const SoftBodyModel<kDimension>>& model) const
    -> Plans {
  try {
    return {model, std::make_shared<const typename MatchKernel<kDimension>::Plan>(plan_of(*model, checked_)),
            nullptr};
  } catch (const BodyTooLarge&) {
    return {model, nullptr, tiles_of(*model, checked_)};
  }
}

/// @throws std::runtime_error  main memory is full.
template <int kDimension>
auto SpeSolver<kDimension>::place_for(const std::shared_ptr<const Plans>& plans) const -> Place {
  Place place{plans, nullptr, nullptr};
  if (plans->whole) place.bodies = std::make_shared<MatchBodies<kDimension>>(memory_, *plans->whole, 1);
  if constexpr (kDimension == 3)
    if (plans->tiles) place.tiled = std::make_unique<TiledMemory>(memory_, *plans->tiles);
  return place;
}

/// Memory that is full now may have room when the body comes: then kick() lays it out, or reports the error.
template <int kDimension>
void SpeSolver<kDimension>::prepare(const std::shared_ptr<const SoftBodyModel<kDimension>>& model) {
  Place place{std::make_shared<const Plans>(plans_of(model)), nullptr, nullptr};
  try {
    place = place_for(place.plans);
  } catch (const std::runtime_error&) {
  }
  const std::lock_guard lock(preparing_);
  prepared_.push_back(std::move(place));
}

template <int kDimension>
void SpeSolver<kDimension>::inherit_state(const Body& whole, const Body& piece,
                                          std::span<const std::uint32_t> particle_of) {
  SC_ASSERT(!is_stepping_, "a body breaks with {} jobs under way", chain_.size());
  if constexpr (kDimension == 3) {  // in two dimensions a rotation has a closed form
    const auto rotations_at = [](const Body& body, const Plans& plans, MatchBodies<3>* bodies,
                                 std::size_t number, TiledMemory* tiled) -> std::optional<RegionRotations> {
      if (bodies != nullptr) return bodies->region_rotations(number);
      if (tiled != nullptr) return tiled->region_rotations(*plans.tiles, body.model().plan()->sums());
      return std::nullopt;
    };
    const auto member = std::ranges::find(members_, &whole, &Member::body);
    if (member == members_.end() || member->group->model != whole.shared_model()) return;
    const std::lock_guard lock(preparing_);
    const auto place = std::ranges::find(prepared_, piece.shared_model(),
                                         [](const Place& made) { return made.plans->model; });
    if (place == prepared_.end()) return;
    const auto known = rotations_at(whole, *member->group->plans, member->group->bodies.get(), member->number,
                                    member->tiled.get());
    auto own = rotations_at(piece, *place->plans, place->bodies.get(), 0, place->tiled.get());
    if (known && own) own->take_from(*known, particle_of);
  }
}

/// Also drops prepared places of models that can have no more bodies.
template <int kDimension>
void SpeSolver<kDimension>::adopt_prepared(Known& known, std::span<Body* const> bodies) {
  std::unordered_set<const SoftBodyModel<kDimension>*> models;
  for (const Body* const body : bodies) models.insert(body->shared_model().get());
  const std::lock_guard lock(preparing_);
  std::erase_if(prepared_, [&](Place& place) {
    const auto& model = place.plans->model;
    if (!models.contains(model.get())) return model.use_count() == 1;
    known.plans.emplace(model.get(), place.plans);
    known.places.emplace(model.get(), std::move(place));
    return true;
  });
}

/// Copies rotations from the old layout of memory to the new one.
template <int kDimension>
void SpeSolver<kDimension>::adopt(Member& member, Member& old) {
  SC_ASSERT(member.group->model == old.group->model, "a body of {} particles has changed its model",
            member.group->model->particles());
  const auto& bodies = member.group->bodies;
  if (!bodies || bodies == old.group->bodies)
    member.tiled = std::move(old.tiled), member.seen_rest = old.seen_rest;
  else
    bodies->take_rotations(member.number, *old.group->bodies, old.number);
}

/// Updates the plan to the body's present rest shape.
template <int kDimension>
void SpeSolver<kDimension>::follow_rest(Member& member) {
  const Body& body = *member.body;
  if (member.seen_rest == body.rest_revision() || !member.fits_spes()) return;
  member.seen_rest = body.rest_revision();
  if (member.group->bodies) {
    member.group->bodies->set_rest(*body.plan());
    return;
  }
  if constexpr (kDimension == 3) member.tiled->set_rest(*member.group->plans->tiles, *body.plan());
}

/// Bodies have come or gone: lays out memory anew for the models whose bodies have changed. Bodies that stay keep their rotations.
template <int kDimension>
void SpeSolver<kDimension>::regroup(std::span<Body* const> bodies) {
  Known known;
  for (Member& member : members_) known.members.emplace(member.body, &member);
  for (const auto& group : groups_) known.plans.emplace(group->model.get(), group->plans);
  adopt_prepared(known, bodies);
  std::vector<std::unique_ptr<Group>> groups;
  std::vector<Member> members;
  std::unordered_map<const SoftBodyModel<kDimension>*, Group*> with_models_plan;
  for (Body* const body : bodies) {
    SC_ASSERT(std::ranges::count(bodies, body) == 1, "one of {} bodies is there twice", bodies.size());
    const bool own_plan = needs_own_plan(*body);
    Group* group = own_plan ? nullptr : with_models_plan[body->shared_model().get()];
    if (group == nullptr) {
      group = groups.emplace_back(std::make_unique<Group>()).get();
      group->model = body->shared_model();
      group->own_plan = own_plan;
      if (!own_plan) with_models_plan[group->model.get()] = group;
    }
    Member& member = members.emplace_back();
    member.body = body;
    member.group = group;
    member.number = group->members.size();
    group->members.push_back(body);
  }
  for (const auto& group : groups) find_place(*group, known);

  // Everything that may fail comes before anything is taken from the old layout.
  std::size_t jobs = 0;
  for (Member& member : members) {
    const Member* const old = known.find(member);
    const Group& group = *member.group;
    if (group.plans->tiles && old == nullptr) {
      const auto made = known.places.find(group.model.get());
      if (made != known.places.end() && made->second.tiled)
        member.tiled = std::move(made->second.tiled);
      else
        member.tiled = std::make_unique<TiledMemory>(memory_, *group.plans->tiles);
    }
    const TiledMemory* const tiled = old != nullptr ? old->tiled.get() : member.tiled.get();
    jobs += 1 + (tiled != nullptr ? tiled->most_jobs() : 1);  // the first 1 is for a look
  }
  chain_.reserve(jobs);
  for (Member& member : members)
    if (Member* const old = known.find(member)) adopt(member, *old);
  chain_.wait();  // for a step that was dropped: its jobs use memory that is freed now
  chain_.clear();
  groups_ = std::move(groups);
  members_ = std::move(members);
}

/// Adds a job beside the step's, for a body that may yield or break. The body's positions are in main memory already.
template <int kDimension>
void SpeSolver<kDimension>::look_at(Member& member) {
  const Body& body = *member.body;
  if (!strain_ || (!body.settings().fracture && !body.settings().plasticity)) return;
  Group& group = *member.group;
  std::span<const std::uint32_t> place_of;
  std::size_t places = group.model->particles();
  dma::EffectiveAddress positions{};
  if (group.bodies) positions = group.bodies->positions_ea(member.number);
  if constexpr (kDimension == 3) {
    if (member.tiled) {
      place_of = group.plans->tiles->place_of();
      places = member.tiled->positions().size();
      positions = member.tiled->positions_ea();
    }
  }
  if (!StrainLooks<kDimension>::can_look_at(*group.model, places)) return;
  if (!group.looks)
    group.looks = std::make_shared<StrainLooks<kDimension>>(memory_, group.model, place_of, places,
                                                            group.members.size());
  if (const auto job = group.looks->job(member.number, body, positions))
    chain_.add({.image = *strain_, .argp = *job});
}

template <int kDimension>
bool SpeSolver<kDimension>::may_break(const Body& body) const {
  SC_ASSERT(!is_stepping_, "asked whether a body breaks with {} jobs under way", chain_.size());
  const auto member = std::ranges::find(members_, &body, &Member::body);
  return member == members_.end() || !member->stepped || !member->group->looks ||
         member->group->looks->may_break(member->number);
}

/// Copies positions and velocities to main memory.
template <int kDimension>
void SpeSolver<kDimension>::upload(Member& member) {
  using Kernel = MatchKernel<kDimension>;
  const Body& body = *member.body;
  Group& group = *member.group;
  if (group.bodies) {
    group.awake.push_back(member.number);
    group.settings.push_back(settings_of(body, step_));
    const auto positions = as_the_kernel_reads_them(body);
    SC_ASSERT(positions.size() == group.bodies->positions(member.number).size(),
              "a body of {} particles in a plan of {}", positions.size(),
              group.bodies->positions(member.number).size());
    static_assert(sizeof positions[0] == sizeof(typename Kernel::Vector));
    std::memcpy(group.bodies->positions(member.number).data(), positions.data(), positions.size_bytes());
    std::ranges::transform(body.velocities(), group.bodies->velocities(member.number).begin(),
                           Kernel::written);
    return;
  }
  if constexpr (kDimension == 3) {
    const std::span<const std::uint32_t> place_of = group.plans->tiles->place_of();
    for (std::size_t i = 0; i < place_of.size(); ++i) {
      member.tiled->positions()[place_of[i]] = Kernel::written(body.positions()[i]);
      member.tiled->velocities()[place_of[i]] = Kernel::written(body.velocities()[i]);
    }
    member.tiled->begin_step(settings_of(body, step_));
  }
}

template <int kDimension>
void SpeSolver<kDimension>::kick(std::span<Body* const> bodies, float step) {
  SC_ASSERT(step > 0 && std::isfinite(step), "a time step of {} s", step);
  SC_ASSERT(!is_stepping_, "kick() of {} bodies, with {} jobs of the one before under way", bodies.size(),
            chain_.size());
  SC_ASSERT(std::ranges::find(bodies, nullptr) == bodies.end(), "one of {} bodies is null", bodies.size());
  if (!knows(bodies)) regroup(bodies);
  step_ = step;
  is_stepping_ = true;
  left_to_ppu_.clear();
  for (const auto& group : groups_) group->awake.clear(), group->settings.clear();
  for (Member& member : members_) {
    member.stepped = false;
    if (member.body->asleep()) continue;
    member.stepped = member.fits_spes();
    if (member.group->own_plan || member.tiled) follow_rest(member);
    if (member.stepped)
      upload(member);
    else
      left_to_ppu_.push_back(member.body);
  }
  chain_.clear();
  for (const auto& group : groups_) {
    if (group->awake.empty()) continue;
    group->bodies->add_jobs(chain_, match_, group->settings, group->awake,
                            bodies_per_job(group->awake.size(), jobs_.spes()));
  }
  for (Member& member : members_)
    if (member.stepped) look_at(member);
  for (const spu::TilePass pass : kTilePasses) {
    for (const Member& member : members_)
      if (member.stepped && member.tiled) member.tiled->add_jobs(chain_, match_tiles_, pass);
    chain_.sync();
  }
  if (chain_.size() != 0) chain_.kick();
}

/// Copies velocities from main memory.
template <int kDimension>
void SpeSolver<kDimension>::read_back(const Member& member) {
  using Kernel = MatchKernel<kDimension>;
  Body& body = *member.body;
  if (member.group->bodies) {
    const auto velocities = member.group->bodies->velocities(member.number);
    body.set_pulled_velocities([&](std::size_t i) { return Kernel::read(velocities[i]); });
    return;
  }
  if constexpr (kDimension == 3) {
    const std::span<const std::uint32_t> place_of = member.group->plans->tiles->place_of();
    const auto velocities = member.tiled->velocities();
    body.set_pulled_velocities([&](std::size_t i) { return Kernel::read(velocities[place_of[i]]); });
  }
}

template <int kDimension>
void SpeSolver<kDimension>::finish() {
  is_stepping_ = false;  // also if an exception is thrown
  try {
    for (Body* const body : left_to_ppu_) body->pull(step_), body->flow(step_);
  } catch (...) {
    chain_.wait();  // its jobs use memory that the next kick() changes
    throw;
  }
  chain_.wait();
  if (chain_.size() == 0) return;
  check_jobs(chain_);
  for (const auto& group : groups_) {
    if (!group->awake.empty() && !group->bodies->take_results().empty())
      throw std::runtime_error("a soft body has positions or velocities that are not finite numbers");
  }
  for (const Member& member : members_)
    if (member.stepped && member.tiled) member.tiled->end_step();
  for (const Member& member : members_) {
    if (!member.stepped) continue;
    read_back(member);
    const auto& looks = member.group->looks;
    member.body->flow(step_, looks ? looks->stretch(member.number) : std::nullopt);
  }
}

template <int kDimension>
void SpeSolver<kDimension>::drop() {
  is_stepping_ = false;
  chain_.wait();
}

template <int kDimension>
void SpeSolver<kDimension>::forget(const Body& body) {
  SC_ASSERT(!is_stepping_, "forget() with {} jobs under way", chain_.size());
  for (const Member& member : members_) {
    if (member.body != &body) continue;
    if (member.group->bodies) member.group->bodies->reset(member.number);
    if (member.tiled) member.tiled->reset();
  }
  const std::lock_guard lock(preparing_);
  for (Place& place : prepared_) {
    if (place.plans->model != body.shared_model()) continue;
    if (place.bodies) place.bodies->reset(0);
    if (place.tiled) place.tiled->reset();
  }
}

template <int kDimension>
std::size_t SpeSolver<kDimension>::bodies_on_ppu() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(members_, [](const Member& member) { return !member.fits_spes(); }));
}

template class SpeSolver<2>;
template class SpeSolver<3>;

}  // namespace softcell::ppu
