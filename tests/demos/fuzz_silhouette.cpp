// Any bytes as a PNG picture for a soft body: it becomes cells within what a lattice may have and a whole sticker, or is
// refused. The first byte says how many cells there are.

#include <cstdlib>
#include <memory>
#include <span>
#include <stdexcept>
#include <utility>

#include "scene_file/picture_cells.h"
#include "softcell/render/png_io.h"
#include "softcell/soft_bodies/lattice.h"
#include "view/sticker.h"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace softcell;
  if (size == 0) return 0;
  const double count = 1 + data[0];
  try {
    render::Image image = demos::kept_picture(
        render::decode_picture(std::as_bytes(std::span(data, size).subspan(1)), "fuzz.png"));
    require(image.is_whole() && image.width <= demos::kMaxKeptSide && image.height <= demos::kMaxKeptSide);
    const auto kept = std::make_shared<const render::Image>(std::move(image));
    const demos::PictureCells made = demos::cells_of_picture(kept, count);
    require(!made.cells.empty() && made.picture.cell_pixels > 0 && made.picture.low.allFinite());
    for (const Eigen::Vector2i& cell : made.cells)
      require(cell.minCoeff() >= 0 && cell.maxCoeff() < ppu::kMaxLatticeCellsPerAxis);
    if (kept->width * kept->height <= 64 * 64) {
      const demos::Sticker sticker = demos::make_sticker(*kept, 0.5f * made.picture.cell_pixels);
      require(sticker.image.is_whole() && sticker.has_something({0, 0}, {1e6f, 1e6f}));
    }
  } catch (const std::runtime_error&) {
    // refused, as it may be
  }
  return 0;
}
