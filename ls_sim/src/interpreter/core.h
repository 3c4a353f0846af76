#pragma once
// One instruction performed: the switch over all of them, made from the table.

#include <cstddef>

#include "control_semantics.h"
#include "double_semantics.h"
#include "instruction_set.h"
#include "integer_semantics.h"
#include "shift_semantics.h"
#include "shuffle_semantics.h"
#include "single_semantics.h"
#include "softcell/base/sanitizers.h"
#include "spu_state.h"

namespace softcell::ls_sim::interpreter {

/// How execution goes on after an instruction.
enum class Flow : std::uint8_t {
  kNext,  ///< with the next word
  kJump,  ///< at another place, which the program counter has
  kEnd,   ///< not at all; Core::ending says why
};

/// What channel instructions and syncs reach. Called in the floating-point mode of the SPU: an implementation that
/// calls other code restores that of the host meanwhile.
class Surroundings {
 public:
  virtual ~Surroundings() = default;
  /// @param value  receives what was read. @return  false when the run ends.
  virtual bool read_channel(std::uint32_t channel, std::uint32_t& value) = 0;
  virtual bool count_channel(std::uint32_t channel, std::uint32_t& value) = 0;
  virtual bool write_channel(std::uint32_t channel, std::uint32_t value) = 0;
  virtual void sync() = 0;
};

/// An observer that moves the SPE's clock, which it brings up to date on request.
template <class Observer>
concept HasClock = requires(Observer& observer) {
  observer.bring_clock();
};

/// Hears nothing, and costs nothing. An observer has these functions; each is called before the instruction
/// changes anything.
struct NoObserver {
  void on_instruction(const Operation&, std::uint32_t) {}
  void on_load(std::uint32_t, std::uint32_t) {}
  void on_store(std::uint32_t, std::uint32_t) {}
};

/// An SPU in the middle of its work.
struct Core {
  SpuState& state;
  std::byte* local_store;
  Surroundings& surroundings;
  Ending ending = Ending::kNone;
  std::uint32_t stop_code = 0;
  std::uint32_t last_pc = 0;  ///< of the instruction that was executed last

