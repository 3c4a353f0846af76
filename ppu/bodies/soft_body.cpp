#include "softcell/soft_bodies/soft_body.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "ppu/bodies/lost_momenta.h"
#include "ppu/bodies/motion.h"
#include "ppu/bodies/rest_shape.h"
#include "ppu/bodies/stillness.h"
#include "ppu/matching/stiffness.h"
#include "ppu/numbers/box_around.h"
#include "ppu/numbers/turning.h"
#include "ppu/reference/shape_matching.h"
#include "softcell/base/assert.h"
#include "softcell/base/text.h"

namespace softcell::ppu {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using turning::cross, turning::inverse, turning::to_float;

Matrix2d matrix_of(const Eigen::Rotation2Df& rotation) { return rotation.cast<double>().toRotationMatrix(); }
Matrix3d matrix_of(const Eigen::Quaternionf& rotation) {
  SC_ASSERT(rotation.norm() > 0, "a quaternion of length {} is no rotation", rotation.norm());
  return rotation.normalized().toRotationMatrix().cast<double>();
}

/// Checks values that the user sets for all particles. @param one,many  the name of such a value, for messages
/// @throws std::runtime_error  there are more or fewer values than particles, or one is not finite
template <class Vector>
void check_values(std::span<const Vector> values, std::size_t particles, const std::string& one,
                  const std::string& many) {
  const std::string body = "a soft body of " + base::counted(particles, "particle") + " was given ";
  if (values.size() != particles) throw std::runtime_error(body + base::counted(values.size(), one, many));
  for (std::size_t i = 0; i < particles; ++i)
    if (!values[i].allFinite())
      throw std::runtime_error(body + "a " + one + " that is not finite, for particle " + std::to_string(i));
}

}  // namespace

template <int kDimension>
SoftBody<kDimension>::SoftBody(std::shared_ptr<const SoftBodyModel<kDimension>> model, const Vector& position)
    : model_((SC_ASSERT(model != nullptr, "a soft body without a model"), std::move(model))),
      settings_(model_->settings()),
      x_(model_->particles()),
      v_(model_->particles(), Vector::Zero()),
      pulled_(v_),
      padded_(kDimension == 3 ? model_->particles() : 0),
      matcher_(std::make_unique<ShapeMatcher<float, kDimension>>(model_->plan())),
      lost_(std::make_unique<LostMomenta<kDimension>>()) {
  place_at_rest(position);
}

template <int kDimension>
SoftBody<kDimension>::SoftBody(const SoftBody& other)
    : model_(other.model_),
      settings_(other.settings_),
      x_(other.x_),
      v_(other.v_),
      pulled_(other.pulled_),
      padded_(other.padded_),
      matcher_(std::make_unique<ShapeMatcher<float, kDimension>>(*other.matcher_)),
      lost_(std::make_unique<LostMomenta<kDimension>>(*other.lost_)),
      revision_(other.revision_),
      resets_(other.resets_),
      rest_revision_(other.rest_revision_),
      asleep_(other.asleep_) {
  if (other.rest_) set_rest(std::make_unique<RestShape<kDimension>>(*other.rest_));
  steps_since_look_ = other.steps_since_look_;
}

template <int kDimension>
SoftBody<kDimension>& SoftBody<kDimension>::operator=(const SoftBody& other) {
  model_ = other.model_;
  settings_ = other.settings_;
  x_ = other.x_;
  v_ = other.v_;
  pulled_.resize(v_.size());
  padded_ = other.padded_;
  *matcher_ = *other.matcher_;
  *lost_ = *other.lost_;
  set_rest(other.rest_ ? std::make_unique<RestShape<kDimension>>(*other.rest_) : nullptr);
  steps_since_look_ = other.steps_since_look_;
  asleep_ = other.asleep_;
  // A change by the user: couplings must notice it, whatever the other body's counts are.
  ++revision_;
  ++resets_;
  return *this;
}

template <int kDimension>
SoftBody<kDimension>::SoftBody(SoftBody&& other) noexcept = default;

