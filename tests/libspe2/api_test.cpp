// Every function of libspe2: what it does, and each error that is documented for it.

#include <libspe2.h>

#include <sys/mman.h>
#include <sys/stat.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

extern "C" {
extern spe_program_handle_t echoes, pauses, collects_signals, calls, sums_its_store, breaks_rules,
    takes_tickets;
}

namespace {

/// A context, while the object lives.
class Context {
 public:
  explicit Context(spe_program_handle_t* program = nullptr, unsigned int flags = 0,
                   spe_gang_context_ptr_t gang = nullptr)
      : spe_(spe_context_create(flags, gang)) {
    EXPECT_NE(spe_, nullptr) << std::strerror(errno);
    if (program != nullptr) {
      EXPECT_EQ(spe_program_load(spe_, program), 0) << std::strerror(errno);
    }
  }
  ~Context() {
    if (runner_.joinable()) runner_.join();
    if (spe_ != nullptr) {
      EXPECT_EQ(spe_context_destroy(spe_), 0) << std::strerror(errno);
    }
  }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  operator spe_context_ptr_t() const { return spe_; }

  int run(std::uint64_t argp = 0, std::uint64_t envp = 0, unsigned int flags = 0) {
    unsigned int entry = SPE_DEFAULT_ENTRY;
    return spe_context_run(spe_, &entry, flags, reinterpret_cast<void*>(argp), reinterpret_cast<void*>(envp),
                           &stop);
  }
  /// run() in a thread, which the destructor waits for.
  void start() {
    runner_ = std::jthread([this] { result = run(); });
  }
  void join() { runner_.join(); }
  void write(unsigned int value) { EXPECT_EQ(spe_in_mbox_write(spe_, &value, 1, SPE_MBOX_ALL_BLOCKING), 1); }

  spe_stop_info_t stop{};
  std::atomic<int> result{-2};

