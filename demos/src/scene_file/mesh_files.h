#pragma once
// The mesh files of one scene, each read once.

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "scene_source.h"
#include "softcell/mesh_import/mesh_import.h"
#include "softcell/soft_bodies/mesh.h"

namespace softcell::demos {

/// "mine.glb: not read: animations, skins". @pre something was not read
std::string not_read_of(const std::string& file, const ppu::ImportReport& report);

class MeshFiles {
 public:
  /// The limit on all pixels in the pictures of a scene's meshes: 512 MB.
  static constexpr std::size_t kMaxPixels = std::size_t{128} << 20;

  /// @param source  must outlive this object; it is told which files were read.
  explicit MeshFiles(const SceneSource& source) : source_(source) {}

  /// The mesh in a file that the scene names at `location`. Bodies that name the same file share its pictures.
  /// @throws SceneError  there is no such file, the scene may not name it, it is no mesh, or the scene has too many pixels.
  const ppu::TriangleMesh& mesh(const std::string& file, const Location& location);

  /// The parts of the meshes that were not read, one sentence for each file.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  const SceneSource& source_;
  std::map<std::string, ppu::TriangleMesh> meshes_;
  std::vector<std::string> notes_;
  std::size_t pixels_ = 0;
};

}  // namespace softcell::demos
