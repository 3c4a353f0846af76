#include "ppu/contacts/obstacle_contacts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "ppu/contacts/contact_terms.h"
#include "ppu/contacts/obstacle_triangle.h"
#include "ppu/contacts/sharp_contacts.h"
#include "ppu/surfaces/edge_points.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

// In cells. A point's motion is followed in steps, none below kLeastStep.
constexpr float kLeastStep = 0.02f;
constexpr float kMostSteps = 256;    // for one motion: a faster point takes longer steps
constexpr float kClearSide = 0.05f;  // cells: a point nearer to a triangle may be on either side
constexpr float kDoubtfulSide =
    0.15f;  // likewise, if it is known to have been on the other side: its body may be pressed flat
// Cosines between normals: of the two sides of a thin plate, and of faces that count as one. If all triangles are like one of them, no two
// are opposite.
constexpr float kOpposite = -0.5f, kAlike = 0.5f;
// A point that arrives at a face this near to an edge, in cells, may belong to the face beside it.
constexpr float kBeside = 0.1f;
// Sine of the angle between a contact's normal and that of the body's surface: below this they are as good as one.
constexpr float kFaceOn = 0.1f;
// In cells: a shape around whose middle there is as much of it is thicker than all that a body may have beyond its drawn surface.
constexpr float kThick = 2;

/// The place where a point's motion comes near an obstacle.
struct Arrival {
  float share;  ///< of the way
  Separation there;

  /// On the obstacle.
  Vector3f place_on(const PointWay& way) const {
    return way.from + share * (way.to - way.from) - there.distance * there.normal;
  }
};

/// Looks for what a step of a motion has jumped over or, if it ends in a thin shape, for the side from which it has come.
/// @param before, after  shares of the way; the motion comes nearer to the obstacle at the first and leaves it at the second
/// @return  a place near the obstacle, on the side from which the motion comes; none: it has only passed by
std::optional<Arrival> jumped_over(const Obstacle& obstacle, const Vector3f& from, const Vector3f& along,
                                   float near, float before, float after) {
  constexpr int kHalvings = 20;
  for (int i = 0; i < kHalvings; ++i) {
    const float middle = 0.5f * (before + after);
    const Separation there = separation(obstacle, from + middle * along);
    const bool comes = there.normal.dot(along) < 0;
    if (comes && there.distance <= near) return Arrival{middle, there};
    (comes ? before : after) = middle;
  }
  return {};
}

/// @param near  metres from the obstacle  @return  the first such place of the motion; none: it does not come near
std::optional<Arrival> arrive(const Obstacle& obstacle, const Vector3f& from, const Vector3f& along,
                              float near, float spacing) {
  const float length = along.norm();
  Separation here = separation(obstacle, from);
  if (here.distance > length + near) return {};
  float done = 0;
  const float least_step = std::max(kLeastStep * spacing, length / kMostSteps);
  while (here.distance > near && done < length) {
    const float before = done;
    const bool may_jump = least_step > here.distance, came = here.normal.dot(along) < 0;
    done = std::min(length, done + std::max(here.distance - near, least_step));
    here = separation(obstacle, from + done / length * along);
    if (may_jump && came && here.normal.dot(along) > 0)
      if (const auto arrival = jumped_over(obstacle, from, along, near, before / length, done / length))
        return arrival;
  }
  if (here.distance > near) return {};
  return Arrival{length > 0 ? done / length : 1, here};
}

/// For a point from outside the first place inside counts: at the end it may be nearer to the other side.
ObstacleHit hit_at(const Arrival& arrival, const PointWay& way) {
  const auto& [share, there] = arrival;
  return ObstacleHit{there.normal, there.distance + (1 - share) * there.normal.dot(way.to - way.from)};
}

