// caller.cpp  caller PACK: what the callers of this folder play, through the C++ interface.
#include <cstdio>
#include <vector>

#include "sinew/sinew.hpp"

#define CHECK(condition) \
  if (!(condition)) return __LINE__

int main(int count, char** arguments) {
  CHECK(count == 2);
  sinew::World world;
  sinew::AssetId asset;
  sinew::AssetInfo info;
  sinew::InstanceId instance;
  CHECK(sinew::World::create({}, &world).ok());
  CHECK(world.load_asset_file(arguments[1], &asset).ok());
  CHECK(world.asset_info(asset, &info).ok());
  CHECK(world.create_instance({.asset = asset}, &instance).ok());
  std::vector<sinew::Matrix34> joints(info.joint_count);
  std::vector<float> places(size_t{3} * info.vertex_count);
  CHECK(world.bind_pose(asset, joints).ok());
  for (int frame = 0; frame < 60; ++frame) {
    CHECK(world.set_pose(instance, {.joints = joints, .root = {.position_m = {0, 0.01 * (frame % 20), 0}}})
              .ok());
    world.step(1.0f / 60);
  }
  CHECK(world.read_positions(instance, {.out = places.data(), .capacity = info.vertex_count}).ok());
  for (const float place : places) std::printf("%.9g\n", static_cast<double>(place));
  return 0;
}
