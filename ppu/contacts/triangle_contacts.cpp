#include "ppu/contacts/triangle_contacts.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "ppu/contacts/body_at_obstacle.h"
#include "ppu/contacts/obstacle_triangle.h"
#include "ppu/surfaces/edge_points.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

// In cells: a point nearer to a triangle may be on either side; likewise, if it is known to have been on the other side, as its body may be
// pressed flat.
constexpr float kClearSide = 0.05f, kDoubtfulSide = 0.15f;
// Cosine between the normals of the two sides of a thin plate. If all triangles are like one of them, no two are opposite.
constexpr float kOpposite = -0.5f;

class TriangleContacts : private BodyAtObstacle {
 public:
  TriangleContacts(const ObstacleSearch& search, std::uint32_t obstacle, std::vector<SoftContact>& contacts)
      : BodyAtObstacle(search, obstacle, contacts),
        triangles_(search.cells.triangles(obstacle_, kEdgeSpacing * body_.spacing())) {}

  /// Points only meet the triangles near their motion.
  void find() {
    // The same as bounds(), but faster.
    const float reach =
        come_near(widened(to_world(obstacle_, triangles_.boxes().bounds()), obstacle_.rounding));
    find_origin();
    find_near_triangles();
    find_fronts();
    for (const EndCells::PointAtTriangle& at : cells_.near_triangles)
      if (const auto hit =
              ObstacleTriangle(obstacle_, triangles_, at.triangle)
                  .meet({at.from, at.to}, at.inside, body_.spacing(), at.front, at.point->allowance))
        add(at.point->anchor, at.point->anchor.of(body_.ends), *hit, hit->end - at.point->allowance);
    try_edges_of_triangles(reach);
  }

 private:
  /// Finds out whether the whole body, with all that is inside of it, has been pressed through triangles: small bodies can be. Then the
  /// last place that it reached without passing through one tells on which side it belongs.
  void find_origin() {
    const auto middle_cell = static_cast<std::uint32_t>(body_.lattice().cells.size() / 2);
    const Vector3f middle = obstacle_.to_own(inner_place(*body_.model, middle_cell, body_.positions));
    KnownSides& sides = *body_.sides;
    const auto [last, last_middle] = track_of(middle);
    if (!is_any_near(last, middle)) return sides.set_track(rigid_.number, obstacle_.part, {middle, middle});
    Vector3f safe = last;
    // If the body has been pressed through, its safe place follows it on the other side.
    const Vector3f here = is_crossed(last, middle) ? Vector3f(last + (middle - last_middle)) : middle;
    for (const Vector3f& place : {moved_off(here), here}) {
      if (is_crossed(last, place)) continue;
      safe = place;
      break;
    }
    if (is_crossed(safe, middle)) origin_ = safe;
    sides.set_track(rigid_.number, obstacle_.part, {safe, middle});
  }

  /// Whether a triangle may lie between two places, or moved_off() the second one. Most bodies are thicker than that: one look spares
  /// several.
  bool is_any_near(const Vector3f& from, const Vector3f& to) const {
    bool any = false;
    for_each_triangle(widened({from.cwiseMin(to), from.cwiseMax(to)}, kPressedThrough * body_.spacing()),
                      [&](std::uint32_t) { any = true; });
    return any;
  }

  KnownSides::Track track_of(const Vector3f& middle) const {
    const auto known = body_.sides->track(rigid_.number, obstacle_.part);
    const auto& origin = body_.sides->origin();
    if (!origin) return known.value_or(KnownSides::Track{middle, middle});
    // A piece that has just broken off. The whole may have been pressed through where it was.
    const Vector3f near = obstacle_.to_own(*origin);
    return {known && is_crossed(known->safe, near) ? known->safe : near, middle};
  }

  /// A place beside triangles, moved off them: the middle of a thin body lies so near to what it slides on that it might be pressed through
  /// in the next substep.
  Vector3f moved_off(const Vector3f& place) const {
    const float margin = kPressedThrough * body_.spacing();
    Vector3f moved = place;
    for_each_triangle(widened({place, place}, margin), [&](std::uint32_t number) {
      const ObstacleTriangle triangle(obstacle_, triangles_, number);
      if (!triangle.has_area() || !triangle.is_over(moved, margin)) return;
      const float height = triangle.height(moved);
      if (std::abs(height) < margin) moved += ((height < 0 ? -margin : margin) - height) * triangle.normal();
    });
    return moved;
  }

