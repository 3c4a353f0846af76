#include "softcell/soft_bodies/shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "ppu/mesh/vertex_normals.h"
#include "ppu/numbers/deterministic_math.h"
#include "softcell/base/assert.h"
#include "softcell/base/text.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3d;
using Triangle = std::array<std::uint32_t, 3>;

void require_length(double value, const char* what) {
  if (!(value > 0) || !std::isfinite(value)) {
    throw std::invalid_argument(std::string(what) + " must be positive and finite, not " +
                                base::shortest(value));
  }
}

void require_count(int value, int low, int high, const char* what) {
  if (value < low || value > high) {
    throw std::invalid_argument(std::string(what) + " must be " + std::to_string(low) + ".." +
                                std::to_string(high) + ", not " + std::to_string(value));
  }
}

/// Positions and triangles alone, in double; normals come later.
struct Surface {
  std::vector<Vector3d> positions;
  std::vector<Triangle> triangles;

  std::uint32_t add(const Vector3d& position) {
    positions.push_back(position);
    return static_cast<std::uint32_t>(positions.size() - 1);
  }
  /// Corners counter-clockwise seen from outside.
  void add_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    SC_ASSERT(std::max({a, b, c, d}) < positions.size(), "a corner {} of {} positions",
              std::max({a, b, c, d}), positions.size());
    triangles.push_back({a, b, c});
    triangles.push_back({a, c, d});
  }
  void append(const Surface& other) {
    const auto base = static_cast<std::uint32_t>(positions.size());
    positions.insert(positions.end(), other.positions.begin(), other.positions.end());
    for (const auto& [a, b, c] : other.triangles) triangles.push_back({a + base, b + base, c + base});
  }
};

/// Its box centred on 0, all of it `factor` times as large.
void centre_and_scale(Surface& surface, double factor) {
  SC_ASSERT(!surface.positions.empty() && factor > 0, "a surface of {} positions, {} times as large",
            surface.positions.size(), factor);
  Vector3d low = surface.positions.front(), high = low;
  for (const Vector3d& p : surface.positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
  for (Vector3d& p : surface.positions) p = factor * (p - 0.5 * (low + high));
}

TriangleMesh smooth_mesh(const Surface& surface) {
  std::vector<Eigen::Vector3f> positions;
  positions.reserve(surface.positions.size());
  for (const Vector3d& position : surface.positions) positions.push_back(position.cast<float>());
  return with_smooth_normals(positions, surface.triangles);
}

/// The surface of the cube [-1, 1]^3, n squares to an edge, vertices shared between faces.
Surface cube_grid(int n) {
  Surface cube;
  std::map<std::array<int, 3>, std::uint32_t> known;
  const auto vertex = [&](const std::array<int, 3>& at) {
    const auto [entry, is_new] = known.try_emplace(at, 0u);
    if (is_new) entry->second = cube.add(Vector3d(2 * at[0] - n, 2 * at[1] - n, 2 * at[2] - n) / n);
    return entry->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;  // u, v, axis are right-handed
    for (const int side : {0, n}) {
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          const auto at = [&](int du, int dv) {
            std::array<int, 3> index{};
            index[axis] = side, index[u] = i + du, index[v] = j + dv;
            return vertex(index);
          };
          const std::uint32_t a = at(0, 0), b = at(1, 0), c = at(1, 1), d = at(0, 1);
          side == 0 ? cube.add_quad(a, d, c, b) : cube.add_quad(a, b, c, d);
        }
      }
    }
  }
  return cube;
}

/// The unit sphere over cube_grid(n). The tangent spreads the squares evenly: equal angles instead of equal
/// lengths.
Surface unit_sphere(int n) {
  Surface sphere = cube_grid(n);
  const auto spread = [](double t) {
    // Exact at the cube's edges and in its middle, so that all six faces meet.
    return t == 0 || t == 1 || t == -1 ? t : sine(kPi / 4 * t) / cosine(kPi / 4 * t);
  };
  for (Vector3d& position : sphere.positions) {
    position = position.unaryExpr(spread).eval();
    position /= position.norm();
  }
  return sphere;
}

