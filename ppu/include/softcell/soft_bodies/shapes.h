#pragma once
// Procedural closed meshes, y up, deterministic on every host (no libm in their coordinates). Their boxes are centred on 0. The box of a
// cone, cylinder or torus is centred along x only if it has an even number of segments around y; its axis always is. Lengths are in metres,
// positive and finite; std::invalid_argument otherwise, and for counts outside of the stated ranges.

#include "softcell/soft_bodies/mesh.h"

namespace softcell::ppu {

/// A sphere of `radius` metres: six faces of a cube, each with `subdivisions` (1..512) squares per side, pushed onto the sphere.
TriangleMesh make_sphere(float radius, int subdivisions);

/// A torus about the y axis; `major` is the radius of the ring, `minor` that of the tube, which is less.
/// Both counts 3..2048.
TriangleMesh make_torus(float major, float minor, int ring_segments, int tube_segments);

/// A box with the given edge lengths, each face divided into squares of about `step` metres (at most
/// 1024 along an edge). Corners are sharp.
TriangleMesh make_box(const Eigen::Vector3f& size, float step);

/// A bumper car `length` metres long (along x): a rounded hull with a bumper ring, a seat back, and a thin
/// antenna at the rear that is about as high as the car is long.
TriangleMesh make_car(float length);

/// A penguin `height` metres high: a body, a head with a beak, two flippers and two feet. It looks towards
/// +z.
TriangleMesh make_penguin(float height);

// The sides of a cone, cylinder and capsule are triangles as long as the side. A soft body that is to bend needs them divided:
// tessellate.h.

/// A spike: a cone about the y axis, its tip up; `segments` 3..2048.
TriangleMesh make_cone(float radius, float height, int segments);

/// A post: a cylinder about the y axis; `segments` 3..2048.
TriangleMesh make_cylinder(float radius, float height, int segments);

/// A box with round edges and corners, a cushion: |x/a|^4 + |y/b|^4 + |z/c|^4 = 1 with half the edge lengths a, b, c;
/// `subdivisions` (1..512) squares along an edge.
TriangleMesh make_rounded_box(const Eigen::Vector3f& size, int subdivisions);

/// A capsule about the y axis: a cylinder of `radius` with half a sphere on each end, `height` metres in all, more than twice the
/// radius; `segments` around the axis 3..2048.
TriangleMesh make_capsule(float radius, float height, int segments);

/// A vase about the y axis with a wall a twelfth of its `height` (metres) thick, half as wide as high; `segments` 3..2048.
TriangleMesh make_vase(float height, int segments);

/// A ramp: a box without the half above its diagonal; it rises along x, from 0 at -x to the full height at +x.
TriangleMesh make_wedge(const Eigen::Vector3f& size);

/// The edges of two cells of `size` metres, side by side along x, as bars; in the first cell a ball, and the lines through it to the cell's
/// six sides. A lattice of cells of the same size has exactly these cells: it shows where a vertex in a cell goes when the cell's corners
/// move.
/// @param ball  its place, in shares of the cell; each 0.1 to 0.9
TriangleMesh make_marked_cells(float size, const Eigen::Vector3f& ball);

}  // namespace softcell::ppu
