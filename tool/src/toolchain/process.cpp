#include "process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

extern char** environ;

namespace softcell::toolchain {
namespace {

std::vector<char*> pointers_to(const Words& words) {
  std::vector<char*> pointers;
  for (const std::string& word : words) pointers.push_back(const_cast<char*>(word.c_str()));
  pointers.push_back(nullptr);
  return pointers;
}

pid_t spawn(const Words& command, posix_spawn_file_actions_t& actions) {
  pid_t child = 0;
  const int error =
      posix_spawnp(&child, command.front().c_str(), &actions, nullptr, pointers_to(command).data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw std::runtime_error("cannot run " + command.front() + ": " + std::strerror(error));
  return child;
}

volatile std::sig_atomic_t caught = 0;

int status_of(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    if (caught != 0) kill(child, SIGTERM);
  }
  if (caught != 0) throw Ended{caught};
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

}  // namespace

void catch_signals() {
  struct sigaction action {};
  action.sa_handler = [](int signal) { caught = signal; };
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
    struct sigaction present {};
    sigaction(signal, nullptr, &present);
    if (present.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
  }
}

void end_by(int signal) {
  std::signal(signal, SIG_DFL);
  std::raise(signal);
  std::abort();
}

int run(const Words& command, bool quiet) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (quiet) posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  return status_of(spawn(command, actions));
}

std::string output_of(const Words& command, bool quiet) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("cannot make a pipe");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  if (quiet) posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  const pid_t child = spawn(command, actions);
  close(ends[1]);
  std::string text;
  std::array<char, 4096> part;
  for (ssize_t got; (got = read(ends[0], part.data(), part.size())) > 0;)
    text.append(part.data(), static_cast<std::size_t>(got));
  close(ends[0]);
  if (const int status = status_of(child); status != 0) throw Failed{status};
  while (text.ends_with('\n')) text.pop_back();
  return text;
}

void become(const Words& command) {
  execvp(command.front().c_str(), pointers_to(command).data());
  throw std::runtime_error("cannot run " + command.front() + ": " + std::strerror(errno));
}

std::filesystem::path ScratchFolder::file(const std::string& name) {
  const auto folder = folder_.path() / std::to_string(files_++);
  std::filesystem::create_directory(folder);
  return folder / name;
}

void run_or_fail(const Words& command) {
  if (const int status = run(command); status != 0) throw Failed{status};
}

}  // namespace softcell::toolchain
