// test_tracy_hook.cpp  The README's hook for Tracy compiles, and its zones are named and nested.
#include <catch2/catch.hpp>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "tests/house/tracy_hook.hpp"
#include "tests/scenes/soft_block.hpp"
#include "tests/scenes/thread_pool.hpp"

using namespace sinew;

namespace {

std::mutex mutex;
std::set<std::string> names;
std::set<uint64_t> values;
uint32_t begun = 0, ended = 0, crossed = 0;
thread_local std::vector<uint32_t> open_here;

}  // namespace

TracyCZoneCtx ___tracy_emit_zone_begin(const ___tracy_source_location_data*, int32_t active) {
  const std::lock_guard lock(mutex);
  open_here.push_back(++begun);
  return {begun, active};
}
void ___tracy_emit_zone_end(TracyCZoneCtx zone) {
  const std::lock_guard lock(mutex);
  ++ended;
  crossed += open_here.empty() || open_here.back() != zone.id;
  if (!open_here.empty()) open_here.pop_back();
}
void ___tracy_emit_zone_name(TracyCZoneCtx, const char* text, size_t size) {
  const std::lock_guard lock(mutex);
  names.emplace(text, size);
}
void ___tracy_emit_zone_value(TracyCZoneCtx, uint64_t value) {
  const std::lock_guard lock(mutex);
  values.insert(value);
}

TEST_CASE("the_readme_s_hook_for_tracy_opens_and_closes_zones_of_each_thread") {
  const scenes::PackBytes pack = scenes::soft_block();
  scenes::ThreadPool pool(2);
  World world;
  REQUIRE(World::create({.tasks = pool.hook(), .profiler = kTracyHook}, &world).ok());
  AssetId asset;
  REQUIRE(world.load_asset(pack.bytes(), &asset).ok());
  InstanceId made;
  for (int i = 0; i < 3; ++i) REQUIRE(world.create_instance({.asset = asset}, &made).ok());
  for (int step = 0; step < 10; ++step) world.step(1.0f / 60);
  CHECK(begun > 0);
  CHECK(ended == begun);
  CHECK(crossed == 0);
  for (const char* name : {"schedule", "instance", "drive", "tissue", "rods", "publish", "report"})
    CHECK(names.contains(name));
  CHECK(values == std::set<uint64_t>{0, 1, 2});
}
