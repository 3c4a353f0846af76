#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstring>
#include <ctime>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "image/low_memory.h"
#include "softcell/ls_sim/engine.h"
#include "softcell/ls_sim/source_lines.h"
#include "test_images.h"

namespace softcell::ls_sim {
namespace {

/// Answers every channel with 0 and records the arithmetic mode in which it was called.
class RecordingPort final : public ChannelPort {
 public:
  ChannelReply read(std::uint32_t) override { return note(); }
  ChannelReply write(std::uint32_t channel, std::uint32_t value) override {
    writes.emplace_back(channel, value);
    return note();
  }
  ChannelReply count(std::uint32_t) override { return note(); }
  ChannelReply issue(const dma::MfcCommand& command) override {
    commands.push_back(command);
    return note();
  }
  void sync() override {
    ++syncs;
    flags_in_sync = __builtin_ia32_readeflags_u64();
  }

  std::vector<std::pair<std::uint32_t, std::uint32_t>> writes;
  std::vector<dma::MfcCommand> commands;
  int syncs = 0;
  std::uint64_t flags_in_sync = 0;
  std::vector<unsigned int> modes;

 private:
  ChannelReply note() {
    modes.push_back(_mm_getcsr() & ~_MM_EXCEPT_MASK);
    return {};
  }
};

class NativeEngineTest : public testing::Test {
 protected:
  RunResult run(const std::string& name, EntryArguments arguments = {}) {
    image_ = test_image(name);
    engine_->load(image_);
    return engine_->run(arguments, port_);
  }

  LocalStore local_store_;
  std::unique_ptr<Engine> engine_ = make_native_engine(local_store_);
  KernelImage image_;
  RecordingPort port_;
};

TEST_F(NativeEngineTest, EndsWithTheStatusOfMain) {
  const RunResult result = run("echo_arguments", {.spe_id = 1, .argp = 0x1000, .envp = 42});
  ASSERT_FALSE(result.fault);
  EXPECT_EQ(result.stop_code, 0x2000u + 42u);
  EXPECT_EQ(result.status(), 42u);
}

TEST_F(NativeEngineTest, RunsAnImageWhereItIsLinked) {
  run("resides", {.argp = 0x1000});
  ASSERT_EQ(port_.commands.size(), 1u);
  std::array<std::uint32_t, 4> report{};  // code, data, stack, value
  std::memcpy(report.data(), local_store_.base() + port_.commands[0].lsa.value, sizeof report);
  EXPECT_EQ(report[0], image_.entry);
  EXPECT_GE(report[1], image_.data_begin);
  EXPECT_LT(report[1], image_.sizes.end);
  EXPECT_LT(report[2], image_.begin);
  EXPECT_GE(report[2], image_.begin - image_.sizes.stack);
  EXPECT_EQ(report[3], 7u);
  EXPECT_GT(engine_->stack_high_water(), 0u);
  EXPECT_LE(engine_->stack_high_water(), image_.sizes.stack);
}

TEST_F(NativeEngineTest, PassesCommandsThroughTheChannelsOfTheMfc) {
  const std::uint64_t ea = 0x5EA0'1234'5680;
  run("echo_arguments", {.argp = ea});
  ASSERT_FALSE(port_.commands.empty());
  const dma::MfcCommand& first = port_.commands.front();
  EXPECT_EQ(first.ea.value, ea);
  EXPECT_EQ(first.size, 128u);
  EXPECT_EQ(first.tag, 5u);
  EXPECT_EQ(first.word, 0x40u);
  EXPECT_LT(first.lsa.value, dma::kLocalStoreBytes);
}

/// Records every access with the source line of its instruction.
class RecordingObserver final : public AccessObserver {
 public:
  explicit RecordingObserver(const KernelImage& image) : lines_(image) {}
  void on_access(const Access& access) override {
    accesses.emplace_back(access, lines_.place_of(access.instruction));
  }
  std::vector<std::pair<Access, std::string>> accesses;

