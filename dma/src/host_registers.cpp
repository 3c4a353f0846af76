#include "softcell/dma/host_registers.h"

#include "host_registers_decoder.h"

#include <atomic>
#include <bit>
#include <cstring>
#include <optional>

namespace softcell::dma {
namespace {

std::atomic<HostRegisterAccess*> asked{nullptr};

// [AMD64 manual, volume 3, instruction encoding] documented
constexpr std::uint8_t kRex = 0x40, kRexMask = 0xF0, kRexW = 8, kRexR = 4;

enum class Constant : std::uint8_t { kNone, kByte, kFourBytes };
enum class Wide : std::uint8_t { kNo, kYes };

/// An instruction with an operand in memory. Where `group` is not -1 the field reg of its second byte is a part of the opcode.
struct Form {
  std::uint8_t opcode;
  int group;
  Wide wide;
  RegisterUse use;
  Constant constant;
  bool memory_first;
};
constexpr Form kForms[] = {
    {0x89, -1, Wide::kNo, RegisterUse::kStore, Constant::kNone, false},
    {0xC7, 0, Wide::kNo, RegisterUse::kStore, Constant::kFourBytes, false},
    {0x8B, -1, Wide::kNo, RegisterUse::kLoad, Constant::kNone, false},
    {0x63, -1, Wide::kYes, RegisterUse::kLoadSigned, Constant::kNone, false},
    {0x03, -1, Wide::kNo, RegisterUse::kAdd, Constant::kNone, false},
    {0x0B, -1, Wide::kNo, RegisterUse::kOr, Constant::kNone, false},
    {0x23, -1, Wide::kNo, RegisterUse::kAnd, Constant::kNone, false},
    {0x2B, -1, Wide::kNo, RegisterUse::kSubtract, Constant::kNone, false},
    {0x33, -1, Wide::kNo, RegisterUse::kXor, Constant::kNone, false},
    {0x3B, -1, Wide::kNo, RegisterUse::kCompare, Constant::kNone, false},
    {0x39, -1, Wide::kNo, RegisterUse::kCompare, Constant::kNone, true},
    {0x81, 7, Wide::kNo, RegisterUse::kCompare, Constant::kFourBytes, true},
    {0x83, 7, Wide::kNo, RegisterUse::kCompare, Constant::kByte, true},
    {0x85, -1, Wide::kNo, RegisterUse::kTest, Constant::kNone, true},
    {0xF7, 0, Wide::kNo, RegisterUse::kTest, Constant::kFourBytes, true},
};

// [AMD64 manual, volume 1, rFLAGS register] documented
constexpr std::uint32_t kCarry = 1, kParity = 4, kAuxiliary = 0x10, kZero = 0x40, kSign = 0x80,
                        kOverflow = 0x800;
constexpr std::uint32_t kArithmeticFlags = kCarry | kParity | kAuxiliary | kZero | kSign | kOverflow;

/// What an arithmetic instruction gives, and its flags.
struct Computed {
  std::uint32_t value, flags;
};
Computed compute(RegisterUse use, std::uint32_t left, std::uint32_t right) {
  std::uint32_t value = 0, flags = 0;
  switch (use) {
    case RegisterUse::kAdd:
      value = left + right;
      flags = (value < left ? kCarry : 0) | ((~(left ^ right) & (left ^ value)) >> 31 != 0 ? kOverflow : 0) |
              ((left ^ right ^ value) & kAuxiliary);
      break;
    case RegisterUse::kSubtract:
    case RegisterUse::kCompare:
      value = left - right;
      flags = (left < right ? kCarry : 0) | (((left ^ right) & (left ^ value)) >> 31 != 0 ? kOverflow : 0) |
              ((left ^ right ^ value) & kAuxiliary);
      break;
    case RegisterUse::kOr:
      value = left | right;
      break;
    case RegisterUse::kXor:
      value = left ^ right;
      break;
    default:  // kAnd, kTest
      value = left & right;
      break;
  }
  if (std::popcount(value & 0xFFu) % 2 == 0) flags |= kParity;
  if (value == 0) flags |= kZero;
  if (value >> 31 != 0) flags |= kSign;
  return {value, flags};
}

/// The rest of an instruction, when memory has been read. @param gpr  its register.
void use_loaded(const AccessOfFourBytes& access, std::uint32_t loaded, greg_t& gpr, mcontext_t& machine) {
  switch (access.use) {
    case RegisterUse::kStore:
      return;
    case RegisterUse::kLoad:
      gpr = static_cast<greg_t>(loaded);  // which clears the upper half
      return;
    case RegisterUse::kLoadSigned:
      gpr = static_cast<std::int32_t>(loaded);
      return;
    default:
      break;
  }
  const std::uint32_t operand = access.immediate.value_or(static_cast<std::uint32_t>(gpr));
  const Computed computed =
      compute(access.use, access.memory_first ? loaded : operand, access.memory_first ? operand : loaded);
  machine.gregs[REG_EFL] = (machine.gregs[REG_EFL] & ~static_cast<greg_t>(kArithmeticFlags)) | computed.flags;
  if (access.use != RegisterUse::kCompare && access.use != RegisterUse::kTest)
    gpr = static_cast<greg_t>(computed.value);
}

}  // namespace

void set_host_register_access(HostRegisterAccess* access) { asked.store(access, std::memory_order_release); }

std::optional<AccessOfFourBytes> decode_access(const std::uint8_t* code) {
  const std::uint8_t* at = code;
  std::uint8_t rex = 0;
  if ((*at & kRexMask) == kRex) rex = *at++;
  const std::uint8_t opcode = *at++;
  const std::uint8_t mod_rm = *at++;
  const unsigned mod = mod_rm >> 6, reg = mod_rm >> 3 & 7u, rm = mod_rm & 7u;
  const Form* form = nullptr;
  for (const Form& each : kForms) {
    if (each.opcode == opcode && (each.group < 0 || static_cast<unsigned>(each.group) == reg) &&
        (each.wide == Wide::kYes) == ((rex & kRexW) != 0))
      form = &each;
  }
  if (form == nullptr || mod == 3) return std::nullopt;
  unsigned displacement = mod == 1 ? 1 : mod == 2 ? 4 : 0;
  if (rm == 4) {
    const unsigned base = *at++ & 7u;
    if (mod == 0 && base == 5) displacement = 4;
  } else if (mod == 0 && rm == 5) {
    displacement = 4;  // from the instruction pointer
  }
  at += displacement;
  AccessOfFourBytes access;
  access.use = form->use;
  access.memory_first = form->memory_first;
  access.gpr = static_cast<int>(reg | ((rex & kRexR) != 0 ? 8u : 0u));
  if (form->constant == Constant::kByte) {
    access.immediate = static_cast<std::uint32_t>(static_cast<std::int8_t>(*at++));
  } else if (form->constant == Constant::kFourBytes) {
    std::uint32_t value = 0;
    std::memcpy(&value, at, sizeof value);
    access.immediate = value;
    at += sizeof value;
  }
  access.bytes = static_cast<int>(at - code);
  return access;
}

bool access_host_register(std::uint64_t address, mcontext_t& machine) {
  HostRegisterAccess* const ask = asked.load(std::memory_order_acquire);
  if (ask == nullptr) return false;
  std::uint32_t value = 0;
  const auto access = decode_access(reinterpret_cast<const std::uint8_t*>(machine.gregs[REG_RIP]));
  if (!access) {
    ask(address, HostAccess::kUnknown, value);
    return false;
  }
  constexpr int kRegisters[] = {REG_RAX, REG_RCX, REG_RDX, REG_RBX, REG_RSP, REG_RBP, REG_RSI, REG_RDI,
                                REG_R8,  REG_R9,  REG_R10, REG_R11, REG_R12, REG_R13, REG_R14, REG_R15};
  greg_t& gpr = machine.gregs[kRegisters[access->gpr]];
  const bool is_store = access->use == RegisterUse::kStore;
  if (is_store) value = access->immediate.value_or(static_cast<std::uint32_t>(gpr));
  if (!ask(address, is_store ? HostAccess::kStore : HostAccess::kLoad, value)) return false;
  use_loaded(*access, value, gpr, machine);
  machine.gregs[REG_RIP] += access->bytes;
  return true;
}

}  // namespace softcell::dma