  /// Whether the way from one place to another crosses a triangle.
  bool is_crossed(const Vector3f& from, const Vector3f& to) const {
    bool crossed = false;
    for_each_triangle({from.cwiseMin(to), from.cwiseMax(to)}, [&](std::uint32_t number) {
      const ObstacleTriangle triangle(obstacle_, triangles_, number);
      if (!triangle.has_area() || !triangle.parts(from, to)) return;
      const float before = triangle.height(from), after = triangle.height(to);
      const Vector3f crossing = from + before / (before - after) * (to - from);
      crossed = crossed || triangle.is_over(crossing, kNear * body_.spacing());
    });
    return crossed;
  }

  /// For each point: triangles near its motion; if there are none, or its body is behind one of them, also those that it has been pressed
  /// through farther.
  void find_near_triangles() {
    const Passage deep = passage(widened(near_, kPressedDeepest * body_.spacing()));
    cells_.near_triangles.clear();
    cells_.boxes().for_each_meeting(deep.box, [&](std::uint32_t cell) {
      const Vector3f inner = inner_place(*body_.model, cell, body_.positions);
      const Bounds<3> around = cells_.boxes().at(cell);
      if (!overlap(near_, Bounds<3>{around.low.cwiseMin(inner), around.high.cwiseMax(inner)})) return;
      const Vector3f inside = origin_ ? *origin_ : obstacle_.to_own(inner);
      for_each_point_outside(cell, [&](const TouchPoint& point, const Vector3f& from, const Vector3f& to) {
        const Bounds<3> line{from.cwiseMin(to).cwiseMin(inner), from.cwiseMax(to).cwiseMax(inner)};
        if (overlap(deep.box, line)) add_between(point, way_of(from, to), inside);
      });
      for_each_point_in(deep, cell, [&](const TouchPoint& point, const Vector3f& from, const Vector3f& to) {
        add_near(point, way_of(from, to), inside);
      });
    });
  }

  /// Adds what may be near a point on the drawn surface.
  void add_near(const TouchPoint& point, const PointWay& way, const Vector3f& inside) {
    // A point that has been pressed through a triangle may be this far behind it and still meets it.
    const Vector3f margin =
        Vector3f::Constant((kNear + kPressedThrough) * body_.spacing() + obstacle_.rounding);
    // As far as it is known before the triangles are looked at.
    const float front = obstacle_.faces_bodies ? 1 : body_.sides->last_side_of(rigid_.number, obstacle_.part);
    EndCells::PointAtTriangle at{&point, 0, way.from, way.to, inside};
    const std::size_t first = cells_.near_triangles.size();
    bool is_any_near = false, is_behind_any = false;
    for_each_triangle({way.from.cwiseMin(way.to) - margin, way.from.cwiseMax(way.to) + margin},
                      [&](std::uint32_t number) {
                        is_any_near = true;
                        const ObstacleTriangle triangle(obstacle_, triangles_, number);
                        if (!triangle.has_area()) return;
                        // It may be the far side of a plate whose near side is not near the point.
                        is_behind_any = is_behind_any || front * triangle.height(inside) < 0;
                        if (triangle.passes_beside(way, body_.spacing())) return;
                        at.triangle = number;
                        cells_.near_triangles.push_back(at);
                      });
    if (!is_any_near || is_behind_any) add_pressed_through(at, first);
    leave_out_far_sides(first);
  }

  /// Calls work(triangle) for triangles whose boxes meet `box`.
  template <typename Work>
  void for_each_triangle(const Bounds<3>& box, const Work& work) const {
    if (overlap(box, triangles_.boxes().bounds())) triangles_.boxes().for_each_meeting(box, work);
  }

  /// Adds triangles that separate a point outside of the drawn surface, however far, from the inside of its body.
  void add_between(const TouchPoint& point, const PointWay& way, const Vector3f& inside) {
    const Vector3f low = inside.cwiseMin(way.from).cwiseMin(way.to),
                   high = inside.cwiseMax(way.from).cwiseMax(way.to);
    const float squashed = kPressedThrough * body_.spacing();
    const float not_deep = point.allowance - kNear * body_.spacing() - obstacle_.rounding;
    const Vector3f margin = Vector3f::Constant(squashed);
    for_each_triangle({low - margin, high + margin}, [&](std::uint32_t number) {
      const ObstacleTriangle triangle(obstacle_, triangles_, number);
      if (std::abs(triangle.height(way.to)) < not_deep) return;
      if (std::abs(triangle.height(inside)) > squashed && !triangle.parts(way.from, inside) &&
          !triangle.parts(way.to, inside))
        return;
      cells_.near_triangles.push_back({&point, number, way.from, way.to, inside});
    });
  }

