#include "progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "softcell/base/assert.h"

namespace softcell::tool {
namespace {

constexpr std::size_t kWidth = 40;

}  // namespace

ProgressBar::ProgressBar(std::string label, std::size_t total, bool quiet)
    : label_(std::move(label)), total_(total), enabled_(!quiet && isatty(STDERR_FILENO) != 0) {}

ProgressBar::~ProgressBar() {
  if (enabled_ && percent_ >= 0) fmt::print(stderr, "\r{:{}}\r", "", label_.size() + kWidth + 10);
}

void ProgressBar::show(std::size_t done) {
  SC_ASSERT(done <= total_, "{}: {} of {} done", label_, done, total_);
  const int percent = total_ == 0 ? 100 : static_cast<int>(100 * done / total_);
  if (!enabled_ || percent == percent_) return;
  SC_ASSERT(percent >= 0 && percent <= 100, "{}: {} % of {} done", label_, percent, total_);
  percent_ = percent;
  const std::size_t filled = kWidth * static_cast<std::size_t>(percent) / 100;
  fmt::print(stderr, "\r{} [{:=<{}}{:{}}] {:3}%", label_, "", filled, "", kWidth - filled, percent);
  std::fflush(stderr);
}

}  // namespace softcell::tool
