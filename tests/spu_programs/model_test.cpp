// The programs that need nothing but registers and local store, on the model of tests/spu_model: both must be
// right, or neither is.

#include <string>

#include <gtest/gtest.h>

#include "spu_model/machine.h"
#include "spu_programs/spu_executable.h"

namespace softcell::spu_programs {
namespace {

spu_model::StepResult run_on_model(const std::string& program, spu_model::Machine& machine) {
  const SpuExecutable executable = parse_executable(read_bytes(SPU_PROGRAMS + ("/" + program) + ".elf"));
  for (const Segment& segment : executable.segments) {
    for (std::size_t i = 0; i < segment.bytes.size(); ++i) {
      machine.local_store.at(segment.address + i) = segment.bytes[i];
    }
  }
  machine.pc = executable.entry;
  constexpr int kMost = 1000000;
  for (int i = 0; i < kMost; ++i) {
    const spu_model::StepResult result = spu_model::step(machine);
    if (result.outcome != spu_model::Outcome::kNext) return result;
  }
  return {};
}

class ProgramsOnTheModel : public testing::TestWithParam<const char*> {};

TEST_P(ProgramsOnTheModel, EndWithoutAFailedCheck) {
  spu_model::Machine machine;
  const spu_model::StepResult result = run_on_model(GetParam(), machine);
  ASSERT_EQ(result.outcome, spu_model::Outcome::kStop) << std::hex << machine.pc;
  EXPECT_EQ(result.stop_code, 0x2000u) << "the low byte is the number of the failed check";
}
INSTANTIATE_TEST_SUITE_P(Spu, ProgramsOnTheModel,
                         testing::Values("loops", "calls", "indirect_branches", "self_modified", "doubles",
                                         "singles"));

}  // namespace
}  // namespace softcell::spu_programs
