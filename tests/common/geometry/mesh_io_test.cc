#include "common/geometry/mesh_io.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include "common/runtime/error.h"

namespace nbs {
namespace {

using ::testing::HasSubstr;

class MeshIo : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) / ("mesh_io_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path Put(const std::string& name, const std::string& content) {
    const std::filesystem::path file = folder_ / name;
    std::ofstream(file, std::ios::binary) << content;
    return file;
  }

  static std::string Get(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }

  static std::string Refusal(const std::filesystem::path& file) {
    try {
      ReadMesh(file);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "accepted";
  }

  std::filesystem::path folder_;
};

TriangleMesh MakeTetrahedron() {
  TriangleMesh mesh;
  mesh.vertices_W = {{0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}, {0, 0, 0.1f}};
  for (const auto& p : mesh.vertices_W) mesh.normals_W.push_back((p - Eigen::Vector3f::Constant(0.025f)).normalized());
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

std::string MakeStl(const TriangleMesh& mesh, uint32_t announced) {
  std::string bytes(80, ' ');
  bytes.append(reinterpret_cast<const char*>(&announced), 4);
  for (const auto& t : mesh.triangles) {
    bytes.append(12, '\0');
    for (uint32_t v : t) bytes.append(reinterpret_cast<const char*>(mesh.vertices_W[v].data()), 12);
    bytes.append(2, '\0');
  }
  return bytes;
}

const char kPlyHeader[] =
    "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
    "z\n"
    "property uchar red\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";

TEST_F(MeshIo, PlyComesBackEqual) {
  const TriangleMesh mesh = MakeTetrahedron();
  WriteMeshPly(folder_ / "a.ply", mesh);
  const TriangleMesh back = ReadMesh(folder_ / "a.ply");
  EXPECT_EQ(back.vertices_W, mesh.vertices_W);
  EXPECT_EQ(back.triangles, mesh.triangles);
  ASSERT_EQ(back.normals_W.size(), mesh.normals_W.size());
  for (size_t i = 0; i < 4; ++i) EXPECT_LT((back.normals_W[i] - mesh.normals_W[i]).norm(), 1e-6f);
}

TEST_F(MeshIo, SameMeshGivesSameBytes) {
  WriteMeshPly(folder_ / "a.ply", MakeTetrahedron());
  WriteMeshPly(folder_ / "b.ply", MakeTetrahedron());
  EXPECT_EQ(Get(folder_ / "a.ply"), Get(folder_ / "b.ply"));
}

TEST_F(MeshIo, ExtraPropertiesAreWrittenAndPassedOverByTheReader) {
  const std::vector<VertexProperty> extra = {{"sigma_m", {1, 2, 3, 4}}, {"scan", {0, 0, 1, 1}}};
  WriteMeshPly(folder_ / "a.ply", MakeTetrahedron(), extra);
  EXPECT_THAT(Get(folder_ / "a.ply"), HasSubstr("property float nz\nproperty float sigma_m\nproperty float scan\n"));
  EXPECT_EQ(ReadMesh(folder_ / "a.ply").vertices_W, MakeTetrahedron().vertices_W);
}

TEST_F(MeshIo, WriterRefusesAPropertyOfWrongLength) {
  const std::vector<VertexProperty> extra = {{"sigma_m", {1, 2}}};
  EXPECT_THROW(WriteMeshPly(folder_ / "a.ply", MakeTetrahedron(), extra), std::invalid_argument);
}

TEST_F(MeshIo, WriterSaysThatAFolderIsMissing) {
  EXPECT_THROW(WriteMeshPly(folder_ / "no" / "a.ply", MakeTetrahedron()), ConfigError);
}

TEST_F(MeshIo, AsciiPlyWithPolygonIsCutIntoAFan) {
  const TriangleMesh mesh =
      ReadMesh(Put("a.ply", std::string(kPlyHeader) + "0 0 0 9\n1 0 0 9\n1 1 0 9\n0 1 0 9\n4 0 1 2 3\n"));
  const std::vector<std::array<uint32_t, 3>> expected = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(mesh.triangles, expected);
  EXPECT_EQ(mesh.vertices_W[2], Eigen::Vector3f(1, 1, 0));
}

TEST_F(MeshIo, BigEndianPlyGivesTheSameMesh) {
  WriteMeshPly(folder_ / "a.ply", MakeTetrahedron());
  std::string bytes = Get(folder_ / "a.ply");
  bytes.replace(bytes.find("little"), 6, "big");
  size_t at = bytes.find("end_header\n") + 11;
  const auto swap4 = [&bytes, &at] {
    std::reverse(bytes.begin() + at, bytes.begin() + at + 4);
    at += 4;
  };
  for (int i = 0; i < 24; ++i) swap4();
  for (int f = 0; f < 4; ++f) {
    ++at;
    for (int i = 0; i < 3; ++i) swap4();
  }
  EXPECT_EQ(ReadMesh(Put("b.ply", bytes)).vertices_W, MakeTetrahedron().vertices_W);
  EXPECT_EQ(ReadMesh(folder_ / "b.ply").triangles, MakeTetrahedron().triangles);
}

TEST_F(MeshIo, EveryCutOfAPlyIsRefused) {
  WriteMeshPly(folder_ / "a.ply", MakeTetrahedron());
  const std::string bytes = Get(folder_ / "a.ply");
  for (size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_THAT(Refusal(Put("cut.ply", bytes.substr(0, length))), HasSubstr("cut.ply")) << length;
  }
}

TEST_F(MeshIo, StlVerticesAreJoined) {
  const TriangleMesh mesh = ReadMesh(Put("a.stl", MakeStl(MakeTetrahedron(), 4)));
  EXPECT_EQ(mesh.vertices_W.size(), 4u);
  EXPECT_EQ(mesh.triangles.size(), 4u);
}

TEST_F(MeshIo, EveryCutOfAnStlIsRefused) {
  const std::string bytes = MakeStl(MakeTetrahedron(), 4);
  for (size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_THAT(Refusal(Put("cut.stl", bytes.substr(0, length))), HasSubstr("cut.stl")) << length;
  }
}

TEST_F(MeshIo, ObjGivesTheSameTrianglesAsItsFaces) {
  const TriangleMesh mesh = ReadMesh(Put("a.OBJ", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n"));
  EXPECT_EQ(mesh.vertices_W.size(), 4u);
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.vertices_W[mesh.triangles[1][1]], Eigen::Vector3f(1, 1, 0));
}

TEST_F(MeshIo, RefusalsNameFileAndReason) {
  const std::string vertices = "0 0 0 9\n1 0 0 9\n0 1 0 9\n0 1 1 9\n";
  EXPECT_THAT(Refusal(folder_ / "none.ply"), HasSubstr("none.ply does not exist."));
  EXPECT_THAT(Refusal(folder_), HasSubstr("is not a file."));
  EXPECT_THAT(Refusal(Put("a.ply", "")), HasSubstr("is empty."));
  EXPECT_THAT(Refusal(Put("a.step", "x")), HasSubstr(".ply, .stl or .obj"));
  EXPECT_THAT(Refusal(Put("a.ply", "hello")), HasSubstr("is not a PLY file"));
  EXPECT_THAT(Refusal(Put("a.stl", "hello")), HasSubstr("cannot be read as a mesh"));
  EXPECT_THAT(Refusal(Put("a.obj", "hello")), HasSubstr("cannot be read as a mesh"));
  EXPECT_THAT(Refusal(Put("a.ply", std::string(kPlyHeader) + vertices + "3 0 1 4\n")),
              HasSubstr("impossible vertex number"));
  EXPECT_THAT(Refusal(Put("a.ply", std::string(kPlyHeader) + vertices + "3 0 1 -1\n")),
              HasSubstr("impossible vertex number"));
  EXPECT_THAT(Refusal(Put("a.ply", std::string(kPlyHeader) + vertices + "2 0 1\n")), HasSubstr("holds no triangle"));
  EXPECT_THAT(Refusal(Put("a.ply", std::string(kPlyHeader) + vertices + "3 0 1 1\n")), HasSubstr("holds no triangle"));
  EXPECT_THAT(Refusal(Put("a.ply", std::string(kPlyHeader) + "0 nan 0 9 0 0 0 9 0 0 0 9 0 0 0 9 3 0 1 2")),
              HasSubstr("not finite"));
  EXPECT_THAT(Refusal(Put("a.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n")), HasSubstr("not finite"));
  EXPECT_THAT(Refusal(Put("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n")), HasSubstr("cannot be read as a mesh"));
}

TEST_F(MeshIo, AnAsciiNumberThatNoDoubleHoldsIsRefusedWhereLargeAndZeroWhereSmall) {
  const std::string rest = " 0 0 9\n1 0 0 9\n0 1 0 9\n0 1 1 9\n3 0 1 2\n";
  for (const std::string number : {"1e400", "-1e400", "1e99999"})
    EXPECT_THAT(Refusal(Put("a.ply", kPlyHeader + number + rest)), HasSubstr("where a number should be, `" + number));
  EXPECT_EQ(ReadMesh(Put("a.ply", kPlyHeader + std::string("-1e-400") + rest)).vertices_W.at(0).x(), 0.0f);
}

TEST_F(MeshIo, AHugeAnnouncedCountIsRefusedWithoutAllocating) {
  std::string text = kPlyHeader;
  text.replace(text.find("vertex 4"), 8, "vertex 4000000000000");
  EXPECT_THAT(Refusal(Put("a.ply", text + "0 0 0 9")), HasSubstr("cut short"));
}

}  // namespace
}  // namespace nbs