 private:
  spe_context_ptr_t spe_;
  std::jthread runner_;
};

/// A pointer to a context that is gone.
spe_context_ptr_t gone() {
  static const spe_context_ptr_t pointer = [] {
    const spe_context_ptr_t spe = spe_context_create(0, nullptr);
    EXPECT_EQ(spe_context_destroy(spe), 0);
    return spe;
  }();
  return pointer;
}

#define EXPECT_ERRNO(call, failure, error)                            \
  do {                                                                \
    errno = 0;                                                        \
    EXPECT_EQ((call), failure);                                       \
    EXPECT_EQ(errno, error) << #call << ": " << std::strerror(errno); \
  } while (0)
#define EXPECT_FAILS(call, error) EXPECT_ERRNO(call, -1, error)
#define EXPECT_NULL(call, error) EXPECT_ERRNO(call, nullptr, error)

// ---- contexts

TEST(SpeContext, IsMadeAndDestroyed) {
  const spe_context_ptr_t spe = spe_context_create(
      SPE_EVENTS_ENABLE | SPE_CFG_SIGNOTIFY1_OR | SPE_CFG_SIGNOTIFY2_OR | SPE_MAP_PS | SPE_NOSCHED, nullptr);
  ASSERT_NE(spe, nullptr);
  EXPECT_EQ(spe_context_destroy(spe), 0);
  EXPECT_FAILS(spe_context_destroy(spe), ESRCH);
  EXPECT_FAILS(spe_context_destroy(nullptr), ESRCH);
}

TEST(SpeContext, RefusesUnknownFlagsIsolationAndGangsThatAreGone) {
  EXPECT_NULL(spe_context_create(1, nullptr), EINVAL);
  EXPECT_NULL(spe_context_create(SPE_ISOLATE, nullptr), ENODEV);
  EXPECT_NULL(spe_context_create(SPE_ISOLATE_EMULATE, nullptr), ENODEV);
  int other = 0;
  EXPECT_NULL(spe_context_create(0, reinterpret_cast<spe_gang_context_ptr_t>(&other)), ESRCH);
}

TEST(SpeContext, ThereAre256AtATime) {
  std::vector<std::unique_ptr<Context>> contexts;
  for (int i = 0; i < 256; ++i) contexts.push_back(std::make_unique<Context>());
  EXPECT_NULL(spe_context_create(0, nullptr), ENOMEM);
  contexts.pop_back();
  const Context in_its_place;
}

TEST(SpeContext, IsNotDestroyedWhileItRuns) {
  Context context(&echoes);
  context.start();
  context.write(5);
  unsigned int value = 0;
  ASSERT_EQ(spe_out_intr_mbox_read(context, &value, 1, SPE_MBOX_ALL_BLOCKING), 1);
  EXPECT_FAILS(spe_context_destroy(context), EAGAIN);
  EXPECT_FAILS(spe_program_load(context, &echoes), EBUSY);
  EXPECT_FAILS(context.run(), EBUSY);
  context.write(0);
}

TEST(SpeGang, HasContextsAndOutlivesThem) {
  EXPECT_NULL(spe_gang_context_create(1), EINVAL);
  const spe_gang_context_ptr_t gang = spe_gang_context_create(0);
  ASSERT_NE(gang, nullptr);
  {
    const Context first(nullptr, 0, gang);
    EXPECT_FAILS(spe_gang_context_destroy(gang), EAGAIN);
    const Context alone;
    EXPECT_NULL(spe_context_create_affinity(0, first, nullptr), EINVAL);
    EXPECT_NULL(spe_context_create_affinity(0, alone, gang), EINVAL);
    EXPECT_NULL(spe_context_create_affinity(0, gone(), gang), ESRCH);
    const spe_context_ptr_t second = spe_context_create_affinity(SPE_AFFINITY_MEMORY, first, gang);
    const spe_context_ptr_t third = spe_context_create_affinity(0, first, gang);
    ASSERT_TRUE(second != nullptr && third != nullptr);
    EXPECT_NULL(spe_context_create_affinity(0, first, gang), EEXIST);  // it has two neighbours
    EXPECT_NULL(spe_context_create_affinity(SPE_AFFINITY_MEMORY, nullptr, gang), EEXIST);
    EXPECT_EQ(spe_context_destroy(second), 0);
    EXPECT_EQ(spe_context_destroy(third), 0);
  }
  EXPECT_EQ(spe_gang_context_destroy(gang), 0);
  EXPECT_FAILS(spe_gang_context_destroy(gang), ESRCH);
  EXPECT_NULL(spe_context_create_affinity(0, nullptr, gang), ESRCH);
}

// ---- programs

TEST(SpeImage, IsOpenedLoadedAndClosed) {
  spe_program_handle_t* const program = spe_image_open(PAUSES_IMAGE);
  ASSERT_NE(program, nullptr) << std::strerror(errno);
  Context context(program);
  EXPECT_EQ(spe_image_close(program), 0);
  EXPECT_EQ(context.run(), 0x11) << "the context has its own copy";
  EXPECT_FAILS(spe_image_close(program), EINVAL);
  EXPECT_FAILS(spe_image_close(nullptr), EINVAL);
}

TEST(SpeImage, TellsWhyAFileCannotBeOpened) {
  EXPECT_NULL(spe_image_open(nullptr), EFAULT);
  EXPECT_NULL(spe_image_open("no such file"), ENOENT);
  const auto file =
      std::filesystem::temp_directory_path() / ("softcell_no_program_" + std::to_string(getpid()));
  std::ofstream(file) << "not an ELF file";
  testing::internal::CaptureStderr();
  EXPECT_NULL(spe_image_open(file.c_str()), ENOEXEC);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("not an ELF file"), std::string::npos);
  if (geteuid() != 0) {
    chmod(file.c_str(), 0);
    EXPECT_NULL(spe_image_open(file.c_str()), EACCES);
  }
  std::filesystem::remove(file);
}

TEST(SpeProgram, IsRefusedWithoutAnImage) {
  const Context context;
  EXPECT_FAILS(spe_program_load(gone(), &pauses), ESRCH);
  EXPECT_FAILS(spe_program_load(context, nullptr), EINVAL);
  alignas(8) std::array<char, 64> text{"this is no ELF file"};
  spe_program_handle_t handle{sizeof handle, text.data(), nullptr};
  EXPECT_FAILS(spe_program_load(context, &handle), EINVAL);
  handle.elf_image = nullptr;
  EXPECT_FAILS(spe_program_load(context, &handle), EINVAL);
}

TEST(SpeProgram, MayHaveAHandleThatOtherToolsHaveMade) {
  spe_program_handle_t handle{sizeof handle, pauses.elf_image, nullptr};
  Context context(&handle);
  EXPECT_EQ(context.run(), 0x11);
}

// ---- running

