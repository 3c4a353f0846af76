#pragma once
// A picture as a sticker: cut out along its silhouette, with a white border.

#include <Eigen/Core>

#include "softcell/render/image.h"

namespace softcell::demos {

struct Sticker {
  /// Opaque in the silhouette and its border, transparent elsewhere; white where nothing is painted.
  render::Image image;
  int scale = 1;   ///< its pixels per pixel of the picture: more than one if the picture is small
  int border = 0;  ///< its pixels before the picture's first one, in both directions

  /// Whether anything in a rectangle is opaque. @param low, high  corners in pixels from the lower left corner
  bool has_something(const Eigen::Vector2f& low, const Eigen::Vector2f& high) const;
};

/// @param picture  its silhouette is where its alpha is above half; not empty
/// @param border  width of the border, in the picture's pixels
Sticker make_sticker(const render::Image& picture, float border);

}  // namespace softcell::demos
