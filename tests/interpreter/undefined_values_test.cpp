// Bits that come from nowhere, followed through registers and local store to where they matter.

#include "interpreter/undefined_values.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "interpreter/execute.h"
#include "softcell/dma/buffer.h"
#include "softcell/ls_sim/findings.h"
#include "softcell/ls_sim/spe_group.h"
#include "spu_words.h"

namespace softcell::ls_sim::interpreter {
namespace {

using enum Mnemonic;

constexpr std::int32_t kHeap = 0x2000;  // which nobody has written

/// "rule: detail" of each finding.
std::vector<std::string> findings_of(const std::vector<std::uint32_t>& words,
                                     EntryState entry = EntryState::kLibspe2) {
  KernelImage image = program_of(words);
  image.checked = true;
  dma::AddressSpace memory;
  Findings findings;
  {
    SpeGroup group(memory, {.spes = 1, .findings = &findings});
    group.start(0, image, {.entry_state = entry});
    EXPECT_TRUE(group.wait(0).ended_normally());
  }
  std::vector<std::string> texts;
  for (const Finding& each : findings.list())
    texts.push_back(std::string(dma::name(each.fault.rule)) + ": " + each.fault.detail);
  return texts;
}

std::uint32_t load_heap(std::uint32_t rt) { return ri16(lqa, rt, kHeap / 4); }
std::uint32_t store_heap(std::uint32_t rt) { return ri16(stqa, rt, kHeap / 4); }
/// Goes on behind itself, whatever the register holds.
std::uint32_t branch_on(std::uint32_t rt) { return ri16(brz, rt, 1); }

TEST(UndefinedValues, OfTheLocalStoreMatterInABranch) {
  const auto found = findings_of({load_heap(10), ri10(ai, 11, 10, 1), branch_on(11), stop_with(0x2000)});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0],
            "uninitialised-value: whether this branch is taken depends on register $11 (LSA 0x00088), on "
            "bytes of heap "
            "or stack (LSA 0x02000) that nobody has written; they were loaded at LSA 0x00080");
}

TEST(UndefinedValues, OfARegisterMatterToo) {
  const auto found = findings_of({ri10(ai, 11, 60, 1), branch_on(11), stop_with(0x2000)});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0],
            "uninitialised-value: whether this branch is taken depends on register $11 (LSA 0x00084), which "
            "the program has "
            "never written");
  EXPECT_TRUE(
      findings_of({ri10(ai, 11, 60, 1), branch_on(11), stop_with(0x2000)}, EntryState::kThreadGroup).empty())
      << "thread groups begin with zeros in all registers";
}

TEST(UndefinedValues, AreFoundInEachUse) {
  const auto use = [](std::uint32_t word) {
    const auto found = findings_of({load_heap(10), ri18(ila, 12, 0x8C), word, stop_with(0x2000)});
    return found.size() == 1 ? found[0].substr(0, found[0].find(" depends")) : std::to_string(found.size());
  };
  EXPECT_EQ(use(ri10(stqd, 12, 10, 0)), "uninitialised-address: the address of this access");
  EXPECT_EQ(use(rr(lqx, 12, 12, 10)), "uninitialised-address: the address of this access");
  EXPECT_EQ(use(rr(binz, 10, 12)), "uninitialised-value: whether this branch is taken");
  EXPECT_EQ(use(ri10(heqi, 0, 10, 5)), "uninitialised-value: whether this stops the SPU");
  EXPECT_EQ(use(rr(wrch, 10, 28)), "uninitialised-value: what is written to this channel");
}

TEST(UndefinedValues, MayBeLoadedCopiedAndMasked) {
  EXPECT_TRUE(
      findings_of({load_heap(10), ri16(stqa, 10, (kHeap + 64) / 4),  // a structure with its padding
                   ri16(lqa, 11, (kHeap + 64) / 4), ri10(andi, 12, 11, 0),
                   branch_on(12),                          // nothing of it is left
                   rr(xor_, 13, 11, 11), branch_on(13),    // nor here
                   ri16(il, 14, 3), rr(and_, 15, 11, 14),  // two bits of it
                   ri10(ori, 16, 15, 4), branch_on(16),    // but not zero whatever they are
                   ri16(ilh, 17, 0x0303), rrr(shufb, 18, 14, 11, 17), branch_on(18),  // bytes of $14 only
                   stop_with(0x2000)})
          .empty());
}

