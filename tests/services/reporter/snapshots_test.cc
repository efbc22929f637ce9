#include "services/reporter/snapshots.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

#include "tests/sim/shapes.h"

namespace nbs {
namespace {

class SnapshotsOfARun : public ::testing::Test {
 protected:
  ~SnapshotsOfARun() override { std::filesystem::remove_all(folder_); }

  std::set<std::string> Names() const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) names.insert(entry.path().filename());
    return names;
  }
  std::string Read(const std::string& name) const {
    std::ifstream in(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  const std::filesystem::path folder_ =
      std::filesystem::path(::testing::TempDir()) / ("snapshots_" + std::to_string(::getpid()));
  const Eigen::AlignedBox3d frame_{Eigen::Vector3d::Constant(-0.1), Eigen::Vector3d::Constant(0.1)};
};

TEST_F(SnapshotsOfARun, AreOfTheScansAskedForAndOfTheLastForLaterOnes) {
  Snapshots snapshots(folder_, frame_, {2, 4, 9});
  for (const float radius : {0.02f, 0.04f, 0.06f, 0.08f, 0.1f}) snapshots.Add(MakeSphere(radius, 3));
  snapshots.Finish();
  EXPECT_THAT(Names(), ::testing::ElementsAre("after-02-back.png", "after-02-front.png", "after-04-back.png",
                                              "after-04-front.png", "after-09-back.png", "after-09-front.png"));
  // One scale for all: what has grown looks larger; and after 9 scans it is what it was after 5.
  EXPECT_NE(Read("after-02-front.png"), Read("after-04-front.png"));
  Snapshots fifth(folder_ / "fifth", frame_, {1});
  fifth.Add(MakeSphere(0.1f, 3));
  EXPECT_EQ(Read("after-09-front.png"), Read("fifth/after-01-front.png"));
}

TEST_F(SnapshotsOfARun, WithoutAScanAreNone) {
  Snapshots snapshots(folder_, frame_, {1});
  snapshots.Finish();
  EXPECT_TRUE(Names().empty());
}

}  // namespace
}  // namespace nbs
