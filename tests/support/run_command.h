#pragma once
// Runs the command `softcell` as a user would.

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

namespace softcell::tests {

struct CommandResult {
  int status = -1;     ///< exit status, or 128 + signal
  std::string output;  ///< standard output and error
};

inline CommandResult run_shell(const std::string& line_of_shell) {
  const std::string line = "( " + line_of_shell + " ) 2>&1";
  CommandResult result;
  std::FILE* pipe = popen(line.c_str(), "r");
  if (pipe == nullptr) return result;
  std::array<char, 4096> buffer{};
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
    result.output.append(buffer.data(), n);
  const int status = pclose(pipe);
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

/// @param arguments  as typed in a shell.
inline CommandResult run_softcell(const std::string& arguments) {
  return run_shell(std::string(SOFTCELL_COMMAND) + " " + arguments);
}

}  // namespace softcell::tests
