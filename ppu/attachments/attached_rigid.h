#pragma once
// A rigid body that soft bodies are attached to, in two dimensions and three.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "ppu/numbers/wide_inverse.h"
#include "ppu/obstacles/obstacle.h"

namespace softcell::ppu {

/// A rigid body for attachments in two dimensions. @see ContactRigid
struct AttachedRigid2d {
  Eigen::Vector2f centre{0, 0};    ///< of mass, metres
  Eigen::Vector2f velocity{0, 0};  ///< m/s, of the centre
  float spin = 0;                  ///< rad/s
  float inverse_mass = 0;          ///< 1/kg; 0: nothing moves it
  float inverse_inertia = 0;       ///< 1/(kg m^2)
};

/// The operations of attachments on a rigid body.
template <int kDimension>
struct AttachedRigid;

template <>
struct AttachedRigid<3> {
  using Rigid = ContactRigid;
  using Vector = Eigen::Vector3f;

  static Vector velocity_at(const Rigid& rigid, const Vector& point) { return rigid.velocity_at(point); }
  /// 1/kg. Rigid bodies with attachments are never held by their supports (supports.h), so that none of them has a coupling.
  static Eigen::Matrix3f linear_mobility(const Rigid& rigid) {
    return rigid.held ? rigid.held->linear
                      : Eigen::Matrix3f(rigid.inverse_mass * Eigen::Matrix3f::Identity());
  }
  /// Whether an impulse moves it alike along all axes.
  static bool is_free(const Rigid& rigid) { return !rigid.held; }
  /// m/s^2: centripetal acceleration of a point that turns with the body.
  static Vector curve(const Rigid& rigid, const Vector& point) {
    return rigid.spin.cross(rigid.spin.cross(Vector(point - rigid.centre)));
  }
  /// 1/kg: the matrix that gives the velocity of the point by an impulse at it.
  static Eigen::Matrix3f mobility(const Rigid& rigid, const Vector& point) {
    const Vector r = point - rigid.centre;
    Eigen::Matrix3f cross;
    cross << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
    return linear_mobility(rigid) + cross * rigid.inverse_inertia * cross.transpose();
  }
  static void apply(Rigid& rigid, const Vector& point, const Vector& impulse) {
    rigid.velocity += linear_mobility(rigid) * impulse;
    rigid.spin += rigid.inverse_inertia * Vector(point - rigid.centre).cross(impulse);
  }

  // For all particles of a weld at once. Axial vectors have one component per axis of rotation.
  static constexpr int kAxes = 3;
  using Axial = Eigen::Vector3f;
  static Axial moment(const Vector& arm, const Vector& force) { return arm.cross(force); }
  static Vector turned(const Axial& spin, const Vector& arm) { return spin.cross(arm); }
  static Eigen::Matrix3f inertia_of_arm(const Vector& arm) {
    return arm.squaredNorm() * Eigen::Matrix3f::Identity() - arm * arm.transpose();
  }
  static bool can_turn(const Rigid& rigid) { return rigid.inverse_inertia.cast<double>().determinant() > 0; }
  static Eigen::Matrix3f inertia(const Rigid& rigid) { return wide_inverse(rigid.inverse_inertia); }
  static void change(Rigid& rigid, const Vector& velocity, const Axial& spin) {
    rigid.velocity += velocity;
    rigid.spin += spin;
  }
};

template <>
struct AttachedRigid<2> {
  using Rigid = AttachedRigid2d;
  using Vector = Eigen::Vector2f;

  static bool is_free(const Rigid& /*rigid*/) { return true; }
  static Vector turned(const Vector& r) { return {-r.y(), r.x()}; }
  static Vector velocity_at(const Rigid& rigid, const Vector& point) {
    return rigid.velocity + rigid.spin * turned(point - rigid.centre);
  }
  static Vector curve(const Rigid& rigid, const Vector& point) {
    return -rigid.spin * rigid.spin * (point - rigid.centre);
  }
  static Eigen::Matrix2f mobility(const Rigid& rigid, const Vector& point) {
    const Vector r = turned(point - rigid.centre);
    return rigid.inverse_mass * Eigen::Matrix2f::Identity() + rigid.inverse_inertia * (r * r.transpose());
  }
  static void apply(Rigid& rigid, const Vector& point, const Vector& impulse) {
    rigid.velocity += rigid.inverse_mass * impulse;
    rigid.spin += rigid.inverse_inertia * turned(point - rigid.centre).dot(impulse);
  }

  static constexpr int kAxes = 1;
  using Axial = Eigen::Vector<float, 1>;
  static Axial moment(const Vector& arm, const Vector& force) { return Axial(turned(arm).dot(force)); }
  static Vector turned(const Axial& spin, const Vector& arm) { return spin[0] * turned(arm); }
  static Axial inertia_of_arm(const Vector& arm) { return Axial(arm.squaredNorm()); }
  static bool can_turn(const Rigid& rigid) { return rigid.inverse_inertia > 0; }
  static Axial inertia(const Rigid& rigid) { return Axial(1 / rigid.inverse_inertia); }
  static void change(Rigid& rigid, const Vector& velocity, const Axial& spin) {
    rigid.velocity += velocity;
    rigid.spin += spin[0];
  }
};

}  // namespace softcell::ppu
