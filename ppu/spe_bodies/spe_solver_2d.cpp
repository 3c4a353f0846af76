#include "softcell/spe_bodies/spe_solver_2d.h"

#include <algorithm>

namespace softcell::ppu {

SpeSolver2d::SpeSolver2d(dma::AddressSpace& memory, JobSystem& jobs, const ls_sim::KernelImage& match_2d)
    : memory_(memory), jobs_(jobs), match_2d_(match_2d) {}

void SpeSolver2d::set_bodies(std::span<SoftBody2d* const> bodies) {
  matching_.reset();  // before its memory is asked for again
  for (Model& model : models_) model.bodies.clear();
  for (SoftBody2d* const body : bodies) {
    const std::shared_ptr<const SoftBodyModel2d>& model = body->shared_model();
    auto known = std::ranges::find(models_, model, &Model::model);
    if (known == models_.end()) {
      models_.push_back({model, MatchPlan2d(model->lattice(), *model->plan()), {}});
      known = models_.end() - 1;
    }
    known->bodies.push_back(body);
  }
  std::erase_if(models_, [](const Model& model) { return model.bodies.empty(); });
  settings_.resize(models_.size());
  if (models_.empty()) return;

  std::vector<MatchOrchestrator2d::Model> makes;
  for (const Model& model : models_) makes.push_back({&model.plan, model.bodies.size()});
  matching_ = std::make_unique<MatchOrchestrator2d>(memory_, jobs_, match_2d_, makes);
}

void SpeSolver2d::pull(float step) {
  if (matching_ == nullptr) return;
  for (std::size_t m = 0; m < models_.size(); ++m) {
    const SoftBodySettings& settings = models_[m].model->settings();
    settings_[m] = {.pull = settings.alpha_of_step(step) / step, .damping = settings.damping_of_step(step)};
  }
  write_bodies();
  matching_->kick(settings_);
  const auto begin = std::chrono::steady_clock::now();
  matching_->wait();
  waited_ += std::chrono::steady_clock::now() - begin;
  read_bodies();
}

void SpeSolver2d::write_bodies() {
  const auto write = [](const Eigen::Vector2f& v) { return spu::MatchVector2d{v.x(), v.y()}; };
  for (std::size_t m = 0; m < models_.size(); ++m) {
    for (std::size_t b = 0; b < models_[m].bodies.size(); ++b) {
      const SoftBody2d& body = *models_[m].bodies[b];
      std::ranges::transform(body.positions(), matching_->positions(m, b).begin(), write);
      std::ranges::transform(body.velocities(), matching_->velocities(m, b).begin(), write);
    }
  }
}

void SpeSolver2d::read_bodies() {
  for (std::size_t m = 0; m < models_.size(); ++m) {
    for (std::size_t b = 0; b < models_[m].bodies.size(); ++b) {
      SoftBody2d& body = *models_[m].bodies[b];
      const auto velocities = matching_->velocities(m, b);
      for (std::size_t i = 0; i < velocities.size(); ++i)
        body.set_particle(i, body.positions()[i], {velocities[i].x, velocities[i].y});
    }
  }
}

}  // namespace softcell::ppu
