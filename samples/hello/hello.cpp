// hello.cpp  The README's program: one creature, thrown up and down by its root, its surface read back each
// frame.
#include <sinew/sinew.hpp>

#include <cmath>
#include <cstdio>
#include <vector>

int main(int count, char** arguments) {
  if (count > 1 && arguments[1][0] == '-') return std::puts("usage: sinew-hello [C.sinew]"), 0;
  sinew::World world;
  sinew::AssetId asset;
  sinew::AssetInfo info;
  sinew::InstanceId creature;
  sinew::Status status = sinew::World::create({}, &world);
  if (status.ok()) status = world.load_asset_file(count > 1 ? arguments[1] : "out/creature.sinew", &asset);
  if (status.ok()) status = world.asset_info(asset, &info);
  if (status.ok()) status = world.create_instance({.asset = asset}, &creature);
  if (!status.ok()) return std::fprintf(stderr, "%s\n", status.message), 2;

  std::vector<sinew::Matrix34> joints(info.joint_count);
  std::vector<float> surface(3 * info.vertex_count);
  status = world.bind_pose(asset, joints);
  for (int frame = 0; status.ok() && frame < 60; ++frame) {
    const double height_m = 0.2 * std::sin(0.2 * frame);  // your animation goes here
    status = world.set_pose(creature, {.joints = joints, .root = {.position_m = {0, height_m, 0}}});
    if (!status.ok()) break;
    const sinew::FrameReport report = world.step(1.0f / 60);
    status = world.read_positions(creature, {.out = surface.data(), .capacity = info.vertex_count});
    std::printf("frame %2d: %3.0f us, first vertex at %.4f m\n", frame, report.total_us, surface[1]);
  }
  return status.ok() ? 0 : (std::fprintf(stderr, "%s\n", status.message), 2);
}
