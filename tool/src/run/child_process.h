#pragma once
// A program that runs with settings of its own in the environment.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace softcell::tool {

struct ChildEnd {
  int status = 0;  ///< its exit status; of one that a signal has ended, 128 + the signal, as a shell says it
  int signal = 0;  ///< 0: none has ended it
};

/// Runs a program and waits for its end. It has the terminal's signals; while it runs, those do not end the caller.
/// @param words       the program, looked for as a shell does, and its arguments; not empty.
/// @param variables   are set in its environment; an empty value takes one away.
/// @param output      a file that receives its standard output; empty: it has the caller's.
/// @throws std::runtime_error  it cannot be started; the message says why.
ChildEnd run_child(const std::vector<std::string>& words, const std::map<std::string, std::string>& variables,
                   const std::filesystem::path& output = {});

/// A folder of its own among the temporary files, which goes with the object and what is in it.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Of a file in it; empty if there is none.
  std::string text(const std::string& name) const;
  /// Of each file in it that ends so (".json"), by the files' names.
  std::vector<std::string> texts(const std::string& extension) const;

 private:
  std::filesystem::path path_;
};

}  // namespace softcell::tool
