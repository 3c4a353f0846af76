#include "gdb_server.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <span>
#include <utility>
#include <vector>

namespace softcell::tool {
namespace {

constexpr int kNumberRegister = ls_sim::kSpuRegisters,
              kCounterRegister = kNumberRegister + 1;  // [GDB] second-hand
constexpr std::uint32_t kMostMemoryBytes = 4096;       // in one packet
constexpr const char* kOk = "OK";
constexpr const char* kBadRequest = "E01";
constexpr const char* kNotPossible = "E02";
constexpr const char* kUnknown = "";  // the protocol's answer to anything that is not supported

std::optional<std::uint32_t> number_of(std::string_view text, int base = 16) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Parses "ADDRESS,LENGTH" within a local store.
std::optional<std::pair<std::uint32_t, std::uint32_t>> range_of(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  const auto address = number_of(text.substr(0, comma)), length = number_of(text.substr(comma + 1));
  if (!address || !length || *address >= dma::kLocalStoreBytes) return std::nullopt;
  return std::pair(*address, std::min(*length, dma::kLocalStoreBytes - *address));
}

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift);
  return bytes;
}

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::vector<std::byte> memory_of(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

std::string target_description() {
  std::string text =
      "<?xml version=\"1.0\"?><!DOCTYPE target SYSTEM \"gdb-target.dtd\"><target version=\"1.0\">"
      "<architecture>spu:256K</architecture><feature name=\"org.softcell.spu\">";
  for (int i = 0; i < ls_sim::kSpuRegisters; ++i)
    text += fmt::format("<reg name=\"r{}\" bitsize=\"128\" type=\"uint128\" regnum=\"{}\"/>", i, i);
  text += fmt::format("<reg name=\"id\" bitsize=\"32\" type=\"uint32\" regnum=\"{}\"/>", kNumberRegister);
  text += fmt::format("<reg name=\"pc\" bitsize=\"32\" type=\"code_ptr\" regnum=\"{}\"/>", kCounterRegister);
  return text + "</feature></target>";
}

const char* name_of(Watchpoint::Kind kind) {
  switch (kind) {
    case Watchpoint::kStores:
      return "watch";
    case Watchpoint::kLoads:
      return "rwatch";
    default:
      return "awatch";
  }
}

}  // namespace

GdbServer::End GdbServer::serve(const DebugSession::Interrupted& interrupted) {
  wants_end_ = interrupted;
  stop_ = session_.start();
  spe_ = stop_.spe;
  while (!end_) {
    const auto packet = connection_.receive();
    if (packet) {
      const std::string reply = answer(*packet);
      connection_.send(reply);
      if (*packet == "QStartNoAckMode") connection_.stop_acknowledging();
    } else if (connection_.is_closed() || interrupted()) {
      break;
    }
  }
  return end_.value_or(stop_.kind == DebugStop::kEnded ? End::kEnded : End::kKilled);
}

DebugSession::Interrupted GdbServer::interrupted() const {
  return [this] { return connection_.poll_interrupt() || wants_end_(); };
}

std::string GdbServer::answer(const std::string& packet) {
  const std::string_view rest = std::string_view(packet).substr(std::min<std::size_t>(1, packet.size()));
  switch (packet.empty() ? '\0' : packet.front()) {
    case '?':
      return report(stop_);
    case 'q':
    case 'Q':
      return about(packet);
    case 'H':
      return select_thread(rest);
    case 'T': {
      const auto thread = number_of(rest);
      const bool exists = thread && *thread >= 1 && static_cast<int>(*thread) <= session_.spes();
      return exists && !session_.has_ended(static_cast<int>(*thread) - 1) ? kOk : kBadRequest;
    }
    case 'g':
      return read_registers();
    case 'G':
      return write_registers(rest);
    case 'p':
      return read_register(rest);
    case 'P':
      return write_register(rest);
    case 'm':
      return read_memory(rest);
    case 'M':
      return write_memory(rest, false);
    case 'X':
      return write_memory(rest, true);
    case 'Z':
    case 'z':
      return change_point(packet);
    case 'c':
    case 's':
      return rest.empty() ? resume(packet) : kNotPossible;  // a program counter cannot be set
    case 'b':
      return packet == "bs" || packet == "bc" ? resume(packet) : kUnknown;
    case 'D':
      end_ = stop_.kind == DebugStop::kEnded ? End::kEnded : End::kDetached;
      return kOk;
    case 'k':
      end_ = End::kKilled;
      return kOk;
    default:
      return kUnknown;
  }
}

