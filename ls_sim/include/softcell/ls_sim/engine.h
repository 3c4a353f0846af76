#pragma once
// Engines execute the instructions of a kernel: the native engine those of the host, the interpreter those of the SPU.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "softcell/dma/addresses.h"
#include "softcell/dma/fault.h"
#include "softcell/ls_sim/channels.h"
#include "softcell/ls_sim/image.h"
#include "softcell/ls_sim/local_store.h"

namespace softcell::ls_sim {

class Debugger;
struct HostCalls;
class SpeTimer;

/// The system that starts an SPU program, which determines the first contents of its registers. Each argument is in bytes 0 to 7 of its
/// register.
enum class EntryState : std::uint8_t {
  /// $3 to $5 are the arguments, $6 the effective address of the SPE's local store, $1 a stack. [libspe2] second-hand
  kLibspe2,
  /// $3 to $6 are the arguments, $1 is 0x3FFF0 in its preferred word, all others are zero. [lv2] second-hand
  kThreadGroup,
};

/// The 64-bit arguments of a kernel's main. libspe2 passes three with the meanings below. lv2's thread groups pass four numbers whose
/// meaning is up to the program. [SPU ABI, libspe2; PSL1GHT, sys/spu.h]
struct EntryArguments {
  std::uint64_t spe_id = 0;
  std::uint64_t argp = 0;
  std::uint64_t envp = 0;
  std::uint64_t fourth = 0;                       ///< only for programs that thread groups start
  EntryState entry_state = EntryState::kLibspe2;  ///< only for SPU programs
  /// The words of three registers, for a native kernel whose main takes vectors; nothing: they begin with the three numbers.
  std::optional<std::array<std::uint32_t, 12>> registers = {};
  /// Whether static data begin the run as they were linked. SPE contexts leave the local store as it is: an image is loaded once.
  bool data_as_linked = true;
};

/// The result of a run, which ends by main's return (or spu_stop) with a stop code, or by a fault.
struct RunResult {
  std::uint32_t stop_code = 0;  ///< 0x2000 + status for a normal end; 0..0x3FFF
  std::optional<dma::Fault> fault;
  dma::EffectiveAddress job = {};  ///< the job in progress when a resident kernel ended
  /// After a fault of an SPU program: its last instructions, at most 32, the latest last.
  std::vector<std::string> last_instructions = {};

  static constexpr std::uint32_t kNormalEnd = 0x2000;  // [libspe2, newlib] documented
  bool ended_normally() const { return !fault && (stop_code & ~0xFFu) == kNormalEnd; }
  std::uint32_t status() const { return stop_code & 0xFFu; }
};

/// Marks the undefined bits of a quadword: a bit is set if nobody has written that bit. Bytes are in the order of the local store.
using UndefinedBits = std::array<std::uint8_t, 16>;

/// One load or store of a checked kernel.
struct Access {
  dma::LocalStoreAddress lsa;  ///< first byte
  std::uint32_t bytes = 0;
  bool is_store = false;
  dma::LocalStoreAddress instruction;    ///< local-store address of the load or store
  dma::LocalStoreAddress stack_pointer;  ///< at that moment
  UndefinedBits undefined{};             ///< the undefined bits that a program for the SPU stores
};

/// A quadword that a program has loaded.
struct LoadedFrom {
  dma::LocalStoreAddress lsa, instruction;
};

/// A use of undefined bits: of a register or bytes of the local store that nobody has written.
struct UndefinedUse {
  enum class Kind : std::uint8_t {
    kAddress,    ///< of a load or store
    kCondition,  ///< of a branch
    kTarget,     ///< of a branch
    kHalt,       ///< the condition of a halt
    kChannel,    ///< the value that is written to a channel
  };
  Kind kind = Kind::kAddress;
  int reg = 0;                     ///< the number of the register with the undefined bits
  std::optional<LoadedFrom> from;  ///< where they were loaded from; none: the register was never written
};

/// One instruction of a checked program for the SPU.
struct ExecutedInstruction {
  dma::LocalStoreAddress address;
  dma::LocalStoreAddress stack_pointer;        ///< before it
  std::optional<UndefinedUse> undefined = {};  ///< its use of undefined bits, if it makes one
};

/// Observes every load and store of a checked kernel, before it happens. A program for the SPU loads and stores whole
/// quadwords. Called by the thread that runs the SPE.
class AccessObserver {
 public:
  virtual ~AccessObserver() = default;
  virtual void on_access(const Access& access) = 0;
  /// The host reads or writes this range in a call that it serves, such as one of the C library's printf().
  virtual void on_host_access(dma::LocalStoreAddress, [[maybe_unused]] std::uint32_t bytes,
                              [[maybe_unused]] bool is_store) {}

