// The costs of an SPE itself: transfers, compared with memcpy of the same bytes, commands, and dispatch of jobs.

#include <array>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "benchmarks.h"
#include "kernel_runs/kernel_file.h"
#include "softcell/base/assert.h"
#include "softcell/dma/buffer.h"
#include "softcell/jobs/job_system.h"
#include "transfers_job.h"

namespace softcell::tool {
namespace {

constexpr std::size_t kBlockBytes = 16384;
constexpr std::size_t kBlocks = 2048;    // commands in one job, so that its dispatch is negligible
constexpr std::size_t kCommands = 8192;  // in one job, of 16 bytes
constexpr std::uint32_t kBlocksInFlight = 2, kCommandsInFlight = 8;
constexpr std::size_t kQueuedJobs = 1000;

/// SPEs that run the kernel `transfers`.
class TransfersRig {
 public:
  explicit TransfersRig(dma::Schedule schedule = {}, int spes = 1)
      : kernel_(load_kernel("transfers")),
        job_loop_(load_kernel("job_loop")),
        jobs_(memory_, {.spes = spes, .schedule = schedule}, job_loop_),
        image_(jobs_.load(kernel_)),
        chain_(jobs_, "benchmark", kQueuedJobs),
        descriptor_(memory_, "transfers job", 1),
        data_(memory_, "transfers data", spu::kTransfersBufferBytes) {}

  void move(spu::TransferDirection direction, std::size_t bytes, std::size_t count, std::uint32_t in_flight) {
    SC_ASSERT(count > 0 && bytes * in_flight <= spu::kTransfersBufferBytes,
              "{} transfers of {} bytes, {} at a time", count, bytes, in_flight);
    descriptor_.span()[0] = {.ea = data_.ea().value,
                             .bytes = static_cast<std::uint32_t>(bytes),
                             .count = static_cast<std::uint32_t>(count),
                             .in_flight = in_flight,
                             .direction = direction,
                             .pad = {}};
    run_jobs(1, descriptor_.ea());
  }

  /// Runs jobs that return at once, in one stage.
  void run_empty_jobs(std::size_t count) { run_jobs(count, {}); }

 private:
  void run_jobs(std::size_t count, dma::EffectiveAddress argp) {
    chain_.clear();
    SC_ASSERT(count > 0 && count <= kQueuedJobs, "{} jobs in a chain of {}", count, kQueuedJobs);
    for (std::size_t i = 0; i < count; ++i) chain_.add({image_, argp});
    chain_.kick();
    chain_.wait();
    if (!chain_.failures().empty()) throw std::runtime_error(chain_.failures().front().message);
  }

  dma::AddressSpace memory_;
  ls_sim::KernelImage kernel_, job_loop_;
  ppu::JobSystem jobs_;
  ppu::JobImage image_;
  ppu::JobChain chain_;
  dma::Buffer<spu::TransfersJob> descriptor_;
  dma::Buffer<std::byte> data_;
};

/// Copies the same blocks by memcpy between the same kinds of memory: two blocks to two others.
class Memcpy {
 public:
  void run() {
    for (std::size_t i = 0; i < kBlocks; ++i) {
      const std::size_t offset = i % kBlocksInFlight * kBlockBytes;
      std::memcpy(to_->data() + offset, from_->data() + offset, kBlockBytes);
      asm volatile("" ::"r"(to_->data()) : "memory");  // keeps the compiler from leaving out any copy
    }
  }

 private:
  /// Aligned as DMA requires: memcpy of 16 KB takes 105 to 185 ns, depending on the low bits of both addresses.
  struct alignas(128) Blocks : std::array<std::byte, kBlocksInFlight * kBlockBytes> {};
  std::unique_ptr<Blocks> from_ = std::make_unique<Blocks>(), to_ = std::make_unique<Blocks>();
};

/// A benchmark of a rig that is made when it is needed, and may be shared.
template <typename Rig, typename Run>
Benchmark on(const Shared<Rig>& shared, std::string name, std::size_t items, Run run) {
  return {std::move(name), [=] { return Work{items, [rig = shared.get(), run] { run(*rig); }}; }};
}

/// The same on SPEs that are awake.
template <typename Run>
Benchmark on_awake(const Shared<TransfersRig>& shared, std::string name, std::size_t items, Run run) {
  return {std::move(name), [=] {
            const auto rig = shared.get();
            return Work{.items = items, .run = [=] { run(*rig); }, .before = [=] { rig->run_empty_jobs(1); }};
          }};
}

}  // namespace

void add_dma_benchmarks(std::vector<Benchmark>& all) {
  const Shared<TransfersRig> eager([] { return std::make_shared<TransfersRig>(); });
  const Shared<TransfersRig> lazy(
      [] { return std::make_shared<TransfersRig>(dma::Schedule{dma::Schedule::kLazy}); });
  const Shared<Memcpy> by_memcpy([] { return std::make_shared<Memcpy>(); });
  const auto blocks = [](spu::TransferDirection direction) {
    return [=](TransfersRig& rig) { rig.move(direction, kBlockBytes, kBlocks, kBlocksInFlight); };
  };
  const auto commands = [](TransfersRig& rig) {
    rig.move(spu::kTransferGet, 16, kCommands, kCommandsInFlight);
  };
  all.push_back(on(by_memcpy, "dma/memcpy16k", kBlocks, [](Memcpy& rig) { rig.run(); }));
  all.push_back(on_awake(eager, "dma/get16k", kBlocks, blocks(spu::kTransferGet)));
  all.push_back(on_awake(eager, "dma/put16k", kBlocks, blocks(spu::kTransferPut)));
  all.push_back(on_awake(eager, "dma/command/eager", kCommands, commands));
  all.push_back(on_awake(lazy, "dma/command/lazy", kCommands, commands));
}

void add_dispatch_benchmarks(std::vector<Benchmark>& all) {
  const Shared<TransfersRig> one([] { return std::make_shared<TransfersRig>(); });
  const Shared<TransfersRig> six(
      [] { return std::make_shared<TransfersRig>(dma::Schedule{}, dma::kSpeCount); });
  const auto many = [](TransfersRig& rig) { rig.run_empty_jobs(kQueuedJobs); };
  const auto single = [](TransfersRig& rig) { rig.run_empty_jobs(1); };
  all.push_back(on_awake(one, "dispatch/queued", kQueuedJobs, many));
  all.push_back(on(one, "dispatch/round_trip", 1, single));
  all.push_back(on(six, "dispatch/round_trip_6_spes", 1, single));
}

}  // namespace softcell::tool
