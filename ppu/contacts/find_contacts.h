#pragma once
// Where bodies would enter something in the coming substep.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/contacts/contact_group.h"
#include "ppu/surfaces/cell_boxes.h"
#include "ppu/surfaces/cell_finder.h"
#include "ppu/surfaces/known_triangles.h"
#include "ppu/surfaces/side_by_side.h"

namespace softcell::ppu {

/// The cells of where a body will be, placed when somebody asks: most bodies need none.
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
  /// Around cells on their ways to where they will be.
  const CellBoxes& boxes() {
    if (!has_boxes_) boxes_.place(body_->lattice(), body_->positions, body_->ends);
    has_boxes_ = true;
    return boxes_;
  }
  /// The first obstacle of triangles in a substep, the second and so on: each is likely to be the one of the substep before.
  /// @param longest  as KnownTriangles::see() has it  @return valid until the next call
  const KnownTriangles& triangles(const Obstacle& obstacle, float longest) {
    if (seen_ == triangles_.size()) triangles_.emplace_back();
    KnownTriangles& known = triangles_[seen_++];
    known.see(obstacle, longest);
    return known;
  }

  /// A touch point and a triangle that it may meet; in the obstacle's frame.
  struct PointAtTriangle {
    const TouchPoint* point;
    std::uint32_t triangle;
    Eigen::Vector3f from, to;  ///< before and after the substep
    Eigen::Vector3f inside;    ///< a place well inside of the body near the point, before it
    bool is_far_side = false;  ///< of a plate whose other side is nearer to the body
  };
  // For those who look for contacts with triangles, again and again without allocating.
  std::vector<CornerSet::Point> near_corners;
  std::vector<PointAtTriangle> near_triangles;
  Beside beside;  // the obstacle that is looked at

 private:
  const ContactBody* body_ = nullptr;
  CellFinder finder_;
  CellBoxes boxes_;
  bool is_placed_ = false, has_boxes_ = false;
  std::vector<KnownTriangles> triangles_;
  std::size_t seen_ = 0;  // of these, in this substep
};

/// Points of the body's surface, and its particles, in an obstacle, and the obstacle's edges in the body.
/// Appends to `contacts`.
/// @param cells  the body's
/// @param near   the indices of the obstacles near the body, each of which is asked for once  @param obstacle  one of these
/// @param step   seconds
void find_contacts(const ContactBody& body, EndCells& cells, std::span<const Obstacle> obstacles,
                   std::span<const std::uint32_t> near, std::uint32_t obstacle,
                   std::span<const ContactRigid> rigids, float step, std::vector<SoftContact>& contacts);

/// Points of a's surface in b. Appends to `contacts`, as seen from a.
/// @param cells_of_a, cells_of_b  the bodies'
void find_contacts(const ContactBody& a, EndCells& cells_of_a, const ContactBody& b, EndCells& cells_of_b,
                   float step, std::vector<SoftContact>& contacts);

/// Whether a body may touch itself. Else it need not be asked for.
bool may_touch_itself(const ContactBody& body);

}  // namespace softcell::ppu
