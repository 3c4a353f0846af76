#include "ppu/lattice/outline_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ppu/numbers/share_of_segment.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

using Eigen::Vector2f;
using Eigen::Vector2i;

OutlineDistance::OutlineDistance(const Skin2d& skin) {
  for (const auto& loop : skin.outlines)
    for (std::size_t i = 0; i < loop.size(); ++i)
      segments_.push_back({skin.rest[loop[i]], skin.rest[loop[(i + 1) % loop.size()]]});
  SC_ASSERT(!segments_.empty(), "a skin of {} vertices has no outlines", skin.rest.size());
  const auto square = [](const Vector2f& at) -> Vector2i { return at.array().floor().matrix().cast<int>(); };
  Vector2i high = low_ = square(segments_.front().from);
  for (const Segment& segment : segments_) {
    low_ = low_.cwiseMin(square(segment.from));
    high = high.cwiseMax(square(segment.from));
  }
  size_ = high - low_ + Vector2i::Ones();
  squares_.resize(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()));
  rows_.resize(static_cast<std::size_t>(size_.y()));
  for (std::uint32_t i = 0; i < segments_.size(); ++i) {
    const Vector2i a = square(segments_[i].from) - low_, b = square(segments_[i].to) - low_;
    const Vector2i first = a.cwiseMin(b), last = a.cwiseMax(b);
    for (int y = first.y(); y <= last.y(); ++y) {
      rows_[static_cast<std::size_t>(y)].push_back(i);
      for (int x = first.x(); x <= last.x(); ++x)
        squares_[static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.x()) +
                 static_cast<std::size_t>(x)]
            .push_back(i);
    }
  }
}

float OutlineDistance::Segment::distance(const Vector2f& at) const {
  const Vector2f along = to - from;
  return (at - from - share_of_segment(from, along, at) * along).norm();
}

/// Looks at squares around the place, ring by ring: everything beyond ring r is farther than r cells.
float OutlineDistance::nearest(const Vector2f& at) const {
  const Vector2i middle = at.array().floor().matrix().cast<int>() - low_;
  const int rings = std::max(middle.cwiseAbs().maxCoeff(), (size_ - middle).cwiseAbs().maxCoeff());
  float least = std::numeric_limits<float>::max();
  for (int ring = 0; ring <= rings && least > static_cast<float>(ring - 1); ++ring) {
    for (int y = std::max(middle.y() - ring, 0); y <= std::min(middle.y() + ring, size_.y() - 1); ++y) {
      const bool whole_row = std::abs(y - middle.y()) == ring;
      for (int x = middle.x() - ring; x <= middle.x() + ring; x += whole_row || ring == 0 ? 1 : 2 * ring) {
        if (x < 0 || x >= size_.x()) continue;
        for (const std::uint32_t i : in_square(x, y)) least = std::min(least, segments_[i].distance(at));
      }
    }
  }
  return least;
}

bool OutlineDistance::is_inside(const Vector2f& at) const {
  const int row = static_cast<int>(std::floor(at.y())) - low_.y();
  if (row < 0 || row >= size_.y()) return false;
  int around = 0;
  for (const std::uint32_t i : rows_[static_cast<std::size_t>(row)]) {
    const Segment& segment = segments_[i];
    const bool up = segment.from.y() <= at.y() && segment.to.y() > at.y();
    const bool down = segment.to.y() <= at.y() && segment.from.y() > at.y();
    if (!up && !down) continue;
    const float share = (at.y() - segment.from.y()) / (segment.to.y() - segment.from.y());
    if (segment.from.x() + share * (segment.to.x() - segment.from.x()) > at.x()) around += up ? 1 : -1;
  }
  return around > 0;
}

float OutlineDistance::signed_distance(const Vector2f& at) const {
  return is_inside(at) ? -nearest(at) : nearest(at);
}

}  // namespace softcell::ppu
