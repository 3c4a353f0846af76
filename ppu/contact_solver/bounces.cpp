#include "ppu/contact_solver/bounces.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

// Iterations over the contacts of one substep that bounce: few bodies bounce at a time.
constexpr int kBounceIterations = 40;
// Two bodies rest on each other and do not hit if gravity makes them as fast within this many substeps.
constexpr double kRestingSteps = 2;
// In cells: when a body first touches something, contacts up to this gap count as touching, too.
constexpr float kTouches = 0.02f;

void insert(std::vector<std::uint32_t>& ascending, std::uint32_t number) {
  const auto at = std::lower_bound(ascending.begin(), ascending.end(), number);
  if (at == ascending.end() || *at != number) ascending.insert(at, number);
}

std::size_t index_in(std::span<const std::uint32_t> ascending, std::uint32_t number) {
  const auto at = std::lower_bound(ascending.begin(), ascending.end(), number);
  SC_ASSERT(at != ascending.end() && *at == number, "body {} is none of {} that bounce", number,
            ascending.size());
  return static_cast<std::size_t>(at - ascending.begin());
}

/// Whether attachments hold particles that are not all on one line: a rigid body held so cannot move.
bool is_held_fast(const ContactBody& body) {
  if (body.inverse_masses_if_held.empty()) return false;
  constexpr float kOffLine = 0.1f;  // cells
  std::optional<Vector3f> first, other;
  for (std::uint32_t p = 0; p < body.positions.size(); ++p) {
    if (!body.holds(p)) continue;
    const Vector3f& at = body.positions[p];
    if (!first) {
      first = at;
    } else if (!other) {
      if (at != *first) other = at;
    } else {
      const Vector3f line = (*other - *first).normalized();
      if (line.cross(at - *first).norm() > kOffLine * body.spacing()) return true;
    }
  }
  return false;
}

/// The share of the substep until a velocity changes: until the contact's surfaces touch. A sharp contact acts at once: it only limits how
/// far the body goes on.
float share_until_touch(const BounceContact& contact, float step) {
  return contact.is_sharp() ? 0.0f : std::min(contact.gap / (step * contact.approach), 1.0f);
}

}  // namespace

Bounces::Whole::Change Bounces::Whole::change_by(const Vector3d& point, const Vector3d& impulse) const {
  const Vector3d moment = (point - centre).cross(impulse);
  if (held == nullptr) return {inverse_mass * impulse, inverse_inertia * moment};
  const Matrix3d coupling = held->coupling.cast<double>();
  return {held->linear.cast<double>() * impulse + coupling * moment,
          coupling.transpose() * impulse + held->angular.cast<double>() * moment};
}

double Bounces::Whole::mobility(const Vector3d& point, const Vector3d& direction) const {
  if (inverse_mass == 0) return 0;
  if (held == nullptr) {
    const Vector3d turn = (point - centre).cross(direction);
    return inverse_mass + turn.dot(inverse_inertia * turn);
  }
  const Change change = change_by(point, direction);
  return direction.dot(change.velocity) + (point - centre).cross(direction).dot(change.spin);
}

void Bounces::Whole::push(const Vector3d& point, const Vector3d& impulse) {
  if (inverse_mass == 0) return;
  const Change change = change_by(point, impulse);
  velocity += change.velocity;
  spin += change.spin;
}

double Bounces::Part::share_of(const Eigen::Vector3i& particle) const {
  if (thickness == kEverything) return 1;
  // A cell's high corners are one step beyond its low corner.
  const Vector3f at = particle.cast<float>();
  const Vector3f off = (cells.low - at).cwiseMax(at - cells.high - Vector3f::Ones()).cwiseMax(0.0f);
  return std::clamp(2 - double{off.norm()} / double{thickness}, 0.0, 1.0);
}

