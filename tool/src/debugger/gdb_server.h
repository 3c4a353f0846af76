#pragma once
// Serves GDB's remote protocol for programs on SPEs.

#include <optional>
#include <string>
#include <string_view>

#include "debug_session.h"
#include "gdb_connection.h"

namespace softcell::tool {

/// The debugger's thread n is SPE n - 1. Registers are those of GDB's port to the SPU: 128 general ones, then the SPE's number and the
/// program counter. Addresses are those of the selected thread's local store.
class GdbServer {
 public:
  /// @param connection, session  must outlive this object
  GdbServer(GdbConnection& connection, DebugSession& session) : connection_(connection), session_(session) {}

  /// How the debugger has left.
  enum class End : std::uint8_t {
    kDetached,  ///< the program goes on without it
    kKilled,    ///< the program ends; also if the connection broke
    kEnded,     ///< after the program's end
  };
  /// Serves until the debugger leaves. @param interrupted  as for DebugSession; true ends the service.
  End serve(const DebugSession::Interrupted& interrupted);

 private:
  std::string answer(const std::string& packet);
  std::string about(std::string_view query);
  std::string features(std::string_view request) const;
  std::string select_thread(std::string_view packet);
  std::string read_registers() const;
  std::string write_registers(std::string_view text);
  std::string read_register(std::string_view text) const;
  std::string write_register(std::string_view text);
  std::string read_memory(std::string_view text) const;
  std::string write_memory(std::string_view text, bool is_binary);
  std::string change_point(std::string_view packet);
  std::string resume(std::string_view action);
  void print_in_debugger(const std::string& sentence);
  std::string report(const DebugStop& stop);
  std::string bytes_of_register(int number) const;
  DebugSession::Interrupted interrupted() const;

  GdbConnection& connection_;
  DebugSession& session_;
  DebugSession::Interrupted wants_end_;
  DebugStop stop_;
  int spe_ = 0;  ///< the selected SPE
  std::optional<End> end_;
};

}  // namespace softcell::tool
