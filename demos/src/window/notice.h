#pragma once

#include <string>
#include <utility>

namespace softcell::demos {

/// A sentence for the user that stands in the window for some seconds.
class Notice {
 public:
  void show(std::string sentence) {
    sentence_ = std::move(sentence);
    frames_ = kFrames;
  }
  /// Once for each frame. Empty: none is shown
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
