#pragma once
// The three checks behind check_mesh_file(); see there.

#include <string>
#include <string_view>

#include "ppu/mesh_import/mesh_file_check.h"

namespace softcell::ppu {

MeshFileContents check_obj(std::string_view bytes);
MeshFileContents check_ply(std::string_view bytes);
MeshFileContents check_stl(std::string_view bytes);

/// Counts one face. @throws std::runtime_error  too few or too many corners, or triangles in all; `where`
/// goes before it.
void add_polygon(MeshFileContents& contents, std::size_t corners, const std::string& where);

/// Says which object and material the triangles have that were counted since the last call; call it after
/// each polygon. @throws std::runtime_error  too many parts.
void extend_parts(MeshFileContents& contents, const std::string& object, const std::string& material);

}  // namespace softcell::ppu
