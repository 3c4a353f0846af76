#include "ppu/contacts/body_at_obstacle.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "ppu/contacts/sharp_contacts.h"
#include "ppu/surfaces/edge_points.h"

namespace softcell::ppu {

using Eigen::Vector3f;

float BodyAtObstacle::come_near(const Bounds<3>& box) {
  const float way = step_ * (rigid_.velocity.norm() + rigid_.spin.norm() * radius(box));
  const float reach = kNear * body_.spacing() + way;
  near_ = widened(box, reach);
  where_edges_begin_ = widened(body_.box, way);
  return reach;
}

float BodyAtObstacle::radius(const Bounds<3>& box) const {
  if (rigid_.spin.isZero(0)) return 0;
  return (box.low - rigid_.centre).cwiseAbs().cwiseMax((box.high - rigid_.centre).cwiseAbs()).norm();
}

BodyAtObstacle::Passage BodyAtObstacle::passage(const Bounds<3>& box) {
  constexpr float kRounding = 1e-5f;  // of the sums that make up a point
  const Vector3f farthest = body_.box.low.cwiseAbs().cwiseMax(body_.box.high.cwiseAbs());
  const Vector3f reach = 2 * cells_.boxes().longest_way() + kRounding * farthest;
  return {box, {box.low - reach, box.high + reach}};
}

void BodyAtObstacle::add(const Anchor& anchor, const Vector3f& point, const ObstacleHit& hit, float above) {
  SoftContact& contact = contacts_.emplace_back();
  contact.a = body_.model->held(anchor);
  contact.rigid = obstacle_.rigid;
  contact.restitution = obstacle_.restitution;
  contact.point = point;
  contact.acts_at = contact.a.of(body_.positions);
  contact.normal = obstacle_.rotation * hit.normal;
  const Vector3f v = contact.a.of(body_.velocities) - rigid_.velocity_at(contact.acts_at);
  contact.above = above;
  complete(contact, hit.end, contact.normal.dot(v), friction_, step_);
}

void BodyAtObstacle::try_edge(const ObstacleEdge& edge, float reach) {
  if (body_.spacing() <= edge.cells_above) return;
  const Vector3f from = obstacle_.rotation * edge.from + obstacle_.position;
  const Vector3f along = obstacle_.rotation * (edge.to - edge.from);
  const auto [first, last] = way_in_box(where_edges_begin_, from, along);
  if (first > last) return;
  const Vector3f a = from + first * along, b = from + last * along, margin = Vector3f::Constant(2 * reach);
  if (!cells_.boxes().any_meets({a.cwiseMin(b) - margin, a.cwiseMax(b) + margin})) return;
  for_each_point_of_edge(
      from, along, where_edges_begin_, kEdgeSpacing * body_.spacing(),
      [&](const Vector3f& point, float share) { try_corner(point, along, edge.radius_at(share)); });
}

bool BodyAtObstacle::is_within_a_floor(const Vector3f& corner, const Vector3f& along) {
  if (!may_have_others_beside()) return false;
  if (!along.isZero(0)) return cells_.beside.face_goes_on(corner, along);
  return body_.model->is_flat() && cells_.beside.face_goes_on(corner, Vector3f::UnitZ());
}

void BodyAtObstacle::try_corner(const Vector3f& corner, const Vector3f& along, float radius) {
  const Vector3f point = moved(corner);
  if (!contains(body_.box, point)) return;
  const auto place = cells_.finder().find(point, [](std::uint32_t) { return true; });
  if (!place) return;
  const FieldValue field = body_.model->surface.field(place->cell, place->xi);
  const Vector3f outwards = place->jacobian.inverse().transpose() * field.gradient;
  const float steep = outwards.norm();
  const float distance = field.distance / steep - obstacle_.rounding - radius;
  if (!(steep > 0) || distance > kNear * body_.spacing()) return;
  if (radius == 0 && is_within_a_floor(corner, along)) return;
  SoftContact& contact = contacts_.emplace_back();
  contact.a = body_.model->held(anchor_in_cell(body_.lattice(), place->cell, place->xi));
  contact.rigid = obstacle_.rigid;
  contact.restitution = obstacle_.restitution;
  contact.point = point;
  contact.acts_at = contact.a.of(body_.positions);
  contact.normal = -outwards / steep;
  contact.room = room_to_squeeze(body_, *place, -field.gradient.normalized(), -distance);
  const Vector3f v = contact.a.of(body_.velocities) - rigid_.velocity_at(contact.acts_at);
  const float inside_edge = obstacle_.rounding + radius;
  if (const auto before = distance_before(*place, corner, outwards / steep))
    complete_from(contact, *before - inside_edge, friction_, step_);
  else
    complete(contact, distance, contact.normal.dot(v), friction_, step_);
}

std::optional<float> BodyAtObstacle::distance_before(const DeformedPlace& place, const Vector3f& corner,
                                                     const Vector3f& normal) const {
  constexpr float kFar = 0.1f, kClose = 0.01f;  // cells
  if (!body_.inverse_masses_if_held.empty()) return {};
  const Vector3f xi = opposite(body_, place, corner);
  if ((place.xi - xi).norm() > kFar) return {};
  const Vector3f found = anchor_in_cell(body_.lattice(), place.cell, xi).of(body_.positions);
  if (!((found - corner).norm() < kClose * body_.spacing())) return {};
  const FieldValue field = body_.model->surface.field(place.cell, xi);
  const Vector3f outwards = place.jacobian.inverse().transpose() * field.gradient;
  const float steep = outwards.norm();
  if (!(outwards.dot(normal) > kAlike * steep)) return {};
  return field.distance / steep;
}

}  // namespace softcell::ppu
