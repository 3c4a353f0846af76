#include "softcell/dma/mfc_command.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace softcell::dma {
namespace {

struct OpcodeRow {
  std::string name;
  std::uint32_t code;
};

const OpcodeRow kOpcodes[] = {
#define SC_MFC_OPCODE(name, code) {#name, code},
#include "softcell/dma/mfc_opcodes.def"
#undef SC_MFC_OPCODE
};

MfcCommand of(std::uint32_t word) { return {.word = word}; }

TEST(MfcOpcode, HasTheNameAndNumberOfTheManual) {
  EXPECT_EQ(std::size(kOpcodes), 39u);
  EXPECT_EQ(name(MfcOpcode{0x20}), "put");
  EXPECT_EQ(name(MfcOpcode{0x32}), "putrf");
  EXPECT_EQ(name(MfcOpcode{0x41}), "getb");
  EXPECT_EQ(name(MfcOpcode{0x46}), "getlf");
  EXPECT_EQ(name(MfcOpcode{0xB4}), "putllc");
  EXPECT_EQ(name(MfcOpcode{0xD0}), "getllar");
}

TEST(MfcOpcode, HasNoNameWhenItIsNoCommand) {
  std::set<std::uint32_t> known;
  for (const OpcodeRow& row : kOpcodes) known.insert(row.code);
  for (std::uint32_t code = 0; code < 0x400; ++code) {
    EXPECT_EQ(name(static_cast<MfcOpcode>(code)).empty(), !known.contains(code)) << std::hex << code;
  }
}

TEST(MfcCommand, PredicatesFollowFromTheName) {
  for (const auto& [name, code] : kOpcodes) {
    const bool is_atomic = name.find("ll") != std::string::npos;  // getllar, putllc, ...
    const bool get = name.starts_with("get") && !is_atomic;
    const bool put = name.starts_with("put") && !is_atomic;
    const bool ordered = get || put || name.starts_with("sndsig");
    EXPECT_EQ(of(code).is_get(), get) << name;
    EXPECT_EQ(of(code).is_put(), put) << name;
    EXPECT_EQ(of(code).has_fence(), (ordered && name.find('f') != std::string::npos) || name == "putqlluc")
        << name;
    EXPECT_EQ(of(code).has_barrier(),
              (ordered && name.find('b') != std::string::npos) || name == "mfceieio" || name == "mfcsync")
        << name;
    EXPECT_EQ(of(code).is_queue_barrier(), name == "barrier") << name;
  }
}

TEST(MfcCommand, KindFollowsFromTheName) {
  for (const auto& [name, code] : kOpcodes) {
    CommandKind kind = CommandKind::kTransfer;
    if (name == "putqlluc") {
      kind = CommandKind::kQueuedLine;
    } else if (name.find("ll") != std::string::npos) {
      kind = CommandKind::kLine;
    } else if (name.starts_with("sndsig")) {
      kind = CommandKind::kSignal;
    } else if (name.starts_with("sdcr")) {
      kind = CommandKind::kCacheHint;
    } else if (name == "barrier" || name.starts_with("mfc")) {
      kind = CommandKind::kOrdering;
    } else if (name.find('l') != std::string::npos) {
      kind = CommandKind::kList;
    } else if (name.ends_with('s')) {
      kind = CommandKind::kStart;
    }
    EXPECT_EQ(of(code).kind(), kind) << name;
  }
  for (const std::uint32_t code : {0x00u, 0x23u, 0x27u, 0x33u, 0x38u, 0x43u, 0x4Cu, 0xA3u, 0xD1u}) {
    EXPECT_EQ(of(code).kind(), CommandKind::kUnknown) << std::hex << code;
  }
}

TEST(MfcCommand, ClassHintsChangeNothing) {
  const MfcCommand hinted = of(0x12340042);
  EXPECT_EQ(hinted.opcode(), MfcOpcode::getf);
  EXPECT_TRUE(hinted.has_fence());
}

}  // namespace
}  // namespace softcell::dma
