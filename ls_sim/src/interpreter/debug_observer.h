#pragma once
// What a program does, told to a Debugger.

#include <atomic>
#include <span>

#include "core.h"
#include "softcell/ls_sim/debugger.h"

namespace softcell::ls_sim::interpreter {

/// An SPE while it stands still within DebugObserver::on_instruction().
class StandingSpe final : public DebuggedSpe {
 public:
  StandingSpe(SpuState& state, std::span<std::byte> local_store) : state_(state), local_store_(local_store) {}

  RegisterBytes read_register(int number) const override {
    RegisterBytes bytes;
    store_quadword(bytes.data(), state_.registers[number]);
    return bytes;
  }
  void write_register(int number, const RegisterBytes& value) override {
    state_.registers[number] = load_quadword(value.data());
  }
  std::span<std::byte> local_store() override { return local_store_; }

 private:
  SpuState& state_;
  std::span<std::byte> local_store_;
};

/// Keeps the program counter in the state, as the debugger may ask where an SPE is.
class DebugObserver {
 public:
  /// @param stop_wanted  is set when the debugger wants the end
  DebugObserver(SpuState& state, Debugger& debugger, int spe, std::atomic<bool>& stop_wanted)
      : state_(state), debugger_(debugger), spe_(spe), stop_wanted_(stop_wanted) {}

  void on_instruction(const Operation&, std::uint32_t pc) {
    state_.pc = pc;
    const HostArithmetic host;
    if (!debugger_.on_instruction(spe_, {pc})) stop_wanted_.store(true, std::memory_order_relaxed);
  }
  void on_load(std::uint32_t lsa, std::uint32_t) { tell(lsa, false); }
  void on_store(std::uint32_t lsa, std::uint32_t) { tell(lsa, true); }

 private:
  void tell(std::uint32_t lsa, bool is_store) {
    const HostArithmetic host;
    debugger_.on_access(spe_, {lsa}, is_store);
  }

  SpuState& state_;
  Debugger& debugger_;
  const int spe_;
  std::atomic<bool>& stop_wanted_;
};

}  // namespace softcell::ls_sim::interpreter