  /// Adds triangles that separate a point from the inside of its body, up to kPressedDeepest from the point.
  /// @param first  index of the point's first triangle in the list
  void add_pressed_through(EndCells::PointAtTriangle at, std::size_t first) {
    const Vector3f inwards = at.inside - at.from;
    const float share = std::min(1.0f, kPressedDeepest * body_.spacing() / inwards.norm());
    const Vector3f deepest = at.from + share * inwards;
    const auto is_there = [&](std::uint32_t triangle) {
      return std::ranges::any_of(
          std::span(cells_.near_triangles).subspan(first),
          [&](const EndCells::PointAtTriangle& known) { return known.triangle == triangle; });
    };
    for_each_triangle({at.from.cwiseMin(deepest), at.from.cwiseMax(deepest)}, [&](std::uint32_t triangle) {
      if (!ObstacleTriangle(obstacle_, triangles_, triangle).parts(at.from, at.inside) || is_there(triangle))
        return;
      at.triangle = triangle;
      cells_.near_triangles.push_back(at);
    });
  }

  /// Leaves out the far sides of plates. The body is in front of one side of a plate and behind the other. A point that has been pressed
  /// into the plate, or rests on it, would seem to have been pressed through the far side.
  /// @param begin  index of the first triangle of the last point
  void leave_out_far_sides(std::size_t begin) {
    const auto near = std::span(cells_.near_triangles).subspan(begin);
    // If all face nearly the same way, as those of a ground do, none face each other.
    const auto is_alike = [&](const EndCells::PointAtTriangle& at) {
      const KnownTriangles::Face &first = triangles_.face(near[0].triangle),
                                 &own = triangles_.face(at.triangle);
      return first.area > 0 && own.area > 0 && first.normal.dot(own.normal) > kAlike;
    };
    if (near.empty() || std::ranges::all_of(near, is_alike)) return;
    for (EndCells::PointAtTriangle& far : near) {
      const ObstacleTriangle farther(obstacle_, triangles_, far.triangle);
      if (!farther.has_area()) continue;
      for (const EndCells::PointAtTriangle& other : near) {
        const ObstacleTriangle nearer(obstacle_, triangles_, other.triangle);
        if (!nearer.has_area() || farther.normal().dot(nearer.normal()) > kOpposite) continue;
        const float height = nearer.height(other.inside), beyond = farther.height(far.inside);
        if (height * beyond >= 0 || std::abs(height) >= std::abs(beyond)) continue;
        if (nearer.is_over(far.from, kNear * body_.spacing())) far.is_far_side = true;
      }
    }
    // Not by std::ranges::remove_if(), whose subranges Clang 14 cannot read.
    std::vector<EndCells::PointAtTriangle>& all = cells_.near_triangles;
    const auto is_far_side = [](const EndCells::PointAtTriangle& at) { return at.is_far_side; };
    all.erase(std::remove_if(all.begin() + static_cast<std::ptrdiff_t>(begin), all.end(), is_far_side),
              all.end());
  }

  /// On which side of a triangle the body is, judged by a point that may have been pressed through: above 0 in front. 0: the point is far
  /// from the triangle before and after the substep, or passes beside it.
  float side_of(const EndCells::PointAtTriangle& near) const {
    const ObstacleTriangle triangle(obstacle_, triangles_, near.triangle);
    if (!triangle.has_area() || near.point->allowance > 0)
      return 0;  // a point outside of what is drawn may be on either side
    const float thick = kPressedThrough * body_.spacing() + obstacle_.rounding;
    const float from = triangle.height(near.from), to = triangle.height(near.to);
    if (std::min(from, to) > thick || std::max(from, to) < -thick) return 0;
    const float share = from * to < 0 ? from / (from - to) : 1;
    const Vector3f at = near.from + share * (near.to - near.from);
    if (!triangle.is_over(at, kNear * body_.spacing())) return 0;
    if (std::abs(from) > thick) return from;
    return triangle.height(near.inside);
  }

