// The zoo as a compiler for the SPU builds it: the interpreter finds in each kernel what is found in its twin for the host.

#include <gtest/gtest.h>

#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "kernel_card.h"
#include "kernel_run.h"
#include "softcell/dma/fault.h"

namespace softcell::zoo {

void PrintTo(const KernelCard& card, std::ostream* os) { *os << card.kind << "/" << card.name; }

namespace {

std::string name_of(const ::testing::TestParamInfo<KernelCard>& info) { return info.param.name; }

/// Kernels that are not built for the SPU, or whose mistake is another there, and why.
const std::map<std::string, std::string> kOtherwise = {
    {"bss_taken_for_zero", "the loader of an SPU program clears its bss"},
    {"effective_address_followed",
     "addresses of an SPU wrap around: a stray pointer reaches the local store"},
    {"impossible_case", "the SPU compiler calls abort(), which is a halt"},
    {"load_behind_the_last_object", "behind the image is the heap: what is found is load-never-written"},
    {"more_loaded_than_fetched", "the loader of an SPU program clears its bss"},
    {"more_put_than_written", "the loader of an SPU program clears its bss"},
    {"overlay_without_sync", "behind the routine, the put takes more than the image has"},
    {"overlay_with_sync", "behind the routine, the put takes more than the image has"},
    {"pointer_past_the_local_store", "addresses of an SPU wrap around"},
    {"store_behind_the_last_object", "a word is stored by a load first, which is found: load-never-written"},
    {"store_into_a_constant", "the constant is in no segment of its own: not found yet"},
    {"store_beside_a_get", "a word is stored by a load first, which is found: load-in-flight"},
    {"store_into_a_get", "a word is stored by a load first, which is found: load-in-flight"},
    {"put_from_a_function_that_returned",
     "nobody knows where the stack of an SPU program ends: only a store there is found"},
    {"stack_too_small", "the build for the SPU refuses it: its linker counts the stack"},
    {"tag_invalid", "libgcc's tag manager has a static constructor"},
    {"tag_manager", "libgcc's tag manager has a static constructor"},
};

/// The rules of all faults and findings of a run, each with its place.
std::vector<std::string> mistakes(const Observation& observation) {
  std::vector<std::string> all;
  for (const ls_sim::RunResult& result : observation.results)
    if (result.fault)
      all.push_back(std::string(dma::name(result.fault->rule)) + " at " + result.fault->place);
  for (const ls_sim::Finding& finding : observation.findings)
    all.push_back(std::string(dma::name(finding.fault.rule)) + " at " + finding.fault.place);
  return all;
}

template <class Body>
void for_each_run(const KernelCard& card, Body body) {
  if (const auto why = kOtherwise.find(card.name); why != kOtherwise.end()) GTEST_SKIP() << why->second;
  for (const Build build : {Build::kPlain, Build::kChecked}) {
    if (build == Build::kPlain ? !card.runs_plain() : !card.runs_checked()) continue;
    for (const char* schedule : {"eager", "lazy", "random:1"}) {
      SCOPED_TRACE(std::string(build == Build::kPlain ? "plain, " : "checked, ") + schedule);
      body(run(card, build, dma::parse_schedule(schedule), ls_sim::Machine::kSpu));
    }
  }
}

class ZooOnSpuBroken : public ::testing::TestWithParam<KernelCard> {};

TEST_P(ZooOnSpuBroken, IsCaught) {
  const std::string expected = GetParam().rule + " at " + GetParam().place();
  for_each_run(GetParam(), [&](const Observation& observation) {
    const std::vector<std::string> found = mistakes(observation);
    EXPECT_FALSE(found.empty()) << "nothing was found; expected " << expected;
    for (const std::string& mistake : found) EXPECT_EQ(mistake, expected);
  });
}

class ZooOnSpuLegal : public ::testing::TestWithParam<KernelCard> {};

TEST_P(ZooOnSpuLegal, IsLeftAlone) {
  for_each_run(GetParam(), [&](const Observation& observation) {
    for (const ls_sim::RunResult& result : observation.results)
      EXPECT_TRUE(result.ended_normally() && result.status() == 0)
          << (result.fault ? result.fault->message() : "stop code " + std::to_string(result.stop_code));
    for (const ls_sim::Finding& finding : observation.findings) ADD_FAILURE() << finding.fault.message();
  });
}

INSTANTIATE_TEST_SUITE_P(All, ZooOnSpuBroken, ::testing::ValuesIn(read_cards("broken")), name_of);
INSTANTIATE_TEST_SUITE_P(All, ZooOnSpuLegal, ::testing::ValuesIn(read_cards("legal")), name_of);

}  // namespace
}  // namespace softcell::zoo
