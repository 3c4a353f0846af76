#pragma once
// Calls of a program that the host serves: stop 0x2100 for the C library, stop 0x2101 for POSIX.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "call_arguments.h"
#include "softcell/ls_sim/channels.h"
#include "softcell/ls_sim/host_calls.h"

namespace softcell::ls_sim::interpreter {

inline constexpr std::uint32_t kC99Call = kAssistedCalls,
                               kPosixCall = kAssistedCalls + 1;  // [libspe2] second-hand

/// The files that one SPE's program has open. Used by the thread that runs the SPE.
class AssistedCalls {
 public:
  /// @param calls  outlives this.
  AssistedCalls(const HostCalls& calls, std::span<std::byte> local_store)
      : calls_(calls), memory_(local_store) {}
  ~AssistedCalls() { close_all(); }
  AssistedCalls(const AssistedCalls&) = delete;
  AssistedCalls& operator=(const AssistedCalls&) = delete;

  /// Serves the call and writes its result over its first argument.
  /// @param code  kC99Call or kPosixCall. @param message  the word after the stop: opcode and address of arguments.
  void serve(std::uint32_t code, std::uint32_t message);

  /// As at the end of a process.
  void close_all();

 private:
  struct Result {
    std::int64_t value = -1;
    int error = 0;
  };

  std::uint32_t argument(int number) const {
    return memory_.word(arguments_ + static_cast<std::uint32_t>(number) * dma::kQuadwordBytes);
  }
  Result c99(std::uint32_t opcode);
  Result posix(std::uint32_t opcode);
  Result print(std::uint32_t stream, std::string_view text) const;
  std::string formatted(int format_argument);
  Result store_text(std::uint32_t to, std::uint32_t room, const std::string& text);
  Result open_file();
  Result read_file();
  Result write_file();
  Result seek_file();
  Result unlink_file() const;
  int host_file(std::uint32_t file) const;

  const HostCalls& calls_;
  CallMemory memory_;
  std::uint32_t arguments_ = 0;
  std::vector<int> files_;  ///< of the host, by the program's number less 3; -1 is free
};

}  // namespace softcell::ls_sim::interpreter
