#include "ppu/contacts/find_contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "ppu/contacts/edge_points.h"
#include "ppu/contacts/triangle_distance.h"

namespace softcell::ppu {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;

// In cells. What comes nearer than kNear in a substep is in contact. Ways are followed in steps, none below
// kLeastStep.
constexpr float kNear = 0.005f, kLeastStep = 0.02f;
constexpr float kMostSteps = 256;  // of a way: what is faster goes in longer ones
// A point so near behind a triangle, in cells, has been pressed through it.
constexpr float kPressedThrough = 0.25f;
constexpr int kApartAtRest =
    3;  // a point never meets cells of its own body that are nearer at rest: their middles

/// Where a point is before and after the substep, in the frame of an obstacle that stands still.
struct Way {
  Vector3f from, to;
};

/// A contact in the obstacle's frame.
struct Hit {
  Vector3f normal;
  float end;  ///< metres, along the normal, at the end of the way: below 0 inside
};

std::optional<Hit> meet_triangle(const std::array<Vector3f, 3>& triangle, float rounding, const Way& way,
                                 float near, float pressed_through) {
  const Vector3f cross = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  const float area = cross.norm();
  if (!(area > 0)) return {};
  Vector3f normal = cross / area;
  float from = normal.dot(way.from - triangle[0]);
  if (from < -pressed_through) normal = -normal, from = -from;
  const float to = normal.dot(way.to - triangle[0]) - rounding;
  if (to > near) return {};
  const float share =
      from - to > 0 ? std::clamp((from - rounding) / (from - rounding - to), 0.0f, 1.0f) : 0.0f;
  const Vector3f at = way.from + share * (way.to - way.from);
  const Vector3f beside = at - nearest_point(triangle, at);
  if ((beside - normal * normal.dot(beside)).squaredNorm() > near * near) return {};
  return Hit{normal, to};
}

std::optional<Hit> meet(const Obstacle& obstacle, const Way& way, float allowance, float spacing) {
  const float near = kNear * spacing - allowance;
  const Vector3f along = way.to - way.from;
  const float length = along.norm();
  Separation here = separation(obstacle, way.from);
  if (here.distance > length + near) return {};
  // From outside the first place counts that is inside: at the end it may be nearer to the other side.
  float done = 0;
  const float least_step = std::max(kLeastStep * spacing, length / kMostSteps);
  while (here.distance > near && done < length) {
    done = std::min(length, done + std::max(here.distance - near, least_step));
    here = separation(obstacle, way.from + done / length * along);
  }
  if (here.distance > near) return {};
  const float left = length > 0 ? 1 - done / length : 0;
  return Hit{here.normal, here.distance + allowance + left * here.normal.dot(along)};
}

/// Fills in what follows from a contact's two velocities.
void complete(SoftContact& contact, float end, float approach, float friction, float step) {
  // The distance at the beginning, if what moves moves straight.
  const float begin = end - step * approach;
  contact.least_velocity = -std::max(begin, 0.0f) / step;
  contact.depth = std::max(-begin, 0.0f);
  contact.friction = friction;
}

bool contains(const Bounds<3>& box, const Vector3f& point) {
  return (point.array() < box.high.array()).all() && (box.low.array() < point.array()).all();
}

class ObstacleContacts {
 public:
  ObstacleContacts(const ContactBody& body, EndCells& cells, const Obstacle& obstacle,
                   std::span<const ContactRigid> rigids, float step, std::vector<SoftContact>& contacts)
      : body_(body),
        cells_(cells),
        obstacle_(obstacle),
        rigid_(rigids[obstacle.rigid]),
        friction_(body.friction * rigid_.friction),
        step_(step),
        contacts_(contacts) {}

