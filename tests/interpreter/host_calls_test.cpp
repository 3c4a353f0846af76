// Calls of a program that the host serves.

#include "softcell/ls_sim/host_calls.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "assisted/assisted_calls.h"
#include "softcell/ls_sim/spe_group.h"
#include "spu_words.h"

namespace softcell::ls_sim::assisted {
namespace {

using interpreter::program_of;
using interpreter::stop_with;

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
    memory_.set_bytes(at, value + '\0');
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
  std::atomic<bool> interrupted_ = false;
  FilesInFolder files_{calls_, interrupted_};
  AssistedCalls served_{files_, local_store_, CallerKind::kSpu};
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

TEST_F(HostCallsTest, WritesHowManyCharactersThereAreSoFar) {
  constexpr std::uint32_t kCounts = kVariable + 256;
  memory_.set_word(kCounts, 0xFFFF'FFFF);
  std::uint32_t at = kVariable;
  for (const std::uint32_t argument : {kCounts, 7u, kCounts + 2}) {
    memory_.set_word(at, argument);
    at += 16;
  }
  set_argument(0, text("abc%hhn|%d%hn"));
  set_argument(1, kVariable);
  set_argument(2, kVariable + 128);
  EXPECT_EQ(serve(kC99Call, 37), 5);
  EXPECT_EQ(printed_, "abc|7");
  EXPECT_EQ(memory_.word(kCounts), 0x03FF'0005u);
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
  using namespace std::string_literals;
  constexpr std::size_t kMostWidth = 4096;  // and the most digits; the arguments are 0
  const std::pair<std::string, std::string> formats[] = {
      {std::string(5000, '%'), std::string(2500, '%')},
      {"%99999999d", std::string(kMostWidth - 1, ' ') + "0"},
      {"%*d", "0"},
      {"%.99999999f", "0." + std::string(kMostWidth, '0')},
      {"%", "%"},
      {"%l", "%l"},
      {"ab%n%Q", "ab%Q"},
      {std::string(3000, '#'), std::string(3000, '#')}};
  for (const auto& [format, expected] : formats) {
    printed_.clear();
    set_argument(0, text(format));
    set_argument(1, kVariable);
    set_argument(2, 0);
    std::vector<std::byte> before = local_store_;
    EXPECT_EQ(serve(kC99Call, 37), static_cast<std::int32_t>(expected.size())) << format.substr(0, 20);
    EXPECT_EQ(printed_, expected);
    // Only the result, and where %n points: to 0.
    std::copy_n(local_store_.begin() + kArguments, 16, before.begin() + kArguments);
    if (format.find("%n") != std::string::npos) {
      EXPECT_EQ(memory_.word(0), 2u);
      memory_.set_word(0, 0);
    }
    EXPECT_TRUE(before == local_store_) << format.substr(0, 20);
  }
  printed_.clear();
  memory_.set_bytes(dma::kLocalStoreBytes - 1, "xy"s);  // a text that passes the end goes on at 0
  set_argument(0, dma::kLocalStoreBytes - 1);
  EXPECT_EQ(serve(kC99Call, 25), 3);
  EXPECT_EQ(printed_, "xy\n");
}

TEST_F(HostCallsTest, ATextWithoutAnEndEnds) {
  std::fill(local_store_.begin(), local_store_.end(), std::byte{'x'});
  set_argument(0, 0x0101'4001);  // an address that has no zero in it either
  EXPECT_GT(serve(kC99Call, 25), 0);
  EXPECT_EQ(printed_.size(), dma::kLocalStoreBytes + 1) << "once around the local store";
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

TEST_F(HostCallsTest, ReadsInputAndScansIt) {
  std::string input = "12 abc 1.5\nsecond line\nx";
  bool is_late = true;
  calls_.standard_input = [&](std::span<char> to) -> std::optional<std::size_t> {
    if (std::exchange(is_late, false)) return std::nullopt;  // it comes later
    const std::size_t count = std::min(to.size(), input.size());
    std::ranges::copy(input.substr(0, count), to.begin());
    input.erase(0, count);
    return count;
  };
  set_argument(0, text("%d %2s%c %lf"));
  set_argument(1, kVariable);
  set_argument(2, 0);
  for (std::uint32_t i = 0; i < 4; ++i) memory_.set_word(kVariable + 16 * i, kBuffer + 32 * i);
  EXPECT_EQ(serve(kC99Call, 38), 4);  // vscanf
  EXPECT_EQ(memory_.word(kBuffer), 12u);
  EXPECT_EQ(memory_.text(kBuffer + 32), "ab");
  EXPECT_EQ(memory_.byte(kBuffer + 64), 'c');
  EXPECT_EQ(std::bit_cast<double>(memory_.doubleword(kBuffer + 96)), 1.5);
  EXPECT_EQ(serve(kC99Call, 20), '\n');  // getchar
  const auto gets = [&] {
    set_argument(0, kBuffer);
    set_argument(1, 100);
    set_argument(2, kStandardInput);
    return serve(kC99Call, 8);
  };
  EXPECT_EQ(gets(), static_cast<std::int32_t>(kBuffer));
  EXPECT_EQ(memory_.text(kBuffer), "second line\n");
  set_argument(0, 0);
  set_argument(1, kBuffer);
  set_argument(2, 100);
  EXPECT_EQ(serve(kPosixCall, 16), 1);
  EXPECT_EQ(memory_.byte(kBuffer), 'x');
  EXPECT_EQ(gets(), 0);
  set_argument(0, kStandardInput);
  EXPECT_EQ(serve(kC99Call, 3), 1);  // feof
}

TEST_F(HostCallsTest, ScansTextsAndRefusesHostileFormats) {
  const auto scan = [&](const std::string& from, const std::string& format) {
    set_argument(0, text(from));
    set_argument(1, text(format));
    set_argument(2, kVariable);
    set_argument(3, 0);
    for (std::uint32_t i = 0; i < 4; ++i) memory_.set_word(kVariable + 16 * i, kBuffer + 32 * i);
    return serve(kC99Call, 41);
  };
  EXPECT_EQ(scan("0x10 -5 beef", "%i %hd %x"), 3);
  EXPECT_EQ(memory_.word(kBuffer), 16u);
  EXPECT_EQ(memory_.byte(kBuffer + 32), 0xFFu);
  EXPECT_EQ(memory_.byte(kBuffer + 33), 0xFBu);
  EXPECT_EQ(memory_.word(kBuffer + 64), 0xBEEFu);
  EXPECT_EQ(scan("", "%d"), -1);
  EXPECT_EQ(scan("x", "%d"), 0);
  for (const std::string& format : {std::string("%"), std::string("%["), std::string("%[^"),
                                    std::string("%[]"), std::string("%99999999999s"), std::string("%*"),
                                    std::string("%lllllld"), std::string("%Q"), std::string(3000, '%')})
    EXPECT_LE(scan("text", format), 1) << format;
}

TEST_F(HostCallsTest, NeitherSleepNorInputOutlastsTheRun) {
  interrupted_ = true;
  calls_.standard_input = [](std::span<char>) { return std::nullopt; };
  EXPECT_EQ(serve(kC99Call, 20), -1);
  set_argument(0, kBuffer);
  set_argument(1, kBuffer + 16);
  memory_.set_word(kBuffer, 1000000);
  EXPECT_EQ(serve(kPosixCall, 32), -1);
  EXPECT_EQ(error(), EINTR);
  EXPECT_GE(memory_.word(kBuffer + 16), 999000u);
}

TEST_F(HostCallsTest, StreamsStayInTheFolder) {
  const auto root = std::filesystem::path(testing::TempDir()) / "softcell_host_streams";
  std::filesystem::remove_all(root);
  std::filesystem::create_directories(root / "in");
  std::ofstream(root / "secret") << "secret";
  const auto open_stream = [&](const std::string& path, const std::string& mode) {
    set_argument(0, text(path));
    set_argument(1, text(mode));
    return serve(kC99Call, 10);
  };
  EXPECT_EQ(open_stream("a", "w"), 0);
  EXPECT_EQ(error(), EACCES);
  calls_.folder = root / "in";
  EXPECT_EQ(open_stream("../secret", "r"), 0);
  const std::int32_t stream = open_stream("a", "w+");
  ASSERT_GT(stream, 3);
  set_argument(0, text("ab"));
  set_argument(1, static_cast<std::uint32_t>(stream));
  EXPECT_GE(serve(kC99Call, 12), 0);
  set_argument(0, static_cast<std::uint32_t>(stream));
  EXPECT_EQ(serve(kC99Call, 2), 0);
  EXPECT_EQ(std::filesystem::file_size(root / "in" / "a"), 2u);
  set_argument(0, text("a"));
  set_argument(1, text("../stolen"));
  EXPECT_EQ(serve(kC99Call, 27), -1);
  set_argument(0, text("a"));
  set_argument(1, text("b"));
  EXPECT_EQ(serve(kC99Call, 27), 0);
  set_argument(0, text("b"));
  EXPECT_EQ(serve(kC99Call, 26), 0);
  EXPECT_TRUE(std::filesystem::is_empty(root / "in"));
  EXPECT_FALSE(std::filesystem::exists(root / "stolen"));
  std::filesystem::remove_all(root);
}

TEST_F(HostCallsTest, AStreamIsReopenedInTheFolder) {
  const auto root = std::filesystem::path(testing::TempDir()) / "softcell_host_reopened";
  std::filesystem::remove_all(root);
  std::filesystem::create_directories(root / "in");
  calls_.folder = root / "in";
  const auto reopen = [&](const std::string& path, const std::string& mode, std::uint32_t stream) {
    set_argument(0, text(path));
    set_argument(1, text(mode));
    set_argument(2, stream);
    return serve(kC99Call, 14);
  };
  EXPECT_EQ(reopen("out", "w", kStandardOutput), static_cast<std::int32_t>(kStandardOutput));
  set_argument(0, text("line"));
  serve(kC99Call, 25);
  EXPECT_EQ(reopen("../stolen", "w", kStandardError), 0);
  EXPECT_NE(error(), 0);
  EXPECT_EQ(reopen("out", "r", 77), 0);
  EXPECT_EQ(error(), EBADF);
  set_argument(0, kStandardOutput);
  serve(kC99Call, 5);  // fflush
  EXPECT_EQ(std::filesystem::file_size(root / "in" / "out"), 5u);
  EXPECT_EQ(printed_, "");
  EXPECT_FALSE(std::filesystem::exists(root / "stolen"));
  std::filesystem::remove_all(root);
}

TEST_F(HostCallsTest, TellsWhatIsKnownOfFilesInTheFolder) {
  const auto root = std::filesystem::path(testing::TempDir()) / "softcell_host_known";
  std::filesystem::remove_all(root);
  std::filesystem::create_directories(root / "in");
  std::ofstream(root / "in" / "five") << "12345";
  std::filesystem::create_symlink("../../secret", root / "in" / "link");
  calls_.folder = root / "in";
  const auto status_of = [&](const std::string& path, std::uint32_t function) {
    set_argument(0, text(path));
    set_argument(1, kBuffer);
    return serve(kPosixCall, function);
  };
  constexpr std::uint32_t kStatus = 23, kLinkStatus = 10, kMode = kBuffer + 8, kSize = kBuffer + 28;
  EXPECT_EQ(status_of("five", kStatus), 0);
  EXPECT_EQ(memory_.word(kMode) & 0170000, 0100000u);
  EXPECT_EQ(memory_.word(kSize), 5u);
  EXPECT_EQ(status_of(".", kStatus), 0);
  EXPECT_EQ(memory_.word(kMode) & 0170000, 0040000u);
  EXPECT_EQ(status_of("link", kStatus), -1);
  EXPECT_EQ(status_of("link", kLinkStatus), 0);
  EXPECT_EQ(memory_.word(kMode) & 0170000, 0120000u);
  EXPECT_EQ(status_of("../in", kStatus), -1);
  const std::int32_t file = open("five", 0);
  set_argument(0, static_cast<std::uint32_t>(file));
  set_argument(1, kBuffer);
  memory_.set_word(kSize, 0);
  EXPECT_EQ(serve(kPosixCall, 4), 0);
  EXPECT_EQ(memory_.word(kSize), 5u);
  set_argument(0, 99);
  EXPECT_EQ(serve(kPosixCall, 4), -1);
  EXPECT_EQ(error(), EBADF);
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
}  // namespace softcell::ls_sim::assisted
