#pragma once
// Small pictures of the scenes that come with softcell, for the menu. ci/figures makes them.

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "softcell/render/image.h"

namespace softcell::demos {

/// All pictures in one sheet, of which the overlay shows parts. Reading them takes some milliseconds. Any thread may use it once it is
/// made.
class ScenePictures {
 public:
  static constexpr int kWidth = 160, kHeight = 90;  ///< of one picture, pixels

  ScenePictures();

  const render::Image& sheet() const { return sheet_; }

  /// The rectangle of a scene's picture in the sheet: left, top, right, bottom, each 0..1. None: the scene has no picture.
  std::optional<std::array<float, 4>> rectangle(std::string_view scene) const;

 private:
  render::Image sheet_;
  std::map<std::string, int, std::less<>> row_;  // in units of kHeight pixels
};

}  // namespace softcell::demos