template <int kDimension>
SoftBody<kDimension>& SoftBody<kDimension>::operator=(SoftBody&& other) noexcept {
  const bool has_other_rest = has_own_rest() || other.has_own_rest();
  std::swap(model_, other.model_);
  std::swap(settings_, other.settings_);
  std::swap(x_, other.x_);
  std::swap(v_, other.v_);
  std::swap(pulled_, other.pulled_);
  std::swap(padded_, other.padded_);
  std::swap(matcher_, other.matcher_);
  std::swap(lost_, other.lost_);
  std::swap(rest_, other.rest_);
  std::swap(steps_since_look_, other.steps_since_look_);
  std::swap(asleep_, other.asleep_);
  // As above; the other body has another state now, too.
  for (SoftBody* const body : {this, &other}) {
    if (has_other_rest) ++body->rest_revision_;
    ++body->revision_;
    ++body->resets_;
  }
  return *this;
}

template <int kDimension>
SoftBody<kDimension>::~SoftBody() = default;

template <int kDimension>
void SoftBody<kDimension>::set_particle(std::size_t particle, const Vector& position,
                                        const Vector& velocity) {
  SC_ASSERT(particle < x_.size(), "particle {} of {}", particle, x_.size());
  x_[particle] = position;
  v_[particle] = velocity;
  if constexpr (kDimension == 3) padded_[particle] = {position.x(), position.y(), position.z(), 0};
}

template <int kDimension>
void SoftBody<kDimension>::set_velocity(std::size_t particle, const Vector& velocity) {
  SC_ASSERT(particle < v_.size(), "particle {} of {}", particle, v_.size());
  v_[particle] = velocity;
}

template <int kDimension>
void SoftBody<kDimension>::place_at_rest(const Vector& position) {
  for (std::size_t i = 0; i < x_.size(); ++i)
    set_particle(i, model_->lattice().rest_position(i) + position, Vector::Zero());
  lost_->forget();
}

template <int kDimension>
void SoftBody<kDimension>::set_asleep(bool asleep) {
  asleep_ = asleep;
  if (asleep) lost_->forget();  // couplings stop bodies that fall asleep
}

template <int kDimension>
void SoftBody<kDimension>::forget_rotations() {
  matcher_->reset();
  ++resets_;
}

template <int kDimension>
void SoftBody<kDimension>::set_rest(std::unique_ptr<RestShape<kDimension>> rest) {
  const bool had_own = has_own_rest();
  steps_since_look_ = 0;
  rest_ = std::move(rest);
  if (had_own || has_own_rest()) matcher_->set_plan(plan()), ++rest_revision_;
}

template <int kDimension>
bool SoftBody<kDimension>::has_own_rest() const {
  return rest_ != nullptr && rest_->is_own();
}

template <int kDimension>
auto SoftBody<kDimension>::plan() const -> std::shared_ptr<const MatchingPlan<float, kDimension>> {
  return has_own_rest() ? rest_->plan() : model_->plan();
}

template <int kDimension>
auto SoftBody<kDimension>::rest_positions() const -> std::vector<Vector> {
  const auto now = plan();
  std::vector<Vector> rest;
  for (const auto& particle : now->particle_constants()) rest.push_back(now->rest_centre() + particle.x0);
  return rest;
}

template <int kDimension>
auto SoftBody<kDimension>::own_rest() const -> std::span<const Vector> {
  return has_own_rest() ? rest_->positions() : std::span<const Vector>();
}

template <int kDimension>
void SoftBody<kDimension>::set_rest_positions(std::span<const Vector> rest) {
  check_values(rest, x_.size(), "position at rest", "positions at rest");
  auto own = std::make_unique<RestShape<kDimension>>(*model_, rest);
  if (const std::size_t bad = own->cells_that_contacts_hold())
    throw std::runtime_error("in a soft body's rest shape " + base::counted(bad, "cell") + " of " +
                             std::to_string(model_->lattice().cells.size()) + (bad == 1 ? " is" : " are") +
                             " flat, inside out, or smaller than half of the cell in the model; contacts "
                             "would push back such cells in each step");
  adopt_rest(std::move(own));
}

