#pragma once
// What a program built for the SPU may have the host do for it: print, and read and write files.

#include <filesystem>
#include <functional>
#include <optional>
#include <string_view>

namespace softcell::ls_sim {

/// Without it, such a call ends the run with its stop code, 0x2100 or 0x2101. Of the C library there are printf and its
/// family, puts, fputs, putchar, fputc, putc, fwrite and fflush on the streams stdout and stderr; of POSIX there are
/// open, close, read, write, lseek and unlink. All others fail with ENOSYS. [libspe2, newlib] second-hand
struct HostCalls {
  /// Called with what a program prints, by the thread that runs its SPE; several SPEs may call at once.
  std::function<void(std::string_view text)> standard_output, standard_error;
  /// The only folder in which programs may open and remove files; none: they may not at all. No path leads out of it,
  /// not even by a symbolic link.
  std::optional<std::filesystem::path> folder;
};

}  // namespace softcell::ls_sim
