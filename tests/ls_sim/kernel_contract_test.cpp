// What the emulator and kernels say to each other by numbers and places is declared on either side, which may not include each other. Here
// the compiler compares the two.

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "../../spu_kernels/sdk/checked/report.h"
#pragma GCC diagnostic pop
#include "../../spu_kernels/sdk/library/assist.h"
#include "assisted/assisted_calls.h"
#include "native/kernel_context.h"
#include "softcell_environment.h"

namespace softcell::ls_sim {
namespace {

using Host = native::Environment;
using Kernel = softcell_sdk::Environment;
static_assert(sizeof(Host) == sizeof(Kernel));
#define SC_SAME_FIELD(field)                                        \
  static_assert(offsetof(Host, field) == offsetof(Kernel, field) && \
                sizeof(Host::field) == sizeof(Kernel::field))
SC_SAME_FIELD(gate);
SC_SAME_FIELD(mfc_lsa);
SC_SAME_FIELD(mfc_eah);
SC_SAME_FIELD(mfc_eal);
SC_SAME_FIELD(mfc_size);
SC_SAME_FIELD(mfc_tag);
SC_SAME_FIELD(mfc_tag_mask);
SC_SAME_FIELD(access_bytes);
SC_SAME_FIELD(access_instruction);
SC_SAME_FIELD(access_stack_pointer);
SC_SAME_FIELD(job_image_ea);
SC_SAME_FIELD(job_ea);
SC_SAME_FIELD(assist);
SC_SAME_FIELD(reserved);

template <class Enumeration>
constexpr std::uint32_t number(Enumeration value) {
  return static_cast<std::uint32_t>(value);
}
#define SC_SAME_NUMBER(host, kernel, name) static_assert(number(host::name) == number(kernel::name))
#define SC_SAME_OPERATION(name) SC_SAME_NUMBER(native::Operation, softcell_sdk, name)
SC_SAME_OPERATION(kRead);
SC_SAME_OPERATION(kWrite);
SC_SAME_OPERATION(kCount);
SC_SAME_OPERATION(kStop);
SC_SAME_OPERATION(kHalt);
SC_SAME_OPERATION(kTagStatus);
SC_SAME_OPERATION(kAccess);
SC_SAME_OPERATION(kJob);
SC_SAME_OPERATION(kSync);
SC_SAME_OPERATION(kAssist);
#define SC_SAME_TOLD(name) SC_SAME_NUMBER(native::Told, softcell_checked, name)
SC_SAME_TOLD(kLoad);
SC_SAME_TOLD(kStore);
SC_SAME_TOLD(kHeapBlock);
SC_SAME_TOLD(kFreedBlock);

static_assert(assisted::kC99Call == kAssistedCalls + softcell_library::kC99);
static_assert(assisted::kPosixCall == kAssistedCalls + softcell_library::kPosix);
#define SC_SAME_C99_CALL(name) SC_SAME_NUMBER(assisted::C99Function, softcell_library::C99Call, name)
SC_SAME_C99_CALL(kClearerr);
SC_SAME_C99_CALL(kFclose);
SC_SAME_C99_CALL(kFeof);
SC_SAME_C99_CALL(kFerror);
SC_SAME_C99_CALL(kFflush);
SC_SAME_C99_CALL(kFgetc);
SC_SAME_C99_CALL(kFgets);
SC_SAME_C99_CALL(kFileno);
SC_SAME_C99_CALL(kFopen);
SC_SAME_C99_CALL(kFputc);
SC_SAME_C99_CALL(kFputs);
SC_SAME_C99_CALL(kFread);
SC_SAME_C99_CALL(kFreopen);
SC_SAME_C99_CALL(kFseek);
SC_SAME_C99_CALL(kFtell);
SC_SAME_C99_CALL(kFwrite);
SC_SAME_C99_CALL(kGetchar);
SC_SAME_C99_CALL(kPutchar);
SC_SAME_C99_CALL(kPuts);
SC_SAME_C99_CALL(kRemove);
SC_SAME_C99_CALL(kRename);
SC_SAME_C99_CALL(kRewind);
SC_SAME_C99_CALL(kTmpfile);
SC_SAME_C99_CALL(kUngetc);
SC_SAME_C99_CALL(kVfprintf);
SC_SAME_C99_CALL(kVfscanf);
SC_SAME_C99_CALL(kVprintf);
SC_SAME_C99_CALL(kVscanf);
SC_SAME_C99_CALL(kVsnprintf);
SC_SAME_C99_CALL(kVsscanf);
#define SC_SAME_POSIX_CALL(name) SC_SAME_NUMBER(assisted::PosixFunction, softcell_library::PosixCall, name)
SC_SAME_POSIX_CALL(kClose);
SC_SAME_POSIX_CALL(kFstat);
SC_SAME_POSIX_CALL(kGettimeofday);
SC_SAME_POSIX_CALL(kLseek);
SC_SAME_POSIX_CALL(kLstat);
SC_SAME_POSIX_CALL(kOpen);
SC_SAME_POSIX_CALL(kRead);
SC_SAME_POSIX_CALL(kStat);
SC_SAME_POSIX_CALL(kUnlink);
SC_SAME_POSIX_CALL(kWrite);
SC_SAME_POSIX_CALL(kFtruncate);
SC_SAME_POSIX_CALL(kAccess);
SC_SAME_POSIX_CALL(kNanosleep);

TEST(KernelContract, IsTheSameOnBothSides) { SUCCEED() << "the compiler has compared it"; }

}  // namespace
}  // namespace softcell::ls_sim
