#include "rotation_axes.h"

#include "softcell/base/assert.h"

namespace softcell::demos {

void Lines::clear() {
  ends.clear();
  links.clear();
}

void Lines::add(const Eigen::Vector3f& from, const Eigen::Vector3f& to) {
  const auto first = static_cast<std::uint32_t>(ends.size());
  ends.push_back(from);
  ends.push_back(to);
  links.push_back({first, first + 1});
}

void RotationAxes::update(const std::vector<Shown3d::Body>& bodies) {
  constexpr float kLengthInCells = 0.45f;  // so that the axes of neighbours do not meet
  SC_ASSERT(bodies.size() >= plans_.size(), "{} bodies with the plans of {}", bodies.size(), plans_.size());
  for (Lines& lines : axes_) lines.clear();
  while (matchers_.size() < plans_.size()) matchers_.emplace_back(plans_[matchers_.size()]);
  for (std::size_t b = 0; b < matchers_.size(); ++b) {
    ppu::ShapeMatcher<float, 3>& matcher = matchers_[b];
    positions_.clear();
    for (const Eigen::Vector4f& p : bodies[b].particles) positions_.emplace_back(p.head<3>());
    SC_ASSERT(positions_.size() == matcher.plan().particles(), "body {} has {} particles of {}", b,
              positions_.size(), matcher.plan().particles());
    goals_.resize(positions_.size());
    matcher.goals(positions_, goals_);
    const float length = kLengthInCells * matcher.plan().spacing();
    const auto region_of = matcher.plan().sums().region_of();
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      const Eigen::Matrix3f rotation = matcher.rotations()[region_of[i]].toRotationMatrix();
      for (int axis = 0; axis < 3; ++axis)
        axes_[static_cast<std::size_t>(axis)].add(positions_[i], positions_[i] + length * rotation.col(axis));
    }
  }
}

}  // namespace softcell::demos
