// Work cut into blocks for threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace flexapod {

/// work(first, last) over all of 0 to n, by the calling thread and as many helpers as there is work for. Blocks are
/// taken in turn by whichever thread is free.
template <class Work> void in_blocks(std::size_t n, std::size_t block, int threads, const Work& work) {
  std::atomic<std::size_t> next{0};
  const auto take = [&] {
    for (std::size_t first = next.fetch_add(block); first < n; first = next.fetch_add(block))
      work(first, std::min(n, first + block));
  };
  const std::size_t helpers = std::min<std::size_t>(threads - 1, n / block);
  std::vector<std::thread> team;
  for (std::size_t i = 0; i < helpers; ++i) team.emplace_back(take);
  take();
  for (std::thread& member : team) member.join();
}

}  // namespace flexapod
