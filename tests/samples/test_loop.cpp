// test_loop.cpp  The parts of the loop: threads behind the task hook, statistics, the run itself.
#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <fstream>
#include <limits>
#include <memory>
#include <thread>

#include "baker/preview/pack_mesh.hpp"
#include "samples/demo/side.hpp"
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
  options.picture_fps = 30;
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

TEST_CASE("parts_are_told_how_far_they_go_and_that_they_come_to_rest") {
  sinew::test::TemporaryFolder folder;
  const Run run = run_block(folder, 1, 1, 60);
  REQUIRE(run.parts.size() == 2);
  CHECK((run.parts[0].name == "left" && run.parts[1].name == "right"));
  for (const PartMotion& part : run.parts) {
    double farthest_mm = 0;  // of what was kept, every second frame
    for (const Snapshot& s : run.snapshots)
      for (size_t v = 0; v < s.sinew.size(); ++v)
        if ((s.sinew[v].x() < 0) == (part.name == "left"))
          farthest_mm =
              std::max(farthest_mm, 1000.0 * static_cast<double>((s.sinew[v] - s.skinned[v]).norm()));
    CHECK(part.largest_mm >= Approx(farthest_mm).epsilon(1e-5));
    CHECK(part.largest_mm < 1.5 * farthest_mm);
    CHECK(part.still_mm < 0.5 * part.largest_mm);
  }
}

TEST_CASE("a_run_without_a_film_keeps_a_few_snapshots_up_to_its_end") {
  sinew::test::TemporaryFolder folder;
  const scenes::PackBytes block = scenes::soft_block();
  const std::string path = folder.file("block.sinew");
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(block.bytes().data()), static_cast<long>(block.bytes().size()));
  const CharacterFile character = open_character(path);
  Options options;
  options.frames = "asked for";
  for (const double seconds : {0.1, 1.0, 2.0}) {
    options.seconds = seconds;
    options.fps = 60;
    const Run run = simulate(character, *make_motion(character, ""), nullptr, options);
    CHECK(run.snapshots.size() == std::min<size_t>(24, run.frames.size()));
    CHECK(run.snapshots.back().time_s == Approx(seconds));
  }
}

TEST_CASE("the_camera_stands_where_it_is_told_and_by_itself_where_most_moves") {
  sinew::test::TemporaryFolder folder;
  const scenes::PackBytes block = scenes::soft_block();
  pack::PackView view;
  REQUIRE(pack::open_pack(block.bytes(), &view).ok());
  const render::Mesh mesh = baker::bind_mesh(view);
  std::vector<float> still(mesh.positions.size(), 0), front = still, back = still, all(still.size(), 1);
  for (size_t v = 0; v < still.size(); ++v) (mesh.normals[v].z() > 0.9f ? front : back)[v] = 1;
  for (size_t v = 0; v < still.size(); ++v) back[v] = mesh.normals[v].z() < -0.9f ? 1.0f : 0.0f;
  CHECK(camera_yaw_deg("front", 180, mesh, all) == 180);
  CHECK(camera_yaw_deg("side", 10, mesh, all) == 100);
  CHECK(camera_yaw_deg("back", 0, mesh, all) == 180);
  CHECK(camera_yaw_deg("auto", 0, mesh, still) == 32);
  CHECK(camera_yaw_deg("auto", 0, mesh, all) == 32);
  CHECK(camera_yaw_deg("auto", 0, mesh, front) == 32);
  CHECK(camera_yaw_deg("auto", 0, mesh, back) == 148);
  CHECK(camera_yaw_deg("auto", 180, mesh, back) == 212);
}

TEST_CASE("an_error_is_expected_only_where_it_was_measured_for_all_tiers_that_were_used") {
  constexpr float kNotMeasured = std::numeric_limits<float>::quiet_NaN();
  const auto record = [](Tier tier, float ratio, uint32_t level = 0) {
    return pack::TierRecord{static_cast<uint32_t>(tier),
                            1,
                            kNotMeasured,
                            kNotMeasured,
                            ratio,
                            kNotMeasured,
                            level,
                            kNotMeasured,
                            pack::kNoIndex};
  };
  const pack::TierRecord tiers[] = {record(Tier::kSkinning, 1), record(Tier::kExtrapolate, kNotMeasured),
                                    record(Tier::kNetwork, 0.25f), record(Tier::kNetwork, kNotMeasured, 1),
                                    record(Tier::kModal, kNotMeasured)};
  CharacterFile character;
  character.view.tiers = tiers;
  Run run{.instances = 1};
  run.frames.resize(2);
  run.frames[0].step.instances_network = 1;
  run.frames[0].step.expected_error = 0.25f;
  run.frames[1].step.instances_extrapolated = 1;
  run.frames[1].step.expected_error = 1;
  REQUIRE(summarise(run, character).expected_error);
  CHECK(summarise(run, character).expected_error->mean == Approx(0.625));
  run.frames[1].step = {.expected_error = kNotMeasured};
  CHECK_FALSE(summarise(run, character).expected_error);
  run.frames[1].step = {.instances_modal = 1, .expected_error = 0.15f};
  CHECK_FALSE(summarise(run, character).expected_error);
}
