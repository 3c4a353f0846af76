#pragma once
// What a joint of Box2D holds.

#include <box2d/b2_joint.h>

#include <cstdint>
#include <vector>

#include "ppu/surfaces/rigid_links.h"

namespace softcell::ppu {

/// Appends the rows that Box2D solves velocities by, of revolute, prismatic, wheel, weld, distance and pulley joints. Of others none: a mouse joint
/// gives way, and what gears, friction and motor joints do between bodies is left to Box2D.
/// @param a, b  indices of the ContactRigid of the joint's bodies  @param step  seconds
void add_joint_rows(b2Joint& joint, std::uint32_t a, std::uint32_t b, float step,
                    std::vector<JointRow>& rows);

}  // namespace softcell::ppu
