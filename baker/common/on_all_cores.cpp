// on_all_cores.cpp  see on_all_cores.hpp.
#include "baker/common/on_all_cores.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "baker/common/progress.hpp"

namespace sinew::baker {

void on_all_cores(const std::string& what, size_t total, size_t pieces,
                  const std::function<void(size_t, std::atomic<size_t>&)>& work) {
  constexpr std::chrono::milliseconds kLook(20);
  std::atomic<size_t> next{0}, done{0}, running{0};
  std::exception_ptr fault;
  std::mutex lock;
  const auto run = [&] {
    try {
      for (size_t piece = next++; piece < pieces; piece = next++) work(piece, done);
    } catch (...) {
      next = pieces;
      const std::lock_guard guard(lock);
      if (!fault) fault = std::current_exception();
    }
    --running;
  };
  std::vector<std::thread> threads;
  running = std::min<size_t>(pieces, std::max(1u, std::thread::hardware_concurrency()));
  for (size_t t = 0, count = running; t < count; ++t) threads.emplace_back(run);
  Progress progress(what, total);
  while (running > 0) {
    progress.update(done);
    std::this_thread::sleep_for(kLook);
  }
  for (std::thread& thread : threads) thread.join();
  if (fault) std::rethrow_exception(fault);
}

}  // namespace sinew::baker
