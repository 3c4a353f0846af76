#pragma once
// Terms that all ways of finding contacts share.

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <optional>

#include "ppu/contacts/contact_body.h"
#include "ppu/contacts/contact_group.h"
#include "ppu/surfaces/cell_finder.h"

namespace softcell::ppu {

inline constexpr float kNear = 0.005f;  ///< cells: points that come nearer in a substep are in contact
/// Cells: a point this near behind a surface without an inside has been pressed through it; one this near in front may have been, from the
/// other side. Where a body is pressed flat, its inside may be as deep in an obstacle.
inline constexpr float kPressedThrough = 0.25f;
inline constexpr float kAlike = 0.5f;  ///< cosine between normals: of faces that count as one

inline bool contains(const Bounds<3>& box, const Eigen::Vector3f& point) {
  return (point.array() < box.high.array()).all() && (box.low.array() < point.array()).all();
}

/// Fills in the fields that follow from the motion along a contact's normal.
/// @param begin  metres, along the normal, at the substep's beginning; below 0 inside
inline void complete_from(SoftContact& contact, float begin, float friction, float step) {
  contact.least_velocity = -std::max(begin, 0.0f) / step;
  contact.depth = std::max(-begin, 0.0f);
  contact.friction = friction;
}

/// The same from where the substep ends, assuming straight motion.
/// @param end  metres, as above, at the substep's end   @param approach  m/s along the normal, of a against b
inline void complete(SoftContact& contact, float end, float approach, float friction, float step) {
  complete_from(contact, end - step * approach, friction, step);
}

/// The way out of a soft body.
struct WayOut {
  float distance;  ///< metres to the surface, below 0 inside
  Eigen::Vector3f normal;
};

/// @param inverse  of DeformedPlace::jacobian   @param allowance  TouchPoint::allowance of the point
/// @return none if the point is not in contact
inline std::optional<WayOut> way_out_by(const FieldValue& field, const Eigen::Matrix3f& inverse,
                                        float allowance, float spacing) {
  const Eigen::Vector3f outwards = inverse.transpose() * field.gradient;
  const float steep = outwards.norm();
  if (!(steep > 0)) return {};
  const float distance = field.distance / steep + allowance;
  if (distance > kNear * spacing) return {};
  return WayOut{distance, outwards / steep};
}

/// The way out through the nearest face. @param allowance  TouchPoint::allowance of a point at `place`   @return none if that point is not
/// in contact
inline std::optional<WayOut> way_out_of(const ContactBody& body, const DeformedPlace& place,
                                        float allowance) {
  return way_out_by(body.model->surface.field(place.cell, place.xi), place.jacobian.inverse(), allowance,
                    body.spacing());
}

/// Moves b's anchor of a contact within its cell, so that impulse and reaction act at one point at the substep's beginning; otherwise they
/// would turn the two bodies. A point still on its way may be somewhat outside.
inline Eigen::Vector3f opposite(const ContactBody& b, const DeformedPlace& place,
                                const Eigen::Vector3f& point) {
  constexpr float kFarthest = 0.5f;  // cells outside: farther out, shares become large
  const Eigen::Matrix3f inverse = place.jacobian.inverse();
  Eigen::Vector3f xi = place.xi;
  for (int i = 0; i < 3; ++i) {
    xi += inverse * (point - anchor_in_cell(b.lattice(), place.cell, xi).of(b.positions));
    xi = xi.cwiseMax(-kFarthest).cwiseMin(1 + kFarthest);
  }
  return xi;
}

}  // namespace softcell::ppu
