#include "softcell/render/png_io.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "softcell/base/assert.h"
#include "softcell/base/read_file.h"
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

/// libpng's last error.
using Message = std::array<char, 200>;

[[noreturn]] void on_error(png_structp png, png_const_charp what) {
  auto& message = *static_cast<Message*>(png_get_error_ptr(png));
  std::snprintf(message.data(), message.size(), "%s", what);
  png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

struct Encoding {
  const Image* image;
  PngEffort effort;
  std::vector<png_text> texts;
  std::vector<std::uint8_t> rgb;  ///< of an opaque picture
  std::vector<png_bytep> rows;
};

/// They refer to `texts`.
std::vector<png_text> text_chunks(std::span<const PngText> texts) {
  std::vector<png_text> chunks;
  for (const PngText& text : texts) {
    SC_ASSERT(!text.keyword.empty() && text.keyword.size() < 80, "a PNG keyword of {} letters",
              text.keyword.size());
    const bool ascii = std::all_of(text.text.begin(), text.text.end(),
                                   [](char c) { return static_cast<signed char>(c) > 0; });
    png_text& chunk = chunks.emplace_back(png_text{});
    chunk.compression = ascii ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
    chunk.key = const_cast<char*>(text.keyword.c_str());
    chunk.text = const_cast<char*>(text.text.c_str());
    chunk.text_length = ascii ? text.text.size() : 0;
    chunk.itxt_length = ascii ? 0 : text.text.size();
    if (!ascii) chunk.lang = chunk.lang_key = const_cast<char*>("");
  }
  return chunks;
}

/// Errors of libpng jump over it: nothing here has a destructor.
bool encode(const Encoding& encoding, std::FILE* stream, Message& message) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &message, on_error, on_warning);
  if (png == nullptr) return false;
  png_infop info = png_create_info_struct(png);
  if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_init_io(png, stream);
  png_set_IHDR(png, info, static_cast<png_uint_32>(encoding.image->width),
               static_cast<png_uint_32>(encoding.image->height), 8,
               encoding.rgb.empty() ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  if (encoding.effort == PngEffort::kFast) {
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_NO_FILTERS);
    png_set_compression_level(png, 3);
  }
  if (!encoding.texts.empty())
    png_set_text(png, info, encoding.texts.data(), static_cast<int>(encoding.texts.size()));
  png_write_info(png, info);
  png_write_image(png, const_cast<png_bytepp>(encoding.rows.data()));
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return true;
}

/// Appends a picture's texts. Errors of libpng jump over it, as over encode(): `texts` belongs to the caller.
bool collect_texts(std::FILE* stream, std::vector<PngText>& texts, Message& message) {
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &message, on_error, on_warning);
  if (png == nullptr) return false;
  png_infop info = png_create_info_struct(png);
  if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_read_struct(&png, &info, nullptr);
    return false;
  }
  png_init_io(png, stream);
  png_read_info(png, info);
  png_textp chunks = nullptr;
  int count = 0;
  png_get_text(png, info, &chunks, &count);
  for (int i = 0; i < count; ++i) texts.push_back({chunks[i].key, chunks[i].text});
  png_destroy_read_struct(&png, &info, nullptr);
  return true;
}

}  // namespace

void write_png(const std::filesystem::path& path, const Image& image, PngEffort effort,
               std::span<const PngText> texts) {
  if (image.width <= 0 || image.height <= 0) fail("write", path, "the picture is empty");
  SC_ASSERT(image.is_whole(), "{} bytes for {} by {} pixels, to {}", image.rgba.size(), image.width,
            image.height, path);
  base::WholeFile file(path);
  const bool opaque = is_opaque(image);
  Encoding encoding{.image = &image,
                    .effort = effort,
                    .texts = text_chunks(texts),
                    .rgb = opaque ? without_alpha(image) : std::vector<std::uint8_t>(),
                    .rows = {}};
  const std::uint8_t* const pixels = opaque ? encoding.rgb.data() : image.rgba.data();
  const std::size_t row_bytes = std::size_t{opaque ? 3u : 4u} * static_cast<std::size_t>(image.width);
  for (int y = 0; y < image.height; ++y)
    encoding.rows.push_back(const_cast<png_bytep>(pixels + static_cast<std::size_t>(y) * row_bytes));
  std::FILE* const stream = file.stream();
  errno = 0;
  Message message{};
  // The system's reason, if there is one, says more than libpng's "Write Error".
  if (!encode(encoding, stream, message)) fail("write", path, errno != 0 ? reason(errno) : message.data());
  file.commit();
}

std::vector<PngText> read_png_texts(const std::filesystem::path& path) {
  const File file(std::fopen(path.c_str(), "rbe"));
  if (!file) fail("read", path, reason(errno));
  std::vector<PngText> texts;
  Message message{};
  if (!collect_texts(file.get(), texts, message)) fail("read", path, message.data());
  return texts;
}

Image decode_picture(std::span<const std::byte> file, const std::string& name) {
  PngImage png;
  if (png_image_begin_read_from_memory(&png, file.data(), file.size()) == 0) fail("read", name, png.message);
  png.format = PNG_FORMAT_RGBA;
  if (png.width > kMaxPictureSide || png.height > kMaxPictureSide) {
    fail("read", name,
         "it has " + std::to_string(png.width) + " by " + std::to_string(png.height) +
             " pixels; a picture may have at most " + std::to_string(kMaxPictureSide) + " a side");
  }
  Image image(static_cast<int>(png.width), static_cast<int>(png.height));
  if (png_image_finish_read(&png, nullptr, image.rgba.data(), 0, nullptr) == 0)
    fail("read", name, png.message);
  return image;
}

Image read_picture(const std::filesystem::path& path) {
  return decode_picture(base::read_file(path, kMaxPictureBytes), path.string());
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