template <int kDimension>
void SoftBody<kDimension>::adopt_rest(std::unique_ptr<RestShape<kDimension>> rest) {
  rest->adopt(*model_->plan());
  set_rest(std::move(rest));
  ++revision_;
}

template <int kDimension>
bool SoftBody<kDimension>::will_look() const {
  return settings_.plasticity && steps_since_look_ + 1 >= kPlasticSteps && !(rest_ && rest_->is_flowing());
}

template <int kDimension>
void SoftBody<kDimension>::flow(float step, std::optional<float> stretch) {
  SC_ASSERT(step > 0 && std::isfinite(step), "a time step of {} s", step);
  if (!settings_.plasticity) return;
  ++steps_since_look_;
  if (rest_ && steps_since_look_ >= kFlowSteps) read_flow();
  if (steps_since_look_ < kPlasticSteps) return;
  steps_since_look_ = 0;
  if (!rest_) rest_ = std::make_unique<RestShape<kDimension>>(*model_);
  const Plasticity& plasticity = *settings_.plasticity;
  // The body has moved on when the flow is done: a larger share would make it oscillate in some cases.
  constexpr double kMost = 0.7;
  const double share = std::min(kMost, damping_from_time_constant(1 / static_cast<double>(plasticity.creep),
                                                                  kPlasticSteps * static_cast<double>(step)));
  rest_->look(x_, stretch, plasticity, share, plan());
}

/// Updates the constants of shape matching to the rest shape.
template <int kDimension>
void SoftBody<kDimension>::read_flow() {
  using Taken = typename RestShape<kDimension>::Taken;
  const Taken taken = rest_->take(x_);
  // Looks that keep time with a swing would come to the same refusal again and again.
  if (taken == Taken::kRefused) ++steps_since_look_;
  if (taken != Taken::kNewShape) return;
  matcher_->set_plan(plan());
  ++rest_revision_;
}

template <int kDimension>
void SoftBody<kDimension>::inherit_state(const SoftBody& whole, std::span<const std::uint32_t> particle_of,
                                         const Eigen::Vector<double, kDimension>& centre) {
  SC_ASSERT(x_.size() == particle_of.size(), "{} particles of a piece of {}", particle_of.size(), x_.size());
  set_material(whole.settings_);
  for (std::size_t i = 0; i < particle_of.size(); ++i) {
    SC_ASSERT(particle_of[i] < whole.x_.size(), "particle {} of a piece is particle {} of {}", i,
              particle_of[i], whole.x_.size());
    set_particle(i, whole.x_[particle_of[i]], whole.v_[particle_of[i]]);
  }
  SC_ASSERT(model_->is_piece(), "a body of {} particles that is no piece inherits a state", x_.size());
  matcher_->take_rotations(*whole.matcher_, particle_of);
  const double share = double{model_->mass()} / double{whole.model_->mass()};
  lost_->inherit(*whole.lost_, std::min(share, 1.0), precise_centre_of_mass() - centre);
  if (!whole.has_own_rest()) return;
  std::vector<Vector> rest;
  for (const std::uint32_t particle : particle_of) rest.push_back(whole.own_rest()[particle]);
  adopt_rest(std::make_unique<RestShape<kDimension>>(*model_, rest));
}

template <int kDimension>
void SoftBody<kDimension>::set_position(std::size_t particle, const Vector& position) {
  SC_ASSERT(particle < x_.size(), "particle {} of {}", particle, x_.size());
  set_particle(particle, position, v_[particle]);
}

template <int kDimension>
void SoftBody<kDimension>::pull(float step) {
  if (!(step > 0) || !std::isfinite(step))
    throw std::invalid_argument("soft body: a time step of " + base::shortest(step) +
                                " s; expected is a positive number");
  std::ranges::copy(v_, pulled_.begin());
  matcher_->step_velocities(x_, pulled_, settings_.alpha_of_step(step), step,
                            settings_.damping_of_step(step));
  end_pull();
}

template <int kDimension>
void SoftBody<kDimension>::end_pull() {
  lost_->count(x_, model_->masses(), v_, pulled_);
  v_.swap(pulled_);
}

