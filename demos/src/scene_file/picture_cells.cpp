#include "picture_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "softcell/base/assert.h"
#include "softcell/render/png_io.h"
#include "softcell/soft_bodies/lattice.h"

namespace softcell::demos {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;

/// Measures areas of a picture's silhouette, in pixels from the picture's lower left corner.
class Silhouette {
 public:
  explicit Silhouette(const render::Image& image)
      : width_(image.width),
        height_(image.height),
        sums_(static_cast<std::size_t>(width_ + 1) * static_cast<std::size_t>(height_ + 1)) {
    low_ = {width_, height_};
    high_ = {0, 0};
    for (int y = 0; y < height_; ++y) {
      std::uint32_t row = 0;
      for (int x = 0; x < width_; ++x) {
        const bool inside = image.pixel(x, height_ - 1 - y)[3] > 127;
        row += inside ? 1 : 0;
        sums_[slot(x + 1, y + 1)] = sums_[slot(x + 1, y)] + row;
        if (!inside) continue;
        low_ = low_.cwiseMin(Vector2i(x, y));
        high_ = high_.cwiseMax(Vector2i(x + 1, y + 1));
      }
    }
  }

  bool empty() const { return sums_.back() == 0; }
  const Vector2i& low() const { return low_; }    ///< corner of its box
  const Vector2i& high() const { return high_; }  ///< after its last pixel

  /// The number of its pixels in a rectangle, with fractions of pixels.
  double area(const Vector2d& low, const Vector2d& high) const {
    return sum(high.x(), high.y()) - sum(low.x(), high.y()) - sum(high.x(), low.y()) + sum(low.x(), low.y());
  }

 private:
  std::size_t slot(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_ + 1) + static_cast<std::size_t>(x);
  }
  /// The number of its pixels left of x and below y.
  double sum(double x, double y) const {
    x = std::clamp(x, 0.0, double(width_));
    y = std::clamp(y, 0.0, double(height_));
    const int left = std::min(static_cast<int>(x), width_ - 1),
              bottom = std::min(static_cast<int>(y), height_ - 1);
    const double u = x - left, v = y - bottom;
    return (1 - u) * (1 - v) * sums_[slot(left, bottom)] + u * (1 - v) * sums_[slot(left + 1, bottom)] +
           (1 - u) * v * sums_[slot(left, bottom + 1)] + u * v * sums_[slot(left + 1, bottom + 1)];
  }

  int width_, height_;
  Vector2i low_, high_;
  std::vector<std::uint32_t> sums_;  // for each corner, all pixels left of it and below it
};

/// Replaces each square of `factor` x `factor` pixels by its mean, weighted by alpha.
render::Image made_smaller(const render::Image& image, int factor) {
  render::Image smaller((image.width + factor - 1) / factor, (image.height + factor - 1) / factor);
  for (int y = 0; y < smaller.height; ++y) {
    for (int x = 0; x < smaller.width; ++x) {
      std::array<std::uint32_t, 4> sums{};
      std::uint32_t pixels = 0;  // fewer than `factor` squared at the picture's upper and right border
      for (int j = y * factor; j < std::min((y + 1) * factor, image.height); ++j) {
        for (int i = x * factor; i < std::min((x + 1) * factor, image.width); ++i) {
          const std::uint8_t* const pixel = image.pixel(i, j);
          for (std::size_t c = 0; c < 3; ++c) sums[c] += std::uint32_t{pixel[3]} * pixel[c];
          sums[3] += pixel[3];
          ++pixels;
        }
      }
      std::uint8_t* const to = smaller.pixel(x, y);
      for (std::size_t c = 0; c < 3 && sums[3] > 0; ++c)
        to[c] = static_cast<std::uint8_t>((sums[c] + sums[3] / 2) / sums[3]);
      to[3] = static_cast<std::uint8_t>(sums[3] / pixels);
    }
  }
  return smaller;
}

}  // namespace

render::Image kept_picture(render::Image picture) {
  SC_ASSERT(picture.is_whole(), "{} bytes for {} by {} pixels", picture.rgba.size(), picture.width,
            picture.height);
  const int longest = std::max(picture.width, picture.height);
  if (longest <= kMaxKeptSide) return picture;
  return made_smaller(picture, (longest + kMaxKeptSide - 1) / kMaxKeptSide);
}

std::shared_ptr<const render::Image> load_picture(const std::filesystem::path& path) {
  return std::make_shared<const render::Image>(kept_picture(render::read_picture(path)));
}

PictureCells cells_of_picture(std::shared_ptr<const render::Image> image, double cells) {
  SC_ASSERT(image != nullptr && cells > 0, "{} cells along a picture", cells);
  const Silhouette silhouette(*image);
  if (silhouette.empty())
    throw std::runtime_error("the picture is transparent: a body is where its alpha is above half");
  if (!(cells <= ppu::kMaxLatticeCellsPerAxis)) {
    throw std::runtime_error(
        fmt::format("the picture would be {:.4g} cells long; a body may be at most {} long", cells,
                    ppu::kMaxLatticeCellsPerAxis));
  }
  const Vector2d box = (silhouette.high() - silhouette.low()).cast<double>();
  const double cell = box.maxCoeff() / cells;  // pixels
  // Whole cells over the silhouette's box, which is in the middle of them.
  const Vector2i count(
      (box / cell - Vector2d::Constant(1e-6)).array().ceil().cwiseMax(1.0).matrix().cast<int>());
  const Vector2d low = silhouette.low().cast<double>() + (box - cell * count.cast<double>()) / 2;
  const auto share = [&](int x, int y) {
    const Vector2d from = low + cell * Vector2d(x, y);
    return silhouette.area(from, from + Vector2d::Constant(cell)) / (cell * cell);
  };
  constexpr double kHalf = 0.5, kSomething = 0.05;
  const auto slot = [&](int x, int y) {
    return static_cast<std::size_t>(x) * static_cast<std::size_t>(count.y()) + static_cast<std::size_t>(y);
  };
  std::vector<bool> taken(static_cast<std::size_t>(count.x()) * static_cast<std::size_t>(count.y()));
  for (int x = 0; x < count.x(); ++x) {
    for (int y = 0; y < count.y(); ++y) taken[slot(x, y)] = share(x, y) >= kHalf;
  }
  const auto is_near_taken = [&](int x, int y) {
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, count.x() - 1); ++i) {
      for (int j = std::max(y - 1, 0); j <= std::min(y + 1, count.y() - 1); ++j) {
        if (taken[slot(i, j)]) return true;
      }
    }
    return false;
  };
  PictureCells result;
  for (int x = 0; x < count.x(); ++x) {
    for (int y = 0; y < count.y(); ++y) {
      if (taken[slot(x, y)] || (!is_near_taken(x, y) && share(x, y) >= kSomething))
        result.cells.push_back({x, y});
    }
  }
  if (result.cells.empty()) {
    throw std::runtime_error(
        "the picture's silhouette is thinner than its cells everywhere: take smaller cells");
  }
  result.picture = {
      .image = std::move(image), .low = (-low / cell).cast<float>(), .cell_pixels = static_cast<float>(cell)};
  return result;
}

}  // namespace softcell::demos
