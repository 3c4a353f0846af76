#include "softcell/dma/translation_cache.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <variant>
#include <vector>

#include "softcell/dma/buffer.h"
#include "softcell/dma/mfc.h"

namespace softcell::dma {
namespace {

bool resolves(TranslationCache& cache, EffectiveAddress ea, std::uint64_t bytes, SpeAccess wanted) {
  return std::holds_alternative<std::byte*>(cache.resolve(ea, bytes, wanted));
}

TEST(TranslationCache, AnswersAsTheAddressSpaceDoes) {
  AddressSpace space;
  TranslationCache cache(space);
  // More buffers than the cache holds, so that entries are replaced and looked up again.
  std::vector<Buffer<char>> buffers;
  buffers.reserve(20);
  for (int i = 0; i < 20; ++i) {
    buffers.emplace_back(space, "b", 256,
                         BufferOptions{.spe_access = i % 2 == 0 ? SpeAccess::kRead : SpeAccess::kReadWrite});
  }
  for (int round = 0; round < 3; ++round) {
    for (const Buffer<char>& buffer : buffers) {
      for (const std::uint64_t offset : {0, 128, 240, 256}) {
        for (const SpeAccess wanted : {SpeAccess::kRead, SpeAccess::kWrite}) {
          const auto expected = space.resolve(buffer.ea() + offset, 16, wanted);
          const auto actual = cache.resolve(buffer.ea() + offset, 16, wanted);
          ASSERT_EQ(actual.index(), expected.index());
          if (const auto* pointer = std::get_if<std::byte*>(&expected)) {
            EXPECT_EQ(std::get<std::byte*>(actual), *pointer);
          } else {
            EXPECT_EQ(std::get<Fault>(actual).rule, std::get<Fault>(expected).rule);
          }
        }
      }
    }
  }
}

TEST(TranslationCache, ForgetsAFreedBuffer) {
  AddressSpace space;
  TranslationCache cache(space);
  Buffer<char> kept(space, "kept", 128);
  Buffer<char> freed(space, "freed", 128);
  const EffectiveAddress ea = freed.ea();
  EXPECT_TRUE(resolves(cache, ea, 128, SpeAccess::kWrite));
  freed = {};
  EXPECT_FALSE(resolves(cache, ea, 128, SpeAccess::kWrite));
  EXPECT_TRUE(resolves(cache, kept.ea(), 128, SpeAccess::kWrite));
}

TEST(TranslationCache, SeesANewBufferAtOnce) {
  AddressSpace space;
  TranslationCache cache(space);
  EXPECT_FALSE(resolves(cache, kMainMemoryBase, 128, SpeAccess::kRead));
  const Buffer<char> buffer(space, "new", 128);
  EXPECT_TRUE(resolves(cache, buffer.ea(), 128, SpeAccess::kRead));
}

// Six SPEs move bytes of their own buffers for as long as the PPU side allocates and frees others.
TEST(TranslationCache, SixMfcsLookUpWhileThePpuAllocates) {
  AddressSpace space;
  constexpr int kAllocations = 1000;
  std::atomic<bool> allocating{true};
  std::vector<int> issued(kSpeCount, 0);
  std::vector<int> moved(kSpeCount, 0);
  std::vector<std::thread> spes;
  spes.reserve(kSpeCount);
  for (int spe = 0; spe < kSpeCount; ++spe) {
    spes.emplace_back([&, spe] {
      std::vector<std::byte> store(kLocalStoreBytes);
      Mfc mfc(store, space, {Schedule::kRandom, 1}, static_cast<std::uint64_t>(spe));
      const Buffer<std::uint32_t> own(space, "own", 4096);
      for (int& i = issued[spe]; i == 0 || allocating.load(); ++i) {
        const auto word = static_cast<std::uint32_t>(i % 1024 * 4);
        const MfcOpcode opcode = i % 2 == 0 ? MfcOpcode::getf : MfcOpcode::putf;
        if (!mfc.issue({static_cast<std::uint32_t>(opcode), {word * 4}, own.ea(word), 16, 1})) ++moved[spe];
      }
      mfc.drain();
    });
  }
  for (int i = 0; i < kAllocations; ++i) {
    const Buffer<char> small(space, "small", 100);
    Buffer<char> large(space, "large", 10000);
    large[9999] = 1;
  }
  allocating = false;
  for (std::thread& spe : spes) spe.join();
  EXPECT_EQ(moved, issued);
  EXPECT_EQ(space.largest_free_range(Memory::kMain), kMainMemoryBytes);
}

}  // namespace
}  // namespace softcell::dma
