#include "services/mesher/lag_queue.h"

#include <gtest/gtest.h>

namespace nbs {
namespace {

using Ids = std::vector<uint32_t>;

TEST(LagQueue, GivesWhatHasWaitedForTheLagInAscendingOrder) {
  LagQueue queue;
  queue.Push(7, {0.000, 0});
  queue.Push(3, {0.001, 1});
  queue.Push(5, {0.006, 2});
  Ids due;
  queue.TakeDue({0.0105, 3}, 0.01, 25, due);
  EXPECT_EQ(due, (Ids{7}));
  queue.TakeDue({0.0165, 4}, 0.01, 25, due);
  EXPECT_EQ(due, (Ids{3, 5}));
}

TEST(LagQueue, StandingSensorIsWaitedForOnlySoManyStripes) {
  LagQueue queue;
  queue.Push(7, {0.0, 10});
  Ids due;
  queue.TakeDue({0.0, 34}, 0.01, 25, due);
  EXPECT_TRUE(due.empty());
  queue.TakeDue({0.0, 35}, 0.01, 25, due);
  EXPECT_EQ(due, (Ids{7}));
}

TEST(LagQueue, TakeAllLeavesNothing) {
  LagQueue queue;
  queue.Push(7, {0.0, 0});
  queue.Push(3, {0.0, 0});
  Ids due;
  queue.TakeAll(due);
  EXPECT_EQ(due, (Ids{3, 7}));
  queue.TakeAll(due);
  EXPECT_TRUE(due.empty());
}

}  // namespace
}  // namespace nbs
