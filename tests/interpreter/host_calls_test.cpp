// Calls of a program that the host serves.

#include "softcell/ls_sim/host_calls.h"

#include <gtest/gtest.h>

#include <bit>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "interpreter/assisted_calls.h"
#include "softcell/ls_sim/spe_group.h"
#include "spu_words.h"

namespace softcell::ls_sim::interpreter {
namespace {

constexpr std::uint32_t kArguments = 0x1000, kText = 0x4000, kVariable = 0x2000, kBuffer = 0x8000;

class HostCallsTest : public testing::Test {
 protected:
  HostCallsTest() {
    calls_.standard_output = [this](std::string_view text) { printed_ += text; };
    calls_.standard_error = [this](std::string_view text) { printed_ += "E:" + std::string(text); };
  }

  void set_argument(int number, std::uint32_t value) {
    memory_.set_word(kArguments + 16u * static_cast<unsigned>(number), value);
  }
  std::uint32_t text(const std::string& value) {
    const std::uint32_t at = next_text_;
    memory_.set_bytes(at, value);
    memory_.set_byte(at + static_cast<std::uint32_t>(value.size()), 0);
    next_text_ += static_cast<std::uint32_t>(value.size()) + 1;
    return at;
  }
  /// @return  what the call returns; error() is its errno.
  std::int32_t serve(std::uint32_t code, std::uint32_t opcode) {
    served_.serve(code, opcode << 24 | kArguments);
    return static_cast<std::int32_t>(memory_.word(kArguments));
  }
  int error() const { return static_cast<int>(memory_.word(kArguments + 12)); }
  std::int32_t open(const std::string& path, std::uint32_t flags) {
    set_argument(0, text(path));
    set_argument(1, flags);
    set_argument(2, 0644);
    return serve(kPosixCall, 15);
  }

