#pragma once

#include <cstdint>
#include <filesystem>

namespace nbs {

/// Merges the histories of a run (streams_folder/*.lcm, and the recorded heartbeats in streams_folder/status) into one
/// plain LCM log, ordered by (utime, source, seq, channel); event timestamps are utimes. Replaces the file whole or not
/// at all. A torn tail of a history is passed over.
///
/// @returns The number of events written.
/// @throws RunFailure if a history is damaged, or the log cannot be written.
int64_t MergeHistories(const std::filesystem::path& streams_folder, const std::filesystem::path& out_file);

}  // namespace nbs
