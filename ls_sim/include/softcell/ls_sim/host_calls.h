#pragma once
// What a program built for the SPU may have the host do for it: print, read, and work on files.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string_view>

namespace softcell::ls_sim {

/// Without it, such a call ends the run with its stop code, 0x2100 or 0x2101. Of the C library there are the families of printf and
/// scanf, fopen and what works on streams, remove and rename; of POSIX open, close, read, write, lseek, ftruncate, access,
/// unlink, gettimeofday and nanosleep. All others fail with ENOSYS. A kernel that is built for the host needs none of this: it has the same
/// calls, for all that the process may do. [libspe2, newlib] second-hand
struct HostCalls {
  /// Called with what a program prints, by the thread that runs its SPE; several SPEs may call at once.
  std::function<void(std::string_view text)> standard_output, standard_error;
  /// Called for what a program reads. @return  how many bytes there were, 0 at the end of the input; nothing: there are none yet, and it is
  /// to be called again. It waits no longer than a run may last after its end is wanted.
  std::function<std::optional<std::size_t>(std::span<char> to)> standard_input;
  /// The only folder in which programs may open and remove files; none: they may not at all. No path leads out of it,
  /// not even by a symbolic link.
  std::optional<std::filesystem::path> folder;
};

}  // namespace softcell::ls_sim
