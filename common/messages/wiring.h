#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "common/runtime/node.h"

namespace nbs {

/// One stream: what travels on which channel, from whom to whom. The table in lcmtypes/README.md is checked against
/// this one.
struct StreamWiring {
  size_t stream;             ///< StreamOf<T>().
  std::string_view channel;  ///< LCM channel.
  std::string_view type;     ///< LCM type in nbs_msgs.
  std::string_view sender;   ///< Service.
  std::vector<std::string_view>
      receivers;  ///< Services; all of them are required: the sender never runs further ahead of them than its window.
};

/// All streams, ordered by stream number, so that Wiring()[n].stream == n.
std::span<const StreamWiring> Wiring();

}  // namespace nbs
