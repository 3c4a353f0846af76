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
    near_ = {low, high};
    if (obstacle_.kind == ObstacleKind::kTriangles) return find_with_triangles(reach);
    cells_.boxes().for_each_meeting(near_, [&](std::uint32_t cell) {
      for_each_point_near(cell, [&](const TouchPoint& point, const Vector3f& from, const Vector3f& to) {
        if (const auto hit = meet(obstacle_, way_of(from, to), point.allowance, body_.spacing()))
          add(point.anchor, to, *hit);
      });
    });
    for (const ObstacleEdge& edge : obstacle_.edges) try_edge(edge, reach);
  }

 private:
  /// The farthest that a point of the obstacle may be from what it turns about.
  float radius() const {
    if (rigid_.spin.isZero(0)) return 0;
    const Bounds<3> box = bounds(obstacle_);
    return (box.low - rigid_.centre).cwiseAbs().cwiseMax((box.high - rigid_.centre).cwiseAbs()).norm();
  }

  /// Calls work(point, from, to) for a cell's points that pass what is near the obstacle.
  template <typename Work>
  void for_each_point_near(std::uint32_t cell, const Work& work) const {
    const ContactModel& model = *body_.model;
    for (std::uint32_t i = model.first_of_cell[cell]; i < model.first_of_cell[cell + 1]; ++i) {
      const TouchPoint& point = model.touch_points[i];
      const Vector3f from = point.anchor.of(body_.positions), to = point.anchor.of(body_.ends);
      if ((from.cwiseMax(to).array() < near_.low.array()).any() ||
          (from.cwiseMin(to).array() > near_.high.array()).any())
        continue;
      work(point, from, to);
    }
  }

  Way way_of(const Vector3f& from, const Vector3f& to) const {
    const Vector3f carried = step_ * rigid_.velocity_at(to);
    return {obstacle_.to_own(from), obstacle_.to_own(to - carried)};
  }

  /// Points meet the triangles near their cell only.
  void find_with_triangles(float reach) {
    find_triangles_near_cells(reach);
    const std::vector<CellAndTriangle>& near = cells_.triangles;
    for (std::size_t i = 0, end; i < near.size(); i = end) {
      const std::uint32_t cell = near[i].cell;
      for (end = i; end < near.size() && near[end].cell == cell;) ++end;
      for_each_point_near(cell, [&](const TouchPoint& point, const Vector3f& from, const Vector3f& to) {
        if (point.allowance > 0) return;  // it may be on either side
        for (std::size_t t = i; t < end; ++t)
          if (const auto hit =
                  meet_triangle(obstacle_.triangles[near[t].triangle], obstacle_.rounding, way_of(from, to),
                                kNear * body_.spacing(), kPressedThrough * body_.spacing()))
            add(point.anchor, to, *hit);
      });
    }
    try_edges_of_triangles(reach);
  }

  /// Of triangles near cells. The ends of short edges belong to many of them: each is looked up once.
  void try_edges_of_triangles(float reach) {
    cells_.corners.clear();
    for (const std::uint32_t triangle : cells_.triangles_near_any) {
      for (const ObstacleEdge& edge : obstacle_.edges.subspan(3 * std::size_t{triangle}, 3)) {
        if ((edge.to - edge.from).norm() > kEdgeSpacing * body_.spacing()) {
          try_edge(edge, reach);
          continue;
        }
        // Where it ends the next edge of the triangle begins.
        cells_.corners.push_back({edge.from.x(), edge.from.y(), edge.from.z()});
      }
    }
    std::sort(cells_.corners.begin(), cells_.corners.end());
    const auto last = std::unique(cells_.corners.begin(), cells_.corners.end());
    for (auto corner = cells_.corners.begin(); corner != last; ++corner)
      try_corner(obstacle_.to_world({(*corner)[0], (*corner)[1], (*corner)[2]}));
  }

  /// To cells_.triangles, ascending by cells, then by triangles.
  void find_triangles_near_cells(float reach) {
    cells_.triangles.clear();
    cells_.triangles_near_any.clear();
    // Triangles are held against cells at the substep's end, so they have to be as much larger as anything moves until then.
    Eigen::Array3f farthest = Eigen::Array3f::Zero();
    for (std::size_t i = 0; i < body_.ends.size(); ++i)
      farthest = farthest.max((body_.ends[i] - body_.positions[i]).array().abs());
    const Vector3f margin = farthest.matrix() + Vector3f::Constant(reach + obstacle_.rounding);
    for (std::uint32_t t = 0; t < obstacle_.triangles.size(); ++t) {
      const auto& own = obstacle_.triangles[t];
      const Vector3f a = obstacle_.to_world(own[0]), b = obstacle_.to_world(own[1]),
                     c = obstacle_.to_world(own[2]);
      const Bounds<3> box{a.cwiseMin(b).cwiseMin(c) - margin, a.cwiseMax(b).cwiseMax(c) + margin};
      const std::size_t before = cells_.triangles.size();
      cells_.finder().for_each_cell_near(box, [&](std::uint32_t cell) {
        cells_.triangles.push_back({cell, t});
      });
      if (cells_.triangles.size() != before) cells_.triangles_near_any.push_back(t);
    }
    std::sort(cells_.triangles.begin(), cells_.triangles.end());
    cells_.triangles.erase(std::unique(cells_.triangles.begin(), cells_.triangles.end()),
                           cells_.triangles.end());
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
  void try_edge(const ObstacleEdge& edge, float reach) {
    const Vector3f from = obstacle_.rotation * edge.from + obstacle_.position;
    const Vector3f along = obstacle_.rotation * (edge.to - edge.from);
    const auto [first, last] = way_in_box(body_.box, from, along);
    if (first > last) return;
    const Vector3f a = from + first * along, b = from + last * along, margin = Vector3f::Constant(2 * reach);
    if (!cells_.boxes().any_meets({a.cwiseMin(b) - margin, a.cwiseMax(b) + margin})) return;
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
  Bounds<3> near_{};  // around the obstacle, as far as anything that moves may come from
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

void find_contacts(const ContactBody& a, EndCells& cells_of_a, const ContactBody& b, EndCells& cells_of_b,
                   float step, std::vector<SoftContact>& contacts) {
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
  cells_of_a.boxes().for_each_meeting(b.box, [&](std::uint32_t cell) {
    for (std::uint32_t i = model.first_of_cell[cell]; i < model.first_of_cell[cell + 1]; ++i)
      try_point(cell, model.touch_points[i]);
  });
}

}  // namespace softcell::ppu
