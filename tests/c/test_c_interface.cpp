// test_c_interface.cpp  The C interface refuses what it is misused with, and gives the bits that C++ gives.
#include <array>
#include <cstring>
#include <limits>
#include <string>
#include <thread>

#include "sinew/sinew.h"
#include "tests/scenes/half_spaces.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using test::Stage;

namespace {

constexpr float kTick_s = 1.0f / 60;

// What a Stage is, through C.
struct Show {
  sinew_world world{};
  sinew_asset asset{};
  sinew_asset_info info{};
  sinew_instance instance{};

  explicit Show(const scenes::PackBytes& pack = test::block_pack(), const sinew_contact_source* source = {}) {
    const sinew_world_def def = sinew_default_world_def();
    REQUIRE(sinew_create_world(SINEW_LAYOUT, &def, &world) == SINEW_OK);
    REQUIRE(sinew_load_asset(world, pack.bytes().data(), pack.bytes().size(), &asset) == SINEW_OK);
    REQUIRE(sinew_get_asset_info(world, asset, &info) == SINEW_OK);
    sinew_instance_def made = sinew_default_instance_def();
    made.asset = asset;
    if (source) made.contacts = *source;
    REQUIRE(sinew_create_instance(world, &made, &instance) == SINEW_OK);
  }
  ~Show() { sinew_destroy_world(world); }
  Show(const Show&) = delete;
  Show& operator=(const Show&) = delete;

  sinew_status set(const scenes::BlockPose& from) const {
    sinew_pose pose = sinew_default_pose();
    pose.joints = reinterpret_cast<const sinew_matrix34*>(from.joints.data());
    pose.joint_count = 2;
    std::memcpy(&pose.root, &from.root, sizeof pose.root);
    return sinew_set_pose(world, instance, &pose);
  }
  void play(const test::Motion& motion, int frames) const {
    for (int f = 1; f <= frames; ++f) {
      REQUIRE(set(motion(f / 60.0)) == SINEW_OK);
      REQUIRE(sinew_step(world, kTick_s, nullptr) == SINEW_OK);
    }
  }
  std::vector<float> places() const {
    std::vector<float> out(size_t{3} * info.vertex_count);
    REQUIRE(sinew_read_positions(world, instance, SINEW_SPACE_CHARACTER, out.data(), info.vertex_count) ==
            SINEW_OK);
    return out;
  }
};

void refuses(sinew_status status, sinew_status expected, const char* why) {
  CHECK(status == expected);
  CHECK_THAT(sinew_message(), Catch::Contains(why));
  (void)sinew_force_isa("abacus");  // so that the next one's message is its own
}

}  // namespace

TEST_CASE("null_pointers_are_refused_and_named") {
  const Show show;
  const sinew_world w = show.world;
  const sinew_instance i = show.instance;
  constexpr sinew_status kInvalid = SINEW_INVALID_ARGUMENT;
  sinew_asset asset;
  refuses(sinew_create_world(SINEW_LAYOUT, nullptr, nullptr), kInvalid, "null");
  refuses(sinew_load_asset(w, nullptr, 64, &asset), kInvalid, "null");
  refuses(sinew_load_asset_file(w, nullptr, &asset), kInvalid, "null");
  refuses(sinew_load_asset_file(w, "x", nullptr), kInvalid, "null");
  refuses(sinew_get_asset_info(w, show.asset, nullptr), kInvalid, "null");
  refuses(sinew_get_asset_arrays(w, show.asset, nullptr), kInvalid, "null");
  refuses(sinew_get_mesh_info(w, show.asset, 0, nullptr), kInvalid, "null");
  refuses(sinew_get_region_info(w, show.asset, 0, nullptr), kInvalid, "null");
  refuses(sinew_bind_pose(w, show.asset, nullptr, 2), kInvalid, "null");
  refuses(sinew_sample_clip(w, show.asset, 0, 0, 0, nullptr, 2), kInvalid, "null");
  refuses(sinew_create_instance(w, nullptr, nullptr), kInvalid, "null");
  refuses(sinew_set_pose(w, i, nullptr), kInvalid, "null");
  sinew_pose pose = sinew_default_pose();
  refuses(sinew_set_pose(w, i, &pose), kInvalid, "joints");
  refuses(sinew_set_views(w, nullptr, 1), kInvalid, "null");
  refuses(sinew_get_report(w, i, nullptr), kInvalid, "null");
  refuses(sinew_read_surface(w, i, nullptr), kInvalid, "null");
  refuses(sinew_read_positions(w, i, SINEW_SPACE_WORLD, nullptr, 1000), kInvalid, "null");
  refuses(sinew_read_joint_matrices(w, i, nullptr, 2), kInvalid, "null");
  refuses(sinew_read_points(w, i, SINEW_SPACE_WORLD, nullptr, nullptr, 1, nullptr), kInvalid, "null");
  refuses(sinew_get_bounds(w, i, nullptr), kInvalid, "null");
  refuses(sinew_save_state(w, i, nullptr, 1 << 20), kInvalid, "null");
  refuses(sinew_restore_state(w, i, nullptr, 1 << 20), kInvalid, "null");
  refuses(sinew_force_isa(nullptr), SINEW_UNSUPPORTED, "avail");
  CHECK(sinew_history(w, nullptr, 8) == 0);
  CHECK(sinew_take_events(w, nullptr, 8) == 0);
  CHECK(sinew_joint_path(w, show.asset, 0, nullptr, 8) == 4);
  CHECK(sinew_isa_name(1000) == nullptr);
}

