#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>

namespace softcell::tool {

/// The line of a progress bar: "demo 2d [====      ]  40%  1:05 left".
/// @param done, total  done <= total  @param elapsed  since the start; the rest is assumed to go on at the same speed
/// @param columns  that it may have; where they are few, the bar is shorter, or there is none
std::string progress_line(std::string_view label, std::size_t done, std::size_t total,
                          std::chrono::seconds elapsed, std::size_t columns);

/// A line on standard error that shows the progress of a long run and the time that is left. It appears only on a terminal.
class ProgressBar {
 public:
  /// @param total  the number that show() counts up to.  @param quiet  never show the line.
  ProgressBar(std::string label, std::size_t total, bool quiet);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(std::size_t done);

 private:
  std::string label_;
  std::size_t total_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::string line_;  ///< the shown line
  bool enabled_;
};

}  // namespace softcell::tool
