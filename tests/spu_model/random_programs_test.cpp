// Random programs through the whole engine, which decodes ahead and keeps what it has decoded, against the
// model: the same local store at the end. A program loads all registers, computes, loads, stores and branches
// for a while, stores all registers and stops.

#include <gtest/gtest.h>

#include <cstring>
#include <string_view>
#include <vector>

#include "softcell/ls_sim/engine.h"
#include "softcell/ls_sim/local_store.h"
#include "spu_model/operands.h"

namespace softcell::spu_model {
namespace {

constexpr std::uint32_t kCode = 0x80;
constexpr std::uint32_t kData = 0x8000;  // what registers are loaded from, then what programs store to
constexpr std::uint32_t kDataBytes = 0x4000;
constexpr std::uint32_t kRegistersAtTheEnd = kData + kDataBytes;
constexpr std::uint32_t kStackTop = 0x3FFF0;
// These registers only the program's frame writes.
constexpr std::uint32_t kDataPointer = 126, kCounter = 127, kFreeRegisters = 126;

class RandomProgram {
 public:
  explicit RandomProgram(std::uint64_t seed) : random_(seed) {
    for (std::uint32_t n = 0; n < 128; ++n) {
      add("lqa", {.rt = n, .immediate = static_cast<std::int64_t>((kData + 16 * n) / 4)});
    }
    add("ila", {.rt = kDataPointer, .immediate = kData + kDataBytes / 2});
    for (int loop = 0; loop < 8; ++loop) {
      add("il", {.rt = kCounter, .immediate = 1 + below(6)});
      const std::size_t first = words_.size();
      const std::int64_t length = 20 + below(60);
      for (std::int64_t i = 0; i < length; ++i) add_something();
      // A branch out of the loop's middle lands here at the latest.
      for (int i = 0; i < kFarthest; ++i) add("nop", {});
      add("ai", {.rt = kCounter, .ra = kCounter, .immediate = -1});
      add("brnz", {.rt = kCounter, .immediate = -static_cast<std::int64_t>(words_.size() - first)});
    }
    for (std::uint32_t n = 0; n < 128; ++n) {
      add("stqa", {.rt = n, .immediate = static_cast<std::int64_t>((kRegistersAtTheEnd + 16 * n) / 4)});
    }
    add("fscrrd", {.rt = 0});
    add("stqa", {.rt = 0, .immediate = static_cast<std::int64_t>((kRegistersAtTheEnd + 16 * 128) / 4)});
    words_.push_back(0x2000);  // stop
  }

  /// Code, a gap and random data.
  ls_sim::KernelImage image() {
    std::vector<std::uint8_t> bytes;
    for (const std::uint32_t word : words_) {
      for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(word >> shift));
    }
    const auto code_end = static_cast<std::uint32_t>(kCode + bytes.size());
    bytes.resize(kData - kCode);
    for (std::uint32_t i = 0; i < kDataBytes / 16; ++i) {
      const Quadword value = random_quadword(static_cast<Kind>(below(3)), random_);
      bytes.insert(bytes.end(), value.bytes.begin(), value.bytes.end());
    }
    ls_sim::KernelImage image;
    image.name = "random";
    image.machine = ls_sim::Machine::kSpu;
    image.begin = kCode;
    image.bytes.resize(bytes.size());
    std::memcpy(image.bytes.data(), bytes.data(), bytes.size());
    image.entry = image.text_begin = kCode;
    image.text_end = code_end;
    image.data_begin = kData;
    image.data_end = kData + kDataBytes;
    image.sizes.from = kCode;
    image.sizes.end = image.data_end;
    return image;
  }

 private:
  static constexpr int kFarthest = 8;  // instructions that a branch leaves out, at most

  std::int64_t below(std::uint64_t limit) { return static_cast<std::int64_t>(random_() % limit); }
  std::uint32_t free_register() { return static_cast<std::uint32_t>(random_() % kFreeRegisters); }
  void add(std::string_view mnemonic, const Fields& fields) { words_.push_back(encode(mnemonic, fields)); }

  void add_something() {
    const std::uint32_t rt = free_register();
    switch (below(12)) {
      case 0:
        return add("stqd", {.rt = rt, .ra = kDataPointer, .immediate = below(1024)});
      case 1:
        return add("lqd", {.rt = rt, .ra = kDataPointer, .immediate = below(1024)});
      case 2: {
        constexpr std::string_view kBranches[] = {"brz", "brnz", "brhz", "brhnz"};
        return add(kBranches[below(4)], {.rt = rt, .immediate = 1 + below(kFarthest)});
      }
      case 3:
        return add(below(2) == 0 ? "br" : "brsl", {.rt = rt, .immediate = 1 + below(kFarthest)});
      case 4:
        return add("lqx", {.rt = rt, .ra = free_register(), .rb = free_register()});
      default:
        break;
    }
    const Instruction* row = nullptr;
    do {
      row = &instructions()[random_() % instructions().size()];
    } while (row->action != nullptr || is_enhanced_double(*row));
    add(row->mnemonic, {.rt = rt,
                        .ra = free_register(),
                        .rb = free_register(),
                        .rc = free_register(),
                        .immediate = static_cast<std::int64_t>(random_())});
  }

  Random random_;
  std::vector<std::uint32_t> words_;
};

/// Programs here touch no channel.
class NoChannels final : public ls_sim::ChannelPort {
 public:
  ls_sim::ChannelReply read(std::uint32_t) override { return {}; }
  ls_sim::ChannelReply write(std::uint32_t, std::uint32_t) override { return {}; }
  ls_sim::ChannelReply count(std::uint32_t) override { return {}; }
  ls_sim::ChannelReply issue(const dma::MfcCommand&) override { return {}; }
  void sync() override {}
};

TEST(InterpreterEngine, AgreesWithTheModelOnRandomPrograms) {
  constexpr std::uint64_t kPrograms = 300;
  constexpr int kMost = 100000;  // instructions of one
  ls_sim::LocalStore local_store;
  const auto engine = ls_sim::make_interpreter_engine(local_store, {});
  NoChannels channels;
  Machine model;
  for (std::uint64_t seed = 0; seed < kPrograms; ++seed) {
    RandomProgram program(seed);
    const ls_sim::KernelImage image = program.image();
    engine->load(image);
    const auto bytes = local_store.bytes();
    model = Machine{};
    std::memcpy(model.local_store.data(), bytes.data(), bytes.size());
    model.store(kStackTop, {});  // whoever starts a program ends its chain of frames
    model.pc = image.entry;

    const ls_sim::RunResult found = engine->run({.entry_state = ls_sim::EntryState::kThreadGroup}, channels);
    ASSERT_FALSE(found.fault) << found.fault->message();
    StepResult expected;
    for (int i = 0; i < kMost && expected.outcome == Outcome::kNext; ++i) expected = step(model);
    ASSERT_EQ(expected, (StepResult{Outcome::kStop, 0x2000}));
    ASSERT_EQ(found.stop_code, expected.stop_code);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      ASSERT_EQ(std::to_integer<std::uint8_t>(bytes[i]), model.local_store[i])
          << "program " << seed << ", local store at " << std::hex << i;
    }
  }
}

}  // namespace
}  // namespace softcell::spu_model
