#include "common/bus/wake_event.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <cstdint>

#include "common/runtime/run_failure.h"

namespace nbs {

WakeEvent::WakeEvent() : descriptor_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (descriptor_ < 0) throw RunFailure("cannot create an event descriptor: too many open files");
}

WakeEvent::~WakeEvent() { close(descriptor_); }

void WakeEvent::Set() {
  const uint64_t one = 1;
  // It fails only when the event has been set 2^64 - 1 times over, and then it is set.
  if (write(descriptor_, &one, sizeof one) < 0) return;
}

void WakeEvent::Clear() {
  uint64_t count;
  if (read(descriptor_, &count, sizeof count) < 0) return;  // It was not set.
}

}  // namespace nbs
