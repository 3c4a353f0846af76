#include "output_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

#include "exit_status.h"
#include "softcell/base/assert.h"

namespace softcell::tool {
namespace {

constexpr const char* kCalled = "standard output";

/// Returns a descriptor of the present standard output, and redirects standard output to standard error.
int redirect_standard_output() {
  std::fflush(stdout);
  const int original = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  if (original < 0 || ::dup2(STDERR_FILENO, STDOUT_FILENO) < 0)
    throw std::runtime_error(fmt::format("cannot write {}: {}", kCalled, std::strerror(errno)));
  return original;
}

}  // namespace

OutputFiles::OutputFiles(const std::vector<NamedFile>& files) {
  check_distinct(files);
  const bool wanted =
      std::ranges::any_of(files, [](const NamedFile& file) { return file.file == kStandardOutput; });
  if (wanted) standard_output_ = redirect_standard_output();
}

base::WholeFile& OutputFiles::open(const std::filesystem::path& file) {
  if (file != kStandardOutput) return files_.open(file);
  SC_ASSERT(standard_output_ >= 0, "standard output was not announced, or is opened twice");
  return files_.open(::fdopen(std::exchange(standard_output_, -1), "wb"), kCalled);
}

void refuse_standard_output(const NamedFile& option) {
  if (option.file != kStandardOutput) return;
  throw UsageError(fmt::format(
      "{0} -: it cannot write to standard output; give a name (./- for one of that name)", option.name));
}

std::string shown_name(const std::filesystem::path& file) {
  return file == kStandardOutput ? kCalled : file.string();
}

}  // namespace softcell::tool
