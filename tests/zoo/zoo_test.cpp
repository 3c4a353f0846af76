// Every broken kernel is caught, by the rule that it breaks and at the line where it does, and every legal
// one is left alone: under all schedules, since a mistake is one whether or not it shows.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <ostream>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "kernel_card.h"
#include "kernel_run.h"
#include "softcell/dma/fault.h"

namespace softcell::zoo {

void PrintTo(const KernelCard& card, std::ostream* os) { *os << card.kind << "/" << card.name; }

namespace {

std::string name_of(const ::testing::TestParamInfo<KernelCard>& info) { return info.param.name; }

template <class Body>
void for_each_run(const KernelCard& card, Body body) {
  for (const Build build : {Build::kPlain, Build::kChecked}) {
    if (build == Build::kPlain ? !card.runs_plain() : !card.runs_checked()) continue;
    for (const char* schedule : {"eager", "lazy", "random:1", "random:2"}) {
      SCOPED_TRACE(std::string(build == Build::kPlain ? "plain, " : "checked, ") + schedule);
      body(build, run(card, build, dma::parse_schedule(schedule)));
    }
  }
}

class ZooBroken : public ::testing::TestWithParam<KernelCard> {
 protected:
  void expect_the_fault(const dma::Fault& fault) const {
    const KernelCard& card = GetParam();
    const std::string message = fault.message();
    EXPECT_EQ(dma::name(fault.rule), card.rule) << message;
    EXPECT_EQ(fault.place, card.place()) << message;
    EXPECT_EQ(fault.kernel, card.name) << message;
    EXPECT_GE(fault.spe, 0) << message;
    for (const std::string& part : {card.rule, card.place(), card.names}) {
      EXPECT_NE(message.find(part), std::string::npos) << "\"" << part << "\" is not in: " << message;
    }
  }
};

TEST_P(ZooBroken, IsCaught) {
  const KernelCard& card = GetParam();
  const bool only_a_finding = card.build == "checked";
  const std::string expected =
      "expected: " + card.rule + " of " + card.names + " at " + card.place() + "; the mistake: " + card.text;
  for_each_run(card, [&](Build, const Observation& observation) {
    for (const ls_sim::RunResult& result : observation.results) {
      if (only_a_finding) {
        EXPECT_FALSE(result.fault) << result.fault->message();
      } else if (result.fault) {
        expect_the_fault(*result.fault);
      } else {
        ADD_FAILURE() << "no fault: it ended with stop code " << result.stop_code << "\n" << expected;
      }
    }
    EXPECT_EQ(observation.findings.size(), only_a_finding ? 1u : 0u) << expected;
    for (const ls_sim::Finding& finding : observation.findings) {
      EXPECT_EQ(finding.count, 1u);
      expect_the_fault(finding.fault);
    }
  });
}

class ZooLegal : public ::testing::TestWithParam<KernelCard> {};

TEST_P(ZooLegal, IsLeftAlone) {
  for_each_run(GetParam(), [&](Build, const Observation& observation) {
    for (const ls_sim::RunResult& result : observation.results) {
      EXPECT_FALSE(result.fault) << result.fault->message();
      EXPECT_TRUE(result.ended_normally() && result.status() == 0) << "stop code " << result.stop_code;
    }
    for (const ls_sim::Finding& finding : observation.findings) ADD_FAILURE() << finding.fault.message();
  });
}

INSTANTIATE_TEST_SUITE_P(All, ZooBroken, ::testing::ValuesIn(read_cards("broken")), name_of);
INSTANTIATE_TEST_SUITE_P(All, ZooLegal, ::testing::ValuesIn(read_cards("legal")), name_of);

/// What no kernel can do, and why.
const std::map<dma::Rule, std::string> kNotForKernels = {
    {dma::Rule::kNotOnProxyQueue, "only the PPU queues proxy commands; see the tests of the proxy queue"},
    {dma::Rule::kEaOutsideAllocation,
     "only the memory of a host program has allocations; see the tests of host programs and of libspe2"},
    {dma::Rule::kImageNotLoadable, "the image is refused before there is a kernel; see the tests of images"},
    {dma::Rule::kStaleInstructions,
     "the host's processor does it, not the kernel; see the tests of the native engine"},
    {dma::Rule::kStopZero, "kernels of the host have no such instruction; see the tests of the interpreter"},
    {dma::Rule::kJumpOutsideCode, "the host's processor does not tell; see the tests of the interpreter"},
    {dma::Rule::kUninitialisedAddress, "compilers warn of it for the host; see the tests of the interpreter"},
    {dma::Rule::kUninitialisedValue,
     "kernels of the host are not followed so far; see the tests of the interpreter"},
    {dma::Rule::kHostFailure, "the host fails, not the kernel; see the tests of host failures"},
};

std::set<std::string> names_of_rules() {
  std::set<std::string> names;
  for (const dma::Rule rule : dma::kAllRules) names.insert(std::string(dma::name(rule)));
  return names;
}

TEST(ZooChecklist, EveryRuleIsBrokenOnce) {
  std::set<std::string> broken;
  for (const KernelCard& card : read_cards("broken")) broken.insert(card.rule);
  for (const dma::Rule rule : dma::kAllRules) {
    const std::string name(dma::name(rule));
    EXPECT_NE(broken.count(name), kNotForKernels.count(rule)) << name;
  }
}

TEST(ZooChecklist, EveryBrokenKernelHasALegalTwinThatKeepsItsRule) {
  std::map<std::string, KernelCard> legal;
  for (const KernelCard& card : read_cards("legal")) legal["legal/" + card.name] = card;
  for (const KernelCard& card : read_cards("broken")) {
    ASSERT_TRUE(legal.contains(card.twin)) << card.name << " names " << card.twin;
    const auto& keeps = legal[card.twin].keeps;
    EXPECT_NE(std::find(keeps.begin(), keeps.end(), card.rule), keeps.end())
        << card.twin << " does not keep " << card.rule << ", which " << card.name << " breaks";
  }
}

TEST(ZooChecklist, EveryLegalKernelKeepsRulesThatExist) {
  const std::set<std::string> names = names_of_rules();
  for (const KernelCard& card : read_cards("legal")) {
    EXPECT_FALSE(card.keeps.empty()) << card.name;
    for (const std::string& rule : card.keeps) EXPECT_TRUE(names.contains(rule)) << card.name << ": " << rule;
  }
}

TEST(ZooChecklist, TheDocumentHasOneSectionWithARemedyForEveryRule) {
  std::ifstream document(ZOO_DOCUMENT);
  std::map<std::string, std::vector<std::string>> sections;  // first lines of the text below each heading
  std::string heading;
  for (std::string line; std::getline(document, line);) {
    if (line.starts_with("### ")) {
      heading = line.substr(4);
    } else if (!heading.empty() && !line.empty()) {
      sections[heading].push_back(line);
      heading.clear();
    }
  }
  for (const dma::Rule rule : dma::kAllRules) {
    const std::string name(dma::name(rule));
    ASSERT_EQ(sections[name].size(), 1u) << name;
    EXPECT_FALSE(sections[name].front().starts_with("<!--")) << name << " has no remedy";
    sections.erase(name);
  }
  for (const auto& [name, text] : sections) ADD_FAILURE() << "a section for " << name << ", which is no rule";
}

TEST(ZooChecklist, UnconfirmedRulesSaySoInTheirExplanation) {
  for (const dma::Rule rule : dma::kAllRules) {
    const bool says_so = dma::explanation(rule).find("unconfirmed") != std::string_view::npos;
    EXPECT_EQ(says_so, dma::evidence(rule) == dma::Evidence::kUnconfirmed) << dma::name(rule);
  }
}

}  // namespace
}  // namespace softcell::zoo
