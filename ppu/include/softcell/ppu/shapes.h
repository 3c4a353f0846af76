#pragma once
// Procedural closed meshes, centred on 0, deterministic on every host (no libm in their coordinates).

#include "softcell/ppu/mesh.h"

namespace softcell::ppu {

/// A sphere of `radius` metres: a cube's six faces, each `subdivisions` squares a side, pushed onto the sphere.
TriangleMesh make_sphere(float radius, int subdivisions);

/// A torus about the y axis; `major` is the radius of the ring, `minor` that of the tube.
TriangleMesh make_torus(float major, float minor, int ring_segments, int tube_segments);

/// A box with the given edge lengths, each face divided into squares of about `step` metres. Corners are sharp.
TriangleMesh make_box(const Eigen::Vector3f& size, float step);

/// A bumper car `length` metres long (along x): a rounded hull with a bumper ring, a seat back, and a thin antenna at the
/// rear that is about as high as the car is long.
TriangleMesh make_car(float length);

}  // namespace softcell::ppu
