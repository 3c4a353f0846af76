#include "kept_input.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

#include "softcell/base/assert.h"

namespace softcell::tool {
namespace {

[[noreturn]] void refuse_input(const char* what) {
  throw std::runtime_error(std::string("the program's standard input cannot be kept for several runs: ") +
                           what + ": " + std::strerror(errno));
}

std::array<int, 2> new_pipe() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) refuse_input("pipe");
  return ends;
}

/// Waits until the descriptor is ready. @return  false: the copy is to stop.
bool is_ready(int descriptor, short events, int stop) {
  std::array<pollfd, 2> both{pollfd{descriptor, events, 0}, pollfd{stop, POLLIN, 0}};
  while (poll(both.data(), both.size(), -1) < 0 && errno == EINTR) {
  }
  return both[1].revents == 0;
}

void close_if_open(int& descriptor) {
  if (descriptor >= 0) close(descriptor);
  descriptor = -1;
}

}  // namespace

KeptInput::KeptInput(std::filesystem::path file) : file_(std::move(file)) {
  struct stat status {};
  if (fstat(STDIN_FILENO, &status) != 0) return;  // it is closed
  is_pipe_ = S_ISFIFO(status.st_mode) || S_ISSOCK(status.st_mode);
  if (S_ISREG(status.st_mode)) begin_ = lseek(STDIN_FILENO, 0, SEEK_CUR);
}

KeptInput::~KeptInput() { end_run(); }

int KeptInput::begin_run() {
  end_run();
  if (begin_) lseek(STDIN_FILENO, *begin_, SEEK_SET);
  if (!is_pipe_) return STDIN_FILENO;
  if (!std::exchange(is_kept_, true)) {
    begin_copy();
  } else {
    input_ = open(file_.c_str(), O_RDONLY | O_CLOEXEC);
    if (input_ < 0) refuse_input(file_.c_str());
  }
  return input_;
}

void KeptInput::end_run() {
  close_if_open(stop_);
  if (copier_.joinable()) copier_.join();
  close_if_open(input_);
}

void KeptInput::begin_copy() {
  SC_ASSERT(input_ < 0 && stop_ < 0, "a copy of standard input begins beside another: {}, {}", input_, stop_);
  const int kept = open(file_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (kept < 0) refuse_input(file_.c_str());
  const auto [from, to] = new_pipe();
  const auto [stop, stopper] = new_pipe();
  fcntl(to, F_SETFL, O_NONBLOCK);
  input_ = from;
  stop_ = stopper;
  copier_ = std::jthread([this, kept, to = to, stop = stop] { copy(kept, to, stop); });
}

/// Takes no more than the program reads, and what a pipe holds.
void KeptInput::copy(int kept, int to, int stop) {
  sigset_t broken_pipe;
  sigemptyset(&broken_pipe);
  sigaddset(&broken_pipe, SIGPIPE);
  pthread_sigmask(SIG_BLOCK, &broken_pipe, nullptr);
  std::array<char, 4096> bytes{};
  bool goes_on = true;
  while (goes_on && is_ready(STDIN_FILENO, POLLIN, stop)) {
    const ssize_t count = read(STDIN_FILENO, bytes.data(), bytes.size());
    if (count <= 0) break;
    goes_on = write(kept, bytes.data(), static_cast<std::size_t>(count)) == count;
    for (ssize_t at = 0; goes_on && at < count;) {
      goes_on = is_ready(to, POLLOUT, stop);
      const ssize_t written =
          goes_on ? write(to, bytes.data() + at, static_cast<std::size_t>(count - at)) : 0;
      if (written < 0 && errno != EAGAIN) goes_on = false;
      at += written > 0 ? written : 0;
    }
  }
  close(to);
  close(kept);
  close(stop);
}

}  // namespace softcell::tool
