#pragma once

#include <cstddef>
#include <string>

namespace softcell::tool {

/// A line on standard error that shows how far a long run is, on a terminal and nowhere else.
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
  int percent_ = -1;
  bool enabled_;
};

}  // namespace softcell::tool