TEST_CASE("structs_that_no_default_function_made_are_refused_by_its_name") {
  const Show show;
  sinew_world world = {5, 5};
  sinew_world_def def{};
  refuses(sinew_create_world(SINEW_LAYOUT, &def, &world), SINEW_INVALID_ARGUMENT, "sinew_default_world_def");
  CHECK(world.index1 == 5);
  sinew_instance_def made{};
  sinew_instance instance;
  refuses(sinew_create_instance(show.world, &made, &instance), SINEW_INVALID_ARGUMENT,
          "sinew_default_instance_def");
  const sinew_pose pose{};
  refuses(sinew_set_pose(show.world, show.instance, &pose), SINEW_INVALID_ARGUMENT, "sinew_default_pose");
  const sinew_view view{};
  refuses(sinew_set_views(show.world, &view, 1), SINEW_INVALID_ARGUMENT, "sinew_default_view");
  const sinew_surface_def surface{};
  refuses(sinew_read_surface(show.world, show.instance, &surface), SINEW_INVALID_ARGUMENT,
          "sinew_default_surface_def");
}

TEST_CASE("another_header_and_ids_of_what_is_gone_are_refused") {
  const sinew_world_def def = sinew_default_world_def();
  sinew_world world;
  refuses(sinew_create_world(SINEW_LAYOUT + 1, &def, &world), SINEW_UNSUPPORTED, "another version");
  REQUIRE(sinew_create_world(SINEW_LAYOUT, &def, &world) == SINEW_OK);
  REQUIRE(sinew_destroy_world(world) == SINEW_OK);
  refuses(sinew_step(world, kTick_s, nullptr), SINEW_STALE_ID, "destroyed");
  refuses(sinew_destroy_world(world), SINEW_STALE_ID, "destroyed");
  sinew_world next;
  REQUIRE(sinew_create_world(SINEW_LAYOUT, &def, &next) == SINEW_OK);
  CHECK(sinew_step(world, kTick_s, nullptr) == SINEW_STALE_ID);  // in the same place, perhaps
  CHECK(sinew_step({}, kTick_s, nullptr) == SINEW_STALE_ID);
  CHECK(sinew_step({65, 1}, kTick_s, nullptr) == SINEW_STALE_ID);
  CHECK(sinew_destroy_world(next) == SINEW_OK);
  const Show show;
  CHECK(sinew_get_asset_info(show.world, {}, nullptr) == SINEW_STALE_ID);
  REQUIRE(sinew_destroy_instance(show.world, show.instance) == SINEW_OK);
  CHECK(sinew_reset(show.world, show.instance) == SINEW_STALE_ID);
  CHECK(sinew_state_bytes(show.world, show.instance) == 0);
}

TEST_CASE("numbers_out_of_range_change_nothing") {
  const Show show;
  show.play(scenes::walk, 20);
  const std::vector<float> before = show.places();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  scenes::BlockPose bad = scenes::walk(1);
  bad.joints[0].m[0][0] = nan;
  CHECK(show.set(bad) == SINEW_NOT_FINITE);
  CHECK(sinew_set_budget_us(show.world, -1) == SINEW_INVALID_ARGUMENT);
  CHECK(sinew_set_time_scale(show.world, show.instance, nan) == SINEW_NOT_FINITE);
  for (const sinew_tier none : {sinew_tier{SINEW_TIER_EXTRAPOLATE}, sinew_tier{3}, SINEW_NONE})
    CHECK(sinew_set_tier_limit(show.world, show.instance, none) == SINEW_INVALID_ARGUMENT);
  sinew_view view = sinew_default_view();
  view.aspect = 0;
  CHECK(sinew_set_views(show.world, &view, 1) == SINEW_INVALID_ARGUMENT);
  std::array<sinew_view, 9> many;
  many.fill(sinew_default_view());
  CHECK(sinew_set_views(show.world, many.data(), 9) == SINEW_INVALID_ARGUMENT);
  CHECK(show.places() == before);
  const Show twin;
  twin.play(scenes::walk, 20);
  for (const Show* each : {&show, &twin}) {
    REQUIRE(each->set(scenes::walk(0.4)) == SINEW_OK);
    REQUIRE(sinew_step(each->world, kTick_s, nullptr) == SINEW_OK);
  }
  CHECK(show.places() == twin.places());
}

