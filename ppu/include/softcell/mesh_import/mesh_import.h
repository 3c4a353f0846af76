#pragma once
// Reads triangle meshes from files.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "softcell/soft_bodies/mesh.h"

namespace softcell::ppu {

/// What import_mesh() reports besides the mesh.
struct ImportReport {
  /// What the file contains but import_mesh() does not read, to be printed after "not read: ": "animations", "the picture 'bark.webp',
  /// which is neither PNG nor JPEG". Empty: everything was read.
  std::vector<std::string> not_read;
  /// The files that were read: the mesh's own, its material library, buffers and pictures.
  std::vector<std::filesystem::path> files;
};

/// Reads a glTF 2.0 (.gltf, .glb), OBJ, PLY or STL file (by its extension). Positions that are equal are joined;
/// normals are taken from the file or made, smooth up to a crease. A position whose corners have several normals,
/// texture coordinates or colours becomes as many vertices. Any thread.
///
/// Besides positions and normals it keeps:
/// - glTF: the objects of the scene at their nodes' places, materials with their pictures (PNG, JPEG), one set of
///   texture coordinates, vertex colours. Animations, skins, morph targets and most extensions are not read.
/// - OBJ: objects, groups, texture coordinates, vertex colours, and the statements Kd, map_Kd, d, Tr, Pr, Pm and norm of the
///   material library, with their pictures.
/// - PLY: texture coordinates, vertex colours. STL: solids (text), colours of triangles (binary).
///
/// Other files that the mesh's file names (buffers, material library, pictures) are opened only if they lie in its folder or below, after
/// links are followed. The material library and pictures may be missing.
/// @param report  receives what was not read; may be null
/// @throws std::runtime_error  one sentence that names the file and what is wrong with it: there is no such file, the format is unknown,
/// the file, or one that it names, is not valid in its format, it has no triangles or more than 4 million, its pictures have more than 64
/// million pixels, a coordinate is NaN or infinite, an index is out of range, or it requires a glTF extension that softcell does not read.
TriangleMesh import_mesh(const std::filesystem::path& path, ImportReport* report = nullptr);

/// The same for a file in memory, which can name no other files.
/// @param name  a name for error messages, whose extension tells the format: "crate.glb"
TriangleMesh import_mesh(std::span<const std::byte> bytes, const std::filesystem::path& name,
                         ImportReport* report = nullptr);

}  // namespace softcell::ppu