TEST(UndefinedValues, AreGoneBitByBit) {
  const auto set_bits = [](std::uint32_t mask, std::uint32_t value) {
    return std::vector<std::uint32_t>{load_heap(10),        ri18(ila, 11, mask), ri18(ila, 12, value),
                                      rr(andc, 10, 10, 11), rr(or_, 10, 10, 12), store_heap(10)};
  };
  std::vector<std::uint32_t> program = set_bits(0x00F, 0x005);
  for (const std::uint32_t word : set_bits(0xFF0, 0x120)) program.push_back(word);
  program.insert(program.end(), {load_heap(13), ri18(ila, 14, 0xFFF), rr(and_, 15, 13, 14), branch_on(15)});
  std::vector<std::uint32_t> whole = program;
  whole.push_back(stop_with(0x2000));
  EXPECT_TRUE(findings_of(whole).empty());
  program.insert(program.end(),
                 {ri18(ila, 14, 0x1000), rr(and_, 15, 13, 14), branch_on(15), stop_with(0x2000)});
  EXPECT_EQ(findings_of(program).size(), 1u) << "the thirteenth bit was never set";
}

TEST(UndefinedValues, EndWithATransferFromMainStorage) {
  dma::AddressSpace memory;
  const dma::Buffer<std::byte> data(memory, "data", 128);
  KernelImage image =
      program_of({load_heap(10), store_heap(10),
                  // a get of 128 bytes to kHeap
                  ri18(ila, 20, kHeap), rr(wrch, 20, 16), rr(wrch, 4, 17), ri7(shlqbyi, 21, 4, 4),
                  rr(wrch, 21, 18), ri16(il, 22, 128), rr(wrch, 22, 19), ri16(il, 23, 0), rr(wrch, 23, 20),
                  ri16(il, 24, 0x40), rr(wrch, 24, 21), ri16(il, 25, 1), rr(wrch, 25, 22), ri16(il, 26, 2),
                  rr(wrch, 26, 23), rr(rdch, 27, 24), load_heap(11), branch_on(11), stop_with(0x2000)});
  image.checked = true;
  Findings findings;
  SpeGroup group(memory, {.spes = 1, .findings = &findings});
  group.start(0, image, {.argp = data.ea().value});
  EXPECT_TRUE(group.wait(0).ended_normally());
  EXPECT_TRUE(findings.empty()) << findings.list().front().fault.message();
}

