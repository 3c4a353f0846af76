#include "ppu/spe_bodies/skin_orchestrator.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <string>

#include "ppu/spe_bodies/job_records.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

using spu::SkinCorner;
using spu::SkinGroup;
using spu::SkinJob;
using spu::SkinnedVertex;

struct SkinOrchestrator::Model {
  std::shared_ptr<const Embedding> embedding;
  dma::Buffer<SkinGroup> groups;
};

struct SkinOrchestrator::Body {
  struct Half {
    dma::Buffer<SkinCorner> corners;
    dma::Buffer<SkinJob> jobs;
    dma::Buffer<SkinnedVertex> vertices;
    Eigen::Vector3f origin{0, 0, 0};
    bool skinned = false;  ///< its vertices match its corners
  };
  const Model* model;
  std::array<Half, 2> half;
};

namespace {

constexpr dma::BufferOptions kInput{.spe_access = dma::SpeAccess::kRead};
constexpr dma::BufferOptions kCorners{.spe_access = dma::SpeAccess::kRead, .element_bytes = sizeof(float)};
constexpr dma::BufferOptions kOutput{.spe_access = dma::SpeAccess::kWrite, .element_bytes = 2};

}  // namespace

Eigen::Vector3f skin_origin(std::span<const Eigen::Vector4f> positions) {
  SC_ASSERT(!positions.empty(), "a body without particles has no origin");
  Eigen::Vector3f low = positions[0].head<3>(), high = low;
  for (const Eigen::Vector4f& p : positions) {
    low = low.cwiseMin(p.head<3>());
    high = high.cwiseMax(p.head<3>());
  }
  return low - Eigen::Vector3f::Constant((high - low).maxCoeff() / 16);
}

SkinOrchestrator::SkinOrchestrator(dma::AddressSpace& memory, JobSystem& jobs,
                                   const ls_sim::KernelImage& skin)
    : memory_(memory),
      skin_(jobs.load(skin)),
      chains_{JobChain(jobs, "skinning, first half", 1), JobChain(jobs, "skinning, second half", 1)} {}

SkinOrchestrator::~SkinOrchestrator() = default;

/// Bodies have come or gone: the jobs that were added are useless now.
void SkinOrchestrator::forget_jobs() {
  for (std::size_t half = 0; half < chains_.size(); ++half) {
    chains_[half].wait();
    chains_[half].clear();
    skins_[half].clear();
  }
}

auto SkinOrchestrator::make_body(std::shared_ptr<const Embedding> embedding, std::size_t particles)
    -> std::unique_ptr<Body> {
  SC_ASSERT(embedding != nullptr && particles > 0, "a body of {} particles {} an embedding", particles,
            embedding ? "with" : "without");
  SC_ASSERT(!embedding->groups.empty(), "a body of {} particles without a mesh", particles);
  auto known =
      std::find_if(models_.begin(), models_.end(), [&](const auto& m) { return m->embedding == embedding; });
  if (known == models_.end()) {
    auto model = std::make_unique<Model>();
    model->groups = dma::Buffer<SkinGroup>(memory_, "skin groups", embedding->groups.size(),
                                           of_record(kSkinGroupRecord, kInput));
    std::copy(embedding->groups.begin(), embedding->groups.end(), model->groups.span().begin());
    model->embedding = std::move(embedding);
    known = models_.insert(models_.end(), std::move(model));
  }
  const Embedding& shared = *(*known)->embedding;
  auto body = std::make_unique<Body>();
  body->model = known->get();
  for (Body::Half& half : body->half) {
    half.corners = dma::Buffer<SkinCorner>(memory_, "particle positions", particles, kCorners);
    half.jobs =
        dma::Buffer<SkinJob>(memory_, "skin jobs", shared.parts.size(), of_record(kSkinJobRecord, kInput));
    half.vertices =
        dma::Buffer<SkinnedVertex>(memory_, "skinned vertices", 4 * shared.groups.size(), kOutput);
  }
  return body;
}

std::size_t SkinOrchestrator::add(std::shared_ptr<const Embedding> embedding, std::size_t particles) {
  drain();
  forget_jobs();
  bodies_.push_back(make_body(std::move(embedding), particles));
  jobs_per_frame_ += bodies_.back()->model->embedding->parts.size();
  return bodies_.size() - 1;
}

void SkinOrchestrator::replace(std::size_t body, std::shared_ptr<const Embedding> embedding,
                               std::size_t particles) {
  SC_ASSERT(body < bodies_.size(), "body {} of {}", body, bodies_.size());
  drain();
  forget_jobs();
  std::unique_ptr<Body> other = make_body(std::move(embedding), particles);
  bodies_[body].swap(other);
  jobs_per_frame_ += bodies_[body]->model->embedding->parts.size();
  jobs_per_frame_ -= other->model->embedding->parts.size();
  forget_unused(*other->model);
}

void SkinOrchestrator::forget_unused(const Model& model) {
  if (std::none_of(bodies_.begin(), bodies_.end(), [&](const auto& body) { return body->model == &model; }))
    std::erase_if(models_, [&](const auto& known) { return known.get() == &model; });
}

