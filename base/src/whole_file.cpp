#include "softcell/base/whole_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

#include "softcell/base/assert.h"

namespace softcell::base {
namespace {

namespace fs = std::filesystem;

/// Of the file's own name, which may be as long as names can be, it has the ending only: a program that is
/// given the name may tell the format by it.
std::string next_temporary_name(const fs::path& file) {
  static std::atomic<unsigned> counter{0};
  constexpr std::size_t kLongestEnding = 32;
  const std::string ending = file.extension().string();
  return ".softcell-" + std::to_string(getpid()) + "-" + std::to_string(counter++) + ".partial" +
         (ending.size() <= kLongestEnding ? ending : "");
}

}  // namespace

WholeFile::WholeFile(fs::path path) : path_(std::move(path)), place_(path_) {
  if (path_.empty()) throw std::runtime_error("cannot write '': the file name is empty");
  std::error_code error;
  const fs::file_status status = fs::status(path_, error);
  if (status.type() == fs::file_type::none) fail(error.value());
  if (is_directory(status)) fail(EISDIR);
  const bool in_place = exists(status) && !is_regular_file(status);
  if (in_place) {
    if (access(path_.c_str(), W_OK) != 0) fail(errno);
    return;
  }
  place_ = behind_links(path_);
  open_temporary(status);
}

WholeFile::WholeFile(std::FILE* stream, fs::path called) : path_(std::move(called)), file_(stream) {
  SC_ASSERT(stream != nullptr, "{} is no open stream", path_);
}

WholeFile::~WholeFile() { discard(); }

fs::path WholeFile::behind_links(fs::path path) {
  constexpr int kMostLinks = 40;  // as the kernel has it
  std::error_code error;
  for (int link = 0; link < kMostLinks && fs::is_symlink(fs::symlink_status(path, error)); ++link) {
    const fs::path target = fs::read_symlink(path, error);
    if (error) break;
    path = path.parent_path() / target;
  }
  return path;
}

void WholeFile::open_temporary(const fs::file_status& replaced) {
  SC_ASSERT(file_ == nullptr && temporary_.empty(), "{} is open already, as {}", path_, temporary_);
  if (exists(replaced)) kept_mode_ = static_cast<mode_t>(replaced.permissions());
  // One that is read-only becomes so when it is written.
  const mode_t mode = kept_mode_ ? *kept_mode_ | S_IWUSR : 0666;
  fs::path name;
  int descriptor = -1;
  do {  // a name that is taken is another writer's, or was left by one that was killed
    name = place_.parent_path() / next_temporary_name(place_);
    descriptor = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
  } while (descriptor < 0 && errno == EEXIST);
  if (descriptor < 0) fail(errno);
  temporary_ = name;
  file_ = ::fdopen(descriptor, "wb");
  if (file_ == nullptr) {
    const int error = errno;
    ::close(descriptor);
    fail(error);
  }
}

void WholeFile::open_in_place() {
  SC_ASSERT(temporary_.empty(), "{} is to be written in place and has the temporary file {}", path_,
            temporary_);
  file_ = std::fopen(place_.c_str(), "wbe");
  if (file_ == nullptr) fail(errno);
}

void WholeFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream()) != bytes.size()) fail(errno);
}

std::FILE* WholeFile::stream() {
  SC_ASSERT(!finished_, "write to {} after finish()", path_);
  if (file_ == nullptr) open_in_place();
  return file_;
}

void WholeFile::finish() {
  if (std::exchange(finished_, true) || file_ == nullptr) return;
  // The umask may have taken some of it away.
  if (kept_mode_ && ::fchmod(::fileno(file_), *kept_mode_) != 0) fail(errno);
  if (std::fclose(std::exchange(file_, nullptr)) != 0) fail(errno);
}

void WholeFile::commit() {
  SC_ASSERT(!settled_, "{} was committed or discarded before", path_);
  finish();
  if (!temporary_.empty() && std::rename(temporary_.c_str(), place_.c_str()) != 0) fail(errno);
  settled_ = true;
}

void WholeFile::discard() {
  if (std::exchange(settled_, true)) return;
  if (file_ != nullptr) std::fclose(std::exchange(file_, nullptr));
  if (!temporary_.empty()) std::remove(temporary_.c_str());
}

void WholeFile::fail(int error) {
  discard();
  throw std::runtime_error("cannot write " + path_.string() + ": " + std::strerror(error));
}

}  // namespace softcell::base
