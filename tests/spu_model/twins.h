#pragma once

// The interpreter and the model side by side: the same state, the same instruction, and what differs
// afterwards.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "interpreter/execute.h"
#include "spu_model/encode.h"

namespace softcell::spu_model {

class Twins final : private ChannelPort {
 public:
  Twins();

  Machine& model() { return model_; }
  const Machine& model() const { return model_; }
  /// Sets both.
  void set_register(std::uint32_t number, const Quadword& value);
  void set_fpscr(const Quadword& value);
  void set_pc(std::uint32_t pc);
  void set_srr0(std::uint32_t address);
  void set_interrupts(bool enabled);
  /// @pre  the bytes end within the local store
  void set_memory(std::uint32_t address, std::span<const std::uint8_t> bytes);

  /// Both execute `word` as if it lay at PC. A halt counts as executed: both go on behind it.
  /// @return what differs in the outcome, in PC, SRR0 and FPSCR and in the registers that the word names, as
  /// a sentence; empty: nothing.
  std::string execute_word(std::uint32_t word);
  /// Both execute the word that each has at PC.
  std::string step();
  /// What differs in all registers and in the local stores; empty: nothing.
  std::string difference() const;

 private:
  // What the interpreter answers where nothing is connected: a count of 1, zeros to read. Channels 13 to 15
  // are the SPU's own.
  ChannelAnswer read(unsigned int channel, std::uint32_t& value) override;
  ChannelAnswer write(unsigned int channel, std::uint32_t value) override;
  ChannelAnswer count(unsigned int, std::uint32_t& count) override;
  std::uint32_t event_count() override { return 1; }

  Quadword interpreter_register(std::uint32_t number) const;
  Quadword interpreter_fpscr() const;
  std::string register_difference(std::uint32_t number) const;

  Machine model_;
  ls_sim::interpreter::SpuState state_;
  std::vector<std::byte> local_store_;
};

/// In hexadecimal, word by word.
std::string to_text(const Quadword& value);
/// Mnemonic and bits.
std::string to_text_of_instruction(std::uint32_t word);

}  // namespace softcell::spu_model
