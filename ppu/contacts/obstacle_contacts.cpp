#include "ppu/contacts/obstacle_contacts.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "ppu/contacts/body_at_obstacle.h"
#include "ppu/contacts/triangle_contacts.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

// In cells: a shape around whose middle there is as much of it is thicker than all that a body may have beyond its drawn surface.
constexpr float kThick = 2;

/// Contacts with a convex shape.
class ConvexContacts : private BodyAtObstacle {
 public:
  using BodyAtObstacle::BodyAtObstacle;

  void find() {
    const float reach = come_near(bounds(obstacle_));
    if (may_have_others_beside())
      cells_.beside.begin(obstacles_, near_obstacles_, obstacle_, body_.spacing());
    const Passage near = passage(near_);
    // Nothing is beyond a thick shape: a point that has a contact is deep in it.
    const bool is_thick = obstacle_.kind == ObstacleKind::kPlane ||
                          separation(obstacle_, Vector3f::Zero()).distance < -kThick * body_.spacing();
    cells_.boxes().for_each_meeting(near_, [&](std::uint32_t cell) {
      if (body_.model->first_of_cell[cell] == body_.model->first_of_cell[cell + 1]) return;
      const FaceByCell face = face_by(cell);
      const bool is_far = face.clear > kNear * body_.spacing() + face.carried;
      if (has_points_outside(cell) && !(is_far && is_thick)) try_points_outside(cell, face, is_thick);
      if (!is_far) try_points_within(near, cell);
    });
    for (const ObstacleEdge& edge : obstacle_.edges) try_edge(edge, reach);
  }

 private:
  /// The face of the obstacle, which is convex, that is nearest to the middle of a cell: the obstacle is behind it. In the world.
  struct FaceByCell {
    Vector3f normal, middle;  ///< the middle of the cell's box
    float distance;           ///< metres of the middle from the face
    float clear;              ///< metres that the whole box is in front of the face, at least
    float carried;            ///< metres that the obstacle would carry a point of the box along, at most

    float height(const Vector3f& place) const { return distance + normal.dot(place - middle); }
  };
  FaceByCell face_by(std::uint32_t cell) const {
    const Bounds<3> box = cells_.boxes().at(cell);
    const Vector3f middle = 0.5f * (box.low + box.high);
    const Separation face = separation(obstacle_, obstacle_.to_own(middle));
    const Vector3f normal = obstacle_.rotation * face.normal, half = 0.5f * (box.high - box.low);
    const float arm = (middle - rigid_.centre).norm() + half.norm();
    return {normal, middle, face.distance, face.distance - normal.cwiseAbs().dot(half),
            step_ * (rigid_.velocity.norm() + rigid_.spin.norm() * arm)};
  }

  /// @param is_thick  of the obstacle
  void try_points_outside(std::uint32_t cell, const FaceByCell& face, bool is_thick) {
    const float near = kNear * body_.spacing();
    const Vector3f inner = inner_place(*body_.model, cell, body_.positions);
    const bool is_inner_before = face.height(inner) > 0;
    for_each_point_outside(cell, [&](const TouchPoint& point, const Vector3f& from, const Vector3f& to) {
      // Most lines pass beside.
      if (is_inner_before && face.height(from) > 0) return;
      if (is_thick && face.height(to) > near + face.carried - point.allowance) return;
      if (!overlap(near_, Bounds<3>{from.cwiseMin(inner), from.cwiseMax(inner)})) return;
      const PointWay way = way_of(from, to);
      if (is_thick && separation(obstacle_, way.to).distance > near - point.allowance) return;
      const auto hit = face_before_point_outside(way, obstacle_.to_own(inner), point.allowance);
      if (hit && hit->end <= near) add(point.anchor, to, *hit, hit->end - point.allowance);
    });
  }

  void try_points_within(const Passage& near, std::uint32_t cell) {
    const float spacing = body_.spacing();
    for_each_point_in(near, cell, [&](const TouchPoint& point, const Vector3f& from, const Vector3f& to) {
      const PointWay way = way_of(from, to);
      const auto arrival = arrive(obstacle_, way.from, way.to - way.from, kNear * spacing, spacing);
      if (!arrival) return;
      if (const auto hit = hit_of(point, way, *arrival, cell)) add(point.anchor, to, *hit, hit->end);
    });
  }

  /// Whether another shape lies behind a face. @param place  on the face, in the obstacle's frame
  bool is_covered(const Vector3f& place, const Vector3f& normal) {
    return may_have_others_beside() && cells_.beside.is_covered(place, normal);
  }

