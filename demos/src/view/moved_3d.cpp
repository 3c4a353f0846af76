#include "moved_3d.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "softcell/base/assert.h"
#include "softcell/render/camera.h"

namespace softcell::demos {
namespace {

using Eigen::Vector3f;
using Box = Moved3d::Box;

constexpr int kEdge = 3;  // pixels around a box, for smoothing and rounding

bool is_same(const render::Camera& a, const render::Camera& b) {
  return a.eye == b.eye && a.target == b.target && a.up == b.up && a.tan_half_fov_y == b.tan_half_fov_y &&
         a.near_plane == b.near_plane && a.far_plane == b.far_plane;
}

bool is_same(const render::Light& a, const render::Light& b) {
  return a.toward == b.toward && a.colour == b.colour && a.sky == b.sky && a.ground == b.ground &&
         a.shadow_centre == b.shadow_centre && a.shadow_radius == b.shadow_radius &&
         a.occlusion == b.occlusion;
}

Box around(const Box& mesh, const Eigen::Matrix4f& pose) {
  Box box;
  if (mesh.isEmpty()) return box;
  for (int k = 0; k < 8; ++k)
    box.extend((pose * mesh.corner(static_cast<Box::CornerType>(k)).homogeneous()).head<3>());
  return box;
}

Box around(const render::LatticeDraw& lattice) {
  Box box;
  for (const Vector3f& particle : lattice.particles) box.extend(particle);
  if (box.isEmpty()) return box;
  const Vector3f reach = Vector3f::Constant(lattice.radius);
  return {box.min() - reach, box.max() + reach};
}

/// Collects the part of the picture that is covered by boxes and their shadows.
class Covered {
 public:
  /// @param lowest  height of the lowest thing that a shadow can fall on, metres
  Covered(const render::FrameDescription& frame, const Moved3d::Extents& extents, float lowest)
      : to_clip_(view_projection(frame.camera, static_cast<float>(extents.picture_width) /
                                                   static_cast<float>(extents.picture_height))),
        toward_light_(frame.light.toward.normalized()),
        longest_shadow_(2 * frame.light.shadow_radius),
        lowest_(lowest),
        width_(extents.picture_width),
        height_(extents.picture_height) {}

  void add(const Box& box) {
    if (box.isEmpty()) return;
    for (int k = 0; k < 8; ++k) {
      const Vector3f corner = box.corner(static_cast<Box::CornerType>(k));
      // A shadow ends below everything, or at the end of the sphere that the light shines on.
      const float fall = std::max(corner.y() - lowest_, 0.0f), slope = toward_light_.y();
      const float shadow = fall < longest_shadow_ * slope ? fall / slope : longest_shadow_;
      add(corner);
      add(corner - shadow * toward_light_);
    }
  }

  std::optional<render::PixelRect> rectangle() const {
    if (everything_) return std::nullopt;
    if (pixels_.isEmpty()) return render::PixelRect{};
    const auto at = [](float value, int side) {  // keeps what is far outside within the range of int
      return static_cast<int>(std::floor(std::clamp(value, -1.0f, static_cast<float>(side) + 1)));
    };
    return render::PixelRect{.left = at(pixels_.min().x(), width_) - kEdge,
                             .top = at(pixels_.min().y(), height_) - kEdge,
                             .right = at(pixels_.max().x(), width_) + 1 + kEdge,
                             .bottom = at(pixels_.max().y(), height_) + 1 + kEdge};
  }

 private:
  void add(const Vector3f& point) {
    const Eigen::Vector4f clip = to_clip_ * point.homogeneous();
    if (!(clip.w() > 1e-3f)) {  // behind the eye, as seen from within its box, or NaN
      everything_ = true;
      return;
    }
    pixels_.extend(Eigen::Vector2f(0.5f * static_cast<float>(width_) * (1 + clip.x() / clip.w()),
                                   0.5f * static_cast<float>(height_) * (1 - clip.y() / clip.w())));
  }

  Eigen::Matrix4f to_clip_;
  Vector3f toward_light_;
  float longest_shadow_, lowest_;
  int width_, height_;
  Eigen::AlignedBox2f pixels_;
  bool everything_ = false;
};

}  // namespace

std::optional<render::PixelRect> Moved3d::since_last(const render::FrameDescription& frame,
                                                     const Extents& extents) {
  SC_ASSERT(extents.static_meshes.size() == frame.statics.size(), "boxes around {} of {} static meshes",
            extents.static_meshes.size(), frame.statics.size());
  SC_ASSERT(extents.picture_width > 0 && extents.picture_height > 0, "a picture of {} by {} pixels",
            extents.picture_width, extents.picture_height);
  restless_now_.assign(extents.soft_bodies.begin(), extents.soft_bodies.end());
  for (const render::LatticeDraw& lattice : frame.lattices) restless_now_.push_back(around(lattice));
  const bool comparable = known_ && is_same(camera_, frame.camera) && is_same(light_, frame.light) &&
                          width_ == extents.picture_width && height_ == extents.picture_height &&
                          poses_.size() == frame.statics.size() && restless_.size() == restless_now_.size();
  std::optional<render::PixelRect> part;
  if (comparable) {
    Box all;
    for (const Box& box : restless_now_) all.extend(box);
    for (std::size_t i = 0; i < poses_.size(); ++i)
      all.extend(around(extents.static_meshes[i], frame.statics[i].pose));
    Covered covered(frame, extents, all.isEmpty() ? 0 : all.min().y());
    for (std::size_t i = 0; i < restless_.size(); ++i) {
      covered.add(restless_[i]);
      covered.add(restless_now_[i]);
    }
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      if (poses_[i] == frame.statics[i].pose) continue;
      covered.add(around(extents.static_meshes[i], poses_[i]));
      covered.add(around(extents.static_meshes[i], frame.statics[i].pose));
    }
    part = covered.rectangle();
  }
  known_ = true;
  camera_ = frame.camera;
  light_ = frame.light;
  width_ = extents.picture_width;
  height_ = extents.picture_height;
  std::swap(restless_, restless_now_);
  poses_.clear();
  for (const render::StaticDraw& item : frame.statics) poses_.push_back(item.pose);
  return part;
}

}  // namespace softcell::demos
