#include "ppu/bodies/motion.h"

#include <cstddef>
#include <span>

#include "ppu/matching/matching_plan.h"
#include "ppu/matching/rotation.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

using turning::cross, turning::inertia_of;

template <int kDimension>
Motion<kDimension> motion_of(const SoftBody<kDimension>& body) {
  using Vector = typename Motion<kDimension>::Vector;
  const std::span<const float> masses = body.model().masses();
  Motion<kDimension> motion;
  double mass = 0;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const double m = masses[i];
    mass += m;
    motion.centre += m * body.position(i).template cast<double>();
    motion.velocity += m * body.velocities()[i].template cast<double>();
  }
  SC_ASSERT(mass > 0, "{} particles have a mass of {} kg together", masses.size(), mass);
  motion.centre /= mass;
  motion.velocity /= mass;

  typename Motion<kDimension>::Matrix second_moment = Motion<kDimension>::Matrix::Zero();
  motion.spin = cross(Vector(Vector::Zero()), Vector(Vector::Zero()));
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const double m = masses[i];
    const Vector r = body.position(i).template cast<double>() - motion.centre;
    const Vector v = body.velocities()[i].template cast<double>();
    motion.spin += m * cross(r, v);
    second_moment += m * r * r.transpose();
  }
  motion.inertia = inertia_of(second_moment);
  return motion;
}

template <int kDimension>
typename Motion<kDimension>::Matrix orientation_of(const SoftBody<kDimension>& body,
                                                   const typename Motion<kDimension>::Vector& centre) {
  const auto plan = body.plan();
  const auto rest = plan->particle_constants();
  SC_ASSERT(rest.size() == body.positions().size(), "{} particles at rest, {} in the body", rest.size(),
            body.positions().size());
  typename Motion<kDimension>::Matrix correlation = Motion<kDimension>::Matrix::Zero();
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const double m = body.model().masses()[i];
    correlation += m * (body.position(i).template cast<double>() - centre) *
                   rest[i].x0.template cast<double>().transpose();
  }
  return nearest_rotation(correlation);
}

template Motion<2> motion_of(const SoftBody<2>&);
template Motion<3> motion_of(const SoftBody<3>&);
template Motion<2>::Matrix orientation_of(const SoftBody<2>&, const Motion<2>::Vector&);
template Motion<3>::Matrix orientation_of(const SoftBody<3>&, const Motion<3>::Vector&);

}  // namespace softcell::ppu