template <int kDimension>
void SoftBody<kDimension>::limit_speed(float limit) {
  SC_ASSERT(limit >= 0, "a speed limit of {} m/s", limit);
  for (Vector& v : v_) {
    const float squared = v.squaredNorm();
    if (squared > limit * limit) v *= limit / std::sqrt(squared);
  }
}

template <int kDimension>
void SoftBody<kDimension>::advance_inner(float step, const Vector& gravity) {
  SC_ASSERT(step > 0 && std::isfinite(step), "a time step of {} s", step);
  for (const std::uint32_t i : model_->inner()) {
    const Vector v = v_[i] + step * gravity;
    set_particle(i, x_[i] + step * v, v);
  }
}

template <int kDimension>
void SoftBody<kDimension>::keep_inner_inside() {
  if (model_->outer().empty()) return;
  Eigen::AlignedBox<float, kDimension> box;
  for (const std::uint32_t i : model_->outer()) box.extend(x_[i]);
  for (const std::uint32_t i : model_->inner()) {
    const Vector inside = x_[i].cwiseMax(box.min()).cwiseMin(box.max());
    Vector v = v_[i];
    for (int axis = 0; axis < kDimension; ++axis) {
      const float back = inside[axis] - x_[i][axis];
      if (back * v[axis] < 0) v[axis] = 0;
    }
    set_particle(i, inside, v);
  }
}

template <int kDimension>
void SoftBody<kDimension>::set_material(const SoftBodySettings& settings) {
  const SoftBodySettings& of_model = model_->settings();
  SC_ASSERT(settings.cell_size == of_model.cell_size && settings.half_width == of_model.half_width &&
                settings.density == of_model.density && settings.contacts == of_model.contacts,
            "a material of cells of {} m, half-width {} and {} kg/m^3 for a body of {} m, {} and {} kg/m^3",
            settings.cell_size, settings.half_width, settings.density, of_model.cell_size,
            of_model.half_width, of_model.density);
  validate(settings);
  if (settings.plasticity) model_->rest_lattice();
  settings_ = settings;
  ++revision_;
}

template <int kDimension>
void SoftBody<kDimension>::translate(const Vector& by) {
  SC_ASSERT(by.allFinite(), "a body of {} particles is moved to infinity or NaN", x_.size());
  for (std::size_t i = 0; i < x_.size(); ++i) set_position(i, x_[i] + by);
  lost_->forget();  // it referred to the old place
  ++revision_;
}

template <int kDimension>
void SoftBody<kDimension>::set_state(std::span<const Vector> positions, std::span<const Vector> velocities) {
  check_values(positions, x_.size(), "position", "positions");
  check_values(velocities, x_.size(), "velocity", "velocities");
  for (std::size_t i = 0; i < x_.size(); ++i) set_particle(i, positions[i], velocities[i]);
  forget_rotations();
  lost_->forget();
  ++revision_;
}

template <int kDimension>
void SoftBody<kDimension>::reset(const Vector& position) {
  SC_ASSERT(position.allFinite(), "a body of {} particles is moved to infinity or NaN", x_.size());
  set_rest(nullptr);
  place_at_rest(position);
  forget_rotations();
  ++revision_;
}

template <int kDimension>
void SoftBody<kDimension>::move_without_force(const Rotation& rotation, const Vector& translation) {
  SC_ASSERT(translation.allFinite(), "a body of {} particles is moved to infinity or NaN", x_.size());
  const typename Motion<kDimension>::Matrix turn = matrix_of(rotation);
  const typename Motion<kDimension>::Vector centre = motion_of(*this).centre;
  const typename Motion<kDimension>::Vector moved_centre = centre + translation.template cast<double>();
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const typename Motion<kDimension>::Vector x =
        moved_centre + turn * (x_[i].template cast<double>() - centre);
    const typename Motion<kDimension>::Vector v = turn * v_[i].template cast<double>();
    set_particle(i, x.template cast<float>(), v.template cast<float>());
  }
  forget_rotations();
  lost_->forget();
  ++revision_;
}

