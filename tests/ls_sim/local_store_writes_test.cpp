// softcell never writes to the instructions in a local store by the host's memcpy, memmove or memset, which may use
// string instructions (dma/local_store_bytes.h says why). This program has its own versions of these functions, which
// record where they write.

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "softcell/base/sanitizers.h"
#include "softcell/dma/buffer.h"
#include "softcell/dma/local_store_bytes.h"
#include "softcell/dma/mfc.h"
#include "softcell/ls_sim/local_store.h"
#include "softcell/ls_sim/spe_group.h"
#include "test_images.h"

// Sanitizers have their own versions of these functions.
#if !SC_ADDRESS_SANITIZER && !SC_THREAD_SANITIZER

namespace {

struct Watched {
  std::atomic<std::uintptr_t> begin{0}, end{0};
};
std::array<Watched, 6> watched;
std::atomic<int> writes_seen{0};
std::atomic<std::size_t> largest_seen{0};

void look(const void* to, std::size_t bytes) {
  const auto begin = reinterpret_cast<std::uintptr_t>(to);
  for (const Watched& range : watched) {
    if (begin >= range.end.load(std::memory_order_relaxed) ||
        begin + bytes <= range.begin.load(std::memory_order_relaxed)) {
      continue;
    }
    ++writes_seen;
    if (bytes > largest_seen) largest_seen = bytes;
  }
}

}  // namespace

// The pointers are volatile, because the compiler would otherwise turn the loops into calls of these same functions.
extern "C" void* memmove(void* to, const void* from, std::size_t bytes) noexcept {
  look(to, bytes);
  auto* const out = static_cast<volatile char*>(to);
  const auto* const in = static_cast<const volatile char*>(from);
  if (reinterpret_cast<std::uintptr_t>(to) < reinterpret_cast<std::uintptr_t>(from)) {
    for (std::size_t i = 0; i < bytes; ++i) out[i] = in[i];
  } else {
    for (std::size_t i = bytes; i-- > 0;) out[i] = in[i];
  }
  return to;
}

extern "C" void* memcpy(void* __restrict to, const void* __restrict from, std::size_t bytes) noexcept {
  return memmove(to, from, bytes);
}

extern "C" void* memset(void* to, int value, std::size_t bytes) noexcept {
  look(to, bytes);
  auto* const out = static_cast<volatile char*>(to);
  for (std::size_t i = 0; i < bytes; ++i) out[i] = static_cast<char>(value);
  return to;
}

namespace softcell::ls_sim {
namespace {

class LocalStoreWrites : public testing::TestWithParam<const char*> {
 protected:
  LocalStoreWrites() {
    for (int spe = 0; spe < group_.spes(); ++spe) {
      const std::span<std::byte> bytes = group_.problem_state(spe).local_store();
      Watched& range = watched[static_cast<std::size_t>(spe)];
      range.begin = reinterpret_cast<std::uintptr_t>(bytes.data());
      range.end = reinterpret_cast<std::uintptr_t>(bytes.data() + bytes.size());
    }
    writes_seen = 0;
    largest_seen = 0;
  }
  ~LocalStoreWrites() override {
    for (Watched& range : watched) range.begin = range.end = 0;
  }

  void run(const char* kernel, const EntryArguments& arguments) {
    const KernelImage image = test_image(kernel);
    const SpeGroup::Outside ppu(group_);
    group_.start(0, image, arguments);
    group_.wait(0);
  }

