#pragma once
// What is round has no edges, and yet nothing else keeps it out of a body where it is thin.
//
// A body feels an obstacle with points of its own surface, some 0.45 cells apart. What bulges between two of them by no more than a small
// part of a cell needs nothing else. Of smaller radius, a cylinder would pass between the points: its axis is looked up in the body, as a
// capsule's is. A polyhedron that stands for something round has edges that are none to a body of small cells.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "ppu/surfaces/obstacle.h"

namespace softcell::ppu {

/// The largest cells, metres, of a body that feels an edge of a hull with points of its own.
/// @param edge    of the hull  @param planes  of its faces: outward unit normal, and distance from 0, metres
/// @return  0: the edge is sharp
float cells_that_feel(const ObstacleEdge& edge, std::span<const Eigen::Vector4f> planes);

/// Appends the edges of a hull, with the cells that feel them. One that gets sharper towards an end, as those of a cone do, in parts.
/// Of more than some 100 corners, where it would take too long, edges are appended as they are.
void add_edges_of_hull(std::span<const ObstacleEdge> of_hull, std::span<const Eigen::Vector4f> planes,
                       std::vector<ObstacleEdge>& edges);

/// Appends a cylinder's axis, so far as balls about it lie within. The cylinder is along y. Metres.
void add_axis_of_cylinder(float radius, float half_height, std::vector<ObstacleEdge>& edges);

/// Appends a cone's axis, its tip included, in parts that get thinner towards the tip. The cone is along y, its tip at + y. Metres.
void add_axis_of_cone(float radius, float half_height, std::vector<ObstacleEdge>& edges);

}  // namespace softcell::ppu
