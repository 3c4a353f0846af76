#pragma once

#include <string>
#include <utility>

namespace softcell::demos {

/// A message for the user that stays in the window for some seconds.
class Notice {
 public:
  void show(std::string sentence) {
    sentence_ = std::move(sentence);
    frames_ = kFrames;
  }
  /// Call it once per frame. Empty: no message is shown
  const std::string& next_frame() {
    if (frames_ == 0 || --frames_ == 0) sentence_.clear();
    return sentence_;
  }

 private:
  static constexpr int kFrames = 8 * 60;

  std::string sentence_;
  int frames_ = 0;
};

}  // namespace softcell::demos
