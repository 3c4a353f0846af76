#pragma once
// Calls of a program on an SPE that the PPU side serves: stop 0x2100 for the C library, stop 0x2101 for POSIX.
// [libspe2, C99 and POSIX handlers; newlib, jsre.h] documented

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "call_memory.h"
#include "files.h"
#include "format.h"
#include "softcell/ls_sim/channels.h"

namespace softcell::ls_sim::assisted {

inline constexpr std::uint32_t kC99Call = kAssistedCalls, kPosixCall = kAssistedCalls + 1;

/// The functions' numbers.
enum C99Function : std::uint32_t {
  kClearerr = 1,
  kFclose = 2,
  kFeof = 3,
  kFerror = 4,
  kFflush = 5,
  kFgetc = 6,
  kFgets = 8,
  kFileno = 9,
  kFopen = 10,
  kFputc = 11,
  kFputs = 12,
  kFread = 13,
  kFreopen = 14,
  kFseek = 15,
  kFtell = 17,
  kFwrite = 18,
  kGetc = 19,
  kGetchar = 20,
  kPutc = 23,
  kPutchar = 24,
  kPuts = 25,
  kRemove = 26,
  kRename = 27,
  kRewind = 28,
  kTmpfile = 32,
  kUngetc = 34,
  kVfprintf = 35,
  kVfscanf = 36,
  kVprintf = 37,
  kVscanf = 38,
  kVsnprintf = 39,
  kVsprintf = 40,
  kVsscanf = 41
};
enum PosixFunction : std::uint32_t {
  kClose = 2,
  kFstat = 4,
  kGettimeofday = 7,
  kLseek = 9,
  kLstat = 10,
  kOpen = 15,
  kRead = 16,
  kStat = 23,
  kUnlink = 24,
  kWrite = 27,
  kFtruncate = 28,
  kAccess = 29,
  kNanosleep = 32
};

/// How a program passes values.
enum class CallerKind {
  kSpu,  ///< made by a compiler for the SPU: big-endian; a va_list is two words
  kHost  ///< built for the host: little-endian; a va_list is that of the x32 ABI
};

/// Used by the thread that runs the SPE.
class AssistedCalls {
 public:
  /// @param files  outlives this
  /// @param local_store  all 256 KB of it
  AssistedCalls(Files& files, std::span<std::byte> local_store, CallerKind kind)
      : files_(files),
        memory_(local_store, kind == CallerKind::kSpu ? std::endian::big : std::endian::little),
        kind_(kind) {}

  /// Sets a function that is called for each range of the local store before a call reads or writes it; empty: none.
  void set_listener(CallMemory::Listener listener) { memory_.set_listener(std::move(listener)); }

  /// Serves the call and writes its result over its first argument: the value in word 0, errno in word 3.
  /// @param code     kC99Call or kPosixCall
  /// @param request  the function's number in the upper 8 bits, and the local-store address of its arguments: a quadword each, with
  ///                 the value in word 0
  /// @return  the value. A function that is not served fails with ENOSYS.
  std::uint32_t serve(std::uint32_t code, std::uint32_t request);

 private:
  struct Result {
    std::int64_t value = -1;
    int error = 0;
  };

  std::uint32_t argument(int number) const {
    return memory_.word(arguments_ + static_cast<std::uint32_t>(number) * dma::kQuadwordBytes);
  }
  /// The result of a function of the host. A value below 0 is an error, whose number is errno.
  static Result of_host(std::int64_t value);

  Result c99(std::uint32_t function);
  // Each serves a part of the C library; nothing: the function is of another part.
  std::optional<Result> output(std::uint32_t function);
  std::optional<Result> input(std::uint32_t function);
  std::optional<Result> files(std::uint32_t function);
  Result posix(std::uint32_t function);

  Result print(std::uint32_t handle, const std::string& text);
  std::string formatted(int format_argument);
  Result store_text(std::uint32_t to, std::uint32_t room, const std::string& text);
  std::unique_ptr<FormatArguments> variable_arguments(int number);
  Result get_character(std::uint32_t handle);
  Result get_line();
  Result read_items();
  Result scan(std::FILE* from, int format_argument);
  Result scan_text();
  std::FILE* opened_stream();
  Result open_stream();
  Result reopen_stream();
  Result temporary_file();
  Result open_descriptor();
  Result read_descriptor();
  Result write_descriptor();
  Result status_of_path(int more_flags);
  Result store_status(int descriptor);
  Result sleep();

  Files& files_;
  CallMemory memory_;
  CallerKind kind_;
  std::uint32_t arguments_ = 0;
};

}  // namespace softcell::ls_sim::assisted
