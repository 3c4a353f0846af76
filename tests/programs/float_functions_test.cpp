// Each function of math.h with one argument, for arguments all over the floats: its error against the host's double precision, and that the
// same source built for the SPU has the same bits. By the environment's SOFTCELL_FLOAT_STRIDE arguments lie as many floats apart, 1 for all
// of them (`ci/float-functions`); the SPU's build computes SOFTCELL_SPU_ARGUMENTS of them.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstdlib>
#include <span>
#include <string>
#include <vector>

#include "float_error.h"
#include "softcell/base/read_file.h"
#include "softcell/dma/address_space.h"
#include "softcell/dma/buffer.h"
#include "softcell/ls_sim/image.h"
#include "softcell/ls_sim/spe_group.h"
#include "sources/float_functions.h"

extern "C" {
extern const std::byte softcell_image_program_float_sweep[], softcell_image_program_float_sweep_end[];
}

namespace softcell::ls_sim {
namespace {

struct Function {
  const char* name;
  double (*exact)(double);
};
#define SC_ENTRY(name) {#name "f", static_cast<double (*)(double)>(std::name)},
const Function kFunctions[] = {FLOAT_FUNCTIONS(SC_ENTRY)};
#undef SC_ENTRY

constexpr std::uint32_t kLogarithmOfGamma = std::size(kFunctions) - 1;

/// As tests/programs/sources/float_sweep.c reads it.
struct Sweep {
  std::uint32_t function = 0, count = 0, first = 0, stride = 0;
  std::uint64_t results = 0;
  std::uint64_t reserved[13] = {};
};
constexpr dma::ElementRun kRecord[] = {{16, 4}, {112, 8}};

constexpr std::uint32_t kBatch = 1u << 16;  // results that an SPE makes at a time
constexpr int kSpes = 6;

std::uint64_t number_from_environment(const char* name, std::uint64_t otherwise) {
  const char* const text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

/// What a function gives for arguments whose bits lie `stride` apart, with their number in front.
class Sweeper {
 public:
  explicit Sweeper(const KernelImage& image, int spes = kSpes)
      : image_(image), group_(memory_, {.spes = spes}) {
    for (int spe = 0; spe < spes; ++spe) {
      work_.emplace_back(memory_, "work", 1, dma::BufferOptions{.record = kRecord});
      results_.emplace_back(memory_, "results", kBatch);
    }
  }

  /// @param arguments  how many. @param use  called with the bits of the first, and what the function gives from there on
  template <class Use>
  void run(std::uint32_t function, std::uint64_t arguments, std::uint32_t stride, const Use& use) {
    const std::size_t spes = work_.size();
    const std::uint64_t of_each = (arguments + spes - 1) / spes;
    const auto batch =
        static_cast<std::uint32_t>(std::min<std::uint64_t>(kBatch, (of_each + 1023) / 1024 * 1024));
    for (std::uint64_t done = 0; done < arguments; done += spes * batch) {
      for (std::size_t spe = 0; spe < spes; ++spe) {
        const auto first = static_cast<std::uint32_t>((done + spe * batch) * stride);
        *work_[spe].data() = {.function = function,
                              .count = batch,
                              .first = first,
                              .stride = stride,
                              .results = results_[spe].ea().value};
        group_.start(static_cast<int>(spe), image_, {.argp = work_[spe].ea().value});
      }
      for (std::size_t spe = 0; spe < spes; ++spe) {
        const RunResult ended = group_.wait(static_cast<int>(spe));
        ASSERT_TRUE(ended.ended_normally()) << (ended.fault ? ended.fault->message() : "");
      }
      for (std::size_t spe = 0; spe < spes; ++spe) {
        const std::uint64_t begin = done + spe * batch;
        if (begin >= arguments) break;
        const std::size_t count = std::min<std::uint64_t>(batch, arguments - begin);
        use(work_[spe].data()->first, std::span<const float>(results_[spe].data(), count));
      }
    }
  }

 private:
  const KernelImage& image_;
  dma::AddressSpace memory_;
  std::vector<dma::Buffer<Sweep>> work_;
  std::vector<dma::Buffer<float>> results_;
  SpeGroup group_;  // last: ends before the buffers go
};

/// The argument that counts for a float's bits, as math.h says.
double argument_of(std::uint32_t bits) {
  constexpr std::uint32_t kExponent = 0x7F800000;
  if ((bits & kExponent) == kExponent) return bits >> 31 != 0 ? -FLT_MAX : FLT_MAX;
  return (bits & kExponent) == 0 ? std::copysign(0.0, std::bit_cast<float>(bits))
                                 : double{std::bit_cast<float>(bits)};
}

class FloatSweeps : public testing::TestWithParam<std::uint32_t> {};

TEST_P(FloatSweeps, AreWithinTheErrorThatTheirHeaderStates) {
  const auto stride = static_cast<std::uint32_t>(number_from_environment("SOFTCELL_FLOAT_STRIDE", 4099));
  const KernelImage image =
      load_image("float_sweep", {softcell_image_program_float_sweep, softcell_image_program_float_sweep_end});
  const Function& function = kFunctions[GetParam()];
  double worst = 0;
  std::uint32_t at = 0;
  Sweeper(image).run(GetParam(), (std::uint64_t{1} << 32) / stride, stride,
                     [&](std::uint32_t bits, std::span<const float> results) {
                       for (const float result : results) {
                         const double argument = argument_of(bits), exact = function.exact(argument);
                         // Close to a zero that is no whole number the logarithm of gamma has twelve digits behind the point.
                         const bool is_close = GetParam() == kLogarithmOfGamma && argument < 0 &&
                                               std::fabs(result - exact) < 1e-12;
                         const double error = is_close ? 0 : error_of(result, exact);
                         if (!(error <= worst)) worst = error, at = bits;
                         bits += stride;
                       }
                     });
  RecordProperty("worst_error_in_units_in_the_last_place", std::to_string(worst));
  EXPECT_LE(worst, kUlpsOfOneArgument)
      << function.name << " of " << std::hexfloat << std::bit_cast<float>(at);
}

#ifdef SOFTCELL_FLOAT_SWEEP_ELF
TEST_P(FloatSweeps, HaveTheSameBitsBuiltForTheSpu) {
  const std::uint64_t arguments = number_from_environment("SOFTCELL_SPU_ARGUMENTS", 4096);
  const auto stride = static_cast<std::uint32_t>((std::uint64_t{1} << 32) / arguments | 1);
  const KernelImage native =
      load_image("float_sweep", {softcell_image_program_float_sweep, softcell_image_program_float_sweep_end});
  const std::vector<std::byte> file = base::read_file(SOFTCELL_FLOAT_SWEEP_ELF, 1 << 20);
  const KernelImage spu = load_spu_program("float_sweep", file);
  ASSERT_EQ(spu.machine, Machine::kSpu);
  std::vector<float> expected;
  const auto keep = [&](std::uint32_t, std::span<const float> results) {
    expected.insert(expected.end(), results.begin(), results.end());
  };
  Sweeper(native).run(GetParam(), arguments, stride, keep);
  std::size_t next = 0, others = 0;
  Sweeper(spu).run(GetParam(), arguments, stride, [&](std::uint32_t bits, std::span<const float> results) {
    for (const float result : results) {
      if (std::bit_cast<std::uint32_t>(result) != std::bit_cast<std::uint32_t>(expected[next++]) &&
          others++ == 0)
        ADD_FAILURE() << kFunctions[GetParam()].name << " of " << std::hexfloat << std::bit_cast<float>(bits)
                      << " is " << result << " on the SPU and " << expected[next - 1] << " on the host";
      bits += stride;
    }
  });
  EXPECT_EQ(others, 0u) << "of " << arguments;
}
#endif

INSTANTIATE_TEST_SUITE_P(Each, FloatSweeps,
                         testing::Range(0u, static_cast<std::uint32_t>(std::size(kFunctions))),
                         [](const testing::TestParamInfo<std::uint32_t>& one) {
                           return std::string(kFunctions[one.param].name);
                         });

}  // namespace
}  // namespace softcell::ls_sim