/// The rounded box |x/a|^4 + |y/b|^4 + |z/c|^4 = 1 with half edges (a, b, c).
Surface rounded_box(const Vector3d& half_edges, int n) {
  Surface box = unit_sphere(n);
  for (Vector3d& position : box.positions) {
    const double squared = position.array().square().square().sum();
    position = (position / std::sqrt(std::sqrt(squared))).cwiseProduct(half_edges);
  }
  return box;
}

/// A tube closed in itself: `ring_segments` rings of `tube_segments` points; ring(angle, tube_angle) goes
/// round the y axis with the first angle (from x towards z) and, with the second, from outside over the top.
template <class Ring>
Surface closed_tube(int ring_segments, int tube_segments, Ring ring) {
  Surface tube;
  for (int i = 0; i < ring_segments; ++i) {
    for (int j = 0; j < tube_segments; ++j)
      tube.add(ring(2 * kPi * i / ring_segments, 2 * kPi * j / tube_segments));
  }
  const auto at = [&](int i, int j) {
    return static_cast<std::uint32_t>((i % ring_segments) * tube_segments + j % tube_segments);
  };
  for (int i = 0; i < ring_segments; ++i) {
    for (int j = 0; j < tube_segments; ++j)
      tube.add_quad(at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
  }
  return tube;
}

struct ProfilePoint {
  double radius, height;
};

/// A closed surface of revolution about the y axis. The profile has the solid on its left, and begins and ends on the axis, with a
/// radius of 0.
Surface revolve(std::span<const ProfilePoint> profile, int segments) {
  Surface surface;
  const std::size_t rings = profile.size() - 2;
  const std::uint32_t bottom = surface.add({0, profile.front().height, 0});
  const auto at = [&](std::size_t ring, int i) {
    return static_cast<std::uint32_t>(1 + ring * static_cast<std::size_t>(segments) +
                                      static_cast<std::size_t>(i % segments));
  };
  for (std::size_t ring = 0; ring < rings; ++ring) {
    const auto [radius, height] = profile[ring + 1];
    for (int i = 0; i < segments; ++i) {
      const double angle = 2 * kPi * i / segments;
      surface.add({radius * cosine(angle), height, radius * sine(angle)});
    }
  }
  const std::uint32_t top = surface.add({0, profile.back().height, 0});
  for (int i = 0; i < segments; ++i) {
    surface.triangles.push_back({bottom, at(0, i), at(0, i + 1)});
    for (std::size_t ring = 0; ring + 1 < rings; ++ring) {
      surface.add_quad(at(ring, i), at(ring + 1, i), at(ring + 1, i + 1), at(ring, i + 1));
    }
    surface.triangles.push_back({at(rings - 1, i), top, at(rings - 1, i + 1)});
  }
  return surface;
}

/// 1 at 0, falling smoothly to 0 at distance 1 and beyond.
double bump(double squared_distance) {
  const double rest = 1 - squared_distance;
  return rest > 0 ? rest * rest : 0;
}

// The car, in units of its length: x forwards, y up, the hull's middle at 0.
constexpr double kHullHalfLength = 0.45, kHullHalfHeight = 0.16, kHullHalfWidth = 0.27;
constexpr double kBumperRadius = 0.05;
constexpr double kAntennaRadius = 0.02, kAntennaKnobRadius = 0.04;
constexpr double kAntennaX = -0.37, kAntennaFoot = 0.05, kAntennaTop = 1.10;

/// The hull: a rounded box whose bonnet slopes down and into which the cockpit is pressed.
Surface car_hull() {
  Surface hull = rounded_box({kHullHalfLength, kHullHalfHeight, kHullHalfWidth}, 20);
  for (Vector3d& p : hull.positions) {
    if (p.y() <= 0) continue;
    const double forward = std::max(0.0, p.x() / kHullHalfLength);
    const double cockpit =
        bump((p.x() + 0.02) * (p.x() + 0.02) / (0.2 * 0.2) + p.z() * p.z() / (0.22 * 0.22));
    p.y() *= (1 - 0.35 * forward * forward) * (1 - 0.7 * cockpit);
  }
  return hull;
}

/// The bumper: a tube around the hull, along an oval |x/a|^4 + |z/c|^4 = 1 a little outside it.
Surface car_bumper() {
  const double a = 0.5 - kBumperRadius, c = a * kHullHalfWidth / kHullHalfLength;
  return closed_tube(80, 14, [=](double angle, double tube_angle) {
    const double x = cosine(angle), z = sine(angle);
    const double squared = x * x * x * x / (a * a * a * a) + z * z * z * z / (c * c * c * c);
    const double reach = 1 / std::sqrt(std::sqrt(squared));
    const Vector3d middle(reach * x, -0.05, reach * z);
    Vector3d outward(middle.x() * middle.x() * middle.x() / (a * a * a * a), 0,
                     middle.z() * middle.z() * middle.z() / (c * c * c * c));
    outward /= outward.norm();
    return Vector3d(middle +
                    kBumperRadius * (cosine(tube_angle) * outward + sine(tube_angle) * Vector3d::UnitY()));
  });
}

/// An upright rounded plate that leans backwards by `lean` metres per metre of height: seat back and
/// windscreen.
Surface leaning_plate(const Vector3d& middle, const Vector3d& half_edges, double lean) {
  Surface plate = rounded_box(half_edges, 10);
  for (Vector3d& p : plate.positions) p = middle + Vector3d(p.x() - lean * p.y(), p.y(), p.z());
  return plate;
}

/// The antenna: a mast with a round knob. Many short rings, so that it bends smoothly.
Surface car_antenna() {
  std::vector<ProfilePoint> profile{{0, kAntennaFoot}};
  constexpr int kMastRings = 48, kKnobRings = 8;
  // The knob's sphere starts where it is as wide as the mast.
  const double knob_middle = kAntennaTop - kAntennaKnobRadius;
  const double neck = std::sqrt(kAntennaKnobRadius * kAntennaKnobRadius - kAntennaRadius * kAntennaRadius);
  for (int i = 0; i < kMastRings; ++i) {
    profile.push_back({kAntennaRadius, kAntennaFoot + (knob_middle - neck - kAntennaFoot) * i / kMastRings});
  }
  for (int i = 0; i < kKnobRings; ++i) {
    const double height =
        -neck + (neck + kAntennaKnobRadius) * (i * (2.0 * kKnobRings - i)) / (kKnobRings * kKnobRings);
    profile.push_back(
        {std::sqrt(kAntennaKnobRadius * kAntennaKnobRadius - height * height), knob_middle + height});
  }
  profile.push_back({0, kAntennaTop});
  Surface antenna = revolve(profile, 14);
  for (Vector3d& p : antenna.positions) p.x() += kAntennaX;
  return antenna;
}

Surface ellipsoid(const Vector3d& middle, const Vector3d& half_axes, int n) {
  Surface surface = unit_sphere(n);
  for (Vector3d& p : surface.positions) p = middle + p.cwiseProduct(half_axes);
  return surface;
}

/// A flipper on the side of `side` (-1 or 1): it stands off towards its tip.
Surface penguin_flipper(double side) {
  Surface flipper = ellipsoid({0.27 * side, 0.46, 0}, {0.045, 0.21, 0.1}, 6);
  for (Vector3d& p : flipper.positions) p.x() += 0.35 * side * (0.46 - p.y());
  return flipper;
}

}  // namespace

