#pragma once
// Where a picture of a scene in three dimensions can differ from the last one: only that part is drawn again.

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

  /// What the frame shows apart from its skinned meshes and lattices.
  struct Extents {
    std::span<const Box> soft_bodies;           ///< around each skinned mesh as it is drawn now, metres
    std::span<const Box> static_meshes;         ///< around each static mesh in its own frame
    int picture_width = 0, picture_height = 0;  ///< pixels, above 0
  };

  /// The part of the picture in which something has moved since the last call, or its shadow; empty if nothing has.
  /// None if everything may differ: at first, and when the camera, the light or the number of things is another one.
  /// Soft bodies and lattices always count as moving.
  std::optional<render::PixelRect> since_last(const render::FrameDescription& frame, const Extents& extents);

  /// The next call has nothing to compare with.
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
