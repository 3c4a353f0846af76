// A steady stream of commands allocates no heap memory.
#include "mfc_fixture.h"
#include "support/allocation_counter.h"

namespace softcell::dma {
namespace {

class MfcAllocation : public testing::TestWithParam<Schedule> {};
INSTANTIATE_TEST_SUITE_P(Schedules, MfcAllocation, testing::ValuesIn(all_schedules()), schedule_test_name);

TEST_P(MfcAllocation, ASteadyStreamOfCommandsAllocatesNothing) {
  MfcBench bench(GetParam());
  ASSERT_GT(test::allocations(), 0u) << "allocations are not counted";
  const std::size_t before = test::allocations();
  for (std::uint32_t i = 0; i < 1000; ++i) {
    bench.issue(i % 3 == 0 ? MfcOpcode::putf : MfcOpcode::get, i % 8 * 1024, i % 32 * 1024, 1024, i % 5);
    if (i % 50 == 49) {
      bench.wait_any(0x1F);
      bench.wait_all(0x1F);
      bench.mfc.drain();
      bench.mfc.begin_job(i);
    }
  }
  EXPECT_EQ(test::allocations(), before);
}

}  // namespace
}  // namespace softcell::dma
