#pragma once
// A solver that does what another one does, and measures how long its user's thread is in it.

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>

#include "softcell/soft_bodies/soft_body_solver.h"

namespace softcell::demos {

/// @tparam kDimension  2 or 3
template <int kDimension>
class TimedSolver final : public ppu::SoftBodySolver<kDimension> {
 public:
  using Body = ppu::SoftBody<kDimension>;
  using Model = ppu::SoftBodyModel<kDimension>;

  /// @param solver  must outlive this object.
  explicit TimedSolver(ppu::SoftBodySolver<kDimension>& solver) : solver_(solver) {}

  /// Elapsed time of all calls so far, except for finish() and prepare().
  std::chrono::nanoseconds time_handing_over() const { return handing_over_; }
  /// Elapsed time of finish() so far: the solver works in it, or waits for SPEs.
  std::chrono::nanoseconds time_finishing() const { return finishing_; }

  void kick(std::span<Body* const> bodies, float step) override {
    const Measured measured(handing_over_);
    solver_.kick(bodies, step);
  }
  void finish() override {
    const Measured measured(finishing_);
    solver_.finish();
  }
  void drop() override {
    const Measured measured(handing_over_);
    solver_.drop();
  }
  void forget(const Body& body) override {
    const Measured measured(handing_over_);
    solver_.forget(body);
  }
  // Other threads call it, too.
  void prepare(const std::shared_ptr<const Model>& model) override { solver_.prepare(model); }
  void inherit_state(const Body& whole, const Body& piece,
                     std::span<const std::uint32_t> particle_of) override {
    const Measured measured(handing_over_);
    solver_.inherit_state(whole, piece, particle_of);
  }
  bool may_break(const Body& body) const override { return solver_.may_break(body); }

 private:
  /// Adds its lifetime to a sum.
  class Measured {
   public:
    explicit Measured(std::chrono::nanoseconds& sum) : sum_(sum) {}
    ~Measured() { sum_ += std::chrono::steady_clock::now() - begin_; }
    Measured(const Measured&) = delete;
    Measured& operator=(const Measured&) = delete;

   private:
    std::chrono::nanoseconds& sum_;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  };

  ppu::SoftBodySolver<kDimension>& solver_;
  std::chrono::nanoseconds handing_over_{0}, finishing_{0};
};

}  // namespace softcell::demos
