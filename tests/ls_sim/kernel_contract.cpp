// What the emulator and kernels say to each other by numbers and places is declared on either side, which may not include each other, and
// the PPU side of a program for libspe2 has some of it once more. Here the compiler compares them: this file is compiled, and never linked.

#include <cstddef>
#include <cstdint>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "../../spu_kernels/sdk/checked/report.h"
#pragma GCC diagnostic pop
#include "../../ppu/libspe2/include/cbe_mfc.h"
#include "../../spu_kernels/sdk/library/assist.h"
#include "../../spu_kernels/sdk/shared/softcell_mfc_constants.h"
#include "assisted/assisted_calls.h"
#include "native/kernel_context.h"
#include "softcell/dma/mfc_command.h"
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
SC_SAME_TOLD(kLoadElsewhere);
SC_SAME_TOLD(kStoreElsewhere);
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

// cbe_mfc.h has all commands. Of those that a kernel may use, the kernels' header has the same names: the compiler refuses a second
// definition of a macro that differs from the first.
#define SC_SAME_OPCODE(name, constant) static_assert(number(dma::MfcOpcode::name) == (constant))
SC_SAME_OPCODE(put, MFC_PUT_CMD);
SC_SAME_OPCODE(putb, MFC_PUTB_CMD);
SC_SAME_OPCODE(putf, MFC_PUTF_CMD);
SC_SAME_OPCODE(putl, MFC_PUTL_CMD);
SC_SAME_OPCODE(putlb, MFC_PUTLB_CMD);
SC_SAME_OPCODE(putlf, MFC_PUTLF_CMD);
SC_SAME_OPCODE(puts, MFC_PUTS_CMD);
SC_SAME_OPCODE(putbs, MFC_PUTBS_CMD);
SC_SAME_OPCODE(putfs, MFC_PUTFS_CMD);
SC_SAME_OPCODE(putr, MFC_PUTR_CMD);
SC_SAME_OPCODE(putrb, MFC_PUTRB_CMD);
SC_SAME_OPCODE(putrf, MFC_PUTRF_CMD);
SC_SAME_OPCODE(putrl, MFC_PUTRL_CMD);
SC_SAME_OPCODE(putrlb, MFC_PUTRLB_CMD);
SC_SAME_OPCODE(putrlf, MFC_PUTRLF_CMD);
SC_SAME_OPCODE(get, MFC_GET_CMD);
SC_SAME_OPCODE(getb, MFC_GETB_CMD);
SC_SAME_OPCODE(getf, MFC_GETF_CMD);
SC_SAME_OPCODE(getl, MFC_GETL_CMD);
SC_SAME_OPCODE(getlb, MFC_GETLB_CMD);
SC_SAME_OPCODE(getlf, MFC_GETLF_CMD);
SC_SAME_OPCODE(gets, MFC_GETS_CMD);
SC_SAME_OPCODE(getbs, MFC_GETBS_CMD);
SC_SAME_OPCODE(getfs, MFC_GETFS_CMD);
SC_SAME_OPCODE(sdcrt, MFC_SDCRT_CMD);
SC_SAME_OPCODE(sdcrtst, MFC_SDCRTST_CMD);
SC_SAME_OPCODE(sdcrz, MFC_SDCRZ_CMD);
SC_SAME_OPCODE(sdcrst, MFC_SDCRST_CMD);
SC_SAME_OPCODE(sdcrf, MFC_SDCRF_CMD);
SC_SAME_OPCODE(sndsig, MFC_SNDSIG_CMD);
SC_SAME_OPCODE(sndsigb, MFC_SNDSIGB_CMD);
SC_SAME_OPCODE(sndsigf, MFC_SNDSIGF_CMD);
SC_SAME_OPCODE(putlluc, MFC_PUTLLUC_CMD);
SC_SAME_OPCODE(putllc, MFC_PUTLLC_CMD);
SC_SAME_OPCODE(putqlluc, MFC_PUTQLLUC_CMD);
SC_SAME_OPCODE(barrier, MFC_BARRIER_CMD);
SC_SAME_OPCODE(mfceieio, MFC_EIEIO_CMD);
SC_SAME_OPCODE(mfcsync, MFC_SYNC_CMD);
SC_SAME_OPCODE(getllar, MFC_GETLLAR_CMD);

constexpr int kCompared = 39;
constexpr int kOpcodes = 0
#define SC_MFC_OPCODE(name, code) +1
#include "softcell/dma/mfc_opcodes.def"
#undef SC_MFC_OPCODE
    ;
static_assert(kOpcodes == kCompared);
static_assert(dma::kMaxTransferBytes == MFC_MAX_DMA_SIZE);

}  // namespace
}  // namespace softcell::ls_sim
