#include "documents.h"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>

#include "lua_sandbox.h"
#include "value_message.h"

namespace softcell::demos {
namespace {

/// A running child and the end of the pipe through which it answers.
class Child {
 public:
  Child(std::string_view chunk, const Location& location) {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) refuse(location);
    process_ = fork();
    if (process_ == 0) {
      close_range(0, static_cast<unsigned>(ends[1]) - 1, 0);
      close_range(static_cast<unsigned>(ends[1]) + 1, ~0u, 0);
      run_sandboxed(chunk, ends[1]);
    }
    close(ends[1]);
    answer_ = ends[0];
    if (process_ < 0) {
      close(answer_);
      refuse(location);
    }
  }
  ~Child() {
    close(answer_);
    kill(process_, SIGKILL);
    while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Everything that the child writes until it ends or its time is over.
  std::string answer() const {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(kLuaAnswerSeconds);
    std::string message;
    std::array<char, 65536> buffer;
    while (message.size() <= 2 * MessageWriter::kMaxBytes) {
      const auto left =
          std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
      if (left.count() <= 0) break;
      pollfd ready{.fd = answer_, .events = POLLIN, .revents = 0};
      if (poll(&ready, 1, static_cast<int>(left.count())) < 0 && errno != EINTR) break;
      if (ready.revents == 0) continue;
      const ssize_t size = read(answer_, buffer.data(), buffer.size());
      if (size < 0 && errno == EINTR) continue;
      if (size <= 0) break;
      message.append(buffer.data(), static_cast<std::size_t>(size));
    }
    return message;
  }

 private:
  [[noreturn]] static void refuse(const Location& location) {
    throw SceneError(location,
                     fmt::format("cannot start a process for the script: {}", std::strerror(errno)));
  }

  pid_t process_ = -1;
  int answer_ = -1;
};

}  // namespace

Value run_lua(std::string_view chunk, const std::shared_ptr<const std::string>& file) {
  const Location location{file, 1, 0};
  const std::string message = Child(chunk, location).answer();
  if (auto value = read_message(message, file)) return std::move(*value);
  throw SceneError(location,
                   fmt::format("the script was stopped: it needs more than {} second, or more memory than "
                               "it may have",
                               kLuaSeconds));
}

}  // namespace softcell::demos