  /// 1: the body was in front of the obstacle's triangles; -1: behind them; 0: it is not known.
  int known_side() const { return body_.sides->known_side_of(rigid_.number, obstacle_.part); }

  /// 1: a point that may have been pressed through shows that the body is in front of a triangle; -1: behind it; 0: neither is clear.
  /// @param known  as known_side() says
  int vote_of(const EndCells::PointAtTriangle& near, int known) const {
    const float side = side_of(near);
    const float clear = (static_cast<float>(known) * side < 0 ? kDoubtfulSide : kClearSide) * body_.spacing();
    return side > clear ? 1 : side < -clear ? -1 : 0;
  }

  /// Finds out on which side of near triangles the body is. A mesh may be wound either way, closed around a solid or around a room: the
  /// majority of its triangles tells. If some contradict, each sheet is judged by itself: a wall may face away from a body on the floor.
  void find_fronts() {
    if (obstacle_.faces_bodies || cells_.near_triangles.empty()) return;
    const int known = known_side();
    int for_front = 0, for_back = 0;
    for (const EndCells::PointAtTriangle& near : cells_.near_triangles) {
      const int vote = vote_of(near, known);
      for_front += vote > 0 ? 1 : 0;
      for_back += vote < 0 ? 1 : 0;
    }
    const float front = body_.sides->side_of(rigid_.number, obstacle_.part, for_front - for_back);
    for (EndCells::PointAtTriangle& near : cells_.near_triangles) near.front = front;
    const bool contradicted = front > 0 ? for_back > 0 : for_front > 0;
    if (contradicted || body_.sides->knows_sheets(rigid_.number, obstacle_.part)) find_fronts_of_sheets();
  }

  void find_fronts_of_sheets() {
    cells_.sheets.find(obstacle_.triangles);
    if (cells_.sheets.count() < 2) return;
    std::vector<KnownSides::SheetSeen>& sheets = cells_.near_sheets;
    sheets.clear();
    const auto sheet_of = [&](const EndCells::PointAtTriangle& near) {
      const std::uint32_t sheet = cells_.sheets.of(near.triangle);
      const auto known = std::ranges::find(sheets, sheet, &KnownSides::SheetSeen::sheet);
      return known != sheets.end() ? known : sheets.insert(known, {sheet, near.triangle, 0});
    };
    const int known = known_side();
    for (const EndCells::PointAtTriangle& near : cells_.near_triangles)
      sheet_of(near)->seen += vote_of(near, known);
    for (KnownSides::SheetSeen& sheet : sheets) {
      const float front = body_.sides->side_of_sheet(rigid_.number, obstacle_.part, obstacle_.triangles,
                                                     cells_.sheets, sheet);
      for (EndCells::PointAtTriangle& near : cells_.near_triangles)
        if (cells_.sheets.of(near.triangle) == sheet.sheet) near.front = front;
    }
  }

  void try_edges_of_triangles(float reach) {
    if (triangles_.has_long_edges()) try_long_edges(reach);
    const auto in_world = [&](const CornerSet::Point& corner) {
      return obstacle_.to_world({corner[0], corner[1], corner[2]});
    };
    // Sorted, so that the order does not depend on where the list of triangles begins.
    std::vector<CornerSet::Point>& near = cells_.near_corners;
    near.clear();
    for (const CornerSet::Point& corner : triangles_.corners())
      if (may_be_in_body(in_world(corner))) near.push_back(corner);
    std::sort(near.begin(), near.end());
    for (const CornerSet::Point& corner : near) try_corner(in_world(corner), Vector3f::Zero(), 0);
  }

  void try_long_edges(float reach) {
    triangles_.boxes().for_each_block([&](std::size_t first, std::size_t end, const Bounds<3>& box) {
      if (!cells_.boxes().any_meets(widened(to_world(obstacle_, box), 2 * reach))) return;
      for (std::size_t edge = 3 * first; edge < 3 * end; ++edge)
        if (triangles_.is_long(edge)) try_edge(obstacle_.edge(edge), reach);
    });
  }

  const KnownTriangles& triangles_;
  std::optional<Vector3f>
      origin_;  // in the obstacle's frame, if the body has been pressed through as a whole
};

}  // namespace

void find_triangle_contacts(const ObstacleSearch& search, std::uint32_t obstacle,
                            std::vector<SoftContact>& contacts) {
  TriangleContacts(search, obstacle, contacts).find();
}

}  // namespace softcell::ppu
