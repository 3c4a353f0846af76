#include "softcell/ls_sim/findings.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace softcell::ls_sim {
namespace {

dma::Fault fault(dma::Rule rule, const char* kernel, const char* place, int spe = 0) {
  dma::Fault result{rule};
  result.spe = spe;
  result.kernel = kernel;
  result.place = place;
  return result;
}

TEST(Findings, CountWhatHappensAtOnePlaceOnAnySpe) {
  Findings findings;
  EXPECT_TRUE(findings.empty());
  findings.add(fault(dma::Rule::kLoadInFlight, "skin", "skin.cpp:9", 2));
  findings.add(fault(dma::Rule::kLoadInFlight, "skin", "skin.cpp:9", 0));
  EXPECT_FALSE(findings.empty());
  const auto list = findings.list();
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].count, 2u);
  EXPECT_EQ(list[0].fault.spe, 2) << "the first occurrence is kept";
}

TEST(Findings, AreInOrderOfRuleKernelAndPlaceWhateverCameFirst) {
  Findings findings;
  findings.add(fault(dma::Rule::kStoreInFlight, "a", "a.cpp:1"));
  findings.add(fault(dma::Rule::kLoadInFlight, "b", "b.cpp:1"));
  findings.add(fault(dma::Rule::kLoadInFlight, "a", "a.cpp:2"));
  findings.add(fault(dma::Rule::kLoadInFlight, "a", "a.cpp:1"));
  const auto list = findings.list();
  ASSERT_EQ(list.size(), 4u);
  EXPECT_EQ(list[0].fault.place, "a.cpp:1");
  EXPECT_EQ(list[1].fault.place, "a.cpp:2");
  EXPECT_EQ(list[2].fault.kernel, "b");
  EXPECT_EQ(list[3].fault.rule, dma::Rule::kStoreInFlight);
}

TEST(Findings, LoseNoneOfManyThreads) {
  constexpr int kThreads = 6, kEach = 1000;
  Findings findings;
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < kThreads; ++t) {
      threads.emplace_back([&findings, t] {
        for (int i = 0; i < kEach; ++i)
          findings.add(fault(dma::Rule::kLoadInFlight, "skin", "skin.cpp:9", t));
      });
    }
  }
  ASSERT_EQ(findings.list().size(), 1u);
  EXPECT_EQ(findings.list()[0].count, std::uint64_t{kThreads} * kEach);
}

}  // namespace
}  // namespace softcell::ls_sim
