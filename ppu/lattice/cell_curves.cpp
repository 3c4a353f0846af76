#include "ppu/lattice/cell_curves.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "ppu/numbers/keep_each_once.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector2f;
using Eigen::Vector2i;

constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();

/// The weights of both ends of an edge, at a share of it: of their positions and of their derivatives.
struct Curve {
  explicit Curve(float t)
      : position{(1 - t) * (1 - t) * (1 + 2 * t), t * t * (3 - 2 * t)},
        derivative{t * (1 - t) * (1 - t), -t * t * (1 - t)} {}
  std::array<float, 2> position, derivative;
};

void add_to(Skin2d& skin, std::uint32_t cell, const Vector2f& at, const std::vector<Pull2d>& pulls) {
  skin.vertex_cells.push_back(cell);
  skin.rest.push_back(at);
  skin.pulls.insert(skin.pulls.end(), pulls.begin(), pulls.end());
  skin.first_pull.push_back(static_cast<std::uint32_t>(skin.pulls.size()));
}

}  // namespace

MeanMap::MeanMap(const Lattice<2>& lattice) : lattice_(lattice) {
  SC_ASSERT(!lattice.particles.empty(), "a lattice of {} cells without particles", lattice.cells.size());
  Vector2i high = low_ = lattice.particles.front();
  for (const Vector2i& at : lattice.particles) {
    low_ = low_.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  size_ = high - low_ + Vector2i::Ones();
  particle_at_.assign(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()), kNobody);
  for (std::uint32_t i = 0; i < lattice.particles.size(); ++i) {
    const Vector2i at = lattice.particles[i] - low_;
    particle_at_[static_cast<std::size_t>(at.x()) * static_cast<std::size_t>(size_.y()) +
                 static_cast<std::size_t>(at.y())] = i;
  }
}

void MeanMap::add_vertex(Skin2d& skin, std::uint32_t cell, const Vector2f& at) {
  constexpr double kBeyondNearest = 2.5;  // cells: at least three rows of particles count
  SC_ASSERT(cell < lattice_.cells.size(), "cell {} of {}", cell, lattice_.cells.size());
  const auto from_point = [&](std::uint32_t particle) {
    return Eigen::Vector2d((lattice_.particles[particle].cast<float>() - at).cast<double>());
  };
  double nearest = std::numeric_limits<double>::infinity();
  for (const std::uint32_t corner : lattice_.corners[cell])
    nearest = std::min(nearest, from_point(corner).norm());
  const double reach = nearest + kBeyondNearest;
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  std::vector<std::pair<std::uint32_t, Eigen::Vector3d>> weighted;  // w (1, x, y)
  const auto weigh = [&](std::uint32_t particle) {
    const Eigen::Vector2d away = from_point(particle);
    const double inside = 1 - away.squaredNorm() / (reach * reach);
    if (inside <= 0) return;
    const Eigen::Vector3d place(1, away.x(), away.y());
    weighted.emplace_back(particle, inside * inside * place);
    moments += weighted.back().second * place.transpose();
  };
  const auto first = [&](int axis) {
    return std::max(static_cast<int>(std::floor(at[axis] - static_cast<float>(reach))) - low_[axis], 0);
  };
  const auto last = [&](int axis) {
    return std::min(static_cast<int>(std::ceil(at[axis] + static_cast<float>(reach))) - low_[axis],
                    size_[axis] - 1);
  };
  for (int x = first(0); x <= last(0); ++x) {
    for (int y = first(1); y <= last(1); ++y) {
      const std::uint32_t particle =
          particle_at_[static_cast<std::size_t>(x) * static_cast<std::size_t>(size_.y()) +
                       static_cast<std::size_t>(y)];
      if (particle != kNobody) weigh(particle);
    }
  }
  const Eigen::Matrix3d inverse = moments.inverse();
  std::vector<Pull2d> pulls;
  for (const auto& [particle, weight] : weighted) {
    const Eigen::Vector3f share = (inverse * weight).cast<float>();
    pulls.push_back({.particle = particle, .share = share.x(), .along_x = share.y(), .along_y = share.z()});
  }
  add_to(skin, cell, at, pulls);
}