TEST_CASE("defaults_are_those_of_cpp") {
  const WorldDef world;
  const sinew_world_def c_world = sinew_default_world_def();
  CHECK(c_world.max_instances == world.max_instances);
  CHECK(c_world.sleep_tolerance == world.sleep_tolerance);
  CHECK(c_world.sight_rays_per_step == world.sight_rays_per_step);
  const InstanceDef instance;
  const sinew_instance_def c_instance = sinew_default_instance_def();
  CHECK(c_instance.importance == instance.importance);
  CHECK(c_instance.root.scale == instance.root.scale);
  CHECK(c_instance.rods_touch == instance.contacts.rods);
  CHECK(c_instance.max_rod_iterations == instance.max_rod_iterations);
  CHECK(sinew_default_view().far_m == View().far_m);
}

TEST_CASE("parameters_and_environment_cross_as_cpp_has_them") {
  const Show show;
  Stage stage;
  const sinew_part_parameters unmade{};
  refuses(sinew_set_parameters(show.world, show.instance, nullptr), SINEW_INVALID_ARGUMENT, "null");
  refuses(sinew_set_parameters(show.world, show.instance, &unmade), SINEW_INVALID_ARGUMENT,
          "sinew_default_part_parameters");
  const sinew_environment no_air{};
  refuses(sinew_set_environment(show.world, &no_air), SINEW_INVALID_ARGUMENT, "sinew_default_environment");
  refuses(sinew_set_added_environment(show.world, show.instance, nullptr), SINEW_INVALID_ARGUMENT, "null");
  refuses(sinew_get_environment(show.world, nullptr), SINEW_INVALID_ARGUMENT, "null");
  refuses(sinew_get_parameters(show.world, show.instance, nullptr), SINEW_INVALID_ARGUMENT, "null");
  sinew_part_parameters softer = sinew_default_part_parameters();
  CHECK(softer.stiffness == PartParameters().stiffness);
  softer.stiffness = 0;
  CHECK(sinew_set_region_parameters(show.world, show.instance, 0, &softer) == SINEW_INVALID_ARGUMENT);
  softer.stiffness = 0.5f;
  softer.intensity = 0.7f;
  REQUIRE(sinew_set_region_parameters(show.world, show.instance, 0, &softer) == SINEW_OK);
  REQUIRE(stage.world.set_region_parameters(stage.blocks[0], 0, {.intensity = 0.7f, .stiffness = 0.5f}).ok());
  sinew_environment air = sinew_default_environment();
  CHECK(air.gravity_m_s2[1] == Environment().gravity_m_s2[1]);
  air.gravity_m_s2[1] = 4;
  REQUIRE(sinew_set_environment(show.world, &air) == SINEW_OK);
  REQUIRE(stage.world.set_environment({.gravity_m_s2 = {0, 4, 0}}).ok());
  const sinew_added_environment push{{1, 2, 3}, {4, 5, 6}};
  REQUIRE(sinew_set_added_environment(show.world, show.instance, &push) == SINEW_OK);
  REQUIRE(stage.world.set_added_environment(stage.blocks[0], {{1, 2, 3}, {4, 5, 6}}).ok());
  show.play(scenes::walk, 40);
  for (int f = 1; f <= 40; ++f) {
    stage.pose(stage.blocks[0], scenes::walk(f / 60.0));
    stage.world.step(kTick_s);
  }
  CHECK(show.places() == stage.read());
  sinew_part_parameters found;
  REQUIRE(sinew_get_region_parameters(show.world, show.instance, 0, &found) == SINEW_OK);
  CHECK(found.intensity == 0.7f);
  sinew_environment felt;
  REQUIRE(sinew_get_environment(show.world, &felt) == SINEW_OK);
  CHECK(felt.gravity_m_s2[1] == 4);
  sinew_added_environment added;
  REQUIRE(sinew_get_added_environment(show.world, show.instance, &added) == SINEW_OK);
  CHECK(added.wind_m_s[2] == 6);
}

