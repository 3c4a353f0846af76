#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "ppu/attachments/attached_body.h"
#include "ppu/numbers/turning.h"

namespace softcell::ppu {

/// One or both patches of an attachment, which turn as one rigid body.
template <int kDimension>
class TurnedPatches {
 public:
  using Vector = Eigen::Vector<double, kDimension>;

  void add(const AttachedBody<kDimension>& body, std::span<const std::uint32_t> particles) {
    for (const std::uint32_t i : particles) {
      const double mass = 1 / double{body.inverse_masses[i]};
      const Vector position = body.positions[i].template cast<double>();
      mass_ += mass;
      sum_ += mass * position;
      squares_ += mass * position * position.transpose();
    }
    patches_[count_++] = {&body, particles};
  }
  /// Adds an angular momentum and no momentum. In three dimensions particles on one line do not turn.
  void turn(const turning::Axial<kDimension>& spin) const {
    const Vector middle = sum_ / mass_;
    const auto inertia = turning::inertia_of((squares_ - mass_ * middle * middle.transpose()).eval());
    const turning::Axial<kDimension> omega = turning::turn_of(inertia, spin);
    for (const auto& [body, particles] : std::span(patches_).first(count_))
      for (const std::uint32_t i : particles) {
        const Vector arm = body->positions[i].template cast<double>() - middle;
        body->velocities[i] += turning::cross(omega, arm).template cast<float>();
      }
  }

 private:
  struct One {
    const AttachedBody<kDimension>* body;
    std::span<const std::uint32_t> particles;
  };
  std::array<One, 2> patches_{};
  std::size_t count_ = 0;
  double mass_ = 0;
  Vector sum_ = Vector::Zero();
  Eigen::Matrix<double, kDimension, kDimension> squares_ =
      Eigen::Matrix<double, kDimension, kDimension>::Zero();
};

}  // namespace softcell::ppu
