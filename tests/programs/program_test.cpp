// Runs whole programs on an SPE: each checks itself, prints what failed, and ends with the number of failures.

#include <elf.h>
#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <cstring>
#include <random>
#include <span>
#include <string>

#include "softcell/dma/address_space.h"
#include "softcell/dma/buffer.h"
#include "softcell/dma/schedule.h"
#include "softcell/ls_sim/findings.h"
#include "softcell/ls_sim/image.h"
#include "softcell/ls_sim/spe_group.h"

#define SC_PROGRAMS(X) \
  X(vectors) X(language) X(library) X(jumps) X(fails) X(maths) X(counts) X(statics) X(no_parameters)
extern "C" {
#define SC_DECLARE(name)                                                                         \
  extern const std::byte softcell_image_program_##name[], softcell_image_program_##name##_end[]; \
  extern const std::byte softcell_image_program_##name##_checked[],                              \
      softcell_image_program_##name##_checked_end[];
SC_PROGRAMS(SC_DECLARE)
#undef SC_DECLARE
}

namespace softcell::ls_sim {
namespace {

struct Program {
  const char* name;
  std::span<const std::byte> plain, checked;
};
const Program kPrograms[] = {
#define SC_ENTRY(name)                                                   \
  {#name,                                                                \
   {softcell_image_program_##name, softcell_image_program_##name##_end}, \
   {softcell_image_program_##name##_checked, softcell_image_program_##name##_checked_end}},
    SC_PROGRAMS(SC_ENTRY)
#undef SC_ENTRY
};

const Program& program(const std::string& name) {
  for (const Program& p : kPrograms)
    if (p.name == name) return p;
  throw std::logic_error("no program " + name);
}

constexpr EntryArguments kArguments{.spe_id = 1, .argp = 2, .envp = 0x3'0000'0003, .fourth = 4};

struct Ended {
  RunResult result;
  std::string output;  ///< standard output
  std::string errors;  ///< and error
};

/// Runs it once on one SPE, and what it prints is kept.
Ended run(std::string_view name, std::span<const std::byte> elf, Findings* findings = nullptr) {
  const KernelImage image = load_image(name, elf);
  dma::AddressSpace memory;
  SpeGroup group(memory, {.spes = 1, .findings = findings});
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  group.start(0, image, kArguments);
  Ended ended;
  ended.result = group.wait(0);
  std::fflush(stdout);
  ended.output = testing::internal::GetCapturedStdout();
  ended.errors = testing::internal::GetCapturedStderr();
  return ended;
}

class Programs : public testing::TestWithParam<const char*> {};

TEST_P(Programs, PassTheirOwnChecks) {
  const Ended ended = run(GetParam(), program(GetParam()).plain);
  EXPECT_FALSE(ended.result.fault) << ended.result.fault->message();
  EXPECT_TRUE(ended.result.ended_normally()) << ended.result.stop_code;
  EXPECT_EQ(ended.result.status(), 0u) << ended.output;
}

TEST_P(Programs, PassThemCheckedWithoutAFinding) {
  Findings findings;
  const Ended ended = run(GetParam(), program(GetParam()).checked, &findings);
  EXPECT_FALSE(ended.result.fault) << ended.result.fault->message();
  EXPECT_EQ(ended.result.status(), 0u) << ended.output;
  for (const auto& found : findings.list()) ADD_FAILURE() << found.fault.message();
}

INSTANTIATE_TEST_SUITE_P(Each, Programs,
                         testing::Values("vectors", "language", "library", "jumps", "statics",
                                         "no_parameters"));

TEST(Program, PrintsOnThePpuSide) {
  EXPECT_EQ(run("library", program("library").plain).output, "0 failures of library.c\n");
}

TEST(Program, EndsWithTheMessageOfAnAssertionThatDoesNotHold) {
  const Ended ended = run("fails", program("fails").plain);
  EXPECT_EQ(ended.result.stop_code, RunResult::kNormalEnd + 1);
  EXPECT_NE(ended.errors.find("fails.c:6: main: assertion \"one == 2\" failed\n"), std::string::npos)
      << ended.errors;
}

TEST(Program, IsNamedByItsOwnLineWhenItFails) {
  const Ended ended = run("maths", program("maths").plain);  // which fetches its work from address 2
  ASSERT_TRUE(ended.result.fault);
  EXPECT_TRUE(ended.result.fault->place.starts_with("maths.c:")) << ended.result.fault->message();
}

TEST(Program, HoldsPointersThatTheLoaderFits) {
  const KernelImage image = load_image("maths", program("maths").plain);
  EXPECT_TRUE(image.program);
  EXPECT_GE(image.relocations.size(), 20u) << "its tables of functions";
  for (const dma::LocalStoreAddress word : image.relocations) {
    EXPECT_GE(word.value, image.begin);
    EXPECT_LE(word.value + 4, image.begin + image.bytes.size());
  }
}

/// The first relocation of the loader's table, and where it lies in the file.
std::pair<std::size_t, Elf32_Rela> first_relocation(std::span<const std::byte> file) {
  const auto read = [&]<class Record>(std::size_t at, Record record) {
    std::memcpy(&record, file.data() + at, sizeof record);
    return record;
  };
  const auto header = read(0, Elf32_Ehdr{});
  for (std::size_t i = 0; i < header.e_shnum; ++i) {
    const auto section = read(header.e_shoff + i * sizeof(Elf32_Shdr), Elf32_Shdr{});
    if (section.sh_type != SHT_RELA || section.sh_size == 0) continue;
    const auto relocation = read(section.sh_offset, Elf32_Rela{});
    if (ELF32_R_TYPE(relocation.r_info) == R_X86_64_RELATIVE) return {section.sh_offset, relocation};
  }
  throw std::logic_error("no relocation");
}

TEST(Program, IsRefusedWithARelocationThatIsNoneOfItsOwnWords) {
  const std::span<const std::byte> whole = program("maths").plain;
  const auto [at, good] = first_relocation(whole);
  for (Elf32_Rela bad :
       {Elf32_Rela{good.r_offset, ELF32_R_INFO(0, R_X86_64_64), good.r_addend},
        Elf32_Rela{0x10, good.r_info, good.r_addend}, Elf32_Rela{0x3FFFE, good.r_info, good.r_addend},
        Elf32_Rela{0xFFFFFFFE, good.r_info, good.r_addend}, Elf32_Rela{good.r_offset, good.r_info, -1}}) {
    std::vector<std::byte> file(whole.begin(), whole.end());
    std::memcpy(file.data() + at, &bad, sizeof bad);
    try {
      load_image("maths", file);
      ADD_FAILURE() << "accepted at " << bad.r_offset;
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(),
                   "kernel image maths: it holds a relocation that is no address of 32 bits in the program");
    }
  }
}

TEST(Program, HoldsNothingOfTheLibraryThatItDoesNotUse) {
  EXPECT_LT(load_image("statics", program("statics").plain).sizes.total() - 4096, 2048u);
}

TEST(Program, SharesCountersAndLocksWithOthers) {
  for (const char* const schedule : {"eager", "lazy", "random:5"}) {
    dma::AddressSpace memory;
    dma::Buffer<std::uint32_t> words(memory, "words",
                                     96);  // three lines: a lock, what it protects, and free counters
    const KernelImage image = load_image("counts", program("counts").plain);
    SpeGroup group(memory, {.spes = 6, .schedule = dma::parse_schedule(schedule)});
    for (int spe = 0; spe < 6; ++spe) group.start(spe, image, {.argp = words.ea().value});
    for (int spe = 0; spe < 6; ++spe) {
      const RunResult ended = group.wait(spe);
      EXPECT_TRUE(ended.ended_normally()) << (ended.fault ? ended.fault->message() : "");
      EXPECT_EQ(ended.status(), 0u);
    }
    EXPECT_EQ(words.data()[0], 0u) << "the lock is free again, " << schedule;
    EXPECT_EQ(words.data()[32], 600u) << schedule;
    EXPECT_EQ(words.data()[64], 600u) << schedule;
    EXPECT_EQ(words.data()[65], 1200u) << schedule;
  }
}

/// As tests/programs/sources/maths.c reads it.
struct Work {
  std::uint32_t function = 0, count = 0;
  std::uint64_t x = 0, y = 0, result = 0;
  std::uint64_t reserved[12] = {};
};

struct MathCase {
  const char* name;
  std::uint32_t function;
  double (*one)(double);
  double (*two)(double, double);
  float low, high;  ///< of the arguments
};

class FloatFunctions : public testing::TestWithParam<MathCase> {};

TEST_P(FloatFunctions, AreWithinTheErrorThatTheirHeaderStates) {
  constexpr std::uint32_t kCount = 16 * 1024;
  constexpr double kUlps = 1.01;  // spu_kernels/sdk/library/include/math.h
  const MathCase& c = GetParam();
  dma::AddressSpace memory;
  dma::Buffer<float> x(memory, "x", kCount), y(memory, "y", kCount), result(memory, "result", kCount);
  dma::Buffer<Work> work(memory, "work", 1);
  std::mt19937 random(7);
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const auto draw = [&] { return c.low + (c.high - c.low) * static_cast<float>(random()) * 0x1p-32f; };
    x.data()[i] = draw();
    y.data()[i] = draw();
  }
  *work.data() = {.function = c.function,
                  .count = kCount,
                  .x = x.ea().value,
                  .y = y.ea().value,
                  .result = result.ea().value};
  const KernelImage image = load_image("maths", program("maths").plain);
  SpeGroup group(memory, {.spes = 1});
  group.start(0, image, {.argp = work.ea().value});
  const RunResult ended = group.wait(0);
  ASSERT_TRUE(ended.ended_normally()) << (ended.fault ? ended.fault->message() : "");
  double worst = 0;
  float at = 0;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const double exact = c.one != nullptr ? c.one(x.data()[i]) : c.two(x.data()[i], y.data()[i]);
    if (std::fabs(exact) < FLT_MIN) continue;  // flushed to zero
    int exponent = 0;
    std::frexp(exact, &exponent);
    const double error = std::fabs(result.data()[i] - exact) / std::ldexp(1.0, exponent - 24);
    if (!(error <= worst)) worst = error, at = x.data()[i];
  }
  EXPECT_LE(worst, kUlps) << c.name << " of " << at;
}

INSTANTIATE_TEST_SUITE_P(
    Each, FloatFunctions,
    testing::Values(
        MathCase{"sqrtf", 0, std::sqrt, nullptr, 0, 1e6f}, MathCase{"expf", 1, std::exp, nullptr, -80, 88},
        MathCase{"logf", 2, std::log, nullptr, 1e-6f, 10},
        MathCase{"sinf", 3, std::sin, nullptr, -1e6f, 1e6f}, MathCase{"sinf", 3, std::sin, nullptr, -4, 4},
        MathCase{"cosf", 4, std::cos, nullptr, -1e3f, 1e3f}, MathCase{"tanf", 5, std::tan, nullptr, -10, 10},
        MathCase{"atanf", 6, std::atan, nullptr, -20, 20}, MathCase{"asinf", 7, std::asin, nullptr, -1, 1},
        MathCase{"acosf", 8, std::acos, nullptr, -1, 1}, MathCase{"tanhf", 9, std::tanh, nullptr, -12, 12},
        MathCase{"floorf", 10, std::floor, nullptr, -1e4f, 1e4f},
        MathCase{"ceilf", 11, std::ceil, nullptr, -1e4f, 1e4f},
        MathCase{"roundf", 12, std::round, nullptr, -1e4f, 1e4f},
        MathCase{"log10f", 13, std::log10, nullptr, 1e-3f, 1e4f},
        MathCase{"sinhf", 14, std::sinh, nullptr, -20, 20},
        MathCase{"cbrtf", 15, std::cbrt, nullptr, -1e4f, 1e4f},
        MathCase{"powf", 100, nullptr, std::pow, 0.01f, 20},
        MathCase{"atan2f", 101, nullptr, std::atan2, -5, 5},
        MathCase{"fmodf", 102, nullptr, std::fmod, -100, 100},
        MathCase{"hypotf", 103, nullptr, std::hypot, -1e4f, 1e4f}),
    [](const testing::TestParamInfo<MathCase>& one) { return one.param.name + std::to_string(one.index); });

}  // namespace
}  // namespace softcell::ls_sim
