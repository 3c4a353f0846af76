#include "softcell/dma/schedule.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace softcell::dma {
namespace {

TEST(Schedule, IsReadFromItsName) {
  EXPECT_EQ(parse_schedule("eager").kind, Schedule::kEager);
  EXPECT_EQ(parse_schedule("lazy").kind, Schedule::kLazy);
  EXPECT_EQ(parse_schedule("random:0"), (Schedule{Schedule::kRandom, 0}));
  EXPECT_EQ(parse_schedule("random:18446744073709551615"), (Schedule{Schedule::kRandom, ~std::uint64_t{0}}));
}

TEST(Schedule, IsWrittenAsItIsRead) {
  for (const char* text : {"eager", "lazy", "random:0", "random:42", "random:18446744073709551615"}) {
    EXPECT_EQ(to_string(parse_schedule(text)), text);
  }
}

class RefusedSchedule : public testing::TestWithParam<const char*> {};

TEST_P(RefusedSchedule, SaysWhatIsAllowed) {
  try {
    parse_schedule(GetParam());
    FAIL() << "accepted '" << GetParam() << "'";
  } catch (const std::invalid_argument& error) {
    const std::string sentence = error.what();
    EXPECT_NE(sentence.find("'" + std::string(GetParam()) + "'"), std::string::npos) << sentence;
    EXPECT_NE(sentence.find("eager, lazy and random:SEED"), std::string::npos) << sentence;
  }
}

INSTANTIATE_TEST_SUITE_P(Texts, RefusedSchedule,
                         testing::Values("", "sometimes", "Eager", "eager ", "random", "random:", "random:x",
                                         "random:-1", "random:+1", "random: 1", "random:1x", "random:0x10",
                                         "random:18446744073709551616"));

}  // namespace
}  // namespace softcell::dma
