#pragma once
// Runs a program with additional variables in its environment.

#include <unistd.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "softcell/base/temporary_folder.h"
#include "verb/interrupt.h"

namespace softcell::tool {

struct ChildEnd {
  int status = 0;  ///< its exit status; if a signal has ended it, 128 + the signal, as shells report it
  int signal = 0;  ///< 0: no signal has ended it
};

/// Who gets the terminal's Ctrl-C while a program runs.
enum class Interrupts {
  kOfTheProgram,         ///< the program alone
  kOfTheProgramAndOurs,  ///< the guard notes them, too
};

/// Runs a program and waits for its end. It gets the terminal's signals; when the guard notes one, the program also gets SIGTERM.
/// @param words       the program, searched for as a shell does, and its arguments; not empty.
/// @param variables   are set in its environment; an empty value removes the variable.
/// @param output      a file that receives its standard output; empty: it shares the caller's.
/// @param input       the descriptor that it reads as its standard input.
/// @throws std::runtime_error  the program cannot be started; the message says why.
ChildEnd run_child(const std::vector<std::string>& words, const std::map<std::string, std::string>& variables,
                   const InterruptGuard& guard, Interrupts interrupts,
                   const std::filesystem::path& output = {}, int input = STDIN_FILENO);

/// The files that runs of a program write.
class RunFolder {
 public:
  const std::filesystem::path& path() const { return folder_.path(); }
  /// The text of a file in the folder; empty if there is none.
  std::string text(const std::string& name) const;
  /// The texts of the files in the folder with this ending (".json"), sorted by the numbers that the files' names are.
  std::vector<std::string> texts(const std::string& extension) const;

 private:
  base::TemporaryFolder folder_{"softcell-run"};
};

}  // namespace softcell::tool
