#include "ppu/contact_solver/lost_spin.h"

#include "ppu/numbers/turning.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

using Eigen::Matrix3d, Eigen::Vector3d;

void LostSpin::begin(std::size_t bodies) { of_bodies_.assign(bodies, {}); }

LostSpin::Spinning& LostSpin::spinning(std::span<const ContactBody> bodies, std::uint32_t body) {
  Spinning& of_body = of_bodies_[body];
  if (of_body.is_known) return of_body;
  of_body.is_known = true;
  const ContactBody& soft = bodies[body];
  const std::span<const float> masses = soft.model->masses();
  double mass = 0;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    mass += double{masses[i]};
    of_body.centre += double{masses[i]} * soft.positions[i].cast<double>();
  }
  of_body.centre /= mass;
  of_body.inertia.setZero();
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const Vector3d r = soft.positions[i].cast<double>() - of_body.centre;
    of_body.inertia += double{masses[i]} * (r.squaredNorm() * Matrix3d::Identity() - r * r.transpose());
  }
  return of_body;
}

void LostSpin::add(std::span<const ContactBody> bodies, std::uint32_t a, std::uint32_t b,
                   const Vector3d& given) {
  SC_ASSERT(a < of_bodies_.size() && b < of_bodies_.size() && given.allFinite(),
            "bodies {} and {} of {}, or a spin that is not finite", a, b, of_bodies_.size());
  if (given.isZero(0)) return;
  Spinning& first = spinning(bodies, a);
  Matrix3d inertia = first.inertia;
  if (b != a) inertia += spinning(bodies, b).inertia;
  const Vector3d turn = turning::turn_of(inertia, given);  // zero if both bodies are pressed to one line
  first.turn -= turn;
  if (b != a) of_bodies_[b].turn -= turn;
}

void LostSpin::take_back(std::span<ContactBody> bodies) const {
  for (std::size_t i = 0; i < of_bodies_.size(); ++i) {
    const Spinning& of_body = of_bodies_[i];
    if (!of_body.is_known || of_body.turn.isZero(0)) continue;
    ContactBody& body = bodies[i];
    for (std::size_t p = 0; p < body.velocities.size(); ++p) {
      const Vector3d arm = body.positions[p].cast<double>() - of_body.centre;
      body.velocities[p] += of_body.turn.cross(arm).cast<float>();
    }
  }
}

}  // namespace softcell::ppu