  [[gnu::always_inline]] In operands(const Operation& op) const {
    return {state.registers[op.ra], state.registers[op.rb], state.registers[op.rc], state.registers[op.rt],
            op.imm};
  }
  Flow set(const Operation& op, Quadword value) {
    state.registers[op.rt] = value;
    return Flow::kNext;
  }
  Flow end(Ending why, std::uint32_t code = 0) {
    ending = why;
    stop_code = code;
    return Flow::kEnd;
  }
};

/// Performs one instruction.
/// @param pc  its local-store address; a taken jump and a stop change it to that of the next instruction.
template <class Observer>
[[gnu::always_inline]] inline Flow perform(Core& core, const Operation& op, std::uint32_t& pc,
                                           Observer& observer);

namespace detail {

// The code of all instructions is inlined into each loop. With the address sanitizer, which needs minutes to compile a function of so many
// temporaries, each instruction is a function that all loops share.
#if SC_ADDRESS_SANITIZER
#define SC_PART_OF_THE_LOOP [[gnu::noinline]]
#else
#define SC_PART_OF_THE_LOOP [[gnu::always_inline]]
#endif

/// The result of `kSemantics` for the operands.
template <auto kSemantics, class... More>
SC_PART_OF_THE_LOOP inline auto computed(const Core& core, const Operation& op, More&... more) {
  return kSemantics(core.operands(op), more...);
}
#undef SC_PART_OF_THE_LOOP

/// Branches with their D or E bit set change whether interrupts are enabled, when they are taken.
inline void change_interrupts(SpuState& state, const Operation& op) {
  if ((op.rb & (kDisableInterrupts | kEnableInterrupts)) == 0) return;
  state.interrupts_enabled = (op.rb & kEnableInterrupts) != 0;
}

inline std::uint32_t next_of(std::uint32_t pc) { return (pc + 4) & kInstructionMask; }

/// Most branches do nothing else.
template <Mnemonic kMnemonic>
[[gnu::always_inline]] inline Flow finish_jump(Core& core, const Operation& op, semantics::Jump jump,
                                               std::uint32_t& pc) {
  constexpr const InstructionInfo& kInfo = info_of(kMnemonic);
  if constexpr (kInfo.writes_target) core.state.registers[op.rt] = in_preferred_word(next_of(pc));
  if (!jump.taken) return Flow::kNext;
  if constexpr (kInfo.format == Format::kRr) change_interrupts(core.state, op);
  pc = jump.target;
  return Flow::kJump;
}

template <class Observer>
[[gnu::always_inline]] inline Flow load(Core& core, const Operation& op, std::uint32_t lsa, std::uint32_t pc,
                                        Observer& observer) {
  observer.on_load(lsa, pc);
  return core.set(op, load_quadword(core.local_store + lsa));
}
template <class Observer>
[[gnu::always_inline]] inline Flow store(Core& core, const Operation& op, std::uint32_t lsa, std::uint32_t pc,
                                         Observer& observer) {
  observer.on_store(lsa, pc);
  store_quadword(core.local_store + lsa, core.state.registers[op.rt]);
  return Flow::kNext;
}

inline Flow stop(Core& core, std::uint32_t code, std::uint32_t& pc) {
  pc = next_of(pc);
  return core.end(Ending::kStop, code);
}

// Channel instructions and syncs are rare, so they are not inlined into the loop.

[[gnu::noinline]] inline Flow read_channel(Core& core, const Operation& op, std::uint32_t pc) {
  core.state.pc = pc;
  std::uint32_t value = 0;
  if (!core.surroundings.read_channel(op.ra, value)) return core.end(Ending::kChannelFault);
  return core.set(op, in_preferred_word(value));
}
[[gnu::noinline]] inline Flow count_channel(Core& core, const Operation& op, std::uint32_t pc) {
  core.state.pc = pc;
  std::uint32_t value = 0;
  if (!core.surroundings.count_channel(op.ra, value)) return core.end(Ending::kChannelFault);
  return core.set(op, in_preferred_word(value));
}
[[gnu::noinline]] inline Flow write_channel(Core& core, const Operation& op, std::uint32_t pc) {
  core.state.pc = pc;
  if (!core.surroundings.write_channel(op.ra, preferred_word(core.state.registers[op.rt])))
    return core.end(Ending::kChannelFault);
  return Flow::kNext;
}
[[gnu::noinline]] inline Flow jump_if_event(Core& core, const Operation& op, std::uint32_t& pc) {
  core.state.pc = pc;
  std::uint32_t events = 0;
  if (!core.surroundings.count_channel(0, events)) return core.end(Ending::kChannelFault);
  const std::uint32_t target = preferred_word(core.state.registers[op.ra]);
  return finish_jump<Mnemonic::bisled>(core, op, semantics::jump_if(events != 0, target), pc);
}

}  // namespace detail

// One of these for each kind.
#define SC_PERFORM_Compute(id) return core.set(op, detail::computed<semantics::id>(core, op));
#define SC_PERFORM_EnhancedDouble(id)                                     \
  if (!core.state.has_enhanced_double) return core.end(Ending::kInvalid); \
  return core.set(op, detail::computed<semantics::id>(core, op));
#define SC_PERFORM_Float(id) return core.set(op, detail::computed<semantics::id>(core, op, core.state.fpscr));
#define SC_PERFORM_ControlFloat(id)                            \
  detail::computed<semantics::id>(core, op, core.state.fpscr); \
  return Flow::kNext;
#define SC_PERFORM_Load(id) \
  return detail::load(core, op, detail::computed<semantics::id>(core, op, pc), pc, observer);
#define SC_PERFORM_Store(id) \
  return detail::store(core, op, detail::computed<semantics::id>(core, op, pc), pc, observer);
#define SC_PERFORM_Jump(id) \
  return detail::finish_jump<Mnemonic::id>(core, op, detail::computed<semantics::id>(core, op, pc), pc);
#define SC_PERFORM_InterruptReturn(id) \
  return detail::finish_jump<Mnemonic::id>(core, op, semantics::jump_if(true, core.state.srr0), pc);
#define SC_PERFORM_EventJump(id) return detail::jump_if_event(core, op, pc);
#define SC_PERFORM_Halt(id) \
  return detail::computed<semantics::id>(core, op) ? core.end(Ending::kHalt) : Flow::kNext;
#define SC_PERFORM_Stop(id) return detail::stop(core, static_cast<std::uint32_t>(op.imm), pc);
#define SC_PERFORM_Breakpoint(id) return detail::stop(core, kBreakpointCode, pc);
#define SC_PERFORM_ReadChannel(id) return detail::read_channel(core, op, pc);
#define SC_PERFORM_CountChannel(id) return detail::count_channel(core, op, pc);
#define SC_PERFORM_WriteChannel(id) return detail::write_channel(core, op, pc);
#define SC_PERFORM_Sync(id) \
  core.surroundings.sync(); \
  return Flow::kNext;
#define SC_PERFORM_Nothing(id) return Flow::kNext;

inline constexpr std::uint32_t kBreakpointCode = 0x3FFF;  // [SPU-ISA, stopd] documented

template <class Observer>
inline Flow perform(Core& core, const Operation& op, std::uint32_t& pc, Observer& observer) {
  observer.on_instruction(op, pc);
  switch (op.mnemonic) {
#define SC_SPU_INSTRUCTION(identifier, mnemonic, format, bits, opcode, latency, reads, writes, kind) \
  case Mnemonic::identifier: {                                                                       \
    SC_PERFORM_##kind(identifier)                                                                    \
  }
#include "instructions.def"
#undef SC_SPU_INSTRUCTION
    case Mnemonic::invalid:
      break;
  }
  return core.end(Ending::kInvalid);
}

#undef SC_PERFORM_Compute
#undef SC_PERFORM_EnhancedDouble
#undef SC_PERFORM_Float
#undef SC_PERFORM_ControlFloat
#undef SC_PERFORM_Load
#undef SC_PERFORM_Store
#undef SC_PERFORM_Jump
#undef SC_PERFORM_InterruptReturn
#undef SC_PERFORM_EventJump
#undef SC_PERFORM_Halt
#undef SC_PERFORM_Stop
#undef SC_PERFORM_Breakpoint
#undef SC_PERFORM_ReadChannel
#undef SC_PERFORM_CountChannel
#undef SC_PERFORM_WriteChannel
#undef SC_PERFORM_Sync
#undef SC_PERFORM_Nothing

}  // namespace softcell::ls_sim::interpreter