TEST(SpeRun, ChecksItsArguments) {
  Context context;
  unsigned int entry = SPE_DEFAULT_ENTRY;
  EXPECT_FAILS(spe_context_run(gone(), &entry, 0, nullptr, nullptr, nullptr), ESRCH);
  EXPECT_FAILS(spe_context_run(context, &entry, 0, nullptr, nullptr, nullptr),
               ENOEXEC);  // nothing was loaded
  ASSERT_EQ(spe_program_load(context, &pauses), 0);
  EXPECT_FAILS(spe_context_run(context, nullptr, 0, nullptr, nullptr, nullptr), EINVAL);
  EXPECT_FAILS(spe_context_run(context, &entry, 4, nullptr, nullptr, nullptr), EINVAL);
  EXPECT_FAILS(spe_context_run(context, &entry, SPE_RUN_USER_REGS, nullptr, nullptr, nullptr), EINVAL);
  entry = 0x1234;
  EXPECT_FAILS(spe_context_run(context, &entry, 0, nullptr, nullptr, nullptr), EINVAL);
}

TEST(SpeRun, StopInformationIsReadOnce) {
  Context context(&pauses, SPE_EVENTS_ENABLE);
  spe_stop_info_t stop{};
  EXPECT_FAILS(spe_stop_info_read(context, &stop), EAGAIN);
  ASSERT_EQ(context.run(), 0x11);
  EXPECT_FAILS(spe_stop_info_read(context, nullptr), EINVAL);
  ASSERT_EQ(spe_stop_info_read(context, &stop), 0);
  EXPECT_EQ(stop.stop_reason, static_cast<unsigned>(SPE_STOP_AND_SIGNAL));
  EXPECT_EQ(stop.result.spe_signal_code, 0x11);
  EXPECT_FAILS(spe_stop_info_read(context, &stop), EAGAIN);
  unsigned int entry = SPE_DEFAULT_ENTRY;
  for (const int code : {0x11, 0x12, 0x13})
    ASSERT_EQ(spe_context_run(context, &entry, 0, nullptr, nullptr, nullptr), code);
  for (const int code : {0x11, 0x12, 0x13}) {
    ASSERT_EQ(spe_stop_info_read(context, &stop), 0);
    EXPECT_EQ(stop.result.spe_signal_code, code);
  }
  EXPECT_FAILS(spe_stop_info_read(context, &stop), EAGAIN);
  EXPECT_FAILS(spe_stop_info_read(gone(), &stop), ESRCH);
  const Context without(&pauses);
  EXPECT_FAILS(spe_stop_info_read(without, &stop), ENOTSUP);
}

TEST(SpeRun, AHaltOrAChannelThatThereIsNotIsAnErrorOfTheProgram) {
  struct Case {
    std::uint64_t what;
    int detail, status;
  };
  for (const auto& [what, detail, status] :
       {Case{8, SPE_SPU_HALT, 4}, Case{9, SPE_SPU_INVALID_CHANNEL, 0x40}}) {
    Context context(&breaks_rules, SPE_MAP_PS);
    testing::internal::CaptureStderr();
    EXPECT_FAILS(context.run(what), EFAULT);
    testing::internal::GetCapturedStderr();
    EXPECT_EQ(context.stop.stop_reason, static_cast<unsigned>(SPE_RUNTIME_ERROR)) << what;
    EXPECT_EQ(context.stop.result.spe_runtime_error, detail) << what;
    EXPECT_EQ(context.stop.spu_status, status) << what;
  }
}

