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

/// All of them in one sheet, which the overlay shows parts of. Reading them takes some milliseconds. Any thread, once it is made.
class ScenePictures {
 public:
  static constexpr int kWidth = 160, kHeight = 90;  ///< of one, pixels

  ScenePictures();

  const render::Image& sheet() const { return sheet_; }

  /// Where a scene's picture is in the sheet: left, top, right, bottom, each 0..1. None: it has none.
  std::optional<std::array<float, 4>> place(std::string_view scene) const;

 private:
  render::Image sheet_;
  std::map<std::string, int, std::less<>> row_;  // of kHeight pixels
};

}  // namespace softcell::demos
