#pragma once
// Converts a joint of Bullet to rows of its Jacobian.

#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <cstdint>
#include <vector>

#include "ppu/obstacles/rigid_links.h"

namespace softcell::ppu {

/// Appends the rows that Bullet's solver would solve for a joint of any kind.
/// @param a, b  indices of the ContactRigid of the joint's first and second body, or JointRow::kWorld
/// @param step  seconds
void add_joint_rows(btTypedConstraint& joint, std::uint32_t a, std::uint32_t b,
                    const btContactSolverInfo& info, float step, std::vector<JointRow>& rows);

}  // namespace softcell::ppu
