#pragma once
// What a checked program does, told to an AccessObserver.

#include <bitset>

#include "core.h"
#include "softcell/ls_sim/engine.h"

namespace softcell::ls_sim::interpreter {

/// Keeps the program counter in the state, where the observer looks for it, and which registers have been written.
class CheckedObserver {
 public:
  static constexpr int kStackRegister = 1, kFirstArgument = 3, kArguments = 4;

  CheckedObserver(SpuState& state, AccessObserver& to) : state_(state), to_(to) {
    written_.set(kStackRegister);
    for (int i = 0; i < kArguments; ++i) written_.set(static_cast<std::size_t>(kFirstArgument + i));
  }

  void on_instruction(const Operation& op, std::uint32_t pc) {
    state_.pc = pc;
    to_.on_instruction(
        {.address = {pc}, .stack_pointer = stack_pointer(), .unset_address_register = unset_address(op)});
    if (op.mnemonic != Mnemonic::invalid && info_of(op.mnemonic).writes_target) written_.set(op.rt);
  }
  void on_load(std::uint32_t lsa, std::uint32_t pc) { access(lsa, pc, false); }
  void on_store(std::uint32_t lsa, std::uint32_t pc) { access(lsa, pc, true); }

 private:
  dma::LocalStoreAddress stack_pointer() const {
    return {preferred_word(state_.registers[kStackRegister]) & dma::kLocalStoreMask};
  }
  int unset_address(const Operation& op) const {
    if (op.mnemonic == Mnemonic::invalid) return -1;
    const InstructionInfo& info = info_of(op.mnemonic);
    if (info.kind != Kind::kLoad && info.kind != Kind::kStore) return -1;
    if ((info.reads & reads::kA) != 0 && !written_[op.ra]) return op.ra;
    if ((info.reads & reads::kB) != 0 && !written_[op.rb]) return op.rb;
    return -1;
  }
  void access(std::uint32_t lsa, std::uint32_t pc, bool is_store) {
    to_.on_access({.lsa = {lsa},
                   .bytes = dma::kQuadwordBytes,
                   .is_store = is_store,
                   .instruction = {pc},
                   .stack_pointer = stack_pointer()});
  }

  SpuState& state_;
  AccessObserver& to_;
  std::bitset<128> written_;
};

}  // namespace softcell::ls_sim::interpreter
