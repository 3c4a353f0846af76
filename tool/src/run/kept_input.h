#pragma once
// The standard input of a program that runs several times: each run reads the same bytes.

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <thread>

namespace softcell::tool {

/// A file is read anew by each run. What comes through a pipe is copied to a file while the first run reads it, for the others. A terminal
/// is shared by all.
class KeptInput {
 public:
  /// @param file  where to keep what comes through a pipe.
  explicit KeptInput(std::filesystem::path file);
  ~KeptInput();
  KeptInput(const KeptInput&) = delete;
  KeptInput& operator=(const KeptInput&) = delete;

  /// Call it before each run. @return  the descriptor that is the run's standard input, until the next call.
  int begin_run();

 private:
  void end_run();
  void begin_copy();
  void copy(int kept, int to, int stop);

  const std::filesystem::path file_;
  std::optional<off_t> begin_;  ///< of a file: where the caller stands in it
  bool is_pipe_ = false, is_kept_ = false;
  int input_ = -1;  ///< of the current run, if it is not the caller's
  int stop_ = -1;   ///< closed when the first run has ended
  std::jthread copier_;
};

}  // namespace softcell::tool
