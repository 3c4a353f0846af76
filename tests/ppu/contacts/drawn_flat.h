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

/// Where the drawn edge of a body is.
inline std::vector<Eigen::Vector2f> drawn_edge(const SoftBody<2>& body) {
  const Skin2d skin = make_skin_2d(body.model().lattice(), SoftBodyModel<2>::kContactRadiusInCells);
  std::vector<Eigen::Vector2f> positions(skin.rest.size()), slopes(skin.rest.size()), edge;
  deform(skin, body.positions(), positions, slopes);
  for (const auto& loop : skin.outlines)
    for (const std::uint32_t vertex : loop) edge.push_back(positions[vertex]);
  return edge;
}
inline float lowest(const SoftBody<2>& body) {
  const std::vector<Eigen::Vector2f> edge = drawn_edge(body);
  return std::ranges::min_element(edge, {}, [](const Eigen::Vector2f& at) { return at.y(); })->y();
}
inline float highest(const SoftBody<2>& body) {
  const std::vector<Eigen::Vector2f> edge = drawn_edge(body);
  return std::ranges::max_element(edge, {}, [](const Eigen::Vector2f& at) { return at.y(); })->y();
}

/// How deep in what is drawn a place is, in cells; below 0: outside.
inline float depth_in(const SoftBody<2>& body, const Eigen::Vector2f& place) {
  const float cell = body.model().lattice().spacing;
  Skin2d skin = make_skin_2d(body.model().lattice(), SoftBodyModel<2>::kContactRadiusInCells);
  std::vector<Eigen::Vector2f> positions(skin.rest.size()), slopes(skin.rest.size());
  deform(skin, body.positions(), positions, slopes);
  for (std::size_t i = 0; i < positions.size(); ++i) skin.rest[i] = positions[i] / cell;
  return -OutlineDistance(skin).signed_distance(place / cell);
}

}  // namespace softcell::ppu
