#include "ppu/obstacles/side_by_side.h"

#include <Eigen/Geometry>
#include <array>

#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;
using Eigen::Vector4f;

// As shares of the spacing:
constexpr float kInside = 0.02f;   // distance of the tested places from an edge or a face
constexpr float kGoesOn = 0.25f;   // a face goes on if there is something this far beyond its edge
constexpr float kLevel = 0.0025f;  // up to this height something is level with a face
constexpr float kDeepest = 0.25f;  // the longest way out through another face
// And through one that the body is in front of, or not farther behind than kDeepest.
constexpr float kPressedIn = 2;

/// Cosines and sines of an eighth and of a sixteenth of a turn.
constexpr float kEighth = 0.70710678f, kCos = 0.92387953f, kSin = 0.38268343f;
constexpr std::array<std::array<float, 2>, 16> kDirections{{{1, 0},
                                                            {kCos, kSin},
                                                            {kEighth, kEighth},
                                                            {kSin, kCos},
                                                            {0, 1},
                                                            {-kSin, kCos},
                                                            {-kEighth, kEighth},
                                                            {-kCos, kSin},
                                                            {-1, 0},
                                                            {-kCos, -kSin},
                                                            {-kEighth, -kEighth},
                                                            {-kSin, -kCos},
                                                            {0, -1},
                                                            {kSin, -kCos},
                                                            {kEighth, -kEighth},
                                                            {kCos, -kSin}}};

float distance_to(const Obstacle& obstacle, const Vector3f& world) {
  return separation(obstacle, obstacle.to_own(world)).distance;
}

/// Calls work(plane) for each face, with its outward normal and its distance from 0.
template <typename Work>
void for_each_plane(const Obstacle& obstacle, const Work& work) {
  if (obstacle.kind == ObstacleKind::kHull)
    for (const Vector4f& plane : obstacle.planes) work(plane);
  if (obstacle.kind != ObstacleKind::kBox) return;
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {-1.0f, 1.0f}) {
      Vector4f plane = Vector4f::Zero();
      plane[axis] = sign;
      plane[3] = obstacle.extent[axis];
      work(plane);
    }
}

}  // namespace

void Beside::begin(std::span<const Obstacle> obstacles, std::span<const std::uint32_t> near,
                   const Obstacle& own, float spacing) {
  SC_ASSERT(spacing > 0, "a spacing of {} m", spacing);
  obstacles_ = obstacles;
  near_ = near;
  own_ = &own;
  spacing_ = spacing;
  has_looked_ = false;
}

/// Looks for the shapes beside it when first asked: most obstacles have none.
bool Beside::none() {
  SC_ASSERT(own_ != nullptr && own_->kind != ObstacleKind::kTriangles && own_->rounding == 0,
            "what is beside an obstacle of kind {}", own_ == nullptr ? -1 : static_cast<int>(own_->kind));
  if (has_looked_) return others_.empty();
  has_looked_ = true;
  others_.clear();
  Bounds<3> around = bounds(*own_);
  around.low.array() -= kGoesOn * spacing_;
  around.high.array() += kGoesOn * spacing_;
  for (const std::uint32_t index : near_) {
    const Obstacle& other = obstacles_[index];
    if (&other == own_ || other.kind == ObstacleKind::kTriangles) continue;
    Bounds<3> box = bounds(other);
    if (!overlap(around, box)) continue;
    box.low.array() -= 2 * kLevel * spacing_;
    box.high.array() += 2 * kLevel * spacing_;
    others_.push_back({&other, box});
  }
  return others_.empty();
}

bool Beside::is_inside_others(const Vector3f& world, float most) const {
  for (const auto& [other, box] : others_)
    if (overlap(box, Bounds<3>{world, world}) && distance_to(*other, world) <= most) return true;
  return false;
}

bool Beside::face_goes_on(const Vector3f& point, const Vector3f& along) {
  if (none()) return false;
  SC_ASSERT(!along.isZero(0), "an edge without a direction at {} {} {}", point.x(), point.y(), point.z());
  const Vector3f axis = along.normalized(), u = axis.unitOrthogonal(), v = axis.cross(u);
  // Looks on both sides of the point along the edge, as the edge may end there.
  for (const float side : {1.0f, -1.0f}) {
    Vector3f last_normal = Vector3f::Zero();
    for (const auto& [cosine, sine] : kDirections) {
      const Vector3f inside = point + kInside * spacing_ * (2 * side * axis + cosine * u + sine * v);
      const Separation face = separation(*own_, own_->to_own(inside));
      if (face.distance > 0) continue;
      const Vector3f normal = own_->rotation * face.normal;
      if (normal.dot(last_normal) > 0.999f) continue;
      last_normal = normal;
      const Vector3f way = kGoesOn * spacing_ * axis.cross(normal);
      const bool is_outwards = distance_to(*own_, point + way) > distance_to(*own_, point - way);
      if (is_inside_others(is_outwards ? point + way : Vector3f(point - way), kLevel * spacing_)) return true;
    }
  }
  return false;
}

std::optional<Separation> Beside::way_out(const Vector3f& point, const Separation& nearest,
                                          const Vector3f& from, const Vector3f& inside) {
  if (none()) return {};
  const auto has_another_behind = [&](const Separation& face) {
    return is_inside_others(own_->to_world(point + (kInside * spacing_ - face.distance) * face.normal), 0);
  };
  if (!has_another_behind(nearest)) return {};
  std::optional<Separation> best;
  for_each_plane(*own_, [&](const Vector4f& plane) {
    const Separation face{plane.head<3>().dot(point) - plane[3], plane.head<3>()};
    const auto height = [&](const Vector3f& place) { return face.normal.dot(place) - plane[3]; };
    const float deepest = -spacing_ * (height(inside) > -kDeepest * spacing_ ? kPressedIn : kDeepest);
    if (face.distance < deepest || (best && face.distance <= best->distance)) return;
    if (face.normal.dot(nearest.normal) > 0.999f || height(from) < deepest) return;
    const Vector3f place = point - face.distance * face.normal;
    if (separation(*own_, place).distance > 2 * kLevel * spacing_ || has_another_behind(face)) return;
    best = face;
  });
  return best;
}

bool Beside::is_covered(const Vector3f& place, const Vector3f& normal) {
  if (none()) return false;
  const auto is_other_at = [&](float beyond, float most) {
    return is_inside_others(own_->to_world(place + beyond * spacing_ * normal), most * spacing_);
  };
  return is_other_at(kInside, 0) || is_other_at(kGoesOn, kLevel);
}

}  // namespace softcell::ppu