void SkinOrchestrator::remove(std::size_t body) {
  SC_ASSERT(body < bodies_.size(), "body {} of {}", body, bodies_.size());
  if (JobChain* const chain = chain_under_way()) chain->wait();
  const bool was_in_flight = in_flight_;
  std::exception_ptr failure;
  try {
    if (was_in_flight) collect();
  } catch (...) {
    failure = std::current_exception();
  }
  forget_jobs();
  jobs_per_frame_ -= bodies_[body]->model->embedding->parts.size();
  const Model* const model = bodies_[body]->model;
  bodies_.erase(bodies_.begin() + static_cast<std::ptrdiff_t>(body));
  forget_unused(*model);
  if (failure) std::rethrow_exception(failure);
}

/// @return false, with nothing done: the half has these vertices already, as the body has not moved since
bool SkinOrchestrator::write_half(Body& body, std::span<const Eigen::Vector4f> positions) {
  Body::Half& half = body.half[static_cast<std::size_t>(working_)];
  if (positions.size() != half.corners.size()) {
    throw std::invalid_argument("a body of " + std::to_string(half.corners.size()) + " particles was given " +
                                std::to_string(positions.size()) + " positions");
  }
  static_assert(sizeof(SkinCorner) == sizeof(Eigen::Vector4f));
  if (half.skinned && std::memcmp(half.corners.data(), positions.data(), positions.size_bytes()) == 0)
    return false;
  half.skinned = false;
  std::memcpy(half.corners.data(), positions.data(), positions.size_bytes());
  half.origin = skin_origin(positions);

  const Embedding& embedding = *body.model->embedding;
  for (std::size_t i = 0; i < embedding.parts.size(); ++i) {
    const SkinPart& part = embedding.parts[i];
    SC_ASSERT(part.first_group + part.group_count <= body.model->groups.size(), "groups {} to {} of {}",
              part.first_group, part.first_group + part.group_count, body.model->groups.size());
    SkinJob job{};
    job.groups_ea = body.model->groups.ea(part.first_group).value;
    job.vertices_ea = half.vertices.ea(std::size_t{part.first_group} * 4).value;
    for (std::size_t w = 0; w < 2; ++w) {
      job.window[w].ea = half.corners.ea(part.window[w].first_particle).value;
      job.window[w].count = part.window[w].count;
    }
    for (int axis = 0; axis < 3; ++axis) job.origin[axis] = half.origin[axis];
    job.group_count = part.group_count;
    half.jobs[i] = job;
  }
  return true;
}

/// Chooses the jobs of the bodies that have moved.
void SkinOrchestrator::choose_jobs() {
  const auto half = static_cast<std::size_t>(working_);
  if (skins_[half] == moved_) return;
  JobChain& chain = chains_[half];
  chain.clear();
  skins_[half].clear();
  chain.reserve(jobs_per_frame_);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (!moved_[b]) continue;
    const auto& descriptors = bodies_[b]->half[half].jobs;
    for (std::size_t i = 0; i < descriptors.size(); ++i)
      chain.add({.image = skin_, .argp = descriptors.ea(i)});
  }
  skins_[half] = moved_;
}

/// Null: no chain is under way, or it had nothing to do.
JobChain* SkinOrchestrator::chain_under_way() {
  if (!in_flight_) return nullptr;
  JobChain& chain = chains_[static_cast<std::size_t>(working_)];
  return chain.size() == 0 ? nullptr : &chain;
}

bool SkinOrchestrator::kick(std::span<const std::span<const Eigen::Vector4f>> positions) {
  if (positions.size() != bodies_.size())
    throw std::invalid_argument("kick() needs the positions of every body");
  if (JobChain* const chain = chain_under_way(); chain != nullptr && !chain->finished()) return false;
  collect();
  working_ = shown_ == 0 ? 1 : 0;
  moved_.resize(bodies_.size());
  for (std::size_t b = 0; b < bodies_.size(); ++b) moved_[b] = write_half(*bodies_[b], positions[b]);
  choose_jobs();
  in_flight_ = true;
  if (JobChain* const chain = chain_under_way()) chain->kick();
  return true;
}

/// Takes over the frame that the SPEs have finished, if there is one.
bool SkinOrchestrator::collect() {
  if (!in_flight_) return false;
  const JobChain* const chain = chain_under_way();
  in_flight_ = false;
  if (chain != nullptr && !chain->failures().empty()) {
    std::string message = "skinning a frame failed";
    for (const JobFailure& failure : chain->failures()) message += "; " + failure.message;
    throw std::runtime_error(message);
  }
  shown_ = working_;
  for (const auto& body : bodies_) body->half[static_cast<std::size_t>(shown_)].skinned = true;
  return true;
}

bool SkinOrchestrator::drain() {
  if (JobChain* const chain = chain_under_way()) chain->wait();
  return collect();
}

SkinnedBody SkinOrchestrator::shown(std::size_t body) const {
  SC_ASSERT(body < bodies_.size(), "body {} of {}", body, bodies_.size());
  if (shown_ < 0) return {};
  const Body::Half& half = bodies_[body]->half[static_cast<std::size_t>(shown_)];
  if (!half.skinned) return {};  // it was added after that frame
  return {half.vertices.span(), half.origin};
}

}  // namespace softcell::ppu
