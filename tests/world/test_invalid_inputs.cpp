// test_invalid_inputs.cpp  Each call refuses what it cannot use, says why, and leaves everything as it was.
#include <array>
#include <cstdlib>
#include <limits>
#include <string>

#include "tests/world/stage.hpp"

using namespace sinew;
using test::Stage;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

void check_refused(const Status& status, StatusCode code) {
  CHECK(status.code == code);
  CHECK(std::string(status.message).size() > 10);
}

Status create_with(WorldDef def) {
  World world;
  return World::create(def, &world);
}

}  // namespace

TEST_CASE("create_refuses_a_definition_out_of_range") {
  check_refused(World::create({}, nullptr), StatusCode::kInvalidArgument);
  check_refused(create_with({.max_assets = 0}), StatusCode::kInvalidArgument);
  check_refused(create_with({.max_assets = 65536}), StatusCode::kInvalidArgument);
  check_refused(create_with({.max_instances = 0}), StatusCode::kInvalidArgument);
  check_refused(create_with({.max_instances = 100001}), StatusCode::kInvalidArgument);
  check_refused(create_with({.max_ticks_per_step = 0}), StatusCode::kInvalidArgument);
  check_refused(create_with({.max_ticks_per_step = 65}), StatusCode::kInvalidArgument);
  for (const TeleportDef& bad :
       {TeleportDef{.distance = 0}, TeleportDef{.distance = kNan}, TeleportDef{.angle_rad = -1},
        TeleportDef{.scale = 1}, TeleportDef{.scale = kNan}, TeleportDef{.acceleration = 0}})
    check_refused(create_with({.teleport = bad}), StatusCode::kInvalidArgument);
  check_refused(create_with({.budget_mode = static_cast<BudgetMode>(7)}), StatusCode::kInvalidArgument);
  const auto enqueue = [](TaskHook::Task, void*, uint32_t, void*) -> void* { return nullptr; };
  check_refused(create_with({.tasks = {.enqueue = enqueue}}), StatusCode::kInvalidArgument);
}

TEST_CASE("create_refuses_an_instruction_set_in_the_environment_that_is_not_there") {
  setenv("SINEW_ISA", "abacus", 1);
  const Status status = create_with({});
  unsetenv("SINEW_ISA");
  check_refused(status, StatusCode::kUnsupported);
  CHECK_THAT(status.message, Catch::Contains("SINEW_ISA") && Catch::Contains("abacus"));
  CHECK(create_with({}).ok());
}

TEST_CASE("null_world_refuses_every_call") {
  World world;
  AssetId asset;
  AssetInfo info;
  InstanceId instance;
  InstanceReport report;
  check_refused(world.load_asset(test::block_pack().bytes(), &asset), StatusCode::kInvalidArgument);
  check_refused(world.load_asset_file("x", &asset), StatusCode::kInvalidArgument);
  check_refused(world.unload_asset(asset), StatusCode::kInvalidArgument);
  check_refused(world.asset_info(asset, &info), StatusCode::kInvalidArgument);
  check_refused(world.create_instance({}, &instance), StatusCode::kInvalidArgument);
  check_refused(world.destroy_instance(instance), StatusCode::kInvalidArgument);
  check_refused(world.set_pose(instance, {}), StatusCode::kInvalidArgument);
  check_refused(world.set_importance(instance, 1), StatusCode::kInvalidArgument);
  check_refused(world.reset(instance), StatusCode::kInvalidArgument);
  check_refused(world.set_budget_us(1), StatusCode::kInvalidArgument);
  check_refused(world.read_positions(instance, {}), StatusCode::kInvalidArgument);
  check_refused(world.read_normals(instance, {}), StatusCode::kInvalidArgument);
  check_refused(world.report(instance, &report), StatusCode::kInvalidArgument);
  check_refused(world.save_state(instance, {}), StatusCode::kInvalidArgument);
  check_refused(world.restore_state(instance, {}), StatusCode::kInvalidArgument);
  CHECK(world.state_bytes(instance) == 0);
  CHECK(world.step(1.0f / 60).ticks == 0);
}

TEST_CASE("load_refuses_what_is_not_a_pack_and_leaves_out_untouched") {
  Stage stage(0);
  AssetId out{42, 43};
  const auto bytes = test::block_pack().bytes();
  CHECK_FALSE(stage.world.load_asset({}, &out).ok());
  CHECK_FALSE(stage.world.load_asset(bytes.first(100), &out).ok());
  CHECK_FALSE(stage.world.load_asset(bytes.first(bytes.size() - 64), &out).ok());
  check_refused(stage.world.load_asset_file("/there/is/no/such.sinew", &out), StatusCode::kUnreadable);
  check_refused(stage.world.load_asset_file(nullptr, &out), StatusCode::kInvalidArgument);
  check_refused(stage.world.load_asset(bytes, nullptr), StatusCode::kInvalidArgument);
  CHECK(out == AssetId{42, 43});
}

