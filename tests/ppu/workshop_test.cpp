// The thread on which flows and pieces are made: it begins with each task, however it comes to know of it.
#include "ppu/bodies/workshop.h"

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <stdexcept>
#include <thread>
#include <vector>

namespace softcell::ppu {
namespace {

using std::chrono::milliseconds;

class WorkshopStarts : public testing::TestWithParam<Workshop::Start> {};

INSTANTIATE_TEST_SUITE_P(Both, WorkshopStarts,
                         testing::Values(Workshop::Start::kAtOnce, Workshop::Start::kByClock));

TEST_P(WorkshopStarts, TasksAtAnyPaceAreDone) {
  Workshop workshop(GetParam());
  int number = 0;
  for (const int pause_ms : {0, 0, 6, 6, 6, 6, 30, 6, 6, 0, 6, 110, 6, 6}) {
    std::this_thread::sleep_for(milliseconds(pause_ms));
    ++number;
    EXPECT_EQ(workshop.begin([number] { return number; }).get(), number) << pause_ms << " ms after the last";
  }
}

TEST_P(WorkshopStarts, WhatIsHurriedIsThere) {
  Workshop workshop(GetParam());
  workshop.hurry();  // nothing to do
  for (int i = 0; i < 10; ++i) {
    std::this_thread::sleep_for(
        milliseconds(50));  // regular, so that the thread would look some milliseconds later
    auto first = workshop.begin([i] { return i; });
    auto second = workshop.begin([i] { return -i; });
    workshop.hurry();
    EXPECT_EQ(first.get(), i);
    EXPECT_EQ(second.get(), -i);
  }
}

TEST_P(WorkshopStarts, TasksAreDoneInTheirOrder) {
  Workshop workshop(GetParam());
  std::vector<int> order;
  std::vector<std::future<bool>> tasks;
  for (int i = 0; i < 60; ++i) {
    if (i % 10 == 0) std::this_thread::sleep_for(milliseconds(8));
    tasks.push_back(workshop.begin([i, &order] { return order.push_back(i), true; }));
  }
  for (auto& task : tasks) task.get();
  for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], static_cast<int>(i));
  EXPECT_EQ(order.size(), tasks.size());
}

TEST_P(WorkshopStarts, AFailureIsTheFutures) {
  Workshop workshop(GetParam());
  auto fails = workshop.begin([]() -> int { throw std::runtime_error("no room"); });
  EXPECT_THROW(fails.get(), std::runtime_error);
  EXPECT_EQ(workshop.begin([] { return 7; }).get(), 7) << "it goes on";
}

TEST_P(WorkshopStarts, ItsEndDoesNotWaitForTheClock) {
  const auto begin = std::chrono::steady_clock::now();
  {
    Workshop workshop(GetParam());
    for (int i = 0; i < 3; ++i) {
      workshop.begin([] { return true; }).get();
      std::this_thread::sleep_for(milliseconds(90));
    }
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(60));
}

}  // namespace
}  // namespace softcell::ppu
