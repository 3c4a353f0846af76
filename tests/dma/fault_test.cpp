#include "softcell/dma/fault.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <string>
#include <string_view>

namespace softcell::dma {
namespace {

TEST(Rule, HasAUniqueNameInKebabCase) {
  std::set<std::string_view> names;
  for (const Rule rule : kAllRules) {
    const std::string_view text = name(rule);
    EXPECT_TRUE(names.insert(text).second) << text;
    EXPECT_FALSE(text.empty());
    EXPECT_TRUE(std::all_of(text.begin(), text.end(), [](char c) {
      return std::islower(c) || std::isdigit(c) || c == '-';
    })) << text;
  }
  EXPECT_EQ(name(Rule::kEaAlignment), "ea-alignment");
  EXPECT_EQ(name(Rule::kImageNotLoadable), "image-not-loadable");
}

TEST(Rule, ExplanationIsASentence) {
  for (const Rule rule : kAllRules) {
    const std::string_view text = explanation(rule);
    EXPECT_TRUE(std::isupper(text.front())) << name(rule);
    EXPECT_TRUE(text.ends_with('.')) << name(rule);
    EXPECT_EQ(text.find("  "), std::string_view::npos) << name(rule);
  }
}

TEST(Rule, ExplanationSaysSoWhenTheHardwareIsUnconfirmed) {
  for (const Rule rule : kAllRules) {
    const bool said = explanation(rule).find("unconfirmed") != std::string_view::npos;
    EXPECT_EQ(said, evidence(rule) == Evidence::kUnconfirmed) << name(rule);
  }
  EXPECT_EQ(evidence(Rule::kSizeZero), Evidence::kUnconfirmed);
  EXPECT_EQ(evidence(Rule::kEaAlignment), Evidence::kRaised);
  EXPECT_EQ(evidence(Rule::kVideoMemoryWrite), Evidence::kSilent);
}

TEST(Fault, MessageNamesEverythingKnown) {
  const Fault fault{.rule = Rule::kEaAlignment,
                    .spe = 2,
                    .kernel = "skin",
                    .place = "skin.cpp:41",
                    .command = MfcCommand{0x42, {0x400}, kMainMemoryBase + 8, 16, 3},
                    .detail = "EA is 8 bytes past a multiple of 16"};
  EXPECT_EQ(
      fault.message(),
      "SPE 2, kernel skin, skin.cpp:41: ea-alignment: getf tag 3, LSA 0x00400, EA 0x5EA010000008, 16 bytes: "
      "EA is 8 bytes past a multiple of 16");
}

TEST(Fault, MessageWithoutACommandNamesTheRest) {
  const Fault fault{
      .rule = Rule::kStackOverflow, .spe = 0, .kernel = "skin", .detail = "96 bytes below its end"};
  EXPECT_EQ(fault.message(), "SPE 0, kernel skin: stack-overflow: 96 bytes below its end");
}

TEST(Fault, MessageSaysWhatIsNotKnown) {
  EXPECT_EQ(Fault{.rule = Rule::kKernelHalt}.message(), "SPE unknown, kernel unknown: kernel-halt");
  const Fault fault{.rule = Rule::kUnknownCommand, .command = MfcCommand{.word = 0xFF}};
  EXPECT_NE(fault.message().find("command 0x000000FF tag 0"), std::string::npos) << fault.message();
}

}  // namespace
}  // namespace softcell::dma
