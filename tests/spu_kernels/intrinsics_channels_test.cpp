// Channels, DMA, halts, loads and stores: what kernels ask of the gate, seen from a stack inside a local
// store.
#include <array>
#include <cstring>
#include <functional>

#include <spu_mfcio.h>

#include "intrinsics_support.h"
#include "local_store_thread.h"

namespace softcell::test {
namespace {

using softcell_sdk::kCount;
using softcell_sdk::kHalt;
using softcell_sdk::kRead;
using softcell_sdk::kStop;
using softcell_sdk::kSync;
using softcell_sdk::kTagStatus;
using softcell_sdk::kWrite;

class IntrinsicsChannels : public ::testing::Test {
 protected:
  LocalStoreThread spe_;

  /// The one call that `kernel` makes.
  GateCall only(std::function<void()> kernel) {
    const auto calls = spe_.run(std::move(kernel));
    EXPECT_EQ(calls.size(), 1u);
    return calls.empty() ? GateCall{} : calls.front();
  }
  void expect_read(std::uint32_t channel, std::function<std::uint32_t()> kernel, std::uint32_t kind = kRead) {
    spe_.answer = [](const GateCall&) { return 0xCAFE0000u; };
    std::uint32_t got = 0;
    const GateCall call = only([&] { got = kernel(); });
    EXPECT_EQ(got, 0xCAFE0000u);
    EXPECT_EQ(call.kind, kind);
    EXPECT_EQ(call.channel, channel);
  }
  void expect_count(std::uint32_t channel, std::function<std::uint32_t()> kernel) {
    expect_read(channel, std::move(kernel), kCount);
  }
  void expect_write(std::uint32_t channel, std::uint32_t value, std::function<void()> kernel) {
    const GateCall call = only(std::move(kernel));
    EXPECT_EQ(call.kind, std::uint32_t{kWrite});
    EXPECT_EQ(call.channel, channel);
    EXPECT_EQ(call.value, value);
  }
};

TEST_F(IntrinsicsChannels, ChannelsByNumber) {
  expect_read(29, [] { return spu_readch(SPU_RdInMbox); });
  expect_read(3, [] { return spu_extract(spu_readchqw(SPU_RdSigNotify1), 0); });
  expect_count(21, [] { return spu_readchcnt(MFC_Cmd); });
  expect_write(28, 77, [] { spu_writech(SPU_WrOutMbox, 77u); });
  expect_write(28, 78, [] { spu_writechqw(SPU_WrOutMbox, (vec_uint4{78u, 1u, 2u, 3u})); });
  expect_read(127, [] { return si_to_uint(si_rdch(127)); });
  expect_count(0, [] { return si_to_uint(si_rchcnt(0)); });
  expect_write(23, 2, [] { si_wrch(MFC_WrTagUpdate, si_from_uint(2)); });
}

TEST_F(IntrinsicsChannels, StopsAndHalts) {
  EXPECT_EQ(only([] { spu_stop(0x2001); }).value, 0x2001u);
  EXPECT_EQ(only([] { si_stop(0x3FFE); }).kind, std::uint32_t{kStop});
  EXPECT_EQ(only([] { si_stopd(qword(vec_uint4{}), qword(vec_uint4{}), qword(vec_uint4{})); }).value,
            0x3FFFu);

  const auto halts = [&](std::function<void()> kernel) {
    const auto calls = spe_.run(std::move(kernel));
    EXPECT_LE(calls.size(), 1u);
    return !calls.empty() && calls.front().kind == kHalt;
  };
  EXPECT_TRUE(halts([] { spu_hcmpeq(-1, -1); }));
  EXPECT_FALSE(halts([] { spu_hcmpeq(1u, 2u); }));
  EXPECT_TRUE(halts([] { spu_hcmpgt(1, -1); }));
  EXPECT_FALSE(halts([] { spu_hcmpgt(1u, -1); })) << "the first operand decides: unsigned";
  const auto q = [](int w) { return qword(vec_int4{w, w + 1, w + 2, w + 3}); };
  EXPECT_TRUE(halts([&] { si_heq(q(5), q(5)); }));
  EXPECT_FALSE(halts([&] { si_heq(q(5), q(6)); }));
  EXPECT_TRUE(halts([&] { si_hgt(q(1), q(-1)); }));
  EXPECT_FALSE(halts([&] { si_hlgt(q(1), q(-1)); }));
  EXPECT_TRUE(halts([&] { si_hlgt(q(-1), q(1)); }));
  EXPECT_TRUE(halts([&] { si_heqi(q(-512), -512); }));
  EXPECT_TRUE(halts([&] { si_hgti(q(0), -1); }));
  EXPECT_FALSE(halts([&] { si_hlgti(q(0), -1); }));
}

TEST_F(IntrinsicsChannels, BarriersAndHintsAskNothing) {
  const auto calls = spe_.run([] {
    spu_dsync();
    spu_idisable();
    si_dsync();
    si_nop();
    si_lnop();
    mfc_end_critical_section(mfc_begin_critical_section());
  });
  EXPECT_TRUE(calls.empty());
}

TEST_F(IntrinsicsChannels, ASyncIsSaidToTheEmulator) {
  EXPECT_EQ(only([] { spu_sync(); }).kind, std::uint32_t{kSync});
  EXPECT_EQ(only([] { spu_sync_c(); }).kind, std::uint32_t{kSync});
  EXPECT_EQ(only([] { si_sync(); }).kind, std::uint32_t{kSync});
  EXPECT_EQ(only([] { si_syncc(); }).kind, std::uint32_t{kSync});
}

TEST_F(IntrinsicsChannels, DmaParametersWaitForTheCommand) {
  const auto calls = spe_.run([] {
    spu_writech(MFC_LSA, 1u);
    spu_writech(MFC_EAH, 2u);
    spu_writech(MFC_EAL, 3u);
    spu_writech(MFC_Size, 4u);
    spu_writech(MFC_TagID, 5u);
    spu_writech(MFC_Cmd, 6u);
  });
  ASSERT_EQ(calls.size(), 1u) << "the parameters are no calls";
  const GateCall& c = calls[0];
  EXPECT_EQ((std::array{c.lsa, c.eah, c.eal, c.size, c.tag, c.value}), (std::array{1u, 2u, 3u, 4u, 5u, 6u}));
}

constexpr std::uint64_t kEa = 0x0000001234567890;
constexpr std::uint32_t kLs = 0x1230;

TEST_F(IntrinsicsChannels, Transfers) {
  void* const ls = spe_.at(kLs);
  const auto expect = [&](std::uint32_t opcode, std::function<void()> kernel) {
    const GateCall c = only(std::move(kernel));
    EXPECT_EQ((std::array{c.kind, c.channel, c.value}),
              (std::array{std::uint32_t{kWrite}, 21u, 7u << 24 | 9u << 16 | opcode}));
    EXPECT_EQ((std::array{c.lsa, c.eah, c.eal, c.size, c.tag}),
              (std::array{kLs, 0x12u, 0x34567890u, 4096u, 31u}));
  };
  expect(0x20, [&] { mfc_put(ls, kEa, 4096, 31, 7, 9); });
  expect(0x21, [&] { mfc_putb(ls, kEa, 4096, 31, 7, 9); });
  expect(0x22, [&] { mfc_putf(ls, kEa, 4096, 31, 7, 9); });
  expect(0x40, [&] { mfc_get(ls, kEa, 4096, 31, 7, 9); });
  expect(0x41, [&] { mfc_getb(ls, kEa, 4096, 31, 7, 9); });
  expect(0x42, [&] { mfc_getf(ls, kEa, 4096, 31, 7, 9); });
}

TEST_F(IntrinsicsChannels, ListsAreAddressedInLocalStore) {
  void* const ls = spe_.at(kLs);
  const void* const list = spe_.at(0x400);
  const auto expect = [&](std::uint32_t opcode, std::function<void()> kernel) {
    const GateCall c = only(std::move(kernel));
    EXPECT_EQ((std::array{c.channel, c.value}), (std::array{21u, opcode}));
    EXPECT_EQ((std::array{c.lsa, c.eah, c.eal, c.size, c.tag}), (std::array{kLs, 0x12u, 0x400u, 64u, 2u}));
  };
  expect(0x24, [&] { mfc_putl(ls, kEa, list, 64, 2, 0, 0); });
  expect(0x25, [&] { mfc_putlb(ls, kEa, list, 64, 2, 0, 0); });
  expect(0x26, [&] { mfc_putlf(ls, kEa, list, 64, 2, 0, 0); });
  expect(0x44, [&] { mfc_getl(ls, kEa, list, 64, 2, 0, 0); });
  expect(0x45, [&] { mfc_getlb(ls, kEa, list, 64, 2, 0, 0); });
  expect(0x46, [&] { mfc_getlf(ls, kEa, list, 64, 2, 0, 0); });
  expect(0x44, [&] { mfc_getl(ls, kEa, 0x400u, 64, 2, 0, 0); });
  const mfc_list_element_t element = {1, 0, 16384, 0x89ABCDEF};
  std::array<std::uint32_t, 2> words{};
  std::memcpy(words.data(), &element, sizeof element);
  EXPECT_EQ(words, (std::array{0x80004000u, 0x89ABCDEFu}))
      << "the MFC's words: stall bit on top, size at the bottom";
}

TEST_F(IntrinsicsChannels, LinesSignalsAndOrder) {
  void* const ls = spe_.at(kLs);
  // opcode, size, tag, ls and ea or not
  const auto expect = [&](std::uint32_t opcode, std::uint32_t size, std::uint32_t tag, bool with_ls,
                          bool with_ea, std::function<void()> kernel) {
    const GateCall c = only(std::move(kernel));
    EXPECT_EQ((std::array{c.channel, c.value & 0xFFFF, c.size, c.tag}), (std::array{21u, opcode, size, tag}));
    EXPECT_EQ(c.lsa, with_ls ? kLs : 0u);
    EXPECT_EQ(c.eah, with_ea ? 0x12u : 0u);
    EXPECT_EQ(c.eal, with_ea ? 0x34567890u : 0u);
  };
  expect(0xD0, 128, 0, true, true, [&] { mfc_getllar(ls, kEa, 0, 0); });
  expect(0xB4, 128, 0, true, true, [&] { mfc_putllc(ls, kEa, 0, 0); });
  expect(0xB0, 128, 0, true, true, [&] { mfc_putlluc(ls, kEa, 0, 0); });
  expect(0xB8, 128, 6, true, true, [&] { mfc_putqlluc(ls, kEa, 6, 0, 0); });
  expect(0xA0, 4, 6, true, true, [&] { mfc_sndsig(ls, kEa, 6, 0, 0); });
  expect(0xA1, 4, 6, true, true, [&] { mfc_sndsigb(ls, kEa, 6, 0, 0); });
  expect(0xA2, 4, 6, true, true, [&] { mfc_sndsigf(ls, kEa, 6, 0, 0); });
  expect(0xC0, 0, 6, false, false, [&] { mfc_barrier(6); });
  expect(0xC8, 0, 6, false, false, [&] { mfc_eieio(6, 0, 0); });
  expect(0xCC, 0, 6, false, false, [&] { mfc_sync(6); });
  expect(0x80, 256, 6, false, true, [&] { mfc_sdcrt(kEa, 256, 6, 0, 0); });
  expect(0x81, 256, 6, false, true, [&] { mfc_sdcrtst(kEa, 256, 6, 0, 0); });
  expect(0x89, 256, 6, false, true, [&] { mfc_sdcrz(kEa, 256, 6, 0, 0); });
  expect(0x8D, 256, 6, false, true, [&] { mfc_sdcrst(kEa, 256, 6, 0, 0); });
  expect(0x8F, 256, 6, false, true, [&] { mfc_sdcrf(kEa, 256, 6, 0, 0); });
}

TEST_F(IntrinsicsChannels, NamedChannels) {
  expect_read(12, [] { return mfc_read_tag_mask(); });
  expect_read(24, [] { return mfc_read_tag_status(); });
  expect_read(25, [] { return mfc_read_list_stall_status(); });
  expect_read(27, [] { return mfc_read_atomic_status(); });
  expect_read(3, [] { return spu_read_signal1(); });
  expect_read(4, [] { return spu_read_signal2(); });
  expect_read(29, [] { return spu_read_in_mbox(); });
  expect_read(8, [] { return spu_read_decrementer(); });
  expect_read(0, [] { return spu_read_event_status(); });
  expect_read(11, [] { return spu_read_event_mask(); });
  expect_read(13, [] { return spu_read_machine_status(); });
  expect_read(15, [] { return spu_read_srr0(); });
  expect_count(21, [] { return mfc_stat_cmd_queue(); });
  expect_count(23, [] { return mfc_stat_tag_update(); });
  expect_count(24, [] { return mfc_stat_tag_status(); });
  expect_count(25, [] { return mfc_stat_list_stall_status(); });
  expect_count(27, [] { return mfc_stat_atomic_status(); });
  expect_count(9, [] { return mfc_stat_multi_src_sync_request(); });
  expect_count(3, [] { return spu_stat_signal1(); });
  expect_count(4, [] { return spu_stat_signal2(); });
  expect_count(29, [] { return spu_stat_in_mbox(); });
  expect_count(28, [] { return spu_stat_out_mbox(); });
  expect_count(30, [] { return spu_stat_out_intr_mbox(); });
  expect_count(0, [] { return spu_stat_event_status(); });
  expect_write(23, 0x1234567, [] { mfc_write_tag_update(0x1234567); });
  expect_write(26, 0x1234567, [] { mfc_write_list_stall_ack(0x1234567); });
  expect_write(28, 0x1234567, [] { spu_write_out_mbox(0x1234567); });
  expect_write(30, 0x1234567, [] { spu_write_out_intr_mbox(0x1234567); });
  expect_write(7, 0x1234567, [] { spu_write_decrementer(0x1234567); });
  expect_write(1, 0x1234567, [] { spu_write_event_mask(0x1234567); });
  expect_write(2, 0x1234567, [] { spu_write_event_ack(0x1234567); });
  expect_write(14, 0x1234567, [] { spu_write_srr0(0x1234567); });
  expect_write(9, 0, [] { mfc_write_multi_src_sync_request(); });
  expect_write(23, 0, [] { mfc_write_tag_update_immediate(); });
  expect_write(23, 1, [] { mfc_write_tag_update_any(); });
  expect_write(23, 2, [] { mfc_write_tag_update_all(); });
}

TEST_F(IntrinsicsChannels, WaitingForTagsIsOneCallWithTheCondition) {
  const auto expect = [&](std::uint32_t condition, std::function<std::uint32_t()> kernel) {
    spe_.answer = [](const GateCall&) { return 0x55u; };
    std::uint32_t got = 0;
    const GateCall call = only([&] { got = kernel(); });
    EXPECT_EQ((std::array{call.kind, call.value, got}),
              (std::array{std::uint32_t{kTagStatus}, condition, 0x55u}));
  };
  expect(0, [] { return mfc_read_tag_status_immediate(); });
  expect(1, [] { return mfc_read_tag_status_any(); });
  expect(2, [] { return mfc_read_tag_status_all(); });
  expect(2, [] { return spu_mfcstat(MFC_TAG_UPDATE_ALL); });
}

TEST_F(IntrinsicsChannels, TheTagMaskWaitsInTheEnvironment) {
  const GateCall call = only([] {
    mfc_write_tag_mask(0x1234567);
    si_wrch(MFC_WrTagMask, si_from_uint(0x80000001));
    mfc_read_tag_status_all();
  });
  EXPECT_EQ(call.tag_mask, 0x80000001u);
}

TEST_F(IntrinsicsChannels, CompositesTakeRawCommands) {
  const GateCall c = only([&] { spu_mfcdma64(spe_.at(0x3FFF0), 1, 2, 16, 3, MFC_GET_CMD); });
  EXPECT_EQ((std::array{c.lsa, c.eah, c.eal, c.size, c.tag, c.value}),
            (std::array{0x3FFF0u, 1u, 2u, 16u, 3u, 0x40u}));
  EXPECT_EQ(only([&] { spu_mfcdma32(spe_.at(0x80), 2, 16, 3, MFC_PUT_CMD); }).eah, 0u);
}

TEST_F(IntrinsicsChannels, MemoryIsReadAgainAfterACall) {
  auto* const word = reinterpret_cast<std::uint32_t*>(spe_.at(0x100));
  *word = 1;
  spe_.answer = [&](const GateCall&) { return *word = 2; };
  std::uint32_t before = 0, after = 0;
  spe_.run([&] {
    before = *word;
    mfc_read_tag_status_all();
    after = *word;
  });
  EXPECT_EQ(before, 1u);
  EXPECT_EQ(after, 2u);
}

TEST_F(IntrinsicsChannels, EffectiveAddressesSplitAndJoin) {
  EXPECT_EQ(mfc_ea2h(kEa), 0x12u);
  EXPECT_EQ(mfc_ea2l(kEa), 0x34567890u);
  EXPECT_EQ(mfc_hl2ea(0x12, 0x34567890), kEa);
  EXPECT_EQ(mfc_ceil128(1), 128);
  EXPECT_EQ(mfc_ceil128(256), 256);
}

TEST_F(IntrinsicsChannels, TagsAreHandedOutOnce) {
  std::uint32_t seen = 0;
  for (int i = 0; i < 32; ++i) {
    const unsigned int tag = mfc_tag_reserve();
    ASSERT_LT(tag, 32u);
    ASSERT_EQ(seen >> tag & 1, 0u);
    seen |= 1u << tag;
  }
  EXPECT_EQ(mfc_tag_reserve(), MFC_TAG_INVALID);
  EXPECT_EQ(mfc_tag_release(7), MFC_TAG_VALID);
  EXPECT_EQ(mfc_tag_release(7), MFC_TAG_INVALID) << "not reserved any more";
  EXPECT_EQ(mfc_multi_tag_reserve(2), MFC_TAG_INVALID) << "one is free, not two in a row";
  EXPECT_EQ(mfc_tag_reserve(), 7u);
  EXPECT_EQ(mfc_multi_tag_release(8, 4), MFC_TAG_VALID);
  EXPECT_EQ(mfc_multi_tag_reserve(4), 8u);
  EXPECT_EQ(mfc_multi_tag_reserve(33), MFC_TAG_INVALID);
  EXPECT_EQ(mfc_multi_tag_release(31, 2), MFC_TAG_INVALID);
  EXPECT_EQ(mfc_multi_tag_release(0, 32), MFC_TAG_VALID);
}

TEST_F(IntrinsicsChannels, LoadsAndStoresWrapAndIgnoreTheLowBits) {
  const vec_uint4 value{1u, 2u, 3u, 4u};
  std::memcpy(spe_.at(0x1000), &value, 16);
  const auto at = [](std::uint32_t address) { return si_from_uint(address); };
  vec_uint4 a, b, c, d;
  spe_.run([&] {
    a = vec_uint4(si_lqd(at(0x1025), -32));
    b = vec_uint4(si_lqx(at(0x40F00), at(0x100)));
    c = vec_uint4(si_lqa(0x1004));
    si_stqd(qword(value), at(0x2000), 16);
    si_stqx(qword(value), at(0x2000), at(0x2F));
    si_stqa(qword(value), 0x2030);
    const volatile void* const pointer = si_to_ptr(si_from_ptr(spe_.at(0x2010)));
    EXPECT_EQ(pointer, spe_.at(0x2010));
    EXPECT_EQ(si_to_ptr(si_from_ptr(nullptr)), nullptr);
    EXPECT_EQ(si_to_uint(si_from_ptr(spe_.at(0x2010))), 0x2010u);
    d = *const_cast<const vec_uint4*>(static_cast<const volatile vec_uint4*>(pointer));
  });
  for (const vec_uint4& got : {a, b, c, d}) EXPECT_EQ(lanes(got), lanes(value));
  EXPECT_EQ(std::memcmp(spe_.at(0x2020), &value, 16), 0);
  EXPECT_EQ(std::memcmp(spe_.at(0x2030), &value, 16), 0);
}

}  // namespace
}  // namespace softcell::test
