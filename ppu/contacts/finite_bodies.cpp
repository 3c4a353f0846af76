#include "ppu/contacts/finite_bodies.h"

#include <stdexcept>

namespace softcell::ppu {

void refuse_to_be_infinite() {
  throw std::runtime_error(
      "a soft body has positions or velocities that are not finite numbers, or passes 1e15 m");
}

void check_finite(const ContactBody& body) {
  constexpr float kFarthest = 1e15f;  // metres
  bool finite = (body.box.high - body.box.low).cwiseAbs().maxCoeff() < kFarthest;
  for (const Eigen::Vector3f& end : body.ends) finite = finite && end.cwiseAbs().maxCoeff() < kFarthest;
  if (!finite) refuse_to_be_infinite();
}

}  // namespace softcell::ppu