/// Corrects the contact of a point that arrives at a face a little way from its edge, while its body's surface slides past the edge. Where
/// a block slides on a soft floor, points ahead of it lie a little above its bottom: they pass below the block, and do not stop it.
/// @param inwards  from the point into its own body, across its surface: of unit length, in the obstacle's frame
/// @return  the contact with the face beyond the edge; none: there is no edge near, or the body runs into the face
std::optional<ObstacleHit> hit_of_face_beside(const Obstacle& obstacle, const PointWay& way,
                                              const Arrival& arrival, const Vector3f& inwards,
                                              float spacing) {
  const Separation& there = arrival.there;
  const float cosine = inwards.dot(there.normal);
  const Vector3f aside = inwards - cosine * there.normal;
  const float sine = aside.norm();
  if (sine < kFaceOn) return {};
  const Vector3f behind = arrival.place_on(way) - kNear * spacing * there.normal;
  const Vector3f beyond = behind + kBeside * spacing / sine * aside;
  const Separation face = separation(obstacle, beyond);
  if (face.distance < 0 || face.normal.dot(inwards) < 0.5f * (cosine + 1)) return {};
  return ObstacleHit{face.normal, face.distance + face.normal.dot(way.to - beyond)};
}

/// A contact with the face through which a line from the inside of a body enters an obstacle.
struct EnteredFace {
  ObstacleHit hit;
  Vector3f place;  ///< on the face, in the obstacle's frame
};

/// Corrects the contact of a point that has been pressed in so deep that it is nearer to another face than to the one through which it
/// entered: to the far side of a thin shape, or to a side near an edge. It would leave through that face, and its body would get stuck
/// there.
/// @param inside  a place of the point's body, before the substep, in the obstacle's frame
/// @param hit     of the point, as hit_at() finds it
/// @return  the contact with the face that the line from inside of the body meets; none: it is the same face, or `inside` does not tell
std::optional<EnteredFace> entered_face(const Obstacle& obstacle, const PointWay& way, const Vector3f& inside,
                                        const ObstacleHit& hit, float spacing) {
  const PointWay line{inside, way.from};
  if (hit.normal.dot(line.to - line.from) <= 0) return {};  // the body is in front of it
  const auto arrival = arrive(obstacle, line.from, line.to - line.from, 0, spacing);
  if (!arrival || arrival->share == 0 || arrival->there.normal.dot(hit.normal) > kAlike) return {};
  const Vector3f place = arrival->place_on(line), &normal = arrival->there.normal;
  return EnteredFace{{normal, normal.dot(way.to - place)}, place};
}

class ObstacleContacts {
 public:
  ObstacleContacts(const ObstacleSearch& search, std::uint32_t obstacle, std::vector<SoftContact>& contacts)
      : body_(search.body),
        cells_(search.cells),
        obstacles_(search.obstacles),
        near_obstacles_(search.near),
        obstacle_(search.obstacles[obstacle]),
        rigid_(search.rigids[obstacle_.rigid]),
        friction_(search.body.friction * rigid_.friction * obstacle_.friction),
        step_(search.step),
        contacts_(contacts) {}