TEST_CASE("what_c_plays_has_the_bits_that_cpp_gives") {
  Stage stage;
  const Show show;
  for (int f = 1; f <= 90; ++f) {
    stage.pose(stage.blocks[0], scenes::walk(f / 60.0));
    const FrameReport report = stage.world.step(kTick_s);
    REQUIRE(show.set(scenes::walk(f / 60.0)) == SINEW_OK);
    sinew_frame_report c_report;
    REQUIRE(sinew_step(show.world, kTick_s, &c_report) == SINEW_OK);
    CHECK(c_report.frame == report.frame);
    CHECK(c_report.instances_network == report.instances_network);
    CHECK(c_report.expected_error == report.expected_error);
  }
  CHECK(show.places() == stage.read());
  sinew_instance_report c_report;
  REQUIRE(sinew_get_report(show.world, show.instance, &c_report) == SINEW_OK);
  CHECK(c_report.tier == SINEW_TIER_NETWORK);
  CHECK(c_report.blend == stage.report().blend);
  std::vector<float> normals(show.places().size()), cpp_normals(normals.size());
  REQUIRE(sinew_read_normals(show.world, show.instance, SINEW_SPACE_WORLD, normals.data(),
                             show.info.vertex_count) == SINEW_OK);
  REQUIRE(stage.world
              .read_normals(
                  stage.blocks[0],
                  {.space = Space::kWorld, .out = cpp_normals.data(), .capacity = stage.info.vertex_count})
              .ok());
  CHECK(normals == cpp_normals);
}

TEST_CASE("a_tier_s_limit_crosses_as_cpp_has_it") {
  const Show show;
  for (const sinew_tier best : {SINEW_TIER_MODAL, SINEW_TIER_NETWORK}) {
    REQUIRE(sinew_set_tier_limit(show.world, show.instance, best) == SINEW_OK);
    show.play(scenes::walk, 2);
    sinew_instance_report report;
    REQUIRE(sinew_get_report(show.world, show.instance, &report) == SINEW_OK);
    CHECK(report.tier == best);
  }
}

TEST_CASE("a_contact_source_in_c_is_asked_and_answers_as_one_in_cpp") {
  scenes::HalfSpaces ceiling;
  ceiling.walls.push_back({.point_m = {0, 0.55, 0}, .normal = {0, -1, 0}});
  const sinew_contact_source source{.find =
                                        [](const sinew_contact_probe* probes, uint32_t count, float dt_s,
                                           sinew_contact_hit* hits, uint32_t capacity, void* context) {
                                          return static_cast<scenes::HalfSpaces*>(context)->find(
                                              {reinterpret_cast<const ContactProbe*>(probes), count}, dt_s,
                                              {reinterpret_cast<ContactHit*>(hits), capacity});
                                        },
                                    .push = nullptr,
                                    .context = &ceiling};
  const Show touching(test::block_pack(), &source), free;
  touching.play(scenes::walk, 30);
  free.play(scenes::walk, 30);
  sinew_instance_report report;
  REQUIRE(sinew_get_report(touching.world, touching.instance, &report) == SINEW_OK);
  CHECK(report.vertices_touched > 0);
  CHECK(touching.places() != free.places());
}

TEST_CASE("a_step_within_a_step_is_refused_without_harm") {
  static sinew_world inner;
  static sinew_status answer;
  sinew_world_def def = sinew_default_world_def();
  def.clock.now_ns = [](void*) -> uint64_t {
    if (inner.index1) answer = sinew_step(inner, kTick_s, nullptr);
    return 0;
  };
  sinew_world world;
  REQUIRE(sinew_create_world(SINEW_LAYOUT, &def, &world) == SINEW_OK);
  inner = world;
  CHECK(sinew_step(world, kTick_s, nullptr) == SINEW_OK);
  CHECK(answer == SINEW_INVALID_ARGUMENT);
  inner = {};
  CHECK(sinew_step(world, kTick_s, nullptr) == SINEW_OK);
  CHECK(sinew_destroy_world(world) == SINEW_OK);
}

TEST_CASE("worlds_are_made_on_many_threads_until_there_are_sixty_four") {
  std::vector<sinew_world> worlds(64);
  std::vector<std::thread> threads;
  for (size_t t = 0; t < 4; ++t)
    threads.emplace_back([&worlds, t] {
      const sinew_world_def def = sinew_default_world_def();
      for (size_t i = t; i < worlds.size(); i += 4) sinew_create_world(SINEW_LAYOUT, &def, &worlds[i]);
    });
  for (std::thread& thread : threads) thread.join();
  const sinew_world_def def = sinew_default_world_def();
  sinew_world one_more;
  refuses(sinew_create_world(SINEW_LAYOUT, &def, &one_more), SINEW_OUT_OF_CAPACITY, "64");
  for (const sinew_world world : worlds) CHECK(sinew_destroy_world(world) == SINEW_OK);
}

TEST_CASE("messages_are_of_their_own_thread") {
  const Show show;
  CHECK(sinew_set_budget_us(show.world, -1) == SINEW_INVALID_ARGUMENT);
  const std::string mine = sinew_message();
  std::string other = "none yet";
  std::thread([&] { other = sinew_message(); }).join();
  CHECK(other.empty());
  CHECK(mine == sinew_message());
}
