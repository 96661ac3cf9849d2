// test_read.cpp  The surface in the caller's memory: three spaces that agree, strides, normals, many readers.
#include <thread>

#include "pack/reader.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using test::Stage;

namespace {

struct Vec {
  double x, y, z;
};

Vec at(const std::vector<float>& v, size_t i) { return {v[3 * i], v[3 * i + 1], v[3 * i + 2]}; }
Vec minus(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double length(Vec a) { return std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z); }

// Linear blend skinning of a point by the vertex's weights, in double, from the pack's own tables.
Vec skin(const pack::PackView& pack, const scenes::BlockPose& pose, size_t vertex, Vec p) {
  Vec out{0, 0, 0};
  for (uint32_t k = 0; k < pack::kInfluences; ++k) {
    const double w = static_cast<double>(pack.skin[vertex].weight[k]);
    const float* b = pack.joints[pack.skin[vertex].joint[k]].inverse_bind;
    const auto& m = pose.joints[pack.skin[vertex].joint[k]].m;
    const double q[3] = {b[0] * p.x + b[1] * p.y + b[2] * p.z + b[3],
                         b[4] * p.x + b[5] * p.y + b[6] * p.z + b[7],
                         b[8] * p.x + b[9] * p.y + b[10] * p.z + b[11]};
    double r[3];
    for (int i = 0; i < 3; ++i)
      r[i] = m[i][0] * q[0] + m[i][1] * q[1] + m[i][2] * q[2] + static_cast<double>(m[i][3]);
    out = {out.x + w * r[0], out.y + w * r[1], out.z + w * r[2]};
  }
  return out;
}

constexpr double kRounding_m = 1e-6;  // float places below 1 m, some ten operations

std::vector<float> normals(const Stage& stage, Space space = Space::kCharacter, size_t index = 0) {
  std::vector<float> out(size_t{3} * stage.info.vertex_count);
  REQUIRE(stage.world
              .read_normals(stage.blocks[index],
                            {.space = space, .out = out.data(), .capacity = stage.info.vertex_count})
              .ok());
  return out;
}

}  // namespace

// What an engine does on the GPU: add the delta to the bind position, then skin. It must give the simulated
// surface.
TEST_CASE("bind_deltas_skinned_give_the_character_positions") {
  Stage stage;
  pack::PackView pack;
  REQUIRE(pack::open_pack(test::block_pack().bytes(), &pack).ok());
  stage.play(scenes::walk, 1.7);
  const std::vector<float> deltas = stage.read(0, Space::kBind), places = stage.read();
  REQUIRE(test::largest_length(deltas) > 0.005);
  double worst_m = 0;
  for (size_t v = 0; v < stage.info.vertex_count; ++v) {
    const Vec d = at(deltas, v);
    const Vec moved = {pack.positions[3 * v] + d.x, pack.positions[3 * v + 1] + d.y,
                       pack.positions[3 * v + 2] + d.z};
    worst_m =
        std::max(worst_m, length(minus(skin(pack, scenes::walk(stage.time_s), v, moved), at(places, v))));
  }
  CHECK(worst_m < kRounding_m);
}

// Deltas live in the bind pose: a pose that folds the surface flat cannot change what they are.
TEST_CASE("bind_deltas_do_not_feel_a_singular_pose") {
  Stage stage, flattened;
  stage.play(scenes::walk, 1);
  flattened.play(scenes::walk, 1);
  scenes::BlockPose flat = scenes::walk(1);
  for (Matrix34& joint : flat.joints) {
    for (auto& row : joint.m) row[0] = 0;
  }
  flattened.pose(flattened.blocks[0], flat);
  flattened.world.step(0);
  stage.world.step(0);
  CHECK(flattened.read(0, Space::kBind) == stage.read(0, Space::kBind));
  CHECK(test::all_finite(flattened.read()));
}

