#include "kernel_samples.h"

#include <algorithm>
#include <stdexcept>

#include "job_chain.h"
#include "rotations_job.h"
#include "softcell/dma/buffer.h"
#include "transfers_job.h"

namespace softcell::tool {
namespace {

// The widths of the numbers in the contracts, for kernels built for the SPU.
constexpr dma::BufferOptions kFloats{.element_bytes = sizeof(float)};
constexpr dma::ElementRun kRotationsJobRecord[] = {{24, 8}, {104, 4}};
constexpr dma::ElementRun kTransfersJobRecord[] = {{8, 8}, {120, 4}};
constexpr dma::ElementRun kJobBoardRecord[] = {{4, 4}, {4, 2}, {120, 8}};

/// Rotations that are far off, and one that must be found from nothing: the deepest paths.
void run_rotations(SampleRun& sample) {
  dma::Buffer<spu::RotationMatrices> matrices(sample.memory(), "matrices", 1, kFloats);
  dma::Buffer<spu::MatchRotations> starts(sample.memory(), "starts", 1, kFloats);
  const dma::Buffer<spu::MatchRotations> found(sample.memory(), "found", 1, kFloats);
  for (std::size_t lane = 0; lane < 4; ++lane) {
    for (std::size_t diagonal : {0, 4, 8}) matrices[0].element[diagonal][lane] = lane == 0 ? 1.0f : -1.0f;
    starts[0].w[lane] = 1;
  }
  dma::Buffer<spu::RotationsJob> job(sample.memory(), "job", 1, {.record = kRotationsJobRecord});
  job[0] = {matrices.ea().value, starts.ea().value, found.ea().value, 1, 1, 0, 6, {}};
  sample.run(job.ea(), 4);
}

void run_transfers(SampleRun& sample) {
  const dma::Buffer<std::byte> data(sample.memory(), "data", 1024);
  dma::Buffer<spu::TransfersJob> job(sample.memory(), "job", 1, {.record = kTransfersJobRecord});
  job[0] = {data.ea().value, 128, 16, 8, spu::kTransferGet, {}};
  sample.run(job.ea(), 16);
}

/// A board that tells the loop to end at once: this measures all of it, because the compiler makes it one function with one frame.
void run_job_loop(SampleRun& sample) {
  dma::Buffer<spu::JobBoard> board(sample.memory(), "board", 1, {.record = kJobBoardRecord});
  board[0].stop = 1;
  sample.run(board.ea());
}

}  // namespace

ls_sim::SpeOptions SampleRun::options() {
  ls_sim::SpeOptions options{.spes = 1, .measure_stack = true};
  if (kernel_.machine == ls_sim::Machine::kSpu) ls_sim::time_by(&timing_, options);
  return options;
}

void SampleRun::begin_timing() {
  begin_ = timing_.now();
  before_ = timing_.by_function(0, kernel_);
  pieces_ = 0;
}

std::vector<ls_sim::FunctionCycles> SampleRun::functions() const {
  if (kernel_.machine != ls_sim::Machine::kSpu) return {};
  std::vector<ls_sim::FunctionCycles> functions = timing_.by_function(0, kernel_);
  for (ls_sim::FunctionCycles& function : functions) {
    const auto before = std::ranges::find(
        before_, function.begin.value, [](const ls_sim::FunctionCycles& each) { return each.begin.value; });
    if (before != before_.end()) function.counts -= before->counts;
  }
  std::erase_if(functions, [](const ls_sim::FunctionCycles& each) { return each.counts.cycles == 0; });
  std::ranges::stable_sort(functions, std::ranges::greater{},
                           [](const ls_sim::FunctionCycles& each) { return each.counts.cycles; });
  return functions;
}

std::optional<double> SampleRun::cycles_a_piece() const {
  if (kernel_.machine != ls_sim::Machine::kSpu || pieces_ == 0) return {};
  return static_cast<double>(timing_.now() - begin_) / static_cast<double>(pieces_);
}

void SampleRun::run(dma::EffectiveAddress argp, std::size_t pieces) {
  spes_.start(0, kernel_, {.spe_id = 0, .argp = argp.value, .envp = 0});
  const ls_sim::RunResult result = spes_.wait(0);
  if (result.fault) throw std::runtime_error(result.fault->message());
  if (result.status() != 0) throw std::runtime_error("kernel " + kernel_.name + " refused its sample");
  pieces_ += pieces;
}

std::span<const KernelSample> plain_samples() {
  static constexpr KernelSample kSamples[] = {{"job_loop", "run without jobs", run_job_loop},
                                              {"rotations", "matrix", run_rotations},
                                              {"transfers", "transfer", run_transfers}};
  return kSamples;
}

std::optional<SampleNeeds> measure(const ls_sim::KernelImage& kernel, std::span<const KernelSample> samples) {
  const auto found = std::ranges::find(samples, kernel.name, &KernelSample::kernel);
  if (found == samples.end()) return std::nullopt;
  SampleRun sample(kernel);
  found->run(sample);
  return SampleNeeds{sample.stack_used(), sample.cycles_a_piece(), found->piece, sample.pieces(),
                     sample.functions()};
}

}  // namespace softcell::tool
