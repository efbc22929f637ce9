#pragma once

#include <cstdint>
#include <random>

#include "common/messages/translate.h"

namespace nbs {

/// A sound message of the given stream with random values; equal generators give equal messages.
Message MakeRandomMessage(size_t stream, std::mt19937_64& random);

MeshDelta MakeRandomMeshDelta(std::mt19937_64& random, size_t vertices, size_t triangles);
VoxelDelta MakeRandomVoxelDelta(std::mt19937_64& random, size_t runs, int longest_run);
CandidateSet MakeRandomCandidateSet(std::mt19937_64& random, size_t candidates);

}  // namespace nbs