TriangleMesh make_sphere(float radius, int subdivisions) {
  require_length(radius, "a sphere's radius");
  require_count(subdivisions, 1, 512, "a sphere's subdivisions");
  const Surface sphere = unit_sphere(subdivisions);
  TriangleMesh mesh;
  for (const Vector3d& direction : sphere.positions) {
    mesh.positions.push_back((static_cast<double>(radius) * direction).cast<float>());
    mesh.normals.push_back(direction.cast<float>());
  }
  mesh.triangles = sphere.triangles;
  return mesh;
}

TriangleMesh make_torus(float major, float minor, int ring_segments, int tube_segments) {
  require_length(major, "a torus's major radius");
  require_length(minor, "a torus's minor radius");
  if (!(minor < major)) {
    throw std::invalid_argument("a torus's minor radius is " + base::shortest(minor) +
                                "; it must be less than its major radius, " + base::shortest(major));
  }
  require_count(ring_segments, 3, 2048, "a torus's ring segments");
  require_count(tube_segments, 3, 2048, "a torus's tube segments");
  const auto normal = [](double angle, double tube_angle) {
    return Vector3d(cosine(tube_angle) * cosine(angle), sine(tube_angle), cosine(tube_angle) * sine(angle));
  };
  const Surface torus = closed_tube(ring_segments, tube_segments, [&](double angle, double tube_angle) {
    const Vector3d ring(cosine(angle), 0, sine(angle));
    return Vector3d(static_cast<double>(major) * ring +
                    static_cast<double>(minor) * normal(angle, tube_angle));
  });
  TriangleMesh mesh;
  mesh.triangles = torus.triangles;
  for (const Vector3d& position : torus.positions) mesh.positions.push_back(position.cast<float>());
  for (const Vector3d& direction : closed_tube(ring_segments, tube_segments, normal).positions) {
    mesh.normals.push_back(direction.cast<float>());
  }
  return mesh;
}

