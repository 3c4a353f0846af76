#include "assisted_calls.h"

#include <fcntl.h>
#include <linux/openat2.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "assisted/assisted_calls.h"

namespace softcell::ls_sim::interpreter {
namespace {

constexpr std::uint32_t kOpcodeShift = 24, kAddressMask = 0xFFFFFF;
constexpr std::uint32_t kStdout = 2, kStderr = 3;  // FILE handles of newlib
constexpr std::uint32_t kFirstFile = 3;            // below are the standard streams
constexpr std::size_t kMostFiles = 64;
constexpr std::uint32_t kMostIo = dma::kLocalStoreBytes;

using enum assisted::C99Function;
// [newlib, jsre.h] second-hand
enum Posix : std::uint32_t { kClose = 2, kLseek = 9, kOpen = 15, kRead = 16, kUnlink = 24, kWrite = 27 };

/// Opens what lies in a folder; the kernel refuses all that leads out of it.
int open_beneath(int folder, const char* path, std::uint64_t flags, std::uint64_t mode) {
  open_how how{};
  how.flags = flags | O_CLOEXEC | O_NONBLOCK | O_NOCTTY;  // a pipe would wait for ever
  how.mode = mode;
  how.resolve = RESOLVE_BENEATH | RESOLVE_NO_MAGICLINKS;
  return static_cast<int>(syscall(SYS_openat2, folder, path, &how, sizeof how));
}

/// A folder of the host, open for as long as this lives. -1: it is not there.
class Folder {
 public:
  explicit Folder(const std::filesystem::path& path)
      : number_(open(path.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC)) {}
  ~Folder() {
    if (number_ >= 0) close(number_);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

/// The program's flags are those of Linux; others than these are not for it.
std::uint64_t open_flags(std::uint32_t flags) {
  return flags & (O_ACCMODE | O_CREAT | O_EXCL | O_TRUNC | O_APPEND);
}

}  // namespace

void AssistedCalls::serve(std::uint32_t code, std::uint32_t message) {
  arguments_ = message & kAddressMask & dma::kLocalStoreMask;
  const std::uint32_t opcode = message >> kOpcodeShift;
  const Result result = code == kC99Call ? c99(opcode) : posix(opcode);
  memory_.set_word(arguments_, static_cast<std::uint32_t>(result.value));
  memory_.set_word(arguments_ + 4, 0);
  memory_.set_word(arguments_ + 8, 0);
  memory_.set_word(arguments_ + 12, static_cast<std::uint32_t>(result.error));
}

void AssistedCalls::close_all() {
  for (const int file : files_) {
    if (file >= 0) close(file);
  }
  files_.clear();
}

// ---- the C library

AssistedCalls::Result AssistedCalls::print(std::uint32_t stream, std::string_view text) const {
  const auto& to = stream == kStdout ? calls_.standard_output : calls_.standard_error;
  if ((stream != kStdout && stream != kStderr) || to == nullptr) return {-1, EBADF};
  to(text);
  return {static_cast<std::int64_t>(text.size()), 0};
}

/// @param format_argument  the number of the argument with the format; the va_list follows it.
std::string AssistedCalls::formatted(int format_argument) {
  VariableArguments variable(memory_, argument(format_argument + 1), argument(format_argument + 2));
  return assisted::format_text(memory_.text(argument(format_argument)), variable);
}

AssistedCalls::Result AssistedCalls::store_text(std::uint32_t to, std::uint32_t room,
                                                const std::string& text) {
  if (room != 0) {
    const std::size_t length = std::min<std::size_t>(text.size(), room - 1);
    memory_.set_bytes(to, std::string_view(text).substr(0, length));
    memory_.set_byte(to + static_cast<std::uint32_t>(length), 0);
  }
  return {static_cast<std::int64_t>(text.size()), 0};
}

AssistedCalls::Result AssistedCalls::c99(std::uint32_t opcode) {
  const auto character = [&](std::uint32_t stream) -> Result {
    const char letter = static_cast<char>(argument(0));
    const Result result = print(stream, {&letter, 1});
    return result.error == 0 ? Result{static_cast<unsigned char>(letter), 0} : result;
  };
  switch (opcode) {
    case kVprintf:
      return print(kStdout, formatted(0));
    case kVfprintf:
      return print(argument(0), formatted(1));
    case kVsprintf:
      return store_text(argument(0), dma::kLocalStoreBytes, formatted(1));
    case kVsnprintf:
      return store_text(argument(0), std::min(argument(1), dma::kLocalStoreBytes), formatted(2));
    case kPuts:
      return print(kStdout, memory_.text(argument(0)) + "\n");
    case kFputs:
      return print(argument(1), memory_.text(argument(0)));
    case kPutchar:
      return character(kStdout);
    case kPutc:
    case kFputc:
      return character(argument(1));
    case kFwrite: {
      const std::uint64_t bytes = std::uint64_t{argument(1)} * argument(2);
      if (bytes > dma::kLocalStoreBytes) return {0, EFAULT};
      const Result result = print(argument(3), memory_.bytes(argument(0), static_cast<std::uint32_t>(bytes)));
      return result.error == 0 ? Result{argument(2), 0} : Result{0, result.error};
    }
    case kFflush:
      return {0, 0};
    default:
      return {-1, ENOSYS};
  }
}

// ---- POSIX

int AssistedCalls::host_file(std::uint32_t file) const {
  const std::size_t index = file - kFirstFile;
  return file >= kFirstFile && index < files_.size() ? files_[index] : -1;
}

AssistedCalls::Result AssistedCalls::open_file() {
  if (!calls_.folder) return {-1, EACCES};
  const auto free = std::ranges::find(files_, -1);
  if (free == files_.end() && files_.size() == kMostFiles) return {-1, EMFILE};
  const Folder folder(*calls_.folder);
  const std::uint64_t flags = open_flags(argument(1));
  const std::uint64_t mode = (flags & O_CREAT) != 0 ? argument(2) & 0666 : 0;
  const int file = open_beneath(folder.number(), memory_.text(argument(0)).c_str(), flags, mode);
  if (file < 0) return {-1, errno};
  const std::size_t index = static_cast<std::size_t>(free - files_.begin());
  if (free == files_.end()) files_.push_back(file);
  files_[index] = file;
  return {static_cast<std::int64_t>(index + kFirstFile), 0};
}

AssistedCalls::Result AssistedCalls::read_file() {
  const int file = host_file(argument(0));
  if (file < 0) return {-1, EBADF};
  std::string data(std::min(argument(2), kMostIo), '\0');
  const ssize_t count = read(file, data.data(), data.size());
  if (count < 0) return {-1, errno};
  memory_.set_bytes(argument(1), std::string_view(data).substr(0, static_cast<std::size_t>(count)));
  return {count, 0};
}

AssistedCalls::Result AssistedCalls::write_file() {
  const std::string data = memory_.bytes(argument(1), std::min(argument(2), kMostIo));
  const std::uint32_t to = argument(0);
  if (to == STDOUT_FILENO || to == STDERR_FILENO) return print(to + 1, data);  // its FILE handle is one more
  const int file = host_file(to);
  if (file < 0) return {-1, EBADF};
  const ssize_t count = write(file, data.data(), data.size());
  return count < 0 ? Result{-1, errno} : Result{count, 0};
}

AssistedCalls::Result AssistedCalls::seek_file() {
  const int file = host_file(argument(0));
  if (file < 0) return {-1, EBADF};
  const off_t place = lseek(file, static_cast<std::int32_t>(argument(1)), static_cast<int>(argument(2)));
  return place < 0 ? Result{-1, errno} : Result{place, 0};
}

/// Removes a file by the folder that holds it, which no symbolic link may lead to.
AssistedCalls::Result AssistedCalls::unlink_file() const {
  if (!calls_.folder) return {-1, EACCES};
  const std::filesystem::path path = memory_.text(argument(0));
  const Folder folder(*calls_.folder);
  const std::string parent = path.has_parent_path() ? path.parent_path().string() : ".";
  const int holder = open_beneath(folder.number(), parent.c_str(), O_RDONLY | O_DIRECTORY, 0);
  if (holder < 0) return {-1, errno};
  const int failed = unlinkat(holder, path.filename().c_str(), 0);
  const int error = failed == 0 ? 0 : errno;
  close(holder);
  return {failed == 0 ? 0 : -1, error};
}

AssistedCalls::Result AssistedCalls::posix(std::uint32_t opcode) {
  switch (opcode) {
    case kOpen:
      return open_file();
    case kRead:
      return read_file();
    case kWrite:
      return write_file();
    case kLseek:
      return seek_file();
    case kUnlink:
      return unlink_file();
    case kClose: {
      const int file = host_file(argument(0));
      if (file < 0) return {-1, EBADF};
      close(file);
      files_[argument(0) - kFirstFile] = -1;
      return {0, 0};
    }
    default:
      return {-1, ENOSYS};
  }
}

}  // namespace softcell::ls_sim::interpreter