/// For each instruction that computes, other values in the undefined bits of its operands change no other bits of the result
/// than those that are followed. Few bits may be missed, none may be followed for nothing.
TEST(UndefinedValues, AreWhatTheResultDependsOn) {
  std::mt19937_64 random(7);
  std::vector<std::byte> store(dma::kLocalStoreBytes);
  std::uint64_t followed = 0, missed = 0;
  for (std::size_t i = 0; i < kInstructions; ++i) {
    const InstructionInfo& info = kInstructionTable[i];
    if (info.kind != Kind::kCompute && info.kind != Kind::kFloat) continue;
    if (info.format == Format::kRi16 || info.format == Format::kRi18) continue;
    const std::uint32_t word = info.format == Format::kRrr ? rrr(static_cast<Mnemonic>(i), 13, 10, 11, 12)
                                                           : rr(static_cast<Mnemonic>(i), 13, 10, 11);
    for (int round = 0; round < 40; ++round) {
      SpuState state;
      UndefinedValues values(EntryState::kThreadGroup);
      std::array<Quadword, 14> masks{};
      for (std::uint32_t reg = 10; reg <= 13; ++reg) {
        UndefinedBits bits{};
        // Bytes here and there, or the words or doubles beside a scalar.
        const int bytes = static_cast<int>(random() % 5);
        for (int b = 0; b < bytes && round % 4 < 2; ++b)
          bits[random() % 16] = round % 2 == 0 ? 0xFF : static_cast<std::uint8_t>(random());
        const std::size_t lane = round % 4 == 2 ? 4 : 8;
        for (std::size_t b = 0; b < bits.size() && round % 4 >= 2; b += lane) {
          if (random() % 2 == 0)
            std::fill_n(bits.begin() + static_cast<std::ptrdiff_t>(b), lane, std::uint8_t{0xFF});
        }
        values.on_instruction(decode(ri16(lqa, reg, 0)), 0, state);
        values.on_load(0, bits);
        masks[reg] = load_quadword(reinterpret_cast<const std::byte*>(bits.data()));
        for (int w = 0; w < 4; ++w)
          state.registers[reg][w] =
              round % 3 == 0 && random() % 2 == 0 ? 0 : static_cast<std::uint32_t>(random());
      }
      const auto result_of = [&](SpuState now) {
        execute(now, std::span<std::byte, dma::kLocalStoreBytes>(store), word);
        return now.registers[13];
      };
      values.on_instruction(decode(word), 0, state);
      values.on_instruction(decode(ri16(stqa, 13, 0)), 0, state);
      const UndefinedBits bits = values.stored();
      const Quadword undefined = load_quadword(reinterpret_cast<const std::byte*>(bits.data()));
      const Quadword expected = result_of(state);
      for (int trial = 0; trial < 20; ++trial) {
        SpuState other = state;
        for (std::uint32_t reg = 10; reg <= 13; ++reg) {
          for (int w = 0; w < 4; ++w) {
            const std::uint32_t value = static_cast<std::uint32_t>(random()), mask = masks[reg][w];
            other.registers[reg][w] = (state.registers[reg][w] & ~mask) | (value & mask);
          }
        }
        const Quadword changes = expected ^ result_of(other);
        for (int w = 0; w < 4; ++w) {
          followed += static_cast<std::uint64_t>(__builtin_popcount(changes[w] & undefined[w]));
          missed += static_cast<std::uint64_t>(__builtin_popcount(changes[w] & ~undefined[w]));
        }
      }
    }
  }
  EXPECT_GT(followed, 100'000u);
  EXPECT_LT(missed, followed / 200) << missed << " of " << followed;
}

/// The undefined bits of $13 after an instruction of $10, $11 and $12, of which the first two words of $10 are undefined.
Quadword undefined_after(std::uint32_t word, Quadword r11) {
  SpuState state;
  UndefinedValues values(EntryState::kThreadGroup);
  UndefinedBits bits{};
  std::fill_n(bits.begin(), 8, std::uint8_t{0xFF});
  values.on_instruction(decode(ri16(lqa, 10, 0)), 0, state);
  values.on_load(0, bits);
  state.registers[10] = from_words(0x40000000, 0x40000000, 0x40000000, 0x40000000);
  state.registers[11] = r11;
  values.on_instruction(decode(word), 0, state);
  values.on_instruction(decode(ri16(stqa, 13, 0)), 0, state);
  const UndefinedBits stored = values.stored();
  return load_quadword(reinterpret_cast<const std::byte*>(stored.data()));
}
void expect_words(Quadword bits, const std::array<std::uint32_t, 4>& words) {
  for (int w = 0; w < 4; ++w) EXPECT_EQ(word(bits, w), words[static_cast<std::size_t>(w)]) << "word " << w;
}

TEST(UndefinedValues, OfAFactorMatterOnlyBesideWhatIsNotZero) {
  const Quadword other = from_words(0, 0x3F800000, 0, 0x3F800000);
  for (const Mnemonic multiply : {fm, fma, fms, fnms}) {
    const std::uint32_t instruction =
        info_of(multiply).format == Format::kRrr ? rrr(multiply, 13, 10, 11, 12) : rr(multiply, 13, 10, 11);
    const Quadword undefined = undefined_after(instruction, other);
    EXPECT_EQ(word(undefined, 0), 0u);
    EXPECT_NE(word(undefined, 1), 0u);
    EXPECT_EQ(word(undefined, 2) | word(undefined, 3), 0u);
  }
  expect_words(undefined_after(rr(fm, 13, 10, 11), from_words(0x3F800000, 0x3F800000, 0, 0)),
               {~0u, ~0u, 0, 0});
  expect_words(undefined_after(rr(fa, 13, 10, 11), Quadword{}), {~0u, ~0u, 0, 0});
  expect_words(undefined_after(rr(fs, 13, 10, 10), Quadword{}), {0, 0, 0, 0});
}

TEST(UndefinedValues, MoveWithTheirBytes) {
  expect_words(undefined_after(ri7(rotqbyi, 13, 10, 4), Quadword{}), {~0u, 0, 0, ~0u});
  expect_words(undefined_after(ri10(andi, 13, 10, 0xF), Quadword{}), {0xF, 0xF, 0, 0});
  expect_words(undefined_after(ri10(ori, 13, 10, 0xF), Quadword{}), {~0xFu, ~0xFu, 0, 0});
  // A zero, ones and 0x80 of a pattern are no copies.
  expect_words(undefined_after(rrr(shufb, 13, 10, 10, 11), from_words(0x80C0E000, 0x18190A0B, 0, 0x10111213)),
               {0xFF, 0, ~0u, ~0u});
  // The pattern itself is undefined.
  EXPECT_NE(word(undefined_after(rrr(shufb, 13, 11, 11, 10), from_words(1, 2, 3, 4)), 0), 0u);
}

}  // namespace
}  // namespace softcell::ls_sim::interpreter
