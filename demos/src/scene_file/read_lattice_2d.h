#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "field_reader.h"
#include "scene_source.h"

namespace softcell::demos {

/// The Lua files of a scene's lattices. Each runs once, however many bodies name it, and all of them together
/// for no longer than one script may (kLuaSeconds).
class LatticeFiles {
 public:
  /// The source must outlive it.
  explicit LatticeFiles(const SceneSource& source);

  /// Good as long as this is. @throws SceneError
  const std::vector<Eigen::Vector2i>& cells(const std::string& file, const Place& place);

 private:
  const SceneSource& source_;
  double begin_;  // seconds of processor time that child processes had needed
  std::map<std::string, std::vector<Eigen::Vector2i>> known_;
};

/// The cells of a 2D soft body: its field `rows`, a picture in text; `shape`, a primitive; or `lattice`, a
/// Lua file. These are the last fields that are read of the body: what else it has is refused.
/// @throws SceneError
std::vector<Eigen::Vector2i> read_lattice_2d(FieldReader& body, LatticeFiles& files);

}  // namespace softcell::demos