/// @param time    seconds after the substep's beginning
/// @param gained  m/s, by gravity in the substep
Bounces::Whole Bounces::whole_of(const ContactBody& body, const Part& part, double time,
                                 const Vector3d& gained) {
  const auto& particles = body.lattice().particles;
  // A body that is held fast is a wall that moves as what holds it does, however its other particles swing. Its velocity includes the
  // gravity of the substep, as all others do.
  const bool is_wall = is_held_fast(body);
  const auto mass_of = [&](std::size_t p) {
    const double share =
        is_wall ? (body.holds(static_cast<std::uint32_t>(p)) ? 1.0 : 0.0) : part.share_of(particles[p]);
    return share * double{body.model->masses()[p]};
  };
  const auto velocity_of = [&](std::size_t p) -> Vector3d {
    return is_wall ? Vector3d(body.held_velocities[p].cast<double>() + gained)
                   : Vector3d(body.velocities[p].cast<double>());
  };
  const auto place = [&](std::size_t p) -> Vector3d {
    return body.positions[p].cast<double>() + time * velocity_of(p);
  };
  Whole whole;
  double mass = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double own = mass_of(p);
    mass += own;
    whole.centre += own * place(p);
    whole.velocity += own * velocity_of(p);
  }
  whole.centre /= mass;
  whole.velocity /= mass;
  Matrix3d inertia = Matrix3d::Zero();
  Vector3d spin = Vector3d::Zero();
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double own = mass_of(p);
    const Vector3d r = place(p) - whole.centre;
    spin += own * r.cross(velocity_of(p));
    inertia += own * (r.squaredNorm() * Matrix3d::Identity() - r * r.transpose());
  }
  // A body that is pressed to a line cannot turn about the line.
  inertia.diagonal().array() += 1e-9 * inertia.trace();
  const Matrix3d inverse = inertia.inverse();
  whole.spin = inverse * spin;
  if (!body.asleep && !is_wall) {
    whole.inverse_mass = 1 / mass;
    whole.inverse_inertia = inverse;
  }
  whole.velocity_before = whole.velocity;
  whole.spin_before = whole.spin;
  return whole;
}

Bounces::Whole Bounces::whole_of(const ContactRigid& rigid) {
  Whole whole;
  whole.centre = rigid.centre.cast<double>();
  whole.velocity = whole.velocity_before = rigid.velocity.cast<double>();
  whole.spin = whole.spin_before = rigid.spin.cast<double>();
  whole.inverse_mass = double{rigid.inverse_mass};
  whole.inverse_inertia = rigid.inverse_inertia.cast<double>();
  if (rigid.held) whole.held = &*rigid.held;
  return whole;
}

void Bounces::add(const BounceContact& contact) {
  SC_ASSERT((contact.restitution > 0 || contact.is_sharp()) && contact.restitution <= 1 && contact.gap >= 0,
            "a bounce with restitution {} over {} m", contact.restitution, contact.gap);
  contacts_.push_back(contact);
}

std::optional<double> Bounces::target_of(const BounceContact& contact, Bounce& bounce, double share,
                                         const BounceSettings& settings, double step) {
  bounce.hits = bounce.a->velocity_at(bounce.point) - bounce.b->velocity_at(bounce.point_b);
  const double along = bounce.normal.dot(bounce.hits);
  if (contact.is_sharp()) {
    const double least = -(double{contact.gap} + double{contact.room}) / step;
    return along < least ? std::optional(least) : std::nullopt;
  }
  // Velocities include the gravity of the whole substep, but gravity acts before and after the bounce: the velocity of a substep is exact
  // in its middle.
  const auto falls = [](const Whole& whole) { return whole.inverse_mass > 0 ? 1.0 : 0.0; };
  const Vector3d falls_by = (falls(*bounce.a) - falls(*bounce.b)) * step * settings.gravity.cast<double>();
  const double fall = bounce.normal.dot(falls_by);
  const double hits = along + fall * (share - 0.5);
  bounce.hits += (share - 0.5) * falls_by;
  if (!(-hits > std::max(double{settings.least_speed}, kRestingSteps * std::abs(fall)))) return {};
  return -double{contact.restitution} * hits + fall * (0.5 - share);
}

/// For changed_: all of a body that bounces; of other bodies the parts near sharp edges.
void Bounces::choose_parts(std::span<const ContactBody> bodies) {
  constexpr float kLeastThickness = 2;  // cells
  parts_.assign(changed_.size(), Part());
  for (const std::uint32_t i : chosen_) {
    const BounceContact& contact = contacts_[i];
    if (!contact.is_sharp()) continue;
    const ContactBody& body = bodies[contact.a];
    const Vector3f cell = body.lattice().cells[contact.cell].cast<float>();
    Part& part = parts_[index_in(changed_, contact.a)];
    if (part.thickness == Part::kEverything) part.cells = {cell, cell};
    part.cells = {part.cells.low.cwiseMin(cell), part.cells.high.cwiseMax(cell)};
    part.thickness = std::max(body.model->thickness() / body.spacing(), kLeastThickness);
  }
}

