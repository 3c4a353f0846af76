// Keeps all memory of a program below 4 GB, for code that keeps its pointers in 32 bits, as on the console. Loaded or
// linked before the C library, for programs that lie at a fixed address (-no-pie):
//
//   variables      the system places them with the program, below 4 GB
//   heap           behind them: the C library takes no pages from elsewhere
//   main's stack   this library has main() run on one of its own, with copies of its arguments
//   other stacks   pthread_create() gives each thread one
//   mmap()         without a wish for an address
//
// Not kept there: the variables of other shared libraries, and the environment.

#include <dlfcn.h>
#include <link.h>
#include <malloc.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <new>

namespace {

constexpr std::size_t kPageBytes = 4096;
constexpr std::size_t kStackBytes = std::size_t{8} << 20, kMostStackBytes = std::size_t{64} << 20;

// Pages are taken from above downwards, and the heap grows towards them: the system begins it at any address in the
// first gigabyte or a little behind, where its own search for low addresses (MAP_32BIT) would find pages, too. From
// kSearchEnd on are the addresses of raw SPUs, of thread groups, and what comes of sums with these.
constexpr std::uintptr_t kSearchBegin = 0x5000'0000, kSearchEnd = 0xD000'0000;
constexpr std::uintptr_t kSearchStep = std::uintptr_t{1} << 16;

void* map(void* place, std::size_t bytes, int protection, int flags, int file, off_t offset) {
  return reinterpret_cast<void*>(syscall(SYS_mmap, place, bytes, protection, flags, file, offset));
}

/// Pages below 4 GB. @return  MAP_FAILED with errno set
void* map_low(std::size_t bytes, int protection, int flags, int file, off_t offset) {
  static std::atomic<std::uintptr_t> lowest{kSearchEnd};  ///< of all pages that this function has returned
  const std::size_t room = (bytes + kSearchStep - 1) / kSearchStep * kSearchStep;
  if (room == 0 || room > kSearchEnd - kSearchBegin) {
    errno = ENOMEM;
    return MAP_FAILED;
  }
  // Searches below all of these first, then everywhere, for pages that have become free.
  for (const std::uintptr_t from : {lowest.load(), kSearchEnd}) {
    for (std::uintptr_t at = from - room; at >= kSearchBegin && at < from; at -= kSearchStep) {
      void* const place = reinterpret_cast<void*>(at);
      void* const got =
          map(place, bytes, protection, (flags & ~MAP_32BIT) | MAP_FIXED_NOREPLACE, file, offset);
      if (got == place) {
        lowest = std::min(lowest.load(), at);
        return got;
      }
      if (got != MAP_FAILED) munmap(got, bytes);
      if (got == MAP_FAILED && errno != EEXIST) return MAP_FAILED;  // it is not for want of a place
    }
  }
  errno = ENOMEM;
  return MAP_FAILED;
}

std::size_t round_up_to_page(std::size_t bytes) { return (bytes + kPageBytes - 1) / kPageBytes * kPageBytes; }

/// A stack with an inaccessible page below it. @return  MAP_FAILED: there is no room
void* map_stack(std::size_t bytes) {
  void* const stack =
      map_low(bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_STACK | MAP_NORESERVE, -1, 0);
  if (stack != MAP_FAILED) mprotect(stack, kPageBytes, PROT_NONE);
  return stack;
}

[[noreturn]] void give_up(const char* why) {
  std::fprintf(stderr, "softcell: %s\n", why);
  _exit(2);
}

// ---- the heap

int is_program_fixed(dl_phdr_info* program, std::size_t, void* fixed) {
  *static_cast<bool*>(fixed) = program->dlpi_addr == 0;
  return 1;  // the program itself comes first
}

/// Before the constructors of others.
[[gnu::constructor(101)]] void keep_heap_low() {
  bool fixed = false;
  dl_iterate_phdr(&is_program_fixed, &fixed);
  if (!fixed) {
    give_up(
        "to keep all memory below 4 GB, link the program with -no-pie: it is position-independent, so its "
        "variables lie above");
  }
  mallopt(M_ARENA_MAX, 1);  // all of the heap lies where sbrk() makes room
  mallopt(M_MMAP_MAX, 0);
}

// ---- stacks of threads

/// A stack that threads use one after another. The C library keeps its data of a thread on the thread's stack, so the next thread gets the
/// stack only when the thread was joined, or has ended and is detached.
struct Stack {
  void* begin = nullptr;
  std::size_t bytes = 0;
  bool taken = false;
  pid_t user = 0;  ///< 0: it has not begun
  bool detached = false;
};

/// Guarded by its mutex. The stacks stay until the process ends.
struct Stacks {
  static constexpr std::size_t kMost = 4096;
  std::mutex mutex;
  std::array<Stack, kMost> all;

