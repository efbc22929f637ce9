#include "sim/render.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/sim/shapes.h"

namespace nbs {
namespace {

struct Color {
  int red, green, blue;
};

Color At(const Picture& picture, int x, int y) {
  const size_t at = (static_cast<size_t>(y) * picture.width + x) * 3;
  return {picture.rgb[at], picture.rgb[at + 1], picture.rgb[at + 2]};
}

View MakeSmallView() {
  View view;
  view.width = 140;
  view.height = 180;
  view.elevation_rad = 0.0;
  return view;
}

int CountRed(const Picture& picture) {
  int count = 0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const Color c = At(picture, x, y);
      count += c.red > 150 && c.green < 80 && c.blue < 80;
    }
  }
  return count;
}

TEST(MeshRenderer, SphereFillsItsDiscAndLeavesTheCornersAlone) {
  const Picture picture = MeshRenderer(MakeSphere(0.1f, 4)).Render(MakeSmallView());
  ASSERT_EQ(picture.rgb.size(), 140u * 180u * 3u);
  const Color middle = At(picture, 70, 90), corner = At(picture, 2, 2);
  EXPECT_GT(middle.red, middle.blue);
  EXPECT_EQ(corner.red, corner.blue);
}

TEST(MeshRenderer, LightComesFromTheUpperLeft) {
  const Picture picture = MeshRenderer(MakeSphere(0.1f, 4)).Render(MakeSmallView());
  EXPECT_GT(At(picture, 50, 70).red, At(picture, 90, 110).red + 20);
}

TEST(MeshRenderer, BackSideIsBlue) {
  TriangleMesh sphere = MakeSphere(0.1f, 4);
  for (auto& t : sphere.triangles) std::swap(t[0], t[1]);
  const Color middle = At(MeshRenderer(sphere).Render(MakeSmallView()), 70, 90);
  EXPECT_GT(middle.blue, middle.red);
}

TEST(MeshRenderer, BordersComeOutRedOnlyWhenAskedFor) {
  TriangleMesh sphere = MakeSphere(0.1f, 4);
  std::erase_if(sphere.triangles, [&](const auto& t) { return sphere.vertices_W[t[0]].z() > 0.03f; });
  const MeshRenderer renderer(sphere);
  View view = MakeSmallView();
  EXPECT_EQ(CountRed(renderer.Render(view)), 0);
  view.mark_borders = true;
  EXPECT_GT(CountRed(renderer.Render(view)), 50);
}

TEST(MeshRenderer, HiddenBordersAreNotDrawn) {
  TriangleMesh sphere = MakeSphere(0.1f, 4);
  std::erase_if(sphere.triangles, [&](const auto& t) { return sphere.vertices_W[t[0]].y() > 0.08f; });
  View view = MakeSmallView();
  view.mark_borders = true;
  EXPECT_EQ(CountRed(MeshRenderer(sphere).Render(view)), 0);
}

TEST(MeshRenderer, AzimuthWalksAroundTheObject) {
  // A ball at +x: in front it is to the right; from the figure's left side (+x, azimuth 90 degrees) it is in the
  // middle.
  TriangleMesh ball = MakeSphere(0.02f, 3);
  for (auto& p : ball.vertices_W) p.x() += 0.1f;
  View view = MakeSmallView();
  view.frame_W = Eigen::AlignedBox3d(Eigen::Vector3d::Constant(-0.12), Eigen::Vector3d::Constant(0.12));
  const MeshRenderer renderer(ball);
  std::vector<Picture> sides;
  for (int side = 0; side < 3; ++side) {
    view.azimuth_rad = side * 0.5 * std::numbers::pi;
    sides.push_back(renderer.Render(view));
  }
  const auto is_ball = [](const Color& c) { return c.red != c.blue; };
  EXPECT_TRUE(is_ball(At(sides[0], 111, 90)));
  EXPECT_TRUE(is_ball(At(sides[1], 70, 90)));
  EXPECT_TRUE(is_ball(At(sides[2], 28, 90)));
  EXPECT_FALSE(is_ball(At(sides[0], 28, 90)));
}

TEST(MeshRenderer, ColoursAndOpennessOfVerticesAreTakenOver) {
  const TriangleMesh sphere = MakeSphere(0.1f, 4);
  Surface surface;
  surface.colors.assign(sphere.vertices_W.size(), Eigen::Vector3f(0.1f, 0.9f, 0.1f));
  const Color green = At(MeshRenderer(sphere, surface).Render(MakeSmallView()), 70, 90);
  EXPECT_GT(green.green, 2 * green.red);
  surface.openness.assign(sphere.vertices_W.size(), 0.0f);
  EXPECT_LT(At(MeshRenderer(sphere, surface).Render(MakeSmallView()), 70, 90).green, green.green);
  surface.colors.pop_back();
  EXPECT_THROW(MeshRenderer(sphere, surface), std::invalid_argument);
}

TEST(MeshRenderer, ProjectionSaysWhereAPointIsDrawn) {
  TriangleMesh ball = MakeSphere(0.004f, 3);
  for (auto& p : ball.vertices_W) p += Eigen::Vector3f(0.03f, 0.02f, -0.05f);
  for (const bool tight : {false, true}) {
    View view = MakeSmallView();
    view.azimuth_rad = 0.4;
    view.elevation_rad = 0.3;
    view.tight = tight;
    view.frame_W = Eigen::AlignedBox3d(Eigen::Vector3d::Constant(-0.1), Eigen::Vector3d::Constant(0.1));
    const Eigen::Vector2d at = Projection(view, *view.frame_W).Project({0.03, 0.02, -0.05});
    const Color there = At(MeshRenderer(ball).Render(view), static_cast<int>(at.x()), static_cast<int>(at.y()));
    EXPECT_NE(there.red, there.blue);
  }
}

TEST(MeshRenderer, PointsBehindTheMeshAreHidden) {
  const MeshRenderer renderer(MakeSphere(0.1f, 4));
  View view = MakeSmallView();
  EXPECT_EQ(renderer.FindHidden({{0, -0.2, 0}, {0, 0.2, 0}, {0.2, 0.2, 0}}, view), (std::vector<uint8_t>{0, 1, 0}));
}

TEST(MeshRenderer, SamePictureEveryTimeAndNothingForAnEmptyMesh) {
  const TriangleMesh sphere = MakeSphere(0.1f, 3);
  EXPECT_EQ(EncodePng(MeshRenderer(sphere).Render(MakeSmallView())),
            EncodePng(MeshRenderer(sphere).Render(MakeSmallView())));
  EXPECT_EQ(CountRed(MeshRenderer(TriangleMesh{}).Render(MakeSmallView())), 0);
}

TEST(EncodePng, BeginsWithTheSignatureAndRefusesAPictureThatIsNotFull) {
  EXPECT_EQ(EncodePng({1, 1, {1, 2, 3}}).substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_THROW(EncodePng({2, 1, {1, 2, 3}}), std::invalid_argument);
}

}  // namespace
}  // namespace nbs
