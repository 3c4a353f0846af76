#pragma once
// Engines run the instructions of a kernel. The native engine runs images built for the host.

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

/// The result of a run, which ends by main's return (or spu_stop) with a stop code, or by a fault.
struct RunResult {
  std::uint32_t stop_code = 0;  ///< 0x2000 + status for a normal end; 0..0x3FFF
  std::optional<dma::Fault> fault;
  dma::EffectiveAddress job = {};  ///< the job in progress when a resident kernel ended

  static constexpr std::uint32_t kNormalEnd = 0x2000;  // [libspe2, newlib] documented
  bool ended_normally() const { return !fault && (stop_code & ~0xFFu) == kNormalEnd; }
  std::uint32_t status() const { return stop_code & 0xFFu; }
};

/// One load or store of a checked kernel.
struct Access {
  dma::LocalStoreAddress lsa;  ///< first byte
  std::uint32_t bytes = 0;
  bool is_store = false;
  dma::LocalStoreAddress instruction;    ///< local-store address of the load or store
  dma::LocalStoreAddress stack_pointer;  ///< at that moment
};

/// Observes every load and store of a checked kernel, before it happens. Called by the thread that runs the
/// SPE.
class AccessObserver {
 public:
  virtual ~AccessObserver() = default;
  virtual void on_access(const Access& access) = 0;
};

/// Observes where jobs begin and end inside a resident kernel. Called by the thread that runs the SPE.
class JobObserver {
 public:
  virtual ~JobObserver() = default;

  /// @param image  effective address of the job's image.
  /// @param job  effective address that identifies the job.
  /// @return  the image, or null if none was registered at that address.
  virtual const KernelImage* on_job_begin(dma::EffectiveAddress image, dma::EffectiveAddress job) = 0;

  /// The main of the current job has returned. Completes the job's commands in flight.
  /// @return  a fault of these commands, if there is one.
  virtual std::optional<dma::Fault> on_job_returned() = 0;

  /// The job has ended without a fault, and its caller goes on. Not called after a fault, which ends the run.
  virtual void on_job_end() = 0;
};

/// One engine belongs to one SPE. Only that SPE's thread calls it, except for interrupt().
class Engine {
 public:
  virtual ~Engine() = default;

  /// Loads an image in place of the last. Text, data and bss are as linked; the rest of the local store is
  /// filled with a pattern. The image must outlive its runs.
  /// @pre  no run is in progress
  virtual void load(const KernelImage& image) = 0;

  /// Runs the loaded image once. Initialised data are as linked; bss is as the last run left it.
  /// @pre  load() was called
  /// @param accesses  called for loads and stores of a checked image; may be null.
  /// @param jobs      called for jobs inside the run; may be null.
  /// @throws  whatever a channel or an observer has thrown, after the run has ended.
  virtual RunResult run(const EntryArguments& arguments, ChannelPort& channels,
                        AccessObserver* accesses = nullptr, JobObserver* jobs = nullptr) = 0;

  /// Where the kernel is: an address within its last channel operation, or the instruction that faulted.
  virtual dma::LocalStoreAddress position() const = 0;

  /// The kernel's stack pointer before its last channel operation.
  virtual dma::LocalStoreAddress stack_pointer() const = 0;

  /// Stops the run in progress, if there is one: it ends with the fault deadline-exceeded. Any thread.
  virtual void interrupt() = 0;

  /// The most stack, in bytes, that any run since load() used: the part that no longer has the fill pattern.
  virtual std::uint32_t stack_high_water() const = 0;
};

/// Makes the engine for images that softcell_add_spu_kernel has built for this host.
/// @throws std::runtime_error  the processor lacks AVX2 or FMA.
std::unique_ptr<Engine> make_native_engine(LocalStore& local_store);

/// @throws std::runtime_error  one of the two is false: the native engine needs both.
void require_vector_units(bool avx2, bool fma);

}  // namespace softcell::ls_sim