 private:
  SourceLines lines_;
};

TEST_F(NativeEngineTest, TellsLoadsAndStoresOfACheckedKernelWithTheirPlaces) {
  image_ = test_image("remembers_checked");
  ASSERT_TRUE(image_.checked);
  engine_->load(image_);
  RecordingObserver observer(image_);
  ASSERT_FALSE(engine_->run({.argp = 0x1000}, port_, &observer).fault);
  // counts.data = ++in_data: one load, two stores.
  std::vector<std::pair<std::uint32_t, bool>> of_line;
  for (const auto& [access, place] : observer.accesses) {
    EXPECT_GE(access.stack_pointer.value, dma::kLocalStoreBytes - image_.sizes.stack);
    EXPECT_EQ(access.bytes, 4u);
    if (place == "remembers.cpp:14") of_line.emplace_back(access.lsa.value, access.is_store);
  }
  const std::uint32_t in_data = image_.objects.front().begin.value;
  ASSERT_EQ(image_.objects.front().name, "in_data");
  ASSERT_EQ(of_line.size(), 3u);
  EXPECT_EQ(of_line[0], std::pair(in_data, false));
  EXPECT_TRUE(of_line[1].second && of_line[2].second);
  EXPECT_NE(of_line[1].first, of_line[2].first);
}

TEST_F(NativeEngineTest, AnUncheckedKernelReportsNothing) {
  image_ = test_image("remembers");
  engine_->load(image_);
  RecordingObserver observer(image_);
  ASSERT_FALSE(engine_->run({.argp = 0x1000}, port_, &observer).fault);
  EXPECT_TRUE(observer.accesses.empty());
}

TEST_F(NativeEngineTest, TellsTheTagMaskBeforeTheTagUpdate) {
  run("echo_arguments", {.argp = 0x1000});
  const std::vector<std::pair<std::uint32_t, std::uint32_t>> expected{{22, 1u << 5}, {23, 2}};
  ASSERT_GE(port_.writes.size(), 2u);
  EXPECT_EQ(decltype(expected)(port_.writes.begin(), port_.writes.begin() + 2), expected);
}

TEST_F(NativeEngineTest, RestoresTheHostsArithmeticInEveryCallAndAfterwards) {
  const unsigned int host = _mm_getcsr() & ~_MM_EXCEPT_MASK;
  run("arithmetic", {.argp = 0x1000});
  ASSERT_FALSE(port_.modes.empty());
  for (const unsigned int mode : port_.modes) EXPECT_EQ(mode, host);
  EXPECT_EQ(_mm_getcsr() & ~_MM_EXCEPT_MASK, host);
}

/// The host's code expects a clear direction flag. With a set one it overwrote the bytes before its own buffers.
TEST_F(NativeEngineTest, AKernelCannotTurnTheHostsStringInstructionsRound) {
  constexpr std::uint64_t kDirectionFlag = 0x400;
  image_ = test_image("computes");
  engine_->load(image_);
  for (const std::uint64_t when : {2, 3}) {
    const RunResult result = engine_->run({.argp = 1, .envp = when}, port_);
    const std::uint64_t flags = __builtin_ia32_readeflags_u64();
    asm volatile("cld" ::: "cc");
    EXPECT_FALSE(result.fault) << when;
    EXPECT_EQ(flags & kDirectionFlag, 0u) << when;
  }
  EXPECT_EQ(port_.syncs, 1);
  EXPECT_EQ(port_.flags_in_sync & kDirectionFlag, 0u);
}

TEST_F(NativeEngineTest, RestoresTheHostsArithmeticAfterAFault) {
  const unsigned int host = _mm_getcsr() & ~_MM_EXCEPT_MASK;
  EXPECT_TRUE(run("illegal_instruction").fault);
  EXPECT_EQ(_mm_getcsr() & ~_MM_EXCEPT_MASK, host);
}

/// Raises SIGILL once in the thread that created it, like a processor that executes code that is no longer there.
class SpuriousFault {
 public:
  explicit SpuriousFault(std::chrono::nanoseconds after) {
    sigevent event{};
    event.sigev_notify = SIGEV_THREAD_ID;
    event.sigev_signo = SIGILL;
    event._sigev_un._tid = gettid();
    timer_create(CLOCK_THREAD_CPUTIME_ID, &event, &timer_);
    const itimerspec when{.it_interval = {}, .it_value = {.tv_sec = 0, .tv_nsec = after.count()}};
    timer_settime(timer_, 0, &when, nullptr);
  }
  ~SpuriousFault() { timer_delete(timer_); }

