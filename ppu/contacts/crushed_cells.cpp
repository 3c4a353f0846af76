#include "ppu/contacts/crushed_cells.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <span>

#include "ppu/numbers/row.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr int kIterations = 3;
// A substep gives back this share of the missing volume, and no more than kMostBack of the volume at rest: larger pushes would enter what
// the body lies on.
constexpr float kShareBack = 0.15f, kMostBack = 0.04f;
// In a cell without any extent a small change of volume would need a large motion: the mobility counts as this much at least, in 1 / (mass
// of the cell), for a cell with edges of 1.
constexpr float kLeastMobility = 0.05f;

/// Mean edges, in cells.
struct Edges {
  Vector3f x, y, z;
  float volume() const { return x.dot(y.cross(z)); }
};

/// Where a corner lies along each axis: -1 or 1.
constexpr float side(unsigned corner, unsigned axis) { return (corner >> axis & 1u) != 0 ? 1.0f : -1.0f; }

template <typename Place>
Edges edges_of(const Place& place) {
  Edges edges{Vector3f::Zero(), Vector3f::Zero(), Vector3f::Zero()};
  for (unsigned k = 0; k < 8; ++k) {
    const Vector3f p = place(k);
    edges.x += 0.25f * side(k, 0) * p;
    edges.y += 0.25f * side(k, 1) * p;
    edges.z += 0.25f * side(k, 2) * p;
  }
  return edges;
}

Edges edges_in(std::span<const Vector3f> positions, float spacing,
               const std::array<std::uint32_t, 8>& corners) {
  return edges_of([&](unsigned k) -> Vector3f { return positions[corners[k]] / spacing; });
}

/// The volume of a cell, as a share of that at rest.
float volume_in(std::span<const Vector3f> positions, float spacing,
                const std::array<std::uint32_t, 8>& corners) {
  return edges_in(positions, spacing, corners).volume();
}
/// The area of a cell in two dimensions, that of the parallelogram of its mean edges, as a share of that at rest.
float volume_in(std::span<const Vector2f> positions, float spacing,
                const std::array<std::uint32_t, 4>& corners) {
  Vector2f x = Vector2f::Zero(), y = Vector2f::Zero();
  for (unsigned k = 0; k < 4; ++k) {
    const Vector2f p = positions[corners[k]] / spacing;
    x += 0.5f * side(k, 0) * p;
    y += 0.5f * side(k, 1) * p;
  }
  return x.x() * y.y() - x.y() * y.x();
}

Edges edges_at_beginning(const ContactBody& body, const std::array<std::uint32_t, 8>& corners) {
  return edges_in(body.positions, body.spacing(), corners);
}

/// The derivative of the volume by each corner's place, in cells.
std::array<Vector3f, 8> gradient(const Edges& edges) {
  const Vector3f yz = edges.y.cross(edges.z), zx = edges.z.cross(edges.x), xy = edges.x.cross(edges.y);
  std::array<Vector3f, 8> by_corner;
  for (unsigned k = 0; k < 8; ++k)
    by_corner[k] = 0.25f * (side(k, 0) * yz + side(k, 1) * zx + side(k, 2) * xy);
  return by_corner;
}

/// Changes motions, in cells a substep, so that the volume grows by `wanted`.
/// @return  the moment of the impulses about any place, as they act where particles are at the substep's beginning; 0 if the edges are, too
Vector3d grow(std::vector<Vector3f>& values, float per_value, const std::array<std::uint32_t, 8>& corners,
              const Edges& edges, float wanted, const ContactBody& body) {
  auto by_corner = gradient(edges);
  if (body.model->is_flat())  // keeps it a layer
    for (Vector3f& by : by_corner) by.z() = 0;
  const std::span<const float> masses = body.model->masses();
  float mass = 0, mobility = 0;
  for (unsigned k = 0; k < 8; ++k) {
    mass += masses[corners[k]];
    mobility += by_corner[k].squaredNorm() / masses[corners[k]];
  }
  const float impulse = wanted / std::max(mobility, kLeastMobility * 8 / mass);
  Vector3d moment = Vector3d::Zero();
  for (unsigned k = 0; k < 8; ++k) {
    values[corners[k]] += per_value * impulse / masses[corners[k]] * by_corner[k];
    const Vector3f arm = body.positions[corners[k]] - body.positions[corners[0]];
    moment += arm.cast<double>().cross((per_value * impulse * by_corner[k]).cast<double>());
  }
  return moment;
}

}  // namespace