/// Sharp edges do not stop a body that bounces.
void Bounces::choose_contacts() {
  chosen_.clear(), changed_.clear(), rigids_.clear();
  const auto choose = [&](std::uint32_t i) {
    const BounceContact& contact = contacts_[i];
    chosen_.push_back(i);
    insert(changed_, contact.a);
    if (contact.b != BounceContact::kNobody)
      insert(changed_, contact.b);
    else
      insert(rigids_, contact.rigid);
  };
  for (std::uint32_t i = 0; i < contacts_.size(); ++i)
    if (!contacts_[i].is_sharp()) choose(i);
  bouncing_ = changed_;
  for (std::uint32_t i = 0; i < contacts_.size(); ++i)
    if (contacts_[i].is_sharp() && !std::ranges::binary_search(bouncing_, contacts_[i].a)) choose(i);
}

/// Chooses the contacts that may bounce, their bodies, and the moments when these first touch.
void Bounces::choose(std::span<const ContactBody> bodies, std::span<const ContactRigid> rigids,
                     const BounceSettings& settings, float step) {
  choose_contacts();
  share_.assign(changed_.size(), 1.0f);
  for (const std::uint32_t i : chosen_) {
    const BounceContact& contact = contacts_[i];
    const float share = share_until_touch(contact, step);
    float& of_a = share_[index_in(changed_, contact.a)];
    of_a = std::min(of_a, share);
    if (contact.b == BounceContact::kNobody) continue;
    float& of_b = share_[index_in(changed_, contact.b)];
    of_b = std::min(of_b, share);
  }
  choose_parts(bodies);
  wholes_.clear();
  for (std::size_t i = 0; i < changed_.size(); ++i)
    wholes_.push_back(whole_of(bodies[changed_[i]], parts_[i], double{share_[i]} * double{step},
                               double{step} * settings.gravity.cast<double>()));
  for (const std::uint32_t rigid : rigids_) wholes_.push_back(whole_of(rigids[rigid]));

  bounces_.clear();
  for (const std::uint32_t i : chosen_) {
    const BounceContact& contact = contacts_[i];
    const bool with_rigid = contact.b == BounceContact::kNobody;
    Bounce bounce;
    bounce.contact = i;
    bounce.a = &wholes_[index_in(changed_, contact.a)];
    bounce.b = &wholes_[with_rigid ? changed_.size() + index_in(rigids_, contact.rigid)
                                   : index_in(changed_, contact.b)];
    bounce.normal = contact.normal.cast<double>();
    const auto waits = [&](std::uint32_t body) {
      const float until_first = step * share_[index_in(changed_, body)];
      return !contact.is_sharp() &&
             contact.gap - until_first * contact.approach > kTouches * bodies[body].spacing();
    };
    if (waits(contact.a) || (!with_rigid && waits(contact.b))) continue;
    const double share = double{share_until_touch(contact, step)};
    const double touches_at = double{share_[index_in(changed_, contact.a)]} * double{step};
    const double left = double{step} - touches_at;
    const Vector3d end = contact.point.cast<double>() - left * bounce.a->velocity;
    bounce.point = bounce.point_b = end - left * bounce.a->spin.cross(end - bounce.a->centre);
    if (with_rigid) bounce.point_b -= touches_at * bounce.b->velocity;
    const auto target = target_of(contact, bounce, share, settings, double{step});
    if (!target) continue;
    bounce.target = *target;
    const double mobility =
        bounce.a->mobility(bounce.point, bounce.normal) + bounce.b->mobility(bounce.point_b, bounce.normal);
    if (!(mobility > 0)) continue;
    bounce.mobility = mobility;
    bounces_.push_back(bounce);
  }
}

void Bounces::find_those_together() {
  together_.reset(wholes_.size());
  for (const Bounce& bounce : bounces_)
    if (bounce.a->inverse_mass > 0 && bounce.b->inverse_mass > 0)
      together_.unite(static_cast<std::uint32_t>(bounce.a - wholes_.data()),
                      static_cast<std::uint32_t>(bounce.b - wholes_.data()));
}