TriangleMesh make_box(const Eigen::Vector3f& size, float step) {
  require_length(step, "a box's step");
  std::array<int, 3> squares{};
  for (int axis = 0; axis < 3; ++axis) {
    require_length(size[axis], "a box's edge");
    const double count = std::floor(static_cast<double>(size[axis]) / static_cast<double>(step) + 0.5);
    if (count > 1024) throw std::invalid_argument("a box's edge must be at most 1024 steps long");
    squares[static_cast<std::size_t>(axis)] = std::max(1, static_cast<int>(count));
  }
  TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const int columns = squares[static_cast<std::size_t>(u)], rows = squares[static_cast<std::size_t>(v)];
    for (const float side : {-0.5f, 0.5f}) {
      const auto base = static_cast<std::uint32_t>(mesh.positions.size());
      for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i <= columns; ++i) {
          Eigen::Vector3f position = Eigen::Vector3f::Zero(), normal = Eigen::Vector3f::Zero();
          position[axis] = side * size[axis];
          position[u] = size[u] * (static_cast<float>(i) / static_cast<float>(columns) - 0.5f);
          position[v] = size[v] * (static_cast<float>(j) / static_cast<float>(rows) - 0.5f);
          normal[axis] = 2 * side;
          mesh.positions.push_back(position);
          mesh.normals.push_back(normal);
        }
      }
      for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
          const std::uint32_t a = base + static_cast<std::uint32_t>(j * (columns + 1) + i), b = a + 1;
          const std::uint32_t d = a + static_cast<std::uint32_t>(columns + 1), c = d + 1;
          mesh.triangles.push_back(side < 0 ? Triangle{a, c, b} : Triangle{a, b, c});
          mesh.triangles.push_back(side < 0 ? Triangle{a, d, c} : Triangle{a, c, d});
        }
      }
    }
  }
  return mesh;
}

TriangleMesh make_car(float length) {
  require_length(length, "a car's length");
  Surface car = car_hull();
  car.append(car_bumper());
  car.append(leaning_plate({-0.24, 0.17, 0}, {0.05, 0.17, 0.17}, 0.25));  // seat back
  car.append(leaning_plate({0.19, 0.13, 0}, {0.03, 0.09, 0.18}, 0.6));    // windscreen
  car.append(car_antenna());
  centre_and_scale(car, static_cast<double>(length));
  return smooth_mesh(car);
}

TriangleMesh make_penguin(float height) {
  require_length(height, "a penguin's height");
  // In units of its height: feet at 0, x to its left, z forwards.
  Surface penguin = ellipsoid({0, 0.4, 0}, {0.27, 0.38, 0.25}, 12);
  penguin.append(ellipsoid({0, 0.83, 0.01}, {0.17, 0.17, 0.17}, 10));
  penguin.append(ellipsoid({0, 0.82, 0.19}, {0.045, 0.035, 0.12}, 6));  // beak
  for (const double side : {-1.0, 1.0}) {
    penguin.append(penguin_flipper(side));
    penguin.append(ellipsoid({0.13 * side, 0.04, 0.1}, {0.09, 0.04, 0.15}, 6));  // foot
  }
  centre_and_scale(penguin, static_cast<double>(height));
  return smooth_mesh(penguin);
}

