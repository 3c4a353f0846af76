#pragma once
// The cells of a soft body in two dimensions from a picture's silhouette.

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <vector>

#include "scene/scene_2d.h"
#include "softcell/render/image.h"

namespace softcell::demos {

/// A picture as it is kept: longer ones are made smaller.
inline constexpr int kMaxKeptSide = 1024;  // pixels

/// Cells along the longest side of a picture's silhouette, where nobody says how many or how large.
inline constexpr int kCellsAlongPicture = 20;

/// Reads a PNG file. @throws std::runtime_error  as render::read_picture()
std::shared_ptr<const render::Image> load_picture(const std::filesystem::path& path);

/// The picture, or one that is smaller by a whole factor and has at most kMaxKeptSide pixels a side.
render::Image kept_picture(render::Image picture);

struct PictureCells {
  std::vector<Eigen::Vector2i> cells;  ///< grid indices
  Picture2d picture;                   ///< where it lies on them
};

/// A cell is in the body if at least half of it is silhouette: where the picture's alpha is above half. A part that is
/// so thin that no such cell is near takes the cells that it passes through. Pieces of a silhouette that no cells join
/// are pieces of one body and move apart. Deterministic.
/// @param cells  along the longest side of the silhouette, above 0; not necessarily a whole number
/// @throws std::runtime_error  the picture is transparent, or would have more cells than a lattice along an axis.
PictureCells cells_of_picture(std::shared_ptr<const render::Image> image, double cells);

}  // namespace softcell::demos
