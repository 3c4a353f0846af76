// Handing the newest value from thread to thread. ThreadSanitizer looks on.

#include "demo/latest.h"

#include <gtest/gtest.h>

#include <array>
#include <thread>

namespace softcell::demos {
namespace {

TEST(Latest, TheNewestIsReadAndOlderOnesAreForgotten) {
  Latest<int> latest;
  latest.next() = 1;
  latest.publish();
  latest.next() = 2;
  latest.publish();
  EXPECT_EQ(latest.current(), 0) << "nothing changes under the reader's hands";
  latest.update();
  EXPECT_EQ(latest.current(), 2);
  latest.update();
  EXPECT_EQ(latest.current(), 2);
}

TEST(Latest, WhatIsReadAndWhatIsWrittenAreNeverTheSame) {
  Latest<int> latest;
  for (int i = 1; i < 20; ++i) {
    latest.next() = i;
    EXPECT_NE(&latest.next(), &latest.current());
    latest.publish();
    EXPECT_NE(&latest.next(), &latest.current());
    if (i % 3 == 0) latest.update();
  }
}

TEST(Latest, WaitingEndsWithAValueOrTheEnd) {
  Latest<int> latest;
  std::thread writer([&] {
    latest.next() = 7;
    latest.publish();
  });
  EXPECT_TRUE(latest.wait());
  EXPECT_EQ(latest.current(), 7);
  writer.join();
  std::thread closer([&] { latest.close(); });
  EXPECT_FALSE(latest.wait());
  closer.join();
}

TEST(Latest, ValuesArriveWholeAndInOrderFromABusyWriter) {
  using Wide = std::array<int, 64>;
  constexpr int kLast = 20'000;
  Latest<Wide> latest;
  std::thread writer([&] {
    for (int i = 1; i <= kLast; ++i) {
      latest.next().fill(i);
      latest.publish();
    }
  });
  int before = 0;
  while (before < kLast && latest.wait()) {
    const Wide& value = latest.current();
    ASSERT_GT(value.front(), before);
    for (const int each : value) ASSERT_EQ(each, value.front());
    before = value.front();
  }
  writer.join();
  EXPECT_EQ(before, kLast) << "the last one is never lost";
}

}  // namespace
}  // namespace softcell::demos