 private:
  timer_t timer_{};
};

TEST_F(NativeEngineTest, AFaultThatDoesNotComeAgainIsTheProcessors) {
  image_ = test_image("computes");
  engine_->load(image_);
  ASSERT_FALSE(engine_->run({.argp = 1000}, port_).fault);
  const SpuriousFault fault(std::chrono::milliseconds(30));
  const RunResult result = engine_->run({.argp = 20'000'000'000}, port_);
  ASSERT_TRUE(result.fault);
  EXPECT_EQ(result.fault->rule, dma::Rule::kStaleInstructions) << result.fault->message();
  EXPECT_NE(result.fault->message().find("the processor ran stale instructions"), std::string::npos)
      << result.fault->message();
  EXPECT_FALSE(run("computes", {.argp = 1000}).fault);  // single steps have ended
}

TEST_F(NativeEngineTest, AFaultInOverwrittenCodeSaysSo) {
  image_ = test_image("illegal_instruction");
  engine_->load(image_);
  local_store_.base()[image_.text_begin + image_.sizes.text - 1] ^= std::byte{1};
  const RunResult result = engine_->run({}, port_);
  ASSERT_TRUE(result.fault);
  EXPECT_NE(result.fault->message().find("have been overwritten, from local-store address"),
            std::string::npos)
      << result.fault->message();
}

TEST_F(NativeEngineTest, TellsOfASync) {
  image_ = test_image("computes");
  engine_->load(image_);
  ASSERT_FALSE(engine_->run({.argp = 1, .envp = 1}, port_).fault);
  EXPECT_EQ(port_.syncs, 1);
  ASSERT_FALSE(engine_->run({.argp = 1, .envp = 0}, port_).fault);
  EXPECT_EQ(port_.syncs, 1);
}

struct FaultCase {
  const char* kernel;
  EntryArguments arguments;
  dma::Rule rule;
  const char* detail;
};

void PrintTo(const FaultCase& c, std::ostream* out) {
  *out << c.kernel << " " << static_cast<std::int64_t>(c.arguments.envp);
}

class NativeEngineFaults : public NativeEngineTest, public testing::WithParamInterface<FaultCase> {};

TEST_P(NativeEngineFaults, AreTypedAndTheEngineLives) {
  const RunResult result = run(GetParam().kernel, GetParam().arguments);
  ASSERT_TRUE(result.fault);
  EXPECT_EQ(result.fault->rule, GetParam().rule) << result.fault->message();
  EXPECT_NE(result.fault->message().find(GetParam().detail), std::string::npos) << result.fault->message();
  const RunResult after = run("echo_arguments", {.argp = 0x1000, .envp = 7});
  EXPECT_FALSE(after.fault);
  EXPECT_EQ(after.status(), 7u);
}

INSTANTIATE_TEST_SUITE_P(
    Each, NativeEngineFaults,
    testing::Values(
        // Three overflows: past the declared stack but not past the arena, past everything, and by one large frame.
        FaultCase{"stack_overflow_deep", {.envp = 12}, dma::Rule::kStackOverflow, "2048 bytes"},
        FaultCase{"stack_overflow_deep", {.envp = 100}, dma::Rule::kStackOverflow, "2048 bytes"},
        FaultCase{"stack_overflow_deep", {.envp = 100'000'000}, dma::Rule::kStackOverflow, "2048 bytes"},
        FaultCase{"read_effective_address",
                  {.argp = dma::kMainMemoryBase.value + 0x80},
                  dma::Rule::kEffectiveAddressAsPointer,
                  "0x10000080"},
        FaultCase{"read_effective_address",
                  {.argp = dma::kVideoMemoryBase.value},
                  dma::Rule::kEffectiveAddressAsPointer,
                  "0xC0000000"},
        FaultCase{"read_effective_address",
                  {.argp = dma::kMainMemoryBase.value + 0x1000'0080},  // behind the usual main memory
                  dma::Rule::kOutsideLocalStore,
                  "address 0x20000080, which is neither in the local store nor an effective address"},
        FaultCase{"read_effective_address", {.argp = 0}, dma::Rule::kOutsideLocalStore, "0x00000"},
        FaultCase{"read_effective_address",
                  {.argp = 0xEA00'0000'0000'0000},  // a pointer keeps only the low 32 bits
                  dma::Rule::kOutsideLocalStore,
                  "address 0x00000,"},
        FaultCase{"outside_local_store", {.envp = 256 * 1024}, dma::Rule::kOutsideLocalStore, "past the end"},
        FaultCase{"outside_local_store",
                  {.envp = static_cast<std::uint64_t>(-128 * 1024)},
                  dma::Rule::kOutsideLocalStore,
                  "before the local store"},
        FaultCase{"illegal_instruction", {}, dma::Rule::kIllegalInstruction, "local-store address"}));

TEST_F(NativeEngineTest, AFileThatNoDebuggerCanReadIsNoObstacle) {
  setenv("SOFTCELL_GDB", "1", 1);
  engine_ = make_native_engine(local_store_);
  unsetenv("SOFTCELL_GDB");
  image_ = test_image("echo_arguments");
  image_.elf = std::make_shared<const std::vector<std::byte>>(16);
  ASSERT_NO_THROW(engine_->load(image_));
  EXPECT_EQ(engine_->run({.argp = 0x1000, .envp = 7}, port_).status(), 7u);
}

TEST_F(NativeEngineTest, AShallowStackIsNoFaultAndIsMeasured) {
  EXPECT_FALSE(run("stack_overflow_deep", {.envp = 2}).fault);
  const std::uint32_t shallow = engine_->stack_high_water();
  EXPECT_FALSE(run("stack_overflow_deep", {.envp = 4}).fault);
  const std::uint32_t deeper = engine_->stack_high_water();
  EXPECT_GE(deeper, shallow + 2 * 256);
  EXPECT_LE(deeper, 2048u);
}

class EndlessKernels : public NativeEngineTest, public testing::WithParamInterface<std::uint64_t> {};

TEST_P(EndlessKernels, AreInterrupted) {
  image_ = test_image("endless");
  engine_->load(image_);
  std::jthread watchdog([this](const std::stop_token& done) {
    while (!done.stop_requested()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      engine_->interrupt();
    }
  });
  const RunResult result = engine_->run({.envp = GetParam()}, port_);
  ASSERT_TRUE(result.fault);
  EXPECT_EQ(result.fault->rule, dma::Rule::kDeadlineExceeded);
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutCalls, EndlessKernels, testing::Values(0, 1));

TEST(LocalStoreArena, LiesBelow4Gigabytes) {
  for (int i = 0; i < 64; ++i) {
    LocalStore local_store;
    const auto base = reinterpret_cast<std::uintptr_t>(local_store.base());
    EXPECT_EQ(base % dma::kLocalStoreBytes, 0u);
    EXPECT_LE(base + dma::kLocalStoreBytes, std::uintptr_t{1} << 32);
  }
}

TEST(LocalStoreArena, IsRefusedInASentenceWhereThereIsNoRoomForIt) {
  LocalStore in_the_way;
  try {
    reserve_below_4_gb(std::size_t{3583} << 20, "a local store");
    FAIL() << "more was reserved than there is above the first 512 MB";
  } catch (const std::runtime_error& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with("a local store cannot be reserved: this process has no ")) << message;
    EXPECT_NE(message.find("below 4 GB"), std::string::npos) << message;
  }
}

TEST(RequireVectorUnits, NamesWhatIsMissing) {
  EXPECT_NO_THROW(require_vector_units(true, true));
  EXPECT_THROW(require_vector_units(true, false), std::runtime_error);
  try {
    require_vector_units(false, true);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("lacks AVX2:"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace softcell::ls_sim
