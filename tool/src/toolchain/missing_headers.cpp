#include "missing_headers.h"

#include <algorithm>
#include <array>

namespace softcell::toolchain {
namespace {

template <class Names>
bool has(const Names& names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

constexpr std::array kOfThePpuSide{"altivec.h",       "lv2/spu.h", "ppu_intrinsics.h", "spu2vmx.h",
                                   "libspe.h",        "libspe2.h", "libspe2-types.h",  "sys/event_queue.h",
                                   "sys/interrupt.h", "sys/spu.h"};
constexpr std::array kOfThreads{"condition_variable", "future", "mutex",    "pthread.h", "sched.h",
                                "semaphore.h",        "thread", "threads.h"};
constexpr std::array kOfSignals{"csignal", "signal.h"};
constexpr std::array kOfText{"clocale", "cwchar", "cwctype", "locale", "locale.h", "wchar.h", "wctype.h"};
constexpr std::array kOfTheSystem{
    "dirent.h",     "dlfcn.h",   "fenv.h",       "getopt.h",    "netdb.h",    "poll.h",
    "pwd.h",        "regex.h",   "sys/ioctl.h",  "sys/ipc.h",   "sys/mman.h", "sys/resource.h",
    "sys/select.h", "sys/shm.h", "sys/socket.h", "sys/times.h", "sys/wait.h", "termios.h"};
constexpr std::array kOfCxx{"any",
                            "atomic",
                            "bitset",
                            "charconv",
                            "chrono",
                            "complex",
                            "deque",
                            "exception",
                            "execution",
                            "filesystem",
                            "forward_list",
                            "fstream",
                            "functional",
                            "iomanip",
                            "ios",
                            "iosfwd",
                            "iostream",
                            "istream",
                            "list",
                            "map",
                            "memory",
                            "memory_resource",
                            "optional",
                            "ostream",
                            "queue",
                            "random",
                            "ratio",
                            "regex",
                            "scoped_allocator",
                            "set",
                            "shared_mutex",
                            "sstream",
                            "stack",
                            "stdexcept",
                            "streambuf",
                            "string",
                            "string_view",
                            "strstream",
                            "system_error",
                            "tuple",
                            "typeindex",
                            "typeinfo",
                            "unordered_map",
                            "unordered_set",
                            "valarray",
                            "variant",
                            "vector"};

}  // namespace

std::optional<std::string> why_missing(std::string_view header) {
  std::string name(1, '<');
  name.append(header).append(">");
  if (has(kOfThePpuSide, header)) return name + " is a header of the PPU side; this is a program for an SPU";
  if (has(kOfThreads, header))
    return name + ": an SPU program has no threads; the PPU side starts one program on each SPE";
  if (has(kOfSignals, header)) return name + ": an SPU program has no signals";
  if (has(kOfText, header)) return name + ": an SPU program has no locales and no wide texts here";
  if (has(kOfTheSystem, header))
    return name + " is not in the C library of SPU programs here; c-library.md lists what there is";
  if (has(kOfCxx, header))
    return name +
           " is not in the C++ library of SPU programs here, which has neither containers nor streams; "
           "c-library.md lists what there is";
  return std::nullopt;
}

}  // namespace softcell::toolchain