  /// @return  none: another shape has the contact
  std::optional<ObstacleHit> hit_of(const TouchPoint& point, const PointWay& way, const Arrival& arrival,
                                    std::uint32_t cell) {
    const float spacing = body_.spacing();
    const Vector3f arrives_at = arrival.place_on(way);
    if (may_turn_near(obstacle_, arrives_at, kBeside * spacing)) {
      const auto beside = hit_of_face_beside(obstacle_, way, arrival, inwards_of(point), spacing);
      if (beside && !is_covered(arrives_at, beside->normal)) return beside;
    }
    return turned_outwards(hit_at(arrival, way), way, cell);
  }

  /// The direction from a point across the surface into its body: of unit length, in the obstacle's frame. 0: the surface is not
  /// flat there.
  Vector3f inwards_of(const TouchPoint& point) const {
    constexpr float kFar = 0.5f, kLeastDepth = 0.35f;  // cells
    const ContactModel& model = *body_.model;
    const auto low = [&](std::uint32_t cell) -> Vector3f {
      return model.lattice().cells[cell].cast<float>();
    };
    const std::uint32_t cell = point.anchor.cell;
    const Vector3f outwards = model.surface.field(cell, point.xi).gradient.stableNormalized();
    const Vector3f place = low(cell) + point.xi - kFar * outwards;
    const auto there = model.cell_at(place);
    if (!there || model.surface.field(*there, place - low(*there)).distance > -kLeastDepth)
      return Vector3f::Zero();
    const Anchor within = anchor_in_cell(model.lattice(), *there, place - low(*there));
    const Vector3f way = within.of(body_.positions) - point.anchor.of(body_.positions);
    return obstacle_.rotation.transpose() * way.stableNormalized();
  }

  /// The contact of a point outside of the drawn surface, which may be deep in the obstacle or on its other side: the line to it from the
  /// inside of its body tells the face.
  /// @param inside  the inner place of the point's cell, in the obstacle's frame
  /// @return  none: the line does not enter, the inner place does not tell, or another shape has the contact
  std::optional<ObstacleHit> face_before_point_outside(const PointWay& way, const Vector3f& inside,
                                                       float allowance) {
    const float spacing = body_.spacing();
    const PointWay line{inside, way.from};
    const auto arrival = arrive(obstacle_, line.from, line.to - line.from, 0, spacing);
    // Where a body is pressed flat, its inside may be a little in the obstacle, too.
    if (!arrival || arrival->there.distance < -kPressedThrough * spacing) return {};
    Separation face = arrival->there;
    Vector3f at = line.from + arrival->share * (line.to - line.from);
    if (arrival->share == 0) {  // of a thin shape, the nearest face may be the far one
      const Vector3f within = at - 2 * kPressedThrough * spacing * face.normal;
      if (separation(obstacle_, within).distance > 0) return {};
    }
    if (is_covered(arrival->place_on(line), face.normal)) {
      if (arrival->share > 0) at = way.from;
      const auto other =
          cells_.beside.way_out(at, {face.normal.dot(at - arrival->place_on(line)), face.normal}, at, inside);
      if (!other) return {};
      face = *other;
    }
    return ObstacleHit{face.normal, face.distance + face.normal.dot(way.to - at) + allowance};
  }

  /// Changes a contact that leads to the far side of a thin shape, or through a face with another shape behind it.
  /// @return  none: the point is in the other shape, which has the contact
  std::optional<ObstacleHit> turned_outwards(const ObstacleHit& hit, const PointWay& way,
                                             std::uint32_t cell) {
    const Vector3f inside = obstacle_.to_own(inner_place(*body_.model, cell, body_.positions));
    const auto entered = entered_face(obstacle_, way, inside, hit, body_.spacing());
    if (entered && !is_covered(entered->place, entered->hit.normal)) return entered->hit;
    if (!may_have_others_beside()) return hit;
    if (const auto other = cells_.beside.way_out(way.to, {hit.end, hit.normal}, way.from, inside))
      return ObstacleHit{other->normal, other->distance};
    if (hit.end > 0 && is_covered(way.to - hit.end * hit.normal, hit.normal)) return {};
    return hit;
  }
};

}  // namespace

void find_contacts(const ObstacleSearch& search, std::vector<SoftContact>& contacts) {
  for (const std::uint32_t obstacle : search.near)
    if (search.obstacles[obstacle].kind == ObstacleKind::kTriangles)
      find_triangle_contacts(search, obstacle, contacts);
    else
      ConvexContacts(search, obstacle, contacts).find();
}

}  // namespace softcell::ppu
