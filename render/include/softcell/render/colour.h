#pragma once
// Colours as the renderer computes with them.

#include <Eigen/Core>
#include <cstdint>

namespace softcell::render {

/// A colour in linear light, each channel 0..1.
using Colour = Eigen::Vector3f;

/// The linear colour of 0xRRGGBB as painting programs write it. A cubic fit to the sRGB curve, exact to 0.003, so that the picture does not
/// depend on libm.
inline Colour srgb(std::uint32_t rrggbb) {
  const auto channel = [rrggbb](int shift) {
    const float encoded = static_cast<float>((rrggbb >> shift) & 0xFFu) / 255.0f;
    return encoded * (encoded * (encoded * 0.305306011f + 0.682171111f) + 0.012522878f);
  };
  return {channel(16), channel(8), channel(0)};
}

}  // namespace softcell::render
