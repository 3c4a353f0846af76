#pragma once
// Gives round shapes and blunt hulls the edges that a body needs to feel them where they are thin.
//
// A body feels an obstacle with points of its own surface, some 0.45 cells apart. An obstacle that bulges between two of them by no more
// than a small part of a cell needs nothing else. A cylinder of smaller radius would pass between the points, so its axis is looked up in
// the body's field, as a capsule's is. A polyhedron that stands for a round shape has edges that a body of small cells need not look up.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "ppu/obstacles/obstacle.h"

namespace softcell::ppu {

/// The largest cells, metres, with which a body still feels an edge of a hull by points of its own.
/// @param edge    of the hull  @param planes  of its faces: outward unit normal, and distance from 0, metres
/// @return  0 if the edge is sharp
float cells_that_feel(const ObstacleEdge& edge, std::span<const Eigen::Vector4f> planes);

/// Appends the edges of a hull, each with the cells that feel it. An edge that gets sharper towards an end, as those of a cone do, is
/// appended in parts. Edges of a hull of more than some 100 corners are appended as they are, as the search would take too long.
void add_edges_of_hull(std::span<const ObstacleEdge> of_hull, std::span<const Eigen::Vector4f> planes,
                       std::vector<ObstacleEdge>& edges);

/// Appends a cylinder's axis, as far as balls around it lie within the cylinder. The cylinder is along y. Metres.
void add_axis_of_cylinder(float radius, float half_height, std::vector<ObstacleEdge>& edges);

/// Appends a cone's axis, its tip included, in parts that get thinner towards the tip. The cone is along y, its tip at +y. Metres.
void add_axis_of_cone(float radius, float half_height, std::vector<ObstacleEdge>& edges);

}  // namespace softcell::ppu
