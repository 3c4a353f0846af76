#include "softcell/dma/host_registers.h"

#include "host_registers_decoder.h"

#include <atomic>
#include <cstring>
#include <optional>

namespace softcell::dma {
namespace {

std::atomic<HostRegisterAccess*> asked{nullptr};

// [AMD64 manual, volume 3, instruction encoding] documented
constexpr std::uint8_t kStoreRegister = 0x89, kLoadRegister = 0x8B, kStoreImmediate = 0xC7;
constexpr std::uint8_t kRex = 0x40, kRexMask = 0xF0, kRexW = 8, kRexR = 4;

}  // namespace

void set_host_register_access(HostRegisterAccess* access) { asked.store(access, std::memory_order_release); }

std::optional<MovOfFourBytes> decode_mov(const std::uint8_t* code) {
  const std::uint8_t* at = code;
  std::uint8_t rex = 0;
  if ((*at & kRexMask) == kRex) rex = *at++;
  const std::uint8_t opcode = *at++;
  const bool immediate = opcode == kStoreImmediate;
  if ((opcode != kStoreRegister && opcode != kLoadRegister && !immediate) || (rex & kRexW) != 0)
    return std::nullopt;
  const std::uint8_t mod_rm = *at++;
  const unsigned mod = mod_rm >> 6, reg = mod_rm >> 3 & 7u, rm = mod_rm & 7u;
  if (mod == 3 || (immediate && reg != 0)) return std::nullopt;
  unsigned displacement = mod == 1 ? 1 : mod == 2 ? 4 : 0;
  if (rm == 4) {
    const unsigned base = *at++ & 7u;
    if (mod == 0 && base == 5) displacement = 4;
  } else if (mod == 0 && rm == 5) {
    displacement = 4;  // from the instruction pointer
  }
  at += displacement;
  MovOfFourBytes mov;
  mov.is_store = opcode != kLoadRegister;
  mov.gpr = static_cast<int>(reg | ((rex & kRexR) != 0 ? 8u : 0u));
  if (immediate) {
    std::uint32_t value = 0;
    std::memcpy(&value, at, sizeof value);
    mov.immediate = value;
    at += sizeof value;
  }
  mov.bytes = static_cast<int>(at - code);
  return mov;
}

bool access_host_register(std::uint64_t address, mcontext_t& machine) {
  HostRegisterAccess* const access = asked.load(std::memory_order_acquire);
  if (access == nullptr) return false;
  const auto mov = decode_mov(reinterpret_cast<const std::uint8_t*>(machine.gregs[REG_RIP]));
  if (!mov) return false;
  constexpr int kRegisters[] = {REG_RAX, REG_RCX, REG_RDX, REG_RBX, REG_RSP, REG_RBP, REG_RSI, REG_RDI,
                                REG_R8,  REG_R9,  REG_R10, REG_R11, REG_R12, REG_R13, REG_R14, REG_R15};
  greg_t& reg = machine.gregs[kRegisters[mov->gpr]];
  std::uint32_t value = mov->immediate ? *mov->immediate : static_cast<std::uint32_t>(reg);
  if (!access(address, mov->is_store, value)) return false;
  if (!mov->is_store) reg = static_cast<greg_t>(value);  // a load of 4 bytes clears the upper half
  machine.gregs[REG_RIP] += mov->bytes;
  return true;
}

}  // namespace softcell::dma
