#pragma once
// What is drawn of soft bodies in two dimensions, for tests of contacts.

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "ppu/lattice/outline_distance.h"
#include "softcell/soft_bodies/skin_2d.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::ppu {

/// The drawn edge of a body. Making it takes a hundred times as long as looking at it: once for a body.
class DrawnFlat {
 public:
  explicit DrawnFlat(const SoftBody<2>& body)
      : body_(&body), skin_(make_skin_2d(body.model().lattice(), SoftBodyModel<2>::kContactRadiusInCells)) {}

  /// Where the edge is now.
  std::vector<Eigen::Vector2f> edge() const {
    const std::vector<Eigen::Vector2f> positions = deformed();
    std::vector<Eigen::Vector2f> edge;
    for (const auto& loop : skin_.outlines)
      for (const std::uint32_t vertex : loop) edge.push_back(positions[vertex]);
    return edge;
  }
  float lowest() const {
    const std::vector<Eigen::Vector2f> now = edge();
    return std::ranges::min_element(now, {}, [](const Eigen::Vector2f& at) { return at.y(); })->y();
  }
  float highest() const {
    const std::vector<Eigen::Vector2f> now = edge();
    return std::ranges::max_element(now, {}, [](const Eigen::Vector2f& at) { return at.y(); })->y();
  }

  /// How deep the deepest of some places is in it now, in cells; 0: all are outside.
  float depth(const std::vector<Eigen::Vector2f>& places) const {
    if (places.empty()) return 0;
    const float cell = body_->model().lattice().spacing;
    const std::vector<Eigen::Vector2f> positions = deformed();
    Skin2d now = skin_;
    for (std::size_t i = 0; i < positions.size(); ++i) now.rest[i] = positions[i] / cell;
    const OutlineDistance outline(now);
    float deepest = 0;
    for (const Eigen::Vector2f& place : places)
      deepest = std::max(deepest, -outline.signed_distance(place / cell));
    return deepest;
  }

 private:
  std::vector<Eigen::Vector2f> deformed() const {
    std::vector<Eigen::Vector2f> positions(skin_.rest.size()), slopes(skin_.rest.size());
    deform(skin_, body_->positions(), positions, slopes);
    return positions;
  }

  const SoftBody<2>* body_;
  Skin2d skin_;
};

inline float lowest(const SoftBody<2>& body) { return DrawnFlat(body).lowest(); }
inline float highest(const SoftBody<2>& body) { return DrawnFlat(body).highest(); }

}  // namespace softcell::ppu
