#pragma once
// The difference of two pictures, and the rule by which a golden test passes. Any thread.

#include <cstddef>
#include <string>

#include "softcell/render/image.h"

namespace softcell::render {

/// The difference of a pixel is the largest difference of its four channels, 0..255.
struct ImageDifference {
  bool same_size = true;   ///< if false, every other number is 0
  std::size_t pixels = 0;  ///< compared
  int max = 0;             ///< the largest difference of all
  std::size_t over_0 = 0;  ///< pixels that differ at all
  std::size_t over_2 = 0;  ///< pixels that differ by more than 2
  std::size_t over_8 = 0;  ///< pixels that differ by more than 8
  double rmse = 0;         ///< root mean square over all channels, 0..255
};

/// Compares two pictures. Pictures of different sizes are not compared: see same_size. @pre both are whole
ImageDifference compare(const Image& actual, const Image& expected);

// The golden rule. One software rasterizer draws the same picture on every processor up to the last bit of its float arithmetic: with all
// instruction sets that it can be told to use on x86-64, at most 0.02 % of the pixels differed, by 1 [measured, Mesa 22.3.6]. A lost
// anti-aliasing, a moved edge or a wrong shade differs by more than 8 in hundreds of pixels. So a picture passes if no pixel differs by
// more than 2 (one bit, and one more from the resolve of four samples), hence none by more than 8, and at most 0.2 % differ at all: ten
// times the measured share. Perceptual measures are not used: those that we tried accepted a picture without anti-aliasing.
inline constexpr int kGoldenMaxDifference = 2;
inline constexpr double kGoldenMaxDifferingShare = 0.002;

/// True if the difference is within the golden rule. Never true for pictures of different sizes.
bool within_golden_rule(const ImageDifference& difference);

/// All numbers in one line, for a test's message.
std::string describe(const ImageDifference& difference);

/// |actual - expected| times `gain`, saturated, opaque. @pre same size; gain is above 0
Image difference_image(const Image& actual, const Image& expected, int gain = 32);

}  // namespace softcell::render
