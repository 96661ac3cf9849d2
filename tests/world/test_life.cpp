// test_life.cpp  Coming and going of worlds, assets and instances.
#include <array>
#include <cstdio>
#include <fstream>

#include "tests/world/stage.hpp"

using namespace sinew;
using test::Stage;

TEST_CASE("world_moves_and_keeps_its_objects") {
  Stage stage(1);
  stage.play(scenes::walk, 0.3);
  const std::vector<float> before = stage.read();
  World moved(std::move(stage.world));
  stage.world = std::move(moved);
  CHECK(stage.read() == before);
}

TEST_CASE("asset_file_is_mapped_and_runs_like_the_bytes") {
  const std::string path = SINEW_BINARY_DIR "/soft_block_of_test_life.sinew";
  const auto bytes = test::block_pack().bytes();
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  Stage stage(1);
  AssetId mapped;
  const Status status = stage.world.load_asset_file(path.c_str(), &mapped);
  INFO(status.message);
  REQUIRE(status.ok());
  InstanceId twin;
  REQUIRE(stage.world.create_instance({.asset = mapped}, &twin).ok());
  stage.blocks.push_back(twin);
  for (int f = 0; f < 60; ++f) {
    for (const InstanceId block : stage.blocks) stage.pose(block, scenes::walk(f / 60.0));
    stage.world.step(1.0f / 60);
  }
  CHECK(stage.read(0) == stage.read(1));
  std::remove(path.c_str());
}

TEST_CASE("asset_info_states_the_counts") {
  Stage stage(1);
  CHECK(stage.info.vertex_count == 462);
  CHECK(stage.info.triangle_count == 720);
  CHECK(stage.info.joint_count == 2);
  CHECK(stage.info.region_count == 2);
  CHECK(stage.info.node_count == 28);
  CHECK(stage.info.tick_hz == 60);
  CHECK(stage.info.height_m == Approx(0.6));
  CHECK(stage.info.instance_bytes > 10000);
}

TEST_CASE("joints_have_the_names_and_the_bind_pose_of_the_file") {
  Stage stage(0);
  std::array<Matrix34, 2> joints;
  REQUIRE(stage.world.bind_pose(stage.asset, joints).ok());
  CHECK(stage.world.joint_name(stage.asset, 0) == std::string("foot"));
  CHECK(stage.world.joint_name(stage.asset, 1) == std::string("waist"));
  const scenes::BlockPose expected = scenes::bind_pose();
  for (size_t j = 0; j < joints.size(); ++j) {
    for (int i = 0; i < 12; ++i)
      CHECK(joints[j].m[i / 4][i % 4] == Approx(expected.joints[j].m[i / 4][i % 4]));
  }
}

// Slots are used again and again while others live on undisturbed.
TEST_CASE("creating_and_destroying_does_not_disturb_the_others") {
  Stage churned(3, {.max_instances = 8}), calm(3);
  std::vector<InstanceId> dead;
  for (int frame = 0; frame < 200; ++frame) {
    InstanceId guest;
    REQUIRE(churned.world.create_instance({.asset = churned.asset}, &guest).ok());
    churned.step(scenes::walk, 1.0 / 60);
    calm.step(scenes::walk, 1.0 / 60);
    REQUIRE(churned.world.destroy_instance(guest).ok());
    dead.push_back(guest);
  }
  for (size_t i = 0; i < 3; ++i) CHECK(churned.read(i) == calm.read(i));
  InstanceReport report;
  for (const InstanceId id : dead) CHECK_FALSE(churned.world.report(id, &report).ok());
}

TEST_CASE("world_can_be_empty") {
  Stage stage(0);
  const FrameReport report = stage.world.step(1.0f / 60);
  CHECK(report.ticks == 0);
  CHECK(report.instances_network == 0);
}

TEST_CASE("instance_enters_in_its_bind_pose_at_its_root") {
  Stage stage(0);
  RootTransform root{.position_m = {5, 0, 0}};
  InstanceId block;
  REQUIRE(stage.world.create_instance({.asset = stage.asset, .root = root}, &block).ok());
  stage.blocks.push_back(block);
  const std::vector<float> character = stage.read(), world = stage.read(0, Space::kWorld);
  CHECK(*std::ranges::min_element(character) == Approx(-0.15));
  for (size_t i = 0; i < world.size(); ++i)
    CHECK(world[i] == Approx(character[i] + (i % 3 == 0 ? 5 : 0)).margin(1e-6));
}
