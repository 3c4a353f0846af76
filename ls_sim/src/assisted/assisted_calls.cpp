#include "assisted_calls.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <ctime>
#include <string_view>

#include "scan.h"
#include "variable_arguments.h"

namespace softcell::ls_sim::assisted {
namespace {

constexpr std::uint32_t kFunctionShift = 24, kAddressMask = 0xFFFFFF;

/// The program's flags are those of Linux; others than these are not for it.
int flags_of_host(std::uint32_t flags) {
  return static_cast<int>(flags) & (O_ACCMODE | O_CREAT | O_EXCL | O_TRUNC | O_APPEND);
}

/// The flags of open() for a mode of fopen(). [C17, 7.21.5.3]
std::optional<int> flags_of_mode(const std::string& mode) {
  const bool updates = mode.find('+') != std::string::npos;
  const int access = updates ? O_RDWR : O_WRONLY;
  const int exclusive = mode.find('x') != std::string::npos ? O_EXCL : 0;
  switch (mode.empty() ? '\0' : mode[0]) {
    case 'r':
      return updates ? O_RDWR : O_RDONLY;
    case 'w':
      return access | O_CREAT | O_TRUNC | exclusive;
    case 'a':
      return access | O_CREAT | O_APPEND | exclusive;
    default:
      return std::nullopt;
  }
}

/// The error of a stream that did not give what was asked for: 0 at its end.
int error_of(std::FILE* stream) { return std::ferror(stream) != 0 ? errno : 0; }

}  // namespace

std::uint32_t AssistedCalls::serve(std::uint32_t code, std::uint32_t request) {
  arguments_ = request & kAddressMask & dma::kLocalStoreMask;
  const std::uint32_t function = request >> kFunctionShift;
  errno = 0;
  const Result result = code == kPosixCall ? posix(function) : c99(function);
  memory_.set_word(arguments_, static_cast<std::uint32_t>(result.value));
  memory_.set_word(arguments_ + 4, 0);
  memory_.set_word(arguments_ + 8, 0);
  memory_.set_word(arguments_ + 12, static_cast<std::uint32_t>(result.error));
  return static_cast<std::uint32_t>(result.value);
}

AssistedCalls::Result AssistedCalls::c99(std::uint32_t function) {
  for (const auto& part : {&AssistedCalls::output, &AssistedCalls::input, &AssistedCalls::files})
    if (const std::optional<Result> result = (this->*part)(function)) return *result;
  return {-1, ENOSYS};
}

AssistedCalls::Result AssistedCalls::of_host(std::int64_t value) { return {value, value < 0 ? errno : 0}; }

// ---- what prints

AssistedCalls::Result AssistedCalls::print(std::uint32_t handle, const std::string& text) {
  const Stream to = files_.stream(handle);
  if (to == nullptr || std::fwrite(text.data(), 1, text.size(), to.get()) != text.size()) return {-1, errno};
  return {static_cast<std::int64_t>(text.size()), 0};
}

std::unique_ptr<FormatArguments> AssistedCalls::variable_arguments(int number) {
  if (kind_ == CallerKind::kHost) return std::make_unique<HostVariableArguments>(memory_, argument(number));
  return std::make_unique<SpuVariableArguments>(memory_, argument(number), argument(number + 1));
}

/// @param format_argument  the number of the argument with the format; the va_list follows it.
std::string AssistedCalls::formatted(int format_argument) {
  return format_text(memory_.text(argument(format_argument)), *variable_arguments(format_argument + 1),
                     memory_);
}

AssistedCalls::Result AssistedCalls::store_text(std::uint32_t to, std::uint32_t room,
                                                const std::string& text) {
  if (room != 0) {
    const std::size_t length = std::min<std::size_t>(text.size(), room - 1);
    memory_.set_bytes(to, text.substr(0, length) + '\0');
  }
  return {static_cast<std::int64_t>(text.size()), 0};
}

std::optional<AssistedCalls::Result> AssistedCalls::output(std::uint32_t function) {
  const auto character = [&](std::uint32_t handle) -> Result {
    const char letter = static_cast<char>(argument(0));
    const Result result = print(handle, std::string(1, letter));
    return result.error == 0 ? Result{static_cast<unsigned char>(letter), 0} : result;
  };
  switch (function) {
    case kVprintf:
      return print(kStandardOutput, formatted(0));
    case kVfprintf:
      return print(argument(0), formatted(1));
    case kVsprintf:
      return store_text(argument(0), dma::kLocalStoreBytes, formatted(1));
    case kVsnprintf:
      return store_text(argument(0), std::min(argument(1), dma::kLocalStoreBytes), formatted(2));
    case kPuts:
      return print(kStandardOutput, memory_.text(argument(0)) + "\n");
    case kFputs:
      return print(argument(1), memory_.text(argument(0)));
    case kPutchar:
      return character(kStandardOutput);
    case kPutc:
    case kFputc:
      return character(argument(1));
    case kFwrite: {
      const std::uint64_t bytes = std::uint64_t{argument(1)} * argument(2);
      if (bytes > dma::kLocalStoreBytes) return Result{0, EFAULT};
      if (bytes == 0) return Result{0, 0};
      const Result result = print(argument(3), memory_.bytes(argument(0), static_cast<std::uint32_t>(bytes)));
      return result.error == 0 ? Result{argument(2), 0} : Result{0, result.error};
    }
    case kFflush: {
      const Stream stream = argument(0) == 0 ? nullptr : files_.stream(argument(0));
      if (argument(0) != 0 && stream == nullptr) return Result{EOF, errno};
      return of_host(std::fflush(stream.get()));
    }
    default:
      return std::nullopt;
  }
}

// ---- what reads

AssistedCalls::Result AssistedCalls::get_character(std::uint32_t handle) {
  const Stream from = files_.stream(handle);
  if (from == nullptr) return {EOF, errno};
  const int letter = std::getc(from.get());
  return {letter, letter == EOF ? error_of(from.get()) : 0};
}

/// fgets. What is read may fall on the arguments.
AssistedCalls::Result AssistedCalls::get_line() {
  const std::uint32_t to = argument(0);
  const auto room = static_cast<std::int32_t>(argument(1));
  const Stream from = files_.stream(argument(2));
  if (from == nullptr || room <= 0) return {0, from == nullptr ? errno : EINVAL};
  std::string line(static_cast<std::size_t>(std::min<std::int32_t>(room, dma::kLocalStoreBytes)), '\0');
  if (std::fgets(line.data(), static_cast<int>(line.size()), from.get()) == nullptr)
    return {0, error_of(from.get())};
  memory_.set_bytes(to, std::string_view(line.c_str(), line.find('\0') + 1));
  return {to, 0};
}

/// fread. Likewise.
AssistedCalls::Result AssistedCalls::read_items() {
  const std::uint32_t to = argument(0), size = argument(1);
  const Stream from = files_.stream(argument(3));
  const std::uint64_t bytes = std::uint64_t{size} * argument(2);
  if (from == nullptr || bytes > dma::kLocalStoreBytes) return {0, from == nullptr ? errno : EFAULT};
  if (bytes == 0) return {0, 0};
  std::string data(bytes, '\0');
  const std::size_t count = std::fread(data.data(), 1, data.size(), from.get());
  const int error = count == bytes ? 0 : error_of(from.get());
  memory_.set_bytes(to, std::string_view(data).substr(0, count));
  return {static_cast<std::int64_t>(count / size), error};
}

AssistedCalls::Result AssistedCalls::scan(std::FILE* from, int format_argument) {
  if (from == nullptr) return {EOF, errno};
  const int stored = scan_stream(from, memory_.text(argument(format_argument)),
                                 *variable_arguments(format_argument + 1), memory_);
  return {stored, 0};
}

/// sscanf
AssistedCalls::Result AssistedCalls::scan_text() {
  std::string text = memory_.text(argument(0));
  std::FILE* const from = fmemopen(text.data(), text.size(), "r");
  const Result result = scan(from, 1);
  if (from != nullptr) std::fclose(from);
  return result;
}

std::optional<AssistedCalls::Result> AssistedCalls::input(std::uint32_t function) {
  switch (function) {
    case kFgetc:
    case kGetc:
      return get_character(argument(0));
    case kGetchar:
      return get_character(kStandardInput);
    case kFgets:
      return get_line();
    case kFread:
      return read_items();
    case kUngetc: {
      const Stream to = files_.stream(argument(1));
      if (to == nullptr) return Result{EOF, errno};
      return Result{std::ungetc(static_cast<int>(argument(0)), to.get()), 0};
    }
    case kVscanf:
      return scan(files_.stream(kStandardInput).get(), 0);
    case kVfscanf:
      return scan(files_.stream(argument(0)).get(), 1);
    case kVsscanf:
      return scan_text();
    default:
      return std::nullopt;
  }
}

// ---- streams and files

/// @return  null is an error, and errno says which
std::FILE* AssistedCalls::opened_stream() {
  const std::string mode = memory_.text(argument(1));
  const std::optional<int> flags = flags_of_mode(mode);
  if (!flags) return errno = EINVAL, nullptr;
  const int descriptor = files_.open(memory_.text(argument(0)), *flags, 0666);
  if (descriptor < 0) return nullptr;
  std::FILE* const stream = fdopen(descriptor, mode.c_str());
  if (stream == nullptr) close(descriptor), errno = EINVAL;
  return stream;
}

/// fopen. @return  a handle; 0 is an error
AssistedCalls::Result AssistedCalls::open_stream() {
  const std::uint32_t handle = files_.add_stream(opened_stream());
  return {handle, handle == 0 ? errno : 0};
}

/// freopen. A path of null, for another mode of the same file, is not known.
AssistedCalls::Result AssistedCalls::reopen_stream() {
  const std::uint32_t handle = argument(2);
  if (files_.stream(handle) == nullptr) return {0, errno};
  std::FILE* const opened = argument(0) == 0 ? (errno = EINVAL, nullptr) : opened_stream();
  const int error = errno;
  if (opened == nullptr) return files_.close_stream(handle), Result{0, error};
  return files_.replace_stream(handle, opened) ? Result{handle, 0} : Result{0, errno};
}

AssistedCalls::Result AssistedCalls::temporary_file() {
  const int descriptor = files_.open(".", O_TMPFILE | O_RDWR, 0600);
  if (descriptor < 0) return {0, errno};
  const std::uint32_t handle = files_.add_stream(fdopen(descriptor, "w+"));
  return {handle, handle == 0 ? errno : 0};
}

std::optional<AssistedCalls::Result> AssistedCalls::files(std::uint32_t function) {
  const auto with_stream = [&](const auto& work) -> Result {
    const Stream stream = files_.stream(argument(0));
    if (stream == nullptr) return {-1, errno};
    return of_host(work(stream.get()));
  };
  switch (function) {
    case kFopen:
      return open_stream();
    case kFreopen:
      return reopen_stream();
    case kTmpfile:
      return temporary_file();
    case kFclose:
      return of_host(files_.close_stream(argument(0)));
    case kRemove:
      return of_host(files_.remove(memory_.text(argument(0))));
    case kRename:
      return of_host(files_.rename(memory_.text(argument(0)), memory_.text(argument(1))));
    case kClearerr:
      return with_stream([](std::FILE* stream) { return std::clearerr(stream), 0; });
    case kFeof:
      return with_stream([](std::FILE* stream) { return std::feof(stream) != 0 ? 1 : 0; });
    case kFerror:
      return with_stream([](std::FILE* stream) { return std::ferror(stream) != 0 ? 1 : 0; });
    case kFileno:
      return with_stream([](std::FILE* stream) { return fileno(stream); });
    case kFseek:
      return with_stream([&](std::FILE* stream) {
        return std::fseek(stream, static_cast<std::int32_t>(argument(1)), static_cast<int>(argument(2)));
      });
    case kFtell:
      return with_stream([](std::FILE* stream) { return std::ftell(stream); });
    case kRewind:
      return with_stream([](std::FILE* stream) { return std::rewind(stream), 0; });
    default:
      return std::nullopt;
  }
}

// ---- POSIX

AssistedCalls::Result AssistedCalls::open_descriptor() {
  const int descriptor = files_.open(memory_.text(argument(0)), flags_of_host(argument(1)), argument(2));
  return of_host(descriptor < 0 ? descriptor : files_.add_descriptor(descriptor));
}

AssistedCalls::Result AssistedCalls::read_descriptor() {
  std::string data(std::min(argument(2), dma::kLocalStoreBytes), '\0');
  ssize_t count = 0;
  if (argument(0) == STDIN_FILENO) {
    // By way of the stream, which may have read more than was asked for.
    const Stream from = files_.stream(kStandardInput);
    for (int letter = 0; letter != '\n' && count < static_cast<ssize_t>(data.size());) {
      letter = std::getc(from.get());
      if (letter == EOF) break;
      data[static_cast<std::size_t>(count++)] = static_cast<char>(letter);
    }
  } else {
    const int descriptor = files_.descriptor_of(argument(0));
    if (descriptor < 0) return {-1, EBADF};
    count = read(descriptor, data.data(), data.size());
  }
  if (count < 0) return {-1, errno};
  memory_.set_bytes(argument(1), std::string_view(data).substr(0, static_cast<std::size_t>(count)));
  return {count, 0};
}

AssistedCalls::Result AssistedCalls::write_descriptor() {
  const std::uint32_t to = argument(0);
  const std::string data = memory_.bytes(argument(1), argument(2));
  if (to == STDOUT_FILENO || to == STDERR_FILENO) return print(to + 1, data);  // its handle is one more
  const int descriptor = files_.descriptor_of(to);
  if (descriptor < 0) return {-1, EBADF};
  return of_host(write(descriptor, data.data(), data.size()));
}

/// stat and lstat
AssistedCalls::Result AssistedCalls::status_of_path(int more_flags) {
  const int descriptor = files_.open(memory_.text(argument(0)), O_PATH | O_CLOEXEC | more_flags, 0);
  if (descriptor < 0) return {-1, errno};
  const Result result = store_status(descriptor);
  close(descriptor);
  return result;
}

/// A word for each member that newlib knows, in its order. [newlib, jsre.h] documented
AssistedCalls::Result AssistedCalls::store_status(int descriptor) {
  struct stat status {};
  if (fstat(descriptor, &status) != 0) return {-1, errno};
  if (status.st_size > INT32_MAX) return {-1, EOVERFLOW};
  std::uint32_t to = argument(1);
  const auto store = [&](auto value) {
    memory_.set_word(to, static_cast<std::uint32_t>(value));
    to += 4;
  };
  store(status.st_dev);
  store(status.st_ino);
  store(status.st_mode);
  store(status.st_nlink);
  store(status.st_uid);
  store(status.st_gid);
  store(status.st_rdev);
  store(status.st_size);
  store(status.st_blksize);
  store(status.st_blocks);
  store(status.st_atim.tv_sec);
  store(status.st_mtim.tv_sec);
  store(status.st_ctim.tv_sec);
  return {0, 0};
}

/// Seconds and nanoseconds, a word each.
AssistedCalls::Result AssistedCalls::sleep() {
  using namespace std::chrono;
  const auto second = static_cast<std::int32_t>(memory_.word(argument(0)));
  const auto fraction = static_cast<std::int32_t>(memory_.word(argument(0) + 4));
  if (second < 0 || fraction < 0 || fraction >= 1000000000) return {-1, EINVAL};
  const auto end = steady_clock::now() + seconds(second) + nanoseconds(fraction);
  // In short naps, as the run may have to end; a signal does so, too.
  constexpr nanoseconds kNap = milliseconds(20);
  nanoseconds left = end - steady_clock::now();
  bool awake = false;
  for (; left > nanoseconds(0) && !awake; left = end - steady_clock::now()) {
    const timespec nap{0, static_cast<long>(std::min(left, kNap).count())};
    awake = nanosleep(&nap, nullptr) != 0 || files_.is_interrupted();
  }
  left = std::max(left, nanoseconds(0));
  if (const std::uint32_t to = argument(1); to != 0) {
    memory_.set_word(to, static_cast<std::uint32_t>(left / seconds(1)));
    memory_.set_word(to + 4, static_cast<std::uint32_t>(left % seconds(1) / nanoseconds(1)));
  }
  return awake ? Result{-1, EINTR} : Result{0, 0};
}

AssistedCalls::Result AssistedCalls::posix(std::uint32_t function) {
  const auto with_descriptor = [&](const auto& work) -> Result {
    const int descriptor = files_.descriptor_of(argument(0));
    if (descriptor < 0) return {-1, EBADF};
    return of_host(work(descriptor));
  };
  switch (function) {
    case kOpen:
      return open_descriptor();
    case kRead:
      return read_descriptor();
    case kWrite:
      return write_descriptor();
    case kNanosleep:
      return sleep();
    case kLseek:
      return with_descriptor([&](int descriptor) {
        return lseek(descriptor, static_cast<std::int32_t>(argument(1)), static_cast<int>(argument(2)));
      });
    case kFtruncate:
      return with_descriptor(
          [&](int descriptor) { return ftruncate(descriptor, static_cast<std::int32_t>(argument(1))); });
    case kStat:
      return status_of_path(0);
    case kLstat:
      return status_of_path(O_NOFOLLOW);
    case kFstat: {
      const int descriptor = files_.descriptor_of(argument(0));
      return descriptor < 0 ? Result{-1, EBADF} : store_status(descriptor);
    }
    case kClose:
      return of_host(files_.close_descriptor(argument(0)));
    case kUnlink:
      return of_host(files_.remove(memory_.text(argument(0))));
    case kAccess: {
      // A file that can be opened in this way may be accessed in this way.
      const bool writes = (argument(1) & W_OK) != 0;
      const int descriptor = files_.open(memory_.text(argument(0)), writes ? O_WRONLY : O_RDONLY, 0);
      if (descriptor < 0) return {-1, errno};
      close(descriptor);
      return {0, 0};
    }
    case kGettimeofday: {
      timeval now{};
      gettimeofday(&now, nullptr);
      const std::uint32_t to = argument(0);
      memory_.set_word(to, static_cast<std::uint32_t>(now.tv_sec));
      memory_.set_word(to + 4, static_cast<std::uint32_t>(now.tv_usec));
      return {0, 0};
    }
    default:
      return {-1, ENOSYS};
  }
}

}  // namespace softcell::ls_sim::assisted
