#include "surface_grip.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "ppu/contacts/cell_finder.h"
#include "ppu/matching/rotation.h"
#include "softcell/base/assert.h"

namespace softcell::demos {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kPatchMass = 0.1;  // of the body's, weighted
constexpr double kLeastRadiusInCells = 1.5;
// As soft as can be without turning cells inside out, tried on 16 bodies of 117 to 22,209 particles that just stand
// on the floor by themselves: with a rigid share of 0.5, cells of three of them turn.
constexpr double kLeastRigidShare = 0.85;
constexpr double kMostPullOut = 0.2;  // of the patch's radius: there the rigid share is 1
constexpr double kMostKick = 0.03;  // of it, that an impulse moves the patch in one substep against the body

/// 1 at the point, 0 from the radius on, smooth.
double weight_at(double distance, double radius) {
  const double rest = std::max(0.0, 1 - distance * distance / (radius * radius));
  return rest * rest;
}

/// From one particle to all others along links, at rest: what is near in space only, such as the other leg, is far.
std::vector<double> distances_through(const ppu::Lattice<3>& lattice, std::uint32_t from) {
  std::vector<double> distances(lattice.particles.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  distances.at(from) = 0;
  open.emplace(0.0, from);
  while (!open.empty()) {
    const auto [distance, a] = open.top();
    open.pop();
    if (distance > distances[a]) continue;
    for (const std::uint32_t b : lattice.neighbours[a]) {
      const double length = (lattice.rest_position(a) - lattice.rest_position(b)).cast<double>().norm();
      if (distance + length >= distances[b]) continue;
      distances[b] = distance + length;
      open.emplace(distances[b], b);
    }
  }
  return distances;
}

std::uint32_t nearest_particle(const ppu::SoftBody<3>& body, const Vector3f& point) {
  const auto positions = body.positions();
  const auto nearer = [&](const Vector3f& a, const Vector3f& b) {
    return (a - point).squaredNorm() < (b - point).squaredNorm();
  };
  return static_cast<std::uint32_t>(std::min_element(positions.begin(), positions.end(), nearer) -
                                    positions.begin());
}

/// The body as one rigid thing.
struct WholeBody {
  double mass = 0;
  Vector3d centre{0, 0, 0}, velocity{0, 0, 0}, spin{0, 0, 0};
  Matrix3d inverse_inertia = Matrix3d::Zero();
  Matrix3d correlation = Matrix3d::Zero();  // sum m (x - c) x0^T

  explicit WholeBody(const ppu::SoftBody<3>& body) {
    const auto masses = body.model().masses();
    const auto x = body.positions(), v = body.velocities();
    for (std::size_t i = 0; i < masses.size(); ++i) {
      const double m = masses[i];
      mass += m;
      centre += m * x[i].cast<double>();
      velocity += m * v[i].cast<double>();
    }
    SC_ASSERT(mass > 0, "a body of {} particles has a mass of {} kg", masses.size(), mass);
    centre /= mass;
    velocity /= mass;
    Matrix3d second = Matrix3d::Zero();
    for (std::size_t i = 0; i < masses.size(); ++i) {
      const double m = masses[i];
      const Vector3d r = x[i].cast<double>() - centre;
      spin += m * r.cross(Vector3d(v[i].cast<double>()));
      second += m * r * r.transpose();
      correlation += m * r * body.model().lattice().rest_position(i).cast<double>().transpose();
    }
    // A body that is flat or on a line turns about all axes all the same.
    constexpr double kThickness = 1e-3;
    const Matrix3d inertia = second.trace() * (1 + kThickness) * Matrix3d::Identity() - second;
    inverse_inertia = inertia.inverse();
  }

  /// What an impulse of 1 N s at `r` from the centre does to the velocity there.
  Matrix3d response_at(const Vector3d& r) const {
    Matrix3d cross;
    cross << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
    return Matrix3d::Identity() / mass - cross * inverse_inertia * cross;
  }
};

}  // namespace

SurfaceGrip::SurfaceGrip(ppu::SoftBody<3>& body, const Vector3f& point) : body_(body) {
  SC_ASSERT(point.allFinite(), "a body is held at ({}, {}, {})", point.x(), point.y(), point.z());
  find_place(point);
  find_patch();
}

void SurfaceGrip::find_place(const Vector3f& point) {
  const ppu::Lattice<3>& lattice = body_.model().lattice();
  ppu::CellFinder cells;
  cells.place(lattice, body_.positions());
  const auto found = cells.find(point, [](std::uint32_t) { return true; });
  if (!found) {
    corners_[0] = nearest_particle(body_, point);
    corners_.fill(corners_[0]);
    shares_ = {1};
    return;
  }
  corners_ = lattice.corners[found->cell];
  for (std::size_t k = 0; k < corners_.size(); ++k) {
    shares_[k] = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float xi = found->xi[static_cast<int>(axis)];
      shares_[k] *= ((k >> axis) & 1) != 0 ? xi : 1 - xi;
    }
  }
}