  dma::AddressSpace memory_;
  dma::Buffer<std::uint32_t> data_{memory_, "data", 64 * 1024};
  SpeGroup group_{memory_, {.spes = 2, .schedule = dma::parse_schedule(GetParam())}};
};

TEST_P(LocalStoreWrites, AreSeenWhenTheyAreByTheHostsLibrary) {
  void* (*volatile move)(void*, const void*, std::size_t) = &std::memmove;
  move(group_.problem_state(1).local_store().data() + 4096, data_.data(), 4096);
  EXPECT_EQ(writes_seen, 1);
}

TEST_P(LocalStoreWrites, OfAllPathsGoByVectorStores) {
  // A kernel that executes a sync may fetch code to anywhere: from here on softcell makes no other kind of copy.
  run("computes", {.argp = 1, .envp = 1});
  // Loads, commands of 16384 bytes, lists, line commands, and repeated runs, which restore the initialised data.
  for (const char* const kernel :
       {"echo_arguments", "no_wait", "increments", "remembers", "padded", "leaves_a_stall"}) {
    for (int again = 0; again < 3; ++again) run(kernel, {.argp = data_.ea().value, .envp = 64});
  }
  // Proxy commands: the PPU's gets and puts.
  ProblemState& spe = group_.problem_state(0);
  for (const std::uint32_t bytes : {16u, 128u, 2048u, 16384u}) {
    ASSERT_FALSE(spe.issue_proxy({.word = static_cast<std::uint32_t>(dma::MfcOpcode::get),
                                  .lsa = {0x8000},
                                  .ea = data_.ea(),
                                  .size = bytes,
                                  .tag = 3}));
    spe.wait_proxy(1u << 3);
  }
  // A put from one local store to another, by a proxy command of the PPU, and the PPU's own writes.
  ASSERT_FALSE(spe.issue_proxy({.word = static_cast<std::uint32_t>(dma::MfcOpcode::put),
                                .lsa = {0x8000},
                                .ea = group_.problem_state(1).local_store_ea(),
                                .size = 16384,
                                .tag = 3}));
  spe.wait_proxy(1u << 3);
  spe.write_local_store({0x1000}, std::as_bytes(data_.span()).first(100'000));
  EXPECT_EQ(writes_seen, 0) << "the largest of " << largest_seen << " bytes";
}

TEST_P(LocalStoreWrites, OfThePpuMustFit) {
  EXPECT_THROW(group_.problem_state(0).write_local_store({dma::kLocalStoreBytes - 15},
                                                         std::as_bytes(data_.span()).first(16)),
               std::invalid_argument);
}

TEST(LocalStoreCode, IsWhereTheMfcHasBeenToldAndNowhereElse) {
  dma::AddressSpace memory;
  dma::Buffer<std::byte> data(memory, "data", dma::kMaxTransferBytes);
  LocalStore local_store;
  watched[0].begin = reinterpret_cast<std::uintptr_t>(local_store.base());
  watched[0].end = watched[0].begin + dma::kLocalStoreBytes;
  dma::Mfc mfc(local_store.bytes(), memory, dma::parse_schedule("eager"), 0, nullptr);
  const auto library_writes = [&](std::uint32_t lsa) {
    writes_seen = 0;
    EXPECT_FALSE(mfc.issue({.word = static_cast<std::uint32_t>(dma::MfcOpcode::get),
                            .lsa = {lsa},
                            .ea = data.ea(),
                            .size = 4096,
                            .tag = 0}));
    return writes_seen.load();
  };
  EXPECT_EQ(library_writes(0x8000), 0) << "it may be anywhere";
  mfc.confine_code({0x4000});
  EXPECT_EQ(library_writes(0x3000), 0);
  EXPECT_EQ(library_writes(0x4000), 1);
  mfc.expect_code_below({0x5000});
  mfc.expect_code_below({0x1000});
  EXPECT_EQ(library_writes(0x4000), 0);
  EXPECT_EQ(library_writes(0x5000), 1);
  mfc.expect_code_everywhere();
  EXPECT_EQ(library_writes(0x5000), 0);
  watched[0].begin = watched[0].end = 0;
}

INSTANTIATE_TEST_SUITE_P(Schedules, LocalStoreWrites, testing::Values("eager", "lazy", "random:3"));

}  // namespace
}  // namespace softcell::ls_sim

#endif

TEST(LocalStoreBytes, ArriveWholeFromAndToEveryOffset) {
  alignas(64) std::array<std::byte, 700> from{}, to{};
  for (std::size_t i = 0; i < from.size(); ++i) from[i] = static_cast<std::byte>(i * 7 + 1);
  for (const std::size_t bytes :
       {0u, 1u, 15u, 16u, 17u, 31u, 127u, 128u, 129u, 255u, 256u, 300u, 511u, 512u, 600u}) {
    for (std::size_t target = 0; target < 48; ++target) {
      for (const std::size_t source : {std::size_t{0}, target % 16, std::size_t{5}}) {
        to.fill(std::byte{0xEE});
        softcell::dma::copy_to_local_store(&to[target], &from[source], bytes);
        for (std::size_t i = 0; i < to.size(); ++i) {
          const bool inside = i >= target && i < target + bytes;
          ASSERT_EQ(to[i], inside ? from[source + i - target] : std::byte{0xEE})
              << bytes << " bytes from " << source << " to " << target << ", byte " << i;
        }
        softcell::dma::fill_local_store(&to[target], std::byte{0x11}, bytes);
        for (std::size_t i = 0; i < to.size(); ++i) {
          ASSERT_EQ(to[i], i >= target && i < target + bytes ? std::byte{0x11} : std::byte{0xEE})
              << bytes << " bytes to " << target << ", byte " << i;
        }
      }
    }
  }
}
