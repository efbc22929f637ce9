#include "tests/common/bus/test_service.h"

#include <stdlib.h>
#include <unistd.h>

namespace nbs {

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "nbs_bus_XXXXXX").string();
  path_ = mkdtemp(name.data());
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

TestService::TestService(ServiceSetup setup, std::unique_ptr<Node> node, std::unique_ptr<Transport> transport)
    : node_(std::move(node)),
      transport_(std::move(transport)),
      runner_(std::make_unique<ServiceRunner>(setup, *node_, *transport_)) {
  thread_ = std::thread([this] {
    try {
      runner_->Run();
    } catch (const std::exception& error) {
      failure_ = error.what();
    }
    ended_ = true;
    // Like a process that is no more, it does not stand on the bus with a full buffer.
    while (!stopped_) transport_->Poll(std::chrono::milliseconds(5), [](std::string_view, std::span<const uint8_t>) {});
  });
}

void TestService::Stop() {
  stopped_ = true;
  runner_->Stop();
  if (thread_.joinable()) thread_.join();
  while (!runner_->JoinFold(std::chrono::milliseconds(100))) {
  }
}

bool TestService::WaitForEnd(std::chrono::seconds limit) const {
  const auto until = std::chrono::steady_clock::now() + limit;
  while (!ended_ && std::chrono::steady_clock::now() < until) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  return ended_;
}

std::string MakeTestUrl() {
  static int count = 0;
  const int port = 20000 + (getpid() * 7 + 1009 * count++) % 40000;
  return "udpm://239.255.76.67:" + std::to_string(port) + "?ttl=0";
}

}  // namespace nbs