TEST(SpeRun, RulesThatAProgramBreaksAreStopReasonsAndMessages) {
  struct Case {
    std::uint64_t what, ea;
    unsigned int reason;
    int detail;
    const char* rule;
  };
  alignas(128) static std::array<std::byte, 256> memory;
  const auto ea = reinterpret_cast<std::uint64_t>(memory.data());
  const auto read_only =
      reinterpret_cast<std::uint64_t>(mmap(nullptr, 4096, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
  for (const auto& [what, at, reason, detail, rule] :
       {Case{1, ea, SPE_RUNTIME_EXCEPTION, SPE_DMA_ALIGNMENT, "ea-alignment"},
        Case{2, 0x7000'0000'0000, SPE_RUNTIME_EXCEPTION, SPE_DMA_SEGMENTATION, "ea-not-mapped"},
        Case{3, read_only, SPE_RUNTIME_EXCEPTION, SPE_DMA_STORAGE, "ea-not-writable"},
        Case{4, ea, SPE_RUNTIME_EXCEPTION, SPE_INVALID_DMA, "tag-out-of-range"},
        Case{12, ea, SPE_RUNTIME_EXCEPTION, SPE_INVALID_DMA, "size-zero"},
        Case{13, ea, SPE_RUNTIME_EXCEPTION, SPE_DMA_ALIGNMENT, "atomic-alignment"}}) {
    Context context(&breaks_rules);
    testing::internal::CaptureStderr();
    EXPECT_FAILS(context.run(what, at), EIO);
    const std::string message = testing::internal::GetCapturedStderr();
    EXPECT_NE(message.find("breaks_rules.cpp"), std::string::npos) << message;
    EXPECT_NE(message.find(rule), std::string::npos) << message;
    EXPECT_EQ(context.stop.stop_reason, reason) << rule;
    EXPECT_EQ(context.stop.result.spe_runtime_exception, detail) << rule;
    EXPECT_EQ(context.run(5), 0) << "stop 0: the context can be used again";
  }
  munmap(reinterpret_cast<void*>(read_only), 4096);
}

// ---- callbacks

int count_only(void*, unsigned int) { return 0; }

TEST(SpeCallback, IsRegisteredUpdatedAndTakenAway) {
  void* const handler = reinterpret_cast<void*>(&count_only);
  EXPECT_FAILS(spe_callback_handler_register(nullptr, 20, SPE_CALLBACK_NEW), EINVAL);
  EXPECT_FAILS(spe_callback_handler_register(handler, 256, SPE_CALLBACK_NEW), EINVAL);
  EXPECT_FAILS(spe_callback_handler_register(handler, 20, 3), EINVAL);
  EXPECT_FAILS(spe_callback_handler_register(handler, 3, SPE_CALLBACK_NEW), EACCES);
  EXPECT_FAILS(spe_callback_handler_register(handler, 1, SPE_CALLBACK_UPDATE), EACCES);
  EXPECT_FAILS(spe_callback_handler_deregister(3), EACCES);
  EXPECT_FAILS(spe_callback_handler_register(handler, 20, SPE_CALLBACK_UPDATE), ESRCH);
  EXPECT_EQ(spe_callback_handler_register(handler, 20, SPE_CALLBACK_NEW), 0);
  EXPECT_FAILS(spe_callback_handler_register(handler, 20, SPE_CALLBACK_NEW), EACCES);
  EXPECT_EQ(spe_callback_handler_register(handler, 20, SPE_CALLBACK_UPDATE), 0);
  EXPECT_EQ(spe_callback_handler_query(20), handler);
  EXPECT_EQ(spe_callback_handler_deregister(20), 0);
  EXPECT_FAILS(spe_callback_handler_deregister(20), ESRCH);
  EXPECT_FAILS(spe_callback_handler_deregister(256), EINVAL);
  EXPECT_NULL(spe_callback_handler_query(20), ESRCH);
  EXPECT_NULL(spe_callback_handler_query(256), EINVAL);
}

TEST(SpeCallback, ACallThatNobodyAnswersIsAnErrorOrWithoutCallbacksAStop) {
  ASSERT_EQ(spe_callback_handler_register(reinterpret_cast<void*>(&count_only), 16, SPE_CALLBACK_NEW), 0);
  Context context(&calls);
  EXPECT_EQ(context.run(0, 0, SPE_NO_CALLBACKS), 0x2110);
  EXPECT_EQ(context.stop.stop_reason, static_cast<unsigned>(SPE_STOP_AND_SIGNAL));
  EXPECT_EQ(spe_callback_handler_deregister(16), 0);
  EXPECT_EQ(context.run(0, 0, SPE_NO_CALLBACKS), 0x2110);
  testing::internal::CaptureStderr();
  EXPECT_FAILS(context.run(), EFAULT);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("number 16, for which"), std::string::npos);
  EXPECT_EQ(context.stop.stop_reason, static_cast<unsigned>(SPE_CALLBACK_ERROR));
  EXPECT_EQ(context.stop.result.spe_callback_error, -1);
  EXPECT_EQ(context.stop.spu_status, 0x2110 << 16 | 2);
}

TEST(SpeCallback, ACallOfTheCLibraryThatNamesNoFunctionIsNoMatterOfHandlers) {
  Context context(&breaks_rules);
  testing::internal::CaptureStderr();
  EXPECT_FAILS(context.run(10, 0), EFAULT);
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "softcell: an SPE program calls the PPU side by number 1, which is the C library's, and names no "
            "function that softcell has\n");
}

// ---- mailboxes and signals

