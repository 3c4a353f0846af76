#pragma once
// What runs a kernel's instructions. The native engine runs host images; others may follow.

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>

#include "softcell/dma/fault.h"
#include "softcell/ls_sim/channels.h"
#include "softcell/ls_sim/image.h"
#include "softcell/ls_sim/local_store.h"

namespace softcell::ls_sim {

/// The three 64-bit arguments of a kernel's main. [SPU ABI, libspe2]
struct EntryArguments {
  std::uint64_t spe_id = 0;
  std::uint64_t argp = 0;
  std::uint64_t envp = 0;
};

/// How a run ended: by main's return (or spu_stop) with a stop code, or by a fault.
struct RunResult {
  std::uint32_t stop_code = 0;  ///< 0x2000 + status for a normal end; 0..0x3FFF
  std::optional<dma::Fault> fault;
  dma::EffectiveAddress job = {};  ///< which job was under way when a kernel that runs many ended

  static constexpr std::uint32_t kNormalEnd = 0x2000;  // [libspe2, newlib] documented
  bool ended_normally() const { return !fault && (stop_code & ~0xFFu) == kNormalEnd; }
  std::uint32_t status() const { return stop_code & 0xFFu; }
};

/// One load or store of a checked kernel.
struct Access {
  dma::LocalStoreAddress lsa;  ///< first byte
  std::uint32_t bytes = 0;
  bool is_store = false;
  dma::LocalStoreAddress instruction;    ///< its place in the code
  dma::LocalStoreAddress stack_pointer;  ///< at that moment
};

/// Sees every load and store that the compiler of a checked kernel reports, before it happens. Called by the
/// thread that runs the SPE.
class AccessObserver {
 public:
  virtual ~AccessObserver() = default;
  virtual void on_access(const Access& access) = 0;
};

/// Sees where jobs begin and end inside a kernel that runs many. Called by the thread that runs the SPE.
class JobObserver {
 public:
  virtual ~JobObserver() = default;

  /// @param image  where the job's image lies in main storage. @param job  what tells it from others.
  /// @return  the image; null when nobody knows it.
  virtual const KernelImage* on_job_begin(dma::EffectiveAddress image, dma::EffectiveAddress job) = 0;

  /// The main of the job that began last has returned: completes what the job has in flight. @return  a fault
  /// of that.
  virtual std::optional<dma::Fault> on_job_returned() = 0;

  /// The job has ended well, and its caller goes on. After a fault it is not called: the run ends.
  virtual void on_job_end() = 0;
};

/// One engine belongs to one SPE and is called by that SPE's thread, except for interrupt().
class Engine {
 public:
  virtual ~Engine() = default;

  /// Makes the image resident, replacing what was there. Text, data and bss are as linked, the rest is
  /// filler.
  virtual void load(const KernelImage& image) = 0;

  /// Runs the resident image once. The initialised data are as linked; bss is as the last run left it.
  /// @param accesses  told of loads and stores of a checked image; may be null.
  /// @param jobs      told of jobs inside the run; may be null.
  /// @throws  what a channel or an observer has thrown, once the run has ended.
  virtual RunResult run(const EntryArguments& arguments, ChannelPort& channels,
                        AccessObserver* accesses = nullptr, JobObserver* jobs = nullptr) = 0;

  /// Where the kernel is: an address within its last call of a channel, or the instruction that faulted;
  /// during a channel operation the one that waits for it.
  virtual dma::LocalStoreAddress position() const = 0;

  /// The kernel's stack pointer at its last call of a channel, less what that call itself has put on the
  /// stack.
  virtual dma::LocalStoreAddress stack_pointer() const = 0;

  /// Stops the run in progress, if there is one, with the fault deadline-exceeded. Any thread.
  virtual void interrupt() = 0;

  /// Most stack in bytes that any run since load() used, found by what is left of the filler.
  virtual std::uint32_t stack_high_water() const = 0;
};

/// The engine for images made by softcell_add_spu_kernel for this host.
/// @throws std::runtime_error  when the processor lacks AVX2 or FMA.
std::unique_ptr<Engine> make_native_engine(LocalStore& local_store);

/// @throws std::runtime_error  one sentence, when one of the two is false: the native engine needs both.
void require_vector_units(bool avx2, bool fma);

}  // namespace softcell::ls_sim
