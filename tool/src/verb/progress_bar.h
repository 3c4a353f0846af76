#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>

namespace softcell::tool {

/// The line of a progress bar: "demo 2d [====      ]  40%  1:05 left".
/// @param done, total  done <= total  @param elapsed  since nothing was done: what is left is taken to go as fast
std::string progress_line(std::string_view label, std::size_t done, std::size_t total,
                          std::chrono::seconds elapsed);

/// A line on standard error that shows how far a long run is and how long it will take, on a terminal and nowhere else.
class ProgressBar {
 public:
  /// @param total  what show() counts up to.  @param quiet  show nothing anywhere.
  ProgressBar(std::string label, std::size_t total, bool quiet);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(std::size_t done);

 private:
  std::string label_;
  std::size_t total_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::string line_;  ///< that is shown
  bool enabled_;
};

}  // namespace softcell::tool