TEST(SpeMailbox, ChecksItsArguments) {
  const Context context;
  unsigned int value = 0;
  for (const auto write : {spe_in_mbox_write, spe_out_intr_mbox_read}) {
    EXPECT_FAILS(write(gone(), &value, 1, SPE_MBOX_ANY_NONBLOCKING), ESRCH);
    EXPECT_FAILS(write(context, nullptr, 1, SPE_MBOX_ANY_NONBLOCKING), EINVAL);
    EXPECT_FAILS(write(context, &value, 0, SPE_MBOX_ANY_NONBLOCKING), EINVAL);
    EXPECT_FAILS(write(context, &value, 1, 0), EINVAL);
    EXPECT_FAILS(write(context, &value, 1, 4), EINVAL);
  }
  EXPECT_FAILS(spe_out_mbox_read(gone(), &value, 1), ESRCH);
  EXPECT_FAILS(spe_out_mbox_read(context, nullptr, 1), EINVAL);
  EXPECT_FAILS(spe_out_mbox_read(context, &value, 0), EINVAL);
  for (const auto status : {spe_out_mbox_status, spe_in_mbox_status, spe_out_intr_mbox_status})
    EXPECT_FAILS(status(gone()), ESRCH);
}

TEST(SpeMailbox, HoldsWhatFitsAndWaitsAsItIsTold) {
  Context context(&echoes);
  std::array<unsigned int, 6> values{1, 2, 3, 4, 5, 0};
  EXPECT_EQ(spe_in_mbox_status(context), 4);
  EXPECT_EQ(spe_in_mbox_write(context, values.data(), 6, SPE_MBOX_ANY_NONBLOCKING), 4) << "nobody reads yet";
  EXPECT_EQ(spe_in_mbox_status(context), 0);
  EXPECT_EQ(spe_in_mbox_write(context, values.data(), 1, SPE_MBOX_ANY_NONBLOCKING), 0);
  EXPECT_EQ(spe_out_mbox_status(context), 0);
  EXPECT_EQ(spe_out_intr_mbox_status(context), 0);
  unsigned int value = 0;
  EXPECT_EQ(spe_out_mbox_read(context, &value, 1), 0);
  EXPECT_EQ(spe_out_intr_mbox_read(context, &value, 1, SPE_MBOX_ANY_NONBLOCKING), 0);
  context.start();
  std::jthread reader([&] {
    std::array<unsigned int, 5> doubled{};
    unsigned int answer = 0;
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_EQ(spe_out_intr_mbox_read(context, &doubled[i], 1,
                                       i == 0 ? SPE_MBOX_ALL_BLOCKING : SPE_MBOX_ANY_BLOCKING),
                1);
      EXPECT_EQ(doubled[i], 2 * (i + 1));
      EXPECT_EQ(spe_out_mbox_read(context, &answer, 1), 1);
      EXPECT_EQ(answer, i + 2);
    }
  });
  EXPECT_EQ(spe_in_mbox_write(context, &values[4], 2, SPE_MBOX_ALL_BLOCKING), 2);
  reader.join();
  context.join();
  EXPECT_EQ(context.stop.result.spe_exit_code, 5);
}

TEST(SpeMailbox, WhoWaitsForAContextThatGoesReturns) {
  const spe_context_ptr_t spe = spe_context_create(0, nullptr);
  std::atomic<bool> waits{false};
  std::jthread waiter([&] {
    unsigned int value = 0;
    waits = true;
    EXPECT_FAILS(spe_out_intr_mbox_read(spe, &value, 1, SPE_MBOX_ALL_BLOCKING), ESRCH);
  });
  while (!waits) std::this_thread::yield();
  std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(spe_context_destroy(spe), 0);
}

TEST(SpeSignal, GoesToOneOfTwoRegisters) {
  Context context(&collects_signals, SPE_CFG_SIGNOTIFY2_OR);
  EXPECT_EQ(spe_signal_write(context, SPE_SIG_NOTIFY_REG_1, 5), 0);
  EXPECT_EQ(spe_signal_write(context, SPE_SIG_NOTIFY_REG_1, 9), 0) << "overwrites";
  EXPECT_EQ(spe_signal_write(context, SPE_SIG_NOTIFY_REG_2, 1), 0);
  EXPECT_EQ(spe_signal_write(context, SPE_SIG_NOTIFY_REG_2, 4), 0) << "collects";
  EXPECT_FAILS(spe_signal_write(context, 3, 0), EINVAL);
  EXPECT_FAILS(spe_signal_write(gone(), SPE_SIG_NOTIFY_REG_1, 0), ESRCH);
  context.write(1);
  EXPECT_EQ(context.run(), 0);
  EXPECT_EQ(context.stop.result.spe_exit_code, 9 << 4 | 5);
}

// ---- proxy commands