CellCurves::CellCurves(const Lattice<2>& lattice) : lattice_(lattice), cells_of_(lattice.particles.size()) {
  for (std::uint32_t cell = 0; cell < lattice.cells.size(); ++cell)
    for (const std::uint32_t particle : lattice.corners[cell]) cells_of_[particle].push_back(cell);
  for (const std::size_t axis : {0u, 1u}) {
    // Edges that begin and edges that end at each particle, each edge once for each cell beside it.
    struct Edges {
      std::vector<std::uint32_t> before, behind;
    };
    std::vector<Edges> edges(lattice.particles.size());
    const std::size_t step = axis == 0 ? 1 : 2, other = 3 - step;
    for (const auto& corner : lattice.corners) {
      for (const std::size_t first : {std::size_t{0}, other}) {
        const std::uint32_t low = corner[first], high = corner[first + step];
        edges[low].behind.push_back(high);
        edges[high].before.push_back(low);
      }
    }
    derivatives_[axis].resize(lattice.particles.size());
    for (std::uint32_t i = 0; i < edges.size(); ++i) {
      const auto& [before, behind] = edges[i];
      const float sides = before.empty() || behind.empty() ? 1.0f : 2.0f;
      const auto add = [&](const std::vector<std::uint32_t>& ends, float sign) {
        for (const std::uint32_t end : ends) {
          const float share = sign / (sides * static_cast<float>(ends.size()));
          derivatives_[axis][i].push_back({end, share});
          derivatives_[axis][i].push_back({i, -share});
        }
      };
      add(before, -1);
      add(behind, 1);
    }
  }
}

Pull2d& CellCurves::pull_of(std::uint32_t particle) {
  const auto found = std::ranges::find(pulls_, particle, &Pull2d::particle);
  return found != pulls_.end() ? *found : pulls_.emplace_back(Pull2d{.particle = particle});
}

float CellCurves::distance(std::uint32_t cell, const Vector2f& at) const {
  const Vector2f in = at - lattice_.cells[cell].cast<float>();
  return (in - in.cwiseMax(Vector2f::Zero()).cwiseMin(Vector2f::Ones())).norm();
}

void CellCurves::add_vertex(Skin2d& skin, std::uint32_t cell, const Vector2f& at) {
  SC_ASSERT(cell < lattice_.cells.size(), "cell {} of {}", cell, lattice_.cells.size());
  constexpr float kReach = 1, kInside = 1e-3f;  // cells
  pulls_.clear();
  const float away = distance(cell, at);
  if (away < kInside || away > 0.9f * kReach) {
    pull_from(cell, at, 1);
  } else {
    near_.clear();
    for (const std::uint32_t particle : lattice_.corners[cell])
      near_.insert(near_.end(), cells_of_[particle].begin(), cells_of_[particle].end());
    keep_each_once(near_);
    // The weight of a cell grows without limit near the cell, and is 0 at the reach.
    const auto weight = [&](std::uint32_t other) {
      const float far = std::max(distance(other, at), kInside);
      const float height = std::max(kReach / far - 1, 0.0f);
      return height * height;
    };
    float sum = 0;
    for (const std::uint32_t other : near_) sum += weight(other);
    for (const std::uint32_t other : near_)
      if (const float share = weight(other) / sum; share > 0) pull_from(other, at, share);
  }
  std::ranges::sort(pulls_, {}, &Pull2d::particle);
  add_to(skin, cell, at, pulls_);
}

/// Adds the shares by which one cell's patch moves the point.
void CellCurves::pull_from(std::uint32_t cell, const Vector2f& at, float weight_of_cell) {
  const Vector2f in = at - lattice_.cells[cell].cast<float>();
  const Vector2f nearest = in.cwiseMax(Vector2f::Zero()).cwiseMin(Vector2f::Ones()), beyond = in - nearest;
  const Curve along_x(nearest.x()), along_y(nearest.y());
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t i = k & 1, j = k >> 1;
    const std::uint32_t corner = lattice_.corners[cell][k];
    const float share = weight_of_cell * along_x.position[i] * along_y.position[j];
    pull_of(corner).share += share;
    const std::array<float, 2> of_derivative{
        weight_of_cell * along_x.derivative[i] * along_y.position[j] + share * beyond.x(),
        weight_of_cell * along_x.position[i] * along_y.derivative[j] + share * beyond.y()};
    for (const std::size_t axis : {0u, 1u}) {
      for (const auto& [particle, weight] : derivatives_[axis][corner]) {
        Pull2d& pull = pull_of(particle);
        pull.share += of_derivative[axis] * weight;
        (axis == 0 ? pull.along_x : pull.along_y) += share * weight;
      }
    }
  }
}

}  // namespace softcell::ppu
