#include "softcell/soft_bodies/soft_body_2d.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "ppu/matching/matching_plan.h"
#include "ppu/reference/shape_matching_2d.h"

namespace softcell::ppu {

using Eigen::Vector2d;
using Eigen::Vector2f;

SoftBodyModel2d::SoftBodyModel2d(Lattice2d lattice, const SoftBodySettings& settings,
                                 float contact_radius_in_cells)
    : settings_(settings),
      lattice_(std::move(lattice)),
      masses_(particle_masses(lattice_, settings.density)),
      contact_radius_in_cells_(contact_radius_in_cells),
      plan_(std::make_shared<MatchingPlan2d<float>>(lattice_, settings.half_width, masses_)) {
  double mass = 0;
  for (const float m : masses_) mass += m;
  mass_ = static_cast<float>(mass);
  const std::vector<bool> is_outer = outer_particles(lattice_);
  for (std::uint32_t i = 0; i < is_outer.size(); ++i) (is_outer[i] ? outer_ : inner_).push_back(i);
}

std::shared_ptr<const SoftBodyModel2d> make_soft_body_model(Lattice2d lattice,
                                                            const SoftBodySettings& settings,
                                                            float contact_radius_in_cells) {
  validate(settings);
  if (lattice.spacing != settings.cell_size) {
    throw std::runtime_error("a soft body's cell_size is " + std::to_string(settings.cell_size) +
                             "; it must be the spacing of the lattice it is made from, " +
                             std::to_string(lattice.spacing));
  }
  if (!(contact_radius_in_cells > 0 && contact_radius_in_cells <= 1)) {
    throw std::runtime_error("a soft body's contact radius is " + std::to_string(contact_radius_in_cells) +
                             " cells; it must be above 0 and at most 1");
  }
  return std::shared_ptr<const SoftBodyModel2d>(
      new SoftBodyModel2d(std::move(lattice), settings, contact_radius_in_cells));
}

SoftBody2d::SoftBody2d(std::shared_ptr<const SoftBodyModel2d> model, const Vector2f& position)
    : model_(std::move(model)),
      x_(model_->particles()),
      v_(model_->particles()),
      matcher_(std::make_unique<ShapeMatcher2d<float>>(model_->plan())) {
  place_at_rest(position);
}

SoftBody2d::SoftBody2d(const SoftBody2d& other)
    : model_(other.model_),
      x_(other.x_),
      v_(other.v_),
      matcher_(std::make_unique<ShapeMatcher2d<float>>(*other.matcher_)),
      revision_(other.revision_) {}

SoftBody2d& SoftBody2d::operator=(const SoftBody2d& other) {
  model_ = other.model_;
  x_ = other.x_;
  v_ = other.v_;
  *matcher_ = *other.matcher_;
  ++revision_;  // a change by the user: couplings must notice, whatever the other's count is
  return *this;
}

SoftBody2d::~SoftBody2d() = default;

void SoftBody2d::place_at_rest(const Vector2f& position) {
  for (std::size_t i = 0; i < x_.size(); ++i)
    set_particle(i, model_->lattice().rest_position(i) + position, Vector2f::Zero());
}

void SoftBody2d::pull(float step) {
  const SoftBodySettings& settings = model_->settings();
  matcher_->step_velocities(x_, v_, settings.alpha_of_step(step), step, settings.damping_of_step(step));
}

void SoftBody2d::limit_speed(float limit) {
  for (Vector2f& v : v_) {
    const float squared = v.squaredNorm();
    if (squared > limit * limit) v *= limit / std::sqrt(squared);
  }
}

void SoftBody2d::advance_inner(float step, const Vector2f& gravity) {
  for (const std::uint32_t i : model_->inner()) {
    v_[i] += step * gravity;
    x_[i] += step * v_[i];
  }
}

void SoftBody2d::keep_inner_inside() {
  Eigen::AlignedBox2f box;
  for (const std::uint32_t i : model_->outer()) box.extend(x_[i]);
  for (const std::uint32_t i : model_->inner()) {
    const Vector2f inside = x_[i].cwiseMax(box.min()).cwiseMin(box.max());
    for (int axis = 0; axis < 2; ++axis) {
      const float back = inside[axis] - x_[i][axis];
      if (back * v_[i][axis] < 0) v_[i][axis] = 0;
    }
    x_[i] = inside;
  }
}

void SoftBody2d::translate(const Vector2f& by) {
  for (Vector2f& x : x_) x += by;
  ++revision_;
}

void SoftBody2d::reset(const Vector2f& position) {
  place_at_rest(position);
  matcher_->reset();
  ++revision_;
}

void SoftBody2d::add_velocity(const Vector2f& dv) {
  for (Vector2f& v : v_) v += dv;
  ++revision_;
}

void SoftBody2d::add_particle_velocity(std::size_t particle, const Vector2f& dv) {
  v_.at(particle) += dv;
  ++revision_;
}

Vector2f SoftBody2d::centre_of_mass() const {
  Vector2d sum = Vector2d::Zero();
  for (std::size_t i = 0; i < x_.size(); ++i) sum += double{model_->masses()[i]} * x_[i].cast<double>();
  return (sum / double{model_->mass()}).cast<float>();
}

Vector2f SoftBody2d::linear_momentum() const {
  Vector2d sum = Vector2d::Zero();
  for (std::size_t i = 0; i < v_.size(); ++i) sum += double{model_->masses()[i]} * v_[i].cast<double>();
  return sum.cast<float>();
}

float SoftBody2d::angular_momentum() const {
  const Vector2d centre = centre_of_mass().cast<double>();
  double sum = 0;
  for (std::size_t i = 0; i < v_.size(); ++i) {
    const Vector2d r = x_[i].cast<double>() - centre;
    sum += double{model_->masses()[i]} * (r.x() * double{v_[i].y()} - r.y() * double{v_[i].x()});
  }
  return static_cast<float>(sum);
}

float SoftBody2d::deformation() const {
  const Vector2d centre = centre_of_mass().cast<double>();
  const auto rest = model_->plan()->particle_constants();
  double cosine = 0, sine = 0;
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const Vector2d p = double{model_->masses()[i]} * (x_[i].cast<double>() - centre);
    const Vector2d q = rest[i].x0.cast<double>();
    cosine += p.dot(q);
    sine += q.x() * p.y() - q.y() * p.x();
  }
  const double length = std::sqrt(cosine * cosine + sine * sine);
  const double c = length > 0 ? cosine / length : 1, s = length > 0 ? sine / length : 0;
  double longest = 0;
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const Vector2d q = rest[i].x0.cast<double>();
    const Vector2d goal = centre + Vector2d(c * q.x() - s * q.y(), s * q.x() + c * q.y());
    longest = std::max(longest, (x_[i].cast<double>() - goal).norm());
  }
  return static_cast<float>(longest);
}

}  // namespace softcell::ppu
