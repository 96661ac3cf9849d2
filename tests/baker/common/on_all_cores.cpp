// on_all_cores.cpp  Every piece is done once, and a fault is told.
#include "baker/common/on_all_cores.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

using namespace sinew::baker;

TEST_CASE("every_piece_is_worked_on_once") {
  std::vector<int> times(100, 0);
  on_all_cores("work", 100, 100, [&](size_t piece, std::atomic<size_t>& done) { ++times[piece], ++done; });
  CHECK(times == std::vector<int>(100, 1));
  on_all_cores("nothing", 0, 0, [](size_t, std::atomic<size_t>&) { FAIL("there is no piece"); });
}

TEST_CASE("the_first_fault_is_thrown_when_all_have_ended_and_none_begins_after_it") {
  std::atomic<size_t> begun{0};
  std::atomic<bool> thrown{false};
  const auto work = [&](size_t piece, std::atomic<size_t>&) {
    ++begun;
    if (piece == 3) thrown = true, throw std::runtime_error("piece 3");
    // Whoever comes later gives the fault time to be told.
    if (piece > 3) {
      while (!thrown) std::this_thread::yield();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  };
  CHECK_THROWS_WITH(on_all_cores("work", 100000, 100000, work), "piece 3");
  CHECK(begun < 100000);
}
