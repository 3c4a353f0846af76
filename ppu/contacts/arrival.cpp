#include "ppu/contacts/arrival.h"

#include <algorithm>
#include <cmath>

#include "ppu/contacts/contact_terms.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

// In cells. A point's motion is followed in steps, none below kLeastStep.
constexpr float kLeastStep = 0.02f;
constexpr float kMostSteps = 256;  // for one motion: a faster point takes longer steps
// Sine of the angle between a contact's normal and that of the body's surface: below this they are as good as one.
constexpr float kFaceOn = 0.1f;

/// Looks for what a step of a motion has jumped over or, if it ends in a thin shape, for the side from which it has come.
/// @param before, after  shares of the way; the motion comes nearer to the obstacle at the first and leaves it at the second
/// @return  a place near the obstacle, on the side from which the motion comes; none: it has only passed by
std::optional<Arrival> jumped_over(const Obstacle& obstacle, const Vector3f& from, const Vector3f& along,
                                   float near, float before, float after) {
  constexpr int kHalvings = 20;
  for (int i = 0; i < kHalvings; ++i) {
    const float middle = 0.5f * (before + after);
    const Separation there = separation(obstacle, from + middle * along);
    const bool comes = there.normal.dot(along) < 0;
    if (comes && there.distance <= near) return Arrival{middle, there};
    (comes ? before : after) = middle;
  }
  return {};
}

}  // namespace

std::optional<Arrival> arrive(const Obstacle& obstacle, const Vector3f& from, const Vector3f& along,
                              float near, float spacing) {
  const float length = along.norm();
  Separation here = separation(obstacle, from);
  if (here.distance > length + near) return {};
  float done = 0;
  const float least_step = std::max(kLeastStep * spacing, length / kMostSteps);
  while (here.distance > near && done < length) {
    const float before = done;
    const bool may_jump = least_step > here.distance, came = here.normal.dot(along) < 0;
    done = std::min(length, done + std::max(here.distance - near, least_step));
    here = separation(obstacle, from + done / length * along);
    if (may_jump && came && here.normal.dot(along) > 0)
      if (const auto arrival = jumped_over(obstacle, from, along, near, before / length, done / length))
        return arrival;
  }
  if (here.distance > near) return {};
  return Arrival{length > 0 ? done / length : 1, here};
}

ObstacleHit hit_at(const Arrival& arrival, const PointWay& way) {
  const auto& [share, there] = arrival;
  return ObstacleHit{there.normal, there.distance + (1 - share) * there.normal.dot(way.to - way.from)};
}

std::optional<ObstacleHit> hit_of_face_beside(const Obstacle& obstacle, const PointWay& way,
                                              const Arrival& arrival, const Vector3f& inwards,
                                              float spacing) {
  const Separation& there = arrival.there;
  const float cosine = inwards.dot(there.normal);
  const Vector3f aside = inwards - cosine * there.normal;
  const float sine = aside.norm();
  if (sine < kFaceOn) return {};
  const Vector3f behind = arrival.place_on(way) - kNear * spacing * there.normal;
  const Vector3f beyond = behind + kBeside * spacing / sine * aside;
  const Separation face = separation(obstacle, beyond);
  if (face.distance < 0 || face.normal.dot(inwards) < 0.5f * (cosine + 1)) return {};
  return ObstacleHit{face.normal, face.distance + face.normal.dot(way.to - beyond)};
}

std::optional<EnteredFace> entered_face(const Obstacle& obstacle, const PointWay& way, const Vector3f& inside,
                                        const ObstacleHit& hit, float spacing) {
  const PointWay line{inside, way.from};
  if (hit.normal.dot(line.to - line.from) <= 0) return {};  // the body is in front of it
  const auto arrival = arrive(obstacle, line.from, line.to - line.from, 0, spacing);
  if (!arrival || arrival->share == 0 || arrival->there.normal.dot(hit.normal) > kAlike) return {};
  const Vector3f place = arrival->place_on(line), &normal = arrival->there.normal;
  return EnteredFace{{normal, normal.dot(way.to - place)}, place};
}

}  // namespace softcell::ppu
