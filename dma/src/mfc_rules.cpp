#include "softcell/dma/mfc_rules.h"

#include <string>

#include "text.h"

namespace softcell::dma {
namespace {

bool is_supported(MfcOpcode opcode) {
  switch (opcode) {
    case MfcOpcode::get:
    case MfcOpcode::getf:
    case MfcOpcode::getb:
    case MfcOpcode::put:
    case MfcOpcode::putf:
    case MfcOpcode::putb:
    case MfcOpcode::putr:  // the result form is a cache hint: the same bytes move
    case MfcOpcode::putrf:
    case MfcOpcode::putrb:
      return true;
    default:
      return false;
  }
}

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
    return byte_count(size) + " are more than the 16384 of one command; split the transfer";
  }
  return byte_count(size) + " is neither 1, 2, 4, 8 nor a multiple of 16";
}

}  // namespace

std::optional<Fault> check_command(const MfcCommand& command) {
  const auto broken = [&](Rule rule, std::string detail) {
    return Fault{.rule = rule, .command = command, .detail = std::move(detail)};
  };
  const auto [word, lsa, ea, size, tag] = command;

  if (!is_supported(command.opcode())) {
    const std::string_view known = name(command.opcode());
    if (known.empty())
      return broken(Rule::kUnknownCommand, "opcode " + hex(word & 0xFFFF, 2) + " is no MFC command");
    return broken(
        Rule::kCommandNotSupported,
        std::string(known) + " is not executed yet; get, put and putr are, with their f and b forms");
  }
  if (tag >= kTagCount)
    return broken(Rule::kTagOutOfRange, "tag " + std::to_string(tag) + " is not in 0..31");
  if (size == 0) return broken(Rule::kSizeZero, "0 bytes; leave the command out");
  if (!is_legal_size(size)) return broken(Rule::kSizeNotLegal, size_detail(size));

  const std::uint32_t alignment = required_alignment(size);
  if (lsa.value % alignment != 0) return broken(Rule::kLsaAlignment, misaligned("LSA", lsa.value, size));
  if (ea.value % alignment != 0) return broken(Rule::kEaAlignment, misaligned("EA", ea.value, size));
  if (lsa.value % kQuadwordBytes != ea.value % kQuadwordBytes) {
    return broken(Rule::kLowBitsDiffer, "low four bits are " + hex(lsa.value % kQuadwordBytes) +
                                            " in LSA and " + hex(ea.value % kQuadwordBytes) +
                                            " in EA; below 16 bytes they must be equal");
  }
  if (lsa.value >= kLocalStoreBytes || size > kLocalStoreBytes - lsa.value) {
    return broken(Rule::kLsaOutOfRange, "bytes " + to_text(lsa) + ".." +
                                            hex(std::uint64_t{lsa.value} + size - 1, 5) +
                                            " reach past the local store's last byte 0x3FFFF");
  }
  return std::nullopt;
}

}  // namespace softcell::dma
