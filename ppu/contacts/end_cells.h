#pragma once
// Where the cells of a body end in the coming substep, for all who look for its contacts.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ppu/contacts/contact_body.h"
#include "ppu/obstacles/known_triangles.h"
#include "ppu/obstacles/side_by_side.h"
#include "ppu/obstacles/triangle_sheets.h"
#include "ppu/surfaces/cell_boxes.h"
#include "ppu/surfaces/cell_finder.h"

namespace softcell::ppu {

/// Search structures over the cells of a body at the substep's end, built on first use: most bodies need none.
class EndCells {
 public:
  void begin(const ContactBody& body) {
    body_ = &body, is_placed_ = has_boxes_ = false;
    seen_ = 0;
  }
  const CellFinder& finder() {
    if (!is_placed_) finder_.place(body_->lattice(), body_->ends);
    is_placed_ = true;
    return finder_;
  }
  /// Boxes around the cells' motion to their ends.
  const CellBoxes& boxes() {
    if (!has_boxes_) boxes_.place(body_->lattice(), body_->positions, body_->ends);
    has_boxes_ = true;
    return boxes_;
  }
  /// Call it for the first obstacle of triangles in a substep, then for the second and so on: each is likely to be the same as in the
  /// substep before.
  /// @param longest  as KnownTriangles::see() has it  @return valid until the next call
  const KnownTriangles& triangles(const Obstacle& obstacle, float longest) {
    if (seen_ == triangles_.size()) triangles_.emplace_back();
    KnownTriangles& known = triangles_[seen_++];
    known.see(obstacle, longest);
    return known;
  }

  /// A touch point and a triangle that it may meet, in the obstacle's frame.
  struct PointAtTriangle {
    const TouchPoint* point;
    std::uint32_t triangle;
    Eigen::Vector3f from, to;  ///< before and after the substep
    Eigen::Vector3f inside;    ///< a place well inside of the body near the point, before the substep
    bool is_far_side = false;  ///< on the far side of a plate; the plate's other side is nearer to the body
    float front = 1;  ///< 1: the body is on the side from which the triangle is wound counterclockwise; or -1
  };
  // Kept for the functions that find contacts with triangles, so that they do not allocate again and again.
  std::vector<CornerSet::Point> near_corners;
  std::vector<PointAtTriangle> near_triangles;
  TriangleSheets sheets;
  std::vector<KnownSides::SheetSeen> near_sheets;
  Beside beside;  // for the obstacle that is being looked at

 private:
  const ContactBody* body_ = nullptr;
  CellFinder finder_;
  CellBoxes boxes_;
  bool is_placed_ = false, has_boxes_ = false;
  std::vector<KnownTriangles> triangles_;
  std::size_t seen_ = 0;  // how many of these are used in this substep
};

}  // namespace softcell::ppu
