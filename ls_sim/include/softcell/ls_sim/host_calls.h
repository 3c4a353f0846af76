#pragma once
// The calls that the host serves for a program built for the SPU: print, read, and work on files.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string_view>

namespace softcell::ls_sim {

/// Without it, such a call ends the run with its stop code, 0x2100 or 0x2101. Of the C library the host serves the families of printf and
/// scanf, fopen, freopen and the functions on streams, remove and rename; of POSIX open, close, read, write, lseek, ftruncate, access,
/// unlink, stat, lstat, fstat, gettimeofday and nanosleep. All others fail with ENOSYS. A kernel that is built for the host does not need
/// it: it makes the same calls itself, for anything that the process may do. [libspe2, newlib] second-hand
struct HostCalls {
  /// Called with the text that a program prints, by the thread that runs its SPE; several SPEs may call at once.
  std::function<void(std::string_view text)> standard_output, standard_error;
  /// Called when a program reads its standard input. @return  how many bytes there were, 0 at the end of the input; nothing: there are none
  /// yet, and it will be called again. It must return soon even if there is no input: until it returns, a run that is stopped or has passed
  /// its deadline cannot end.
  std::function<std::optional<std::size_t>(std::span<char> to)> standard_input;
  /// The only folder in which programs may open and remove files; none: they cannot open or remove any. No path leads out of it, not even
  /// through a symbolic link.
  std::optional<std::filesystem::path> folder;
};

}  // namespace softcell::ls_sim
