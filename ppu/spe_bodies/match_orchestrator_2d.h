#pragma once
// Steps bodies in two dimensions on the SPEs: shape matching and damping by the kernel `match_2d`.
//
//     MatchOrchestrator2d matching(memory, jobs, image, {{&man, 20}, {&ball, 3}});  // 20 men, 3 balls
//     matching.positions(0, b)[i] = ..., matching.velocities(0, b)[i] = ...
//     matching.step({{{.pull = alpha / h, .damping = k}, {.pull = ..., .damping = ...}}});
//     ... = matching.velocities(0, b)[i]
//
// Positions, velocities and directions live in main memory, where the SPEs work on them.

#include <cstddef>
#include <span>
#include <vector>

#include "match_2d_job.h"
#include "ppu/plans/match_plan_2d.h"
#include "softcell/dma/buffer.h"
#include "softcell/jobs/job_system.h"

namespace softcell::ppu {

/// Used by one thread at a time.
class MatchOrchestrator2d {
 public:
  using Vector = spu::MatchVector2d;

  /// Bodies of one make.
  struct Model {
    const MatchPlan2d* plan = nullptr;  ///< read by the constructor only
    std::size_t bodies = 0;             ///< 1 or more
  };

  /// How the bodies of one model are stepped.
  struct Settings {
    float pull = 0;     ///< alpha / h, 1/s, not negative
    float damping = 0;  ///< k, 0..1
  };

  /// `memory`, `jobs` and `match_2d` must outlive the orchestrator; `match_2d` is the image of that kernel.
  /// @param bodies_per_job  a job fetches the plan once and steps so many bodies, all of one model
  /// @throws std::runtime_error  main memory is full.
  MatchOrchestrator2d(dma::AddressSpace& memory, JobSystem& jobs, const ls_sim::KernelImage& match_2d,
                      std::span<const Model> models, std::size_t bodies_per_job = 16);

  std::size_t models() const { return models_.size(); }
  std::size_t bodies(std::size_t model) const { return models_[model].bodies; }
  std::span<Vector> positions(std::size_t model,
                              std::size_t body);  ///< metres; the step does not change them
  std::span<Vector> velocities(std::size_t model, std::size_t body);  ///< m/s
  /// Of the plan's regions, in groups of four: see MatchPlan2d::region_of().
  std::span<const spu::MatchDirections> directions(std::size_t model, std::size_t body) const;

  /// One step of all bodies: kick() and wait(). @param settings  one for each model
  void step(std::span<const Settings> settings);

  /// Starts a step. @pre the one before has been waited for. Nothing may be read or changed before wait()
  /// returns.
  /// @throws std::invalid_argument  settings out of their ranges, or not one for each model.
  void kick(std::span<const Settings> settings);

  /// @throws std::runtime_error  a job failed, or a body has positions or velocities that are no numbers;
  ///         those bodies are as they were before the step. They are counted through all models.
  void wait();

  /// Forgets a body's directions, to which regions without one of their own keep; that is also how a body
  /// begins.
  void reset(std::size_t model, std::size_t body);

 private:
  /// The memory of one model's bodies.
  struct Bodies {
    Bodies(dma::AddressSpace& memory, const Model& model, std::size_t bodies_per_job);
    std::byte* state(std::size_t body) { return states.data() + body * spu::match_2d_state_stride(header); }
    const std::byte* state(std::size_t body) const { return const_cast<Bodies*>(this)->state(body); }

    std::size_t bodies;
    spu::MatchPlanHeader2d header;
    dma::Buffer<std::byte> plan, positions, states;
    dma::Buffer<spu::MatchJob2d> jobs;
  };

  std::vector<Bodies> models_;
  bool in_flight_ = false;
  JobChain chain_;  ///< last, so that it has ended before what its jobs work on goes
};

}  // namespace softcell::ppu
