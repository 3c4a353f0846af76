// Runs whole programs on an SPE: each checks itself, prints what failed, and ends with the number of failures.

#include <elf.h>
#include <gtest/gtest.h>
#include <sys/mman.h>

#include <algorithm>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "float_error.h"
#include "softcell/dma/address_space.h"
#include "softcell/dma/buffer.h"
#include "softcell/dma/schedule.h"
#include "softcell/ls_sim/findings.h"
#include "softcell/ls_sim/image.h"
#include "softcell/ls_sim/spe_group.h"

// clang-format off
#define SC_PROGRAMS(X)                                                                  \
  X(vectors) X(casts) X(language) X(library) X(jumps) X(fails) X(maths) X(counts) X(files) \
  X(calendar) X(text_numbers) X(characters) X(doubles) X(shared_words) X(prints) X(simd) \
  X(traps) X(statics) X(objects) X(destroys) X(vmx) X(stl) \
  X(no_parameters)
// clang-format on
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
Ended run(std::string_view name, std::span<const std::byte> elf, const EntryArguments& arguments,
          Findings* findings = nullptr) {
  const KernelImage image = load_image(name, elf);
  dma::AddressSpace memory;
  SpeGroup group(memory, {.spes = 1, .findings = findings});
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  group.start(0, image, arguments);
  Ended ended;
  ended.result = group.wait(0);
  std::fflush(stdout);
  ended.output = testing::internal::GetCapturedStdout();
  ended.errors = testing::internal::GetCapturedStderr();
  return ended;
}

