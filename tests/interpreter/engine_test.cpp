// The interpreter on SPEs: programs of others, and small ones made here.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "softcell/dma/buffer.h"
#include "softcell/ls_sim/findings.h"
#include "softcell/ls_sim/image.h"
#include "softcell/ls_sim/spe_group.h"
#include "softcell/ls_sim/timing.h"
#include "spu_words.h"

namespace softcell::ls_sim::interpreter {
namespace {

using enum Mnemonic;

std::vector<std::byte> read_bytes(const std::string& name) {
  std::ifstream file(std::string(SOFTCELL_SPU_PROGRAMS "/") + name, std::ios::binary);
  EXPECT_TRUE(file.is_open()) << name;
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::vector<std::byte> bytes(text.size());
  std::memcpy(bytes.data(), text.data(), text.size());
  return bytes;
}

KernelImage load_program(const std::string& name) {
  return load_spu_program(name, read_bytes(name + ".elf"));
}

const dma::Schedule kSchedules[] = {
    {dma::Schedule::kEager}, {dma::Schedule::kLazy}, {dma::Schedule::kRandom, 7}};

/// Both optimisations of a program, under each schedule.
struct Case {
  std::string optimisation;
  dma::Schedule schedule;
};
std::vector<Case> cases() {
  std::vector<Case> all;
  for (const char* optimisation : {".O2", ".Os"}) {
    for (const dma::Schedule& schedule : kSchedules) all.push_back({optimisation, schedule});
  }
  return all;
}

TEST(SpuProgram, ChecksItself) {
  for (const Case& each : cases()) {
    const KernelImage image = load_program("selfcheck" + each.optimisation);
    dma::AddressSpace memory;
    SpeGroup group(memory, {.spes = 1, .schedule = each.schedule});
    group.start(0, image, {});
    const RunResult result = group.wait(0);
    ASSERT_TRUE(result.ended_normally()) << (result.fault ? result.fault->message() : "");
    EXPECT_EQ(result.status(), 0u) << "the number of the check that failed, " << each.optimisation;
    if (each.optimisation == ".O2") {
      EXPECT_EQ(group.statistics(0).instructions, 27474u);
    }
  }
}

TEST(SpuProgram, WithoutMistakesHasNoFindings) {
  for (const char* optimisation : {".O2", ".Os"}) {
    const std::vector<std::byte> input = read_bytes("vector_math.in.bin");
    KernelImage checks = load_program(std::string("selfcheck") + optimisation);
    KernelImage vectors = load_program(std::string("vector_math") + optimisation);
    checks.checked = vectors.checked = true;
    dma::AddressSpace memory;
    const dma::Buffer<std::byte> in(memory, "in", input.size()), out(memory, "out", 5120);
    Findings findings;
    SpeGroup group(memory, {.spes = 2, .findings = &findings});
    group.start(0, checks, {});
    group.start(1, vectors, {.argp = in.ea().value, .envp = out.ea().value});
    EXPECT_EQ(group.wait(0).status(), 0u);
    EXPECT_EQ(group.wait(1).status(), 0u);
    for (const Finding& finding : findings.list()) ADD_FAILURE() << finding.fault.message();
  }
}

/// Words of a parameter block as the SPU reads them: the PPU side has them in its own order, since the buffer knows
/// that it holds words of 32 bits.
dma::Buffer<std::uint32_t> parameter_block(dma::AddressSpace& memory,
                                           const std::vector<std::uint64_t>& addresses,
                                           const std::vector<std::uint32_t>& words) {
  dma::Buffer<std::uint32_t> block(memory, "parameters", 32);
  std::size_t at = 0;
  for (const std::uint64_t address : addresses) {
    block[at++] = static_cast<std::uint32_t>(address >> 32);
    block[at++] = static_cast<std::uint32_t>(address);
  }
  for (const std::uint32_t word : words) block[at++] = word;
  return block;
}

std::uint32_t bits_of(float value) {
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

TEST(SpuProgram, ScalesAStreamInTypedBuffers) {
  constexpr std::uint32_t kCount = 5024;
  for (const Case& each : cases()) {
    const KernelImage image = load_program("scale_stream" + each.optimisation);
    dma::AddressSpace memory;
    dma::Buffer<float> in(memory, "in", kCount), out(memory, "out", kCount);
    for (std::uint32_t i = 0; i < kCount; ++i) in[i] = static_cast<float>(i);
    const auto block =
        parameter_block(memory, {in.ea().value, out.ea().value}, {kCount, bits_of(0.5f), bits_of(3.0f)});
    SpeGroup group(memory, {.spes = 1, .schedule = each.schedule});
    group.start(0, image, {.argp = block.ea().value});
    const RunResult result = group.wait(0);
    ASSERT_TRUE(result.ended_normally()) << (result.fault ? result.fault->message() : "");
    for (std::uint32_t i = 0; i < kCount; ++i) ASSERT_EQ(out[i], 0.5f * static_cast<float>(i) + 3.0f) << i;
    EXPECT_EQ(group.statistics(0).dma.get.commands + group.statistics(0).dma.put.commands, 7u);
    EXPECT_EQ(group.statistics(0).dma.get.bytes + group.statistics(0).dma.put.bytes, 40320u);
    if (each.optimisation == ".O2") {
      EXPECT_EQ(group.statistics(0).instructions, 17905u);
    }
  }
}

TEST(SpuProgram, WithDebugInformationFailsAtALine) {
  const KernelImage image = load_program("scale_stream.debug");
  dma::AddressSpace memory;
  SpeGroup group(memory, {.spes = 1});
  group.start(0, image, {});  // its parameters are fetched from address 0
  const RunResult result = group.wait(0);
  ASSERT_TRUE(result.fault.has_value());
  EXPECT_EQ(result.fault->rule, dma::Rule::kEaNotMapped);
  EXPECT_EQ(result.fault->place, "scale_stream.cpp:12");
  EXPECT_EQ(result.last_instructions.back(), "0x000C0  main + 0x40  wrch $ch21,$9  scale_stream.cpp:12");
}

TEST(SpuProgram, GathersRecordsByAList) {
  constexpr std::uint32_t kRecords = 256, kPicked = 96;
  for (const Case& each : cases()) {
    const KernelImage image = load_program("gather_list" + each.optimisation);
    dma::AddressSpace memory;
    dma::Buffer<std::uint32_t> table(memory, "table", kRecords * 4), indices(memory, "indices", kPicked),
        out(memory, "out", kPicked * 4);
    for (std::uint32_t i = 0; i < kRecords * 4; ++i) table[i] = i * 2654435761u;
    for (std::uint32_t i = 0; i < kPicked; ++i) indices[i] = (i * 37 + 11) % kRecords;
    const auto block =
        parameter_block(memory, {table.ea().value, indices.ea().value, out.ea().value}, {kPicked});
    SpeGroup group(memory, {.spes = 1, .schedule = each.schedule});
    group.start(0, image, {.argp = block.ea().value});
    const RunResult result = group.wait(0);
    ASSERT_TRUE(result.ended_normally()) << (result.fault ? result.fault->message() : "");
    for (std::uint32_t i = 0; i < kPicked * 4; ++i) ASSERT_EQ(out[i], table[indices[i / 4] * 4 + i % 4]) << i;
  }
}

TEST(SpuProgram, CountsOnSixSpesAtOnce) {
  constexpr std::uint32_t kTimes = 500;
  for (const Case& each : cases()) {
    const KernelImage image = load_program("atomic_count" + each.optimisation);
    dma::AddressSpace memory;
    dma::Buffer<std::uint32_t> counter(memory, "counter", 32);
    SpeGroup group(memory, {.spes = 6, .schedule = each.schedule});
    for (int spe = 0; spe < 6; ++spe) group.start(spe, image, {.argp = counter.ea().value, .envp = kTimes});
    for (int spe = 0; spe < 6; ++spe) EXPECT_TRUE(group.wait(spe).ended_normally());
    EXPECT_EQ(counter[0], 6 * kTimes);
  }
}

TEST(SpuProgram, AnswersInItsMailbox) {
  for (const Case& each : cases()) {
    const KernelImage image = load_program("mailbox_echo" + each.optimisation);
    dma::AddressSpace memory;
    SpeGroup group(memory, {.spes = 1, .schedule = each.schedule});
    group.start(0, image, {});
    ProblemState& spe = group.problem_state(0);
    spe.write_in_mbox(0x12345678);
    EXPECT_EQ(spe.wait_out_mbox(), 0xE195D3B7u);
    spe.write_in_mbox(1);
    EXPECT_EQ(spe.wait_out_mbox(), 0x7FFFFFFFu);
    spe.write_in_mbox(0);
    EXPECT_TRUE(group.wait(0).ended_normally());
  }
}

TEST(SpuProgram, ComputesVectorsToTheBit) {
  const std::vector<std::byte> input = read_bytes("vector_math.in.bin"),
                               expected = read_bytes("vector_math.expected.bin");
  for (const Case& each : cases()) {
    const KernelImage image = load_program("vector_math" + each.optimisation);
    dma::AddressSpace memory;
    dma::Buffer<std::byte> in(memory, "in", input.size()), out(memory, "out", expected.size());
    std::ranges::copy(input, in.data());
    SpeGroup group(memory, {.spes = 1, .schedule = each.schedule});
    group.start(0, image, {.argp = in.ea().value, .envp = out.ea().value});
    EXPECT_TRUE(group.wait(0).ended_normally());
    EXPECT_TRUE(std::ranges::equal(out.span(), expected)) << each.optimisation;
  }
}

// ---- how runs end

RunResult run_words(const std::vector<std::uint32_t>& words, const SpeOptions& options = {.spes = 1},
                    const EntryArguments& arguments = {}) {
  const KernelImage image = program_of(words);
  dma::AddressSpace memory;
  SpeGroup group(memory, options);
  group.start(0, image, arguments);
  return group.wait(0);
}

TEST(Interpreter, StartsAsLibspe2Does) {
  // The upper words of $3 to $6 and the stack pointer, summed up in the stop code's place: each is compared by a halt.
  const RunResult result =
      run_words({ri10(heqi, 0, 3, 0), rr(rotqby, 10, 3, 9), ri7(rotqbyi, 10, 3, 4), ri10(ceqi, 11, 10, 5),
                 ri10(heqi, 0, 11, 0), ri7(rotqbyi, 10, 6, 4), ri18(ila, 12, 0),
                 opcode(ilhu) | 0xF000u << 7 | 12, rr(heq, 0, 10, 12), stop_with(0x2007)},
                {.spes = 1}, {.spe_id = 0x100000005, .argp = 1, .envp = 2});
  ASSERT_TRUE(result.fault.has_value());  // the last halt finds the local store's address, as it should
  EXPECT_EQ(result.fault->rule, dma::Rule::kKernelHalt);
  EXPECT_NE(result.fault->detail.find("0x000A0"), std::string::npos) << result.fault->detail;
}

TEST(Interpreter, StartsAsThreadGroupsDo) {
  const RunResult result = run_words({ri7(rotqbyi, 10, 6, 4), ri10(heqi, 0, 10, 77), stop_with(0x2000)},
                                     {.spes = 1}, {.fourth = 77, .entry_state = EntryState::kThreadGroup});
  ASSERT_TRUE(result.fault.has_value());
  EXPECT_EQ(result.fault->rule, dma::Rule::kKernelHalt);
}

TEST(Interpreter, ReportsZeroedMemoryWithTheWayThere) {
  const RunResult result =
      run_words({ri16(il, 3, 1), ri16(brnz, 3, 3), 0x40200000, 0x40200000, ri16(il, 4, 2), 0});
  ASSERT_TRUE(result.fault.has_value());
  EXPECT_EQ(result.fault->rule, dma::Rule::kStopZero);
  ASSERT_EQ(result.last_instructions.size(), 4u);
  EXPECT_EQ(result.last_instructions[0], "0x00080  il $3,1");
  EXPECT_EQ(result.last_instructions[1], "0x00084  brnz $3,0x90");
  EXPECT_EQ(result.last_instructions[2], "0x00090  il $4,2");
  EXPECT_EQ(result.last_instructions[3], "0x00094  stop 0");
}

TEST(Interpreter, KeepsThirtyTwoInstructionsOfALoop) {
  const RunResult result =
      run_words({ri16(il, 3, 100), ri10(ai, 3, 3, -1), ri16(brnz, 3, -1), ri10(hgti, 0, 3, -1)});
  ASSERT_TRUE(result.fault.has_value());
  EXPECT_EQ(result.fault->rule, dma::Rule::kKernelHalt);
  ASSERT_EQ(result.last_instructions.size(), 32u);
  EXPECT_EQ(result.last_instructions[31], "0x0008C  hgti $0,$3,-1");
  EXPECT_EQ(result.last_instructions[30], "0x00088  brnz $3,0x84");
  EXPECT_EQ(result.last_instructions[29], "0x00084  ai $3,$3,-1");
  EXPECT_EQ(result.last_instructions[0], "0x00088  brnz $3,0x84");
}

TEST(Interpreter, NamesAnIllegalInstruction) {
  const RunResult result = run_words({0x40200000, 0xAF123456});
  ASSERT_TRUE(result.fault.has_value());
  EXPECT_EQ(result.fault->rule, dma::Rule::kIllegalInstruction);
  EXPECT_NE(result.fault->detail.find("0x00084"), std::string::npos);
  EXPECT_NE(result.fault->detail.find("0xAF123456"), std::string::npos);
}

TEST(Interpreter, EndsAnEndlessLoopAndSaysWhere) {
  using namespace std::chrono_literals;
  for (const std::vector<std::uint32_t>& words :
       {std::vector<std::uint32_t>{ri16(br, 0, 0)}, {ri18(ila, 3, 0x80), rr(bi, 0, 3)}}) {
    const RunResult result = run_words(words, {.spes = 1, .deadline = 50ms});
    ASSERT_TRUE(result.fault.has_value());
    EXPECT_EQ(result.fault->rule, dma::Rule::kDeadlineExceeded);
    EXPECT_NE(result.fault->detail.find("0x0008"), std::string::npos) << result.fault->detail;
    EXPECT_EQ(result.last_instructions.size(), 32u);
  }
}

TEST(Interpreter, EndsARoundThroughAllOfTheLocalStore) {
  using namespace std::chrono_literals;
  // A local store of nops: execution wraps around at 256 KB.
  const std::vector<std::uint32_t> nops(dma::kLocalStoreBytes / 4 - 4, 0x40200000);
  KernelImage image = program_of(nops, 0);
  image.entry = 0x100;
  dma::AddressSpace memory;
  SpeGroup group(memory, {.spes = 1, .deadline = 50ms});
  group.prepare(0, image, {});
  const std::uint32_t nop_bytes = 0x00002040;
  std::vector<std::byte> last(16);
  for (int i = 0; i < 4; ++i) std::memcpy(&last[4 * i], &nop_bytes, 4);
  group.problem_state(0).write_local_store({dma::kLocalStoreBytes - 16}, last);
  group.start(0);
  const RunResult result = group.wait(0);
  ASSERT_TRUE(result.fault.has_value());
  // The entry state wrote a back chain over the nops at the top, or the run would go on to its deadline.
  EXPECT_TRUE(result.fault->rule == dma::Rule::kDeadlineExceeded ||
              result.fault->rule == dma::Rule::kStopZero);
}

TEST(Interpreter, ExecutesWhatItHasWritten) {
  EXPECT_EQ(run_words(overwrites_its_code(opcode(sync))).stop_code, 0x2005u);
}

TEST(Interpreter, RefusesChannelsThatDoNotExist) {
  const RunResult result = run_words({rr(rdch, 3, 50)});
  ASSERT_TRUE(result.fault.has_value());
  EXPECT_EQ(result.fault->rule, dma::Rule::kIllegalChannel);
}

TEST(Interpreter, GivesSrr0BackAndTakesAnInterrupt) {
  // Enables the event of a mailbox, and interrupts with a branch; the handler at 0 stops.
  std::vector<std::uint32_t> words(0x80 / 4, 0x40200000);
  words[0] = stop_with(0x2009);
  const std::vector<std::uint32_t> main = {ri16(il, 3, 0x10), rr(wrch, 3, 1), ri18(ila, 4, 0x90), 0x40200000,
                                           rr(bi, 0, 4, kEnableInterrupts)};
  words.insert(words.end(), main.begin(), main.end());
  KernelImage image = program_of(words, 0);
  image.entry = 0x80;
  dma::AddressSpace memory;
  SpeGroup group(memory, {.spes = 1});
  group.start(0, image, {});
  group.problem_state(0).write_in_mbox(1);
  EXPECT_EQ(group.wait(0).stop_code, 0x2009u);
}

TEST(Interpreter, TakesTheDecrementersInterruptInSimulatedTime) {
  // Enables the decrementer's event, starts it with 1,000 ticks, and jumps on the spot; the handler at 0 stops.
  constexpr std::uint32_t kDecrementerEvent = 0x20, kWriteDecrementer = 7;
  std::vector<std::uint32_t> words(0x80 / 4, 0x40200000);
  words[0] = stop_with(0x2009);
  const std::vector<std::uint32_t> main = {
      ri16(il, 3, kDecrementerEvent), rr(wrch, 3, 1),     ri16(il, 5, 1000),
      rr(wrch, 5, kWriteDecrementer), ri18(ila, 4, 0x94), rr(bi, 0, 4, kEnableInterrupts)};
  words.insert(words.end(), main.begin(), main.end());
  KernelImage image = program_of(words, 0);
  image.entry = 0x80;
  Timing timing(1);
  dma::AddressSpace memory;
  SpeGroup group(memory, {.spes = 1,
                          .deadline = std::chrono::seconds(20),
                          .clock = Clock::kSimulated,
                          .interleaving = Interleaving::kByTime,
                          .timing = &timing});
  group.start(0, image, {});
  EXPECT_EQ(group.wait(0).stop_code, 0x2009u);
  constexpr double kCycles = 1000 * 3.2e9 / 79.8e6;
  EXPECT_NEAR(static_cast<double>(timing.now(0)), kCycles, 100);
}

TEST(Interpreter, RunsAgainAsLinked) {
  // Adds 1 to a word of its own image and halts if it was not the first time.
  const std::vector<std::uint32_t> words = {ri16(lqa, 3, 0xA0 / 4),
                                            ri10(heqi, 0, 3, 8),
                                            ri10(ai, 3, 3, 1),
                                            ri16(stqa, 3, 0xA0 / 4),
                                            stop_with(0x2000),
                                            0,
                                            0,
                                            0,
                                            7,
                                            0,
                                            0,
                                            0};
  const KernelImage image = program_of(words);
  dma::AddressSpace memory;
  SpeGroup group(memory, {.spes = 1});
  for (int i = 0; i < 3; ++i) {
    group.start(0, image, {});
    EXPECT_TRUE(group.wait(0).ended_normally()) << i;
  }
}

TEST(Interpreter, RunsNoJobs) {
  const KernelImage image = program_of({stop_with(0x2000)});
  dma::AddressSpace memory;
  SpeGroup group(memory, {.spes = 1});
  EXPECT_THROW(group.start_resident(0, image, {}), std::invalid_argument);
  EXPECT_THROW(group.register_job_image(dma::kMainMemoryBase, image), std::invalid_argument);
}

// ---- byte order

/// Gets `bytes` from argp to 0x1000 and puts them to envp.
std::vector<std::uint32_t> copying(std::uint32_t bytes, std::uint32_t offset) {
  return {ri18(ila, 10, 0x1000 + offset),
          rr(wrch, 10, 16),
          rr(wrch, 4, 17),
          ri7(rotqbyi, 11, 4, 4),
          rr(wrch, 11, 18),
          ri18(ila, 12, bytes),
          rr(wrch, 12, 19),
          ri16(il, 13, 1),
          rr(wrch, 13, 20),
          ri16(il, 14, 0x40),
          rr(wrch, 14, 21),
          ri16(il, 15, 2),
          rr(wrch, 15, 22),
          rr(wrch, 15, 23),
          rr(rdch, 16, 24),
          rr(wrch, 10, 16),
          rr(wrch, 5, 17),
          ri7(rotqbyi, 11, 5, 4),
          rr(wrch, 11, 18),
          rr(wrch, 12, 19),
          rr(wrch, 13, 20),
          ri16(il, 14, 0x20),
          rr(wrch, 14, 21),
          rr(wrch, 15, 22),
          rr(wrch, 15, 23),
          rr(rdch, 16, 24),
          stop_with(0x2000)};
}

template <class T>
void expect_swapped_and_back(std::uint32_t bytes, std::uint32_t offset) {
  dma::AddressSpace memory;
  dma::Buffer<T> in(memory, "in", 256), out(memory, "out", 256);
  for (std::size_t i = 0; i < 256; ++i) in[i] = static_cast<T>(0x0102030405060708ull * (i + 1));
  const KernelImage image = program_of(copying(bytes, offset));
  SpeGroup group(memory, {.spes = 1});
  group.start(0, image, {.argp = in.ea().value + offset, .envp = out.ea().value + offset});
  const RunResult result = group.wait(0);
  ASSERT_TRUE(result.ended_normally()) << (result.fault ? result.fault->message() : "");
  const auto* const local =
      reinterpret_cast<const std::uint8_t*>(group.problem_state(0).local_store().data()) + 0x1000;
  for (std::uint32_t at = offset; at < offset + bytes; ++at) {
    const auto shift = 8 * (sizeof(T) - 1 - at % sizeof(T));
    EXPECT_EQ(local[at], static_cast<std::uint8_t>(static_cast<std::uint64_t>(in[at / sizeof(T)]) >> shift))
        << "byte " << at << " of elements of " << sizeof(T);
    // What came back is the same number, as far as it was copied.
    const auto byte_of = [&](const dma::Buffer<T>& from) {
      return static_cast<std::uint8_t>(static_cast<std::uint64_t>(from[at / sizeof(T)]) >> shift);
    };
    EXPECT_EQ(byte_of(out), byte_of(in)) << at;
  }
}

TEST(ByteOrder, OfTypedBuffersChangesOnTheWay) {
  expect_swapped_and_back<std::uint32_t>(256, 0);
  expect_swapped_and_back<std::uint16_t>(48, 16);
  expect_swapped_and_back<std::uint64_t>(160, 80);
  expect_swapped_and_back<std::uint8_t>(32, 0);
}

TEST(ByteOrder, OfPartsOfElementsIsTheirs) {
  expect_swapped_and_back<std::uint32_t>(1, 6);
  expect_swapped_and_back<std::uint32_t>(2, 2);
  expect_swapped_and_back<std::uint64_t>(4, 12);
  expect_swapped_and_back<std::uint64_t>(8, 8);
  expect_swapped_and_back<std::uint16_t>(4, 4);
}

TEST(ByteOrder, OfSignalsAndMailIsThatOfNumbers) {
  // SPE 0 sends the word at 0xDC to a signal register of SPE 1 (argp), which puts it into its mailbox.
  std::vector<std::uint32_t> sends = {
      ri18(ila, 10, 0xDC), rr(wrch, 10, 16),   rr(wrch, 4, 17),  ri7(rotqbyi, 11, 4, 4),
      rr(wrch, 11, 18),    ri16(il, 12, 4),    rr(wrch, 12, 19), ri16(il, 13, 1),
      rr(wrch, 13, 20),    ri16(il, 14, 0xA0), rr(wrch, 14, 21), ri16(il, 15, 2),
      rr(wrch, 15, 22),    rr(wrch, 15, 23),   rr(rdch, 16, 24), stop_with(0x2000)};
  while (0x80 + 4 * sends.size() < 0xDC) sends.push_back(0x40200000);
  sends.push_back(0x12345678);
  const KernelImage sender = program_of(sends);
  const KernelImage receiver = program_of({rr(rdch, 3, 3), rr(wrch, 3, 28), stop_with(0x2000)});
  dma::AddressSpace memory;
  SpeGroup group(memory, {.spes = 2});
  group.start(1, receiver, {});
  group.start(0, sender, {.argp = dma::local_store_ea(1).value + 0x5400C});
  EXPECT_TRUE(group.wait(0).ended_normally());
  EXPECT_EQ(group.problem_state(1).wait_out_mbox(), 0x12345678u);
  EXPECT_TRUE(group.wait(1).ended_normally());
}

TEST(ByteOrder, OfProxyCommandsIsThatOfTheProgram) {
  dma::AddressSpace memory;
  dma::Buffer<std::uint32_t> numbers(memory, "numbers", 4);
  numbers[0] = 0x01020304;
  const KernelImage image = program_of({ri16(lqa, 3, 0x1000 / 4), rr(wrch, 3, 28), stop_with(0x2000)});
  SpeGroup group(memory, {.spes = 1});
  group.prepare(0, image, {});
  const dma::MfcCommand get{.word = 0x40, .lsa = {0x1000}, .ea = numbers.ea(), .size = 16, .tag = 3};
  EXPECT_FALSE(group.problem_state(0).issue_proxy(get).has_value());
  group.problem_state(0).wait_proxy(1u << 3);
  group.start(0);
  EXPECT_TRUE(group.wait(0).ended_normally());
  EXPECT_EQ(group.problem_state(0).read_out_mbox(), 0x01020304u);
}

TEST(ByteOrder, OfRawBuffersStays) {
  dma::AddressSpace memory;
  struct Mixed {
    std::uint64_t a;
    std::uint32_t b, c;
  };
  dma::Buffer<Mixed> in(memory, "in", 8), out(memory, "out", 8);
  for (std::size_t i = 0; i < 8; ++i) in[i] = {i * 0x0102030405060708ull, 5, 6};
  const KernelImage image = program_of(copying(128, 0));
  SpeGroup group(memory, {.spes = 1});
  group.start(0, image, {.argp = in.ea().value, .envp = out.ea().value});
  EXPECT_TRUE(group.wait(0).ended_normally());
  EXPECT_EQ(std::memcmp(in.data(), group.problem_state(0).local_store().data() + 0x1000, 128), 0);
  EXPECT_EQ(std::memcmp(in.data(), out.data(), 128), 0);
}

}  // namespace
}  // namespace softcell::ls_sim::interpreter
