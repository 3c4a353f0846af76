// The cost of an instruction of a program built for the SPU.

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "benchmarks.h"
#include "softcell/base/assert.h"
#include "softcell/dma/address_space.h"
#include "softcell/ls_sim/spe_group.h"
#include "softcell/ls_sim/timing.h"

namespace softcell::tool {
namespace {

/// A loop of integer and floating-point arithmetic, shuffles, loads, a store and branches. argp's upper word is the number of times that it
/// runs, a multiple of four.
constexpr std::uint32_t kMix[] = {
    0x42080006,  //       ila     $6,0x1000
    0x420FFF95,  //       ila     $21,0x1fff
    0x42100016,  //       ila     $22,0x2000
    0x3400030A,  // loop: lqd     $10,0($6)
    0x3400430B,  //       lqd     $11,16($6)
    0xE182C50C,  //       fma     $12,$10,$11,$12
    0x1C080306,  //       ai      $6,$6,32
    0x1803868D,  //       a       $13,$13,$14
    0xB1E2C510,  //       shufb   $15,$10,$11,$16
    0x58C50511,  //       fm      $17,$10,$20
    0x3F810792,  //       rotqbyi $18,$15,4
    0x18254306,  //       and     $6,$6,$21
    0x24000B0C,  //       stqd    $12,0($22)
    0x8262C517,  //       selb    $19,$10,$11,$23
    0x48038698,  //       cgt     $24,$13,$14
    0x0F60C699,  //       shli    $25,$13,3
    0x48234C9A,  //       xor     $26,$25,$13
    0x1400C21B,  //       andi    $27,$4,3
    0x2000011B,  //       brz     $27,skip
    0x04000D9C,  //       ori     $28,$27,0
    0x1CFFC204,  // skip: ai      $4,$4,-1
    0x217FF704,  //       brnz    $4,loop
    0x00002000,  //       stop    0x2000
};
constexpr std::size_t kRounds = 200'000;
constexpr std::size_t kInstructions = 3 + kRounds * 18 + kRounds / 4 * 3 + 1;
constexpr std::uint32_t kBegin = 0x80;

ls_sim::KernelImage mix() {
  ls_sim::KernelImage image;
  image.name = "mix";
  image.machine = ls_sim::Machine::kSpu;
  image.begin = image.entry = image.text_begin = kBegin;
  for (const std::uint32_t word : kMix) {
    for (int shift = 24; shift >= 0; shift -= 8) image.bytes.push_back(static_cast<std::byte>(word >> shift));
  }
  SC_ASSERT(image.bytes.size() == sizeof kMix && kBegin + sizeof kMix <= 0x100,
            "a program of {} bytes from {} on", image.bytes.size(), kBegin);
  const auto end = kBegin + static_cast<std::uint32_t>(sizeof kMix);
  image.text_end = image.rodata_begin = image.rodata_end = image.data_begin = image.data_end = end;
  image.sizes = {.text = sizeof kMix, .stack = 4096, .budget = dma::kLocalStoreBytes, .end = 0x100};
  return image;
}

class InterpreterRig {
 public:
  explicit InterpreterRig(bool is_timed)
      : image_(mix()),
        timing_(is_timed ? std::make_unique<ls_sim::Timing>(1) : nullptr),
        group_(memory_, options()) {}

  void run() {
    group_.start(0, image_, {.argp = std::uint64_t{kRounds} << 32});
    const ls_sim::RunResult result = group_.wait(0);
    if (result.fault) throw std::runtime_error(result.fault->message());
    const std::uint64_t executed = group_.statistics(0).instructions;
    SC_ASSERT(executed >= before_, "{} instructions after {}", executed, before_);
    if (executed - before_ != kInstructions)
      throw std::runtime_error("the mix executed " + std::to_string(executed - before_) +
                               " instructions instead of " + std::to_string(kInstructions));
    before_ = executed;
  }

 private:
  ls_sim::SpeOptions options() const {
    ls_sim::SpeOptions options{.spes = 1};
    ls_sim::time_by(timing_.get(), options);
    return options;
  }

  dma::AddressSpace memory_;
  ls_sim::KernelImage image_;
  std::unique_ptr<ls_sim::Timing> timing_;
  ls_sim::SpeGroup group_;
  std::uint64_t before_ = 0;
};

}  // namespace

void add_interpreter_benchmarks(std::vector<Benchmark>& all) {
  for (const bool is_timed : {false, true}) {
    all.push_back({is_timed ? "interpreter/mix-timed" : "interpreter/mix", [is_timed] {
                     const auto rig = std::make_shared<InterpreterRig>(is_timed);
                     return Work{.items = kInstructions, .run = [rig] { rig->run(); }};
                   }});
  }
}

}  // namespace softcell::tool
