#pragma once
// Shows the rotations that shape matching finds as lines.

#include <Eigen/Core>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "ppu/reference/shape_matching.h"
#include "simulation/shown.h"

namespace softcell::demos {

/// Lines to draw, in the form of a lattice of links without particles.
struct Lines {
  std::vector<Eigen::Vector3f> ends;
  std::vector<std::array<std::uint32_t, 2>> links;

  void clear();
  void add(const Eigen::Vector3f& from, const Eigen::Vector3f& to);
};

/// The axes of each particle's region, rotated as the region is. Computes the rotations from the shown positions, so that the lines do not
/// depend on the solver and on where it keeps its rotations.
class RotationAxes {
 public:
  /// Replaces the plans by those of all present bodies.
  void set_bodies(std::vector<std::shared_ptr<const ppu::MatchingPlan<float, 3>>> plans) {
    plans_ = std::move(plans);
    matchers_.clear();
  }

  /// @param bodies  at least as many as there are plans, in the same order
  void update(const std::vector<Shown3d::Body>& bodies);

  /// The x, y and z axes.
  const std::array<Lines, 3>& axes() const { return axes_; }

 private:
  std::vector<std::shared_ptr<const ppu::MatchingPlan<float, 3>>> plans_;
  // The first update() makes them, since most runs never show them.
  std::vector<ppu::ShapeMatcher<float, 3>> matchers_;
  std::vector<Eigen::Vector3f> positions_, goals_;
  std::array<Lines, 3> axes_;
};

}  // namespace softcell::demos
