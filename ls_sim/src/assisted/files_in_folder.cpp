#include <fcntl.h>
#include <linux/openat2.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "files.h"

namespace softcell::ls_sim::assisted {
namespace {

constexpr std::uint32_t kFirstDescriptor = 3;  // below are the standard streams
constexpr std::size_t kMostDescriptors = 64;

/// Opens what lies in a folder; the kernel refuses all that leads out of it.
int open_beneath(int folder, const char* path, int flags, unsigned int mode) {
  open_how how{};
  // A pipe would wait for ever. With O_PATH nothing is opened.
  const int more_flags = (flags & O_PATH) != 0 ? O_CLOEXEC : O_CLOEXEC | O_NONBLOCK | O_NOCTTY;
  how.flags = static_cast<unsigned int>(flags | more_flags);
  how.mode = (how.flags & O_CREAT) != 0 ? mode & 0666 : 0;
  how.resolve = RESOLVE_BENEATH | RESOLVE_NO_MAGICLINKS;
  return static_cast<int>(syscall(SYS_openat2, folder, path, &how, sizeof how));
}

/// A descriptor that is closed at the end of its scope; errno stays. -1: there is none.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    const int error = errno;
    if (number_ >= 0) close(number_);
    errno = error;
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

int open_folder(const std::filesystem::path& path) {
  return open(path.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
}

/// The folder that holds a file, which no symbolic link may lead to.
int open_holder(int folder, const std::filesystem::path& file) {
  const std::string parent = file.has_parent_path() ? file.parent_path().string() : ".";
  return open_beneath(folder, parent.c_str(), O_RDONLY | O_DIRECTORY, 0);
}

using Output = std::function<void(std::string_view)>;

ssize_t read_input(void* files, char* to, std::size_t size) {
  return static_cast<ssize_t>(static_cast<const FilesInFolder*>(files)->read_input({to, size}));
}

ssize_t write_output(void* output, const char* from, std::size_t size) {
  const auto& write = *static_cast<const Output*>(output);
  if (write == nullptr) return errno = EBADF, 0;
  write({from, size});
  return static_cast<ssize_t>(size);
}

Stream stream_of(const void* cookie, const char* mode, const cookie_io_functions_t& functions) {
  std::FILE* const stream = fopencookie(const_cast<void*>(cookie), mode, functions);
  if (stream == nullptr) return nullptr;
  if (mode[0] == 'w')
    std::setvbuf(stream, nullptr, _IONBF, 0);  // what is printed together goes out in one piece
  return {stream, &std::fclose};
}

}  // namespace

FilesInFolder::FilesInFolder(const HostCalls& calls, const std::atomic<bool>& interrupted)
    : calls_(calls),
      interrupted_(interrupted),
      input_(stream_of(this, "r", {assisted::read_input, nullptr, nullptr, nullptr})),
      output_(stream_of(&calls.standard_output, "w", {nullptr, write_output, nullptr, nullptr})),
      error_(stream_of(&calls.standard_error, "w", {nullptr, write_output, nullptr, nullptr})) {}

FilesInFolder::~FilesInFolder() { close_all(); }

std::size_t FilesInFolder::read_input(std::span<char> to) const {
  while (calls_.standard_input != nullptr && !is_interrupted())
    if (const std::optional<std::size_t> count = calls_.standard_input(to)) return *count;
  return 0;
}

void FilesInFolder::close_all() {
  close_streams();
  for (const int descriptor : descriptors_)
    if (descriptor >= 0) close(descriptor);
  descriptors_.clear();
}

Stream& FilesInFolder::standard(std::uint32_t handle) {
  return handle == kStandardInput ? input_ : handle == kStandardOutput ? output_ : error_;
}

bool FilesInFolder::replace_standard_stream(std::uint32_t handle, const Stream& opened) {
  standard(handle) = opened;
  return true;
}

int FilesInFolder::open(const std::string& path, int flags, unsigned int mode) {
  if (!calls_.folder) return errno = EACCES, -1;
  const Descriptor folder(open_folder(*calls_.folder));
  return open_beneath(folder.number(), path.c_str(), flags, mode);
}

int FilesInFolder::remove(const std::string& path) {
  if (!calls_.folder) return errno = EACCES, -1;
  const Descriptor folder(open_folder(*calls_.folder));
  const Descriptor holder(open_holder(folder.number(), path));
  if (holder.number() < 0) return -1;
  return unlinkat(holder.number(), std::filesystem::path(path).filename().c_str(), 0);
}

int FilesInFolder::rename(const std::string& from, const std::string& to) {
  if (!calls_.folder) return errno = EACCES, -1;
  const Descriptor folder(open_folder(*calls_.folder));
  const Descriptor holder(open_holder(folder.number(), from)), target(open_holder(folder.number(), to));
  if (holder.number() < 0 || target.number() < 0) return -1;
  return renameat(holder.number(), std::filesystem::path(from).filename().c_str(), target.number(),
                  std::filesystem::path(to).filename().c_str());
}

int FilesInFolder::add_descriptor(int descriptor) {
  auto free = std::ranges::find(descriptors_, -1);
  if (free == descriptors_.end()) {
    if (descriptors_.size() == kMostDescriptors) return close(descriptor), errno = EMFILE, -1;
    free = descriptors_.emplace(descriptors_.end());
  }
  *free = descriptor;
  return static_cast<int>(free - descriptors_.begin() + kFirstDescriptor);
}

int FilesInFolder::descriptor_of(std::uint32_t number) {
  const std::size_t index = std::size_t{number} - kFirstDescriptor;
  if (number < kFirstDescriptor || index >= descriptors_.size()) return -1;
  return descriptors_[index];
}

int FilesInFolder::close_descriptor(std::uint32_t number) {
  const int descriptor = descriptor_of(number);
  if (descriptor < 0) return errno = EBADF, -1;
  descriptors_[number - kFirstDescriptor] = -1;
  return close(descriptor);
}

}  // namespace softcell::ls_sim::assisted
