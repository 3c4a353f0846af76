// Main storage that is the memory of this process.

#include <sys/mman.h>

#include <array>
#include <atomic>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "softcell/dma/address_space.h"
#include "softcell/dma/host_allocations.h"
#include "softcell/dma/local_store_port.h"
#include "softcell/dma/mfc.h"

namespace softcell::dma {
namespace {

constexpr std::uint64_t kPage = 4096;

EffectiveAddress ea_of(const void* pointer) { return {reinterpret_cast<std::uint64_t>(pointer)}; }

/// Pages of this process, while the object lives.
class Pages {
 public:
  explicit Pages(std::uint64_t count, int protection = PROT_READ | PROT_WRITE)
      : bytes_(count * kPage),
        begin_(
            static_cast<std::byte*>(mmap(nullptr, bytes_, protection, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0))) {}
  ~Pages() { munmap(begin_, bytes_); }
  Pages(const Pages&) = delete;
  Pages& operator=(const Pages&) = delete;

  std::byte* begin() const { return begin_; }
  std::byte* page(std::uint64_t number) const { return begin_ + number * kPage; }

 private:
  std::uint64_t bytes_;
  std::byte* begin_;
};

struct Lost : ReservationListener {
  void on_reservation_lost() override { ++count; }
  std::atomic<int> count{0};
};

class HostProgramTest : public testing::Test {
 protected:
  std::optional<Rule> rule_of(const void* at, std::uint64_t bytes, SpeAccess wanted) {
    auto resolved = space_.resolve(ea_of(at), bytes, wanted);
    if (const Fault* fault = std::get_if<Fault>(&resolved)) {
      detail_ = fault->detail;
      return fault->rule;
    }
    EXPECT_EQ(std::get<std::byte*>(resolved), at);
    return std::nullopt;
  }
  std::optional<Fault> issue(MfcOpcode opcode, std::uint32_t lsa, const void* at, std::uint32_t size,
                             std::uint32_t tag = 0) {
    return mfc_.issue({.word = static_cast<std::uint32_t>(opcode),
                       .lsa = {lsa},
                       .ea = ea_of(at),
                       .size = size,
                       .tag = tag});
  }
  std::uint32_t atomic_status() { return std::get<std::uint32_t>(mfc_.read_atomic_status()); }