void SurfaceGrip::find_patch() {
  const ppu::Lattice<3>& lattice = body_.model().lattice();
  const auto masses = body_.model().masses();
  const auto nearest = std::max_element(shares_.begin(), shares_.end()) - shares_.begin();
  const std::vector<double> distances =
      distances_through(lattice, corners_[static_cast<std::size_t>(nearest)]);

  double mass = 0;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    mass += double{masses[i]};
    centre_at_rest_ += double{masses[i]} * lattice.rest_position(i).cast<double>();
  }
  centre_at_rest_ /= mass;
  const auto weighted_mass = [&](double radius) {
    double sum = 0;
    for (std::size_t i = 0; i < masses.size(); ++i)
      sum += double{masses[i]} * weight_at(distances[i], radius);
    return sum;
  };
  // A lattice may be in pieces.
  double reached = 0;
  for (std::size_t i = 0; i < masses.size(); ++i)
    if (std::isfinite(distances[i])) reached += double{masses[i]};
  const double wanted = std::min(kPatchMass * mass, reached / 2);
  double low = kLeastRadiusInCells * double{lattice.spacing}, high = low;
  while (weighted_mass(high) < wanted) high *= 2;
  for (int halving = 0; halving < 20; ++halving) {
    const double middle = (low + high) / 2;
    (weighted_mass(middle) < wanted ? low : high) = middle;
  }
  radius_ = static_cast<float>(high);

  weights_.resize(masses.size());
  for (std::size_t i = 0; i < masses.size(); ++i) {
    weights_[i] = static_cast<float>(weight_at(distances[i], high));
    patch_mass_ += double{masses[i]} * double{weights_[i]};
  }
  for (std::size_t k = 0; k < corners_.size(); ++k) {
    patch_response_ += double{shares_[k]} * double{weights_[corners_[k]]};
    point_at_rest_ += double{shares_[k]} * lattice.rest_position(corners_[k]).cast<double>();
  }
}

Vector3f SurfaceGrip::point() const {
  Vector3f point(0, 0, 0);
  for (std::size_t k = 0; k < corners_.size(); ++k) point += shares_[k] * body_.position(corners_[k]);
  return point;
}

void SurfaceGrip::pull(const HandMotion<3>& hand, const Vector3f& gravity, float step) {
  SC_ASSERT(step > 0, "a substep of {} s", step);
  using Strength = HandStrength<3>;
  const double h = double{step};
  const WholeBody whole(body_);
  const Vector3d point = this->point().cast<double>(), arm = point - whole.centre;
  Vector3d velocity(0, 0, 0);  // of the point
  for (std::size_t k = 0; k < corners_.size(); ++k)
    velocity += double{shares_[k]} * body_.velocities()[corners_[k]].cast<double>();

  // What is left of its swinging about the hand.
  const double most = h * Strength::most_acceleration(gravity), damped = Strength::damped_share(h);
  const Vector3d drag = Strength::limited(damped * (hand.velocity.cast<double>() - whole.velocity), most);
  const Vector3d slow_down = -damped * (whole.inverse_inertia * whole.spin);
  velocity += drag + slow_down.cross(arm);

  const Matrix3d rotation = ppu::update_rotation(whole.correlation, rotation_);
  const double pulled_out =
      (arm - rotation * (point_at_rest_ - centre_at_rest_)).norm() / (kMostPullOut * double{radius_});
  double rigid = std::min(1.0, kLeastRigidShare + (1 - kLeastRigidShare) * pulled_out * pulled_out);
  const Vector3d change = Strength::wanted_velocity(hand, point) - velocity - h * gravity.cast<double>();
  const Matrix3d response =
      (1 - rigid) * patch_response_ / patch_mass_ * Matrix3d::Identity() + rigid * whole.response_at(arm);
  const Vector3d impulse = Strength::limited(response.inverse() * change, most * whole.mass);

  Vector3d patch = (1 - rigid) / patch_mass_ * impulse;
  const double most_patch = kMostKick * double{radius_} / h;
  if (const double kick = patch.norm(); kick > most_patch) {
    rigid = 1 - (1 - rigid) * most_patch / kick;
    patch *= most_patch / kick;
  }
  const Vector3d shift = drag + rigid / whole.mass * impulse;
  const Vector3d turn = slow_down + rigid * (whole.inverse_inertia * arm.cross(impulse));
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    const Vector3d r = body_.position(i).cast<double>() - whole.centre;
    const Vector3d dv = shift + turn.cross(r) + double{weights_[i]} * patch;
    body_.add_particle_velocity(i, dv.cast<float>());
  }
}

void SurfaceGrip::let_go(const Vector3f& velocity) {
  const Vector3d aid = HandStrength<3>::throw_aid(velocity.cast<double>(), WholeBody(body_).velocity);
  body_.add_velocity(aid.cast<float>());
}

}  // namespace softcell::demos
