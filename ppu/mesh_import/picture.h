#pragma once
// Pictures of mesh materials: PNG by libpng, JPEG by libjpeg-turbo.

#include <cstddef>
#include <memory>
#include <string_view>

#include "softcell/soft_bodies/mesh_material.h"

namespace softcell::ppu {

inline constexpr int kMaxPictureSide = 16384;

/// Whether the bytes begin as those of a format that decode_picture() reads.
bool is_picture(std::string_view bytes);

/// Decodes a PNG or JPEG file. Nothing is allocated for a picture of more than `most_pixels`.
/// @throws std::runtime_error  a clause about the picture without its name: neither format, damaged, too large.
std::shared_ptr<const MeshPicture> decode_picture(std::string_view bytes, std::size_t most_pixels);

}  // namespace softcell::ppu