std::string GdbServer::about(std::string_view query) {
  if (query.starts_with("qSupported"))
    return "PacketSize=4000;QStartNoAckMode+;qXfer:features:read+;ReverseStep+;ReverseContinue+";
  if (query == "QStartNoAckMode") return kOk;
  if (query == "qAttached") return "1";
  if (query == "qC") return fmt::format("QC{:x}", spe_ + 1);
  if (query == "qfThreadInfo") {
    std::string threads;
    for (int spe = 0; spe < session_.spes(); ++spe)
      if (!session_.has_ended(spe)) threads += fmt::format("{}{:x}", threads.empty() ? "m" : ",", spe + 1);
    return threads.empty() ? "l" : threads;
  }
  if (query == "qsThreadInfo") return "l";
  if (query.starts_with("qThreadExtraInfo,")) {
    const auto thread = number_of(query.substr(query.find(',') + 1));
    if (!thread || *thread < 1 || static_cast<int>(*thread) > session_.spes()) return kBadRequest;
    const int spe = static_cast<int>(*thread) - 1;
    return hexadecimal_of(fmt::format("SPE {}{}", spe,
                                      session_.is_running(spe)  ? ""
                                      : session_.has_ended(spe) ? ", has ended"
                                                                : ", has not begun"));
  }
  constexpr std::string_view kFeatures = "qXfer:features:read:target.xml:";
  if (query.starts_with(kFeatures)) return features(query.substr(kFeatures.size()));
  return kUnknown;
}

std::string GdbServer::features(std::string_view request) const {
  static const std::string kDescription = target_description();
  const std::size_t comma = request.find(',');
  if (comma == std::string_view::npos) return kBadRequest;
  const auto offset = number_of(request.substr(0, comma)), length = number_of(request.substr(comma + 1));
  if (!offset || !length || *offset > kDescription.size()) return kBadRequest;
  const std::string part = kDescription.substr(*offset, *length);
  return (*offset + part.size() == kDescription.size() ? "l" : "m") + part;
}

std::string GdbServer::select_thread(std::string_view packet) {
  if (packet.empty()) return kBadRequest;
  const std::string_view thread = packet.substr(1);
  if (thread == "-1" || thread == "0") return kOk;
  const auto number = number_of(thread);
  if (!number || *number < 1 || static_cast<int>(*number) > session_.spes()) return kBadRequest;
  spe_ = static_cast<int>(*number) - 1;
  return kOk;
}

// ---- registers and memory

std::string GdbServer::bytes_of_register(int number) const {
  if (number == kNumberRegister) return big_endian(static_cast<std::uint32_t>(spe_));
  if (number == kCounterRegister) return big_endian(session_.position(spe_));
  return text_of(session_.read_register(spe_, number));
}

std::string GdbServer::read_registers() const {
  std::string all;
  for (int i = 0; i <= kCounterRegister; ++i) all += hexadecimal_of(bytes_of_register(i));
  return all;
}

std::string GdbServer::write_registers(std::string_view text) {
  constexpr std::size_t kBytes = ls_sim::kSpuRegisters * dma::kQuadwordBytes;
  const auto bytes = bytes_of(text);
  if (!bytes || bytes->size() < kBytes || !session_.is_running(spe_)) return kBadRequest;
  for (int i = 0; i < ls_sim::kSpuRegisters; ++i) {
    const std::string one =
        bytes->substr(static_cast<std::size_t>(i) * dma::kQuadwordBytes, dma::kQuadwordBytes);
    if (one == bytes_of_register(i)) continue;
    ls_sim::RegisterBytes value;
    std::ranges::copy(memory_of(one), value.begin());
    session_.write_register(spe_, i, value);
  }
  return kOk;
}

std::string GdbServer::read_register(std::string_view text) const {
  const auto number = number_of(text);
  if (!number || *number > kCounterRegister) return kBadRequest;
  return hexadecimal_of(bytes_of_register(static_cast<int>(*number)));
}

