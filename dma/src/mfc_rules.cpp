#include "softcell/dma/mfc_rules.h"

#include <string>
#include <string_view>
#include <utility>

#include "softcell/base/assert.h"
#include "softcell/dma/local_store_port.h"
#include "text.h"

namespace softcell::dma {
namespace {

/// A broken rule, without the command that breaks it.
struct Breach {
  Rule rule;
  std::string detail;
};

constexpr bool is_small(std::uint32_t size) { return size == 1 || size == 2 || size == 4 || size == 8; }

constexpr bool is_legal_size(std::uint32_t size) {
  return is_small(size) || (size % kQuadwordBytes == 0 && size <= kMaxTransferBytes);
}

/// Alignment that a legal size asks of both addresses, in bytes.
constexpr std::uint32_t required_alignment(std::uint32_t size) {
  return is_small(size) ? size : kQuadwordBytes;
}

std::string misaligned(std::string_view which, std::uint64_t address, std::uint32_t size) {
  const std::uint32_t alignment = required_alignment(size);
  return std::string(which) + " is " + byte_count(address % alignment) + " past a multiple of " +
         std::to_string(alignment) + ", which a transfer of " + byte_count(size) + " needs";
}

std::string size_detail(std::uint32_t size) {
  if (size > kMaxTransferBytes) {
    return byte_count(size) + " are more than the " + std::to_string(kMaxTransferBytes) +
           " of one command; split the transfer";
  }
  return byte_count(size) + " is neither 1, 2, 4, 8 nor a multiple of 16";
}

std::optional<Breach> check_range(LocalStoreAddress lsa, std::uint32_t size) {
  if (lsa.value < kLocalStoreBytes && size <= kLocalStoreBytes - lsa.value) return std::nullopt;
  return Breach{Rule::kLsaOutOfRange, "bytes " + to_text(lsa) + ".." +
                                          hex(std::uint64_t{lsa.value} + size - 1, 5) +
                                          " reach past the local store's last byte 0x3FFFF"};
}

std::optional<Breach> check_transfer(const MfcCommand& command) {
  const auto [word, lsa, ea, size, tag] = command;
  if (size == 0) return Breach{Rule::kSizeZero, "0 bytes; leave the command out"};
  if (!is_legal_size(size)) return Breach{Rule::kSizeNotLegal, size_detail(size)};
  const std::uint32_t alignment = required_alignment(size);
  if (lsa.value % alignment != 0) return Breach{Rule::kLsaAlignment, misaligned("LSA", lsa.value, size)};
  if (ea.value % alignment != 0) return Breach{Rule::kEaAlignment, misaligned("EA", ea.value, size)};
  if (lsa.value % kQuadwordBytes != ea.value % kQuadwordBytes) {
    return Breach{Rule::kLowBitsDiffer, "low four bits are " + hex(lsa.value % kQuadwordBytes) +
                                            " in LSA and " + hex(ea.value % kQuadwordBytes) +
                                            " in EA; below 16 bytes they must be equal"};
  }
  return check_range(lsa, size);
}

/// Whole quadwords between aligned addresses, which nearly all transfers are: told without looking for what
/// is wrong.
bool is_plainly_legal(const MfcCommand& command) {
  const std::uint64_t addresses = command.lsa.value | command.ea.value | command.size;
  return command.kind() == CommandKind::kTransfer && command.tag < kTagCount &&
         addresses % kQuadwordBytes == 0 && command.size - 1 < kMaxTransferBytes &&
         command.lsa.value < kLocalStoreBytes && command.size <= kLocalStoreBytes - command.lsa.value;
}

std::optional<Breach> check_list(const MfcCommand& command) {
  if (std::optional<Breach> breach = check_range(command.lsa, 1)) {
    breach->detail = "LSA " + to_text(command.lsa) + " lies past the local store's last byte 0x3FFFF";
    return breach;
  }
  const LocalStoreAddress list = command.list_address();
  if (list.value % kListElementBytes != 0) {
    return Breach{Rule::kListAddress, "the list's address " + to_text(list) + " is " +
                                          byte_count(list.value % kListElementBytes) +
                                          " past a multiple of 8"};
  }
  if (command.size == 0 || command.size % kListElementBytes != 0 || command.size > kMaxTransferBytes) {
    return Breach{Rule::kListSize, "a list of " + byte_count(command.size) +
                                       "; 8 for each element, 8 to 16384 in all, are allowed"};
  }
  if (check_range(list, command.size)) {
    return Breach{Rule::kListAddress, "the list's bytes " + to_text(list) + ".." +
                                          hex(std::uint64_t{list.value} + command.size - 1, 5) +
                                          " reach past the local store's last byte 0x3FFFF"};
  }
  return std::nullopt;
}

std::optional<Breach> check_line(const MfcCommand& command) {
  const auto off_line = [](std::string_view which, std::uint64_t address) {
    return Breach{Rule::kAtomicAlignment, std::string(which) + " is " + byte_count(address % kLineBytes) +
                                              " past a multiple of 128; a whole line is moved"};
  };
  if (command.lsa.value % kLineBytes != 0) return off_line("LSA", command.lsa.value);
  if (command.ea.value % kLineBytes != 0) return off_line("EA", command.ea.value);
  return check_range(command.lsa, kLineBytes);
}

bool is_signal_register(EffectiveAddress ea, EffectiveAddress local_stores) {
  const std::uint64_t offset = (ea.value - local_stores.value) % kLocalStoreStrideBytes;
  return ea >= local_stores && (offset == static_cast<std::uint64_t>(SpeRegister::kSignal1) ||
                                offset == static_cast<std::uint64_t>(SpeRegister::kSignal2));
}

std::optional<Breach> check_signal(const MfcCommand& command, EffectiveAddress local_stores) {
  const auto [word, lsa, ea, size, tag] = command;
  if (size != kSignalBytes) {
    return Breach{Rule::kSignalCommand, byte_count(size) + "; a signal has 4"};
  }
  if (!is_signal_register(ea, local_stores)) {
    return Breach{Rule::kSignalCommand, "EA is not a Sig_Notify register of an SPE; they lie " +
                                            hex(static_cast<std::uint32_t>(SpeRegister::kSignal1)) + " and " +
                                            hex(static_cast<std::uint32_t>(SpeRegister::kSignal2)) +
                                            " past the SPE's base address"};
  }
  if (lsa.value % kSignalBytes != 0) {
    return Breach{Rule::kLsaAlignment, misaligned("LSA", lsa.value, kSignalBytes)};
  }
  if (const std::uint32_t low = ea.value % kQuadwordBytes; lsa.value % kQuadwordBytes != low) {
    return Breach{Rule::kLowBitsDiffer, "low four bits are " + hex(lsa.value % kQuadwordBytes) +
                                            " in LSA and " + hex(low) + " in EA; a signal's must be equal"};
  }
  return check_range(lsa, kSignalBytes);
}

std::optional<Breach> check_cache_hint(const MfcCommand& command) {
  if (command.size == 0) return Breach{Rule::kSizeZero, "0 bytes; leave the command out"};
  if (command.size > kMaxTransferBytes) return Breach{Rule::kSizeNotLegal, size_detail(command.size)};
  return std::nullopt;
}

std::optional<Breach> check(const MfcCommand& command, EffectiveAddress local_stores) {
  const CommandKind kind = command.kind();
  if (kind == CommandKind::kUnknown) {
    return Breach{Rule::kUnknownCommand,
                  "opcode " + hex(command.word & 0xFFFF, 2) + " is not an MFC command"};
  }
  if (kind == CommandKind::kStart) {
    return Breach{Rule::kProxyFormOnly, "an SPU's own commands have no start form; it runs already"};
  }
  if (kind == CommandKind::kLine) return check_line(command);  // no tag to look at
  if (command.tag >= kTagCount) {
    return Breach{Rule::kTagOutOfRange, "tag " + std::to_string(command.tag) + " is not in 0..31"};
  }
  switch (kind) {
    case CommandKind::kTransfer:
      return check_transfer(command);
    case CommandKind::kList:
      return check_list(command);
    case CommandKind::kQueuedLine:
      return check_line(command);
    case CommandKind::kSignal:
      return check_signal(command, local_stores);
    case CommandKind::kCacheHint:
      return check_cache_hint(command);
    default:
      return std::nullopt;
  }
}

std::optional<Breach> check(const MfcCommand& command, ListElement element, LocalStoreAddress cursor) {
  const std::uint32_t size = element.size();
  if (element.reserved() != 0) {
    // stall:1, reserved:15, size:16 from the lowest bit on.
    const bool from_the_lowest_bit =
        (element.head & 0xFFFE) == 0 && element.head >> 16 <= kMaxTransferBytes && element.head >> 16 != 0;
    return Breach{Rule::kListElementReservedBits,
                  "its first word is " + hex(element.head, 8) + "; bits 1 to 16 must be zero" +
                      (from_the_lowest_bit ? "; were bit fields written? On a PC they begin with the lowest "
                                             "bit: write the word, or an mfc_list_element_t"
                                           : "")};
  }
  if (size == 0) return std::nullopt;
  if (!is_legal_size(size)) return Breach{Rule::kListElementSize, size_detail(size)};
  if (element.eal % required_alignment(size) != 0) {
    return Breach{Rule::kListElementAlignment, misaligned("EA " + hex(element.eal, 8), element.eal, size)};
  }
  if (std::uint64_t{element.eal} + size > std::uint64_t{1} << 32) {
    return Breach{Rule::kListCrosses4Gb,
                  byte_count(size) + " from " + to_text(element.ea(command)) +
                      " on reach past a boundary of 4 GB, and MFC_EAH is common to all elements"};
  }
  const LocalStoreAddress lsa = element.local_address(cursor);
  if (size >= kQuadwordBytes && lsa.value % kQuadwordBytes != 0) {
    return Breach{Rule::kLsaAlignment, misaligned("LSA " + to_text(lsa), lsa.value, size)};
  }
  return check_range(lsa, size);
}

}  // namespace

std::optional<Fault> check_command(const MfcCommand& command, EffectiveAddress local_stores) {
  if (is_plainly_legal(command)) return std::nullopt;
  std::optional<Breach> breach = check(command, local_stores);
  if (!breach) return std::nullopt;
  return Fault{.rule = breach->rule, .command = command, .detail = std::move(breach->detail)};
}

std::optional<Fault> check_element(const MfcCommand& command, std::uint32_t index, ListElement element,
                                   LocalStoreAddress lsa) {
  SC_ASSERT(index < command.size / kListElementBytes, "element {} of a list of {} bytes", index,
            command.size);
  const std::optional<Breach> breach = check(command, element, lsa);
  if (!breach) return std::nullopt;
  return Fault{
      .rule = breach->rule, .command = command, .detail = describe_element(command, index, breach->detail)};
}

std::string describe_element(const MfcCommand& command, std::uint32_t index, std::string_view detail) {
  return "element " + std::to_string(index) + " of " + std::to_string(command.size / kListElementBytes) +
         " (from 0): " + std::string(detail);
}

}  // namespace softcell::dma
