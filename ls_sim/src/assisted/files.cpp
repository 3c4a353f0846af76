#include "files.h"

#include <fcntl.h>
#include <stdio_ext.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <utility>

namespace softcell::ls_sim::assisted {
namespace {

constexpr std::uint32_t kFirstHandle = kStandardError + 1;
constexpr std::size_t kMostStreams = 64;

class FilesOfProcess final : public Files {
 public:
  int open(const std::string& path, int flags, unsigned int mode) override {
    return ::open(path.c_str(), flags, mode);
  }
  int remove(const std::string& path) override { return std::remove(path.c_str()); }
  int rename(const std::string& from, const std::string& to) override {
    return std::rename(from.c_str(), to.c_str());
  }
  int add_descriptor(int descriptor) override { return descriptor; }
  int descriptor_of(std::uint32_t number) override { return static_cast<int>(number); }
  int close_descriptor(std::uint32_t number) override { return close(static_cast<int>(number)); }

 protected:
  Stream standard_stream(std::uint32_t handle) override {
    std::FILE* const stream = handle == kStandardInput ? stdin : handle == kStandardOutput ? stdout : stderr;
    return {stream, [](std::FILE*) {}};
  }
  /// That of the process stays, and leads to the other file.
  bool replace_standard_stream(std::uint32_t handle, const Stream& opened) override {
    std::FILE* const stream = standard_stream(handle).get();
    const bool reads = handle == kStandardInput;
    const int access = fcntl(fileno(opened.get()), F_GETFL) & O_ACCMODE;
    if (access == (reads ? O_WRONLY : O_RDONLY)) return errno = EINVAL, false;
    if (reads)
      __fpurge(stream);
    else
      std::fflush(stream);
    if (dup2(fileno(opened.get()), fileno(stream)) < 0) return false;
    std::clearerr(stream);
    return true;
  }
};

}  // namespace

Files& files_of_process() {
  static auto* const files = new FilesOfProcess;  // SPEs run until all else of the program has ended
  return *files;
}

std::uint32_t Files::add_stream(std::FILE* opened) {
  if (opened == nullptr) return 0;
  Stream stream(opened, &std::fclose);
  const std::lock_guard lock(mutex_);
  auto free = std::ranges::find(streams_, nullptr);
  if (free == streams_.end()) {
    if (streams_.size() == kMostStreams) return errno = EMFILE, 0;
    free = streams_.emplace(streams_.end());
  }
  *free = std::move(stream);
  return static_cast<std::uint32_t>(free - streams_.begin()) + kFirstHandle;
}

Stream Files::stream(std::uint32_t handle) {
  if (handle >= kStandardInput && handle <= kStandardError) return standard_stream(handle);
  const std::lock_guard lock(mutex_);
  const std::size_t index = std::size_t{handle} - kFirstHandle;
  if (index < streams_.size() && streams_[index] != nullptr) return streams_[index];
  errno = EBADF;
  return nullptr;
}

/// Writes the rest of the buffer now, so that the program gets the error if that fails.
int Files::close_stream(std::uint32_t handle) {
  const Stream closed = stream(handle);
  if (closed == nullptr) return EOF;
  const int result = std::fflush(closed.get());
  if (handle < kFirstHandle) return result;  // a standard stream, which the process goes on to use
  const std::lock_guard lock(mutex_);
  streams_[handle - kFirstHandle] = nullptr;
  return result;
}

bool Files::replace_stream(std::uint32_t handle, std::FILE* opened) {
  const Stream replacement(opened, &std::fclose), replaced = stream(handle);
  if (replaced == nullptr) return false;
  if (handle < kFirstHandle) return replace_standard_stream(handle, replacement);
  std::fflush(replaced.get());
  const std::lock_guard lock(mutex_);
  streams_[handle - kFirstHandle] = replacement;
  return true;
}

void Files::close_streams() {
  const std::lock_guard lock(mutex_);
  streams_.clear();
}

}  // namespace softcell::ls_sim::assisted
