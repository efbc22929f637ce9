#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include "common/bus/service_main.h"
#include "tests/common/bus/fake_nodes.h"

namespace {

// A sensor that differs from itself on every start, as no service may.
class FickleSensor : public nbs::Node {
 public:
  void Start(nbs::Outbox& out) override {
    nbs::Stripe stripe;
    stripe.ranges_m = {
        static_cast<float>(std::chrono::steady_clock::now().time_since_epoch().count() % 1000000) * 1e-6f + 0.1f};
    out.push_back(stripe);
  }
  size_t NextInput() const override { return nbs::StreamOf<nbs::Profile>(); }
  void Handle(const nbs::Message&, nbs::Outbox&) override {}
};

// Computes for a minute once it has been started.
class BusyMesher : public nbs::Node {
 public:
  void Start(nbs::Outbox&) override { std::this_thread::sleep_for(std::chrono::minutes(1)); }
  size_t NextInput() const override { return kNoInput; }
  void Handle(const nbs::Message&, nbs::Outbox&) override {}
};

// Publishes profiles without being asked.
class ProfileSource : public nbs::Node {
 public:
  ProfileSource(int count, int points) : count_(count), points_(points) {}
  void Start(nbs::Outbox& out) override {
    for (int i = 0; i < count_; ++i) {
      nbs::Profile profile{40000 * i, i + 1 == count_, {}};
      if (!profile.end_of_scan) profile.ranges_m.assign(static_cast<size_t>(points_), 0.3f);
      out.push_back(std::move(profile));
    }
  }
  size_t NextInput() const override { return kNoInput; }
  void Handle(const nbs::Message&, nbs::Outbox&) override {}

 private:
  int count_;
  int points_;
};

std::unique_ptr<nbs::Node> MakeNode(const std::string& kind, int count, int size) {
  if (kind == "robot") return std::make_unique<nbs::FakeRobot>(count);
  if (kind == "simulator") return std::make_unique<nbs::FakeSimulator>(size);
  if (kind == "sensor") return std::make_unique<nbs::FakeSensor>();
  if (kind == "mesher") return std::make_unique<nbs::FakeMesher>(count, size);
  if (kind == "reporter") return std::make_unique<nbs::FakeReader<nbs::MeshDelta>>();
  if (kind == "voxelmap") return std::make_unique<nbs::FakeReader<nbs::Stripe>>();
  if (kind == "profiles") return std::make_unique<ProfileSource>(count, size);
  if (kind == "profile_reader") return std::make_unique<nbs::FakeReader<nbs::Profile>>();
  if (kind == "fickle") return std::make_unique<FickleSensor>();
  if (kind == "busy") return std::make_unique<BusyMesher>();
  return nullptr;
}

}  // namespace

/// probe_service SERVICE KIND COUNT SIZE OPTION…: a service with a fake node, for tests and measurements of the bus.
int main(int argc, char** argv) {
  if (argc < 5) return 1;
  const std::string kind = argv[2];
  const int count = std::atoi(argv[3]);
  const int size = std::atoi(argv[4]);
  argv[4] = argv[0];
  return nbs::RunService(argv[1], argc - 4, argv + 4,
                         [&](const nbs::RunConfig&) { return MakeNode(kind, count, size); });
}