  std::vector<std::byte> local_store_ = std::vector<std::byte>(dma::kLocalStoreBytes);
  CallMemory memory_{local_store_};
  HostCalls calls_;
  AssistedCalls served_{calls_, local_store_};
  std::string printed_;
  std::uint32_t next_text_ = kText;
};

TEST_F(HostCallsTest, PrintsWhatPrintfWould) {
  const std::string format = "%d|%5u|%-4x|%s|%c|%lld|%.3f|%05.1e|%%|%hd|%*d|%p\n";
  std::uint32_t at = kVariable;
  const auto word = [&](std::uint32_t value) { memory_.set_word(at, value), at += 16; };
  const auto doubleword = [&](std::uint64_t value) {
    memory_.set_word(at, static_cast<std::uint32_t>(value >> 32));
    memory_.set_word(at + 4, static_cast<std::uint32_t>(value));
    at += 16;
  };
  word(static_cast<std::uint32_t>(-7));
  word(42);
  word(0xBEEF);
  const std::uint32_t caller_stack = at;  // the caller's frame begins here: its header holds no argument
  at += 32;
  word(text("text"));
  word('z');
  doubleword(static_cast<std::uint64_t>(-1234567890123));
  doubleword(std::bit_cast<std::uint64_t>(2.0 / 3));
  doubleword(std::bit_cast<std::uint64_t>(12345.0));
  word(0x1FFFF);
  word(6);
  word(3);
  word(0x3FFF0);
  set_argument(0, text(format));
  set_argument(1, kVariable);
  set_argument(2, caller_stack);
  const std::int32_t returned = serve(kC99Call, 37);
  EXPECT_EQ(returned, static_cast<std::int32_t>(printed_.size()));
  EXPECT_EQ(printed_, "-7|   42|beef|text|z|-1234567890123|0.667|1.2e+04|%|-1|     3|0x3fff0\n");
}

TEST_F(HostCallsTest, PrintsLinesAndCharacters) {
  set_argument(0, text("line"));
  serve(kC99Call, 25);
  set_argument(0, 'x');
  EXPECT_EQ(serve(kC99Call, 24), 'x');
  set_argument(0, text("oops"));
  set_argument(1, 3);
  serve(kC99Call, 12);
  EXPECT_EQ(printed_, "line\nxE:oops");
}

TEST_F(HostCallsTest, FormatsIntoTheLocalStore) {
  set_argument(0, kBuffer);
  set_argument(1, 4);
  set_argument(2, text("%d"));
  set_argument(3, kVariable);
  set_argument(4, 0);
  memory_.set_word(kVariable, 123456);
  EXPECT_EQ(serve(kC99Call, 39), 6);
  EXPECT_EQ(memory_.text(kBuffer), "123");
}

TEST_F(HostCallsTest, HostileFormatsEnd) {
  for (const std::string& format :
       {std::string(5000, '%'), std::string("%99999999d"), std::string("%.99999999f"), std::string("%"),
        std::string("%l"), std::string("%n%Q"), std::string(3000, '#')}) {
    set_argument(0, text(format));
    set_argument(1, kVariable);
    set_argument(2, 0);
    serve(kC99Call, 37);
  }
  set_argument(0, dma::kLocalStoreBytes - 1);  // a text that passes the end goes on at 0
  serve(kC99Call, 25);
}

TEST_F(HostCallsTest, UnknownOnesFail) {
  EXPECT_EQ(serve(kC99Call, 31), -1);  // system
  EXPECT_EQ(error(), ENOSYS);
  EXPECT_EQ(serve(kPosixCall, 99), -1);
  EXPECT_EQ(error(), ENOSYS);
}

TEST_F(HostCallsTest, WithoutAFolderThereAreNoFiles) {
  EXPECT_EQ(open("a", 0), -1);
  EXPECT_EQ(error(), EACCES);
}

TEST_F(HostCallsTest, FilesStayInTheFolder) {
  const auto root = std::filesystem::path(testing::TempDir()) / "softcell_host_calls";
  std::filesystem::remove_all(root);
  std::filesystem::create_directories(root / "in");
  std::ofstream(root / "secret") << "secret";
  std::filesystem::create_symlink("../secret", root / "in" / "link");
  calls_.folder = root / "in";
  for (const std::string& outside :
       {std::string("../secret"), (root / "secret").string(), std::string("link")}) {
    EXPECT_EQ(open(outside, 0), -1) << outside;
    EXPECT_NE(error(), 0) << outside;
  }
  set_argument(0, text("../secret"));
  EXPECT_EQ(serve(kPosixCall, 24), -1);
  EXPECT_TRUE(std::filesystem::exists(root / "secret"));

  const std::int32_t file = open("new", 2 | 0100);  // O_RDWR | O_CREAT
  ASSERT_EQ(file, 3);
  set_argument(0, 3);
  set_argument(1, text("hello"));
  set_argument(2, 5);
  EXPECT_EQ(serve(kPosixCall, 27), 5);
  set_argument(0, 3);
  set_argument(1, 1);
  set_argument(2, 0);
  EXPECT_EQ(serve(kPosixCall, 9), 1);
  set_argument(0, 3);
  set_argument(1, kBuffer);
  set_argument(2, 100);
  EXPECT_EQ(serve(kPosixCall, 16), 4);
  EXPECT_EQ(memory_.text(kBuffer), "ello");
  set_argument(0, 3);
  EXPECT_EQ(serve(kPosixCall, 2), 0);
  set_argument(0, 3);
  EXPECT_EQ(serve(kPosixCall, 2), -1);
  EXPECT_EQ(error(), EBADF);
  set_argument(0, text("new"));
  EXPECT_EQ(serve(kPosixCall, 24), 0);
  EXPECT_FALSE(std::filesystem::exists(root / "in" / "new"));
  std::filesystem::remove_all(root);
}

/// puts() of a text in the program, and an end with the status 3.
std::vector<std::uint32_t> calling_puts() {
  return {stop_with(kC99Call),
          25u << 24 | 0x90,
          stop_with(0x2003),
          0x40200000,
          0xA0,
          0,
          0,
          0,            // the argument, at 0x90
          0x68690000};  // "hi", at 0xA0
}

TEST(HostCallsOfAProgram, AreServedAndItGoesOn) {
  std::string printed;
  HostCalls calls;
  calls.standard_output = [&](std::string_view text) { printed += text; };
  const KernelImage image = program_of(calling_puts());
  dma::AddressSpace memory;
  SpeGroup group(memory, {.spes = 1, .host_calls = &calls});
  group.start(0, image, {});
  EXPECT_EQ(group.wait(0).stop_code, 0x2003u);
  EXPECT_EQ(printed, "hi\n");
}

TEST(HostCallsOfAProgram, EndItIfNobodyServesThem) {
  const KernelImage image = program_of(calling_puts());
  dma::AddressSpace memory;
  SpeGroup group(memory, {.spes = 1});
  group.start(0, image, {});
  EXPECT_EQ(group.wait(0).stop_code, kC99Call);
}

}  // namespace
}  // namespace softcell::ls_sim::interpreter
