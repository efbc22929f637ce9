#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace nbs {

/// Which samples each of many scan paths covers, one bit for each.
class CoverTable {
 public:
  CoverTable(size_t paths, size_t samples);

  size_t paths() const { return paths_; }
  size_t samples() const { return samples_; }

  /// Different paths may be filled from different threads.
  void Mark(size_t path, size_t sample) { words_[path * stride_ + sample / 64] |= uint64_t{1} << (sample % 64); }
  bool covers(size_t path, size_t sample) const { return (row(path)[sample / 64] >> (sample % 64) & 1) != 0; }
  std::span<const uint64_t> row(size_t path) const { return {words_.data() + path * stride_, stride_}; }

  /// Samples that at least one path covers.
  size_t CountCovered() const;

 private:
  size_t paths_, samples_, stride_;
  std::vector<uint64_t> words_;
};

/// What a scan path is chosen by.
enum class CoverRule : uint8_t {
  kScan,   ///< The most samples not yet covered.
  kMetre,  ///< The most of them for each metre of the path, with metre_offset_m added to its length.
};

struct CoverSettings {
  CoverRule rule = CoverRule::kScan;
  double metre_offset_m = 0.15;  ///< What a scan costs however short it is.
  int max_paths = 100;
  std::optional<size_t> first;  ///< The path to begin with, whatever it covers; none: the rule chooses it as well.
};

struct CoverStep {
  size_t path = 0;
  size_t covered = 0;  ///< Samples covered by this and all paths before it.
};

/// Paths in the order in which a greedy cover takes them, until no path covers a sample more or max_paths are taken.
/// Between equal paths the lower number wins. (Greedy comes within 1 - 1/e of the most that so many paths can cover:
/// Nemhauser, Wolsey, Fisher, Mathematical Programming 14, 1978, DOI 10.1007/BF01588971.)
///
/// @param lengths_m  One a path, >= 0.
/// @throws std::invalid_argument if there is not one length a path, or `first` is no path.
std::vector<CoverStep> FindGreedyCover(const CoverTable& table, std::span<const double> lengths_m,
                                       const CoverSettings& settings);

}  // namespace nbs
