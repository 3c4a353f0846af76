#include "ppu/surfaces/round_edges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;
using Eigen::Vector4f;

// In cells. Points of a body may be a bit farther apart than PointChooser wants them, as not each place can have one.
constexpr float kApart = 0.7f;
constexpr float kBulge = 0.06f;
/// Of a radius, which bulges by kApart^2 / (8 radius): rounded.
constexpr float kCellsOfRadius = 1;

/// How far a hull stands out between two places of its surface, one on either side of an edge.
/// @param at     on the edge                     @param out     outwards, of unit length
/// @param aside  from the edge to one of the places, at a right angle to `out`
float bulge(std::span<const Vector4f> planes, const Vector3f& at, const Vector3f& out,
            const Vector3f& aside) {
  constexpr float kUpright = 0.02f;  // a face that is nearly parallel to `out` is the end of the edge
  float sum = 0;
  for (const Vector3f& place : {Vector3f(at + aside), Vector3f(at - aside)}) {
    float height = 0;
    for (const Vector4f& plane : planes) {
      const Vector3f normal = plane.head<3>();
      const float upright = normal.dot(out);
      if (upright > kUpright) height = std::min(height, (plane[3] - normal.dot(place)) / upright);
    }
    sum -= height;
  }
  return sum / 2;
}

}  // namespace

float cells_that_feel(const ObstacleEdge& edge, std::span<const Vector4f> planes) {
  const Vector3f along = edge.to - edge.from;
  const float length = along.norm();
  if (!(length > 0)) return 0;
  const float tolerance = 1e-4f * (length + std::max(edge.from.norm(), edge.to.norm()));
  Vector3f out = Vector3f::Zero();
  for (const Vector4f& plane : planes) {
    const Vector3f normal = plane.head<3>();
    const float from = std::abs(normal.dot(edge.from) - plane[3]),
                to = std::abs(normal.dot(edge.to) - plane[3]);
    if (std::max(from, to) <= tolerance) out += normal;
  }
  const Vector3f aside = along.cross(out);
  if (!(aside.norm() > 0)) return 0;
  out.normalize();
  const auto is_felt_in_cells_of = [&](float cell) {
    const Vector3f half = kApart / 2 * cell * aside.normalized();
    for (const float share : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f})
      if (!(bulge(planes, edge.from + share * along, out, half) <= kBulge * cell)) return false;
    return true;
  };
  // The share of a cell by which a convex hull bulges grows with the cell.
  constexpr int kHalvings = 10;
  float felt = std::ldexp(length, -6), not_felt = std::ldexp(length, 3);
  if (!is_felt_in_cells_of(felt)) return 0;
  for (int i = 0; i < kHalvings; ++i) {
    const float between = std::sqrt(felt * not_felt);
    (is_felt_in_cells_of(between) ? felt : not_felt) = between;
  }
  return felt;
}

void add_edge_of_hull(const ObstacleEdge& edge, std::span<const Vector4f> planes,
                      std::vector<ObstacleEdge>& edges) {
  constexpr int kMostHalvings = 5;
  ObstacleEdge rest = edge;
  for (int i = 0; i < kMostHalvings; ++i) {
    rest.cells_above = cells_that_feel(rest, planes);
    if (rest.cells_above > 0) break;
    const Vector3f middle = 0.5f * (rest.from + rest.to);
    ObstacleEdge first{rest.from, middle}, second{middle, rest.to};
    first.cells_above = cells_that_feel(first, planes);
    second.cells_above = cells_that_feel(second, planes);
    if (first.cells_above == second.cells_above) break;  // sharp at both ends
    const bool is_first = first.cells_above > 0;
    edges.push_back(is_first ? first : second);
    rest = is_first ? second : first;
  }
  edges.push_back(rest);
}

void add_axis_of_cylinder(float radius, float half_height, std::vector<ObstacleEdge>& edges) {
  SC_ASSERT(radius >= 0 && half_height >= 0, "a cylinder of radius {} m and half height {} m", radius,
            half_height);
  if (half_height <= radius) return;
  const Vector3f end(0, half_height - radius, 0);
  edges.push_back({-end, end, radius, radius, kCellsOfRadius * radius});
}

void add_axis_of_cone(float radius, float half_height, std::vector<ObstacleEdge>& edges) {
  SC_ASSERT(radius >= 0 && half_height >= 0, "a cone of radius {} m and half height {} m", radius,
            half_height);
  constexpr int kParts = 6;
  const float height = 2 * half_height;
  // Of a ball that touches the side: its radius, as a share of how far its middle is below the tip.
  const float share = radius / std::sqrt(radius * radius + height * height);
  const auto place = [&](float below) { return Vector3f(0, half_height - below, 0); };
  float below = height / (1 + share);  // the ball there touches the base, too
  for (int part = 1; part <= kParts; ++part) {
    const float above = part == kParts ? 0 : below / 2;
    edges.push_back(
        {place(below), place(above), share * below, share * above, kCellsOfRadius * share * above});
    below = above;
  }
}

}  // namespace softcell::ppu