  /// The C library has allocated a block of its heap for the program or, with `is_freed`, is about to free one. `block.bytes` is the size
  /// that the program asked for, `block.instruction` the call.
  virtual void on_heap_block([[maybe_unused]] const Access& block, [[maybe_unused]] bool is_freed) {}

  // Only for programs for the SPU:

  /// Called before each instruction.
  virtual void on_instruction(const ExecutedInstruction&) {}
  /// The undefined bits of the quadword at this address.
  virtual UndefinedBits undefined_bits(dma::LocalStoreAddress) { return {}; }
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

  /// Runs the loaded image once. Initialised data are as linked; bss is as the last run left it, and zero for a
  /// program.
  /// @pre  load() was called
  /// @param accesses  called for loads and stores of a checked image; may be null.
  /// @param jobs      called for jobs inside the run; may be null.
  /// @throws  whatever a channel or an observer has thrown, after the run has ended.
  virtual RunResult run(const EntryArguments& arguments, ChannelPort& channels,
                        AccessObserver* accesses = nullptr, JobObserver* jobs = nullptr) = 0;

  /// The kernel's position: an address within its last channel operation, or the instruction that faulted.
  virtual dma::LocalStoreAddress position() const = 0;

  /// The kernel's stack pointer before its last channel operation.
  virtual dma::LocalStoreAddress stack_pointer() const = 0;

  /// Stops the run in progress, if there is one: it ends with the fault deadline-exceeded. Any thread.
  virtual void interrupt() = 0;

  /// The most stack, in bytes, that any run since load() used: the part that no longer has the fill pattern.
  virtual std::uint32_t stack_high_water() const = 0;

  /// SPU instructions executed since the engine was made. 0 if it does not count them; the native one does not.
  virtual std::uint64_t instructions() const { return 0; }
};

/// Options of a native engine. All objects that it points to must outlive the engine.
struct NativeOptions {
  Debugger* debugger = nullptr;  ///< its on_instruction() is called before each instruction; may be null
  int spe = 0;                   ///< the SPE's number, for the debugger
  /// The size of main memory: faults of kernels that follow an effective address as a pointer say so for addresses in it.
  std::uint64_t main_memory_bytes = dma::kMainMemoryBytes;
};

/// Makes the engine for images that softcell_add_spu_kernel has built for this host.
/// @throws std::runtime_error  the processor lacks AVX2 or FMA.
std::unique_ptr<Engine> make_native_engine(LocalStore& local_store, const NativeOptions& options = {});

/// Options of an interpreter. All objects that it points to must outlive the engine.
struct InterpreterOptions {
  const HostCalls* host_calls = nullptr;  ///< the calls that the host serves for programs; null: none
  SpeTimer* timer = nullptr;              ///< times the instructions; null: they are not timed
  /// Its on_instruction() is called before each instruction, and nothing is timed; may be null.
  Debugger* debugger = nullptr;
  int spe = 0;  ///< the SPE's number, for the debugger
};

/// Makes the engine for programs built for the SPU (load_spu_program()).
/// @param local_store_ea  of this SPE; programs started by libspe2 get it.
/// @throws std::runtime_error  the processor lacks AVX2 or FMA.
std::unique_ptr<Engine> make_interpreter_engine(LocalStore& local_store, dma::EffectiveAddress local_store_ea,
                                                const InterpreterOptions& options = {});

/// @throws std::runtime_error  one of the two is false: both engines need both.
void require_vector_units(bool avx2, bool fma);

}  // namespace softcell::ls_sim
