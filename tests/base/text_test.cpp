#include "softcell/base/text.h"

#include <gtest/gtest.h>

#include "softcell/base/nearest_name.h"

#include <cmath>
#include <string>
#include <string_view>

namespace softcell::base {
namespace {

TEST(Utf8Length, KnowsSequencesAndRefusesTheRest) {
  EXPECT_EQ(utf8_length("a", 0), 1u);
  EXPECT_EQ(utf8_length("\xC3\xA9", 0), 2u);
  EXPECT_EQ(utf8_length("x\xE2\x82\xAC", 1), 3u);
  EXPECT_EQ(utf8_length("\xF0\x9F\x8E\xAE", 0), 4u);
  for (const char* wrong : {"\x80", "\xC3", "\xC0\x80", "\xE0\x9F\xBF", "\xED\xA0\x80", "\xF4\x90\x80\x80"})
    EXPECT_EQ(utf8_length(wrong, 0), 0u) << one_line(wrong);
}

TEST(OneLine, KeepsTextAndNamesBytesThatAreNone) {
  EXPECT_EQ(one_line("caf\xC3\xA9\tand\nmore"), "caf\xC3\xA9 and more");
  EXPECT_EQ(one_line("\x1b[31m \x7f \xC2\x85 \xff"), "\\x1b[31m \\x7f \\xc2\\x85 \\xff");
}

TEST(OneLine, LeavesTheMiddleOutOfALongSentence) {
  std::string text;
  for (int i = 0; i < 1001; ++i) text += "\xC3\xA9";  // of two bytes: nowhere is one cut in half
  const std::string line = one_line(text);
  EXPECT_LT(line.size(), 2010u);
  EXPECT_NE(line.find(" ... "), std::string::npos);
  for (std::size_t at = 0; at < line.size(); at += utf8_length(line, at))
    ASSERT_NE(utf8_length(line, at), 0u);
}

TEST(Hex, HasAtLeastTheDigitsAskedFor) {
  EXPECT_EQ(hex(0xBEEF), "0xBEEF");
  EXPECT_EQ(hex(0xBEEF, 5), "0x0BEEF");
  EXPECT_EQ(hex(0xFEDCBA9876543210, 16), "0xFEDCBA9876543210");
  EXPECT_EQ(byte_count(1) + ", " + byte_count(16), "1 byte, 16 bytes");
}

TEST(Counted, OneIsSingularAndAllElsePlural) {
  EXPECT_EQ(counted(0, "frame"), "0 frames");
  EXPECT_EQ(counted(1, "frame"), "1 frame");
  EXPECT_EQ(counted(2, "frame"), "2 frames");
  EXPECT_EQ(counted(1, "body", "bodies"), "1 body");
  EXPECT_EQ(counted(5, "body", "bodies"), "5 bodies");
}

TEST(NearestName, IsTheOneThatIsASlipAway) {
  constexpr std::string_view kVerbs[] = {"demo", "bench", "report", "scenes"};
  EXPECT_EQ(nearest_name("bnech", kVerbs), "bench") << "neighbours swapped";
  EXPECT_EQ(nearest_name("dmeo", kVerbs), "demo");
  EXPECT_EQ(nearest_name("reprt", kVerbs), "report") << "left out";
  EXPECT_EQ(nearest_name("sceness", kVerbs), "scenes") << "inserted";
  EXPECT_EQ(nearest_name("remort", kVerbs), "report") << "replaced";
  EXPECT_EQ(nearest_name("dance", kVerbs), "");
  EXPECT_EQ(nearest_name("", kVerbs), "");
}

TEST(Shortest, HasTheDigitsThatTellANumberFromOthers) {
  EXPECT_EQ(shortest(0.1f), "0.1");
  EXPECT_EQ(shortest(std::nextafter(0.1f, 1.0f)), "0.10000001");
  EXPECT_EQ(shortest(1e-8f), "1e-08");
  EXPECT_EQ(shortest(-2.0f), "-2");
  EXPECT_EQ(shortest(0.1), "0.1");
  EXPECT_EQ(shortest(static_cast<double>(0.1f)), "0.1") << "a float that has become a double";
  EXPECT_EQ(shortest(1e300), "1e+300");
  EXPECT_EQ(shortest(-1.25e-300), "-1.25e-300");
  EXPECT_EQ(shortest(NAN), "nan");
  EXPECT_EQ(shortest(-INFINITY), "-inf");
}

}  // namespace
}  // namespace softcell::base
