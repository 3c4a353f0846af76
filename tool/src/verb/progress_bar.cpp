#include "progress_bar.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <utility>

#include "softcell/base/assert.h"

namespace softcell::tool {
namespace {

constexpr std::size_t kWidest = 40, kNarrowest = 4;  // of a bar
constexpr std::size_t kBesideBar = sizeof(" [] 100%") - 1, kLongestTime = sizeof("  99:59:59 left") - 1;
constexpr std::size_t kUsualColumns = 80;

/// Columns of the terminal. In the last one a line would wrap in some of them.
std::size_t usable_columns() {
  winsize size{};
  const bool is_known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
  return (is_known ? std::size_t{size.ws_col} : kUsualColumns) - 1;
}

}  // namespace

std::string progress_line(std::string_view label, std::size_t done, std::size_t total,
                          std::chrono::seconds elapsed, std::size_t columns) {
  SC_ASSERT(done <= total && elapsed.count() >= 0, "{}: {} of {} done in {} s", label, done, total,
            elapsed.count());
  const std::size_t percent = total == 0 ? 100 : 100 * done / total;
  const std::size_t others = label.size() + kBesideBar + kLongestTime;
  if (columns < others + kNarrowest) return fmt::format("{} {:3}%", label, percent).substr(0, columns);
  const std::size_t width = std::min(kWidest, columns - others), filled = width * percent / 100;
  std::string line = fmt::format("{} [{:=<{}}{:{}}] {:3}%", label, "", filled, "", width - filled, percent);
  // After less than a second the speed is not known well enough.
  if (done == 0 || done == total || elapsed.count() == 0) return line;
  const auto seconds = static_cast<std::uint64_t>(
      static_cast<double>(elapsed.count()) * static_cast<double>(total - done) / static_cast<double>(done) +
      0.5);
  const std::uint64_t minutes = seconds / 60;
  line += minutes < 60 ? fmt::format("  {}:{:02} left", minutes, seconds % 60)
                       : fmt::format("  {}:{:02}:{:02} left", minutes / 60, minutes % 60, seconds % 60);
  return line;
}

ProgressBar::ProgressBar(std::string label, std::size_t total, bool quiet)
    : label_(std::move(label)), total_(total), enabled_(!quiet && isatty(STDERR_FILENO) != 0) {}

ProgressBar::~ProgressBar() {
  if (enabled_ && !line_.empty()) fmt::print(stderr, "\r{:{}}\r", "", line_.size());
}

void ProgressBar::show(std::size_t done) {
  SC_ASSERT(done <= total_, "{}: {} of {} done", label_, done, total_);
  if (!enabled_) return;
  const auto elapsed =
      std::chrono::duration_cast<std::chrono::seconds>(std::chrono::steady_clock::now() - begin_);
  const std::size_t columns = usable_columns();
  std::string line = progress_line(label_, done, total_, elapsed, columns);
  if (line == line_) return;
  // Spaces cover the rest of a longer previous line.
  fmt::print(stderr, "\r{:{}}", line, std::min(line_.size(), columns));
  std::fflush(stderr);
  line_ = std::move(line);
}

}  // namespace softcell::tool
