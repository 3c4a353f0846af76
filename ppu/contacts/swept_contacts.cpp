#include "ppu/contacts/swept_contacts.h"

#include <algorithm>
#include <cmath>

#include "ppu/contacts/contact_terms.h"
#include "ppu/numbers/box_around.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

// In cells of the smaller body, in a substep: slower bodies end near where they touch.
constexpr float kFast = 1;
// In the thinner body's thickness, in a substep: slower bodies end where they are pushed back.
constexpr float kFastInBodies = 0.3f;
constexpr float kSweepStep = 0.5f;  // cells
constexpr int kMostMoments = 48;    // of a sweep

Vector3f between(const Vector3f& from, const Vector3f& to, float share) { return from + share * (to - from); }
Bounds<3> between(const Bounds<3>& from, const Bounds<3>& to, float share) {
  return {between(from.low, to.low, share), between(from.high, to.high, share)};
}
/// The relative mean displacement of two bodies in the substep, metres.
float relative_travel(const ContactBody& a, const ContactBody& b) { return (a.travel - b.travel).norm(); }
float smaller_spacing(const ContactBody& a, const ContactBody& b) {
  return std::min(a.spacing(), b.spacing());
}

}  // namespace

bool are_fast(const ContactBody& a, const ContactBody& b) {
  const float thickness = std::min(a.model->thickness(), b.model->thickness());
  return relative_travel(a, b) > std::max(kFastInBodies * thickness, smaller_spacing(a, b));
}

void SweptContacts::find(const ContactBody& a, const ContactBody& b, float step,
                         std::vector<SoftContact>& contacts) {
  const ContactModel& model = *a.model;
  const float friction = a.friction * b.friction;
  const int steps =
      std::clamp(static_cast<int>(std::ceil(relative_travel(a, b) / (kSweepStep * smaller_spacing(a, b)))), 1,
                 kMostMoments);
  from_.clear(), to_.clear();
  for (const TouchPoint& point : model.touch_points) {
    from_.push_back(point.anchor.of(a.positions));
    to_.push_back(point.anchor.of(a.ends));
  }
  has_met_.assign(from_.size(), false);
  const Bounds<3> b_from = box_around<Bounds<3>>(b.positions), b_to = box_around<Bounds<3>>(b.ends);
  const Bounds<3> a_from = box_around<Bounds<3>>(from_), a_to = box_around<Bounds<3>>(to_);
  for (int k = 1; k <= steps; ++k) {
    const float share = static_cast<float>(k) / static_cast<float>(steps);
    const Bounds<3> box = between(b_from, b_to, share);
    if (!overlap(between(a_from, a_to, share), box)) continue;
    particles_.clear();
    for (std::size_t i = 0; i < b.ends.size(); ++i)
      particles_.push_back(between(b.positions[i], b.ends[i], share));
    finder_.place(b.lattice(), particles_);
    for (std::size_t i = 0; i < from_.size(); ++i) {
      const Vector3f at = between(from_[i], to_[i], share);
      if (has_met_[i] || !contains(box, at)) continue;
      const auto place = finder_.find(at, [](std::uint32_t) { return true; });
      if (!place) continue;
      const TouchPoint& point = model.touch_points[i];
      const auto way_out = way_out_of(b, *place, point.allowance);
      if (!way_out) continue;
      has_met_[i] = true;
      SoftContact& contact = contacts.emplace_back();
      contact.a = model.held(point.anchor);
      contact.b = b.model->held(anchor_in_cell(b.lattice(), place->cell, place->xi));
      contact.point = at;
      contact.normal = way_out->normal;
      const Vector3f v = contact.a.of(a.velocities) - contact.b.of(b.velocities);
      const float approach = contact.normal.dot(v);
      complete(contact, way_out->distance + (1 - share) * step * approach, approach, friction, step);
    }
  }
}

}  // namespace softcell::ppu
