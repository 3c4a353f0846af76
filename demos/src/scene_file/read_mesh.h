#pragma once

#include <Eigen/Geometry>

#include "document/field_reader.h"
#include "mesh_files.h"
#include "softcell/soft_bodies/mesh.h"

namespace softcell::demos {

/// Reads the field `rotation` of a body: a table of `axis` and `degrees`. @throws SceneError
Eigen::Quaternionf read_rotation(FieldReader& body);

/// Reads the mesh of a soft body or an obstacle: its field `shape`, a primitive, or `mesh`, a file, with `up`, `scale` or `longest_side`.
/// These must be the last fields that are read of the body: any others that it has are refused.
/// @throws SceneError
ppu::TriangleMesh read_mesh(FieldReader& body, MeshFiles& files);

/// Rotates a mesh about its origin, unless the rotation is the identity.
void rotate(ppu::TriangleMesh& mesh, const Eigen::Quaternionf& rotation);

}  // namespace softcell::demos