  static Stacks& get() {
    alignas(Stacks) static std::byte place[sizeof(Stacks)];
    static Stacks* const made = new (place) Stacks;
    return *made;
  }

  /// A stack that is no longer used, or a new one. @return  null: there is no room
  Stack* take(std::size_t bytes) {
    const std::lock_guard lock(mutex);
    for (Stack& stack : all) {
      if (stack.taken && stack.detached && stack.user != 0 &&
          syscall(SYS_tgkill, getpid(), stack.user, 0) != 0)
        stack.taken = false;
      if (stack.taken || (stack.begin != nullptr && stack.bytes < bytes)) continue;
      if (stack.begin == nullptr) {
        void* const begin = map_stack(bytes);
        if (begin == MAP_FAILED) return nullptr;
        stack.begin = begin;
        stack.bytes = bytes;
      }
      stack.taken = true;
      stack.user = 0;
      stack.detached = false;
      return &stack;
    }
    return nullptr;
  }
  void give_back(Stack& stack) {
    const std::lock_guard lock(mutex);
    stack.taken = false;
  }
  void set_user(Stack& stack, pid_t user) {
    const std::lock_guard lock(mutex);
    stack.user = user;
  }
  void set_detached(Stack& stack) {
    const std::lock_guard lock(mutex);
    stack.detached = true;
  }
  /// The stack of a thread that can be joined. @return  null: it is none of ours
  Stack* of(pthread_t thread) {
    const std::lock_guard lock(mutex);
    for (Stack& stack : all) {
      // The C library's data of a thread, to which pthread_t points, lie on its stack, also before the thread begins.
      const auto begin = reinterpret_cast<std::uintptr_t>(stack.begin),
                 at = static_cast<std::uintptr_t>(thread);
      if (stack.taken && !stack.detached && at >= begin && at < begin + stack.bytes) return &stack;
    }
    return nullptr;
  }
};

struct ThreadStart {
  void* (*function)(void*);
  void* argument;
  Stack* stack;
};

void* begin_thread(void* given) {
  const ThreadStart start = *static_cast<ThreadStart*>(given);
  std::free(given);
  Stacks::get().set_user(*start.stack, static_cast<pid_t>(syscall(SYS_gettid)));
  return start.function(start.argument);
}

using CreateThread = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);

/// A thread on a stack of ours.
int create_thread(CreateThread create, pthread_t* thread, const pthread_attr_t* attributes,
                  void* (*function)(void*), void* argument) {
  std::size_t bytes = 0;
  pthread_attr_t own;
  if (pthread_attr_init(&own) != 0) return ENOMEM;
  pthread_attr_getstacksize(attributes == nullptr ? &own : attributes, &bytes);
  Stack* const stack = Stacks::get().take(round_up_to_page(bytes) + kPageBytes);
  auto* const start = static_cast<ThreadStart*>(std::malloc(sizeof(ThreadStart)));
  int error = stack == nullptr || start == nullptr ? EAGAIN : 0;
  if (error == 0) {
    *start = {function, argument, stack};
    if (attributes != nullptr) {
      int state = 0;
      pthread_attr_getdetachstate(attributes, &state);
      pthread_attr_setdetachstate(&own, state);
      if (state == PTHREAD_CREATE_DETACHED && stack != nullptr) Stacks::get().set_detached(*stack);
    }
    pthread_attr_setstack(&own, static_cast<std::byte*>(stack->begin) + kPageBytes,
                          stack->bytes - kPageBytes);
    error = create(thread, &own, &begin_thread, start);
  }
  if (error != 0) {
    if (stack != nullptr) Stacks::get().give_back(*stack);
    std::free(start);
  }
  pthread_attr_destroy(&own);
  return error;
}

// ---- main's stack

using Main = int (*)(int, char**, char**);
struct {
  Main function;
  int argc;
  char** argv;
  char** environment;
  int result;
  ucontext_t outside, inside;
} program_main;

void run_main() {
  program_main.result = program_main.function(program_main.argc, program_main.argv, program_main.environment);
}

char** copy_of_arguments(int argc, char** argv) {
  auto** const copy = static_cast<char**>(std::calloc(static_cast<std::size_t>(argc) + 1, sizeof(char*)));
  for (int i = 0; copy != nullptr && i < argc; ++i) copy[i] = strdup(argv[i]);
  return copy;
}

