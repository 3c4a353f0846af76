// Errors of lv2 as errors of C.

#include <array>
#include <cerrno>
#include <utility>

#include "lv2.h"
#include "sys/lv2errno.h"

namespace {

using namespace softcell::psl1ght;

constexpr std::array<std::pair<std::uint32_t, int>, 15> kErrors{{{kAgain, EAGAIN},
                                                                 {kInvalid, EINVAL},
                                                                 {kNotSupported, ENOSYS},
                                                                 {kNoMemory, ENOMEM},
                                                                 {kNoSuchObject, ESRCH},
                                                                 {kNoSuchFile, ENOENT},
                                                                 {kNoProgram, ENOEXEC},
                                                                 {kBusy, EBUSY},
                                                                 {kTimedOut, ETIMEDOUT},
                                                                 {kFault, EFAULT},
                                                                 {kWrongState, EIO},
                                                                 {kCancelled, ECANCELED},
                                                                 {kExists, EEXIST},
                                                                 {kConnected, EISCONN},
                                                                 {kNotConnected, ENOTCONN}}};
constexpr std::uint32_t kErrorClass = 0x80010000;

}  // namespace

s32 lv2error(s32 error) {
  const auto code = static_cast<std::uint32_t>(error);
  for (const auto& [of_lv2, of_c] : kErrors) {
    if (of_lv2 == code) return of_c;
  }
  return (code & 0xFFFF0000u) == kErrorClass ? EINVAL : error;
}

s32 lv2errno(s32 error) {
  if ((static_cast<std::uint32_t>(error) & 0xFFFF0000u) != kErrorClass) return error;
  errno = lv2error(error);
  return -1;
}
