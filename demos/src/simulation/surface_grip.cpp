#include "surface_grip.h"

#include <algorithm>

#include "ppu/contacts/cell_finder.h"
#include "ppu/matching/rotation.h"
#include "softcell/base/assert.h"

namespace softcell::demos {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

// As soft as can be without turning cells inside out, tried on 16 bodies of 117 to 22,209 particles that just stand
// on the floor by themselves: with a rigid share of 0.5, cells of three of them turn.
constexpr double kLeastRigidShare = 0.85;
constexpr double kMostPullOut = 0.2;  // of the patch's radius: there the rigid share is 1
constexpr double kMostKick = 0.03;  // of it, that an impulse moves the patch in one substep against the body

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

  WholeBody(const ppu::SoftBody<3>& body, const HeldRest<3>& rest) {
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
      correlation += m * r * rest.positions[i].cast<double>().transpose();
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

SurfaceGrip::SurfaceGrip(ppu::SoftBody<3>& body, const Vector3f& point)
    : body_(body), place_(place_of(body, point)), patch_(body.model(), place_.nearest()), rest_(body) {
  for (std::size_t k = 0; k < place_.corners.size(); ++k) {
    const std::uint32_t corner = place_.corners[k];
    patch_response_ += double{place_.shares[k]} * double{patch_.weights[corner]};
  }
}

SurfaceGrip::Place SurfaceGrip::place_of(const ppu::SoftBody<3>& body, const Vector3f& point) {
  SC_ASSERT(point.allFinite(), "a body is held at ({}, {}, {})", point.x(), point.y(), point.z());
  const ppu::Lattice<3>& lattice = body.model().lattice();
  ppu::CellFinder cells;
  cells.place(lattice, body.positions());
  const auto found = cells.find(point, [](std::uint32_t) { return true; });
  Place place;
  if (!found) {
    place.corners.fill(nearest_particle(body, point));
    place.shares = {1};
    return place;
  }
  place.corners = lattice.corners[found->cell];
  for (std::size_t k = 0; k < place.corners.size(); ++k) {
    place.shares[k] = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float xi = found->xi[static_cast<int>(axis)];
      place.shares[k] *= ((k >> axis) & 1) != 0 ? xi : 1 - xi;
    }
  }
  return place;
}

std::uint32_t SurfaceGrip::Place::nearest() const {
  return corners[static_cast<std::size_t>(std::max_element(shares.begin(), shares.end()) - shares.begin())];
}

Vector3f SurfaceGrip::point() const {
  Vector3f point(0, 0, 0);
  for (std::size_t k = 0; k < place_.corners.size(); ++k)
    point += place_.shares[k] * body_.position(place_.corners[k]);
  return point;
}

void SurfaceGrip::pull(const HandMotion<3>& hand, const Vector3f& gravity, float step) {
  SC_ASSERT(step > 0, "a substep of {} s", step);
  using Strength = HandStrength<3>;
  const double h = double{step};
  rest_.renew(body_);
  const WholeBody whole(body_, rest_);
  const Vector3d point = this->point().cast<double>(), arm = point - whole.centre;
  Vector3d velocity(0, 0, 0), point_at_rest(0, 0, 0);
  for (std::size_t k = 0; k < place_.corners.size(); ++k) {
    const double share = double{place_.shares[k]};
    velocity += share * body_.velocities()[place_.corners[k]].cast<double>();
    point_at_rest += share * rest_.positions[place_.corners[k]].cast<double>();
  }

  // What is left of its swinging about the hand.
  const double most = h * Strength::most_acceleration(gravity), damped = Strength::damped_share(h);
  const Vector3d drag = Strength::limited(damped * (hand.velocity.cast<double>() - whole.velocity), most);
  const Vector3d slow_down = -damped * (whole.inverse_inertia * whole.spin);
  velocity += drag + slow_down.cross(arm);

  const Matrix3d rotation = ppu::update_rotation(whole.correlation, rotation_);
  const double pulled_out =
      (arm - rotation * (point_at_rest - rest_.centre)).norm() / (kMostPullOut * double{patch_.radius});
  double rigid = std::min(1.0, kLeastRigidShare + (1 - kLeastRigidShare) * pulled_out * pulled_out);
  const Vector3d change = Strength::wanted_velocity(hand, point) - velocity - h * gravity.cast<double>();
  const Matrix3d response =
      (1 - rigid) * patch_response_ / patch_.mass * Matrix3d::Identity() + rigid * whole.response_at(arm);
  const Vector3d impulse = Strength::limited(response.inverse() * change, most * whole.mass);

  Vector3d kick_of_patch = (1 - rigid) / patch_.mass * impulse;
  const double most_patch = kMostKick * double{patch_.radius} / h;
  if (const double kick = kick_of_patch.norm(); kick > most_patch) {
    rigid = 1 - (1 - rigid) * most_patch / kick;
    kick_of_patch *= most_patch / kick;
  }
  const Vector3d shift = drag + rigid / whole.mass * impulse;
  const Vector3d turn = slow_down + rigid * (whole.inverse_inertia * arm.cross(impulse));
  for (std::size_t i = 0; i < patch_.weights.size(); ++i) {
    const Vector3d r = body_.position(i).cast<double>() - whole.centre;
    const Vector3d dv = shift + turn.cross(r) + double{patch_.weights[i]} * kick_of_patch;
    body_.add_particle_velocity(i, dv.cast<float>());
  }
}

void SurfaceGrip::let_go(const Vector3f& velocity) {
  const Vector3d aid = HandStrength<3>::throw_aid(velocity.cast<double>(), WholeBody(body_, rest_).velocity);
  body_.add_velocity(aid.cast<float>());
}

}  // namespace softcell::demos