  void find() {
    const float reach =
        kNear * body_.spacing() + step_ * (rigid_.velocity.norm() + rigid_.spin.norm() * radius());
    const Vector3f margin = Vector3f::Constant(reach);
    const Bounds<3> box = bounds(obstacle_);
    const Vector3f low = box.low - margin, high = box.high + margin;
    const ContactModel& model = *body_.model;
    for (std::uint32_t cell = 0; cell + 1 < model.first_of_cell.size(); ++cell) {
      if (model.first_of_cell[cell] == model.first_of_cell[cell + 1]) continue;
      if (!overlap(body_.box_of_cell(cell), {low, high})) continue;
      for (std::uint32_t i = model.first_of_cell[cell]; i < model.first_of_cell[cell + 1]; ++i) {
        const TouchPoint& point = model.touch_points[i];
        const Vector3f from = point.anchor.of(body_.positions), to = point.anchor.of(body_.ends);
        if ((from.cwiseMax(to).array() < low.array()).any() ||
            (from.cwiseMin(to).array() > high.array()).any())
          continue;
        try_point(point, from, to);
      }
    }
    for (const ObstacleEdge& edge : obstacle_.edges) try_edge(edge);
  }

 private:
  /// The farthest that a point of the obstacle may be from what it turns about.
  float radius() const {
    if (rigid_.spin.isZero(0)) return 0;
    const Bounds<3> box = bounds(obstacle_);
    return (box.low - rigid_.centre).cwiseAbs().cwiseMax((box.high - rigid_.centre).cwiseAbs()).norm();
  }

  void try_point(const TouchPoint& point, const Vector3f& from, const Vector3f& to) {
    const Vector3f carried = step_ * rigid_.velocity_at(to);
    const Way way{obstacle_.to_own(from), obstacle_.to_own(to - carried)};
    if (obstacle_.kind == ObstacleKind::kTriangles) {
      if (point.allowance > 0) return;  // it may be on either side
      for (const auto& triangle : obstacle_.triangles)
        if (const auto hit = meet_triangle(triangle, obstacle_.rounding, way, kNear * body_.spacing(),
                                           kPressedThrough * body_.spacing()))
          add(point.anchor, to, *hit);
    } else if (const auto hit = meet(obstacle_, way, point.allowance, body_.spacing())) {
      add(point.anchor, to, *hit);
    }
  }

  void add(const Anchor& anchor, const Vector3f& point, const Hit& hit) {
    SoftContact& contact = contacts_.emplace_back();
    contact.a = anchor;
    contact.rigid = obstacle_.rigid;
    contact.point = point;
    contact.normal = obstacle_.rotation * hit.normal;
    const Vector3f v = anchor.of(body_.velocities) - rigid_.velocity_at(point);
    complete(contact, hit.end, contact.normal.dot(v), friction_, step_);
  }

  /// Points of the edge that are in the body: it has to give way there.
  void try_edge(const ObstacleEdge& edge) {
    const Vector3f from = obstacle_.rotation * edge.from + obstacle_.position;
    const Vector3f along = obstacle_.rotation * (edge.to - edge.from);
    for_each_point_of_edge(from, along, body_.box, kEdgeSpacing * body_.spacing(),
                           [&](const Vector3f& point) { try_corner(point); });
  }

  void try_corner(const Vector3f& point) {
    if (!contains(body_.box, point)) return;
    const Vector3f moved = point + step_ * rigid_.velocity_at(point);
    const auto place = cells_.finder().find(moved, [](std::uint32_t) { return true; });
    if (!place) return;
    const FieldValue field = body_.model->surface.field(place->cell, place->xi);
    const Vector3f outwards = place->jacobian.inverse().transpose() * field.gradient;
    const float steep = outwards.norm();
    if (!(steep > 0) || field.distance / steep > kNear * body_.spacing() + obstacle_.rounding) return;
    SoftContact& contact = contacts_.emplace_back();
    contact.a = anchor_in_cell(body_.lattice(), place->cell, place->xi);
    contact.rigid = obstacle_.rigid;
    contact.point = moved;
    contact.normal = -outwards / steep;
    const Vector3f v = contact.a.of(body_.velocities) - rigid_.velocity_at(moved);
    complete(contact, field.distance / steep - obstacle_.rounding, contact.normal.dot(v), friction_, step_);
  }

