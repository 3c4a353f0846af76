#pragma once

// The state of an SPU, and one step of the model: a slow model of the instruction set, written from the
// architecture's definitions and from nothing of softcell's. It says what the interpreter must do.

#include <array>
#include <cstdint>
#include <vector>

#include "spu_model/quadword.h"

namespace softcell::spu_model {

constexpr std::uint32_t kLocalStoreLimit = 0x3FFFF;  // LSLR [SPU-ISA, 2] documented

/// How an access to a channel ended.
enum class ChannelAnswer { kDone, kStalls, kInvalid };

/// What lies behind rdch, wrch and rchcnt. A machine without one answers each access as invalid.
class ChannelPort {
 public:
  virtual ~ChannelPort() = default;
  virtual ChannelAnswer read(unsigned int channel, std::uint32_t& value) = 0;
  virtual ChannelAnswer write(unsigned int channel, std::uint32_t value) = 0;
  virtual ChannelAnswer count(unsigned int channel, std::uint32_t& count) = 0;
  /// The count of SPU_RdEventStat, which bisled and interrupts look at.
  virtual std::uint32_t event_count() = 0;
};

struct Machine {
  std::array<Quadword, 128> registers{};
  std::uint32_t pc = 0;    // of the next instruction; a multiple of 4 within the local store
  std::uint32_t srr0 = 0;  // where iret returns to
  bool interrupts_enabled = false;
  Quadword fpscr{};
  std::vector<std::uint8_t> local_store = std::vector<std::uint8_t>(kLocalStoreLimit + 1);
  /// Whether dfceq, dfcmeq, dfcgt, dfcmgt and dftsv exist: on a PowerXCell 8i only.
  bool enhanced_double = false;
  ChannelPort* channels = nullptr;

  /// The quadword that contains `address`, which wraps at the end of the local store.
  Quadword load(std::uint32_t address) const;
  void store(std::uint32_t address, const Quadword& value);
  /// The word at `address`, as instructions are fetched.
  std::uint32_t fetch(std::uint32_t address) const;
  void place(std::uint32_t address, std::uint32_t instruction);
};

/// What ended with an instruction.
enum class Outcome {
  kNext,                // goes on at Machine::pc
  kStop,                // stop, stopd: Machine::pc is that of the instruction behind it
  kHalt,                // a condition of heq, hgt, ...: as stop
  kInvalidInstruction,  // no opcode: nothing changed
  kInvalidChannel,      // nothing changed
  kChannelStall,        // nothing changed; the instruction is to be tried again
};

struct StepResult {
  Outcome outcome = Outcome::kNext;
  std::uint32_t stop_code = 0;  // of kStop, 14 bits

  friend bool operator==(const StepResult&, const StepResult&) = default;
};

/// Executes the instruction at Machine::pc, after an interrupt that is due. [SPU-ISA, 12]
StepResult step(Machine& machine);
/// Executes `word` as if it lay at Machine::pc.
StepResult execute(Machine& machine, std::uint32_t word);

}  // namespace softcell::spu_model
