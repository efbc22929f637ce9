#include "common/kinematics/urdf_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

#include "common/runtime/error.h"
#include "tests/common/kinematics/arms.h"

namespace nbs {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;

std::string ReadText(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// The small arm's URDF with one piece of text replaced, once.
std::string ErrorAfter(const std::string& from, const std::string& to, const std::string& flange = "tool0") {
  std::string text = ReadText(std::filesystem::path(NBS_SOURCE_DIR) / "tests/common/kinematics/irb120.urdf");
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("nbs_urdf_" + std::to_string(getpid()) + ".urdf");
  std::ofstream(file) << text;
  std::string error;
  try {
    ReadArm(file, "base", flange);
  } catch (const ConfigError& e) {
    error = e.what();
  }
  std::filesystem::remove(file);
  return error;
}

TEST(UrdfReader, Kr16HasABodyOnEveryLink) {
  const ArmModel model = ReadKr16();
  ASSERT_EQ(model.links.size(), 7u);
  EXPECT_EQ(model.links[0].blocks.size(), 1u);
  EXPECT_EQ(model.links[1].blocks.size(), 1u);
  // Spheres at the ends of cylinders are part of their capsules.
  const size_t capsules[] = {0, 0, 2, 5, 1, 2, 1};
  for (int k = 0; k < 7; ++k) EXPECT_EQ(model.links[k].capsules.size(), capsules[k]) << k;
}

TEST(UrdfReader, MissingFileIsRefused) { EXPECT_THROW(ReadArm("/nowhere/arm.urdf", "base", "tool0"), ConfigError); }

TEST(UrdfReader, BrokenXmlIsRefusedWithItsLine) {
  EXPECT_THAT(ErrorAfter("</link>", "</lnk>"), AllOf(HasSubstr(".urdf:"), HasSubstr("no valid XML")));
}

TEST(UrdfReader, XmlThatIsNoUrdfIsRefused) {
  EXPECT_THAT(ErrorAfter("<robot name=\"abb_irb_120\">", "<robot>"), HasSubstr("no valid URDF"));
}

TEST(UrdfReader, JointWithoutLimitsIsRefused) {
  EXPECT_THAT(ErrorAfter("<limit lower=\"-2.87979\" upper=\"2.87979\" velocity=\"4.36332\" effort=\"0\"/>", ""),
              HasSubstr("joint `joint_1` has no limits"));
}

TEST(UrdfReader, LimitThatUrdfdomWouldTakeAsZeroIsRefused) {
  EXPECT_THAT(ErrorAfter("lower=\"-2.87979\" ", ""), EndsWith("joint `joint_1` has limits without `lower`"));
}

TEST(UrdfReader, JointWithoutSpeedIsRefused) {
  EXPECT_THAT(ErrorAfter("velocity=\"4.36332\"", "velocity=\"0\""), HasSubstr("joint `joint_1` has no speed"));
}

TEST(UrdfReader, LimitsTheWrongWayRoundAreRefused) {
  EXPECT_THAT(ErrorAfter("lower=\"-2.87979\"", "lower=\"3\""), HasSubstr("joint `joint_1` has a lower limit"));
}

TEST(UrdfReader, NumberThatIsNoneIsRefused) {
  EXPECT_THAT(ErrorAfter("velocity=\"4.36332\"", "velocity=\"fast\""), HasSubstr("no valid URDF"));
}

TEST(UrdfReader, LinkWithoutBodyIsRefused) {
  EXPECT_THAT(ErrorAfter("<collision><geometry><sphere radius=\"0.09\"/></geometry></collision>", ""),
              EndsWith("link `link_1` has no collision body"));
}

TEST(UrdfReader, ShapeThatUrdfdomDropsIsRefused) {
  EXPECT_THAT(
      ErrorAfter("<geometry><sphere radius=\"0.09\"/></geometry>", "<geometry><ball radius=\"0.09\"/></geometry>"),
      HasSubstr("link `link_1` has 1 collision shapes, of which 1 cannot be read"));
  EXPECT_THAT(ErrorAfter("<sphere radius=\"0.09\"/>", "<sphere radius=\"wide\"/>"), HasSubstr("cannot be read"));
}

TEST(UrdfReader, ShapeWithoutSizeIsRefused) {
  EXPECT_THAT(ErrorAfter("<sphere radius=\"0.09\"/>", "<sphere radius=\"0\"/>"), HasSubstr("without size"));
}

TEST(UrdfReader, MeshAsBodyIsRefused) {
  EXPECT_THAT(ErrorAfter("<sphere radius=\"0.09\"/>", "<mesh filename=\"a.stl\"/>"),
              HasSubstr("has a mesh as collision shape"));
}

TEST(UrdfReader, SlidingJointIsRefused) {
  EXPECT_THAT(ErrorAfter("<joint name=\"joint_1\" type=\"revolute\">", "<joint name=\"joint_1\" type=\"prismatic\">"),
              HasSubstr("joint `joint_1` does not turn"));
}

TEST(UrdfReader, MissingLinkIsRefusedWithThoseThatThereAre) {
  EXPECT_THAT(ErrorAfter("tool0", "tool0", "flange"), HasSubstr("there is no link `flange` (there are: base, link_1"));
}

TEST(UrdfReader, JointOffTheChainIsRefused) {
  EXPECT_THAT(ErrorAfter("tool0", "tool0", "link_5"), HasSubstr("joint `joint_6` moves but is not on the way"));
}

}  // namespace
}  // namespace nbs
