// A steady stream of commands allocates no heap memory.
#include "allocation_counter.h"
#include "mfc_fixture.h"

namespace softcell::dma {
namespace {

class MfcAllocation : public testing::TestWithParam<Schedule> {};
INSTANTIATE_TEST_SUITE_P(Schedules, MfcAllocation, testing::ValuesIn(all_schedules()), schedule_test_name);

TEST_P(MfcAllocation, ASteadyStreamOfCommandsAllocatesNothing) {
  MfcBench bench(GetParam());
  ASSERT_GT(allocation_count(), 0) << "allocations are not counted";
  const long before = allocation_count();
  for (std::uint32_t i = 0; i < 1000; ++i) {
    bench.issue(i % 3 == 0 ? MfcOpcode::putf : MfcOpcode::get, i % 8 * 1024, i % 32 * 1024, 1024, i % 5);
    if (i % 50 == 49) {
      bench.wait_any(0x1F);
      bench.wait_all(0x1F);
      bench.mfc.drain();
      bench.mfc.begin_job(i);
    }
  }
  EXPECT_EQ(allocation_count(), before);
}

}  // namespace
}  // namespace softcell::dma
