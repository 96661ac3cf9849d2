// in_motion.cpp  What an engine calls in a frame.
#include "tests/fuzz/in_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <span>

namespace sinew::fuzz {
namespace {

constexpr float kFrame_s = 1.0f / 60;

bool all_finite(std::span<const float> numbers) {
  return std::ranges::all_of(numbers, [](float number) { return std::isfinite(number); });
}

bool all_finite(std::span<const Matrix34> matrices) {
  return std::ranges::all_of(matrices, [](const Matrix34& matrix) {
    return std::ranges::all_of(matrix.m,
                               [](const auto& row) { return all_finite(std::span<const float>(row)); });
  });
}

bool surface_is_finite(const World& world, InstanceId instance, const AssetInfo& info) {
  bool finite = true;
  std::vector<float> places(size_t{3} * info.vertex_count), normals(places.size()),
      tangents(size_t{4} * info.vertex_count);
  for (const Space space : {Space::kCharacter, Space::kWorld, Space::kBind}) {
    SurfaceReadDef def = {.space = space,
                          .capacity = info.vertex_count,
                          .positions = {.out = places.data()},
                          .normals = {.out = normals.data()},
                          .tangents = {.out = tangents.data(), .format = VertexFormat::kFloat4}};
    if (!world.read_surface(instance, def).ok()) {
      def.tangents = {};
      if (!world.read_surface(instance, def).ok()) continue;
    }
    finite = finite && all_finite(places) && all_finite(normals) && all_finite(tangents);
  }
  return finite;
}

bool frames_are_finite(const World& world, InstanceId instance, const AssetInfo& info) {
  bool finite = true;
  std::vector<Matrix34> joints(info.joint_count);
  if (world.read_joint_matrices(instance, joints).ok()) finite = all_finite(joints);
  if (info.triangle_count > 0) {
    const SurfacePlace places[] = {{.triangle = 0, .weights = {0.25f, 0.25f, 0.5f}},
                                   {.triangle = info.triangle_count - 1, .weights = {0, 0, 1}}};
    Matrix34 points[2] = {};
    if (world.read_points(instance, {}, places, points).ok()) finite = finite && all_finite(points);
  }
  Bounds bounds;
  if (world.bounds(instance, &bounds).ok()) finite = finite && std::isfinite(bounds.radius_m);
  return finite;
}

void ask_all(const World& world, AssetId asset, InstanceId instance, const AssetInfo& info) {
  std::vector<DebugLine> lines(64);
  world.debug_lines(instance, kDebugAll, {0, 0, 0}, lines);
  InstanceReport report;
  (void)world.report(instance, &report);
  std::vector<char> path(64);
  for (uint32_t j = 0; j < info.joint_count; ++j) {
    JointInfo joint;
    (void)world.joint_info(asset, j, &joint);
    world.joint_path(asset, j, path);
  }
  for (uint32_t r = 0; r < info.region_count; ++r) {
    RegionInfo region;
    (void)world.region_info(asset, r, &region);
  }
  for (uint32_t r = 0; r < info.rod_count; ++r) {
    RodInfo rod;
    (void)world.rod_info(asset, r, &rod);
  }
  for (uint32_t p = 0; p < info.primitive_count; ++p) {
    PrimitiveInfo primitive;
    (void)world.primitive_info(asset, p, &primitive);
  }
}

}  // namespace

World make_world(uint32_t assets, uint32_t instances) {
  World world;
  const WorldDef def = {.max_assets = assets,
                        .max_instances = instances,
                        .report_history = 1,
                        .event_capacity = 8,
                        .assert_hook = {.fail = [](const char*, const char*, int, void*) {}}};
  if (!World::create(def, &world).ok()) std::abort();
  return world;
}

bool add_instance(World& world, AssetId asset, InstanceId* out) {
  InstanceDef def = {.asset = asset, .contacts = {.own_body = true}, .rod_start = RodWarmStart::kLearned};
  if (world.create_instance(def, out).ok()) return true;
  def.rod_start = RodWarmStart::kAsBaked;
  return world.create_instance(def, out).ok();
}

bool move_and_read(World& world, AssetId asset, InstanceId instance, int steps) {
  AssetInfo info;
  if (!world.asset_info(asset, &info).ok()) return true;
  std::vector<Matrix34> joints(info.joint_count);
  for (int s = 0; s < steps; ++s) {
    const float turn = 0.1f * static_cast<float>(s);
    const bool of_clip =
        info.clip_count > 0 && s > 0 && world.sample_clip(asset, 0, 0.03 * s, ClipEnd::kHold, joints).ok();
    if (!of_clip && !world.bind_pose(asset, joints).ok()) return true;
    RootTransform root;
    root.position_m[0] = 0.02 * s * s;
    root.rotation_xyzw[1] = std::sin(turn);
    root.rotation_xyzw[3] = std::cos(turn);
    (void)world.set_pose(instance, {.joints = joints, .root = root});
    world.step(kFrame_s);
  }
  ask_all(world, asset, instance, info);
  const bool surface = surface_is_finite(world, instance, info);
  return frames_are_finite(world, instance, info) && surface;
}

}  // namespace sinew::fuzz
