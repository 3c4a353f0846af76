#pragma once
// Converts a joint of Box2D to rows of its Jacobian.

#include <box2d/b2_joint.h>

#include <cstdint>
#include <vector>

#include "ppu/obstacles/rigid_links.h"

namespace softcell::ppu {

/// Appends the rows with which Box2D solves velocities, for all joints but gears: their effect is left to Box2D.
/// @param a, b  indices of the ContactRigid of the joint's bodies  @param step  seconds
void add_joint_rows(b2Joint& joint, std::uint32_t a, std::uint32_t b, float step,
                    std::vector<JointRow>& rows);

}  // namespace softcell::ppu
