#include "snapshots_3d.h"

#include "ppu/bodies/processor_time.h"
#include "softcell/base/assert.h"

namespace softcell::demos {

void Snapshots3d::skin_on_spes(dma::AddressSpace& memory, ppu::JobSystem& jobs,
                               const ls_sim::KernelImage& skin) {
  SC_ASSERT(!orchestrator_ && drawn_.empty(), "{} bodies are skinned already", drawn_.size());
  orchestrator_.emplace(memory, jobs, skin);
}

bool Snapshots3d::follow(const ppu::BulletSoftBodies& bodies) {
  const std::size_t before = drawn_.size();
  bool changed = before != bodies.size();
  drawn_.resize(bodies.size());
  positions_.resize(bodies.size());
  vertices_ = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const auto& model = bodies[b].shared_model();
    positions_[b] = bodies[b].padded_positions();
    vertices_ += model->embedding().slot_of_vertex.size();
    if (drawn_[b] == model) continue;
    changed = true;
    drawn_[b] = model;
    if (!orchestrator_) continue;
    const std::shared_ptr<const ppu::Embedding> embedding(model, &model->embedding());
    if (b < before)
      orchestrator_->replace(b, embedding, model->particles());
    else
      orchestrator_->add(embedding, model->particles());
  }
  return changed;
}

void Snapshots3d::remove(std::size_t body) {
  SC_ASSERT(body < drawn_.size(), "body {} of {}", body, drawn_.size());
  drawn_.erase(drawn_.begin() + static_cast<std::ptrdiff_t>(body));
  if (orchestrator_) orchestrator_->remove(body);
}

Snapshot3d& Snapshots3d::next() {
  SC_ASSERT(!handed_over_, "a frame of {} bodies is handed over before the one before is taken",
            positions_.size());
  return snapshots_[static_cast<std::size_t>(1 - newest_)];
}

void Snapshots3d::hand_over(std::span<const std::size_t> sources) {
  if (orchestrator_) {
    copy_particles(sources);
    const auto before = ppu::processor_time();
    orchestrator_->kick(positions_);
    skin_time_ = ppu::processor_time() - before;
  } else {
    const auto before = ppu::processor_time();
    copy_particles(sources);
    for (std::size_t b = 0; b < positions_.size(); ++b) next().origins[b] = ppu::skin_origin(positions_[b]);
    skin_time_ = ppu::processor_time() - before;
  }
  handed_over_ = true;
}

void Snapshots3d::copy_particles(std::span<const std::size_t> sources) {
  SC_ASSERT(sources.size() == positions_.size(), "the sources of {} soft bodies of {}", sources.size(),
            positions_.size());
  Snapshot3d& snapshot = next();
  snapshot.particles.resize(positions_.size());
  for (std::size_t b = 0; b < positions_.size(); ++b)
    snapshot.particles[b].assign(positions_[b].begin(), positions_[b].end());
  snapshot.models = drawn_;
  snapshot.sources.assign(sources.begin(), sources.end());
  snapshot.origins.resize(positions_.size());
}

void Snapshots3d::take_over() {
  if (!handed_over_) return;
  handed_over_ = false;
  if (orchestrator_) orchestrator_->drain();
  newest_ = 1 - newest_;
}

ppu::SkinnedBody Snapshots3d::skinned(std::size_t body) const {
  SC_ASSERT(body < shown().particles.size(), "body {} of {}", body, shown().particles.size());
  if (orchestrator_) return orchestrator_->shown(body);
  return {.vertices = {}, .origin = shown().origins[body]};
}

}  // namespace softcell::demos
