#pragma once

#include "common/bus/flight.h"

namespace nbs {

/// When the next heartbeat is due: at once when somebody waits for credit, within 10 ms when something has moved, every
/// 200 ms when nothing moves.
class HeartbeatClock {
 public:
  void NoteMoved() { moved_ = true; }
  void NoteHurry() { hurry_ = true; }
  void NoteSent(Instant now);

  bool IsDue(Instant now) const { return CalcDue() <= now; }
  /// A moment in the past when it is due already.
  Instant CalcDue() const;

 private:
  bool moved_ = false;
  bool hurry_ = true;
  Instant last_{};
};

}  // namespace nbs