  void find() {
    if (obstacle_.kind == ObstacleKind::kTriangles)
      return find_with_triangles(cells_.triangles(obstacle_, kEdgeSpacing * body_.spacing()));
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
  static Bounds<3> widened(const Bounds<3>& box, float by) {
    return {box.low - Vector3f::Constant(by), box.high + Vector3f::Constant(by)};
  }

  /// Sets near_ and where_edges_begin_. @param box  around the obstacle  @return how far from the obstacle they reach, metres
  float come_near(const Bounds<3>& box) {
    const float way = step_ * (rigid_.velocity.norm() + rigid_.spin.norm() * radius(box));
    const float reach = kNear * body_.spacing() + way;
    near_ = widened(box, reach);
    where_edges_begin_ = widened(body_.box, way);
    return reach;
  }

  /// The largest possible distance of a point of the obstacle from its centre of rotation.
  float radius(const Bounds<3>& box) const {
    if (rigid_.spin.isZero(0)) return 0;
    return (box.low - rigid_.centre).cwiseAbs().cwiseMax((box.high - rigid_.centre).cwiseAbs()).norm();
  }

  /// A box, and a box of the ends of all points that may pass through it: points hardly move farther than the particles that hold them.
  struct Passage {
    Bounds<3> box, ends;
  };
  Passage passage(const Bounds<3>& box) {
    constexpr float kRounding = 1e-5f;  // of the sums that make up a point
    const Vector3f farthest = body_.box.low.cwiseAbs().cwiseMax(body_.box.high.cwiseAbs());
    const Vector3f reach = 2 * cells_.boxes().longest_way() + kRounding * farthest;
    return {box, {box.low - reach, box.high + reach}};
  }

  /// Calls work(point, from, to) for those of a cell's points on the drawn surface, or inside, that may pass through the box.
  template <typename Work>
  void for_each_point_in(const Passage& passage, std::uint32_t cell, const Work& work) const {
    const ContactModel& model = *body_.model;
    const Bounds<3>& box = passage.box;
    for (std::uint32_t i = model.first_of_cell[cell]; i < model.first_of_cell[cell + 1]; ++i) {
      const TouchPoint& point = model.touch_points[i];
      if (point.allowance > 0) continue;
      const Vector3f to = point.anchor.of(body_.ends);
      if (!contains(passage.ends, to)) continue;  // decided without looking where it begins
      const Vector3f from = point.anchor.of(body_.positions);
      if ((from.cwiseMax(to).array() < box.low.array()).any() ||
          (from.cwiseMin(to).array() > box.high.array()).any())
        continue;
      work(point, from, to);
    }
  }

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

  PointWay way_of(const Vector3f& from, const Vector3f& to) const {
    const Vector3f carried = step_ * rigid_.velocity_at(to);
    return {obstacle_.to_own(from), obstacle_.to_own(to - carried)};
  }

  /// On which side of a triangle the body is, judged by a point that may have been pressed through: above 0 in front. 0: the point is far
  /// from the triangle before and after the substep, or passes beside it.
  float side_of(const KnownTriangles& triangles, const EndCells::PointAtTriangle& near) const {
    const ObstacleTriangle triangle(obstacle_, triangles, near.triangle);
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
  int vote_of(const KnownTriangles& triangles, const EndCells::PointAtTriangle& near, int known) const {
    const float side = side_of(triangles, near);
    const float clear = (static_cast<float>(known) * side < 0 ? kDoubtfulSide : kClearSide) * body_.spacing();
    return side > clear ? 1 : side < -clear ? -1 : 0;
  }

  /// Finds out on which side of near triangles the body is. A mesh may be wound either way, closed around a solid or around a room: the
  /// majority of its triangles tells. If some contradict, each sheet is judged by itself: a wall may face away from a body on the floor.
  void find_fronts(const KnownTriangles& triangles) {
    if (obstacle_.faces_bodies || cells_.near_triangles.empty()) return;
    const int known = known_side();
    int for_front = 0, for_back = 0;
    for (const EndCells::PointAtTriangle& near : cells_.near_triangles) {
      const int vote = vote_of(triangles, near, known);
      for_front += vote > 0 ? 1 : 0;
      for_back += vote < 0 ? 1 : 0;
    }
    const float front = body_.sides->side_of(rigid_.number, obstacle_.part, for_front - for_back);
    for (EndCells::PointAtTriangle& near : cells_.near_triangles) near.front = front;
    const bool contradicted = front > 0 ? for_back > 0 : for_front > 0;
    if (contradicted || body_.sides->knows_sheets(rigid_.number, obstacle_.part))
      find_fronts_of_sheets(triangles);
  }

  void find_fronts_of_sheets(const KnownTriangles& triangles) {
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
      sheet_of(near)->seen += vote_of(triangles, near, known);
    for (KnownSides::SheetSeen& sheet : sheets) {
      const float front = body_.sides->side_of_sheet(rigid_.number, obstacle_.part, obstacle_.triangles,
                                                     cells_.sheets, sheet);
      for (EndCells::PointAtTriangle& near : cells_.near_triangles)
        if (cells_.sheets.of(near.triangle) == sheet.sheet) near.front = front;
    }
  }

  /// Points only meet the triangles near their motion.
  void find_with_triangles(const KnownTriangles& triangles) {
    // The same as bounds(), but faster.
    const float reach =
        come_near(widened(to_world(obstacle_, triangles.boxes().bounds()), obstacle_.rounding));
    find_origin(triangles);
    find_near_triangles(triangles);
    find_fronts(triangles);
    for (const EndCells::PointAtTriangle& at : cells_.near_triangles)
      if (const auto hit =
              ObstacleTriangle(obstacle_, triangles, at.triangle)
                  .meet({at.from, at.to}, at.inside, body_.spacing(), at.front, at.point->allowance))
        add(at.point->anchor, at.point->anchor.of(body_.ends), *hit, hit->end - at.point->allowance);
    try_edges_of_triangles(triangles, reach);
  }

  /// Leaves out the far sides of plates. The body is in front of one side of a plate and behind the other. A point that has been pressed
  /// into the plate, or rests on it, would seem to have been pressed through the far side.
  /// @param begin  index of the first triangle of the last point
  void leave_out_far_sides(const KnownTriangles& triangles, std::size_t begin) {
    const auto near = std::span(cells_.near_triangles).subspan(begin);
    // If all face nearly the same way, as those of a ground do, none face each other.
    const auto is_alike = [&](const EndCells::PointAtTriangle& at) {
      const KnownTriangles::Face &first = triangles.face(near[0].triangle),
                                 &own = triangles.face(at.triangle);
      return first.area > 0 && own.area > 0 && first.normal.dot(own.normal) > kAlike;
    };
    if (near.empty() || std::ranges::all_of(near, is_alike)) return;
    for (EndCells::PointAtTriangle& far : near) {
      const ObstacleTriangle farther(obstacle_, triangles, far.triangle);
      if (!farther.has_area()) continue;
      for (const EndCells::PointAtTriangle& other : near) {
        const ObstacleTriangle nearer(obstacle_, triangles, other.triangle);
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

  /// Finds out whether the whole body, with all that is inside of it, has been pressed through triangles: small bodies can be. Then the
  /// last place that it reached without passing through one tells on which side it belongs.
  void find_origin(const KnownTriangles& triangles) {
    const auto middle_cell = static_cast<std::uint32_t>(body_.lattice().cells.size() / 2);
    const Vector3f middle = obstacle_.to_own(inner_place(*body_.model, middle_cell, body_.positions));
    KnownSides& sides = *body_.sides;
    const auto [last, last_middle] = track_of(triangles, middle);
    if (!is_any_near(triangles, last, middle))
      return sides.set_track(rigid_.number, obstacle_.part, {middle, middle});
    Vector3f safe = last;
    // If the body has been pressed through, its safe place follows it on the other side.
    const Vector3f here =
        is_crossed(triangles, last, middle) ? Vector3f(last + (middle - last_middle)) : middle;
    for (const Vector3f& place : {moved_off(triangles, here), here}) {
      if (is_crossed(triangles, last, place)) continue;
      safe = place;
      break;
    }
    if (is_crossed(triangles, safe, middle)) origin_ = safe;
    sides.set_track(rigid_.number, obstacle_.part, {safe, middle});
  }

  /// Whether a triangle may lie between two places, or moved_off() the second one. Most bodies are thicker than that: one look spares
  /// several.
  bool is_any_near(const KnownTriangles& triangles, const Vector3f& from, const Vector3f& to) const {
    bool any = false;
    for_each_triangle(triangles,
                      widened({from.cwiseMin(to), from.cwiseMax(to)}, kPressedThrough * body_.spacing()),
                      [&](std::uint32_t) { any = true; });
    return any;
  }

  KnownSides::Track track_of(const KnownTriangles& triangles, const Vector3f& middle) const {
    const auto known = body_.sides->track(rigid_.number, obstacle_.part);
    const auto& origin = body_.sides->origin();
    if (!origin) return known.value_or(KnownSides::Track{middle, middle});
    // A piece that has just broken off. The whole may have been pressed through where it was.
    const Vector3f near = obstacle_.to_own(*origin);
    return {known && is_crossed(triangles, known->safe, near) ? known->safe : near, middle};
  }

  /// A place beside triangles, moved off them: the middle of a thin body lies so near to what it slides on that it might be pressed through
  /// in the next substep.
  Vector3f moved_off(const KnownTriangles& triangles, const Vector3f& place) const {
    const float margin = kPressedThrough * body_.spacing();
    Vector3f moved = place;
    for_each_triangle(triangles, widened({place, place}, margin), [&](std::uint32_t number) {
      const ObstacleTriangle triangle(obstacle_, triangles, number);
      if (!triangle.has_area() || !triangle.is_over(moved, margin)) return;
      const float height = triangle.height(moved);
      if (std::abs(height) < margin) moved += ((height < 0 ? -margin : margin) - height) * triangle.normal();
    });
    return moved;
  }

  /// Whether the way from one place to another crosses a triangle.
  bool is_crossed(const KnownTriangles& triangles, const Vector3f& from, const Vector3f& to) const {
    bool crossed = false;
    for_each_triangle(triangles, {from.cwiseMin(to), from.cwiseMax(to)}, [&](std::uint32_t number) {
      const ObstacleTriangle triangle(obstacle_, triangles, number);
      if (!triangle.has_area() || !triangle.parts(from, to)) return;
      const float before = triangle.height(from), after = triangle.height(to);
      const Vector3f crossing = from + before / (before - after) * (to - from);
      crossed = crossed || triangle.is_over(crossing, kNear * body_.spacing());
    });
    return crossed;
  }

  /// For each point: triangles near its motion; if there are none, or its body is behind one of them, also those that it has been pressed
  /// through farther.
  void find_near_triangles(const KnownTriangles& triangles) {
    const float spacing = body_.spacing();
    // A point that has been pressed through a triangle may be this far behind it and still meets it.
    const Vector3f margin = Vector3f::Constant((kNear + kPressedThrough) * spacing + obstacle_.rounding);
    const Passage deep = passage(widened(near_, kPressedDeepest * spacing));
    // As far as it is known before the triangles are looked at.
    const float front = obstacle_.faces_bodies ? 1 : body_.sides->last_side_of(rigid_.number, obstacle_.part);
    cells_.near_triangles.clear();
    cells_.boxes().for_each_meeting(deep.box, [&](std::uint32_t cell) {
      const Vector3f inner = inner_place(*body_.model, cell, body_.positions);
      const Bounds<3> around = cells_.boxes().at(cell);
      if (!overlap(near_, Bounds<3>{around.low.cwiseMin(inner), around.high.cwiseMax(inner)})) return;
      const Vector3f inside = origin_ ? *origin_ : obstacle_.to_own(inner);
      for_each_point_outside(cell, [&](const TouchPoint& point, const Vector3f& from, const Vector3f& to) {
        if (!overlap(deep.box,
                     Bounds<3>{from.cwiseMin(to).cwiseMin(inner), from.cwiseMax(to).cwiseMax(inner)}))
          return;
        const PointWay way = way_of(from, to);
        add_between(triangles, {&point, 0, way.from, way.to, inside});
      });
      for_each_point_in(deep, cell, [&](const TouchPoint& point, const Vector3f& from, const Vector3f& to) {
        const PointWay way = way_of(from, to);
        EndCells::PointAtTriangle at{&point, 0, way.from, way.to, inside};
        const std::size_t first = cells_.near_triangles.size();
        bool is_any_near = false, is_behind_any = false;
        for_each_triangle(triangles, {way.from.cwiseMin(way.to) - margin, way.from.cwiseMax(way.to) + margin},
                          [&](std::uint32_t triangle) {
                            is_any_near = true;
                            const ObstacleTriangle one(obstacle_, triangles, triangle);
                            if (!one.has_area()) return;
                            // It may be the far side of a plate whose near side is not near the point.
                            is_behind_any = is_behind_any || front * one.height(inside) < 0;
                            if (one.passes_beside(way, spacing)) return;
                            at.triangle = triangle;
                            cells_.near_triangles.push_back(at);
                          });
        if (!is_any_near || is_behind_any) add_pressed_through(triangles, at, first);
        leave_out_far_sides(triangles, first);
      });
    });
  }

  /// Calls work(triangle) for triangles whose boxes meet `box`.
  template <typename Work>
  static void for_each_triangle(const KnownTriangles& triangles, const Bounds<3>& box, const Work& work) {
    if (overlap(box, triangles.boxes().bounds())) triangles.boxes().for_each_meeting(box, work);
  }

  /// Adds triangles that separate a point outside of the drawn surface, however far, from the inside of its body.
  void add_between(const KnownTriangles& triangles, EndCells::PointAtTriangle at) {
    const Vector3f low = at.inside.cwiseMin(at.from).cwiseMin(at.to),
                   high = at.inside.cwiseMax(at.from).cwiseMax(at.to);
    const float squashed = kPressedThrough * body_.spacing();
    const float not_deep = at.point->allowance - kNear * body_.spacing() - obstacle_.rounding;
    const Vector3f margin = Vector3f::Constant(squashed);
    for_each_triangle(triangles, {low - margin, high + margin}, [&](std::uint32_t triangle) {
      const ObstacleTriangle one(obstacle_, triangles, triangle);
      if (std::abs(one.height(at.to)) < not_deep) return;
      if (std::abs(one.height(at.inside)) > squashed && !one.parts(at.from, at.inside) &&
          !one.parts(at.to, at.inside))
        return;
      at.triangle = triangle;
      cells_.near_triangles.push_back(at);
    });
  }

  /// Adds triangles that separate a point from the inside of its body, up to kPressedDeepest from the point.
  /// @param first  index of the point's first triangle in the list
  void add_pressed_through(const KnownTriangles& triangles, EndCells::PointAtTriangle at, std::size_t first) {
    const Vector3f inwards = at.inside - at.from;
    const float share = std::min(1.0f, kPressedDeepest * body_.spacing() / inwards.norm());
    const Vector3f deepest = at.from + share * inwards;
    const auto is_there = [&](std::uint32_t triangle) {
      return std::ranges::any_of(
          std::span(cells_.near_triangles).subspan(first),
          [&](const EndCells::PointAtTriangle& known) { return known.triangle == triangle; });
    };
    for_each_triangle(triangles, {at.from.cwiseMin(deepest), at.from.cwiseMax(deepest)},
                      [&](std::uint32_t triangle) {
                        if (!ObstacleTriangle(obstacle_, triangles, triangle).parts(at.from, at.inside) ||
                            is_there(triangle))
                          return;
                        at.triangle = triangle;
                        cells_.near_triangles.push_back(at);
                      });
  }

  void try_edges_of_triangles(const KnownTriangles& triangles, float reach) {
    if (triangles.has_long_edges()) try_long_edges(triangles, reach);
    const auto in_world = [&](const CornerSet::Point& corner) {
      return obstacle_.to_world({corner[0], corner[1], corner[2]});
    };
    // Sorted, so that the order does not depend on where the list of triangles begins.
    std::vector<CornerSet::Point>& near = cells_.near_corners;
    near.clear();
    for (const CornerSet::Point& corner : triangles.corners())
      if (may_be_in_body(in_world(corner))) near.push_back(corner);
    std::sort(near.begin(), near.end());
    for (const CornerSet::Point& corner : near) try_corner(in_world(corner), Vector3f::Zero(), 0);
  }

  void try_long_edges(const KnownTriangles& triangles, float reach) {
    triangles.boxes().for_each_block([&](std::size_t first, std::size_t end, const Bounds<3>& box) {
      if (!cells_.boxes().any_meets(widened(to_world(obstacle_, box), 2 * reach))) return;
      for (std::size_t edge = 3 * first; edge < 3 * end; ++edge)
        if (triangles.is_long(edge)) try_edge(obstacle_.edge(edge), reach);
    });
  }

  /// @param above  metres, of the point above the obstacle at the substep's end; hit.end, less the allowance if that counts in it
  void add(const Anchor& anchor, const Vector3f& point, const ObstacleHit& hit, float above) {
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

  /// Adds contacts for the points of the edge that are in the body.
  void try_edge(const ObstacleEdge& edge, float reach) {
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

  Vector3f moved(const Vector3f& point) const { return point + step_ * rigid_.velocity_at(point); }

  /// Rules out most points by a look at a few boxes.
  bool may_be_in_body(const Vector3f& point) const {
    return contains(where_edges_begin_, point) && cells_.finder().may_find(moved(point));
  }

  /// Triangles have been checked already, and round shapes have their edges inside.
  bool may_have_others_beside() const {
    return obstacle_.kind != ObstacleKind::kTriangles && obstacle_.rounding == 0 &&
           near_obstacles_.size() > 1;
  }

  /// Whether another shape lies behind a face. @param place  on the face, in the obstacle's frame
  bool is_covered(const Vector3f& place, const Vector3f& normal) {
    return may_have_others_beside() && cells_.beside.is_covered(place, normal);
  }

  bool is_within_a_floor(const Vector3f& corner, const Vector3f& along) {
    if (!may_have_others_beside()) return false;
    if (!along.isZero(0)) return cells_.beside.face_goes_on(corner, along);
    return body_.model->is_flat() && cells_.beside.face_goes_on(corner, Vector3f::UnitZ());
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

  /// From a point across the surface into its body: of unit length, in the obstacle's frame. 0: the surface is not flat there.
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

  /// @param along   the edge of the corner; 0: a tip, in two dimensions a corner
  /// @param radius  of the edge there, metres
  void try_corner(const Vector3f& corner, const Vector3f& along, float radius) {
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

  /// Where a corner that is at a place of the body at the substep's end is at its beginning: metres from the surface, below 0 inside. To go
  /// back from the end with the velocities leaves errors where the body bends, and what rests on it would tremble.
  /// @param normal  of the surface at the end   @return none: it moves far within the body, was near another face, or attachments hold the
  ///                body: what presses on it is solved with what holds it
  std::optional<float> distance_before(const DeformedPlace& place, const Vector3f& corner,
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

  const ContactBody& body_;
  EndCells& cells_;
  std::span<const Obstacle> obstacles_;
  std::span<const std::uint32_t> near_obstacles_;
  const Obstacle& obstacle_;
  const ContactRigid& rigid_;
  float friction_;
  float step_;
  std::vector<SoftContact>& contacts_;
  std::optional<Vector3f>
      origin_;                     // in the obstacle's frame, if the body has been pressed through as a whole
  Bounds<3> near_{};               // around the obstacle, as far as anything that moves may come from
  Bounds<3> where_edges_begin_{};  // of the obstacle that may be in the body at the substep's end
};

}  // namespace

void find_contacts(const ObstacleSearch& search, std::vector<SoftContact>& contacts) {
  for (const std::uint32_t obstacle : search.near) ObstacleContacts(search, obstacle, contacts).find();
}

}  // namespace softcell::ppu
