#pragma once
// Pictures as PNG files.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "softcell/render/image.h"

namespace softcell::render {

enum class PngEffort {
  kFast,   ///< for frames: about 5 times as fast, about 1.7 times as large
  kSmall,  ///< for pictures that are kept, such as golden ones
};

/// A text in a PNG file, for programs that show information about a picture.
struct PngText {
  /// 1 to 79 letters, digits and single spaces; the format defines "Software", "Title" and others.
  std::string keyword;
  std::string text;  ///< UTF-8, one line
};

/// Writes a picture as an atomic file (see base/whole_file.h). Stores the alpha channel only if some pixel is
/// not opaque. Any thread.
/// @pre  the picture is whole
/// @throws std::runtime_error  with the file and the reason: empty picture, directory missing or not
/// writable, disk full.
void write_png(const std::filesystem::path& path, const Image& image, PngEffort effort = PngEffort::kFast,
               std::span<const PngText> texts = {});

/// The texts of a PNG file, in order. Any thread. @throws std::runtime_error  as read_png()
std::vector<PngText> read_png_texts(const std::filesystem::path& path);

// Limits for pictures from strangers: no file may fill the memory, however small it is.
inline constexpr int kMaxPictureSide = 4096;                                  // pixels
inline constexpr std::uintmax_t kMaxPictureBytes = std::uintmax_t{64} << 20;  // of the file

/// Reads a stranger's PNG file as RGBA8. Any thread.
/// @throws std::runtime_error  one sentence with the file and the reason: it does not exist, is a device or a pipe, is too large, is not a
/// PNG file, or is damaged.
Image read_picture(const std::filesystem::path& path);

/// The same from a file's bytes. @param name  of the file, for the message
Image decode_picture(std::span<const std::byte> file, const std::string& name);

/// Reads any PNG as RGBA8. Any thread.
/// @throws std::runtime_error  with the file and the reason: it cannot be opened, is not a PNG file, or is
/// damaged.
Image read_png(const std::filesystem::path& path);

}  // namespace softcell::render
