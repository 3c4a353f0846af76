#pragma once
// Sends and receives packets of GDB's remote protocol over a socket.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace softcell::tool {

/// A socket of this host that waits for one debugger. [GDB manual, remote protocol] documented
class GdbConnection {
 public:
  /// @param port  0: any free port
  /// @throws std::runtime_error  the port cannot be used.
  explicit GdbConnection(std::uint16_t port);
  ~GdbConnection();
  GdbConnection(const GdbConnection&) = delete;
  GdbConnection& operator=(const GdbConnection&) = delete;

  std::uint16_t port() const { return port_; }

  /// Waits a short time for the debugger. @return  whether it has connected.
  bool accept();

  /// Waits a short time for the next packet and acknowledges it.
  /// @return  its contents, unescaped; none if no packet has come yet.
  std::optional<std::string> receive();
  /// @return  whether the debugger has sent its byte 3, which asks for a stop, since the last call.
  bool poll_interrupt();
  void send(std::string_view contents);

  /// Call it when the debugger no longer wants acknowledgements.
  void stop_acknowledging() { acknowledges_ = false; }
  bool is_closed() const { return is_closed_; }

 private:
  bool read_some(int milliseconds);
  std::optional<std::string> extract_packet();

  int listener_ = -1, socket_ = -1;
  std::uint16_t port_ = 0;
  bool acknowledges_ = true, is_closed_ = false;
  std::string received_;
};

// Numbers as the protocol writes them.
std::string hexadecimal_of(std::string_view bytes);
/// @return  none if the text is no sequence of pairs of hexadecimal digits.
std::optional<std::string> bytes_of(std::string_view hexadecimal);

}  // namespace softcell::tool
