#pragma once
// What a checked program does, told to an AccessObserver.

#include "core.h"
#include "softcell/ls_sim/engine.h"
#include "undefined_values.h"

namespace softcell::ls_sim::interpreter {

/// Keeps the program counter in the state, where the observer looks for it.
class CheckedObserver {
 public:
  static constexpr int kStackRegister = 1, kFirstArgument = 3, kArguments = 4;

  CheckedObserver(SpuState& state, UndefinedValues& values, AccessObserver& to)
      : state_(state), values_(values), to_(to) {}

  void on_instruction(const Operation& op, std::uint32_t pc) {
    state_.pc = pc;
    to_.on_instruction({.address = {pc},
                        .stack_pointer = stack_pointer(),
                        .undefined = values_.on_instruction(op, pc, state_)});
  }
  void on_load(std::uint32_t lsa, std::uint32_t pc) {
    access(lsa, pc, false);
    values_.on_load(lsa, to_.undefined_bits({lsa}));
  }
  void on_store(std::uint32_t lsa, std::uint32_t pc) { access(lsa, pc, true); }

 private:
  dma::LocalStoreAddress stack_pointer() const {
    return {preferred_word(state_.registers[kStackRegister]) & dma::kLocalStoreMask};
  }
  void access(std::uint32_t lsa, std::uint32_t pc, bool is_store) {
    to_.on_access({.lsa = {lsa},
                   .bytes = dma::kQuadwordBytes,
                   .is_store = is_store,
                   .instruction = {pc},
                   .stack_pointer = stack_pointer(),
                   .undefined = is_store ? values_.stored() : UndefinedBits{}});
  }

  SpuState& state_;
  UndefinedValues& values_;
  AccessObserver& to_;
};

}  // namespace softcell::ls_sim::interpreter
