#include "ppu/obstacles/round_edges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;
using Eigen::Vector4f;

// In cells. Points of a body may be somewhat farther apart than PointChooser wants them, as not every place can have one.
constexpr float kApart = 0.7f;
constexpr float kBulge = 0.06f;
/// The largest cells for which an edge is round, as a multiple of a radius, rounded: between two points a radius bulges by
/// kApart^2 / (8 radius).
constexpr float kCellsOfRadius = 1;

/// The largest cells for which the hull, half of kApart to either side of a place of an edge, lies no more than kBulge lower than there.
/// Each face gives a lower bound of that depth in proportion to the cells, so there is no need to search.
/// @param at     on the edge                       @param out    outwards, of unit length
/// @param aside  at a right angle to both, of unit length
float cells_that_feel(std::span<const Vector4f> planes, const Vector3f& at, const Vector3f& out,
                      const Vector3f& aside) {
  constexpr float kUpright = 0.02f;  // a face that is nearly parallel to `out` is the end of the edge
  float cells = std::numeric_limits<float>::max();
  for (const Vector4f& plane : planes) {
    const Vector3f normal = plane.head<3>();
    const float upright = normal.dot(out);
    if (upright <= kUpright) continue;
    const float behind = std::max(0.0f, plane[3] - normal.dot(at));  // metres from the place to the plane
    const float sinks = kApart / 2 * std::abs(normal.dot(aside)) - kBulge * upright;
    if (sinks * cells > behind) cells = behind / sinks;
  }
  return cells;
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
  Vector3f aside = along.cross(out);
  if (!(aside.norm() > 0)) return 0;
  out.normalize();
  aside.normalize();
  const float sharp = std::ldexp(length, -6);  // its own two faces are on it but for rounding
  float cells = std::numeric_limits<float>::max();
  for (const float share : {0.0f, 1.0f, 0.25f, 0.5f, 0.75f}) {
    cells = std::min(cells, cells_that_feel(planes, edge.from + share * along, out, aside));
    if (cells < sharp) return 0;
  }
  return cells;
}

namespace {

void add_edge_of_hull(const ObstacleEdge& edge, std::span<const Vector4f> planes,
                      std::vector<ObstacleEdge>& edges) {
  constexpr int kMostHalvings = 4;
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

}  // namespace

void add_edges_of_hull(std::span<const ObstacleEdge> of_hull, std::span<const Vector4f> planes,
                       std::vector<ObstacleEdge>& edges) {
  constexpr std::size_t kMost = 60'000;  // edges times faces: they take about a millisecond
  if (of_hull.size() * planes.size() > kMost) {
    edges.insert(edges.end(), of_hull.begin(), of_hull.end());
    return;
  }
  for (const ObstacleEdge& edge : of_hull) add_edge_of_hull(edge, planes, edges);
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
  // The radius of a ball that touches the side, as a share of how far its middle is below the tip.
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
