#include "disassembler.h"

#include <array>
#include <cstdio>

namespace softcell::ls_sim::interpreter {
namespace {

std::string hexadecimal(std::uint32_t value) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%#x", value);
  return text.data();
}

std::string reg(std::uint8_t number) { return std::string(1, '$').append(std::to_string(number)); }

std::string local_store_address(std::uint32_t address) { return hexadecimal(address & kInstructionMask); }

/// Writes the operands of one instruction.
class Operands {
 public:
  Operands(const Operation& operation, std::uint32_t address)
      : op_(operation), info_(info_of(operation.mnemonic)), address_(address) {}

  std::string text() const {
    switch (info_.format) {
      case Format::kRrr:
        return reg(op_.rt) + "," + reg(op_.ra) + "," + reg(op_.rb) + "," + reg(op_.rc);
      case Format::kRr:
        return of_registers();
      case Format::kRi7:
        return is_insertion_control() ? displaced(op_.imm) : with_number(op_.imm);
      case Format::kRi8:
        return with_number(scale());
      case Format::kRi10:
        return is_memory() ? displaced(op_.imm * 16) : with_number(op_.imm);
      case Format::kRi16:
        return of_long_immediate();
      case Format::kRi18:
        return reg(op_.rt) + "," + std::to_string(op_.imm);
      case Format::kRi16h:
        return hinted_branch() + "," + (op_.mnemonic == Mnemonic::hbra ? absolute() : relative());
      case Format::kRrh:
        return hinted_branch() + "," + reg(op_.ra);
    }
    return {};
  }

 private:
  bool is_memory() const { return info_.kind == Kind::kLoad || info_.kind == Kind::kStore; }
  bool is_insertion_control() const {
    return info_.latency == LatencyClass::kShuf && info_.mnemonic[0] == 'c';
  }

  std::string displaced(std::int32_t bytes) const {
    return reg(op_.rt) + "," + std::to_string(bytes) + "(" + reg(op_.ra) + ")";
  }
  std::string with_number(std::int32_t value) const {
    return reg(op_.rt) + "," + reg(op_.ra) + "," + std::to_string(value);
  }
  std::string relative() const {
    return local_store_address(address_ + (static_cast<std::uint32_t>(op_.imm) << 2));
  }
  std::string absolute() const { return local_store_address(static_cast<std::uint32_t>(op_.imm) << 2); }
  std::string hinted_branch() const {
    return local_store_address(address_ + (static_cast<std::uint32_t>(hint_distance(op_)) << 2));
  }

  /// The exponent of two that the assembler takes.
  std::int32_t scale() const {
    const bool to_float = op_.mnemonic == Mnemonic::csflt || op_.mnemonic == Mnemonic::cuflt;
    return (to_float ? 155 : 173) - op_.imm;
  }

  std::string of_long_immediate() const {
    switch (op_.mnemonic) {
      case Mnemonic::lqa:
      case Mnemonic::stqa:
      case Mnemonic::brasl:
        return reg(op_.rt) + "," + absolute();
      case Mnemonic::bra:
        return absolute();
      case Mnemonic::br:
        return relative();
      case Mnemonic::il:
        return reg(op_.rt) + "," + std::to_string(op_.imm);
      default:
        break;
    }
    if (is_memory() || info_.kind == Kind::kJump) return reg(op_.rt) + "," + relative();
    return reg(op_.rt) + "," + std::to_string(op_.imm & 0xFFFF);
  }

  std::string of_registers() const {
    switch (op_.mnemonic) {
      case Mnemonic::stop:  // GNU objdump leaves out the code
        return hexadecimal(static_cast<std::uint32_t>(op_.imm));
      case Mnemonic::nop:
        return reg(op_.rt);
      case Mnemonic::lnop:
      case Mnemonic::sync:
      case Mnemonic::dsync:
        return {};
      case Mnemonic::iret:
      case Mnemonic::bi:
        return reg(op_.ra);
      case Mnemonic::rdch:
      case Mnemonic::rchcnt:
        return reg(op_.rt) + ",$ch" + std::to_string(op_.ra);
      case Mnemonic::wrch:
        return "$ch" + std::to_string(op_.ra) + "," + reg(op_.rt);
      case Mnemonic::mfspr:
        return reg(op_.rt) + ",$sp" + std::to_string(op_.ra);
      case Mnemonic::mtspr:
        return "$sp" + std::to_string(op_.ra) + "," + reg(op_.rt);
      case Mnemonic::fscrrd:
        return reg(op_.rt);
      default:
        break;
    }
    const std::string two = reg(op_.rt) + "," + reg(op_.ra);
    return (info_.reads & reads::kB) != 0 ? two + "," + reg(op_.rb) : two;
  }

  const Operation& op_;
  const InstructionInfo& info_;
  std::uint32_t address_;
};

/// What the bits of RB add to the mnemonic of a branch, a hint or a sync.
std::string suffix(const Operation& op) {
  const InstructionInfo& info = info_of(op.mnemonic);
  if (op.mnemonic == Mnemonic::sync) return (op.rb & kFeatureBit) != 0 ? "c" : "";
  if (op.mnemonic == Mnemonic::hbr) return (op.rb & kFeatureBit) != 0 ? "p" : "";
  const bool is_branch =
      info.kind == Kind::kJump || info.kind == Kind::kInterruptReturn || info.kind == Kind::kEventJump;
  if (!is_branch || info.format != Format::kRr) return {};
  std::string text;
  if ((op.rb & kDisableInterrupts) != 0) text += "d";
  if ((op.rb & kEnableInterrupts) != 0) text += "e";
  return text;
}

}  // namespace

std::string disassemble(const Operation& operation, std::uint32_t address) {
  if (operation.mnemonic == Mnemonic::invalid) return ".long " + hexadecimal(operation.word);
  const std::string operands = Operands(operation, address).text();
  const std::string name = std::string(info_of(operation.mnemonic).mnemonic) + suffix(operation);
  return operands.empty() ? name : name + " " + operands;
}

}  // namespace softcell::ls_sim::interpreter
