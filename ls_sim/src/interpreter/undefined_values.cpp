#include "undefined_values.h"

#include <array>
#include <cstddef>
#include <utility>

#include "checked_observer.h"
#include "execute.h"

namespace softcell::ls_sim::interpreter {
namespace {

constexpr Quadword kAllBits{~0u, ~0u, ~0u, ~0u};
constexpr std::uint32_t kWord = ~0u;
constexpr std::uint32_t kAddressBits = kQuadwordMask;
constexpr std::uint64_t kExponents = 0x7FF0000000000000;

bool any(Quadword q) { return _mm_testz_si128((__m128i)q, (__m128i)q) == 0; }

bool computes(Kind kind, const SpuState& state) {
  return kind == Kind::kCompute || kind == Kind::kFloat ||
         (kind == Kind::kEnhancedDouble && state.has_enhanced_double);
}

/// Bits that differ from register to register.
Quadword scattered(std::uint8_t reg, std::uint32_t seed) {
  U32x4 q{};
  for (int i = 0; i < 4; ++i) {
    seed = (seed + reg + 1u) * 0x9E3779B1u;
    q[i] = seed ^ seed >> 15;
  }
  return q;
}

/// The values that a trial puts into undefined bits: extremes, the opposites of the present ones, and the operands with which they may be
/// compared.
constexpr int kTrials = 32;
Quadword other_bits(int trial, const Operation& op, std::uint8_t reg, const SpuState& state) {
  switch (trial) {
    case 0:
      return Quadword{};
    case 1:
      return kAllBits;
    case 2:
      return ~state.registers[reg];
    case 3:
      return (Quadword)splat_byte(0x55);
    case 4:
      return (Quadword)splat_byte(0xAA);
    case 5:
      return (Quadword)splat_byte(0x80);
    case 6:
      return (Quadword)splat_byte(0x7F);
    case 7:
      return (Quadword)splat_byte(op.imm);
    case 8:
      return (Quadword)splat_half(op.imm);
    case 9:
      return splat_word(op.imm);
    case 10:
      return state.registers[op.ra];
    case 11:
      return state.registers[op.rb];
    default:
      return scattered(reg, static_cast<std::uint32_t>(trial));
  }
}

// Most instructions with undefined bits do one of two things, and what becomes of the bits is known without trials.

/// Operands of which each bit of the result copies at most one, or its complement, as long as the control is defined.
struct Moves {
  std::uint8_t data = 0;  ///< of `reads`; 0: the instruction is no such one
  std::uint8_t control = 0;
  Quadword control_bits{};  ///< those that count
};

Moves moves_of(Mnemonic mnemonic) {
  const Quadword low_byte_of_preferred_word{0, 0, 0, 0xFF};
  using enum Mnemonic;
  switch (mnemonic) {
    case rotqby:
    case rotqbybi:
    case rotqbi:
    case rotqmby:
    case rotqmbybi:
    case rotqmbi:
    case shlqby:
    case shlqbybi:
    case shlqbi:
      return {reads::kA, reads::kB, low_byte_of_preferred_word};
    case rotqbyi:
    case rotqbii:
    case rotqmbyi:
    case rotqmbii:
    case shlqbyi:
    case shlqbii:
    case roti:
    case rothi:
    case rotmi:
    case rothmi:
    case rotmai:
    case rotmahi:
    case shli:
    case shlhi:
    case xsbh:
    case xshw:
    case xswd:
    case ori:
    case orbi:
    case orhi:
    case andi:
    case andbi:
    case andhi:
    case xori:
    case xorbi:
    case xorhi:
      return {reads::kA, 0, Quadword{}};
    case shufb:
    case selb:
      return {reads::kA | reads::kB, reads::kC, kAllBits};
    default:
      return {};
  }
}

/// An instruction that adds, or multiplies and adds, each lane by itself.
struct Sum {
  int lane_bytes = 0;  ///< 0: the instruction is no such one
  bool multiplies = false;
};

Sum sum_of(Mnemonic mnemonic) {
  using enum Mnemonic;
  switch (mnemonic) {
    case a:
    case sf:
    case ai:
    case sfi:
    case fa:
    case fs:
      return {4, false};
    case fm:
    case fma:
    case fms:
    case fnms:
      return {4, true};
    case dfa:
    case dfs:
      return {8, false};
    case dfm:
    case dfma:
    case dfms:
    case dfnma:
    case dfnms:
      return {8, true};
    default:
      return {};
  }
}

/// All bits of the lanes of which one is set. @param bytes  of a lane, 4 or 8
Quadword whole_lanes(Quadword bits, int bytes) {
  return bytes == 4 ? (Quadword)((S32x4)bits != 0) : (Quadword)((S64x2)bits != 0);
}

}  // namespace

UndefinedValues::UndefinedValues(EntryState entry) {
  if (entry == EntryState::kThreadGroup) return;  // all registers are set
  undefined_.fill(kAllBits);
  undefined_[CheckedObserver::kStackRegister] = Quadword{};
  for (int i = 0; i < CheckedObserver::kArguments; ++i)
    undefined_[static_cast<std::size_t>(CheckedObserver::kFirstArgument + i)] = Quadword{};
}

std::optional<UndefinedUse> UndefinedValues::on_instruction(const Operation& op, std::uint32_t pc,
                                                            const SpuState& state) {
  target_ = op.rt;
  pc_ = pc;
  if (op.mnemonic == Mnemonic::invalid) return {};
  const InstructionInfo& info = info_of(op.mnemonic);
  if (computes(info.kind, state)) {
    follow(op, info, state);
    return {};
  }
  const std::optional<UndefinedUse> found = use(op, info, state);
  if (found) undefined_[static_cast<std::size_t>(found->reg)] = Quadword{};  // report it once
  if (info.writes_target && info.kind != Kind::kLoad) undefined_[op.rt] = Quadword{};
  return found;
}

void UndefinedValues::follow(const Operation& op, const InstructionInfo& info, const SpuState& state) {
  struct Operand {
    std::uint8_t bit, reg;
  };
  const Operand operands[] = {{reads::kA, op.ra}, {reads::kB, op.rb}, {reads::kC, op.rc}, {reads::kT, op.rt}};
  std::optional<LoadedFrom> from;
  bool depends = false;
  for (const auto& [bit, reg] : operands) {
    if ((info.reads & bit) == 0 || !any(undefined_[reg])) continue;
    if (!std::exchange(depends, true)) from = from_[reg];
  }
  if (!depends) {
    if (info.writes_target) undefined_[op.rt] = Quadword{};
    return;
  }
  if (info.writes_target) {
    if (const auto known = undefined_without_trials(op, info, state)) {
      undefined_[op.rt] = *known;
      from_[op.rt] = from;
      return;
    }
  }
  trial_.fpscr = state.fpscr;
  trial_.has_enhanced_double = state.has_enhanced_double;
  /// The result with these operands.
  const auto result_of = [&](const auto& operand) {
    for (const auto& [bit, reg] : operands) trial_.registers[reg] = operand(reg);
    interpreter::compute(trial_, op);
    return trial_.registers[op.rt];
  };
  const Quadword result = result_of([&](std::uint8_t reg) { return state.registers[reg]; });
  Quadword changes{};
  for (int trial = 0; trial < kTrials; ++trial) {
    changes |= result ^ result_of([&](std::uint8_t reg) {
                 const Quadword mask = undefined_[reg];
                 return (state.registers[reg] & ~mask) | (other_bits(trial, op, reg, state) & mask);
               });
  }
  if (!info.writes_target) return;
  undefined_[op.rt] = changes;
  from_[op.rt] = from;
}

/// @return  none: it takes trials. @pre  an operand has undefined bits
std::optional<Quadword> UndefinedValues::undefined_without_trials(const Operation& op,
                                                                  const InstructionInfo& info,
                                                                  const SpuState& state) {
  if (const Moves moves = moves_of(op.mnemonic); moves.data != 0) {
    const std::uint8_t control = moves.control == reads::kB ? op.rb : op.rc;
    const bool has_b = (moves.data & reads::kB) != 0;
    if (moves.control != 0) {
      if (any(undefined_[control] & moves.control_bits) || control == op.ra || (has_b && control == op.rb))
        return {};
      trial_.registers[control] = state.registers[control];
    }
    const auto moved = [&](const auto& of) {
      trial_.registers[op.ra] = of(op.ra);
      if (has_b) trial_.registers[op.rb] = of(op.rb);
      interpreter::compute(trial_, op);
      return trial_.registers[op.rt];
    };
    const Quadword constant = moved([](std::uint8_t) { return Quadword{}; });
    return constant ^ moved([&](std::uint8_t reg) { return undefined_[reg]; });
  }

  const Sum sum = sum_of(op.mnemonic);
  const int lane = sum.lane_bytes;
  if (lane == 0) return {};
  struct Operand {
    std::uint8_t bit, reg;
  };
  // Only where lanes are undefined as a whole, and no operand may cancel another.
  const Operand operands[] = {{reads::kA, op.ra}, {reads::kB, op.rb}, {reads::kC, op.rc}, {reads::kT, op.rt}};
  Quadword result{};
  std::array<Quadword, 2> factors{};
  std::array<std::uint8_t, 4> used{};
  std::size_t count = 0;
  for (const auto& [bit, reg] : operands) {
    if ((info.reads & bit) == 0) continue;
    const Quadword undefined = undefined_[reg];
    for (std::size_t i = 0; i < count; ++i) {
      if (used[i] == reg && any(undefined)) return {};
    }
    used[count++] = reg;
    if (any(undefined ^ whole_lanes(undefined, lane))) return {};
    result |= undefined;
    if (count <= factors.size()) factors[count - 1] = undefined;
  }
  if (!sum.multiplies) return result;
  // A product with zero, or with a denormal that counts as zero, does not depend on the other factor.
  const Quadword exponent =
      lane == 4 ? (Quadword)splat_word(0x7F800000) : (Quadword)U64x2{kExponents, kExponents};
  for (std::size_t i = 0; i < factors.size(); ++i) {
    const Quadword other = state.registers[used[1 - i]];
    if (any(factors[i] & ~factors[1 - i] & ~whole_lanes(other & exponent, lane))) return {};
  }
  return result;
}

/// @param bits  of the preferred word: those that count
std::optional<UndefinedUse> UndefinedValues::use_of(std::uint8_t reg, std::uint32_t bits,
                                                    const SpuState& state, UndefinedUse::Kind kind) {
  const std::uint32_t undefined = preferred_word(undefined_[reg]) & bits;
  if (undefined == 0) return {};
  // Whether a word is zero does not depend on the rest of it where one bit is set.
  const bool is_condition = kind == UndefinedUse::Kind::kCondition;
  if (is_condition && (preferred_word(state.registers[reg]) & bits & ~undefined) != 0) return {};
  return UndefinedUse{.kind = kind, .reg = reg, .from = from_[reg]};
}

std::optional<UndefinedUse> UndefinedValues::use(const Operation& op, const InstructionInfo& info,
                                                 const SpuState& state) {
  const auto first_of = [](std::optional<UndefinedUse> first, const auto& second) {
    return first ? first : second();
  };
  using enum UndefinedUse::Kind;
  const bool has_a = (info.reads & reads::kA) != 0, has_b = (info.reads & reads::kB) != 0;
  const auto of = [&](bool is_read, std::uint8_t reg, std::uint32_t bits, UndefinedUse::Kind kind) {
    return is_read ? use_of(reg, bits, state, kind) : std::nullopt;
  };
  switch (info.kind) {
    case Kind::kLoad:
    case Kind::kStore:
      return first_of(of(has_a, op.ra, kAddressBits, kAddress),
                      [&] { return of(has_b, op.rb, kAddressBits, kAddress); });
    case Kind::kJump:
    case Kind::kEventJump: {
      const bool is_half = op.mnemonic == Mnemonic::brhz || op.mnemonic == Mnemonic::brhnz ||
                           op.mnemonic == Mnemonic::bihz || op.mnemonic == Mnemonic::bihnz;
      return first_of(of((info.reads & reads::kT) != 0, op.rt, is_half ? 0xFFFFu : kWord, kCondition),
                      [&] { return of(has_a, op.ra, kAddressBits, kTarget); });
    }
    case Kind::kHalt:
      return first_of(of(has_a, op.ra, kWord, kHalt), [&] { return of(has_b, op.rb, kWord, kHalt); });
    case Kind::kWriteChannel:
      return of(true, op.rt, kWord, kChannel);
    default:
      return {};
  }
}

void UndefinedValues::on_load(std::uint32_t lsa, const UndefinedBits& undefined) {
  undefined_[target_] = load_quadword(reinterpret_cast<const std::byte*>(undefined.data()));
  from_[target_] = LoadedFrom{.lsa = {lsa}, .instruction = {pc_}};
}

UndefinedBits UndefinedValues::stored() const {
  UndefinedBits bits;
  store_quadword(reinterpret_cast<std::byte*>(bits.data()), undefined_[target_]);
  return bits;
}

}  // namespace softcell::ls_sim::interpreter