TriangleMesh make_cone(float radius, float height, int segments) {
  require_length(radius, "a cone's radius");
  require_length(height, "a cone's height");
  require_count(segments, 3, 2048, "a cone's segments");
  const double half = 0.5 * static_cast<double>(height);
  TriangleMesh mesh;
  const auto add = [&](const Vector3d& position, const Vector3d& normal) {
    mesh.positions.push_back(position.cast<float>());
    mesh.normals.push_back((normal / normal.norm()).cast<float>());
    return static_cast<std::uint32_t>(mesh.positions.size() - 1);
  };
  const auto slope_at = [&](double angle) {
    return Vector3d(2 * half * cosine(angle), radius, 2 * half * sine(angle));
  };
  // Each segment has a tip of its own, so that the tip is shaded like the slope below it.
  for (int i = 0; i < segments; ++i) {
    const double angle = 2 * kPi * i / segments;
    const Vector3d rim(static_cast<double>(radius) * cosine(angle), -half,
                       static_cast<double>(radius) * sine(angle));
    add(rim, slope_at(angle));
    add({0, half, 0}, slope_at(2 * kPi * (i + 0.5) / segments));
    add(rim, -Vector3d::UnitY());
  }
  const std::uint32_t middle = add({0, -half, 0}, -Vector3d::UnitY());
  for (int i = 0; i < segments; ++i) {
    const auto here = static_cast<std::uint32_t>(3 * i),
               next = static_cast<std::uint32_t>(3 * ((i + 1) % segments));
    mesh.triangles.push_back({here, here + 1, next});
    mesh.triangles.push_back({middle, here + 2, next + 2});
  }
  return mesh;
}

TriangleMesh make_cylinder(float radius, float height, int segments) {
  require_length(radius, "a cylinder's radius");
  require_length(height, "a cylinder's height");
  require_count(segments, 3, 2048, "a cylinder's segments");
  const double half = 0.5 * static_cast<double>(height);
  const ProfilePoint profile[] = {{0, -half}, {radius, -half}, {radius, half}, {0, half}};
  return smooth_mesh(revolve(profile, segments));
}

TriangleMesh make_rounded_box(const Eigen::Vector3f& size, int subdivisions) {
  for (const float edge : {size.x(), size.y(), size.z()}) require_length(edge, "a rounded box's edge");
  require_count(subdivisions, 1, 512, "a rounded box's subdivisions");
  return smooth_mesh(rounded_box(0.5 * size.cast<double>(), subdivisions));
}

TriangleMesh make_capsule(float radius, float height, int segments) {
  require_length(radius, "a capsule's radius");
  require_length(height, "a capsule's height");
  require_count(segments, 3, 2048, "a capsule's segments");
  if (!(height > 2 * radius)) {
    throw std::invalid_argument("a capsule's height is " + base::shortest(height) +
                                "; it must be more than twice its radius, " + base::shortest(radius));
  }
  const double r = static_cast<double>(radius), middle = 0.5 * static_cast<double>(height) - r;
  const int rings = std::max(2, segments / 4);  // of half a sphere
  std::vector<ProfilePoint> profile{{0, -middle - r}};
  for (int i = 1; i <= rings; ++i)
    profile.push_back({r * sine(kPi / 2 * i / rings), -middle - r * cosine(kPi / 2 * i / rings)});
  for (int i = rings; i >= 1; --i)
    profile.push_back({r * sine(kPi / 2 * i / rings), middle + r * cosine(kPi / 2 * i / rings)});
  profile.push_back({0, middle + r});
  return smooth_mesh(revolve(profile, segments));
}

