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

}  // namespace
}  // namespace softcell::ls_sim::assisted
