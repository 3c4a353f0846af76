#include "ppu/contacts/overlap.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "ppu/numbers/box_around.h"
#include "ppu/surfaces/edge_points.h"
#include "ppu/surfaces/triangle_distance.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

class OverlapSearch {
 public:
  OverlapSearch(std::span<const Vector3f> positions, const ContactModel& model, const CellFinder& cells,
                const Obstacle& obstacle)
      : positions_(positions),
        model_(model),
        cells_(cells),
        obstacle_(obstacle),
        spacing_(model.lattice().spacing) {}

  std::optional<Overlap> find() const {
    Vector3f sum = Vector3f::Zero();
    float inside = 0;
    std::optional<Overlap> beside;  // a point of the obstacle that is in the body
    for (const TouchPoint& touch : model_.touch_points) {
      const Vector3f point = touch.anchor.of(positions_);
      const Separation from = separation_of(point);
      if (from.distance <= -touch.allowance && obstacle_.kind != ObstacleKind::kTriangles) {
        sum += point;
        inside += 1;
      } else if (inside == 0 && !beside) {
        beside = try_nearest(point, from);
      }
    }
    if (inside > 0) {
      const Vector3f middle = sum / inside;
      return Overlap{middle, separation_of(middle).normal};
    }
    return beside ? beside : find_along_edges();
  }

 private:
  /// Separation of a point in the world from the obstacle.
  Separation separation_of(const Vector3f& point) const {
    Separation result;
    if (obstacle_.kind == ObstacleKind::kTriangles) {
      Vector3f away = Vector3f::Constant(std::numeric_limits<float>::max());
      const Vector3f own = obstacle_.to_own(point);
      float nearest = std::numeric_limits<float>::max();
      for (const auto& triangle : obstacle_.triangles) {
        const Vector3f off = own - nearest_point(triangle, own);
        if (off.squaredNorm() < nearest) nearest = off.squaredNorm(), away = off;
      }
      result.distance = std::sqrt(nearest);
      if (result.distance > 0) result.normal = away / result.distance;
    } else {
      result = separation(obstacle_, obstacle_.to_own(point));
    }
    result.normal = obstacle_.rotation * result.normal;
    return result;
  }

  /// For a thin obstacle between points of the body: its nearest point to one of them lies within the body.
  std::optional<Overlap> try_nearest(const Vector3f& point, const Separation& from) const {
    constexpr float kFarthest = 2, kRounding = 1e-3f;  // cells
    if (from.distance > kFarthest * spacing_) return {};
    const Vector3f nearest = point - from.distance * from.normal;
    // Near edges of a hull, separation() underestimates the distance.
    if (separation_of(nearest).distance > kRounding * spacing_ || !is_in_body(nearest, 0)) return {};
    return Overlap{nearest, from.normal};
  }

  std::optional<Overlap> find_along_edges() const {
    std::optional<Overlap> found;
    const Bounds<3> box = box_around<Bounds<3>>(positions_);
    for (std::size_t i = 0; i < obstacle_.edge_count(); ++i) {
      const ObstacleEdge edge = obstacle_.edge(i);
      const Vector3f from = obstacle_.to_world(edge.from), along = obstacle_.to_world(edge.to) - from;
      for_each_point_of_edge(from, along, box, kEdgeSpacing * spacing_,
                             [&](const Vector3f& point, float share) {
                               if (!found && is_in_body(point, obstacle_.rounding + edge.radius_at(share)))
                                 found = Overlap{point, separation_of(point).normal};
                             });
      if (found) break;
    }
    return found;
  }

  /// @param rounding  metres by which the point may be outside
  bool is_in_body(const Vector3f& point, float rounding) const {
    const auto place = cells_.find(point, [](std::uint32_t) { return true; });
    if (!place) return false;
    const FieldValue field = model_.surface.field(place->cell, place->xi);
    if (field.distance <= 0) return true;
    const float steep = (place->jacobian.inverse().transpose() * field.gradient).norm();
    return field.distance <= rounding * steep;
  }

  std::span<const Vector3f> positions_;
  const ContactModel& model_;
  const CellFinder& cells_;
  const Obstacle& obstacle_;
  float spacing_;
};

}  // namespace

std::optional<Overlap> find_overlap(std::span<const Vector3f> positions, const ContactModel& model,
                                    const CellFinder& cells, const Obstacle& obstacle) {
  SC_ASSERT(positions.size() == model.lattice().particles.size(),
            "{} particles with the surface of a model of {}", positions.size(),
            model.lattice().particles.size());
  return OverlapSearch(positions, model, cells, obstacle).find();
}

}  // namespace softcell::ppu
