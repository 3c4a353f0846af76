#pragma once
// What the ways of finding contacts have in common.

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <optional>

#include "ppu/contacts/contact_body.h"
#include "ppu/contacts/contact_group.h"
#include "ppu/surfaces/cell_finder.h"

namespace softcell::ppu {

inline constexpr float kNear = 0.005f;  ///< cells: what comes nearer in a substep is in contact

inline bool contains(const Bounds<3>& box, const Eigen::Vector3f& point) {
  return (point.array() < box.high.array()).all() && (box.low.array() < point.array()).all();
}

/// Fills in what follows from a contact's two velocities.
/// @param end  metres, along the normal, at the substep's end; below 0 inside   @param approach  m/s along the normal, of a against b
inline void complete(SoftContact& contact, float end, float approach, float friction, float step) {
  // The distance at the beginning, if what moves moves straight.
  const float begin = end - step * approach;
  contact.least_velocity = -std::max(begin, 0.0f) / step;
  contact.depth = std::max(-begin, 0.0f);
  contact.friction = friction;
}

/// Out of a soft body.
struct WayOut {
  float distance;  ///< metres to the surface, below 0 inside
  Eigen::Vector3f normal;
};

/// @param inverse  of DeformedPlace::jacobian   @param allowance  TouchPoint::allowance of what is there
/// @return none if that is not in contact
inline std::optional<WayOut> way_out_by(const FieldValue& field, const Eigen::Matrix3f& inverse,
                                        float allowance, float spacing) {
  const Eigen::Vector3f outwards = inverse.transpose() * field.gradient;
  const float steep = outwards.norm();
  if (!(steep > 0)) return {};
  const float distance = field.distance / steep + allowance;
  if (distance > kNear * spacing) return {};
  return WayOut{distance, outwards / steep};
}

/// By the nearest face. @param allowance  TouchPoint::allowance of what is at a place of the body   @return none if that is not in contact
inline std::optional<WayOut> way_out_of(const ContactBody& body, const DeformedPlace& place,
                                        float allowance) {
  return way_out_by(body.model->surface.field(place.cell, place.xi), place.jacobian.inverse(), allowance,
                    body.spacing());
}

}  // namespace softcell::ppu
