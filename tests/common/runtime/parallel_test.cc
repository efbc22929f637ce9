#include "common/runtime/parallel.h"

#include <gtest/gtest.h>

namespace nbs {
namespace {

TEST(Parallel, EachThreadRunsOnceUnderItsNumber) {
  for (const int threads : {1, 2, 7}) {
    std::vector<int> runs(threads, 0);
    RunOnThreads(threads, [&](int thread) { ++runs[thread]; });
    EXPECT_EQ(runs, std::vector<int>(threads, 1));
  }
}

TEST(Parallel, EachIndexComesOnceOnAnyNumberOfThreads) {
  for (const int threads : {1, 3, 8}) {
    for (const size_t count : {0u, 1u, 2u, 1000u}) {
      std::vector<int> visits(count, 0);
      ForEachIndex(count, threads, [&](size_t i) { ++visits[i]; });
      EXPECT_EQ(visits, std::vector<int>(count, 1)) << threads << " threads";
    }
  }
}

// Two that wait for each other end only if they run side by side.
TEST(Parallel, IndicesRunSideBySide) {
  std::atomic<int> started = 0;
  ForEachIndex(2, 2, [&](size_t) {
    ++started;
    while (started < 2) std::this_thread::yield();
  });
  EXPECT_EQ(started, 2);
}

}  // namespace
}  // namespace nbs
