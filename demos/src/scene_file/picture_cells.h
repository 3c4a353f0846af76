#pragma once
// Makes the cells of a soft body in two dimensions from the silhouette of a picture.

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <vector>

#include "scene/scene_2d.h"
#include "softcell/render/image.h"

namespace softcell::demos {

/// The longest side of a picture that is kept; larger pictures are scaled down.
inline constexpr int kMaxKeptSide = 1024;  // pixels

/// Cells along the longest side of a picture's silhouette, unless the scene or the user states their number or size.
inline constexpr int kCellsAlongPicture = 20;

/// Reads a PNG file. @throws std::runtime_error  as render::read_picture()
std::shared_ptr<const render::Image> load_picture(const std::filesystem::path& path);

/// The picture itself, or the picture scaled down by a whole factor to at most kMaxKeptSide pixels a side.
render::Image kept_picture(render::Image picture);

struct PictureCells {
  std::vector<Eigen::Vector2i> cells;  ///< grid indices
  Picture2d picture;                   ///< where the picture lies on the cells
};

/// A cell is in the body if at least half of it is silhouette, that is, if the picture's alpha is above half there. A part that is so thin
/// that no such cell is near takes the cells that it passes through. If the cells do not join pieces of the silhouette, these are pieces of
/// one body and move apart. Deterministic.
/// @param cells  along the longest side of the silhouette, above 0; need not be a whole number
/// @throws std::runtime_error  the picture is transparent, or would have more cells than a lattice along an axis.
PictureCells cells_of_picture(std::shared_ptr<const render::Image> image, double cells);

}  // namespace softcell::demos
