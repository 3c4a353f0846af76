#include "ppu/bullet/joint_rows.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include "ppu/bullet/bullet_vector.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

// btGeneric6DofSpring2Constraint has most: of each of six axes two limits, a motor and a spring.
constexpr std::size_t kMostRows = 24;

/// What joints write into, numbers of one row behind those of another.
struct BulletRow {
  btVector3 linear_a{0, 0, 0}, angular_a{0, 0, 0}, linear_b{0, 0, 0}, angular_b{0, 0, 0};
  btScalar target = 0, softness = 0, least = -SIMD_INFINITY, most = SIMD_INFINITY;
};
static_assert(sizeof(BulletRow) % sizeof(btScalar) == 0);

/// Bullet's largest number, where it means none.
float limit_of(btScalar limit) {
  if (limit >= SIMD_INFINITY) return JointRow::kNoLimit;
  return limit <= -SIMD_INFINITY ? -JointRow::kNoLimit : limit;
}

/// Where a motor or errors of positions want it. What has not come to a limit yet may go there, and what is beyond stays there.
float target_of(const BulletRow& row) {
  const bool is_limited_below = row.least > -SIMD_INFINITY, is_limited_above = row.most < SIMD_INFINITY;
  if (is_limited_below == is_limited_above) return row.target;
  return is_limited_below ? std::min(row.target, 0.0f) : std::max(row.target, 0.0f);
}

/// How much an impulse changes of a row's speed, as Bullet sees it.
float mobility(const btRigidBody& body, const btVector3& linear, const btVector3& angular) {
  return body.getInvMass() * linear.length2() + angular.dot(body.getInvInertiaTensorWorld() * angular);
}

/// Whether the program, or Bullet for it, wants to know what a joint bears: to break it, for example.
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
                    .softness = row.softness * gives_way,  // Bullet's is a share of it
                    .least = limit_of(row.least),
                    .most = limit_of(row.most),
                    .is_watched = is_watched(joint)});
  }
}

}  // namespace softcell::ppu