TEST_CASE("load_and_create_refuse_beyond_capacity") {
  Stage stage(2, {.max_assets = 1, .max_instances = 2});
  AssetId asset;
  InstanceId instance;
  check_refused(stage.world.load_asset(test::block_pack().bytes(), &asset), StatusCode::kOutOfCapacity);
  check_refused(stage.world.create_instance({.asset = stage.asset}, &instance), StatusCode::kOutOfCapacity);
  CHECK(is_null(asset));
  CHECK(is_null(instance));
}

TEST_CASE("unload_refuses_while_instances_live") {
  Stage stage(1);
  check_refused(stage.world.unload_asset(stage.asset), StatusCode::kInvalidArgument);
  CHECK(stage.world.destroy_instance(stage.blocks[0]).ok());
  CHECK(stage.world.unload_asset(stage.asset).ok());
  check_refused(stage.world.unload_asset(stage.asset), StatusCode::kStaleId);
}

TEST_CASE("create_instance_refuses_a_bad_root") {
  Stage stage(0);
  InstanceId out;
  RootTransform root;
  root.position_m[1] = static_cast<double>(kNan);
  check_refused(stage.world.create_instance({.asset = stage.asset, .root = root}, &out),
                StatusCode::kNotFinite);
  root = {.rotation_xyzw = {0, 0, 0, 0}};
  check_refused(stage.world.create_instance({.asset = stage.asset, .root = root}, &out),
                StatusCode::kInvalidArgument);
  check_refused(stage.world.create_instance({.asset = stage.asset}, nullptr), StatusCode::kInvalidArgument);
  CHECK(is_null(out));
}

TEST_CASE("stale_and_null_ids_are_refused_and_reported_to_the_hook") {
  Stage stage(1);
  const InstanceId dead = stage.blocks[0];
  REQUIRE(stage.world.destroy_instance(dead).ok());
  std::vector<std::byte> bytes(100);
  InstanceReport report;
  for (const InstanceId id : {dead, InstanceId{}, InstanceId{1000, 1}}) {
    check_refused(stage.world.destroy_instance(id), StatusCode::kStaleId);
    check_refused(stage.world.set_pose(id, scenes::bind_pose().pose()), StatusCode::kStaleId);
    check_refused(stage.world.set_importance(id, 1), StatusCode::kStaleId);
    check_refused(stage.world.reset(id), StatusCode::kStaleId);
    check_refused(stage.world.read_positions(id, {}), StatusCode::kStaleId);
    check_refused(stage.world.read_normals(id, {}), StatusCode::kStaleId);
    check_refused(stage.world.report(id, &report), StatusCode::kStaleId);
    check_refused(stage.world.save_state(id, bytes), StatusCode::kStaleId);
    check_refused(stage.world.restore_state(id, bytes), StatusCode::kStaleId);
    CHECK(stage.world.state_bytes(id) == 0);
  }
  CHECK(stage.faults.faults == 30);
}

TEST_CASE("bad_poses_are_refused_counted_and_leave_the_last_good_one") {
  Stage stage(1), calm(1);
  scenes::BlockPose good = scenes::bent_pose(0.2), bad = good;
  const InstanceId block = stage.blocks[0];
  stage.pose(block, good);
  calm.pose(calm.blocks[0], good);

  Pose short_pose = good.pose();
  short_pose.joints = short_pose.joints.first(1);
  check_refused(stage.world.set_pose(block, short_pose), StatusCode::kInvalidArgument);
  check_refused(stage.world.set_pose(block, {}), StatusCode::kInvalidArgument);
  bad.joints[1].m[2][1] = kNan;
  check_refused(stage.world.set_pose(block, bad.pose()), StatusCode::kNotFinite);
  bad.joints[1].m[2][1] = kInfinity;
  check_refused(stage.world.set_pose(block, bad.pose()), StatusCode::kNotFinite);
  bad.joints[1].m[2][1] = 1e30f;
  check_refused(stage.world.set_pose(block, bad.pose()), StatusCode::kInvalidArgument);
  bad = good;
  bad.root.position_m[0] = static_cast<double>(kInfinity);
  check_refused(stage.world.set_pose(block, bad.pose()), StatusCode::kNotFinite);
  bad.root.position_m[0] = 1e15;
  check_refused(stage.world.set_pose(block, bad.pose()), StatusCode::kInvalidArgument);
  bad = good;
  bad.root.rotation_xyzw[0] = kNan;
  check_refused(stage.world.set_pose(block, bad.pose()), StatusCode::kNotFinite);
  bad.root = {.rotation_xyzw = {0, 0, 0, 0}};
  check_refused(stage.world.set_pose(block, bad.pose()), StatusCode::kInvalidArgument);

  CHECK(stage.world.step(1.0f / 60).rejected_poses == 9);
  CHECK(calm.world.step(1.0f / 60).rejected_poses == 0);
  CHECK(stage.world.step(1.0f / 60).rejected_poses == 0);
  calm.world.step(1.0f / 60);
  CHECK(stage.read() == calm.read());
}

