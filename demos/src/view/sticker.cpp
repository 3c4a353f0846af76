#include "sticker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "softcell/base/assert.h"

namespace softcell::demos {
namespace {

/// For each place on a line the least sum of `line` elsewhere and the squared distance to there, which is the lower envelope of parabolas
/// (P. Felzenszwalb, D. Huttenlocher, Distance Transforms of Sampled Functions, 2012).
class LineDistances {
 public:
  void run(std::vector<float>& line) {
    const auto n = static_cast<int>(line.size());
    at_.resize(line.size());
    from_.resize(line.size() + 1);
    result_.resize(line.size());
    int count = 0;
    for (int q = 0; q < n; ++q) {
      const float value = line[static_cast<std::size_t>(q)];
      if (value == kFar) continue;
      float begins = -kFar;
      while (count > 0) {
        const int p = at_[static_cast<std::size_t>(count - 1)];
        const auto x = static_cast<float>(q), y = static_cast<float>(p);
        begins = ((value + x * x) - (line[static_cast<std::size_t>(p)] + y * y)) / (2 * (x - y));
        if (begins > from_[static_cast<std::size_t>(count - 1)]) break;
        --count;
        begins = -kFar;
      }
      at_[static_cast<std::size_t>(count)] = q;
      from_[static_cast<std::size_t>(count)] = begins;
      ++count;
    }
    int k = 0;
    for (int q = 0; q < n; ++q) {
      if (count == 0) return;  // `line` is infinite everywhere
      while (k + 1 < count && from_[static_cast<std::size_t>(k + 1)] < static_cast<float>(q)) ++k;
      const auto away = static_cast<float>(q - at_[static_cast<std::size_t>(k)]);
      result_[static_cast<std::size_t>(q)] =
          away * away + line[static_cast<std::size_t>(at_[static_cast<std::size_t>(k)])];
    }
    line.swap(result_);
  }

  static constexpr float kFar = std::numeric_limits<float>::infinity();

 private:
  std::vector<int> at_;
  std::vector<float> from_, result_;
};

/// For each pixel the distance of its centre to the centre of the nearest pixel with an alpha above half.
std::vector<float> distances(const render::Image& image) {
  const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
  std::vector<float> field(width * height);
  for (std::size_t i = 0; i < field.size(); ++i)
    field[i] = image.rgba[4 * i + 3] > 127 ? 0 : LineDistances::kFar;
  LineDistances lines;
  std::vector<float> line;
  const auto transform = [&](std::size_t first, std::size_t step, std::size_t count) {
    line.resize(count);
    for (std::size_t i = 0; i < count; ++i) line[i] = field[first + i * step];
    lines.run(line);
    for (std::size_t i = 0; i < count; ++i) field[first + i * step] = line[i];
  };
  for (std::size_t x = 0; x < width; ++x) transform(x, width, height);
  for (std::size_t y = 0; y < height; ++y) transform(y * width, 1, width);
  for (float& value : field) value = std::sqrt(value);
  return field;
}

}  // namespace

bool Sticker::has_something(const Eigen::Vector2f& low, const Eigen::Vector2f& high) const {
  const auto pixel = [](float at, int side) {
    return static_cast<int>(std::clamp(at, 0.0f, static_cast<float>(side)));
  };
  const int left = pixel(std::floor(low.x()), image.width), right = pixel(std::ceil(high.x()), image.width);
  const int bottom = pixel(std::floor(low.y()), image.height), top = pixel(std::ceil(high.y()), image.height);
  for (int y = bottom; y < top; ++y) {
    for (int x = left; x < right; ++x) {
      if (image.pixel(x, image.height - 1 - y)[3] != 0) return true;
    }
  }
  return false;
}

Sticker make_sticker(const render::Image& picture, float border) {
  SC_ASSERT(picture.is_whole() && picture.width > 0 && picture.height > 0, "a picture of {} by {} pixels",
            picture.width, picture.height);
  SC_ASSERT(border >= 0, "a border of {} pixels", border);
  constexpr int kFineSide = 512;  // pixels: enough for a border with a smooth edge
  Sticker sticker;
  const int longest = std::max(picture.width, picture.height);
  sticker.scale = std::max((kFineSide + longest - 1) / longest, 1);
  const float width = border * static_cast<float>(sticker.scale);
  sticker.border = static_cast<int>(std::ceil(width)) + 2;
  render::Image& image = sticker.image;
  image = render::Image(sticker.scale * picture.width + 2 * sticker.border,
                        sticker.scale * picture.height + 2 * sticker.border);
  std::fill(image.rgba.begin(), image.rgba.end(), std::uint8_t{255});
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 0;
  for (int y = 0; y < sticker.scale * picture.height; ++y) {
    for (int x = 0; x < sticker.scale * picture.width; ++x) {
      const std::uint8_t* const from = picture.pixel(x / sticker.scale, y / sticker.scale);
      std::uint8_t* const to = image.pixel(x + sticker.border, y + sticker.border);
      const int alpha = from[3];
      for (int c = 0; c < 3; ++c)
        to[c] = static_cast<std::uint8_t>((alpha * from[c] + (255 - alpha) * 255 + 127) / 255);
      to[3] = from[3];
    }
  }
  const std::vector<float> away = distances(image);
  for (std::size_t i = 0; i < away.size(); ++i)
    image.rgba[4 * i + 3] =
        static_cast<std::uint8_t>(255 * std::clamp(width + 1 - away[i], 0.0f, 1.0f) + 0.5f);
  return sticker;
}

}  // namespace softcell::demos
