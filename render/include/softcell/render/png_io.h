#pragma once
// Pictures as PNG files.

#include <filesystem>

#include "softcell/render/image.h"

namespace softcell::render {

enum class PngEffort {
  fast,   ///< for frames: about 5 times as fast, about 1.7 times as large
  small,  ///< for pictures that are kept, such as golden ones
};

/// Writes a picture as an atomic file (see base/whole_file.h). Stores the alpha channel only if some pixel is
/// not opaque. Any thread.
/// @pre  the picture is whole
/// @throws std::runtime_error  with the file and the reason: empty picture, directory missing or not
/// writable, disk full.
void write_png(const std::filesystem::path& path, const Image& image, PngEffort effort = PngEffort::fast);

/// Reads any PNG as RGBA8. Any thread.
/// @throws std::runtime_error  with the file and the reason: it cannot be opened, is not a PNG file, or is
/// damaged.
Image read_png(const std::filesystem::path& path);

}  // namespace softcell::render
