// test_loop.cpp  The parts of the loop: threads behind the task hook, statistics, the run itself.
#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <fstream>
#include <memory>
#include <thread>

#include "samples/demo/simulate.hpp"
#include "samples/demo/statistics.hpp"
#include "samples/demo/summary.hpp"
#include "samples/demo/thread_pool.hpp"
#include "tests/baker/common/temporary_folder.hpp"
#include "tests/scenes/soft_block.hpp"

using namespace sinew;
using namespace sinew::demo;

namespace {

struct Counters {
  std::vector<std::atomic<int>> runs;
  explicit Counters(size_t count) : runs(count) {}
  static void count(void* argument, uint32_t index) {
    ++static_cast<Counters*>(argument)->runs[index];
    std::this_thread::yield();  // threads meet at the next claim
  }
};

Run run_block(const sinew::test::TemporaryFolder& folder, int instances, int threads, double fps,
              bool camera = false) {
  const scenes::PackBytes block = scenes::soft_block();
  const std::string path = folder.file("block.sinew");
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(block.bytes().data()), static_cast<long>(block.bytes().size()));
  const CharacterFile character = open_character(path);
  Options options;
  options.instances = instances;
  options.threads = threads;
  options.seconds = 1.5;
  options.fps = fps;
  options.camera = camera;
  options.frames = "asked for, so that snapshots are kept";
  return simulate(character, *make_motion(character, ""), nullptr, options);
}

}  // namespace

TEST_CASE("statistics_of_nothing_are_zero") {
  const Spread none = spread_of({});
  CHECK((none.median == 0 && none.p99 == 0 && none.max == 0 && none.mean == 0));
}

TEST_CASE("p99_is_what_99_percent_do_not_exceed") {
  std::vector<double> values;
  for (int i = 100; i >= 1; --i) values.push_back(i);
  const Spread spread = spread_of(values);
  CHECK((spread.median == 50 && spread.p99 == 99 && spread.max == 100 && spread.mean == 50.5));
}

TEST_CASE("pool_runs_every_index_once_in_every_job") {
  for (const int threads : {2, 3, 8}) {
    ThreadPool pool(threads);
    const TaskHook hook = pool.hook();
    REQUIRE(hook.enqueue != nullptr);
    for (uint32_t job = 0; job < 2000; ++job) {
      const uint32_t count = job % 37;
      Counters counters(count);
      hook.finish(hook.enqueue(Counters::count, &counters, count, hook.context), hook.context);
      for (const auto& runs : counters.runs) REQUIRE(runs == 1);
    }
  }
}

TEST_CASE("pool_of_one_thread_is_the_null_hook") { CHECK(ThreadPool(1).hook().enqueue == nullptr); }

TEST_CASE("recorded_positions_do_not_depend_on_threads_or_neighbours") {
  sinew::test::TemporaryFolder folder;
  const Run alone = run_block(folder, 1, 1, 60), crowd = run_block(folder, 5, 3, 60);
  REQUIRE(alone.snapshots.size() == crowd.snapshots.size());
  for (size_t i = 0; i < alone.snapshots.size(); ++i)
    CHECK(alone.snapshots[i].sinew == crowd.snapshots[i].sinew);
  CHECK(alone.crowd.empty());
  CHECK(crowd.crowd.size() == 5);
}

// It looks 22 degrees to its left by then, over a hundred blocks that stand around it.
TEST_CASE("what_the_turning_camera_does_not_show_is_hidden_and_told_so") {
  sinew::test::TemporaryFolder folder;
  const Run all = run_block(folder, 100, 1, 60), seen = run_block(folder, 100, 1, 60, true);
  const auto hidden = std::ranges::count_if(seen.crowd, &CrowdMember::hidden);
  CHECK(std::ranges::none_of(all.crowd, &CrowdMember::hidden));
  CHECK(all.reasons[static_cast<size_t>(TierReason::kHidden)] == 0);
  CHECK((hidden > 10 && hidden < 90));
  CHECK(seen.frames.back().step.instances_hidden == static_cast<uint32_t>(hidden));
  CHECK(seen.reasons[static_cast<size_t>(TierReason::kHidden)] > 0);
}

TEST_CASE("tissue_moves_and_the_witness_shows_skinning_without_it") {
  sinew::test::TemporaryFolder folder;
  const Run run = run_block(folder, 1, 1, 60);
  CHECK(run.frames.size() == 91);
  CHECK(run.snapshots.size() == 46);
  float moved = 0, skinned = 0;
  for (const Snapshot& snapshot : run.snapshots) {
    for (size_t v = 0; v < snapshot.sinew.size(); ++v) {
      moved = std::max(moved, (snapshot.sinew[v] - snapshot.skinned[v]).norm());
      skinned = std::max(skinned, (snapshot.skinned[v] - run.snapshots[0].skinned[v]).norm());
    }
  }
  CHECK(moved > 0.001f);
  CHECK(skinned < 1e-5f);  // the built-in shake moves the root only
}
