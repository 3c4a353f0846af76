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
  bench.write_list({bench.element(256, 0)});
  const std::size_t before = test::allocations();
  for (std::uint32_t i = 0; i < 1000; ++i) {
    bench.issue(i % 3 == 0 ? MfcOpcode::putf : MfcOpcode::get, i % 8 * 1024, i % 32 * 1024, 1024, i % 5);
    if (i % 7 == 0) bench.issue(MfcOpcode::getllar, 16384, 0, 0, 0);
    if (i % 11 == 0) bench.issue(MfcOpcode::barrier, 0, 0, 0, 6);
    if (i % 13 == 0) {
      ASSERT_FALSE(bench.mfc.issue(bench.list_command(MfcOpcode::getlf, 32768, 1, 7)));
    }
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
