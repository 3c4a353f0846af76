// Proxy commands.

#include <cstdint>

#include "libspe2.h"
#include "object.h"
#include "softcell/dma/mfc_command.h"

using softcell::dma::MfcOpcode;
using softcell::libspe2::fail;
using softcell::libspe2::Machine;
using softcell::libspe2::with_context;

namespace {

constexpr unsigned int kClassBits = 8;

int issue(spe_context_ptr_t spe, MfcOpcode opcode, unsigned int ls, void* ea, unsigned int size,
          unsigned int tag, unsigned int tid, unsigned int rid) {
  return with_context(spe, [&](spe_context& context) {
    const std::uint32_t classes = (tid & 0xFFu) << (16 + kClassBits) | (rid & 0xFFu) << 16;
    const auto fault =
        context.problem_state().issue_proxy({.word = classes | static_cast<std::uint32_t>(opcode),
                                             .lsa = {ls},
                                             .ea = {reinterpret_cast<std::uint64_t>(ea)},
                                             .size = size,
                                             .tag = tag});
    if (fault) {
      Machine::get().report(*fault);
      return fail(EINVAL);
    }
    context.tags.fetch_or(1u << tag);
    Machine::get().contexts().wake();  // somebody may wait for the event of its completion
    return 0;
  });
}

}  // namespace

int spe_mfcio_put(spe_context_ptr_t spe, unsigned int ls, void* ea, unsigned int size, unsigned int tag,
                  unsigned int tid, unsigned int rid) {
  return issue(spe, MfcOpcode::put, ls, ea, size, tag, tid, rid);
}
int spe_mfcio_putb(spe_context_ptr_t spe, unsigned int ls, void* ea, unsigned int size, unsigned int tag,
                   unsigned int tid, unsigned int rid) {
  return issue(spe, MfcOpcode::putb, ls, ea, size, tag, tid, rid);
}
int spe_mfcio_putf(spe_context_ptr_t spe, unsigned int ls, void* ea, unsigned int size, unsigned int tag,
                   unsigned int tid, unsigned int rid) {
  return issue(spe, MfcOpcode::putf, ls, ea, size, tag, tid, rid);
}
int spe_mfcio_get(spe_context_ptr_t spe, unsigned int ls, void* ea, unsigned int size, unsigned int tag,
                  unsigned int tid, unsigned int rid) {
  return issue(spe, MfcOpcode::get, ls, ea, size, tag, tid, rid);
}
int spe_mfcio_getb(spe_context_ptr_t spe, unsigned int ls, void* ea, unsigned int size, unsigned int tag,
                   unsigned int tid, unsigned int rid) {
  return issue(spe, MfcOpcode::getb, ls, ea, size, tag, tid, rid);
}
int spe_mfcio_getf(spe_context_ptr_t spe, unsigned int ls, void* ea, unsigned int size, unsigned int tag,
                   unsigned int tid, unsigned int rid) {
  return issue(spe, MfcOpcode::getf, ls, ea, size, tag, tid, rid);
}

int spe_mfcio_tag_status_read(spe_context_ptr_t spe, unsigned int mask, unsigned int behavior,
                              unsigned int* tag_status) {
  return with_context(spe, [&](spe_context& context) {
    if (tag_status == nullptr) return fail(EINVAL);
    const unsigned int tags = mask == 0 ? context.tags.load() : mask;
    unsigned int complete = 0;
    switch (behavior) {
      case SPE_TAG_ALL:
        complete = context.problem_state().wait_proxy(tags);
        break;
      case SPE_TAG_ANY:
        complete = context.spe->wait_any_proxy(tags);
        break;
      case SPE_TAG_IMMEDIATE:
        complete = context.problem_state().proxy_status(tags);
        break;
      default:
        return fail(EINVAL);
    }
    context.tags.fetch_and(~complete);
    if (const auto fault = context.spe->poll_proxy_fault()) {
      Machine::get().report(*fault);
      return fail(EIO);
    }
    *tag_status = complete;
    return 0;
  });
}