TEST_CASE("set_budget_refuses_nan_and_negative") {
  Stage stage(1);
  check_refused(stage.world.set_budget_us(kNan), StatusCode::kInvalidArgument);
  check_refused(stage.world.set_budget_us(-1), StatusCode::kInvalidArgument);
  CHECK(stage.world.step(0).budget_us == kInfinity);
  CHECK(stage.world.set_budget_us(0).ok());
  CHECK(stage.world.step(0).budget_us == 0);
}

TEST_CASE("reads_refuse_bad_definitions_and_write_nothing") {
  Stage stage(1);
  const size_t count = stage.info.vertex_count;
  std::vector<float> out(3 * count + 3, -7);
  const auto refused = [&](ReadDef def, StatusCode code = StatusCode::kInvalidArgument) {
    check_refused(stage.world.read_positions(stage.blocks[0], def), code);
    check_refused(stage.world.read_normals(stage.blocks[0], def), code);
  };
  auto* misaligned = reinterpret_cast<float*>(reinterpret_cast<char*>(out.data()) + 2);
  refused({.capacity = count});
  refused({.out = misaligned, .capacity = count});
  refused({.out = out.data(), .stride_bytes = 8, .capacity = count});
  refused({.out = out.data(), .stride_bytes = 14, .capacity = count});
  refused({.out = out.data(), .capacity = count - 1});
  refused({.space = static_cast<Space>(9), .out = out.data(), .capacity = count});
  ReadDef far{.space = Space::kWorld, .out = out.data(), .capacity = count};
  far.origin_m[2] = static_cast<double>(kNan);
  refused(far, StatusCode::kNotFinite);
  CHECK(std::ranges::all_of(out, [](float v) { return v == -7; }));
}

TEST_CASE("mesh_info_refuses_bad_ids_and_meshes_and_covers_all_vertices") {
  Stage stage;
  MeshInfo mesh;
  check_refused(World().mesh_info(stage.asset, 0, &mesh), StatusCode::kInvalidArgument);
  check_refused(stage.world.mesh_info({}, 0, &mesh), StatusCode::kStaleId);
  check_refused(stage.world.mesh_info(stage.asset, 0, nullptr), StatusCode::kInvalidArgument);
  check_refused(stage.world.mesh_info(stage.asset, stage.info.mesh_count, &mesh),
                StatusCode::kInvalidArgument);
  CHECK(mesh.name == nullptr);
  REQUIRE(stage.info.mesh_count == 1);
  REQUIRE(stage.world.mesh_info(stage.asset, 0, &mesh).ok());
  CHECK(mesh.name != nullptr);
  CHECK(mesh.first_vertex == 0);
  CHECK(mesh.vertex_count == stage.info.vertex_count);
  CHECK(mesh.mesh_from_bind.m[1][1] == 1);
}

TEST_CASE("joint_name_and_bind_pose_refuse_bad_ids_joints_and_sizes") {
  Stage stage(0);
  std::array<Matrix34, 3> joints{};
  CHECK(stage.world.joint_name({}, 0) == nullptr);
  CHECK(stage.world.joint_name(stage.asset, 2) == nullptr);
  check_refused(stage.world.bind_pose({}, std::span(joints).first(2)), StatusCode::kStaleId);
  check_refused(stage.world.bind_pose(stage.asset, joints), StatusCode::kInvalidArgument);
  check_refused(stage.world.bind_pose(stage.asset, std::span(joints).first(1)), StatusCode::kInvalidArgument);
  CHECK(joints[0].m[0][0] == 0);
  CHECK(World().joint_name(stage.asset, 0) == nullptr);
}

TEST_CASE("null_outputs_are_refused") {
  Stage stage(1);
  check_refused(stage.world.asset_info(stage.asset, nullptr), StatusCode::kInvalidArgument);
  check_refused(stage.world.report(stage.blocks[0], nullptr), StatusCode::kInvalidArgument);
  check_refused(stage.world.asset_info({}, nullptr), StatusCode::kStaleId);
}

TEST_CASE("dt_that_is_no_time_advances_nothing") {
  Stage stage(1);
  stage.play(scenes::walk, 0.5);
  const std::vector<float> before = stage.read();
  for (const float dt : {kNan, -1.0f, 0.0f, -kInfinity}) {
    const FrameReport report = stage.world.step(dt);
    CHECK(report.ticks == 0);
    CHECK(report.dropped_s == 0);
  }
  CHECK(stage.read() == before);
}

TEST_CASE("step_inside_a_step_is_a_reported_fault_and_does_nothing") {
  struct Reentrant {
    World* world = nullptr;
    uint32_t inner_ticks = 99;
  } reentrant;
  const auto enqueue = [](TaskHook::Task task, void* argument, uint32_t count, void* context) -> void* {
    auto& self = *static_cast<Reentrant*>(context);
    self.inner_ticks = self.world->step(1).ticks;
    for (uint32_t i = 0; i < count; ++i) task(argument, i);
    return nullptr;
  };
  Stage stage(1, {.tasks = {.enqueue = enqueue, .finish = [](void*, void*) {}, .context = &reentrant}});
  reentrant.world = &stage.world;
  CHECK(stage.world.step(1.0f / 60).ticks == 1);
  CHECK(reentrant.inner_ticks == 0);
  CHECK(stage.faults.faults == 1);
}