std::string GdbServer::write_register(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) return kBadRequest;
  const auto number = number_of(text.substr(0, equals));
  const auto bytes = bytes_of(text.substr(equals + 1));
  if (!number || !bytes || *number > kCounterRegister) return kBadRequest;
  if (*number >= ls_sim::kSpuRegisters || bytes->size() != dma::kQuadwordBytes || !session_.is_running(spe_))
    return kNotPossible;
  ls_sim::RegisterBytes value;
  std::ranges::copy(memory_of(*bytes), value.begin());
  session_.write_register(spe_, static_cast<int>(*number), value);
  return kOk;
}

std::string GdbServer::read_memory(std::string_view text) const {
  const auto range = range_of(text);
  if (!range || session_.has_ended(spe_)) return kBadRequest;
  return hexadecimal_of(
      text_of(session_.read_memory(spe_, range->first, std::min(range->second, kMostMemoryBytes))));
}

std::string GdbServer::write_memory(std::string_view text, bool is_binary) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return kBadRequest;
  const auto range = range_of(text.substr(0, colon));
  const std::string_view contents = text.substr(colon + 1);
  const auto bytes = is_binary ? std::optional(std::string(contents)) : bytes_of(contents);
  if (!range || !bytes || bytes->size() != range->second || !session_.is_running(spe_)) return kBadRequest;
  if (!bytes->empty()) session_.write_memory(spe_, range->first, memory_of(*bytes));
  return kOk;
}

/// "Z0,ADDRESS,KIND": breakpoints (0, 1), and watchpoints of stores, loads and both (2 to 4).
std::string GdbServer::change_point(std::string_view packet) {
  if (packet.size() < 4 || packet[2] != ',') return kBadRequest;
  const bool is_set = packet.front() == 'Z';
  const auto range = range_of(packet.substr(3));
  if (!range) return kBadRequest;
  switch (packet[1]) {
    case '0':
    case '1':
      session_.set_breakpoint(range->first, is_set);
      return kOk;
    case '2':
    case '3':
    case '4': {
      const auto kind = static_cast<Watchpoint::Kind>(packet[1] - '2');
      session_.set_watchpoint({kind, range->first, std::max(range->second, 1u)}, is_set);
      return kOk;
    }
    default:
      return kUnknown;
  }
}

// ---- running

std::string GdbServer::resume(std::string_view action) {
  if (stop_.kind == DebugStop::kEnded) return report(stop_);
  if (action == "c") {
    stop_ = session_.go_on(interrupted());
  } else if (action == "s") {
    if (session_.has_ended(spe_)) return kNotPossible;
    stop_ = session_.step(spe_, interrupted());
  } else if (action == "bc") {
    stop_ = session_.go_back(interrupted());
  } else {
    stop_ = session_.step_back(interrupted());
  }
  spe_ = stop_.spe;
  if (stop_.kind == DebugStop::kFault)
    for (const std::string& sentence : session_.failures()) print_in_debugger(sentence);
  return report(stop_);
}

/// Shows a sentence in the debugger's window.
void GdbServer::print_in_debugger(const std::string& sentence) {
  connection_.send("O" + hexadecimal_of(sentence + "\n"));
}

std::string GdbServer::report(const DebugStop& stop) {
  constexpr int kTrapSignal = 5, kInterruptSignal = 2, kFaultSignal = 6;
  if (stop.kind == DebugStop::kEnded) {
    // The first SPE that has failed determines the answer.
    for (const SpeRun& spe : session_.result().spes) {
      if (spe.result.fault) return "X06";
      if (!spe.result.ended_normally() || spe.result.status() != 0)
        return fmt::format("W{:02x}", spe.result.ended_normally() ? spe.result.status() : 1);
    }
    return "W00";
  }
  const int signal = stop.kind == DebugStop::kInterrupted ? kInterruptSignal
                     : stop.kind == DebugStop::kFault     ? kFaultSignal
                                                          : kTrapSignal;
  std::string text = fmt::format("T{:02x}thread:{:x};", signal, stop.spe + 1);
  if (stop.kind == DebugStop::kWatchpoint)
    text += fmt::format("{}:{:x};", name_of(stop.watchpoint.kind), stop.watchpoint.begin);
  if (stop.kind == DebugStop::kBeginning) text += "replaylog:begin;";
  return text;
}

}  // namespace softcell::tool
