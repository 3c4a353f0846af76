#include "spu_model/twins.h"

#include <cstdio>
#include <cstring>

#include "softcell/base/assert.h"

namespace softcell::spu_model {
namespace {

namespace interpreter = ls_sim::interpreter;

/// A register of the interpreter from its 16 bytes in the SPU's order, and back.
interpreter::Quadword theirs(const Quadword& value) {
  return interpreter::load_quadword(reinterpret_cast<const std::byte*>(value.bytes.data()));
}
Quadword ours(interpreter::Quadword value) {
  Quadword result;
  interpreter::store_quadword(reinterpret_cast<std::byte*>(result.bytes.data()), value);
  return result;
}

std::string hexadecimal(std::uint32_t value) {
  char text[16];
  std::snprintf(text, sizeof text, "%08X", value);
  return text;
}

Outcome outcome_of(interpreter::Ending ending) {
  switch (ending) {
    case interpreter::Ending::kNone:
      return Outcome::kNext;
    case interpreter::Ending::kStop:
      return Outcome::kStop;
    case interpreter::Ending::kHalt:
      return Outcome::kHalt;
    case interpreter::Ending::kChannelFault:
      return Outcome::kInvalidChannel;
    default:
      return Outcome::kInvalidInstruction;
  }
}

const char* name_of(Outcome outcome) {
  constexpr const char* kNames[] = {"next", "stop", "halt", "invalid instruction", "invalid channel",
                                    "stall"};
  return kNames[static_cast<int>(outcome)];
}

constexpr unsigned int kMachineStatus = 13, kWriteSrr0 = 14, kReadSrr0 = 15;  // channels [CBEA] documented

}  // namespace

std::string to_text(const Quadword& value) {
  std::string text;
  for (int i = 0; i < 4; ++i) text += (i == 0 ? "" : " ") + hexadecimal(value.word(i));
  return text;
}

std::string to_text_of_instruction(std::uint32_t word) {
  const Instruction* const row = decode(word);
  return (row == nullptr ? "no instruction" : std::string(row->mnemonic)) + " (" + hexadecimal(word) + ")";
}

Twins::Twins() : local_store_(kLocalStoreLimit + 1) {
  model_.channels = this;
  model_.enhanced_double = true;
  state_.has_enhanced_double = true;
}

void Twins::set_register(std::uint32_t number, const Quadword& value) {
  model_.registers.at(number) = value;
  state_.registers[number] = theirs(value);
}
void Twins::set_fpscr(const Quadword& value) {
  model_.fpscr = value;
  state_.fpscr.bits = theirs(value);
}
void Twins::set_pc(std::uint32_t pc) { model_.pc = state_.pc = pc & kLocalStoreLimit & ~3u; }
void Twins::set_srr0(std::uint32_t address) { model_.srr0 = state_.srr0 = address & kLocalStoreLimit & ~3u; }
void Twins::set_interrupts(bool enabled) { model_.interrupts_enabled = state_.interrupts_enabled = enabled; }
void Twins::set_memory(std::uint32_t address, std::span<const std::uint8_t> bytes) {
  SC_ASSERT(address <= model_.local_store.size() && bytes.size() <= model_.local_store.size() - address,
            "{} bytes at {} pass the end of the local store", bytes.size(), address);
  if (bytes.empty()) return;
  std::memcpy(model_.local_store.data() + address, bytes.data(), bytes.size());
  std::memcpy(local_store_.data() + address, bytes.data(), bytes.size());
}

std::string Twins::execute_word(std::uint32_t word) {
  const std::uint32_t pc = model_.pc;
  const StepResult expected = execute(model_, word);
  const interpreter::Step found = interpreter::execute(
      state_, std::span<std::byte, kLocalStoreLimit + 1>(local_store_.data(), local_store_.size()), word);
  const std::string where = to_text_of_instruction(word) + " at " + hexadecimal(pc) + ": ";
  if (outcome_of(found.ending) != expected.outcome) {
    return where + "the outcome is " + name_of(outcome_of(found.ending)) + " and not " +
           name_of(expected.outcome);
  }
  if (expected.outcome == Outcome::kStop && found.stop_code != expected.stop_code) {
    return where + "the stop code is " + hexadecimal(found.stop_code) + " and not " +
           hexadecimal(expected.stop_code);
  }
  // Where execution would go on after a halt is the engine's affair.
  if (expected.outcome == Outcome::kHalt) state_.pc = model_.pc;
  if (state_.pc != model_.pc) {
    return where + "PC is " + hexadecimal(state_.pc) + " and not " + hexadecimal(model_.pc);
  }
  if (state_.srr0 != model_.srr0) {
    return where + "SRR0 is " + hexadecimal(state_.srr0) + " and not " + hexadecimal(model_.srr0);
  }
  if (state_.interrupts_enabled != model_.interrupts_enabled) {
    return where + "interrupts are " + (state_.interrupts_enabled ? "enabled" : "disabled");
  }
  if (interpreter_fpscr() != model_.fpscr) {
    return where + "FPSCR is " + to_text(interpreter_fpscr()) + " and not " + to_text(model_.fpscr);
  }
  for (const std::uint32_t number : {word >> 7, word >> 14, word, word >> 21}) {
    const std::string difference = register_difference(number & 127);
    if (!difference.empty()) return where + difference;
  }
  return {};
}

std::string Twins::step() {
  const std::uint32_t word = model_.fetch(model_.pc);
  std::uint32_t found = 0;
  for (std::uint32_t i = 0; i < 4; ++i)
    found = found << 8 | std::to_integer<std::uint32_t>(local_store_.at(state_.pc + i));
  if (found != word)
    return "the word at " + hexadecimal(state_.pc) + " is " + hexadecimal(found) + " and not " +
           hexadecimal(word);
  return execute_word(word);
}

std::string Twins::difference() const {
  for (std::uint32_t number = 0; number < 128; ++number) {
    const std::string difference = register_difference(number);
    if (!difference.empty()) return difference;
  }
  if (std::memcmp(local_store_.data(), model_.local_store.data(), local_store_.size()) == 0) return {};
  std::uint32_t address = 0;
  while (std::to_integer<std::uint8_t>(local_store_[address]) == model_.local_store[address]) ++address;
  return "the local stores differ at " + hexadecimal(address);
}

ChannelAnswer Twins::read(unsigned int channel, std::uint32_t& value) {
  value = channel == kMachineStatus ? (model_.interrupts_enabled ? 1 : 0)
          : channel == kReadSrr0    ? model_.srr0
                                    : 0;
  return ChannelAnswer::kDone;
}
ChannelAnswer Twins::write(unsigned int channel, std::uint32_t value) {
  if (channel == kWriteSrr0) model_.srr0 = value & kLocalStoreLimit & ~3u;
  return ChannelAnswer::kDone;
}
ChannelAnswer Twins::count(unsigned int, std::uint32_t& count) {
  count = 1;
  return ChannelAnswer::kDone;
}

Quadword Twins::interpreter_register(std::uint32_t number) const { return ours(state_.registers[number]); }
Quadword Twins::interpreter_fpscr() const { return ours(state_.fpscr.bits); }

std::string Twins::register_difference(std::uint32_t number) const {
  const Quadword found = interpreter_register(number);
  const Quadword& expected = model_.registers.at(number);
  if (found == expected) return {};
  return "register " + std::to_string(number) + " is " + to_text(found) + " and not " + to_text(expected);
}

}  // namespace softcell::spu_model
