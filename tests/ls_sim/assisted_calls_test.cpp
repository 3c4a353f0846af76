// What calls of the C library return to a program on an SPE.

#include "assisted/assisted_calls.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <utility>
#include <vector>

#include "softcell/dma/addresses.h"

namespace softcell::ls_sim::assisted {
namespace {

/// Calls fwrite of `count` items of `size` bytes on standard output, which is `file` meanwhile. @return  what fwrite returns
std::uint32_t fwrite_to(const char* file, std::uint32_t size, std::uint32_t count) {
  std::vector<std::byte> local_store(dma::kLocalStoreBytes);
  constexpr std::uint32_t kRequest = 0x100, kData = 0x1000, kStandardOutput = 2;
  const std::uint32_t arguments[] = {kData, size, count, kStandardOutput};
  for (std::size_t i = 0; i < 4; ++i)
    std::memcpy(&local_store[kRequest + 16 * i], &arguments[i], sizeof arguments[i]);
  std::FILE* const to = std::fopen(file, "w");
  if (to == nullptr) return ~1u;
  std::setvbuf(to, nullptr, _IONBF, 0);
  std::FILE* const before = std::exchange(stdout, to);
  const std::uint32_t written = AssistedCalls(files_of_process(), local_store, CallerKind::kHost)
                                    .serve(kC99Call, std::uint32_t{C99Function::kFwrite} << 24 | kRequest);
  stdout = before;
  std::fclose(to);
  return written;
}

TEST(AssistedCalls, FwriteReturnsTheItemsThatWereWritten) {
  EXPECT_EQ(fwrite_to("/dev/null", 4, 25), 25u);
  EXPECT_EQ(fwrite_to("/dev/null", 0, 25), 0u);
}

TEST(AssistedCalls, AFwriteThatFailsHasWrittenNothing) {
  EXPECT_EQ(fwrite_to("/dev/full", 4, 25), 0u);
  EXPECT_EQ(fwrite_to("/dev/full", 1, 100), 0u);
}

struct Told {
  std::uint32_t lsa, bytes;
  bool is_store;
  bool operator==(const Told&) const = default;
};

/// What a listener hears of a call of the host's kind with these words as arguments.
std::vector<Told> told_of(std::vector<std::byte>& local_store, std::uint32_t function,
                          const std::vector<std::uint32_t>& arguments) {
  constexpr std::uint32_t kRequest = 0x100;
  for (std::size_t i = 0; i < arguments.size(); ++i)
    std::memcpy(&local_store[kRequest + 16 * i], &arguments[i], sizeof arguments[i]);
  std::vector<Told> told;
  AssistedCalls calls(files_of_process(), local_store, CallerKind::kHost);
  calls.set_listener([&](std::uint32_t lsa, std::uint32_t bytes, bool is_store) {
    if (lsa < kRequest || lsa >= kRequest + 64) told.push_back({lsa, bytes, is_store});
  });
  calls.serve(kC99Call, function << 24 | kRequest);
  return told;
}

TEST(AssistedCalls, TellWhatTheyReadAndWrite) {
  std::vector<std::byte> local_store(dma::kLocalStoreBytes);
  const auto set_text = [&](std::uint32_t lsa, const char* text) {
    std::memcpy(&local_store[lsa], text, std::strlen(text) + 1);
  };
  constexpr std::uint32_t kFormat = 0x1000, kTo = 0x2000, kList = 0x3000;
  set_text(kFormat, "eleven char");
  EXPECT_EQ(told_of(local_store, kVsprintf, {kTo, kFormat, kList}),
            (std::vector<Told>{{kFormat, 12, false}, {kTo, 12, true}}));
  EXPECT_EQ(told_of(local_store, kFwrite, {0x4000, 4, 25, 99}), (std::vector<Told>{{0x4000, 100, false}}));
  // Addresses wrap around.
  set_text(0x3FFFC, "abc");
  local_store[0x3FFFF] = std::byte{'d'};
  EXPECT_EQ(told_of(local_store, kRemove, {0x3FFFC}),
            (std::vector<Told>{{0x3FFFC, 4, false}, {0, 1, false}}));
}

}  // namespace
}  // namespace softcell::ls_sim::assisted
