#include "tests/common/bus/memory_bus.h"

#include <algorithm>

#include "common/bus/window.h"

namespace nbs {

class MemoryBus::MemberTransport : public Transport {
 public:
  explicit MemberTransport(std::shared_ptr<Shared> shared)
      : shared_(std::move(shared)), self_(std::make_shared<Member>()) {
    const std::lock_guard lock(shared_->mutex);
    shared_->members.push_back(self_);
  }

  ~MemberTransport() override {
    const std::lock_guard lock(shared_->mutex);
    std::erase(shared_->members, self_);
  }

  void Subscribe(const std::string& channel) override {
    const std::lock_guard lock(shared_->mutex);
    self_->channels.insert(channel);
  }

  void Publish(std::string_view channel, std::span<const uint8_t> data) override {
    const size_t cost = EstimateKernelBytes(data.size());
    const std::lock_guard lock(shared_->mutex);
    for (const auto& member : shared_->members) {
      if (member->bytes + cost > shared_->receive_buffer) {
        ++shared_->lost;
        continue;
      }
      member->bytes += cost;
      shared_->peak = std::max(shared_->peak, member->bytes);
      member->buffer.push_back({std::string(channel), {data.begin(), data.end()}});
    }
    shared_->arrived.notify_all();
  }

  void Poll(std::chrono::microseconds timeout, const Handler& handler) override {
    std::deque<Datagram> arrived;
    {
      std::unique_lock lock(shared_->mutex);
      shared_->arrived.wait_for(lock, timeout, [this] { return self_->woken || !self_->buffer.empty(); });
      self_->woken = false;
      arrived.swap(self_->buffer);
      self_->bytes = 0;
      std::erase_if(arrived,
                    [this](const Datagram& d) { return self_->channels.find(d.channel) == self_->channels.end(); });
    }
    for (const Datagram& datagram : arrived) handler(datagram.channel, datagram.data);
  }

  void Wake() override {
    const std::lock_guard lock(shared_->mutex);
    self_->woken = true;
    shared_->arrived.notify_all();
  }

 private:
  std::shared_ptr<Shared> shared_;
  std::shared_ptr<Member> self_;
};

MemoryBus::MemoryBus(size_t receive_buffer) : shared_(std::make_shared<Shared>()) {
  shared_->receive_buffer = receive_buffer;
}

std::unique_ptr<Transport> MemoryBus::Join() { return std::make_unique<MemberTransport>(shared_); }

int64_t MemoryBus::lost() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->lost;
}

size_t MemoryBus::peak_bytes() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->peak;
}

}  // namespace nbs
