#pragma once
// The three checks behind check_mesh_file(); see there.

#include <string>

#include "ppu/mesh_import/mesh_file_check.h"

namespace softcell::ppu {

MeshFileContents check_obj(std::string_view bytes);
MeshFileContents check_ply(std::string_view bytes);
MeshFileContents check_stl(std::string_view bytes);

/// Counts one face. @throws std::runtime_error  too few or too many corners, or triangles in all; `where`
/// goes before it.
void add_polygon(MeshFileContents& contents, std::size_t corners, const std::string& where);

}  // namespace softcell::ppu
