#include "child_process.h"
#include "softcell/base/assert.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string_view>

extern char** environ;

namespace softcell::tool {
namespace {

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<std::string> environment_with(const std::map<std::string, std::string>& variables) {
  SC_ASSERT(std::ranges::none_of(variables,
                                 [](const auto& variable) {
                                   return variable.first.empty() ||
                                          variable.first.find('=') != std::string::npos;
                                 }),
            "one of {} variables has no name, or = in it", variables.size());
  std::vector<std::string> environment;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    if (!variables.contains(std::string(text.substr(0, text.find('='))))) environment.emplace_back(text);
  }
  for (const auto& [name, value] : variables) {
    if (!value.empty()) environment.push_back(name + "=" + value);
  }
  return environment;
}

/// Why a program was not started. A name without a slash is only searched for in the folders of PATH.
std::string why_not_run(const std::string& program, int error) {
  if (error != ENOENT) return std::strerror(error);
  if (program.find('/') != std::string::npos) return "there is no such file";
  const bool is_here = std::filesystem::exists(program);
  return "no folder of PATH has it" + (is_here ? "; did you mean ./" + program + "?" : std::string());
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// While the object lives, the terminal's Ctrl-\ ends only the child, and so does Ctrl-C unless it is ours, too.
class InterruptsLeftToTheChild {
 public:
  explicit InterruptsLeftToTheChild(Interrupts interrupts) {
    struct sigaction ignore {};
    ignore.sa_handler = SIG_IGN;
    sigaction(SIGINT, interrupts == Interrupts::kOfTheProgram ? &ignore : nullptr, &interrupt_);
    sigaction(SIGQUIT, &ignore, &quit_);
  }
  ~InterruptsLeftToTheChild() {
    sigaction(SIGINT, &interrupt_, nullptr);
    sigaction(SIGQUIT, &quit_, nullptr);
  }
  InterruptsLeftToTheChild(const InterruptsLeftToTheChild&) = delete;
  InterruptsLeftToTheChild& operator=(const InterruptsLeftToTheChild&) = delete;

 private:
  struct sigaction interrupt_ {
  }, quit_{};
};

/// Returns when the child has ended. Until then it gets a SIGTERM for each signal that the guard notes.
void wait_for(pid_t child, const InterruptGuard& guard) {
  SC_ASSERT(child > 0, "the process {} is no child", child);
  pollfd end{static_cast<int>(syscall(SYS_pidfd_open, child, 0)), POLLIN, 0};
  if (end.fd < 0) return;  // no such call in this kernel: waitpid() waits
  // Held back but within ppoll(), so that none arrives between the question and the wait.
  sigset_t noted, usual;
  sigemptyset(&noted);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&noted, signal);
  sigprocmask(SIG_BLOCK, &noted, &usual);
  do {
    if (guard.interrupted()) kill(child, SIGTERM);
  } while (ppoll(&end, 1, nullptr, &usual) < 0 && errno == EINTR);
  sigprocmask(SIG_SETMASK, &usual, nullptr);
  close(end.fd);
}

}  // namespace

ChildEnd run_child(const std::vector<std::string>& words, const std::map<std::string, std::string>& variables,
                   const InterruptGuard& guard, Interrupts interrupts, const std::filesystem::path& output,
                   int input) {
  SC_ASSERT(!words.empty(), "a child process of {} variables runs nothing", variables.size());
  std::vector<std::string> arguments = words, environment = environment_with(variables);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (!output.empty())
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                     0600);
  if (input != STDIN_FILENO) posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t usual;
  sigemptyset(&usual);
  sigaddset(&usual, SIGINT);
  sigaddset(&usual, SIGQUIT);
  sigaddset(&usual, SIGXFSZ);  // main() ignores it
  posix_spawnattr_setsigdefault(&attributes, &usual);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);

  const InterruptsLeftToTheChild here(interrupts);
  pid_t child = 0;
  const int error = posix_spawnp(&child, arguments.front().c_str(), &actions, &attributes,
                                 pointers_to(arguments).data(), pointers_to(environment).data());
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (error != 0)
    throw std::runtime_error("cannot run " + words.front() + ": " + why_not_run(words.front(), error));
  wait_for(child, guard);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status)) return {128 + WTERMSIG(status), WTERMSIG(status)};
  return {WEXITSTATUS(status), 0};
}

std::string RunFolder::text(const std::string& name) const { return text_of(path() / name); }

std::vector<std::string> RunFolder::texts(const std::string& extension) const {
  // Of numbers, the shorter one is the smaller one.
  const auto comes_before = [](const std::filesystem::path& a, const std::filesystem::path& b) {
    const std::size_t a_length = a.native().size(), b_length = b.native().size();
    return a_length != b_length ? a_length < b_length : a < b;
  };
  std::set<std::filesystem::path, decltype(comes_before)> files;
  for (const auto& file : std::filesystem::directory_iterator(path())) files.insert(file.path());
  std::vector<std::string> texts;
  for (const std::filesystem::path& file : files)
    // A process that was ended while it wrote has left a hidden file.
    if (file.extension() == extension && !file.filename().string().starts_with('.'))
      texts.push_back(text_of(file));
  return texts;
}

}  // namespace softcell::tool
