#pragma once

#include <string>

#include "common/runtime/node.h"

namespace nbs {

/// Why no sender of ours would send this message, in words; empty if nothing speaks against it.
///
/// Looked for: numbers that are not finite, rotations that are none, counts and times below zero, scan numbers below
/// zero or above kMaxScans, voxel runs that overlap or do not add up, mesh slots of 2^28 and more, vertices
/// more than a kilometre away, more joints than any arm has (kMaxJoints). The ranges of a Profile are not looked
/// at: they are the instrument's raw data, judged by the sensor service.
std::string FindFault(const Message& message);

}  // namespace nbs
