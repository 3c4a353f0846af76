#pragma once
// What contacts with an obstacle of any kind have in common: the body's points near it, and the obstacle's edges and corners in the body.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ppu/contacts/arrival.h"
#include "ppu/contacts/contact_terms.h"
#include "ppu/contacts/obstacle_contacts.h"

namespace softcell::ppu {

/// A body and one obstacle near it, in one substep. Appends contacts to a list.
class BodyAtObstacle {
 public:
  /// @param obstacle  its index in search.obstacles
  BodyAtObstacle(const ObstacleSearch& search, std::uint32_t obstacle, std::vector<SoftContact>& contacts)
      : body_(search.body),
        cells_(search.cells),
        obstacles_(search.obstacles),
        near_obstacles_(search.near),
        obstacle_(search.obstacles[obstacle]),
        rigid_(search.rigids[obstacle_.rigid]),
        friction_(search.body.friction * rigid_.friction * obstacle_.friction),
        step_(search.step),
        contacts_(contacts) {}

 protected:
  static Bounds<3> widened(const Bounds<3>& box, float by) {
    return {box.low - Eigen::Vector3f::Constant(by), box.high + Eigen::Vector3f::Constant(by)};
  }

  /// Sets near_ and where_edges_begin_. @param box  around the obstacle  @return how far from the obstacle they reach, metres
  float come_near(const Bounds<3>& box);

  /// A box, and a box of the ends of all points that may pass through it: points hardly move farther than the particles that hold them.
  struct Passage {
    Bounds<3> box, ends;
  };
  Passage passage(const Bounds<3>& box);

  /// Calls work(point, from, to) for those of a cell's points on the drawn surface, or inside, that may pass through the box.
  template <typename Work>
  void for_each_point_in(const Passage& passage, std::uint32_t cell, const Work& work) const {
    const ContactModel& model = *body_.model;
    const Bounds<3>& box = passage.box;
    for (std::uint32_t i = model.first_of_cell[cell]; i < model.first_of_cell[cell + 1]; ++i) {
      const TouchPoint& point = model.touch_points[i];
      if (point.allowance > 0) continue;
      const Eigen::Vector3f to = point.anchor.of(body_.ends);
      if (!contains(passage.ends, to)) continue;  // decided without looking where it begins
      const Eigen::Vector3f from = point.anchor.of(body_.positions);
      if ((from.cwiseMax(to).array() < box.low.array()).any() ||
          (from.cwiseMin(to).array() > box.high.array()).any())
        continue;
      work(point, from, to);
    }
  }

  bool has_points_outside(std::uint32_t cell) const {
    return body_.model->first_particle_of_cell[cell] < body_.model->first_of_cell[cell + 1];
  }

  /// Calls work(point, from, to) for those of a cell's points that are outside of the drawn surface. All are particles.
  template <typename Work>
  void for_each_point_outside(std::uint32_t cell, const Work& work) const {
    const ContactModel& model = *body_.model;
    for (std::uint32_t i = model.first_particle_of_cell[cell]; i < model.first_of_cell[cell + 1]; ++i) {
      const TouchPoint& point = model.touch_points[i];
      if (point.allowance <= 0) continue;
      const unsigned corner =
          (point.xi.x() > 0.5f ? 1u : 0) | (point.xi.y() > 0.5f ? 2u : 0) | (point.xi.z() > 0.5f ? 4u : 0);
      const std::uint32_t particle = point.anchor.particle[corner];
      work(point, body_.positions[particle], body_.ends[particle]);
    }
  }

  /// @param from, to  in the world, before and after the substep
  PointWay way_of(const Eigen::Vector3f& from, const Eigen::Vector3f& to) const {
    const Eigen::Vector3f carried = step_ * rigid_.velocity_at(to);
    return {obstacle_.to_own(from), obstacle_.to_own(to - carried)};
  }

  /// @param above  metres, of the point above the obstacle at the substep's end; hit.end, less the allowance if that counts in it
  void add(const Anchor& anchor, const Eigen::Vector3f& point, const ObstacleHit& hit, float above);

  // What of the obstacle is in the body.

  /// Adds contacts for the points of the edge that are in the body.
  /// @param reach  as come_near() returns it
  void try_edge(const ObstacleEdge& edge, float reach);
  /// Adds a contact if the corner, or point of an edge, is in the body at the substep's end.
  /// @param along   the edge of the corner; 0: a tip, in two dimensions a corner
  /// @param radius  of the edge there, metres
  void try_corner(const Eigen::Vector3f& corner, const Eigen::Vector3f& along, float radius);

  /// Rules out most points by a look at a few boxes.
  bool may_be_in_body(const Eigen::Vector3f& point) const {
    return contains(where_edges_begin_, point) && cells_.finder().may_find(moved(point));
  }

  /// Triangles have been checked already, and round shapes have their edges inside.
  bool may_have_others_beside() const {
    return obstacle_.kind != ObstacleKind::kTriangles && obstacle_.rounding == 0 &&
           near_obstacles_.size() > 1;
  }

  const ContactBody& body_;
  EndCells& cells_;
  std::span<const Obstacle> obstacles_;
  std::span<const std::uint32_t> near_obstacles_;
  const Obstacle& obstacle_;
  const ContactRigid& rigid_;
  float friction_;
  float step_;
  std::vector<SoftContact>& contacts_;
  Bounds<3> near_{};               // around the obstacle, as far as anything that moves may come from
  Bounds<3> where_edges_begin_{};  // of the obstacle that may be in the body at the substep's end

 private:
  /// The largest possible distance of a point of the obstacle from its centre of rotation.
  float radius(const Bounds<3>& box) const;
  Eigen::Vector3f moved(const Eigen::Vector3f& point) const {
    return point + step_ * rigid_.velocity_at(point);
  }
  bool is_within_a_floor(const Eigen::Vector3f& corner, const Eigen::Vector3f& along);
  /// Where a corner that is at a place of the body at the substep's end is at its beginning: metres from the surface, below 0 inside. To go
  /// back from the end with the velocities leaves errors where the body bends, and what rests on it would tremble.
  /// @param normal  of the surface at the end   @return none: it moves far within the body, was near another face, or attachments hold the
  ///                body: what presses on it is solved with what holds it
  std::optional<float> distance_before(const DeformedPlace& place, const Eigen::Vector3f& corner,
                                       const Eigen::Vector3f& normal) const;
};

}  // namespace softcell::ppu
