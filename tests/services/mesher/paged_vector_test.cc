#include "services/mesher/paged_vector.h"

#include <gtest/gtest.h>

#include <vector>

namespace nbs {
namespace {

TEST(PagedVector, HoldsWhatAVectorHolds) {
  PagedVector<int> paged;
  std::vector<int> oracle;
  for (int i = 0; i < 2000; ++i) {
    paged.push_back(3 * i);
    oracle.push_back(3 * i);
    if (i % 3 == 0) paged[static_cast<size_t>(i) / 2] = oracle[static_cast<size_t>(i) / 2] = -i;
  }
  ASSERT_EQ(paged.size(), oracle.size());
  size_t i = 0;
  for (int value : paged) EXPECT_EQ(value, oracle[i++]);
  EXPECT_EQ(paged.back(), oracle.back());
}

TEST(PagedVector, ElementsStayWhereTheyAreAsItGrows) {
  PagedVector<int> paged;
  paged.push_back(1);
  const int* first = &paged[0];
  paged.GrowTo(10'000);
  EXPECT_EQ(first, &paged[0]);
  EXPECT_EQ(paged[9'999], 0);
}

TEST(PagedVector, GrowToNeverShrinks) {
  PagedVector<int> paged;
  paged.GrowTo(5);
  paged.GrowTo(2);
  EXPECT_EQ(paged.size(), 5u);
}

}  // namespace
}  // namespace nbs
