// main.cpp  What the interface costs: calls through C beside C++, and the ways of reading a surface.
//
//   perf_interface C.sinew [...]
//
// A pack's first clip, or its bind pose bobbing. Ways take turns in one process, on one thread; a figure is
// the median of its rounds.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "perf/help.hpp"
#include "sinew/sinew.h"
#include "sinew/sinew.hpp"

namespace sinew::perf {
namespace {

constexpr int kRounds = 401;
constexpr uint32_t kPoints = 1000;

[[noreturn]] void fail(const char* message) {
  std::fprintf(stderr, "perf_interface: %s\n", message);
  std::exit(2);
}
void must(const Status& status) {
  if (!status.ok()) fail(status.message);
}
void must(sinew_status status) {
  if (status != SINEW_OK) fail(sinew_message());
}

double now_us() {
  using namespace std::chrono;
  return duration<double, std::micro>(steady_clock::now().time_since_epoch()).count();
}

struct Way {
  const char* name;
  std::function<void()> run;
  std::vector<double> took_us = {};
  double median_us() {
    std::ranges::nth_element(took_us, took_us.begin() + kRounds / 2);
    return took_us[kRounds / 2];
  }
};

// One instance on each side, posed alike.
struct Sides {
  World world;
  AssetId asset;
  AssetInfo info;
  InstanceId instance;
  sinew_world c_world;
  sinew_asset c_asset;
  sinew_instance c_instance;
  std::vector<Matrix34> joints;

  explicit Sides(const char* path) {
    const WorldDef def{.budget_mode = BudgetMode::kWorkUnits};
    must(World::create(def, &world));
    must(world.load_asset_file(path, &asset));
    must(world.asset_info(asset, &info));
    must(world.create_instance({.asset = asset}, &instance));
    sinew_world_def c_def = sinew_default_world_def();
    c_def.budget_mode = SINEW_BUDGET_WORK_UNITS;
    must(sinew_create_world(SINEW_LAYOUT, &c_def, &c_world));
    must(sinew_load_asset_file(c_world, path, &c_asset));
    sinew_instance_def made = sinew_default_instance_def();
    made.asset = c_asset;
    must(sinew_create_instance(c_world, &made, &c_instance));
    joints.resize(info.joint_count);
    must(world.bind_pose(asset, joints));
  }

  RootTransform pose(int round) {
    if (info.clip_count > 0) must(world.sample_clip(asset, 0, round / 60.0, ClipEnd::kLoop, joints));
    return {.position_m = {0, 0.05 * static_cast<double>(info.height_m) * std::sin(0.2 * round), 0}};
  }
};

// In turns, each round in another order; before a round `begin`.
void play(std::vector<Way>& ways, const std::function<void(int round)>& begin) {
  for (Way& way : ways) way.took_us.resize(kRounds);
  for (int round = 0; round < kRounds; ++round) {
    begin(round);
    for (size_t w = 0; w < ways.size(); ++w) {
      Way& way = ways[(w + static_cast<size_t>(round)) % ways.size()];
      const double begin_us = now_us();
      way.run();
      way.took_us[static_cast<size_t>(round)] = now_us() - begin_us;
    }
  }
}

// A frame: pose, step, displacements.
void compare_calls(Sides& sides) {
  std::vector<float> places(size_t{3} * sides.info.vertex_count);
  RootTransform root;
  std::vector<Way> ways;
  ways.push_back({"C++", [&] {
                    must(sides.world.set_pose(sides.instance, {.joints = sides.joints, .root = root}));
                    sides.world.step(1.0f / 60);
                    must(sides.world.read_positions(
                        sides.instance,
                        {.space = Space::kBind, .out = places.data(), .capacity = sides.info.vertex_count}));
                  }});
  ways.push_back({"C", [&] {
                    sinew_pose pose = sinew_default_pose();
                    pose.joints = reinterpret_cast<const sinew_matrix34*>(sides.joints.data());
                    pose.joint_count = sides.info.joint_count;
                    std::memcpy(&pose.root, &root, sizeof root);
                    must(sinew_set_pose(sides.c_world, sides.c_instance, &pose));
                    must(sinew_step(sides.c_world, 1.0f / 60, nullptr));
                    must(sinew_read_positions(sides.c_world, sides.c_instance, SINEW_SPACE_BIND,
                                              places.data(), sides.info.vertex_count));
                  }});
  play(ways, [&](int round) { root = sides.pose(round); });
  const double cpp_us = ways[0].median_us(), c_us = ways[1].median_us();
  std::printf("  a frame (pose, step, read)   C++ %8.2f us   C %8.2f us   ratio %.3f\n", cpp_us, c_us,
              c_us / cpp_us);
}

void compare_reads(Sides& sides) {
  const World& world = sides.world;
  AssetArrays arrays;
  must(world.asset_arrays(sides.asset, &arrays));
  const size_t vertices = sides.info.vertex_count, moved = sides.info.moved_vertex_count;
  std::vector<float> places(3 * vertices), normals(3 * vertices);
  std::vector<uint16_t> halves(4 * vertices);
  std::vector<SurfacePlace> points;
  for (uint32_t i = 0; i < kPoints; ++i)
    points.push_back({i * 7919u % sides.info.triangle_count, {0.2f, 0.3f, 0.5f}});
  std::vector<Matrix34> frames(points.size());
  const auto read = [&](const SurfaceReadDef& def) { must(world.read_surface(sides.instance, def)); };
  std::vector<Way> ways;
  ways.push_back({"positions", [&] { read({.capacity = vertices, .positions = {places.data()}}); }});
  ways.push_back({"displacements", [&] {
                    read({.space = Space::kBind, .capacity = vertices, .positions = {places.data()}});
                  }});
  ways.push_back(
      {"displacements, what moves alone", [&] {
         read({.space = Space::kBind, .moved_only = true, .capacity = moved, .positions = {places.data()}});
       }});
  ways.push_back({"positions, then normals", [&] {
                    read({.capacity = vertices, .positions = {places.data()}});
                    read({.capacity = vertices, .normals = {normals.data()}});
                  }});
  ways.push_back({"positions and normals in one", [&] {
                    read({.capacity = vertices, .positions = {places.data()}, .normals = {normals.data()}});
                  }});
  ways.push_back({"the same as halves", [&] {
                    read({.capacity = vertices,
                          .positions = {places.data()},
                          .normals = {halves.data(), 0, VertexFormat::kHalf4}});
                  }});
  ways.push_back(
      {"1,000 points of the surface", [&] { must(world.read_points(sides.instance, {}, points, frames)); }});
  play(ways, [](int) {});
  for (Way& way : ways) std::printf("  %-32s %8.2f us\n", way.name, way.median_us());
  std::printf("  a point                          %8.3f us, of %zu vertices %zu soft\n",
              ways.back().median_us() / kPoints, vertices, moved);
}

}  // namespace
}  // namespace sinew::perf

int main(int count, char** arguments) {
  using namespace sinew::perf;
  if (gives_help(count, arguments, "usage: perf_interface C.sinew [...]")) return 0;
  if (count < 2) fail("usage: perf_interface C.sinew [...]");
  for (int i = 1; i < count; ++i) {
    Sides sides(arguments[i]);
    std::printf("%s\n", arguments[i]);
    compare_calls(sides);
    compare_reads(sides);
  }
  return 0;
}
