#include "ppu/mesh_import/picture.h"

#include <png.h>
#include <turbojpeg.h>

#include <cstdint>
#include <limits>
#include <string>

#include "ppu/mesh_import/mesh_file_text.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using namespace std::string_view_literals;
constexpr std::string_view kPngBegins = "\x89PNG\r\n\x1a\n"sv;
constexpr std::string_view kJpegBegins = "\xff\xd8\xff"sv;

/// libpng's and libjpeg-turbo's words, which may hold bytes of the file.
std::string printable(const char* words) {
  std::string text = words;
  for (char& c : text) c = c >= ' ' && c <= '~' ? c : '?';
  return text;
}

MeshPicture blank(std::uint64_t width, std::uint64_t height, std::size_t most_pixels) {
  if (width < 1 || height < 1 || width > kMaxPictureSide || height > kMaxPictureSide ||
      width * height > most_pixels) {
    refuse("it has " + std::to_string(width) + " by " + std::to_string(height) +
           " pixels; a side may have at most " + std::to_string(kMaxPictureSide) +
           ", and a model's pictures together 64 million");
  }
  MeshPicture picture{.width = static_cast<int>(width), .height = static_cast<int>(height), .rgba = {}};
  picture.rgba.resize(4 * width * height);
  return picture;
}

/// The control block of libpng's simplified interface, freed in every case.
struct PngReader : png_image {
  PngReader() : png_image{} { version = PNG_IMAGE_VERSION; }
  ~PngReader() { png_image_free(this); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
};

MeshPicture decode_png(std::string_view bytes, std::size_t most_pixels) {
  PngReader png;
  if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) == 0)
    refuse("it is a damaged PNG file (" + printable(png.message) + ")");
  png.format = PNG_FORMAT_RGBA;
  MeshPicture picture = blank(png.width, png.height, most_pixels);
  // A warning, as that of a wrong colour profile, leaves the pixels as they are.
  if (png_image_finish_read(&png, nullptr, picture.rgba.data(), 0, nullptr) == 0)
    refuse("it is a damaged PNG file (" + printable(png.message) + ")");
  return picture;
}

struct JpegReader {
  tjhandle handle = tjInitDecompress();
  JpegReader() {
    if (handle == nullptr) refuse("no JPEG file can be read: " + printable(tjGetErrorStr2(nullptr)));
  }
  ~JpegReader() { tjDestroy(handle); }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;
};

MeshPicture decode_jpeg(std::string_view bytes, std::size_t most_pixels) {
  const JpegReader jpeg;
  const auto refuse_damaged = [&] {
    refuse("it is a damaged JPEG file, or one of a kind that is not read (" +
           printable(tjGetErrorStr2(jpeg.handle)) + ")");
  };
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  int width = 0, height = 0, subsampling = 0, colour_space = 0;
  if (tjDecompressHeader3(jpeg.handle, data, bytes.size(), &width, &height, &subsampling, &colour_space) !=
          0 ||
      width < 1 || height < 1)
    refuse_damaged();
  MeshPicture picture =
      blank(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height), most_pixels);
  // A progressive file of many scans would take minutes. Other warnings are those of files cut off.
  constexpr int kStrict = TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS | TJFLAG_ACCURATEDCT;
  if (tjDecompress2(jpeg.handle, data, bytes.size(), picture.rgba.data(), width, 0, height, TJPF_RGBA,
                    kStrict) != 0)
    refuse_damaged();
  return picture;
}

}  // namespace

bool is_picture(std::string_view bytes) {
  return bytes.starts_with(kPngBegins) || bytes.starts_with(kJpegBegins);
}

std::shared_ptr<const MeshPicture> decode_picture(std::string_view bytes, std::size_t most_pixels) {
  if (bytes.size() > std::numeric_limits<unsigned long>::max() / 2) refuse("it is too large");
  if (bytes.starts_with(kPngBegins))
    return std::make_shared<const MeshPicture>(decode_png(bytes, most_pixels));
  if (bytes.starts_with(kJpegBegins))
    return std::make_shared<const MeshPicture>(decode_jpeg(bytes, most_pixels));
  refuse("it is neither a PNG nor a JPEG file");
}

}  // namespace softcell::ppu
