#include "gdb_connection.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <numeric>
#include <stdexcept>

namespace softcell::tool {
namespace {

constexpr int kMomentMilliseconds = 50;
constexpr std::size_t kMostBytes = 1 << 20;  // of received bytes that are no complete packet yet
constexpr char kInterrupt = 3, kEscape = '}';
constexpr char kEscapeBit = 0x20;

int value_of(char digit) {
  if (digit >= '0' && digit <= '9') return digit - '0';
  if (digit >= 'a' && digit <= 'f') return digit - 'a' + 10;
  if (digit >= 'A' && digit <= 'F') return digit - 'A' + 10;
  return -1;
}

unsigned checksum(std::string_view contents) {
  return std::accumulate(contents.begin(), contents.end(), 0u,
                         [](unsigned sum, char c) { return (sum + static_cast<unsigned char>(c)) & 0xFF; });
}

std::string unescaped(std::string_view contents) {
  std::string text;
  for (std::size_t i = 0; i < contents.size(); ++i) {
    if (contents[i] == kEscape && i + 1 < contents.size()) {
      text += static_cast<char>(contents[++i] ^ kEscapeBit);
    } else {
      text += contents[i];
    }
  }
  return text;
}

bool is_readable(int descriptor, int milliseconds) {
  pollfd one{.fd = descriptor, .events = POLLIN, .revents = 0};
  return poll(&one, 1, milliseconds) > 0;
}

}  // namespace

GdbConnection::GdbConnection(std::uint16_t port) : listener_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  const int on = 1;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);  // only this host may connect
  socklen_t bytes = sizeof address;
  if (listener_ < 0 || setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) != 0 ||
      bind(listener_, reinterpret_cast<const sockaddr*>(&address), bytes) != 0 || listen(listener_, 1) != 0 ||
      getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &bytes) != 0) {
    const std::string reason = std::strerror(errno);
    if (listener_ >= 0) close(listener_);
    throw std::runtime_error(
        fmt::format("--port {}: a debugger cannot be waited for there: {}", port, reason));
  }
  port_ = ntohs(address.sin_port);
}

GdbConnection::~GdbConnection() {
  if (socket_ >= 0) close(socket_);
  close(listener_);
}

bool GdbConnection::accept() {
  if (!is_readable(listener_, kMomentMilliseconds)) return false;
  socket_ = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
  if (socket_ < 0) return false;
  const int on = 1;
  setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  return true;
}

bool GdbConnection::read_some(int milliseconds) {
  if (is_closed_ || !is_readable(socket_, milliseconds)) return false;
  std::array<char, 4096> bytes{};
  const ssize_t count = recv(socket_, bytes.data(), bytes.size(), 0);
  if (count <= 0 || received_.size() > kMostBytes) {
    is_closed_ = true;
    return false;
  }
  received_.append(bytes.data(), static_cast<std::size_t>(count));
  return true;
}

/// Skips acknowledgements and broken packets. It reports broken packets to the debugger, which sends them again.
std::optional<std::string> GdbConnection::extract_packet() {
  for (;;) {
    const std::size_t begin = received_.find('$');
    if (begin == std::string::npos) return std::nullopt;
    const std::size_t end = received_.find('#', begin);
    if (end == std::string::npos || end + 2 >= received_.size()) return std::nullopt;
    const std::string contents = received_.substr(begin + 1, end - begin - 1);
    const int high = value_of(received_[end + 1]), low = value_of(received_[end + 2]);
    const bool is_right =
        high >= 0 && low >= 0 && checksum(contents) == static_cast<unsigned>(high * 16 + low);
    received_.erase(0, end + 3);
    if (acknowledges_) ::send(socket_, is_right ? "+" : "-", 1, MSG_NOSIGNAL);
    if (is_right) return unescaped(contents);
  }
}

std::optional<std::string> GdbConnection::receive() {
  if (auto packet = extract_packet()) return packet;
  read_some(kMomentMilliseconds);
  return extract_packet();
}

bool GdbConnection::poll_interrupt() {
  read_some(0);
  const std::size_t at = received_.find(kInterrupt);
  if (at == std::string::npos) return is_closed_;  // there is nobody to wait for
  received_.erase(at, 1);
  return true;
}

void GdbConnection::send(std::string_view contents) {
  const std::string packet = fmt::format("${}#{:02x}", contents, checksum(contents));
  for (std::size_t sent = 0; sent < packet.size() && !is_closed_;) {
    const ssize_t count = ::send(socket_, packet.data() + sent, packet.size() - sent, MSG_NOSIGNAL);
    if (count <= 0)
      is_closed_ = true;
    else
      sent += static_cast<std::size_t>(count);
  }
}

std::string hexadecimal_of(std::string_view bytes) {
  std::string text;
  for (const char byte : bytes) text += fmt::format("{:02x}", static_cast<unsigned char>(byte));
  return text;
}

std::optional<std::string> bytes_of(std::string_view hexadecimal) {
  if (hexadecimal.size() % 2 != 0) return std::nullopt;
  std::string bytes;
  for (std::size_t i = 0; i < hexadecimal.size(); i += 2) {
    const int high = value_of(hexadecimal[i]), low = value_of(hexadecimal[i + 1]);
    if (high < 0 || low < 0) return std::nullopt;
    bytes += static_cast<char>(high * 16 + low);
  }
  return bytes;
}

}  // namespace softcell::tool