int main_on_low_stack(int argc, char** argv, char** environment) {
  rlimit limit{};
  std::size_t bytes = kStackBytes;
  if (getrlimit(RLIMIT_STACK, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    bytes = round_up_to_page(limit.rlim_cur);
  bytes = bytes < kMostStackBytes ? bytes : kMostStackBytes;
  void* const stack = map_stack(bytes);
  char** const arguments = copy_of_arguments(argc, argv);
  if (stack == MAP_FAILED || arguments == nullptr)
    give_up("there is no room below 4 GB for the stack of main()");
  program_main.argc = argc;
  program_main.argv = arguments;
  program_main.environment = environment;
  getcontext(&program_main.inside);
  program_main.inside.uc_stack.ss_sp = stack;
  program_main.inside.uc_stack.ss_size = bytes;
  program_main.inside.uc_link = &program_main.outside;
  makecontext(&program_main.inside, &run_main, 0);
  swapcontext(&program_main.outside, &program_main.inside);
  return program_main.result;
}

/// Joins by the C library's function; then the stack is free.
template <class Join>
int join_thread(pthread_t thread, Join&& join) {
  Stack* const stack = Stacks::get().of(thread);
  const int error = join();
  if (error == 0 && stack != nullptr) Stacks::get().give_back(*stack);
  return error;
}

template <class Function>
Function next_definition(const char* name) {
  auto* const found = reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
  if (found == nullptr) give_up("the C library lacks a function that keeps memory below 4 GB");
  return found;
}

}  // namespace

#define SC_EXPORT [[gnu::visibility("default")]]

extern "C" {

SC_EXPORT int __libc_start_main(Main main_function, int argc, char** argv, void (*init)(), void (*fini)(),
                                void (*rtld_fini)(), void* stack_end) {
  using Start = int (*)(Main, int, char**, void (*)(), void (*)(), void (*)(), void*);
  program_main.function = main_function;
  return next_definition<Start>("__libc_start_main")(&main_on_low_stack, argc, argv, init, fini, rtld_fini,
                                                     stack_end);
}

SC_EXPORT int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*function)(void*),
                             void* argument) {
  static const auto create = next_definition<CreateThread>("pthread_create");
  void* stack = nullptr;
  std::size_t bytes = 0;
  // A stack of the program's own begins at an address; else there is none yet.
  if (attributes != nullptr && pthread_attr_getstack(attributes, &stack, &bytes) == 0 && stack != nullptr &&
      reinterpret_cast<std::uintptr_t>(stack) + bytes != 0)
    return create(thread, attributes, function, argument);
  return create_thread(create, thread, attributes, function, argument);
}

SC_EXPORT int pthread_join(pthread_t thread, void** result) {
  static const auto join = next_definition<int (*)(pthread_t, void**)>("pthread_join");
  return join_thread(thread, [&] { return join(thread, result); });
}
SC_EXPORT int pthread_tryjoin_np(pthread_t thread, void** result) {
  static const auto join = next_definition<int (*)(pthread_t, void**)>("pthread_tryjoin_np");
  return join_thread(thread, [&] { return join(thread, result); });
}
SC_EXPORT int pthread_timedjoin_np(pthread_t thread, void** result, const timespec* until) {
  static const auto join =
      next_definition<int (*)(pthread_t, void**, const timespec*)>("pthread_timedjoin_np");
  return join_thread(thread, [&] { return join(thread, result, until); });
}
SC_EXPORT int pthread_detach(pthread_t thread) {
  static const auto detach = next_definition<int (*)(pthread_t)>("pthread_detach");
  Stack* const stack = Stacks::get().of(thread);
  const int error = detach(thread);
  if (error == 0 && stack != nullptr) Stacks::get().set_detached(*stack);
  return error;
}

SC_EXPORT void* mmap(void* place, std::size_t bytes, int protection, int flags, int file, off_t offset) {
  if (place == nullptr && (flags & (MAP_FIXED | MAP_FIXED_NOREPLACE)) == 0) {
    void* const low = map_low(bytes, protection, flags, file, offset);
    if (low != MAP_FAILED) return low;
  }
  return map(place, bytes, protection, flags, file, offset);
}
SC_EXPORT void* mmap64(void* place, std::size_t bytes, int protection, int flags, int file, off_t offset) {
  return mmap(place, bytes, protection, flags, file, offset);
}

}  // extern "C"
