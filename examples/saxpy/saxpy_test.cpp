// The kernel under test is the image itself: it runs from a local store and reaches its data by DMA, as on a
// console, under every order of transfers that its waits allow.

#include <gtest/gtest.h>

#include <bit>
#include <string>
#include <vector>

#include "saxpy_job.h"
#include "softcell/dma/buffer.h"
#include "softcell/ls_sim/spe_group.h"

// Made by softcell_embed_spu_images.
extern "C" const std::byte softcell_image_saxpy[], softcell_image_saxpy_end[];
extern "C" const std::byte softcell_image_saxpy_no_wait[], softcell_image_saxpy_no_wait_end[];

namespace {

using namespace softcell;

// Small integers: exact, however the arithmetic rounds.
constexpr float kA = 3;
float x_at(std::size_t i) { return static_cast<float>(i % 100); }
float y_at(std::size_t i) { return static_cast<float>(i % 7); }

/// Runs the image on SPEs that share the work. @return y.
std::vector<float> run(const ls_sim::KernelImage& image, std::size_t count, const std::string& schedule,
                       int spes = 1) {
  dma::AddressSpace memory;
  dma::Buffer<float> x(memory, "x", count), y(memory, "y", count);
  for (std::size_t i = 0; i < count; ++i) {
    x[i] = x_at(i);
    y[i] = y_at(i);
  }
  dma::Buffer<SaxpyJob> job(memory, "job", 1);
  job[0] = {std::bit_cast<std::uint32_t>(kA),
            x.ea().value,
            y.ea().value,
            count,
            static_cast<std::uint64_t>(spes),
            0};

  ls_sim::SpeGroup group(memory, {.spes = spes, .schedule = dma::parse_schedule(schedule)});
  for (int spe = 0; spe < spes; ++spe)
    group.start(spe, image, {.spe_id = static_cast<std::uint64_t>(spe), .argp = job.ea().value});
  for (int spe = 0; spe < spes; ++spe) {
    const ls_sim::RunResult result = group.wait(spe);
    EXPECT_FALSE(result.fault) << result.fault->message();
    EXPECT_EQ(result.status(), kSaxpyDone);
  }
  return {y.span().begin(), y.span().end()};
}

std::vector<float> expected(std::size_t count) {
  std::vector<float> y(count);
  for (std::size_t i = 0; i < count; ++i) y[i] = kA * x_at(i) + y_at(i);
  return y;
}

class Saxpy : public testing::TestWithParam<const char*> {};

TEST_P(Saxpy, AddsForCountsAroundItsBlockSize) {
  const auto image = ls_sim::load_image("saxpy", {softcell_image_saxpy, softcell_image_saxpy_end});
  for (const std::size_t count : {4u, 2044u, 2048u, 2052u, 4096u, 10'000u})
    EXPECT_EQ(run(image, count, GetParam()), expected(count)) << count;
}

TEST_P(Saxpy, GivesTheSameOnAnyNumberOfSpes) {
  const auto image = ls_sim::load_image("saxpy", {softcell_image_saxpy, softcell_image_saxpy_end});
  for (int spes = 1; spes <= 6; ++spes)
    EXPECT_EQ(run(image, 20'000, GetParam(), spes), expected(20'000)) << spes << " SPEs";
}

INSTANTIATE_TEST_SUITE_P(Schedules, Saxpy, testing::Values("eager", "lazy", "random:1", "random:2"));

TEST(SaxpyNoWait, IsRightByLuckAndWrongByDesign) {
  const auto image =
      ls_sim::load_image("saxpy_no_wait", {softcell_image_saxpy_no_wait, softcell_image_saxpy_no_wait_end});
  EXPECT_EQ(run(image, 1024, "eager"), expected(1024));
  EXPECT_NE(run(image, 1024, "lazy"), expected(1024));
}

}  // namespace
