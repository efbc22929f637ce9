#include "sim/oracle/greedy_cover.h"

#include <bit>
#include <queue>
#include <stdexcept>
#include <string>

namespace nbs {
namespace {

size_t CountNew(std::span<const uint64_t> row, const std::vector<uint64_t>& covered) {
  size_t count = 0;
  for (size_t w = 0; w < row.size(); ++w) count += static_cast<size_t>(std::popcount(row[w] & ~covered[w]));
  return count;
}

/// A path's score, new in the round it was counted in and an upper bound in every later one.
struct Bound {
  double score = 0.0;
  size_t path = 0;
  size_t round = 0;

  /// The top of a priority queue: the highest score, on a tie the lowest number.
  bool operator<(const Bound& other) const {
    return score < other.score || (score == other.score && path > other.path);
  }
};

/// Lazy greedy (Minoux, Optimization Techniques, LNCIS 7, 1978, DOI 10.1007/BFb0006528): what a path would add never
/// grows, so only paths whose old score beats the best new one are counted again.
class Chooser {
 public:
  Chooser(const CoverTable& table, std::span<const double> lengths_m, const CoverSettings& settings)
      : table_(table), lengths_m_(lengths_m), settings_(settings) {
    const std::vector<uint64_t> nothing((table.samples() + 63) / 64, 0);
    for (size_t path = 0; path < table.paths(); ++path) bounds_.push({CalcScore(path, nothing), path, 0});
  }

  /// The path to take in round `round`, after `covered`; nullopt if none covers a sample more.
  std::optional<size_t> Choose(size_t round, const std::vector<uint64_t>& covered) {
    while (!bounds_.empty() && bounds_.top().score > 0.0) {
      const Bound top = bounds_.top();
      bounds_.pop();
      if (top.round == round) return top.path;
      bounds_.push({CalcScore(top.path, covered), top.path, round});
    }
    return std::nullopt;
  }

 private:
  double CalcScore(size_t path, const std::vector<uint64_t>& covered) const {
    const double cost = settings_.rule == CoverRule::kMetre ? lengths_m_[path] + settings_.metre_offset_m : 1.0;
    return static_cast<double>(CountNew(table_.row(path), covered)) / cost;
  }

  const CoverTable& table_;
  std::span<const double> lengths_m_;
  const CoverSettings& settings_;
  std::priority_queue<Bound> bounds_;
};

}  // namespace

CoverTable::CoverTable(size_t paths, size_t samples)
    : paths_(paths), samples_(samples), stride_((samples + 63) / 64), words_(paths_ * stride_, 0) {}

size_t CoverTable::CountCovered() const {
  std::vector<uint64_t> all(stride_, 0);
  for (size_t path = 0; path < paths_; ++path) {
    for (size_t w = 0; w < stride_; ++w) all[w] |= row(path)[w];
  }
  return CountNew(all, std::vector<uint64_t>(stride_, 0));
}

std::vector<CoverStep> FindGreedyCover(const CoverTable& table, std::span<const double> lengths_m,
                                       const CoverSettings& settings) {
  if (lengths_m.size() != table.paths()) {
    throw std::invalid_argument("FindGreedyCover: " + std::to_string(lengths_m.size()) + " lengths for " +
                                std::to_string(table.paths()) + " paths");
  }
  if (settings.first && *settings.first >= table.paths()) {
    throw std::invalid_argument("FindGreedyCover: there is no path " + std::to_string(*settings.first));
  }
  std::vector<uint64_t> covered((table.samples() + 63) / 64, 0);
  Chooser chooser(table, lengths_m, settings);
  std::vector<CoverStep> steps;
  size_t count = 0;
  while (static_cast<int>(steps.size()) < settings.max_paths) {
    const bool is_given = settings.first && steps.empty();
    const std::optional<size_t> next = is_given ? settings.first : chooser.Choose(steps.size(), covered);
    if (!next) break;
    const std::span<const uint64_t> row = table.row(*next);
    count += CountNew(row, covered);
    for (size_t w = 0; w < row.size(); ++w) covered[w] |= row[w];
    steps.push_back({*next, count});
  }
  return steps;
}

}  // namespace nbs
