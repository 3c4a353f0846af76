// Problem state as the PPU program's memory: its loads and stores at spe_ps_area_get().

#include <cstdint>
#include <mutex>
#include <string>

#include "libspe2.h"
#include "object.h"
#include "registers.h"
#include "softcell/base/text.h"
#include "softcell/dma/addresses.h"
#include "softcell/dma/host_registers.h"
#include "softcell/dma/mfc_command.h"

namespace softcell::libspe2 {
namespace {

/// Offsets from the local store. [CBEA, problem state memory map] documented
enum Register : std::uint32_t {
  kMsSync = 0x40000,
  kMfcLsa = 0x43004,
  kMfcEah = 0x43008,
  kMfcEal = 0x4300C,
  kMfcSizeTag = 0x43010,
  kMfcCommand = 0x43014,
  kMfcQueueStatus = 0x43104,
  kProxyQueryType = 0x43204,
  kProxyQueryMask = 0x4321C,
  kProxyTagStatus = 0x4322C,
  kOutMbox = 0x44004,
  kInMbox = 0x4400C,
  kMboxStatus = 0x44014,
  kSpuStatus = 0x44024,
  kSignal1 = 0x5400C,
  kSignal2 = 0x5C00C,
};
constexpr std::uint32_t kQueueEmpty = 0x8000'0000, kRunning = 1;
constexpr int kProxySlots = 8;

/// Stores the value that was written to a register of one context. Guarded by its mutex.
void store(spe_context& context, std::uint32_t offset, std::uint32_t value) {
  auto& registers = context.registers;
  switch (offset) {
    case kMfcLsa:
      registers.command.lsa.value = value;
      break;
    case kMfcEah:
      registers.command.ea.value = std::uint64_t{value} << 32 | (registers.command.ea.value & 0xFFFF'FFFFu);
      break;
    case kMfcEal:
      registers.command.ea.value = registers.command.ea.value >> 32 << 32 | value;
      break;
    case kMfcSizeTag:
      registers.command.size = value >> 16;
      registers.command.tag = value & 0xFFFFu;
      break;
    case kMfcCommand:
      registers.command.word = value;
      break;
    case kProxyQueryMask:
      registers.query_mask = value;
      break;
    case kInMbox:
      context.problem_state().write_in_mbox(value);
      break;
    case kSignal1:
      context.problem_state().write_signal(1, value);
      break;
    case kSignal2:
      context.problem_state().write_signal(2, value);
      break;
    default:  // MFC_MSSync and Prxy_QueryType ask for what is true at once
      break;
  }
}

std::uint32_t load(spe_context& context, std::uint32_t offset) {
  auto& registers = context.registers;
  switch (offset) {
    case kMfcCommand:  // queues what was written
      if (const auto fault = context.problem_state().issue_proxy(registers.command)) {
        Machine::get().report(*fault);
        return 1;
      }
      context.tags.fetch_or(1u << registers.command.tag);
      Machine::get().contexts().wake();
      return 0;
    case kMfcQueueStatus: {
      const int free = context.problem_state().free_proxy_slots();
      return static_cast<std::uint32_t>(free) | (free == kProxySlots ? kQueueEmpty : 0);
    }
    case kProxyQueryMask:
      return registers.query_mask;
    case kProxyTagStatus:
      return context.problem_state().proxy_status(registers.query_mask);
    case kOutMbox:
      return context.problem_state().read_out_mbox().value_or(0);
    case kMboxStatus:
      return context.problem_state().mbox_status();
    case kSpuStatus:
      return context.spe->state().runs ? kRunning : registers.spu_status;
    default:
      return 0;
  }
}

bool is_stored(std::uint32_t offset) {
  switch (offset) {
    case kMsSync:
    case kMfcLsa:
    case kMfcEah:
    case kMfcEal:
    case kMfcSizeTag:
    case kMfcCommand:
    case kProxyQueryType:
    case kProxyQueryMask:
    case kInMbox:
    case kSignal1:
    case kSignal2:
      return true;
    default:
      return false;
  }
}

bool is_loaded(std::uint32_t offset) {
  switch (offset) {
    case kMsSync:
    case kMfcCommand:
    case kMfcQueueStatus:
    case kProxyQueryType:
    case kProxyQueryMask:
    case kProxyTagStatus:
    case kOutMbox:
    case kMboxStatus:
    case kSpuStatus:
      return true;
    default:
      return false;
  }
}

std::string offset_in_problem_state(std::uint32_t offset) {
  return base::hex(offset - dma::kLocalStoreBytes);
}

bool access_address(std::uint64_t address, dma::HostAccess access, std::uint32_t& value) {
  const std::uint64_t base = address / dma::kLocalStoreStrideBytes * dma::kLocalStoreStrideBytes;
  const auto offset = static_cast<std::uint32_t>(address - base);
  const auto context = Objects<spe_context>::all().find_if([&](spe_context& each) {
    return each.spe != nullptr && each.problem_state().local_store_ea().value == base;
  });
  if (context == nullptr || offset < dma::kLocalStoreBytes) return false;
  if (access == dma::HostAccess::kUnknown) {
    Machine::complain("the program accesses problem state at offset " + offset_in_problem_state(offset) +
                      " of an SPE context by an instruction that softcell does not know; load the register "
                      "of 4 bytes into a "
                      "variable first, or store it from one");
    return false;
  }
  return access_register(*context, offset, access == dma::HostAccess::kStore, value);
}

}  // namespace

bool access_register(spe_context& context, std::uint32_t offset, bool is_store, std::uint32_t& value) {
  if ((context.flags & SPE_MAP_PS) == 0 || !(is_store ? is_stored(offset) : is_loaded(offset))) {
    Machine::complain("the program accesses problem state at offset " + offset_in_problem_state(offset) +
                      " of an SPE context, " +
                      ((context.flags & SPE_MAP_PS) == 0 ? "which was made without SPE_MAP_PS"
                       : is_store                        ? "where no register is that a PC program may write"
                                  : "where no register is that a PC program may read"));
    return false;
  }
  const std::lock_guard lock(context.mutex);
  if (is_store) {
    store(context, offset, value);
  } else {
    value = load(context, offset);
  }
  return true;
}

void map_registers() { dma::set_host_register_access(&access_address); }

}  // namespace softcell::libspe2
