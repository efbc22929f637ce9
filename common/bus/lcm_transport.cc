#include "common/bus/lcm_transport.h"

#include <lcm/lcm.h>
#include <poll.h>

#include <algorithm>
#include <cstdlib>

#include "common/runtime/error.h"

namespace nbs {
namespace {

constexpr const char* kBufferOption = "recv_buf_size=";
constexpr int kMostDatagramsPerPoll = 64;  // So that repair, credit and heartbeat go out while a flood comes in.

[[noreturn]] void ThrowCannotOpen(const std::string& url) {
  throw ConfigError("cannot open the bus at " + url +
                    ": if this machine has no multicast route, run `ip route add 239.255.76.67/32 dev lo` as root "
                    "before the services start (without root: "
                    "`unshare -Urn`, then `ip link set lo up; ip route add 224.0.0.0/4 dev lo`)");
}

}  // namespace

struct LcmTransport::Lcm {
  explicit Lcm(const std::string& url) : handle(lcm_create(url.c_str())) {}
  ~Lcm() {
    if (handle != nullptr) lcm_destroy(handle);
  }
  Lcm(const Lcm&) = delete;
  Lcm& operator=(const Lcm&) = delete;

  lcm_t* handle;
};

std::string ResolveLcmUrl(const std::string& url) {
  std::string resolved = url;
  if (resolved.empty()) {
    const char* from_environment = std::getenv("LCM_DEFAULT_URL");
    if (from_environment != nullptr) resolved = from_environment;
  }
  if (resolved.empty()) resolved = "udpm://239.255.76.67:7667?ttl=0";
  if (resolved.starts_with("udpm://") && resolved.find(kBufferOption) == std::string::npos) {
    resolved += resolved.find('?') == std::string::npos ? "?" : "&";
    resolved += kBufferOption + std::string("4194304");
  }
  return resolved;
}

LcmTransport::LcmTransport(const std::string& url) : url_(ResolveLcmUrl(url)), lcm_(std::make_unique<Lcm>(url_)) {
  if (lcm_->handle == nullptr) ThrowCannotOpen(url_);
}

LcmTransport::~LcmTransport() = default;

void LcmTransport::Subscribe(const std::string& channel) {
  const auto copy = [](const lcm_recv_buf_t* received, const char* name, void* inbox) {
    const auto* data = static_cast<const uint8_t*>(received->data);
    static_cast<std::vector<Datagram>*>(inbox)->push_back({name, {data, data + received->data_size}});
  };
  lcm_subscription_t* subscription = lcm_subscribe(lcm_->handle, channel.c_str(), copy, &inbox_);
  if (subscription == nullptr) ThrowCannotOpen(url_);
  lcm_subscription_set_queue_capacity(subscription, 0);
}

void LcmTransport::Publish(std::string_view channel, std::span<const uint8_t> data) {
  // A failed send is one more lost datagram: repair and heartbeat take care of it.
  (void)lcm_publish(lcm_->handle, std::string(channel).c_str(), data.data(), static_cast<unsigned>(data.size()));
}

void LcmTransport::Poll(std::chrono::microseconds timeout, const Handler& handler) {
  pollfd waited[2] = {{lcm_get_fileno(lcm_->handle), POLLIN, 0}, {wake_.descriptor(), POLLIN, 0}};
  const timespec limit{timeout.count() / 1000000, (timeout.count() % 1000000) * 1000};
  if (ppoll(waited, 2, &limit, nullptr) <= 0) return;
  if ((waited[1].revents & POLLIN) != 0) wake_.Clear();
  if ((waited[0].revents & POLLIN) == 0) return;
  for (int i = 0; i < kMostDatagramsPerPoll && lcm_handle_timeout(lcm_->handle, 0) > 0; ++i) {
  }
  std::vector<Datagram> arrived;
  arrived.swap(inbox_);
  for (const Datagram& datagram : arrived) handler(datagram.channel, datagram.data);
}

}  // namespace nbs
