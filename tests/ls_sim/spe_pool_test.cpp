#include "softcell/ls_sim/spe_pool.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "softcell/dma/buffer.h"
#include "test_images.h"

namespace softcell::ls_sim {
namespace {

using Words = std::array<std::uint32_t, 32>;

class SpePoolTest : public testing::Test {
 protected:
  dma::Buffer<Words> make_lines(std::size_t count) {
    dma::Buffer<Words> lines(memory_, "lines", count);
    for (std::size_t i = 0; i < count; ++i) lines.span()[i].fill(static_cast<std::uint32_t>(i));
    return lines;
  }

  dma::AddressSpace memory_;
};

TEST_F(SpePoolTest, RunsEveryJobOnceForAnyNumberOfSpesAndAnySchedule) {
  const KernelImage image = test_image("echo_arguments");
  for (int spes = 1; spes <= 6; ++spes) {
    for (const char* schedule : {"eager", "lazy", "random:1", "random:2"}) {
      SpePool pool(memory_, {.spes = spes, .schedule = dma::parse_schedule(schedule)});
      auto lines = make_lines(100);
      std::vector<Job> jobs;
      for (std::size_t i = 0; i < 100; ++i) jobs.push_back({&image, lines.ea(i), {}});
      JobBatch batch;
      pool.submit(batch, jobs);
      batch.wait();
      EXPECT_TRUE(batch.failures().empty()) << batch.failures().front().message;
      for (std::size_t i = 0; i < 100; ++i) {
        for (const std::uint32_t word : lines.span()[i]) ASSERT_EQ(word, i + 1) << spes << " " << schedule;
      }
      std::uint64_t jobs_run = 0, bytes = 0;
      for (const SpeStatistics& s : pool.statistics()) jobs_run += s.jobs, bytes += s.dma.bytes();
      EXPECT_EQ(jobs_run, 100u);
      EXPECT_EQ(bytes, 100u * 256u);
    }
  }
}

TEST_F(SpePoolTest, OneFaultingJobFailsItsBatchAndTheOthersAndThePoolGoOn) {
  const KernelImage good = test_image("echo_arguments"), bad = test_image("bad_dma");
  SpePool pool(memory_, {.spes = 2});
  auto lines = make_lines(3);
  const std::vector<Job> jobs{{&good, lines.ea(), {}}, {&bad, lines.ea(), {24}}, {&good, lines.ea(1), {}}};
  JobBatch batch;
  pool.submit(batch, jobs);
  batch.wait();
  ASSERT_EQ(batch.failures().size(), 1u);
  EXPECT_EQ(batch.failures()[0].job, 1u);
  const std::string& message = batch.failures()[0].message;
  for (const char* part : {"SPE ", "bad_dma", "get", "tag 3", "0x5EA010000000", "24"}) {
    EXPECT_NE(message.find(part), std::string::npos) << part << " is not in: " << message;
  }
  EXPECT_EQ(lines.span()[0][0], 1u);
  EXPECT_EQ(lines.span()[1][0], 2u);

  pool.submit(batch, std::span(jobs).first(1));
  batch.wait();
  EXPECT_TRUE(batch.failures().empty());
}

TEST_F(SpePoolTest, AKernelThatRefusesItsJobFailsIt) {
  const KernelImage image = test_image("echo_arguments");
  SpePool pool(memory_, {.spes = 1});
  auto lines = make_lines(1);
  JobBatch batch;
  pool.submit(batch, std::vector<Job>{{&image, lines.ea(), {9}}});
  batch.wait();
  ASSERT_EQ(batch.failures().size(), 1u);
  EXPECT_NE(batch.failures()[0].message.find("status 9"), std::string::npos);
}

TEST_F(SpePoolTest, AnEndlessKernelIsStoppedByTheDeadline) {
  const KernelImage image = test_image("endless");
  SpePool pool(memory_, {.spes = 2, .deadline = std::chrono::milliseconds(200)});
  JobBatch batch;
  pool.submit(batch, std::vector<Job>{{&image, {}, {0}}, {&image, {}, {1}}});
  batch.wait();
  ASSERT_EQ(batch.failures().size(), 2u);
  for (const JobFailure& failure : batch.failures()) {
    EXPECT_NE(failure.message.find("deadline-exceeded"), std::string::npos) << failure.message;
  }
}

TEST_F(SpePoolTest, AReadWithoutAWaitShowsUnderTheLazySchedule) {
  const KernelImage image = test_image("no_wait");
  for (const auto& [schedule, expected] : {std::pair{"eager", 1u}, std::pair{"lazy", 0u}}) {
    SpePool pool(memory_, {.spes = 1, .schedule = dma::parse_schedule(schedule)});
    auto lines = make_lines(2);
    JobBatch batch;
    pool.submit(batch, std::vector<Job>{{&image, lines.ea(1), lines.ea()}});
    batch.wait();
    ASSERT_TRUE(batch.failures().empty());
    EXPECT_EQ(lines.span()[0][0], expected) << schedule;
  }
}

TEST_F(SpePoolTest, InitialisedDataAreFreshForEveryJob) {
  const KernelImage image = test_image("remembers");
  for (const bool reload : {false, true}) {
    SpePool pool(memory_, {.spes = 1, .reload_always = reload});
    auto lines = make_lines(3);
    JobBatch batch;
    for (std::size_t i = 0; i < 3; ++i) {
      pool.submit(batch, std::vector<Job>{{&image, lines.ea(i), {}}});
      batch.wait();
      EXPECT_EQ(lines.span()[i][0], 101u);
      EXPECT_EQ(lines.span()[i][1], reload ? 1u : i + 1)
          << "bss is the last job's unless the image is reloaded";
    }
  }
}

TEST_F(SpePoolTest, ComputesWithTheArithmeticOfTheSpu) {
  const KernelImage image = test_image("arithmetic");
  SpePool pool(memory_, {.spes = 1});
  const dma::Buffer<std::array<float, 32>> out(memory_, "out", 1);
  JobBatch batch;
  pool.submit(batch, std::vector<Job>{{&image, out.ea(), {}}});
  batch.wait();
  ASSERT_TRUE(batch.failures().empty());
  const auto& result = out.span()[0];
  EXPECT_EQ(result[0], 1.0f);
  EXPECT_EQ(result[4], std::nextafterf(1.0f, 0.0f));
  EXPECT_EQ(result[8], 0.0f);
  EXPECT_EQ(result[12], std::nextafterf(1.0f, 0.0f)) << "the mode was lost in a call out of the kernel";
}

TEST_F(SpePoolTest, RefusesOptionsOutOfRange) {
  EXPECT_THROW(SpePool(memory_, {.spes = 0}), std::invalid_argument);
  EXPECT_THROW(SpePool(memory_, {.spes = 7}), std::invalid_argument);
  EXPECT_THROW(SpePool(memory_, {.deadline = std::chrono::milliseconds(0)}), std::invalid_argument);
}

}  // namespace
}  // namespace softcell::ls_sim
