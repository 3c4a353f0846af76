#include "softcell/ls_sim/whole_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

namespace softcell::ls_sim {
namespace {

namespace fs = std::filesystem;

/// Not made of the file's own name, which may be as long as names can be.
std::string next_temporary_name() {
  static std::atomic<unsigned> counter{0};
  return ".softcell-" + std::to_string(getpid()) + "-" + std::to_string(counter++) + ".partial";
}

}  // namespace

WholeFile::WholeFile(fs::path path) : path_(std::move(path)), place_(path_) {
  if (path_.empty()) throw std::runtime_error("cannot write '': it is no file name");
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
  const mode_t mode = exists(replaced) ? static_cast<mode_t>(replaced.permissions()) : 0666;
  fs::path name;
  int descriptor = -1;
  do {  // a name that is taken is another writer's, or was left by one that was killed
    name = place_.parent_path() / next_temporary_name();
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
  // What the umask took away.
  if (exists(replaced) && ::fchmod(descriptor, mode) != 0) fail(errno);
}

void WholeFile::open_in_place() {
  file_ = std::fopen(place_.c_str(), "wbe");
  if (file_ == nullptr) fail(errno);
}

void WholeFile::write(std::string_view bytes) {
  if (file_ == nullptr) open_in_place();
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail(errno);
}

void WholeFile::finish() {
  if (file_ != nullptr && std::fclose(std::exchange(file_, nullptr)) != 0) fail(errno);
}

void WholeFile::commit() {
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

}  // namespace softcell::ls_sim
