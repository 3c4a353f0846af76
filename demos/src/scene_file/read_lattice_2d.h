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
  /// @param source  must outlive this object
  explicit LatticeFiles(const SceneSource& source);

  /// The result is valid as long as this object. @throws SceneError
  const std::vector<Eigen::Vector2i>& cells(const std::string& file, const Location& location);
  /// @throws SceneError
  std::shared_ptr<const render::Image> picture(const std::string& file, const Location& location);

 private:
  const SceneSource& source_;
  double begin_;  // seconds of processor time that child processes had used when this object was made
  std::map<std::string, std::vector<Eigen::Vector2i>> known_;
  std::map<std::string, std::shared_ptr<const render::Image>> pictures_;
};

/// The user's own picture, which replaces what a body states.
struct OwnPicturePlace {
  const OwnPicture* picture = nullptr;  ///< null: the body keeps what it states
  float longest_side = 0;               ///< metres
};

/// Reads the cells of a 2D soft body: its field `rows`, a picture in text; `shape`, a primitive; `lattice`, a Lua file; or `image`, a
/// picture, with which the body is then drawn. These must be the last fields that are read of the body: any others that it has are refused.
/// @param body  gets its cells, its ring and its picture; with a picture also its cell size, if that is 0
/// @throws SceneError
void read_lattice_2d(FieldReader& fields, LatticeFiles& files, const OwnPicturePlace& own,
                     SoftBody2dPlacement& body);

}  // namespace softcell::demos
