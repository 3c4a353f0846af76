// An exception of the host on an SPE's thread ends the run, not the process.

#include <string>

#include <gtest/gtest.h>

#include "../support/allocation_counter.h"
#include "softcell/ls_sim/spe_group.h"
#include "softcell/ls_sim/trace.h"
#include "test_images.h"

namespace softcell::ls_sim {
namespace {

TEST(HostFailure, EndsTheRunAndNotTheProcess) {
  const KernelImage image = test_image("marks_jobs");
  const EntryArguments one_job{.argp = 1};
  dma::AddressSpace memory;
  SpeGroup group(memory, {.spes = 1});
  // When a job begins, the engine saves its caller's variables, and this allocation fails.
  test::refuse_allocations_from(image.sizes.bss);
  group.start_resident(0, image, one_job);
  const RunResult result = group.wait(0);
  test::refuse_allocations_from(static_cast<std::size_t>(-1));
  ASSERT_TRUE(result.fault);
  EXPECT_EQ(result.fault->rule, dma::Rule::kHostFailure);
  EXPECT_EQ(result.fault->spe, 0);
  EXPECT_EQ(result.fault->kernel, "marks_jobs");
  EXPECT_NE(result.fault->message().find("bad_alloc"), std::string::npos) << result.fault->message();

  group.start_resident(0, image, one_job);
  EXPECT_FALSE(group.wait(0).fault) << "the SPE goes on";
}

TEST(HostFailure, OfBookkeepingEndsTheRunAndNotTheProcess) {
  const KernelImage image = test_image("sees_mask");
  dma::AddressSpace memory;
  Trace trace(1);
  SpeGroup group(memory, {.spes = 1, .trace = &trace});
  group.prepare(0, image, {});
  test::refuse_allocations_from(64);
  group.start(0);
  const RunResult result = group.wait(0);
  test::refuse_allocations_from(static_cast<std::size_t>(-1));
  ASSERT_TRUE(result.fault);
  EXPECT_EQ(result.fault->rule, dma::Rule::kHostFailure);
  EXPECT_EQ(result.fault->spe, 0);

  group.prepare(0, image, {});
  group.start(0);
  EXPECT_FALSE(group.wait(0).fault) << "the SPE goes on";
}

}  // namespace
}  // namespace softcell::ls_sim