float volume_of_cell(const ContactBody& body, std::uint32_t cell) {
  SC_ASSERT(cell < body.lattice().corners.size(), "cell {} of {}", cell, body.lattice().corners.size());
  return edges_at_beginning(body, body.lattice().corners[cell]).volume();
}

template <int kDimension>
CrushedCellCount count_crushed_cells(const Lattice<kDimension>& lattice,
                                     std::span<const typename Lattice<kDimension>::Position> positions) {
  SC_ASSERT(positions.size() == lattice.particles.size(), "{} positions of {} particles", positions.size(),
            lattice.particles.size());
  CrushedCellCount count;
  for (const auto& corners : lattice.corners) {
    const float volume = volume_in(positions, lattice.spacing, corners);
    if (volume < kLeastVolume) ++count.crushed;
    if (volume < 0) ++count.inside_out;
  }
  return count;
}

template CrushedCellCount count_crushed_cells<2>(const Lattice<2>&, std::span<const Eigen::Vector2f>);
template CrushedCellCount count_crushed_cells<3>(const Lattice<3>&, std::span<const Vector3f>);

/// The places where particles would be at the end, in cells.
void CrushedCells::place_ends(const ContactBody& body, float step) {
  const float per_spacing = 1 / body.spacing();
  ends_.resize(body.positions.size());
  for (std::size_t i = 0; i < ends_.size(); ++i)
    set_row(ends_[i], per_spacing * (body.positions[i] + step * body.velocities[i]));
}

/// The same as edges_of(), three numbers at a time.
float CrushedCells::volume_at_end(const std::array<std::uint32_t, 8>& corners) const {
  Eigen::Array4f x = Eigen::Array4f::Zero(), y = x, z = x;
  for (unsigned k = 0; k < 8; ++k) {
    const Eigen::Array4f& p = ends_[corners[k]];
    x += 0.25f * side(k, 0) * p;
    y += 0.25f * side(k, 1) * p;
    z += 0.25f * side(k, 2) * p;
  }
  return Edges{x.head<3>(), y.head<3>(), z.head<3>()}.volume();
}

bool CrushedCells::hold(ContactBody& body, float step) {
  SC_ASSERT(step > 0, "a substep of {} s", step);
  cells_.clear();
  least_.clear();
  count_ = 0;
  moment_.setZero();
  const Lattice<3>& lattice = body.lattice();
  const float per_spacing = 1 / body.spacing();
  const auto edges_at_end = [&](const std::array<std::uint32_t, 8>& corners) {
    return edges_of([&](unsigned k) -> Vector3f {
      return per_spacing * (body.positions[corners[k]] + step * body.velocities[corners[k]]);
    });
  };
  place_ends(body, step);
  for (std::uint32_t cell = 0; cell < lattice.cells.size(); ++cell)
    if (!body.model->is_margin(cell) && volume_at_end(lattice.corners[cell]) < kLeastVolume)
      cells_.push_back(cell);
  if (cells_.empty()) return false;

  bool changed = false;
  for (const std::uint32_t cell : cells_) {
    const auto& corners = lattice.corners[cell];
    const Edges edges = edges_at_beginning(body, corners);
    const float volume = edges.volume();
    least_.push_back(std::min(volume, kLeastVolume));
    if (volume >= kLeastVolume) continue;
    ++count_;
    const float back = std::min(kShareBack * (kLeastVolume - volume), kMostBack);
    grow(body.pushes, body.spacing() / step, corners, edges, back, body);
  }
  for (int i = 0; i < kIterations; ++i) {
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      const auto& corners = lattice.corners[cells_[c]];
      const Edges edges = edges_at_end(corners);
      const float missing = least_[c] - edges.volume();
      if (missing <= 0) continue;
      moment_ += grow(body.velocities, body.spacing() / step, corners, edges, missing, body);
      changed = true;
    }
  }
  if (body.model->is_flat()) moment_.head<2>().setZero();
  return changed;
}

}  // namespace softcell::ppu