  AddressSpace space_{HostProgram{.spes = 8}};
  std::unique_ptr<std::array<std::byte, kLocalStoreBytes + kLineBytes>> bytes_ =
      std::make_unique<std::array<std::byte, kLocalStoreBytes + kLineBytes>>();
  std::byte* const store_ = bytes_->data() + (kLineBytes - ea_of(bytes_->data()).value % kLineBytes);
  Lost lost_;
  Mfc mfc_{std::span(store_, kLocalStoreBytes), space_, Schedule{}, 0, &lost_};
  std::string detail_;
};

TEST_F(HostProgramTest, APointerOfTheProgramIsAnEffectiveAddress) {
  alignas(128) std::array<std::uint32_t, 64> on_the_stack{};
  static std::array<std::uint32_t, 64> global;
  const auto on_the_heap = std::make_unique<std::array<std::uint32_t, 64>>();
  for (void* at : {static_cast<void*>(on_the_stack.data()), static_cast<void*>(global.data()),
                   static_cast<void*>(on_the_heap->data())}) {
    EXPECT_EQ(rule_of(at, 256, SpeAccess::kReadWrite), std::nullopt) << detail_;
  }
  for (std::uint32_t i = 0; i < 64; ++i) on_the_stack[i] = i * i;
  ASSERT_FALSE(issue(MfcOpcode::get, 0x100, on_the_stack.data(), 256));
  ASSERT_FALSE(issue(MfcOpcode::put, 0x100, global.data() - ea_of(global.data()).value % 16 / 4, 16));
  std::array<std::uint32_t, 64> arrived;
  std::memcpy(arrived.data(), store_ + 0x100, 256);
  EXPECT_EQ(arrived, on_the_stack);
}

TEST_F(HostProgramTest, WhatIsNotMappedIsAFault) {
  std::byte* gone;
  {
    const Pages pages(1);
    gone = pages.begin();
    EXPECT_EQ(rule_of(gone, kPage, SpeAccess::kReadWrite), std::nullopt);
  }
  EXPECT_EQ(rule_of(nullptr, 16, SpeAccess::kRead), Rule::kEaNotMapped);
  EXPECT_NE(detail_.find("null pointer"), std::string::npos) << detail_;
  EXPECT_EQ(rule_of(reinterpret_cast<void*>(0x1000), 16, SpeAccess::kRead), Rule::kEaNotMapped);
  EXPECT_NE(detail_.find("MFC_EAH"), std::string::npos) << detail_;
  EXPECT_EQ(rule_of(reinterpret_cast<void*>(0x7000'0000'0000'0000), 16, SpeAccess::kRead),
            Rule::kEaNotMapped);
  EXPECT_EQ(detail_.find("exchanged"), std::string::npos) << detail_;
}

/// What programs of the Cell SDK do: a union of a 64-bit number and two words, of which word 0 is the upper one on a Cell only.
TEST_F(HostProgramTest, ExchangedHalvesOfAnAddressAreNamed) {
  const Pages pages(1);
  const std::uint64_t ea = ea_of(pages.begin()).value, exchanged = ea << 32 | ea >> 32;
  EXPECT_EQ(rule_of(reinterpret_cast<void*>(exchanged), 16, SpeAccess::kRead), Rule::kEaNotMapped);
  EXPECT_NE(detail_.find("are the halves of EA exchanged?"), std::string::npos) << detail_;
}

TEST_F(HostProgramTest, PermissionsOfThePagesHold) {
  const Pages pages(3);
  mprotect(pages.page(1), kPage, PROT_READ);
  mprotect(pages.page(2), kPage, PROT_NONE);
  EXPECT_EQ(rule_of(pages.page(0), kPage, SpeAccess::kReadWrite), std::nullopt);
  EXPECT_EQ(rule_of(pages.page(1), kPage, SpeAccess::kRead), std::nullopt);
  EXPECT_EQ(rule_of(pages.page(1), 16, SpeAccess::kWrite), Rule::kEaNotWritable);
  EXPECT_EQ(rule_of(pages.page(2), 16, SpeAccess::kRead), Rule::kEaNotMapped);
  EXPECT_EQ(rule_of(pages.page(0), 2 * kPage, SpeAccess::kRead), std::nullopt) << "over two mappings";
  EXPECT_EQ(rule_of(pages.page(0), 2 * kPage, SpeAccess::kWrite), Rule::kEaNotWritable);
  EXPECT_NE(detail_.find("from the 4096th of 8192 bytes on"), std::string::npos) << detail_;
  mprotect(pages.page(1), kPage, PROT_READ | PROT_WRITE);
  EXPECT_EQ(rule_of(pages.page(1), 16, SpeAccess::kWrite), std::nullopt) << "the mappings are read anew";
}

TEST_F(HostProgramTest, BytesThatVanishWhileTheyMoveEndTheTransferAndNotTheProcess) {
  const Pages pages(5);
  ASSERT_FALSE(issue(MfcOpcode::get, 0, pages.page(0), 256)) << "now the MFC has the mapping in its cache";
  munmap(pages.page(1), 4 * kPage);
  for (const std::uint32_t size : {16u, 128u, 16384u}) {
    std::byte* const at = pages.page(1) - (size == 16384 ? 16 : 0);
    EXPECT_THROW(issue(MfcOpcode::get, 0, at, size), StorageLost) << size;
    EXPECT_THROW(issue(MfcOpcode::put, 0, at, size), StorageLost) << size;
  }
  EXPECT_THROW(issue(MfcOpcode::getllar, 0, pages.page(1), 128), StorageLost);
  EXPECT_FALSE(issue(MfcOpcode::put, 0, pages.page(0), 256)) << "the MFC goes on";
}

TEST_F(HostProgramTest, AFailureOfSomebodyElseStaysOne) {
  EXPECT_DEATH(*static_cast<volatile int*>(nullptr) = 1, "");
}

TEST_F(HostProgramTest, ItHasNoBuffers) {
  EXPECT_THROW(space_.allocate("b", 16), std::logic_error);
  EXPECT_THROW(space_.free({16}), std::logic_error);
  EXPECT_THROW(static_cast<void>(space_.free_bytes(Memory::kMain)), std::logic_error);
}

/// A local store where a host program's storage has it.
class Store final : public LocalStorePort {
 public:
  Store(AddressSpace& space, int spe) : bytes_(space.host_address_of_local_store(spe), kLocalStoreBytes) {
    mprotect(bytes_.data(), bytes_.size(), PROT_READ | PROT_WRITE);
  }
  std::span<std::byte> local_store() override { return bytes_; }
  void on_external_write(LocalStoreAddress lsa, std::uint32_t) override { written.push_back(lsa.value); }
  void on_register_write(SpeRegister which, std::uint32_t value) override {
    registers.emplace_back(which, value);
  }
  std::vector<std::uint32_t> written;
  std::vector<std::pair<SpeRegister, std::uint32_t>> registers;

 private:
  std::span<std::byte> bytes_;
};

TEST_F(HostProgramTest, ALocalStoreLiesBelow4GbAtItsOwnPointer) {
  Store store(space_, 7);
  const EffectiveAddress ea = space_.local_store_ea(7);
  EXPECT_EQ(ea.value >> 32, 0u);
  EXPECT_EQ(ea.value % kLocalStoreStrideBytes, 0u);
  EXPECT_EQ(ea_of(store.local_store().data()), ea);
  EXPECT_EQ(rule_of(store.local_store().data(), 16, SpeAccess::kWrite), Rule::kEaNotMapped);
  space_.map_local_store(7, store);
  ASSERT_FALSE(issue(MfcOpcode::put, 0x40, store.local_store().data() + 0x2000, 64));
  EXPECT_EQ(store.written, std::vector<std::uint32_t>{0x2000});
  const auto signal = reinterpret_cast<const void*>(ea.value + 0x5400C);
  const std::uint32_t value = 77;
  std::memcpy(store_ + 0x30C, &value, sizeof value);
  ASSERT_FALSE(issue(MfcOpcode::sndsig, 0x30C, signal, 4));
  ASSERT_EQ(store.registers.size(), 1u);
  EXPECT_EQ(store.registers[0], std::pair(SpeRegister::kSignal1, value));
  space_.unmap_local_store(7);
  EXPECT_THROW(space_.map_local_store(8, store), std::invalid_argument);
}

// ---- atomics

struct alignas(128) Line {
  std::array<std::uint32_t, 32> words{};
};

/// What a program for the Cell does with the offset that its SPU side has sent: here that is a pointer.
TEST_F(HostProgramTest, ALocalStoreAndAPointerIntoOneAreNoAddress) {
  const EffectiveAddress one = space_.local_store_ea(1), two = space_.local_store_ea(2);
  const auto detail_at = [&](std::uint64_t ea) {
    auto resolved = space_.resolve({ea}, 16, SpeAccess::kWrite);
    const Fault* const fault = std::get_if<Fault>(&resolved);
    return fault == nullptr || fault->rule != Rule::kEaNotMapped ? "" : fault->detail;
  };
  const char* const hint = "its kernel sends (unsigned)pointer & 0x3FFFF";
  EXPECT_NE(detail_at(one.value + two.value + 0x1E00).find(hint), std::string::npos);
  EXPECT_EQ(detail_at(one.value + two.value + kLocalStoreBytes).find(hint), std::string::npos);
}

TEST_F(HostProgramTest, APlainStoreOfAHostThreadLosesTheReservation) {
  Line line;
  ASSERT_FALSE(issue(MfcOpcode::getllar, 0, &line, 128));
  EXPECT_EQ(atomic_status(), 4u);
  line.words[5] = 9;
  ASSERT_FALSE(issue(MfcOpcode::putllc, 0, &line, 128));
  EXPECT_EQ(atomic_status(), 1u) << "failed";
  EXPECT_EQ(line.words[5], 9u);
  ASSERT_FALSE(issue(MfcOpcode::getllar, 0, &line, 128));
  atomic_status();
  line.words[6] = 1;
  mfc_.look_for_host_stores();
  EXPECT_EQ(lost_.count, 1) << "as the event LR";
  mfc_.look_for_host_stores();
  EXPECT_EQ(lost_.count, 1);
}

TEST_F(HostProgramTest, APutllcStoresTheQuadwordsThatItChanges) {
  Line line;
  ASSERT_FALSE(issue(MfcOpcode::getllar, 0, &line, 128));
  atomic_status();
  const std::uint32_t value = 42;
  for (const std::uint32_t word : {0u, 4u, 31u}) std::memcpy(store_ + word * 4, &value, 4);
  ASSERT_FALSE(issue(MfcOpcode::putllc, 0, &line, 128));
  EXPECT_EQ(atomic_status(), 0u);
  EXPECT_EQ(line.words[0], 42u);
  EXPECT_EQ(line.words[4], 42u);
  EXPECT_EQ(line.words[31], 42u);
}

TEST_F(HostProgramTest, SpesAndHostThreadsCountOnTheSameLine) {
  constexpr std::uint32_t kRounds = 20000;
  Line line;
  std::atomic<bool> go{false};
  const auto count_by_mfc = [&](std::uint32_t word) {
    auto store = std::make_unique<std::array<Line, kLocalStoreBytes / sizeof(Line)>>();
    auto* const bytes = reinterpret_cast<std::byte*>(store->data());
    Mfc mfc(std::span(bytes, kLocalStoreBytes), space_, Schedule{}, word + 1);
    while (!go) std::this_thread::yield();
    for (std::uint32_t i = 0; i < kRounds;) {
      ASSERT_FALSE(mfc.issue({.word = 0xD0, .lsa = {0}, .ea = ea_of(&line), .size = 128}));
      static_cast<void>(mfc.read_atomic_status());
      ++(*store)[0].words[word];
      ASSERT_FALSE(mfc.issue({.word = 0xB4, .lsa = {0}, .ea = ea_of(&line), .size = 128}));
      if (std::get<std::uint32_t>(mfc.read_atomic_status()) == 0) ++i;
    }
  };
  const auto count_by_host = [&](std::uint32_t word) {
    while (!go) std::this_thread::yield();
    for (std::uint32_t i = 0; i < kRounds; ++i)
      std::atomic_ref(line.words[word]).fetch_add(1, std::memory_order_relaxed);
  };
  std::vector<std::jthread> threads;
  threads.emplace_back(count_by_mfc, 0);
  threads.emplace_back(count_by_mfc, 0);
  threads.emplace_back(count_by_host, 0);  // the same word
  threads.emplace_back(count_by_host, 7);  // and one in another quadword
  go = true;
  threads.clear();
  EXPECT_EQ(line.words[0], 3 * kRounds);
  EXPECT_EQ(line.words[7], kRounds);
}

// ---- allocations

class Blocks final : public HostAllocations {
 public:
  std::optional<HostAllocation> last_at_or_below(std::uint64_t address) const override {
    return address < block.begin ? std::nullopt : std::optional(block);
  }
  bool owns(std::uint64_t address) const override { return address - heap < 0x1000; }
  std::uint64_t generation() const override { return ended; }

  std::uint64_t heap = 0;
  HostAllocation block;
  std::uint64_t ended = 0;
};

TEST_F(HostProgramTest, ACommandStaysWithinAnAllocation) {
  const Pages pages(1);
  Blocks blocks;
  blocks.heap = ea_of(pages.begin()).value;
  blocks.block = {.begin = blocks.heap + 256, .bytes = 100, .made_at = "make_particles+0x40"};
  space_.set_allocations(&blocks);
  std::byte* const block = pages.begin() + 256;
  EXPECT_FALSE(issue(MfcOpcode::get, 0, block, 112)) << "up to the quadword of its last byte";
  EXPECT_FALSE(issue(MfcOpcode::get, 0, block + 96, 4 * 4));
  for (const auto& [at, size] : {std::pair(block, 128u), std::pair(block + 112, 16u),
                                 std::pair(block - 16, 16u), std::pair(block - 16, 32u)}) {
    const auto fault = issue(MfcOpcode::put, 0, at, size);
    ASSERT_TRUE(fault) << at - block << " " << size;
    EXPECT_EQ(fault->rule, Rule::kEaOutsideAllocation) << fault->message();
  }
  EXPECT_NE(issue(MfcOpcode::put, 0, block, 128)->detail.find("allocated by make_particles+0x40"),
            std::string::npos);
  blocks.block.live = false;
  ++blocks.ended;
  const auto fault = issue(MfcOpcode::get, 0, block, 16);
  ASSERT_TRUE(fault) << "the MFC keeps no copy of a block that was freed";
  EXPECT_EQ(fault->rule, Rule::kEaOutsideAllocation);
  EXPECT_NE(fault->detail.find("was freed"), std::string::npos) << fault->detail;
  space_.set_allocations(nullptr);
}

}  // namespace
}  // namespace softcell::dma
