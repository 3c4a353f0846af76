#include "softcell/ls_sim/timing.h"

#include <algorithm>
#include <map>
#include <span>

#include "element_interconnect.h"
#include "softcell/base/assert.h"
#include "spe_timer.h"

namespace softcell::ls_sim {
namespace {

constexpr std::array<TimingParameterInfo,
                     []() {
                       std::size_t count = 0;
#define SC_TIMING_PARAMETER(name, value, unit, confidence, source, meaning) ++count;
#include "softcell/ls_sim/timing_parameters.def"
#undef SC_TIMING_PARAMETER
                       return count;
                     }()>
    kParameters{{
#define SC_TIMING_PARAMETER(name, value, unit, confidence, source, meaning) \
  {#name, value, unit, confidence, source, meaning},
#include "softcell/ls_sim/timing_parameters.def"
#undef SC_TIMING_PARAMETER
    }};

struct StallName {
  std::string_view text, json;
};
constexpr std::array<StallName, kStalls> kStallNames{{{"dependency", "dependency"},
                                                      {"branch miss", "branch_miss"},
                                                      {"hint target", "hint_target"},
                                                      {"fetch", "fetch"},
                                                      {"float unit", "float_unit"},
                                                      {"double precision", "double_precision"},
                                                      {"local store port", "local_store_port"},
                                                      {"sync", "sync"},
                                                      {"tag wait", "tag_wait"},
                                                      {"DMA queue", "dma_queue"},
                                                      {"other channel", "other_channel"}}};

const StallName& names_of(Stall stall) {
  const auto index = static_cast<std::size_t>(stall);
  SC_ASSERT(index < kStallNames.size(), "stall {}", index);
  return kStallNames[index];
}

}  // namespace

std::span<const TimingParameterInfo> timing_parameters() { return kParameters; }

std::string_view name(Stall stall) { return names_of(stall).text; }
std::string_view json_name(Stall stall) { return names_of(stall).json; }

std::uint64_t CycleCounts::stalled() const {
  std::uint64_t sum = 0;
  for (const std::uint64_t each : stalls) sum += each;
  return sum;
}

double CycleCounts::cycles_per_instruction() const {
  return instructions == 0 ? 0.0 : static_cast<double>(cycles) / static_cast<double>(instructions);
}

double CycleCounts::dual_issue_share() const {
  const std::uint64_t issuing = instructions - pairs;
  return issuing == 0 ? 0.0 : static_cast<double>(pairs) / static_cast<double>(issuing);
}

CycleCounts& CycleCounts::operator+=(const CycleCounts& other) {
  instructions += other.instructions;
  cycles += other.cycles;
  pairs += other.pairs;
  for (std::size_t i = 0; i < kStalls; ++i) stalls[i] += other.stalls[i];
  return *this;
}

CycleCounts& CycleCounts::operator-=(const CycleCounts& other) {
  SC_ASSERT(instructions >= other.instructions && cycles >= other.cycles,
            "{} instructions in {} cycles are taken from {} in {}", other.instructions, other.cycles,
            instructions, cycles);
  instructions -= other.instructions;
  cycles -= other.cycles;
  pairs -= other.pairs;
  for (std::size_t i = 0; i < kStalls; ++i) stalls[i] -= other.stalls[i];
  return *this;
}

Timing::Timing(int spes, const TimingParameters& parameters)
    : parameters_(parameters), interconnect_(std::make_unique<ElementInterconnect>(parameters_)) {
  SC_ASSERT(spes > 0 && spes <= dma::kSpeCount, "the timing of {} SPEs", spes);
  for (int spe = 0; spe < spes; ++spe)
    timers_.push_back(std::make_unique<SpeTimer>(spe, *interconnect_, parameters_));
}

Timing::~Timing() = default;

int Timing::spes() const { return static_cast<int>(timers_.size()); }

SpeTimer& Timing::timer(int spe) {
  SC_ASSERT(spe >= 0 && spe < spes(), "SPE {} of {}", spe, spes());
  return *timers_[static_cast<std::size_t>(spe)];
}

CycleCounts Timing::total(int spe) const {
  SC_ASSERT(spe >= 0 && spe < spes(), "SPE {} of {}", spe, spes());
  CycleCounts sum = timers_[static_cast<std::size_t>(spe)]->native;
  timers_[static_cast<std::size_t>(spe)]->program.for_each(
      [&](std::uint32_t, const CycleCounts& counts) { sum += counts; });
  return sum;
}

PipelineCounts Timing::pipeline(int spe) const {
  SC_ASSERT(spe >= 0 && spe < spes(), "SPE {} of {}", spe, spes());
  return timers_[static_cast<std::size_t>(spe)]->pipeline;
}

TransferCounts Timing::transfers(int spe) const {
  SC_ASSERT(spe >= 0 && spe < spes(), "SPE {} of {}", spe, spes());
  const SpeTimer& timer = *timers_[static_cast<std::size_t>(spe)];
  TransferCounts counts = timer.mfc.counts();
  counts.tag_waits = timer.tag_waits;
  counts.queue_waits = timer.queue_waits;
  counts.other_waits = timer.other_waits;
  return counts;
}

std::uint64_t Timing::now(int spe) const {
  SC_ASSERT(spe >= 0 && spe < spes(), "SPE {} of {}", spe, spes());
  return timers_[static_cast<std::size_t>(spe)]->clock.now();
}

std::uint64_t Timing::now() const {
  std::uint64_t latest = 0;
  for (const auto& timer : timers_) latest = std::max(latest, timer->clock.now());
  return latest;
}

std::vector<KernelCycles> Timing::by_kernel() const {
  std::map<std::string, KernelCycles> sums;
  for (const auto& timer : timers_) {
    for (const KernelCycles& each : timer->jobs.kernels()) {
      KernelCycles& sum = sums[each.kernel];
      sum.kernel = each.kernel;
      sum.jobs += each.jobs;
      sum.cycles += each.cycles;
      sum.waits += each.waits;
    }
  }
  std::vector<KernelCycles> kernels;
  for (const auto& [name, sum] : sums) kernels.push_back(sum);
  return kernels;
}

CycleCounts Timing::at(int spe, dma::LocalStoreAddress instruction) const {
  SC_ASSERT(spe >= 0 && spe < spes(), "SPE {} of {}", spe, spes());
  return timers_[static_cast<std::size_t>(spe)]->program.read(instruction.value & dma::kLocalStoreMask);
}

std::vector<FunctionCycles> Timing::by_function(int spe, const KernelImage& image) const {
  SC_ASSERT(spe >= 0 && spe < spes(), "SPE {} of {}", spe, spes());
  std::map<std::uint32_t, FunctionCycles> found;  // by where the function begins
  timers_[static_cast<std::size_t>(spe)]->program.for_each([&](std::uint32_t pc, const CycleCounts& counts) {
    const auto behind =
        std::ranges::upper_bound(image.functions, dma::LocalStoreAddress{pc}, {}, &ImageObject::begin);
    const bool is_named = behind != image.functions.begin() && pc >= image.text_begin && pc < image.text_end;
    const ImageObject* const function = is_named ? &*(behind - 1) : nullptr;
    FunctionCycles& of = found[function == nullptr ? dma::kLocalStoreBytes : function->begin.value];
    if (of.counts.instructions == 0) {
      of.name = function == nullptr ? "" : function->name;
      of.begin = function == nullptr ? dma::LocalStoreAddress{pc} : function->begin;
    }
    of.counts += counts;
  });
  std::vector<FunctionCycles> functions;
  functions.reserve(found.size());
  for (auto& [begin, function] : found) functions.push_back(std::move(function));
  std::ranges::stable_sort(functions, std::greater<>(),
                           [](const FunctionCycles& function) { return function.counts.cycles; });
  return functions;
}

}  // namespace softcell::ls_sim