Ended run(std::string_view name, std::span<const std::byte> elf, Findings* findings = nullptr) {
  return run(name, elf, kArguments, findings);
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
                         testing::Values("vectors", "casts", "language", "library", "jumps", "calendar",
                                         "characters", "doubles", "simd", "statics", "objects", "vmx", "stl",
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

TEST(Program, IsToldWhatItDidWhenTheProcessorStopsIt) {
  const struct {
    std::uint64_t how;
    const char *place, *message;
  } cases[] = {{1, "traps.c:15", "the smallest integer by -1"},
               {2, "traps.c:16", "jumped to address 0x00000, by a null pointer to a function"},
               {3, "traps.c:23", "read from address 0x00000, by a null pointer"},
               {4, "traps.c:18", "accessed a vector at an address that is no multiple of 16"}};
  for (const auto& [how, place, message] : cases) {
    const Ended ended = run("traps", program("traps").plain, EntryArguments{.argp = how});
    ASSERT_TRUE(ended.result.fault) << how;
    EXPECT_EQ(ended.result.fault->place, place) << ended.result.fault->message();
    EXPECT_NE(ended.result.fault->detail.find(message), std::string::npos) << ended.result.fault->message();
  }
}

/// Effective addresses below 4 GB, as those of a program without position-independent code: the processor would let it pass.
TEST(Program, IsToldOfALoadOrStoreInMainStorage) {
  void* const page =
      mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_32BIT, -1, 0);
  ASSERT_NE(page, MAP_FAILED);
  const auto ea = reinterpret_cast<std::uint64_t>(page);
  const struct {
    std::uint64_t how, ea;
    const char *place, *message;
  } cases[] = {{5, ea, "traps.c:21", "a load from address 0x"},
               {6, ea + 8, "traps.c:22", "a store to address 0x"},
               {5, 0, "traps.c:21", "read from address 0x00000, by a null pointer"}};
  for (const auto& [how, address, place, message] : cases) {
    Findings findings;
    const Ended ended =
        run("traps", program("traps").checked, EntryArguments{.argp = how, .envp = address}, &findings);
    ASSERT_TRUE(ended.result.fault) << how;
    EXPECT_EQ(ended.result.fault->rule, dma::Rule::kOutsideLocalStore);
    EXPECT_EQ(ended.result.fault->place, place) << ended.result.fault->message();
    EXPECT_NE(ended.result.fault->detail.find(message), std::string::npos) << ended.result.fault->message();
    EXPECT_TRUE(findings.list().empty());
  }
  EXPECT_EQ(*static_cast<int*>(page), 0);
  munmap(page, 4096);
}

TEST(Program, EndsItsStaticObjectsTheLastFirst) {
  for (const auto& build : {program("destroys").plain, program("destroys").checked}) {
    const Ended ended = run("destroys", build, EntryArguments{});
    EXPECT_EQ(ended.output,
              "first is made\nsecond is made\nthird is made\natexit\na hundred end\nthird ends\nsecond "
              "ends\nfirst ends\nthe last destructor function\nthe first destructor function\n");
    EXPECT_EQ(ended.result.status(), 0u) << ended.errors;
  }
}

TEST(Program, EndsWithASentenceWhenItsHeapHasNoRoomForAnObject) {
  const Ended ended = run("destroys", program("destroys").plain, EntryArguments{.argp = 1});
  EXPECT_EQ(ended.result.stop_code, RunResult::kNormalEnd + 1);
  EXPECT_EQ(ended.errors, "operator new: the heap of the local store has no room for 262144 bytes\n");
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

/// Runs a program in both builds with a buffer of its own, whose address it is given.
template <class Prepare>
void expect_to_pass_with_a_buffer(const char* name, const Prepare& prepare) {
  for (const bool checked : {false, true}) {
    dma::AddressSpace memory;
    dma::Buffer<char> buffer(memory, "buffer", 256);
    prepare(buffer.span());
    const KernelImage image = load_image(name, checked ? program(name).checked : program(name).plain);
    Findings findings;
    SpeGroup group(memory, {.spes = 1, .findings = checked ? &findings : nullptr});
    testing::internal::CaptureStdout();
    group.start(0, image, {.argp = buffer.ea().value});
    const RunResult ended = group.wait(0);
    std::fflush(stdout);
    const std::string output = testing::internal::GetCapturedStdout();
    EXPECT_TRUE(ended.ended_normally()) << (ended.fault ? ended.fault->message() : "");
    EXPECT_EQ(ended.status(), 0u) << output;
    for (const auto& found : findings.list()) ADD_FAILURE() << found.fault.message();
  }
}

TEST(Program, WorksOnFilesOfThePpuSide) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "softcell_program_files";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  expect_to_pass_with_a_buffer("files", [&](std::span<char> path) {
    const std::string text = (folder / "numbers.txt").string();
    ASSERT_LT(text.size(), path.size());
    std::ranges::copy(text, path.begin());
  });
  EXPECT_TRUE(std::filesystem::is_empty(folder)) << "it removes what it makes";
  std::filesystem::remove_all(folder);
}

TEST(Program, SharesWordsByTheSyncLibrary) {
  expect_to_pass_with_a_buffer("shared_words", [](std::span<char>) {});
}

TEST(Program, PrintsAndReadsInEveryWay) {
  const auto input = std::filesystem::path(testing::TempDir()) / "softcell_program_input.txt";
  std::ofstream(input) << "12 apples\nand a line\n";
  ASSERT_NE(std::freopen(input.c_str(), "r", stdin), nullptr);
  const Ended ended = run("prints", program("prints").plain);
  EXPECT_EQ(ended.output,
            "1 vprintf 2.50\nvfp 12345678901\nvsprintf-7\nvsnpr\nfpc\nfputs\nfwrite\n3 4.5\nread 12 "
            "apples\n1\nline and a line\n1 -1\n1\n");
  EXPECT_EQ(ended.errors, "perror: No such file or directory\nBad file descriptor\n");
  EXPECT_EQ(ended.result.status(), 5u);
  std::filesystem::remove(input);
}

/// As tests/programs/sources/text_numbers.c reads them.
struct TextNumber {
  char text[120] = {};
  double value = 0;
};

TEST(Program, ReadsNumbersAsTheHostDoes) {
  std::vector<std::string> texts{"0",
                                 "-0.0",
                                 "1",
                                 "  +1.5e3x",
                                 ".5",
                                 "5.",
                                 "1e",
                                 "1e+",
                                 "0x1.8p3",
                                 "0x.8p-3",
                                 "0x",
                                 "0x1.fffffffffffff8p0",
                                 "0x1.00000000000008p0",
                                 "0x1.00000000000018p0",
                                 "-0x1.000000000000080000000001p0",
                                 "0x123456789abcdefp0",
                                 "0xffffffffffffffffffp-3",
                                 "0x1.fffffffffffff8p1023",
                                 "0x1.fffffffffffff7p1023",
                                 "inf",
                                 "-Infinity",
                                 "1e400",
                                 "-1e400",
                                 "1e-400",
                                 "1.7976931348623157e308",
                                 "1.7976931348623159e308",
                                 "2.2250738585072014e-308",
                                 "9007199254740993",
                                 "9007199254740992.5",
                                 "9007199254740995",
                                 "4503599627370496.5",
                                 "4503599627370497.5",
                                 "0.1",
                                 "123456789012345678",
                                 "1.00000000000000011102230246251565404236316680908203125",
                                 "1.00000000000000011102230246251565404236316680908203124",
                                 "8.98846567431158e307",
                                 "5e-324",
                                 "4.9406564584124654e-320",
                                 "abc",
                                 "",
                                 "-",
                                 "1.2.3",
                                 "00012"};
  std::mt19937_64 random(3);
  while (texts.size() < 4096) {
    const int digits = 1 + static_cast<int>(random() % 19);
    std::string text(random() % 2 == 0 ? "-" : "");
    const std::size_t point = random() % 20;
    for (int i = 0; i < digits; ++i) {
      if (static_cast<std::size_t>(i) == point) text += '.';
      text += static_cast<char>('0' + random() % 10);
    }
    const int exponent = static_cast<int>(random() % 640) - 320;
    text += random() % 4 == 0 ? "" : "e" + std::to_string(exponent);
    texts.push_back(text);
  }
  dma::AddressSpace memory;
  dma::Buffer<TextNumber> numbers(memory, "numbers", texts.size());
  for (std::size_t i = 0; i < texts.size(); ++i) std::ranges::copy(texts[i], numbers[i].text);
  const KernelImage image = load_image("text_numbers", program("text_numbers").plain);
  SpeGroup group(memory, {.spes = 1});
  group.start(0, image, {.argp = numbers.ea().value, .envp = texts.size()});
  const RunResult ended = group.wait(0);
  ASSERT_TRUE(ended.ended_normally()) << (ended.fault ? ended.fault->message() : "");
  for (std::size_t i = 0; i < texts.size(); ++i) {
    char* end = nullptr;
    double expected = std::strtod(texts[i].c_str(), &end);
    if (std::fabs(expected) < DBL_MIN) expected = std::copysign(0.0, expected);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(numbers[i].value), std::bit_cast<std::uint64_t>(expected))
        << texts[i] << " is " << numbers[i].value;
    EXPECT_EQ(numbers[i].text[0], static_cast<char>(end - texts[i].c_str())) << "characters of " << texts[i];
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
    const double error = error_of(result.data()[i], exact);
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
