#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace nbs {

/// Calls work(0) … work(threads - 1), each on a thread of its own, of which this thread is one; returns when all have
/// ended. `work` must not throw.
///
/// @param threads  >= 1.
template <typename Work>
void RunOnThreads(int threads, const Work& work) {
  std::vector<std::jthread> others;
  for (int thread = 1; thread < threads; ++thread) others.emplace_back([&work, thread] { work(thread); });
  work(0);
}

/// Calls work(i) once for each i < count, on so many threads; which thread takes which i is not determined, so each
/// must write to what is its own alone. `work` must not throw.
template <typename Work>
void ForEachIndex(size_t count, int threads, const Work& work) {
  std::atomic<size_t> next = 0;
  const auto helpers = std::min(static_cast<size_t>(threads), count);
  RunOnThreads(static_cast<int>(helpers), [&](int) {
    for (size_t i = next++; i < count; i = next++) work(i);
  });
}

}  // namespace nbs