TEST(SpeProxyDma, MovesBytesAndTellsRules) {
  Context context;
  alignas(128) std::array<std::uint32_t, 32> from, to{};
  for (std::uint32_t i = 0; i < 32; ++i) from[i] = i * i;
  unsigned int status = 0;
  EXPECT_EQ(spe_mfcio_get(context, 0x1000, from.data(), 128, 1, 0, 0), 0);
  EXPECT_EQ(spe_mfcio_putf(context, 0x1000, to.data(), 64, 1, 0, 0), 0);
  EXPECT_EQ(spe_mfcio_putb(context, 0x1040, to.data() + 16, 64, 1, 0, 0), 0);
  EXPECT_EQ(spe_mfcio_tag_status_read(context, 0, SPE_TAG_ALL, &status), 0);
  EXPECT_EQ(status, 2u);
  EXPECT_EQ(to, from);
  EXPECT_EQ(spe_mfcio_getb(context, 0x2000, from.data(), 16, 31, 0, 0), 0);
  EXPECT_EQ(spe_mfcio_getf(context, 0x2010, from.data(), 16, 31, 0, 0), 0);
  EXPECT_EQ(spe_mfcio_put(context, 0x2000, to.data() + 4, 16, 2, 0, 0), 0);
  EXPECT_EQ(spe_mfcio_tag_status_read(context, 1u << 31 | 4, SPE_TAG_ANY, &status), 0);
  EXPECT_NE(status, 0u);
  EXPECT_EQ(spe_mfcio_tag_status_read(context, 1u << 31 | 4, SPE_TAG_ALL, &status), 0);
  EXPECT_EQ(status, 1u << 31 | 4);
  EXPECT_EQ(spe_mfcio_tag_status_read(context, 8, SPE_TAG_IMMEDIATE, &status), 0);
  EXPECT_EQ(status, 8u) << "a tag without commands is complete";
  EXPECT_FAILS(spe_mfcio_tag_status_read(context, 1, 0, &status), EINVAL);
  EXPECT_FAILS(spe_mfcio_tag_status_read(context, 1, SPE_TAG_ALL, nullptr), EINVAL);
  EXPECT_FAILS(spe_mfcio_tag_status_read(gone(), 1, SPE_TAG_ALL, &status), ESRCH);
  for (const auto issue :
       {spe_mfcio_put, spe_mfcio_putb, spe_mfcio_putf, spe_mfcio_get, spe_mfcio_getb, spe_mfcio_getf}) {
    testing::internal::CaptureStderr();
    EXPECT_FAILS(issue(context, 0x1000, from.data(), 17, 1, 0, 0), EINVAL);
    EXPECT_FAILS(issue(context, 0x1000, nullptr, 16, 1, 0, 0), EINVAL);
    EXPECT_FAILS(issue(context, 0x1000, from.data(), 16, 32, 0, 0), EINVAL);
    const std::string message = testing::internal::GetCapturedStderr();
    EXPECT_NE(message.find("proxy command of the PPU side: size-not-legal"), std::string::npos) << message;
    EXPECT_FAILS(issue(gone(), 0x1000, from.data(), 16, 1, 0, 0), ESRCH);
  }
}

// ---- memory and the machine

TEST(SpeMemory, IsThePointerThatOthersUse) {
  const Context context(nullptr, SPE_MAP_PS), without;
  auto* const store = static_cast<char*>(spe_ls_area_get(context));
  ASSERT_NE(store, nullptr);
  EXPECT_EQ(spe_ls_size_get(context), 262144);
  std::memset(store, 7, 262144);
  EXPECT_NULL(spe_ls_area_get(gone()), ESRCH);
  EXPECT_FAILS(spe_ls_size_get(gone()), ESRCH);
  EXPECT_EQ(static_cast<char*>(spe_ps_area_get(context, SPE_SIG_NOTIFY_1_AREA)) - store, 0x54000);
  EXPECT_EQ(static_cast<char*>(spe_ps_area_get(context, SPE_SIG_NOTIFY_2_AREA)) - store, 0x5C000);
  EXPECT_EQ(static_cast<char*>(spe_ps_area_get(context, SPE_CONTROL_AREA)) - store, 0x44000);
  EXPECT_EQ(static_cast<char*>(spe_ps_area_get(context, SPE_MFC_COMMAND_AREA)) - store, 0x43000);
  EXPECT_EQ(static_cast<char*>(spe_ps_area_get(context, SPE_MSSYNC_AREA)) - store, 0x40000);
  EXPECT_EQ(offsetof(spe_spu_control_area_t, SPU_NPC), 0x34u);
  EXPECT_EQ(offsetof(spe_mfc_command_area_t, Prxy_TagStatus), 0x22Cu);
  EXPECT_NULL(spe_ps_area_get(without, SPE_CONTROL_AREA), EACCES);
  EXPECT_NULL(spe_ps_area_get(context, static_cast<ps_area>(5)), EINVAL);
  EXPECT_NULL(spe_ps_area_get(gone(), SPE_CONTROL_AREA), ESRCH);
  EXPECT_EQ(spe_mssync_start(context), 0);
  EXPECT_EQ(spe_mssync_status(context), 0);
  EXPECT_FAILS(spe_mssync_start(gone()), ESRCH);
  EXPECT_FAILS(spe_mssync_status(gone()), ESRCH);
}