TEST_CASE("world_positions_are_the_root_applied_to_character_positions") {
  Stage stage;
  stage.play(scenes::walk, 1.3);
  const std::vector<float> character = stage.read(), world = stage.read(0, Space::kWorld);
  const RootTransform root = scenes::walk(stage.time_s).root;
  const double y = root.rotation_xyzw[1], w = root.rotation_xyzw[3];
  const double c = 1 - 2 * y * y, s = 2 * y * w;
  double worst_m = 0;
  for (size_t v = 0; v < stage.info.vertex_count; ++v) {
    const Vec p = at(character, v);
    const Vec expected = {c * p.x + s * p.z + root.position_m[0], p.y + root.position_m[1],
                          c * p.z - s * p.x + root.position_m[2]};
    worst_m = std::max(worst_m, length(minus(at(world, v), expected)));
  }
  CHECK(worst_m < kRounding_m);
}

TEST_CASE("stride_leaves_the_bytes_between_alone") {
  Stage stage;
  stage.play(scenes::walk, 0.7);
  const size_t count = stage.info.vertex_count;
  std::vector<float> wide(5 * count, -7);
  const std::vector<float> tight = stage.read();
  REQUIRE(
      stage.world.read_positions(stage.blocks[0], {.out = wide.data(), .stride_bytes = 20, .capacity = count})
          .ok());
  bool same = true, untouched = true;
  for (size_t v = 0; v < count; ++v) {
    for (size_t k = 0; k < 3; ++k) same = same && wide[5 * v + k] == tight[3 * v + k];
    untouched = untouched && wide[5 * v + 3] == -7 && wide[5 * v + 4] == -7;
  }
  CHECK(same);
  CHECK(untouched);
}

TEST_CASE("normals_are_unit_and_smooth_across_seams") {
  Stage stage;
  pack::PackView pack;
  REQUIRE(pack::open_pack(test::block_pack().bytes(), &pack).ok());
  stage.play(scenes::walk, 1.1);
  const std::vector<float> n = normals(stage);
  bool unit = true, smooth = true;
  for (size_t v = 0; v < stage.info.vertex_count; ++v) {
    unit = unit && std::abs(length(at(n, v)) - 1) < 1e-5;
    smooth = smooth && length(minus(at(n, v), at(n, pack.welded[v]))) == 0;
  }
  CHECK(unit);
  CHECK(smooth);
}

TEST_CASE("normals_of_the_flat_faces_point_outwards_and_turn_with_the_root") {
  Stage stage;
  scenes::BlockPose quarter = scenes::bent_pose(0, 0, 3.14159265358979 / 2);
  stage.pose(stage.blocks[0], quarter);
  stage.world.step(1.0f / 60);
  const std::vector<float> places = stage.read(), character = normals(stage),
                           world = normals(stage, Space::kWorld);
  for (size_t v = 0; v < stage.info.vertex_count; ++v) {
    const Vec p = at(places, v);
    const bool inner = std::abs(p.x) < 0.14 && p.y > 0.01 && p.y < 0.59;  // of the faces z = +-0.15
    if (!inner) continue;
    const double side = p.z > 0 ? 1 : -1;
    CHECK(length(minus(at(character, v), {0, 0, side})) < 1e-5);
    CHECK(length(minus(at(world, v), {side, 0, 0})) < 1e-5);
  }
}

// After a step: positions of one instance, and normals of different ones, from several threads at a time.
TEST_CASE("many_threads_read_at_a_time") {
  constexpr size_t kThreads = 4;
  Stage stage(kThreads);
  stage.play(scenes::walk, 1);
  std::vector<std::vector<float>> expected, expected_normals, seen(kThreads), seen_normals(kThreads);
  const size_t floats = size_t{3} * stage.info.vertex_count;
  for (size_t i = 0; i < kThreads; ++i) {
    expected_normals.push_back(normals(stage, Space::kCharacter, i));
    seen[i].resize(floats);
    seen_normals[i].resize(floats);
  }
  const World& world = stage.world;
  std::vector<std::thread> threads;
  for (size_t i = 0; i < kThreads; ++i) {
    threads.emplace_back([&, i] {
      for (int round = 0; round < 20; ++round) {
        world.read_positions(stage.blocks[0], {.out = seen[i].data(), .capacity = floats});
        world.read_normals(stage.blocks[i], {.out = seen_normals[i].data(), .capacity = floats});
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (size_t i = 0; i < kThreads; ++i) {
    CHECK(seen[i] == stage.read(0));
    CHECK(seen_normals[i] == expected_normals[i]);
  }
}