  const ContactBody& body_;
  EndCells& cells_;
  const Obstacle& obstacle_;
  const ContactRigid& rigid_;
  float friction_;
  float step_;
  std::vector<SoftContact>& contacts_;
};

}  // namespace

void find_contacts(const ContactBody& body, EndCells& cells, const Obstacle& obstacle,
                   std::span<const ContactRigid> rigids, float step, std::vector<SoftContact>& contacts) {
  ObstacleContacts(body, cells, obstacle, rigids, step, contacts).find();
}

namespace {

/// Where in its cell b's side of a contact is held, for an impulse and its reaction to be at one point at the
/// substep's beginning: else they would turn the two bodies. What is on its way may be somewhat outside.
Vector3f opposite(const ContactBody& b, const DeformedPlace& place, const Vector3f& point) {
  constexpr float kFarthest = 0.5f;  // cells outside: farther out, shares grow large
  const Matrix3f inverse = place.jacobian.inverse();
  Vector3f xi = place.xi;
  for (int i = 0; i < 3; ++i) {
    xi += inverse * (point - anchor_in_cell(b.lattice(), place.cell, xi).of(b.positions));
    xi = xi.cwiseMax(-kFarthest).cwiseMin(1 + kFarthest);
  }
  return xi;
}

}  // namespace

/// Cells reach 0.9 cells from their middles.
bool may_touch_itself(const ContactBody& body) {
  return may_be_folded(body, 0.5f * (kApartAtRest - 0.9f) * body.spacing());
}

void find_contacts(const ContactBody& a, const ContactBody& b, EndCells& cells_of_b, float step,
                   std::vector<SoftContact>& contacts) {
  const float friction = a.friction * b.friction;
  const Lattice<3>& lattice_b = b.lattice();
  const bool itself = &a == &b;
  const ContactModel& model = *a.model;
  const auto try_point = [&](std::uint32_t cell, const TouchPoint& point) {
    const Vector3f to = point.anchor.of(a.ends);
    if (!contains(b.box, to)) return;
    const auto is_apart = [&](std::uint32_t other) {
      if (!itself) return true;  // `cell` is one of a's, which b need not have
      const Eigen::Vector3i off = lattice_b.cells[other] - lattice_b.cells[cell];
      return off.squaredNorm() > kApartAtRest * kApartAtRest;
    };
    const auto place = cells_of_b.finder().find(to, is_apart);
    if (!place) return;
    const FieldValue field = b.model->surface.field(place->cell, place->xi);
    const Vector3f outwards = place->jacobian.inverse().transpose() * field.gradient;
    const float steep = outwards.norm();
    if (!(steep > 0)) return;
    const float distance = field.distance / steep + point.allowance;
    if (distance > kNear * b.spacing()) return;
    SoftContact& contact = contacts.emplace_back();
    contact.a = point.anchor;
    contact.b = anchor_in_cell(lattice_b, place->cell, opposite(b, *place, point.anchor.of(a.positions)));
    contact.point = to;
    contact.normal = outwards / steep;
    const Vector3f v = contact.a.of(a.velocities) - contact.b.of(b.velocities);
    complete(contact, distance, contact.normal.dot(v), friction, step);
  };
  for (std::uint32_t cell = 0; cell + 1 < model.first_of_cell.size(); ++cell) {
    if (model.first_of_cell[cell] == model.first_of_cell[cell + 1]) continue;
    if (!overlap(a.box_of_cell(cell), b.box)) continue;
    for (std::uint32_t i = model.first_of_cell[cell]; i < model.first_of_cell[cell + 1]; ++i)
      try_point(cell, model.touch_points[i]);
  }
}

}  // namespace softcell::ppu