TEST(SpeCpuInfo, IsThatOfAConsole) {
  EXPECT_EQ(spe_cpu_info_get(SPE_COUNT_PHYSICAL_CPU_NODES, -1), 1);
  EXPECT_EQ(spe_cpu_info_get(SPE_COUNT_PHYSICAL_SPES, -1), 6);
  EXPECT_EQ(spe_cpu_info_get(SPE_COUNT_USABLE_SPES, 0), 6);
  EXPECT_FAILS(spe_cpu_info_get(0, -1), EINVAL);
  EXPECT_FAILS(spe_cpu_info_get(SPE_COUNT_USABLE_SPES, 1), EINVAL);
  EXPECT_FAILS(spe_cpu_info_get(SPE_COUNT_USABLE_SPES, -2), EINVAL);
}

// ---- events

TEST(SpeEvents, CheckTheirArguments) {
  const spe_event_handler_ptr_t handler = spe_event_handler_create();
  ASSERT_NE(handler, nullptr);
  const Context context(nullptr, SPE_EVENTS_ENABLE), without;
  spe_event_unit_t event{SPE_EVENT_IN_MBOX, context, {}};
  int nothing = 0;
  for (const auto change : {spe_event_handler_register, spe_event_handler_deregister}) {
    EXPECT_FAILS(change(&nothing, &event), ESRCH);
    EXPECT_FAILS(change(handler, nullptr), EINVAL);
    spe_event_unit_t wrong{SPE_EVENT_IN_MBOX, gone(), {}};
    EXPECT_FAILS(change(handler, &wrong), EINVAL);
    wrong = {16, context, {}};
    EXPECT_FAILS(change(handler, &wrong), ENOTSUP);
    wrong = {SPE_EVENT_IN_MBOX, without, {}};
    EXPECT_FAILS(change(handler, &wrong), ENOTSUP);
  }
  EXPECT_FAILS(spe_event_wait(&nothing, &event, 1, 0), ESRCH);
  EXPECT_FAILS(spe_event_wait(handler, nullptr, 1, 0), EINVAL);
  EXPECT_FAILS(spe_event_wait(handler, &event, 0, 0), EINVAL);
  EXPECT_FAILS(spe_event_wait(handler, &event, 1, -2), EINVAL);
  EXPECT_EQ(spe_event_wait(handler, &event, 1, 0), 0);
  EXPECT_EQ(spe_event_wait(handler, &event, 1, 5), 0);
  EXPECT_EQ(spe_event_handler_destroy(handler), 0);
  EXPECT_FAILS(spe_event_handler_destroy(handler), ESRCH);
}

TEST(SpeEvents, HoldAsLongAsTheirCondition) {
  const spe_event_handler_ptr_t handler = spe_event_handler_create();
  Context context(&echoes, SPE_EVENTS_ENABLE);
  spe_event_unit_t wanted{SPE_EVENT_ALL_EVENTS, context, {}};
  wanted.data.u64 = 99;
  ASSERT_EQ(spe_event_handler_register(handler, &wanted), 0);
  std::array<spe_event_unit_t, 8> events{};
  const auto wait_for = [&](unsigned int event) {
    const int count = spe_event_wait(handler, events.data(), 8, 1000);
    return count >= 1 && events[0].events == event && events[0].spe == context && events[0].data.u64 == 99;
  };
  EXPECT_TRUE(wait_for(SPE_EVENT_IN_MBOX)) << "there is room";
  std::array<unsigned int, 4> four{1, 2, 0, 7};
  EXPECT_EQ(spe_in_mbox_write(context, four.data(), 4, SPE_MBOX_ALL_BLOCKING), 4);
  EXPECT_EQ(spe_event_wait(handler, events.data(), 8, 0), 0) << "it is full";
  alignas(16) std::array<char, 16> bytes{};
  EXPECT_EQ(spe_mfcio_get(context, 0x20000, bytes.data(), 16, 3, 0, 0), 0);
  EXPECT_TRUE(wait_for(SPE_EVENT_TAG_GROUP));
  EXPECT_TRUE(wait_for(SPE_EVENT_TAG_GROUP)) << "until the status is read";
  unsigned int status = 0;
  EXPECT_EQ(spe_mfcio_tag_status_read(context, 0, SPE_TAG_IMMEDIATE, &status), 0);
  EXPECT_EQ(status, 8u);
  wanted.events = SPE_EVENT_IN_MBOX;
  EXPECT_EQ(spe_event_handler_deregister(handler, &wanted), 0);
  context.start();
  for (unsigned int i = 1; i <= 2; ++i) {
    EXPECT_TRUE(wait_for(SPE_EVENT_OUT_INTR_MBOX));
    unsigned int value = 0;
    while (spe_out_mbox_read(context, &value, 1) == 0) std::this_thread::yield();
    EXPECT_EQ(spe_out_intr_mbox_read(context, &value, 1, SPE_MBOX_ANY_NONBLOCKING), 1);
    EXPECT_EQ(value, 2 * i);
  }
  EXPECT_TRUE(wait_for(SPE_EVENT_SPE_STOPPED));
  spe_stop_info_t stop{};
  EXPECT_EQ(spe_stop_info_read(context, &stop), 0);
  EXPECT_EQ(stop.result.spe_exit_code, 2);
  EXPECT_EQ(spe_event_wait(handler, events.data(), 8, 0), 0);
  EXPECT_EQ(spe_event_handler_destroy(handler), 0);
}

