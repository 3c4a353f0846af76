#include "ppu/obstacles/moved_by_place.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "ppu/numbers/turned_towards.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Matrix3f;
using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr float kFastest = 100;       // m/s
constexpr float kLeastCosine = 0.5f;  // of the angle of a turn
// Substeps. A body that has not moved for longer than kLongestFrame has come to rest. When it moves again, the number of substeps in a
// frame is not known; kUnknownFrame stands for it.
constexpr int kLongestFrame = 32, kUnknownFrame = 4;

Matrix3f turn_between(const Pose& from, const Pose& to) { return to.rotation * from.rotation.transpose(); }

bool is_elsewhere(const Pose& from, const Pose& to, float most) {
  return !((to.position - from.position).norm() <= most) ||
         (turn_between(from, to).trace() - 1) / 2 < kLeastCosine;
}

Pose between(const Pose& from, const Pose& to, float share) {
  const Quaternionf turned = turned_towards(Quaternionf(from.rotation), Quaternionf(to.rotation), share);
  return {from.position + share * (to.position - from.position), turned.toRotationMatrix()};
}

}  // namespace

std::optional<MovedByPlace> FollowedPlace::follow(const Pose& now, float size, float step) {
  SC_ASSERT(step > 0 && size >= 0, "a body of {} m moves for {} s", size, step);
  if (!(now == seen_)) {
    left_ = has_moved_ && since_ <= kLongestFrame ? since_ : kUnknownFrame;
    has_moved_ = true;
    since_ = 0;
    seen_ = now;
    if (is_elsewhere(shown_, seen_, std::min(size / 2, kFastest * step * static_cast<float>(left_)))) {
      shown_ = seen_;
      left_ = 0;
      return std::nullopt;
    }
  }
  ++since_;
  const Pose from = shown_;
  shown_ = left_ > 1 ? between(shown_, seen_, 1 / static_cast<float>(left_)) : seen_;
  --left_;
  const Matrix3f turn = turn_between(from, shown_);
  const Vector3f axis(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1));
  return MovedByPlace{from, (shown_.position - from.position) / step, axis / (2 * step)};
}

}  // namespace softcell::ppu
