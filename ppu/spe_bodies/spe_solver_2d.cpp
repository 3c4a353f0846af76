#include "softcell/spe_bodies/spe_solver_2d.h"

#include <algorithm>
#include <vector>

#include "ppu/matching/matching_plan.h"
#include "ppu/spe_bodies/match_orchestrator_2d.h"

namespace softcell::ppu {

struct SpeSolver2d::State {
  struct Model {
    std::shared_ptr<const SoftBodyModel2d> model;
    MatchPlan2d plan;
    std::vector<SoftBody2d*> bodies;
  };

  void set_bodies(std::span<SoftBody2d* const> bodies);
  void pull(float step);
  void write_bodies();
  void read_bodies();

  dma::AddressSpace& memory;
  JobSystem& jobs;
  const ls_sim::KernelImage& match_2d;
  std::vector<Model> models;
  std::vector<MatchOrchestrator2d::Settings> settings_of;  // each model
  std::unique_ptr<MatchOrchestrator2d> matching;           // none without bodies
  std::chrono::nanoseconds waited{0};
};

SpeSolver2d::SpeSolver2d(dma::AddressSpace& memory, JobSystem& jobs, const ls_sim::KernelImage& match_2d)
    : state_(new State{memory, jobs, match_2d, {}, {}, {}}) {}
SpeSolver2d::~SpeSolver2d() = default;

void SpeSolver2d::set_bodies(std::span<SoftBody2d* const> bodies) { state_->set_bodies(bodies); }
void SpeSolver2d::pull(float step) { state_->pull(step); }
std::chrono::nanoseconds SpeSolver2d::time_waited() const { return state_->waited; }

void SpeSolver2d::State::set_bodies(std::span<SoftBody2d* const> bodies) {
  matching.reset();  // before its memory is asked for again
  for (Model& model : models) model.bodies.clear();
  for (SoftBody2d* const body : bodies) {
    const std::shared_ptr<const SoftBodyModel2d>& model = body->shared_model();
    auto known = std::ranges::find(models, model, &Model::model);
    if (known == models.end()) {
      models.push_back({model, MatchPlan2d(model->lattice(), *model->plan()), {}});
      known = models.end() - 1;
    }
    known->bodies.push_back(body);
  }
  std::erase_if(models, [](const Model& model) { return model.bodies.empty(); });
  settings_of.resize(models.size());
  if (models.empty()) return;

  std::vector<MatchOrchestrator2d::Model> makes;
  for (const Model& model : models) makes.push_back({&model.plan, model.bodies.size()});
  matching = std::make_unique<MatchOrchestrator2d>(memory, jobs, match_2d, makes);
}

void SpeSolver2d::State::pull(float step) {
  if (matching == nullptr) return;
  for (std::size_t m = 0; m < models.size(); ++m) {
    const SoftBodySettings& settings = models[m].model->settings();
    settings_of[m] = {.pull = settings.alpha_of_step(step) / step, .damping = settings.damping_of_step(step)};
  }
  write_bodies();
  matching->kick(settings_of);
  const auto begin = std::chrono::steady_clock::now();
  matching->wait();
  waited += std::chrono::steady_clock::now() - begin;
  read_bodies();
}

void SpeSolver2d::State::write_bodies() {
  const auto write = [](const Eigen::Vector2f& v) { return spu::MatchVector2d{v.x(), v.y()}; };
  for (std::size_t m = 0; m < models.size(); ++m) {
    for (std::size_t b = 0; b < models[m].bodies.size(); ++b) {
      const SoftBody2d& body = *models[m].bodies[b];
      std::ranges::transform(body.positions(), matching->positions(m, b).begin(), write);
      std::ranges::transform(body.velocities(), matching->velocities(m, b).begin(), write);
    }
  }
}

void SpeSolver2d::State::read_bodies() {
  for (std::size_t m = 0; m < models.size(); ++m) {
    for (std::size_t b = 0; b < models[m].bodies.size(); ++b) {
      SoftBody2d& body = *models[m].bodies[b];
      const auto velocities = matching->velocities(m, b);
      for (std::size_t i = 0; i < velocities.size(); ++i)
        body.set_particle(i, body.positions()[i], {velocities[i].x, velocities[i].y});
    }
  }
}

}  // namespace softcell::ppu
