// Local stores and registers as memory, multi-source synchronisation, and what the machine has.

#include "libspe2.h"
#include "object.h"
#include "softcell/dma/addresses.h"

using softcell::libspe2::fail;
using softcell::libspe2::with_context;

namespace {

constexpr int kNoArea = -1;

/// The offset of an area from the local store. [CBEA, problem state memory map; SPU thread mapping] documented
int offset_of(enum ps_area area) {
  switch (area) {
    case SPE_MSSYNC_AREA:
      return 0x40000;
    case SPE_MFC_COMMAND_AREA:
      return 0x43000;
    case SPE_CONTROL_AREA:
      return 0x44000;
    case SPE_SIG_NOTIFY_1_AREA:
      return 0x54000;
    case SPE_SIG_NOTIFY_2_AREA:
      return 0x5C000;
  }
  return kNoArea;
}

/// @return  what find() has found, or null.
template <class Find>
void* pointer_of(spe_context_ptr_t spe, Find&& find) {
  void* found = nullptr;
  with_context(spe, [&](spe_context& context) {
    found = find(context);
    return 0;
  });
  return found;
}

}  // namespace

void* spe_ls_area_get(spe_context_ptr_t spe) {
  return pointer_of(
      spe, [](spe_context& context) -> void* { return context.problem_state().local_store().data(); });
}

int spe_ls_size_get(spe_context_ptr_t spe) {
  return with_context(spe, [](spe_context&) { return static_cast<int>(softcell::dma::kLocalStoreBytes); });
}

void* spe_ps_area_get(spe_context_ptr_t spe, enum ps_area area) {
  return pointer_of(spe, [&](spe_context& context) -> void* {
    const int offset = offset_of(area);
    if (offset == kNoArea || (context.flags & SPE_MAP_PS) == 0) {
      errno = offset == kNoArea ? EINVAL : EACCES;
      return nullptr;
    }
    return context.problem_state().local_store().data() + offset;
  });
}

int spe_mssync_start(spe_context_ptr_t spe) {
  return with_context(spe, [](spe_context&) { return 0; });
}

int spe_mssync_status(spe_context_ptr_t spe) {
  return with_context(spe, [](spe_context&) { return 0; });
}

int spe_cpu_info_get(int info_requested, int cpu_node) {
  if (cpu_node < -1 || cpu_node > 0) return fail(EINVAL);
  switch (info_requested) {
    case SPE_COUNT_PHYSICAL_CPU_NODES:
      return 1;
    case SPE_COUNT_PHYSICAL_SPES:
    case SPE_COUNT_USABLE_SPES:
      return softcell::dma::kSpeCount;
    default:
      return fail(EINVAL);
  }
}
