#include "services/mesher/remesh.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <stdexcept>

#include "services/mesher/mesher_node.h"
#include "tests/services/mesher/synthetic_scan.h"

namespace nbs {
namespace {

/// Scans of a sphere from all around, by a robot that is up to 1 mm off.
std::vector<Stripe> MakeScans() {
  std::vector<Stripe> stripes;
  for (Sweep sweep : MakeSweepsAround(0.05, 0.30, 3, 0.7)) {
    sweep.offset_W = 1e-3 * Eigen::Vector3d(std::sin(1.7 * sweep.scan), std::cos(2.3 * sweep.scan), 0.0);
    for (const Stripe& stripe : ScanSolid(MakeSolidSphere(0.05), {}, sweep)) stripes.push_back(stripe);
  }
  return stripes;
}

/// Root mean square distance of the vertices from the sphere that fits them best (algebraically).
double CalcRoughness(const MeshReplica& replica) {
  const TriangleMesh mesh = replica.MakeCompactMesh();
  const auto count = static_cast<Eigen::Index>(mesh.vertices_W.size());
  Eigen::MatrixX4d rows(count, 4);
  for (Eigen::Index i = 0; i < count; ++i) rows.row(i) << mesh.vertices_W[i].cast<double>().transpose(), 1.0;
  const Eigen::VectorXd squares = rows.leftCols<3>().rowwise().squaredNorm();
  const Eigen::Vector4d fit = rows.colPivHouseholderQr().solve(squares);
  const Eigen::Vector3d middle = 0.5 * fit.head<3>();
  const double radius = std::sqrt(fit[3] + middle.squaredNorm());
  const Eigen::VectorXd off = (rows.leftCols<3>().rowwise() - middle.transpose()).rowwise().norm().array() - radius;
  return std::sqrt(off.squaredNorm() / static_cast<double>(count));
}

TEST(Remesh, AScanThatWasCutShortCountsAsClosed) {
  std::vector<Stripe> whole = MakeScans(), cut = whole;
  ASSERT_TRUE(cut.back().end_of_scan);
  cut.pop_back();
  const Registered a = Remesh({}, whole), b = Remesh({}, cut);
  EXPECT_EQ(std::get<MeshDelta>(a.mesh[0]).triangles, std::get<MeshDelta>(b.mesh[0]).triangles);
  EXPECT_TRUE(std::get<MeshDelta>(b.mesh[0]).end_of_scan);
  EXPECT_EQ(b.stripes.size(), cut.size());
  EXPECT_THROW(Remesh({}, {}), std::invalid_argument);
}

TEST(Remesh, GivesTheMeshThatTheMovedStripesGive) {
  const Registered registered = Remesh({}, MakeScans());
  MesherNode node{RunConfig{}};
  MeshReplica streamed, anew;
  Outbox out;
  for (const Message& stripe : registered.stripes) node.Handle(stripe, out);
  for (const Message& message : out) {
    if (const auto* delta = std::get_if<MeshDelta>(&message)) streamed.Apply(*delta);
  }
  ASSERT_EQ(registered.mesh.size(), 2u);
  anew.Apply(std::get<MeshDelta>(registered.mesh[0]));
  EXPECT_EQ(anew.MakeCompactMesh().vertices_W, streamed.MakeCompactMesh().vertices_W);
  EXPECT_EQ(anew.MakeCompactMesh().triangles, streamed.MakeCompactMesh().triangles);
  EXPECT_EQ(std::get<MeshScan>(registered.mesh[1]), std::get<MeshScan>(out.back()));
}

TEST(Remesh, IsSmootherThanWhatWasStreamed) {
  MesherNode node{RunConfig{}};
  MeshReplica streamed, anew;
  Outbox out;
  for (const Stripe& stripe : MakeScans()) node.Handle(stripe, out);
  for (const Message& message : out) {
    if (const auto* delta = std::get_if<MeshDelta>(&message)) streamed.Apply(*delta);
  }
  anew.Apply(std::get<MeshDelta>(Remesh({}, MakeScans()).mesh[0]));
  EXPECT_GT(CalcRoughness(streamed), 0.15e-3);
  EXPECT_LT(CalcRoughness(anew), 0.05e-3);
}

TEST(Remesh, TwiceGivesTheSameBits) {
  const Registered a = Remesh({}, MakeScans()), b = Remesh({}, MakeScans());
  EXPECT_EQ(std::get<MeshDelta>(a.mesh[0]), std::get<MeshDelta>(b.mesh[0]));
  for (size_t i = 0; i < a.stripes.size(); ++i)
    ASSERT_EQ(std::get<Stripe>(a.stripes[i]).X_WS.matrix(), std::get<Stripe>(b.stripes[i]).X_WS.matrix());
}

}  // namespace
}  // namespace nbs
