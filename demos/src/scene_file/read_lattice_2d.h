#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "document/field_reader.h"
#include "scene/scene_2d.h"
#include "scene_library.h"
#include "scene_source.h"

namespace softcell::demos {

/// The Lua files of a scene's lattices, and its pictures. Each is read once, however many bodies name it, and all Lua
/// files together run for no longer than one script may (kLuaSeconds).
class LatticeFiles {
 public:
  /// The source must outlive it.
  explicit LatticeFiles(const SceneSource& source);

  /// Good as long as this is. @throws SceneError
  const std::vector<Eigen::Vector2i>& cells(const std::string& file, const Place& place);
  /// @throws SceneError
  std::shared_ptr<const render::Image> picture(const std::string& file, const Place& place);

 private:
  const SceneSource& source_;
  double begin_;  // seconds of processor time that child processes had needed
  std::map<std::string, std::vector<Eigen::Vector2i>> known_;
  std::map<std::string, std::shared_ptr<const render::Image>> pictures_;
};

/// Takes the place of what a body states: the user's own picture.
struct OwnPicturePlace {
  const OwnPicture* picture = nullptr;  ///< null: what the body states counts
  float longest_side = 0;               ///< metres
};

/// The cells of a 2D soft body: its field `rows`, a picture in text; `shape`, a primitive; `lattice`, a Lua file; or
/// `image`, a picture, which the body is then drawn with. These are the last fields that are read of the body: what else
/// it has is refused.
/// @param body  its cells, its ring and its picture are set; for a picture its cell size, if it is 0
/// @throws SceneError
void read_lattice_2d(FieldReader& fields, LatticeFiles& files, const OwnPicturePlace& own,
                     SoftBody2dPlacement& body);

}  // namespace softcell::demos
