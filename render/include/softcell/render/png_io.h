#pragma once
// Pictures as PNG files.

#include <filesystem>

#include "softcell/render/image.h"

namespace softcell::render {

enum class PngEffort {
  fast,   ///< for frames: about 5 times as fast, about 1.7 times as large
  small,  ///< for pictures that are kept, such as golden ones
};

/// Writes the picture; the alpha channel is stored only when some pixel is not opaque. The file appears under
/// its name when it is whole: until then it is a temporary one in the same directory, removed when anything
/// fails. A path that is no regular file (a device, a pipe) is written directly.
/// @throws std::runtime_error  one sentence naming the file: empty picture, directory missing or not
/// writable, disk full.
void write_png(const std::filesystem::path& path, const Image& image, PngEffort effort = PngEffort::fast);

/// Reads any PNG as RGBA8.
/// @throws std::runtime_error  one sentence naming the file: it cannot be opened, or is no PNG, or a damaged
/// one.
Image read_png(const std::filesystem::path& path);

}  // namespace softcell::render
