#pragma once
// Marks where jobs begin and end inside a resident kernel, for the messages, statistics and traces of the
// emulator. On the hardware the marks cost two stores.

#include <stdint.h>

#ifdef __SPU__
namespace softcell::spu {
/// Effective addresses of the image and of the job in progress. The emulator finds this variable by its name; it sees that a job begins
/// and ends by the call of main and the return from it.
inline volatile uint64_t job_mark[2];

inline void mark_job_begin(uint64_t image_ea, uint64_t job_ea) {
  job_mark[0] = image_ea;
  job_mark[1] = job_ea;
}
inline void mark_job_end() {}
}  // namespace softcell::spu
#else
#include "softcell_environment.h"  // of the sdk
namespace softcell::spu {
/// @param image_ea  of the image that runs   @param job_ea  of the job's descriptor, which identifies the job
inline void mark_job_begin(uint64_t image_ea, uint64_t job_ea) {
  softcell_sdk::mark_job_begin(image_ea, job_ea);
}
inline void mark_job_end() { softcell_sdk::mark_job_end(); }
}  // namespace softcell::spu
#endif