TEST(SpeEvents, AHandlerIsNotDestroyedWhileSomebodyWaits) {
  const spe_event_handler_ptr_t handler = spe_event_handler_create();
  const Context context(nullptr, SPE_EVENTS_ENABLE);
  std::atomic<bool> waits{false};
  std::jthread waiter([&] {
    spe_event_unit_t event{};
    waits = true;
    EXPECT_EQ(spe_event_wait(handler, &event, 1, -1), 1);
  });
  while (!waits) std::this_thread::yield();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_FAILS(spe_event_handler_destroy(handler), EAGAIN);
  spe_event_unit_t wanted{SPE_EVENT_IN_MBOX, context, {}};
  EXPECT_EQ(spe_event_handler_register(handler, &wanted), 0) << "what is registered meanwhile counts";
  waiter.join();
  EXPECT_EQ(spe_event_handler_destroy(handler), 0);
}

// ---- contention

TEST(SpeContention, ThousandsOfContextsComeAndGo) {
  std::vector<std::jthread> threads;
  for (int thread = 0; thread < 4; ++thread) {
    threads.emplace_back([] {
      for (int i = 0; i < 300; ++i) {
        Context context(&pauses);
        EXPECT_EQ(context.run(), 0x11);
      }
    });
  }
}

TEST(SpeContention, SignalsOfTheProcessDoNotDisturbRuns) {
  static std::atomic<int> received{0};
  struct sigaction action {};
  action.sa_handler = [](int) { ++received; };
  struct sigaction before {};
  sigaction(SIGUSR1, &action, &before);
  {
    std::atomic<bool> ends{false};
    Context context(&echoes);
    context.start();
    std::jthread sender([&] {
      while (!ends) {
        kill(getpid(), SIGUSR1);
        std::this_thread::sleep_for(std::chrono::microseconds(50));
      }
    });
    for (unsigned int i = 1; i <= 500; ++i) {
      context.write(i);
      unsigned int value = 0;
      EXPECT_EQ(spe_out_intr_mbox_read(context, &value, 1, SPE_MBOX_ALL_BLOCKING), 1);
      EXPECT_EQ(value, 2 * i);
      EXPECT_EQ(spe_out_mbox_read(context, &value, 1), 1);
    }
    context.write(0);
    context.join();
    EXPECT_EQ(context.result, 0);
    ends = true;
  }
  sigaction(SIGUSR1, &before, nullptr);
  EXPECT_GT(received, 0);
}

TEST(SpeContention, AThreadThatIsCancelledRunsItsContextToTheEndFirst) {
  Context context(&echoes);
  pthread_t thread{};
  ASSERT_EQ(pthread_create(
                &thread, nullptr,
                [](void* argument) -> void* {
                  static_cast<Context*>(argument)->run();
                  return nullptr;
                },
                &context),
            0);
  context.write(1);
  unsigned int value = 0;
  EXPECT_EQ(spe_out_intr_mbox_read(context, &value, 1, SPE_MBOX_ALL_BLOCKING), 1);
  EXPECT_EQ(pthread_cancel(thread), 0);
  context.write(0);
  EXPECT_EQ(pthread_join(thread, nullptr), 0);
  EXPECT_EQ(context.stop.stop_reason, static_cast<unsigned>(SPE_EXIT));
}

}  // namespace
