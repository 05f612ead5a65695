/// The same work on many items by a few threads, with the same result for any number of them.
#pragma once

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace tractus::lab {

/// work(item) for each item 0 … items − 1, each once, in any order; items must not touch each
/// other's results.
template <class Work>
void parallel(int items, int threads, const Work& work) {
  std::atomic<int> next{0};
  const auto run = [&] {
    for (int item = next++; item < items; item = next++) work(item);
  };
  std::vector<std::jthread> others;
  for (int k = 1; k < std::min(threads, items); ++k) others.emplace_back(run);
  run();
}

}  // namespace tractus::lab
