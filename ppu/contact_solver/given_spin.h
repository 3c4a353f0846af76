#pragma once
// The angular momentum that the contacts of a pair have given both bodies together (lost_spin.h).

#include <Eigen/Core>
#include <span>

#include "ppu/contact_solver/contact_groups.h"
#include "ppu/contacts/contact_body.h"

namespace softcell::ppu {

/// kg m^2/s. A push moves particles together with their momenta. @param group  a pair of soft bodies, solved
Eigen::Vector3d given_spin(const ContactGroup& group, std::span<const ContactBody> bodies, float step);

}  // namespace softcell::ppu
