#include "ppu/bullet/joint_rows.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include "ppu/bullet/bullet_vector.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

// btGeneric6DofSpring2Constraint has the most: two limits, a motor and a spring for each of six axes.
constexpr std::size_t kMostRows = 24;

/// A row as joints fill it in: all numbers of one row lie together, one row after the other.
struct BulletRow {
  btVector3 linear_a{0, 0, 0}, angular_a{0, 0, 0}, linear_b{0, 0, 0}, angular_b{0, 0, 0};
  btScalar target = 0, softness = 0, least = -SIMD_INFINITY, most = SIMD_INFINITY;
};
static_assert(sizeof(BulletRow) % sizeof(btScalar) == 0);

/// Translates Bullet's largest number, which means no limit.
float limit_of(btScalar limit) {
  if (limit >= SIMD_INFINITY) return JointRow::kNoLimit;
  return limit <= -SIMD_INFINITY ? -JointRow::kNoLimit : limit;
}

/// The speed at which a motor or the correction of position errors aims. A row within its limit may move up to it; a row beyond its limit
/// stays there, and its error is not corrected.
float target_of(const BulletRow& row) {
  const bool is_limited_below = row.least > -SIMD_INFINITY, is_limited_above = row.most < SIMD_INFINITY;
  if (is_limited_below == is_limited_above) return row.target;
  return is_limited_below ? std::min(row.target, 0.0f) : std::max(row.target, 0.0f);
}

/// The change of a row's speed by an impulse, as Bullet computes it.
float mobility(const btRigidBody& body, const btVector3& linear, const btVector3& angular) {
  return body.getInvMass() * linear.length2() + angular.dot(body.getInvInertiaTensorWorld() * angular);
}

/// Whether the program, or Bullet for it, reads the joint's load, for example to break the joint.
bool is_watched(const btTypedConstraint& joint) {
  return joint.needsFeedback() || joint.getBreakingImpulseThreshold() < SIMD_INFINITY;
}

}  // namespace

void add_joint_rows(btTypedConstraint& joint, std::uint32_t a, std::uint32_t b,
                    const btContactSolverInfo& info, float step, std::vector<JointRow>& rows) {
  SC_ASSERT(step > 0, "a substep of {} s", step);
  btTypedConstraint::btConstraintInfo1 size;
  joint.buildJacobian();
  joint.getInfo1(&size);
  SC_ASSERT(size.m_numConstraintRows >= 0 && std::size_t(size.m_numConstraintRows) <= kMostRows,
            "a joint of {} rows", size.m_numConstraintRows);
  std::array<BulletRow, kMostRows> made;
  for (BulletRow& row : made) row.softness = info.m_globalCfm;
  btTypedConstraint::btConstraintInfo2 wanted;
  wanted.fps = 1 / step;
  wanted.erp = info.m_erp;
  wanted.m_damping = info.m_damping;
  wanted.m_numIterations = info.m_numIterations;
  wanted.rowskip = sizeof(BulletRow) / sizeof(btScalar);
  wanted.m_J1linearAxis = made[0].linear_a;
  wanted.m_J1angularAxis = made[0].angular_a;
  wanted.m_J2linearAxis = made[0].linear_b;
  wanted.m_J2angularAxis = made[0].angular_b;
  wanted.m_constraintError = &made[0].target;
  wanted.cfm = &made[0].softness;
  wanted.m_lowerLimit = &made[0].least;
  wanted.m_upperLimit = &made[0].most;
  joint.getInfo2(&wanted);
  for (int i = 0; i < size.m_numConstraintRows; ++i) {
    const BulletRow& row = made[static_cast<std::size_t>(i)];
    const float gives_way = mobility(joint.getRigidBodyA(), row.linear_a, row.angular_a) +
                            mobility(joint.getRigidBodyB(), row.linear_b, row.angular_b);
    rows.push_back({.a = a,
                    .b = b,
                    .of_a = {to_eigen(row.linear_a), to_eigen(row.angular_a)},
                    .of_b = {to_eigen(row.linear_b), to_eigen(row.angular_b)},
                    .target = target_of(row),
                    .softness = row.softness * gives_way,  // Bullet's softness is a share of it
                    .least = limit_of(row.least),
                    .most = limit_of(row.most),
                    .is_watched = is_watched(joint)});
  }
}

}  // namespace softcell::ppu
