#pragma once
// Finds the part of a picture of a scene in three dimensions that can differ from the last picture: only that part is redrawn.

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "softcell/render/frame.h"

namespace softcell::demos {

/// Used by one thread.
class Moved3d {
 public:
  using Box = Eigen::AlignedBox3f;

  /// The sizes of what the frame shows.
  struct Extents {
    std::span<const Box> soft_bodies;           ///< around each skinned mesh as it is drawn now, metres
    std::span<const Box> static_meshes;         ///< around each static mesh in its own frame
    int picture_width = 0, picture_height = 0;  ///< pixels, above 0
  };

  /// The part of the picture in which something, or its shadow, has moved since the last call; empty if nothing has. None if everything may
  /// differ: in the first call, and when the camera, the light or the number of things has changed. Soft bodies and lattices always count
  /// as moving.
  std::optional<render::PixelRect> since_last(const render::FrameDescription& frame, const Extents& extents);

  /// Makes the next call compare with nothing.
  void forget() { known_ = false; }

 private:
  bool known_ = false;
  render::Camera camera_;
  render::Light light_;
  int width_ = 0, height_ = 0;
  std::vector<Box> restless_, restless_now_;  // of soft bodies and lattices
  std::vector<Eigen::Matrix4f> poses_;
};

}  // namespace softcell::demos
