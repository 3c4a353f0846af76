#include "local_stores.h"

#include <algorithm>
#include <cstring>
#include <string>

#include "softcell/base/assert.h"
#include "text.h"

namespace softcell::dma {
namespace {

constexpr SpeRegister kRegisters[] = {SpeRegister::kInMbox, SpeRegister::kSignal1, SpeRegister::kSignal2};
constexpr std::uint32_t kRegisterBytes = 4;

bool is_known(std::uint32_t offset) {
  return std::find(std::begin(kRegisters), std::end(kRegisters), static_cast<SpeRegister>(offset)) !=
         std::end(kRegisters);
}

}  // namespace

std::variant<std::byte*, Fault> LocalStores::resolve_register(EffectiveAddress ea, std::uint64_t bytes,
                                                              bool writes) {
  SC_ASSERT(is_register(ea), "{} is in the local store of SPE {}", ea, spe_of(ea));
  const std::string spe = "SPE " + std::to_string(spe_of(ea));
  const std::uint32_t offset = offset_of(ea);
  if (port_of(ea).load(std::memory_order_acquire) == nullptr) {
    return Fault{.rule = Rule::kEaNotMapped,
                 .detail = "EA is a register of " + spe + ", which does not exist"};
  }
  if (!is_known(offset)) {
    return Fault{.rule = Rule::kRegisterAccess,
                 .detail = "offset " + hex(offset, 5) + " of " + spe +
                           " is not a register that others may write; those are SPU_In_Mbox (0x4400C), "
                           "Sig_Notify_1 (0x5400C) and Sig_Notify_2 (0x5C00C)"};
  }
  if (!writes) {
    return Fault{.rule = Rule::kRegisterAccess,
                 .detail = "EA is a register of " + spe + ", which others may only write"};
  }
  if (bytes != kRegisterBytes) {
    return Fault{.rule = Rule::kRegisterAccess,
                 .detail = byte_count(bytes) + " are written to a register of " + spe + ", which takes 4"};
  }
  return &register_stand_in_;
}

bool LocalStores::on_write(EffectiveAddress ea, const std::byte* from, std::uint32_t bytes) {
  LocalStorePort* port = port_of(ea).load(std::memory_order_acquire);
  if (port == nullptr) return false;
  if (!is_register(ea)) {
    port->on_external_write({offset_of(ea)}, bytes);
    return false;
  }
  SC_ASSERT(bytes == kRegisterBytes && is_known(offset_of(ea)),
            "{} bytes written at {} of SPE {}'s registers", bytes, offset_of(ea), spe_of(ea));
  std::uint32_t value = 0;
  std::memcpy(&value, from, sizeof value);
  port->on_register_write(static_cast<SpeRegister>(offset_of(ea)), value);
  return true;
}

}  // namespace softcell::dma
