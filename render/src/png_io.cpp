#include "softcell/render/png_io.h"

#include <png.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "softcell/base/assert.h"
#include "softcell/base/whole_file.h"

namespace softcell::render {
namespace {

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, FileCloser>;

/// The control block of libpng's simplified interface, freed in every case.
struct PngImage : png_image {
  PngImage() : png_image{} { version = PNG_IMAGE_VERSION; }
  ~PngImage() { png_image_free(this); }
  PngImage(const PngImage&) = delete;
  PngImage& operator=(const PngImage&) = delete;
};

std::string reason(int error_number) { return std::generic_category().message(error_number); }

[[noreturn]] void fail(const char* action, const std::filesystem::path& path, const std::string& why) {
  throw std::runtime_error(std::string("cannot ") + action + " " + path.string() + ": " + why);
}

bool is_opaque(const Image& image) {
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
    if (image.rgba[i] != 255) return false;
  }
  return true;
}

std::vector<std::uint8_t> without_alpha(const Image& image) {
  std::vector<std::uint8_t> rgb(image.rgba.size() / 4 * 3);
  for (std::size_t pixel = 0; pixel < image.rgba.size() / 4; ++pixel) {
    std::copy_n(&image.rgba[4 * pixel], 3, &rgb[3 * pixel]);
  }
  return rgb;
}

}  // namespace

void write_png(const std::filesystem::path& path, const Image& image, PngEffort effort) {
  if (image.width <= 0 || image.height <= 0) fail("write", path, "the picture is empty");

  SC_ASSERT(image.is_whole(), "{} bytes for {} by {} pixels, to {}", image.rgba.size(), image.width,
            image.height, path);
  PngImage png;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.flags = effort == PngEffort::fast ? PNG_IMAGE_FLAG_FAST : 0;
  const bool opaque = is_opaque(image);
  png.format = opaque ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
  const std::vector<std::uint8_t> rgb = opaque ? without_alpha(image) : std::vector<std::uint8_t>();

  base::WholeFile file(path);
  std::FILE* const stream = file.stream();
  errno = 0;
  const bool encoded =
      png_image_write_to_stdio(&png, stream, 0, opaque ? rgb.data() : image.rgba.data(), 0, nullptr) != 0;
  // The system's reason, if there is one, says more than libpng's "Write Error".
  if (!encoded) fail("write", path, errno != 0 ? reason(errno) : png.message);
  file.commit();
}

Image read_png(const std::filesystem::path& path) {
  const File file(std::fopen(path.c_str(), "rbe"));
  if (!file) fail("read", path, reason(errno));

  PngImage png;
  if (png_image_begin_read_from_stdio(&png, file.get()) == 0) fail("read", path, png.message);
  png.format = PNG_FORMAT_RGBA;
  constexpr png_uint_32 kMaxSide = 32768;  // keeps the size in bytes far from overflow
  if (png.width > kMaxSide || png.height > kMaxSide) fail("read", path, "more than 32768 pixels a side");
  Image image(static_cast<int>(png.width), static_cast<int>(png.height));
  if (png_image_finish_read(&png, nullptr, image.rgba.data(), 0, nullptr) == 0)
    fail("read", path, png.message);
  return image;
}

}  // namespace softcell::render