/// A restitution is that of velocities along normals. Friction acts at the same time and turns bodies, which can make them faster than they
/// were: boxes that turned and bounced on a rough floor gained up to a third of their energy. Bodies that would gain keep so much of all
/// their impulses that they gain nothing.
void Bounces::take_back_gained_energy() {
  find_those_together();
  gains_.assign(wholes_.size(), {});
  for (const Bounce& bounce : bounces_) {
    const Vector3d impulse = bounce.whole_impulse();
    Gain& gain = gains_[set_of(bounce)];
    gain.linear += impulse.dot(bounce.hits);
    gain.square += 0.5 * impulse.dot(bounce.a->change_at(bounce.point) - bounce.b->change_at(bounce.point_b));
  }
  for (Bounce& bounce : bounces_) {
    const double kept = gains_[set_of(bounce)].share_kept();
    bounce.impulse *= kept;
    bounce.friction_impulse *= kept;
  }
  for (Whole& whole : wholes_)
    if (const double kept = gains_[set_of(whole)].share_kept(); kept < 1) whole.keep(kept);
}

/// Gives each bounce an impulse along its normal, and friction by Coulomb's law, as contact_group.cpp does for particles.
void Bounces::iterate() {
  const auto apply = [](const Bounce& bounce, const Vector3d& impulse) {
    bounce.a->push(bounce.point, impulse);
    bounce.b->push(bounce.point_b, -impulse);
  };
  for (Bounce& bounce : bounces_) {
    const auto velocity = [&]() -> Vector3d {
      return bounce.a->velocity_at(bounce.point) - bounce.b->velocity_at(bounce.point_b);
    };
    const double wanted = bounce.impulse + (bounce.target - bounce.normal.dot(velocity())) / bounce.mobility;
    const double impulse = std::max(0.0, wanted);
    apply(bounce, (impulse - bounce.impulse) * bounce.normal);
    bounce.impulse = impulse;

    const Vector3d v = velocity();
    const Vector3d sliding = v - bounce.normal.dot(v) * bounce.normal;
    const double speed = sliding.norm();
    Vector3d friction = bounce.friction_impulse;
    if (speed > 0) {
      const Vector3d direction = sliding / speed;
      friction -= sliding / (bounce.a->mobility(bounce.point, direction) +
                             bounce.b->mobility(bounce.point_b, direction));
    }
    const double most = double{contacts_[bounce.contact].friction} * impulse;
    const double length = friction.norm();
    if (length > most) friction *= most / length;
    apply(bounce, friction - bounce.friction_impulse);
    bounce.friction_impulse = friction;
  }
}

void Bounces::apply(std::span<ContactBody> bodies, std::span<ContactRigid> rigids, float step) const {
  for (std::size_t i = 0; i < changed_.size(); ++i) {
    const Whole& whole = wholes_[i];
    ContactBody& body = bodies[changed_[i]];
    const Vector3d change = whole.velocity - whole.velocity_before;
    const Vector3d turn = whole.spin - whole.spin_before;
    const double time = double{share_[i]} * double{step};
    for (std::size_t p = 0; p < body.velocities.size(); ++p) {
      const Vector3d touching = body.positions[p].cast<double>() + time * body.velocities[p].cast<double>();
      const double share = parts_[i].share_of(body.lattice().particles[p]);
      const Vector3d by = share * (change + turn.cross(touching - whole.centre));
      const Vector3d velocity = body.velocities[p].cast<double>() + by;
      body.velocities[p] = velocity.cast<float>();
      body.pushes[p] -= (double{share_[i]} * by).cast<float>();
    }
  }
  for (std::size_t i = 0; i < rigids_.size(); ++i) {
    const Whole& whole = wholes_[changed_.size() + i];
    rigids[rigids_[i]].velocity += (whole.velocity - whole.velocity_before).cast<float>();
    rigids[rigids_[i]].spin += (whole.spin - whole.spin_before).cast<float>();
  }
}

void Bounces::solve(std::span<ContactBody> bodies, std::span<ContactRigid> rigids,
                    const BounceSettings& settings, float step) {
  SC_ASSERT(step > 0, "a substep of {} s", step);
  choose(bodies, rigids, settings, step);
  if (bounces_.empty()) return changed_.clear();
  for (int i = 0; i < kBounceIterations; ++i) iterate();
  take_back_gained_energy();
  apply(bodies, rigids, step);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < changed_.size(); ++i)
    if (wholes_[i].velocity != wholes_[i].velocity_before || wholes_[i].spin != wholes_[i].spin_before)
      changed_[kept++] = changed_[i];
  changed_.resize(kept);
}

}  // namespace softcell::ppu