TriangleMesh make_vase(float height, int segments) {
  require_length(height, "a vase's height");
  require_count(segments, 3, 2048, "a vase's segments");
  // Radius and height in shares of the height: up the outside, over the rim and down the inside.
  constexpr std::array<std::array<double, 2>, 18> kProfile{{{0, -0.5},
                                                            {0.15, -0.5},
                                                            {0.165, -0.47},
                                                            {0.21, -0.36},
                                                            {0.25, -0.22},
                                                            {0.262, -0.08},
                                                            {0.24, 0.08},
                                                            {0.185, 0.22},
                                                            {0.145, 0.34},
                                                            {0.15, 0.43},
                                                            {0.19, 0.49},
                                                            {0.18, 0.5},
                                                            {0.105, 0.43},
                                                            {0.085, 0.32},
                                                            {0.13, 0.17},
                                                            {0.178, -0.06},
                                                            {0.14, -0.36},
                                                            {0, -0.4}}};
  std::vector<ProfilePoint> profile;
  for (const auto& [radius, at] : kProfile)
    profile.push_back({radius * static_cast<double>(height), at * static_cast<double>(height)});
  return smooth_mesh(revolve(profile, segments));
}

TriangleMesh make_wedge(const Eigen::Vector3f& size) {
  for (const float edge : {size.x(), size.y(), size.z()}) require_length(edge, "a wedge's edge");
  Surface wedge;
  const Vector3d half = 0.5 * size.cast<double>();
  for (const double z : {-half.z(), half.z()}) {
    wedge.add({-half.x(), -half.y(), z});
    wedge.add({half.x(), -half.y(), z});
    wedge.add({half.x(), half.y(), z});
  }
  wedge.triangles = {{0, 2, 1}, {3, 4, 5}};  // the two sides
  wedge.add_quad(0, 1, 4, 3);                // floor
  wedge.add_quad(1, 2, 5, 4);                // back
  wedge.add_quad(0, 3, 5, 2);                // slope
  // Its edges all bend by 90 degrees or more: past the crease, so every face stays flat.
  return smooth_mesh(wedge);
}

TriangleMesh make_marked_cells(float size, const Eigen::Vector3f& ball) {
  require_length(size, "a cell's size");
  for (const float share : ball) {
    if (!(share >= 0.1f && share <= 0.9f))
      throw std::invalid_argument("a ball in a cell must be at 0.1 to 0.9 of it, in each direction");
  }
  // In units of a cell, with the first cell's low corner at 0; nothing reaches out of the two cells.
  constexpr float kLine = 0.03f, kBallRadius = 0.09f;
  // Bars of the three directions differ in width, so that none has an edge in common with another.
  constexpr std::array<float, 3> kBars{0.06f, 0.054f, 0.048f};
  constexpr float kLow = kBars[0] / 2, kHigh = 1 - kLow;
  TriangleMesh mesh;
  const auto add = [&](const TriangleMesh& part, const Eigen::Vector3f& middle) {
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Eigen::Vector3f& p : part.positions)
      mesh.positions.emplace_back(size * (p + middle - Eigen::Vector3f(1, 0.5f, 0.5f)));
    mesh.normals.insert(mesh.normals.end(), part.normals.begin(), part.normals.end());
    for (const auto& [a, b, c] : part.triangles) mesh.triangles.push_back({a + base, b + base, c + base});
  };
  // A bar along an axis has a vertex wherever a cell ends.
  const auto add_bar = [&](int axis, float length, float width, const Eigen::Vector3f& middle) {
    Eigen::Vector3f edges = Eigen::Vector3f::Constant(width);
    edges[axis] = length;
    add(make_box(edges, 1), middle);
  };
  for (const float u : {kLow, kHigh}) {
    for (const float v : {kLow, kHigh}) add_bar(0, 2, kBars[0], {1, u, v});
    for (const float x : {kLow, 1.0f, 1 + kHigh}) {
      add_bar(1, 1, kBars[1], {x, 0.5f, u});
      add_bar(2, 1, kBars[2], {x, u, 0.5f});
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Vector3f middle = ball;
    middle[axis] = 0.5f;
    add_bar(axis, 1, kLine, middle);
  }
  add(make_sphere(kBallRadius, 6), ball);
  return mesh;
}

}  // namespace softcell::ppu
