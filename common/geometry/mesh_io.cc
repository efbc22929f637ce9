#include "common/geometry/mesh_io.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <bit>
#include <cctype>
#include <fstream>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "common/geometry/ply_reader.h"
#include "common/runtime/error.h"

namespace nbs {
namespace {

static_assert(std::endian::native == std::endian::little, "WriteMeshPly copies memory as it is");

void Append(std::string& bytes, const void* data, size_t size) { bytes.append(static_cast<const char*>(data), size); }

std::string MakePlyHeader(const TriangleMesh& mesh, std::span<const VertexProperty> extra) {
  std::ostringstream header;
  header << "ply\nformat binary_little_endian 1.0\nelement vertex " << mesh.vertices_W.size() << "\n";
  for (const char* name : {"x", "y", "z"}) header << "property float " << name << "\n";
  if (!mesh.normals_W.empty()) {
    for (const char* name : {"nx", "ny", "nz"}) header << "property float " << name << "\n";
  }
  for (const VertexProperty& property : extra) header << "property float " << property.name << "\n";
  header << "element face " << mesh.triangles.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
  return header.str();
}

void CheckSizes(const TriangleMesh& mesh, std::span<const VertexProperty> extra) {
  const size_t vertices = mesh.vertices_W.size();
  if (!mesh.normals_W.empty() && mesh.normals_W.size() != vertices) {
    throw std::invalid_argument("WriteMeshPly: " + std::to_string(mesh.normals_W.size()) + " normals for " +
                                std::to_string(vertices) + " vertices");
  }
  for (const VertexProperty& property : extra) {
    if (property.values.size() == vertices) continue;
    throw std::invalid_argument("WriteMeshPly: property " + property.name + " has " +
                                std::to_string(property.values.size()) + " values for " + std::to_string(vertices) +
                                " vertices");
  }
}

void WriteWhole(const std::filesystem::path& file, const std::string& bytes) {
  std::filesystem::path temporary = file;
  temporary += ".part";
  std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  std::error_code error;
  if (stream) std::filesystem::rename(temporary, file, error);
  if (!stream || error) throw ConfigError("Cannot write " + file.string() + ": check folder, rights and free space.");
}

/// Gives one number to vertices that are equal in all coordinates, the lowest first, and drops the others.
void JoinVertices(TriangleMesh& mesh) {
  const auto& p = mesh.vertices_W;
  std::vector<uint32_t> order(p.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&p](uint32_t i) { return std::array<float, 3>{p[i].x(), p[i].y(), p[i].z()}; };
  std::sort(order.begin(), order.end(), [&key](uint32_t a, uint32_t b) {
    const auto key_a = key(a);
    const auto key_b = key(b);
    return key_a != key_b ? key_a < key_b : a < b;
  });
  std::vector<uint32_t> first(p.size());
  for (size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && key(order[i]) == key(order[i - 1]);
    first[order[i]] = same ? first[order[i - 1]] : order[i];
  }
  std::vector<uint32_t> compact(p.size());
  std::vector<Eigen::Vector3f> joined;
  for (uint32_t i = 0; i < p.size(); ++i) {
    if (first[i] == i) {
      compact[i] = static_cast<uint32_t>(joined.size());
      joined.push_back(p[i]);
    }
  }
  for (auto& triangle : mesh.triangles) {
    for (uint32_t& v : triangle) v = compact[first[v]];
  }
  mesh.vertices_W = std::move(joined);
}

/// STL and OBJ through assimp.
TriangleMesh ReadByAssimp(const std::filesystem::path& file) {
  Assimp::Importer importer;
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene =
      importer.ReadFile(file.string(), aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_PreTransformVertices);
  if (scene == nullptr) throw std::runtime_error(std::string("cannot be read as a mesh: ") + importer.GetErrorString());
  TriangleMesh mesh;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& part = *scene->mMeshes[m];
    const auto offset = static_cast<uint32_t>(mesh.vertices_W.size());
    for (unsigned v = 0; v < part.mNumVertices; ++v) {
      mesh.vertices_W.emplace_back(part.mVertices[v].x, part.mVertices[v].y, part.mVertices[v].z);
    }
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices != 3) continue;
      for (unsigned i = 0; i < 3; ++i) {
        if (face.mIndices[i] >= part.mNumVertices)
          throw std::runtime_error("has a face with an impossible vertex number");
      }
      mesh.triangles.push_back({offset + face.mIndices[0], offset + face.mIndices[1], offset + face.mIndices[2]});
    }
  }
  return mesh;
}

/// Refuses what no later step could use, and tidies the rest.
void Check(TriangleMesh& mesh) {
  for (const Eigen::Vector3f& p : mesh.vertices_W) {
    if (!p.allFinite()) throw std::runtime_error("has a coordinate that is not finite");
  }
  for (const auto& triangle : mesh.triangles) {
    for (uint32_t v : triangle) {
      if (v >= mesh.vertices_W.size()) throw std::runtime_error("has a face with an impossible vertex number");
    }
  }
  std::erase_if(mesh.triangles, [](const auto& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  if (mesh.triangles.empty()) throw std::runtime_error("holds no triangle");
  for (Eigen::Vector3f& normal : mesh.normals_W) {
    if (!normal.allFinite()) throw std::runtime_error("has a normal that is not finite");
    normal.normalize();
  }
}

std::string ReadWhole(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string content{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream.is_open() || stream.bad()) throw std::runtime_error("cannot be opened");
  return content;
}

TriangleMesh ReadUnchecked(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) throw std::runtime_error("does not exist");
  if (!std::filesystem::is_regular_file(file)) throw std::runtime_error("is not a file");
  if (std::filesystem::file_size(file) == 0) throw std::runtime_error("is empty");
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (extension == ".ply") return ParsePly(ReadWhole(file));
  if (extension != ".stl" && extension != ".obj") {
    throw std::runtime_error("is of an unknown type: a mesh file ends in .ply, .stl or .obj");
  }
  TriangleMesh mesh = ReadByAssimp(file);
  JoinVertices(mesh);
  return mesh;
}

}  // namespace

void WriteMeshPly(const std::filesystem::path& file, const TriangleMesh& mesh, std::span<const VertexProperty> extra) {
  CheckSizes(mesh, extra);
  std::string bytes = MakePlyHeader(mesh, extra);
  bytes.reserve(bytes.size() + mesh.vertices_W.size() * (24 + 4 * extra.size()) + mesh.triangles.size() * 13);
  for (size_t v = 0; v < mesh.vertices_W.size(); ++v) {
    Append(bytes, mesh.vertices_W[v].data(), 12);
    if (!mesh.normals_W.empty()) Append(bytes, mesh.normals_W[v].data(), 12);
    for (const VertexProperty& property : extra) Append(bytes, &property.values[v], 4);
  }
  for (const auto& triangle : mesh.triangles) {
    bytes.push_back(3);
    Append(bytes, triangle.data(), 12);
  }
  WriteWhole(file, bytes);
}

TriangleMesh ReadMesh(const std::filesystem::path& file) {
  try {
    TriangleMesh mesh = ReadUnchecked(file);
    Check(mesh);
    return mesh;
  } catch (const std::exception& error) {
    throw ConfigError("The mesh file " + file.string() + " " + error.what() + ".");
  }
}

}  // namespace nbs
