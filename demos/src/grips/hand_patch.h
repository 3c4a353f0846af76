#pragma once
// The part of a soft body by which a hand holds it, in either dimension.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "softcell/base/assert.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::demos {

/// The particles around one particle of a body, with smooth weights; their weighted mass is a tenth of the body's. So a patch looks equally
/// large on a lattice of 100 particles and on one of 20,000.
template <int Dimension>
struct HandPatch {
  static constexpr double kMassShare = 0.1;  // of the body's, weighted
  static constexpr double kLeastRadiusInCells = 1.5;

  std::vector<float> weights;  ///< for each particle, smooth: 1 at the middle, 0 from the radius on
  float radius = 0;            ///< metres, measured through the body
  double mass = 0;             ///< kg: sum m w

  /// @param middle  a particle  @pre the body has it
  HandPatch(const ppu::SoftBodyModel<Dimension>& model, std::uint32_t middle) {
    const ppu::Lattice<Dimension>& lattice = model.lattice();
    const auto masses = model.masses();
    const std::vector<double> distances = distances_through(lattice, middle);
    double whole = 0;
    for (const float m : masses) whole += double{m};
    const auto weighted_mass = [&](double at) {
      double sum = 0;
      for (std::size_t i = 0; i < masses.size(); ++i) sum += double{masses[i]} * weight_at(distances[i], at);
      return sum;
    };
    // A lattice may consist of unconnected pieces, of which the patch has only one.
    double reached = 0;
    for (std::size_t i = 0; i < masses.size(); ++i)
      if (std::isfinite(distances[i])) reached += double{masses[i]};
    const double wanted = std::min(kMassShare * whole, reached / 2);
    double low = kLeastRadiusInCells * double{lattice.spacing}, high = low;
    while (weighted_mass(high) < wanted) high *= 2;
    for (int halving = 0; halving < 20; ++halving) {
      const double half = (low + high) / 2;
      (weighted_mass(half) < wanted ? low : high) = half;
    }
    radius = static_cast<float>(high);
    weights.resize(masses.size());
    for (std::size_t i = 0; i < masses.size(); ++i) {
      weights[i] = static_cast<float>(weight_at(distances[i], high));
      mass += double{masses[i]} * double{weights[i]};
    }
  }

 private:
  /// 1 at the point, 0 from the radius on, smooth.
  static double weight_at(double distance, double radius) {
    const double rest = std::max(0.0, 1 - distance * distance / (radius * radius));
    return rest * rest;
  }

  /// Distances from one particle to all others along links, at rest: what is near in space only, such as the other leg, is far.
  static std::vector<double> distances_through(const ppu::Lattice<Dimension>& lattice, std::uint32_t from) {
    std::vector<double> distances(lattice.particles.size(), std::numeric_limits<double>::infinity());
    SC_ASSERT(from < distances.size(), "a hand holds particle {} of {}", from, distances.size());
    using Entry = std::pair<double, std::uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    distances[from] = 0;
    open.emplace(0.0, from);
    while (!open.empty()) {
      const auto [distance, a] = open.top();
      open.pop();
      if (distance > distances[a]) continue;
      for (const std::uint32_t b : lattice.neighbours[a]) {
        const double length =
            (lattice.rest_position(a) - lattice.rest_position(b)).template cast<double>().norm();
        if (distance + length >= distances[b]) continue;
        distances[b] = distance + length;
        open.emplace(distances[b], b);
      }
    }
    return distances;
  }
};

/// The part of a soft body that a hand holds, and that can be pinned.
template <int Dimension>
struct HeldPart {
  const ppu::SoftBody<Dimension>* body = nullptr;
  Eigen::Vector<float, Dimension> point = Eigen::Vector<float, Dimension>::Zero();  ///< metres, as it is now
  float radius = 0;                      ///< metres, of the hand's patch
  std::vector<std::uint32_t> particles;  ///< those that a pin holds, ascending

  HeldPart(const ppu::SoftBody<Dimension>& held, const HandPatch<Dimension>& patch,
           const Eigen::Vector<float, Dimension>& at)
      : body(&held), point(at), radius(patch.radius) {
    for (std::uint32_t i = 0; i < patch.weights.size(); ++i)
      if (patch.weights[i] > kLeastWeight) particles.push_back(i);
  }

 private:
  // This includes two thirds of the radius; in the smallest patch it still includes all neighbours along the axes, so that no part is flat.
  static constexpr float kLeastWeight = 0.3f;
};

/// The shape to which a held body would return: that of its model, or its own shape if it has yielded (ppu::Plasticity).
template <int Dimension>
struct HeldRest {
  std::vector<Eigen::Matrix<float, Dimension, 1>> positions;  ///< of the body's particles, metres
  Eigen::Vector<double, Dimension> centre = Eigen::Vector<double, Dimension>::Zero();  ///< of its mass

  explicit HeldRest(const ppu::SoftBody<Dimension>& body) { copy_rest(body); }
  /// Updates the shape if the body has yielded since; only then does it allocate.
  void renew(const ppu::SoftBody<Dimension>& body) {
    if (body.rest_revision() != revision_) copy_rest(body);
  }

 private:
  void copy_rest(const ppu::SoftBody<Dimension>& body) {
    revision_ = body.rest_revision();
    const auto masses = body.model().masses();
    if (body.has_own_rest()) {
      positions = body.rest_positions();
    } else {
      positions.resize(masses.size());
      for (std::size_t i = 0; i < masses.size(); ++i) positions[i] = body.model().lattice().rest_position(i);
    }
    double whole = 0;
    centre.setZero();
    for (std::size_t i = 0; i < masses.size(); ++i) {
      whole += double{masses[i]};
      centre += double{masses[i]} * positions[i].template cast<double>();
    }
    centre /= whole;
  }

  std::uint32_t revision_ = 0;
};

}  // namespace softcell::demos
