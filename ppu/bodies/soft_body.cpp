#include "softcell/soft_bodies/soft_body.h"

#include <cmath>
#include <utility>

#include "ppu/matching/rotation.h"
#include "ppu/reference/shape_matching.h"

namespace softcell::ppu {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

/// Sums over the body in double precision: positions far from the origin lose nothing.
struct Motion {
  Vector3d centre{0, 0, 0};    // metres
  Vector3d velocity{0, 0, 0};  // m/s, of the centre
  Vector3d spin{0, 0, 0};      // kg m^2/s, angular momentum about the centre
  Matrix3d inertia;            // kg m^2, about the centre
};

Motion motion_of(const SoftBody& body) {
  const std::span<const float> masses = body.model().masses();
  Motion motion;
  double mass = 0;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const double m = masses[i];
    mass += m;
    motion.centre += m * body.position(i).cast<double>();
    motion.velocity += m * body.velocities()[i].cast<double>();
  }
  motion.centre /= mass;
  motion.velocity /= mass;

  Matrix3d second_moment = Matrix3d::Zero();
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const double m = masses[i];
    const Vector3d r = body.position(i).cast<double>() - motion.centre;
    motion.spin += m * r.cross(body.velocities()[i].cast<double>());
    second_moment += m * r * r.transpose();
  }
  motion.inertia = second_moment.trace() * Matrix3d::Identity() - second_moment;
  return motion;
}

}  // namespace

SoftBody::SoftBody(std::shared_ptr<const SoftBodyModel> model, const Vector3f& position)
    : model_(std::move(model)),
      x_(model_->particles()),
      v_(model_->particles(), Vector3f::Zero()),
      padded_(model_->particles()),
      matcher_(std::make_unique<ShapeMatcher<float>>(model_->plan())) {
  place_at_rest(position);
}

SoftBody::SoftBody(const SoftBody& other)
    : model_(other.model_),
      x_(other.x_),
      v_(other.v_),
      padded_(other.padded_),
      matcher_(std::make_unique<ShapeMatcher<float>>(*other.matcher_)),
      revision_(other.revision_),
      resets_(other.resets_),
      asleep_(other.asleep_) {}

SoftBody& SoftBody::operator=(const SoftBody& other) {
  model_ = other.model_;
  x_ = other.x_;
  v_ = other.v_;
  padded_ = other.padded_;
  *matcher_ = *other.matcher_;
  asleep_ = other.asleep_;
  // A change by the user: couplings must notice, whatever the other's counts are.
  ++revision_;
  ++resets_;
  return *this;
}

SoftBody::~SoftBody() = default;

void SoftBody::place_at_rest(const Vector3f& position) {
  for (std::size_t i = 0; i < x_.size(); ++i)
    set_particle(i, model_->lattice().rest_position(i) + position, Vector3f::Zero());
}

void SoftBody::forget_rotations() {
  matcher_->reset();
  ++resets_;
}

void SoftBody::set_position(std::size_t particle, const Vector3f& position) {
  set_particle(particle, position, v_[particle]);
}

void SoftBody::pull(float step) {
  const SoftBodySettings& settings = model_->settings();
  matcher_->step_velocities(x_, v_, settings.alpha_of_step(step), step, settings.damping_of_step(step));
}

void SoftBody::limit_speed(float limit) {
  for (Vector3f& v : v_) {
    const float squared = v.squaredNorm();
    if (squared > limit * limit) v *= limit / std::sqrt(squared);
  }
}

void SoftBody::advance_inner(float step, const Vector3f& gravity) {
  for (const std::uint32_t i : model_->inner()) {
    const Vector3f v = v_[i] + step * gravity;
    set_particle(i, x_[i] + step * v, v);
  }
}

void SoftBody::translate(const Vector3f& by) {
  for (std::size_t i = 0; i < x_.size(); ++i) set_position(i, x_[i] + by);
  ++revision_;
}

void SoftBody::reset(const Vector3f& position) {
  place_at_rest(position);
  forget_rotations();
  ++revision_;
}

void SoftBody::move_without_force(const Eigen::Quaternionf& rotation, const Vector3f& translation) {
  const Matrix3d turn = rotation.normalized().toRotationMatrix().cast<double>();
  const Vector3d centre = motion_of(*this).centre;
  const Vector3d moved_centre = centre + translation.cast<double>();
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const Vector3d x = moved_centre + turn * (x_[i].cast<double>() - centre);
    const Vector3d v = turn * v_[i].cast<double>();
    set_particle(i, x.cast<float>(), v.cast<float>());
  }
  forget_rotations();
  ++revision_;
}

void SoftBody::reset_deformation() {
  const Motion motion = motion_of(*this);
  const auto rest = model_->plan()->particle_constants();
  Matrix3d correlation = Matrix3d::Zero();
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const double m = model_->masses()[i];
    correlation += m * (x_[i].cast<double>() - motion.centre) * rest[i].x0.cast<double>().transpose();
  }
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  const Matrix3d turn = find_rotation(correlation, orientation);

  for (std::size_t i = 0; i < x_.size(); ++i) {
    const Vector3d x = motion.centre + turn * rest[i].x0.cast<double>();
    set_particle(i, x.cast<float>(), motion.velocity.cast<float>());
  }
  // The undeformed body has another inertia: the turn that gives it the same angular momentum. A lattice is
  // at least a cell in each direction, so its inertia can be inverted.
  const Vector3d omega = motion_of(*this).inertia.inverse() * motion.spin;
  forget_rotations();
  add_angular_velocity(omega.cast<float>());
}

void SoftBody::add_velocity(const Vector3f& dv) {
  for (Vector3f& v : v_) v += dv;
  ++revision_;
}

void SoftBody::add_particle_velocity(std::size_t particle, const Vector3f& dv) {
  v_[particle] += dv;
  ++revision_;
}

void SoftBody::add_angular_velocity(const Vector3f& dw) {
  const Vector3f centre = centre_of_mass();
  for (std::size_t i = 0; i < x_.size(); ++i) v_[i] += dw.cross(x_[i] - centre);
  ++revision_;
}

Vector3f SoftBody::centre_of_mass() const { return motion_of(*this).centre.cast<float>(); }

Vector3f SoftBody::linear_momentum() const {
  Vector3d momentum = Vector3d::Zero();
  for (std::size_t i = 0; i < v_.size(); ++i) momentum += double{model_->masses()[i]} * v_[i].cast<double>();
  return momentum.cast<float>();
}

Vector3f SoftBody::angular_momentum() const { return motion_of(*this).spin.cast<float>(); }

Bounds SoftBody::bounds() const {
  Bounds box{x_[0], x_[0]};
  for (const Vector3f& x : x_) {
    box.low = box.low.cwiseMin(x);
    box.high = box.high.cwiseMax(x);
  }
  return box;
}

}  // namespace softcell::ppu