template <int kDimension>
void SoftBody<kDimension>::reset_deformation() {
  const Motion<kDimension> motion = motion_of(*this);
  const typename Motion<kDimension>::Matrix turn = orientation_of(*this, motion.centre);
  set_rest(nullptr);
  const auto rest = model_->plan()->particle_constants();
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const typename Motion<kDimension>::Vector x = motion.centre + turn * rest[i].x0.template cast<double>();
    set_particle(i, x.template cast<float>(), motion.velocity.template cast<float>());
  }
  // The undeformed body has another inertia: computes the spin that gives it the same angular momentum. A lattice has at least one cell in
  // each direction, so its inertia can be inverted.
  const decltype(motion.spin) omega = inverse(motion_of(*this).inertia) * motion.spin;
  forget_rotations();
  lost_->forget();
  turn_velocities(to_float(omega));
}

template <int kDimension>
void SoftBody<kDimension>::add_velocity(const Vector& dv) {
  SC_ASSERT(dv.allFinite(), "infinity or NaN is added to the velocities of {} particles", v_.size());
  for (Vector& v : v_) v += dv;
  ++revision_;
}

template <int kDimension>
void SoftBody<kDimension>::add_particle_velocity(std::size_t particle, const Vector& dv) {
  SC_ASSERT(particle < v_.size(), "particle {} of {}", particle, v_.size());
  SC_ASSERT(dv.allFinite(), "infinity or NaN is added to the velocity of particle {} of {}", particle,
            v_.size());
  v_[particle] += dv;
  ++revision_;
}

template <int kDimension>
void SoftBody<kDimension>::add_angular_velocity(const AxialVector& dw) {
  SC_ASSERT(cross(dw, Vector(Vector::Zero())).allFinite(),  // infinity times 0 is NaN
            "infinity or NaN is added to the velocities of {} particles", v_.size());
  turn_velocities(dw);
}

template <int kDimension>
void SoftBody<kDimension>::turn_velocities(const AxialVector& dw) {
  const Vector centre = centre_of_mass();
  for (std::size_t i = 0; i < x_.size(); ++i) v_[i] += cross(dw, Vector(x_[i] - centre));
  ++revision_;
}

template <int kDimension>
auto SoftBody<kDimension>::centre_of_mass() const -> Vector {
  return precise_centre_of_mass().template cast<float>();
}

template <int kDimension>
auto SoftBody<kDimension>::precise_centre_of_mass() const -> Eigen::Vector<double, kDimension> {
  return motion_of(*this).centre;
}

template <int kDimension>
float SoftBody<kDimension>::mean_speed() const {
  MeanSpeed speed;
  for (std::size_t i = 0; i < v_.size(); ++i) speed.add(model_->masses()[i], v_[i]);
  return speed.value();
}

template <int kDimension>
auto SoftBody<kDimension>::linear_momentum() const -> Vector {
  typename Motion<kDimension>::Vector momentum = Motion<kDimension>::Vector::Zero();
  for (std::size_t i = 0; i < v_.size(); ++i)
    momentum += double{model_->masses()[i]} * v_[i].template cast<double>();
  return momentum.template cast<float>();
}

template <int kDimension>
auto SoftBody<kDimension>::angular_momentum() const -> AxialVector {
  return to_float(motion_of(*this).spin);
}

template <int kDimension>
Bounds<kDimension> SoftBody<kDimension>::bounds() const {
  SC_ASSERT(!x_.empty(), "a body without particles has no box");
  return box_around<Bounds<kDimension>>(x_);
}

template <int kDimension>
float SoftBody<kDimension>::deformation() const {
  const typename Motion<kDimension>::Vector centre = motion_of(*this).centre;
  const typename Motion<kDimension>::Matrix turn = orientation_of(*this, centre);
  const auto now = plan();
  const auto rest = now->particle_constants();
  double longest = 0;
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const typename Motion<kDimension>::Vector rigid = centre + turn * rest[i].x0.template cast<double>();
    longest = std::max(longest, (x_[i].template cast<double>() - rigid).norm());
  }
  return static_cast<float>(longest);
}

template class SoftBody<2>;
template class SoftBody<3>;

}  // namespace softcell::ppu
