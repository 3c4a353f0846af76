#pragma once
// Runs other programs, and keeps temporary files.

#include <filesystem>
#include <string>
#include <vector>

#include "softcell/base/temporary_folder.h"

namespace softcell::toolchain {

using Words = std::vector<std::string>;

/// A signal wants this process to end.
struct Ended {
  int signal;
};

/// From here on Ctrl-C, SIGTERM and their like end the program that is run, and are thrown as Ended when it has ended, so that no temporary
/// file is left. A signal that is ignored stays so.
void catch_signals();

/// Ends this process as the signal would have done. @pre  catch_signals() was called
[[noreturn]] void end_by(int signal);

/// Runs a program and waits for its end. It shares our standard input, output and error.
/// @param quiet  drops its standard error.
/// @return  its status; 1 if a signal has ended it.
/// @throws std::runtime_error  it cannot be run; the message names it.
/// @throws Ended
int run(const Words& command, bool quiet = false);

/// Like run(), but returns what the program prints on standard output, without the last line's end.
/// @throws Failed  its status is not 0.
std::string output_of(const Words& command, bool quiet = false);

/// Replaces this process by another program. @throws std::runtime_error  it cannot be run.
[[noreturn]] void become(const Words& command);

/// The temporary files of a command.
class ScratchFolder {
 public:
  /// A name in the folder that no other call gets.
  std::filesystem::path file(const std::string& name);

 private:
  base::TemporaryFolder folder_{"softcell-spu"};
  int files_ = 0;
};

/// Ends the command with this status. The program that it has called has printed why.
struct Failed {
  int status;
};

/// run(), and Failed if its status is not 0.
void run_or_fail(const Words& command);

}  // namespace softcell::toolchain
