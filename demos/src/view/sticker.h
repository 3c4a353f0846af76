#pragma once
// A picture as a sticker: cut out along its silhouette, with a white border.

#include <Eigen/Core>

#include "softcell/render/image.h"

namespace softcell::demos {

struct Sticker {
  /// Opaque in the silhouette and its border, else transparent; white where nothing is painted.
  render::Image image;
  int scale = 1;   ///< its pixels along one of the picture: more than one where the picture is small
  int border = 0;  ///< its pixels before the picture's first, in both directions

  /// Whether anything is opaque in a rectangle: its corners in pixels from the lower left corner.
  bool has_something(const Eigen::Vector2f& low, const Eigen::Vector2f& high) const;
};

/// @param picture  what has an alpha above half is in the silhouette; not empty
/// @param border  width of the border, in the picture's pixels
Sticker make_sticker(const render::Image& picture, float border);

}  // namespace softcell::demos
