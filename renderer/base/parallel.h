// Loops on all cores.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <thread>
#include <vector>

namespace irad {

/// Calls work(i) for every i below `count`, on this thread and others, which take `block` of them at once; `threads` 0:
/// as many as there are cores. What it does for one must not depend on others, and throws at most on this thread.
void parallelFor(size_t count, const auto& work, uint32_t threads = 0, size_t block = 1) {
  std::atomic<size_t> next = 0;
  const auto blocks = [&] {
    for (size_t first; (first = block * next++) < count;)
      for (size_t i = first; i < std::min(count, first + block); ++i) work(i);
  };
  if (threads == 0) threads = std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::jthread> others;
  for (size_t t = 1; t < threads && t * block < count; ++t) others.emplace_back(blocks);
  blocks();
}

}  // namespace irad
