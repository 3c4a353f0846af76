#pragma once
// Linear light and the sRGB encoding of pictures.

#include <Eigen/Core>
#include <cmath>

namespace softcell::ppu {

/// The sRGB encoding of a colour in linear light, each channel 0..1; alpha stays. @source IEC 61966-2-1
inline Eigen::Vector4f srgb_encoded(const Eigen::Vector4f& linear) {
  Eigen::Vector4f encoded = linear;
  for (int c = 0; c < 3; ++c) {
    const float x = linear[c];
    if (x <= 0.0031308f) {
      encoded[c] = 12.92f * x;
    } else if (x < 1) {  // 1 stays so to the last bit
      encoded[c] = 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
    }
  }
  return encoded;
}

}  // namespace softcell::ppu
