#include "softcell/base/whole_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

#include "softcell/base/assert.h"

namespace softcell::base {
namespace {

namespace fs = std::filesystem;

/// The names of temporary files where a signal handler may read them: in memory that is never freed.
struct NameForSignals {
  enum State : int { kFree, kTaken, kRead };
  std::atomic<int> state{kFree};
  std::array<char, PATH_MAX> name;
};
constexpr std::size_t kNamesForSignals = 64;
std::array<NameForSignals, kNamesForSignals> names_for_signals;
static_assert(std::atomic<int>::is_always_lock_free);

void remove_temporary_files_and_end(int signal) {
  for (const NameForSignals& name : names_for_signals) {
    if (name.state.load(std::memory_order_acquire) == NameForSignals::kRead) ::unlink(name.name.data());
  }
  ::raise(signal);  // handled by default again
}

/// Returns a name that has only the ending of the file's own name, which may be as long as names can be: a program that is
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
  remember_temporary();
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
  forget_temporary();
}

void WholeFile::discard() {
  if (std::exchange(settled_, true)) return;
  if (file_ != nullptr) std::fclose(std::exchange(file_, nullptr));
  if (!temporary_.empty()) std::remove(temporary_.c_str());
  forget_temporary();
}

void WholeFile::remember_temporary() {
  const std::string& path = temporary_.native();
  if (path.size() >= PATH_MAX) return;
  for (std::size_t i = 0; i < names_for_signals.size(); ++i) {
    NameForSignals& name = names_for_signals[i];
    int free = NameForSignals::kFree;
    if (!name.state.compare_exchange_strong(free, NameForSignals::kTaken)) continue;
    std::memcpy(name.name.data(), path.c_str(), path.size() + 1);
    name.state.store(NameForSignals::kRead, std::memory_order_release);
    name_for_signals_ = i;
    return;
  }
}

void WholeFile::forget_temporary() {
  if (const std::size_t name = std::exchange(name_for_signals_, kNoName); name != kNoName)
    names_for_signals[name].state.store(NameForSignals::kFree, std::memory_order_release);
}

void WholeFile::fail(int error) {
  discard();
  throw std::runtime_error("cannot write " + path_.string() + ": " + std::strerror(error));
}

void remove_temporary_files_at(std::initializer_list<int> signals) {
  struct sigaction action {};
  action.sa_handler = &remove_temporary_files_and_end;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_NODEFER);
  sigemptyset(&action.sa_mask);
  for (const int signal : signals) {
    struct sigaction present {};
    sigaction(signal, nullptr, &present);
    if (present.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
  }
}

}  // namespace softcell::base
