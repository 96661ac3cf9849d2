// test_rod_start.cpp  What rods' iterations start from: as baked, or as an instance says.
#include <algorithm>
#include <cstring>

#include "tests/pack/random_coping_net.hpp"
#include "tests/scenes/thread_pool.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using scenes::kTail;
using test::Stage;

namespace {

// Soft enough for several iterations in some ticks.
constexpr double kYoung_pa = 2e4;
// Of joints of rods that are 0.4 m long, in a motion that does not whirl them: the last iteration of a tick
// turned no segment by more than 0.01 rad, and so left about the square of that.
constexpr double kTolerance = 1e-3;

// The tail starts learned, the horns do not. A network of random weights guesses badly; where the iteration
// ends must not tell.
const scenes::PackBytes& learned_pack() {
  static const baker::Safetensors net = test::random_coping_net();
  static const scenes::PackBytes pack =
      scenes::soft_block({.network = false,
                          .rods = scenes::RodMatter{.young_modulus_pa = kYoung_pa, .learned = true},
                          .rod_weights = &net});
  return pack;
}

const scenes::PackBytes& plain_pack() {
  static const scenes::PackBytes pack =
      scenes::soft_block({.network = false, .rods = scenes::RodMatter{.young_modulus_pa = kYoung_pa}});
  return pack;
}

struct StartStage : Stage {
  explicit StartStage(std::initializer_list<InstanceDef> defs, WorldDef def = {},
                      const scenes::PackBytes& pack = learned_pack())
      : Stage(0, def, pack) {
    for (InstanceDef instance : defs) {
      instance.asset = asset;
      blocks.emplace_back();
      REQUIRE(world.create_instance(instance, &blocks.back()).ok());
    }
  }
  double strength = 0.3;  // beyond, the tail whirls, and any difference grows tenfold a second
  void step() {
    time_s += 1.0 / 60;
    for (const InstanceId block : blocks)
      REQUIRE(world.set_pose(block, scenes::with_rods(scenes::shake(time_s, strength)).pose()).ok());
    world.step(1.0f / 60);
  }
  std::vector<Matrix34> joints(size_t index) const {
    std::vector<Matrix34> out(info.joint_count);
    REQUIRE(world.read_joint_matrices(blocks[index], out).ok());
    return out;
  }
};

double largest_difference(std::span<const Matrix34> a, std::span<const Matrix34> b) {
  double largest = 0;
  for (size_t j = 0; j < a.size(); ++j)
    for (int k = 0; k < 12; ++k)
      largest = std::fmax(largest, std::fabs(double{a[j].m[k / 4][k % 4]} - double{b[j].m[k / 4][k % 4]}));
  return largest;
}

bool same_bits(const std::vector<Matrix34>& a, const std::vector<Matrix34>& b) {
  return std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
}

constexpr InstanceDef kContinued{.rod_start = RodWarmStart::kContinued},
    kLearned{.rod_start = RodWarmStart::kLearned};

}  // namespace

TEST_CASE("a_start_that_there_is_not_is_refused_and_nothing_is_made") {
  Stage stage(0, {}, plain_pack());
  InstanceId out;
  CHECK_FALSE(stage.info.rod_network);
  Status status =
      stage.world.create_instance({.asset = stage.asset, .rod_start = RodWarmStart::kLearned}, &out);
  CHECK(status.code == StatusCode::kInvalidArgument);
  CHECK(std::string(status.message).find("sinew-bake character --rods") != std::string::npos);
  status = stage.world.create_instance({.asset = stage.asset, .rod_start = RodWarmStart{3}}, &out);
  CHECK(status.code == StatusCode::kInvalidArgument);
  for (const uint32_t most : {0u, 1001u}) {
    status = stage.world.create_instance({.asset = stage.asset, .max_rod_iterations = most}, &out);
    CHECK(status.code == StatusCode::kInvalidArgument);
    CHECK(std::string(status.message).find("max_rod_iterations") != std::string::npos);
  }
  CHECK(is_null(out));
}

TEST_CASE("rods_stop_after_as_many_iterations_as_an_instance_allows") {
  StartStage stage({{.max_rod_iterations = 1}, {}});
  stage.strength = 1;
  uint32_t most = 0;
  for (int tick = 0; tick < 120; ++tick) {
    stage.step();
    CHECK(stage.report(0).rod_iterations == stage.info.rod_count);
    most = std::max(most, stage.report(1).rod_iterations);
  }
  CHECK(most > stage.info.rod_count);
}

TEST_CASE("the_start_of_rods_does_not_change_where_they_end") {
  StartStage stage({kContinued, kLearned, {}});
  CHECK(stage.info.rod_network);
  double largest = 0, moved = 0;
  for (int tick = 0; tick < 300; ++tick) {
    stage.step();
    for (const size_t other : {1u, 2u})
      largest = std::fmax(largest, largest_difference(stage.joints(0), stage.joints(other)));
    const scenes::TailedPose pose = scenes::with_rods(scenes::shake(stage.time_s, stage.strength));
    moved = std::fmax(moved, largest_difference(stage.joints(0), pose.joints));
  }
  CHECK(moved > 10 * kTolerance);
  CHECK(largest < kTolerance);
  CHECK_FALSE(same_bits(stage.joints(0), stage.joints(1)));  // they did start differently
}

TEST_CASE("weights_that_overflow_are_no_guess_and_throw_no_rod") {
  baker::Safetensors net = test::random_coping_net();
  for (auto& [name, tensor] : net.tensors) {
    std::vector<float> values = tensor.as_f32();
    for (float& v : values) v *= name.starts_with("norm") ? 20.0f : 1e20f;
    tensor = baker::tensor_f32(tensor.shape, values);
  }
  const scenes::PackBytes pack = scenes::soft_block(
      {.network = false, .rods = scenes::RodMatter{.young_modulus_pa = kYoung_pa}, .rod_weights = &net});
  StartStage stage({kContinued, kLearned}, {}, pack);
  double largest = 0;
  for (int tick = 0; tick < 120; ++tick) {
    stage.step();
    largest = std::fmax(largest, largest_difference(stage.joints(0), stage.joints(1)));
  }
  CHECK(stage.report(1).rod_recoveries == 0);
  CHECK(largest < kTolerance);
}

TEST_CASE("a_rod_starts_as_its_recipe_says_beside_others_that_do_not") {
  StartStage stage({{}, kContinued});
  for (int tick = 0; tick < 60; ++tick) stage.step();
  const auto baked = stage.joints(0), continued = stage.joints(1);
  CHECK(std::memcmp(&baked[scenes::kHorns[0]], &continued[scenes::kHorns[0]], 6 * sizeof(Matrix34)) == 0);
  CHECK(std::memcmp(&baked[kTail], &continued[kTail], 4 * sizeof(Matrix34)) != 0);
}

TEST_CASE("learned_starts_have_the_same_bits_on_any_number_of_threads") {
  scenes::ThreadPool pool(3);
  StartStage one({kLearned, kLearned, kLearned, kLearned}),
      many({kLearned, kLearned, kLearned, kLearned}, {.tasks = pool.hook()});
  for (int tick = 0; tick < 60; ++tick) one.step(), many.step();
  for (size_t i = 0; i < 4; ++i) CHECK(same_bits(one.joints(i), many.joints(i)));
}

TEST_CASE("a_snapshot_keeps_what_a_learned_start_remembers_and_fits_no_other_start") {
  StartStage stage({kLearned}), other({kContinued});
  for (int tick = 0; tick < 40; ++tick) stage.step(), other.step();
  const std::vector<std::byte> saved = stage.save();
  const double time_s = stage.time_s;
  for (int tick = 0; tick < 20; ++tick) stage.step();
  const auto first = stage.joints(0);
  REQUIRE(stage.world.restore_state(stage.blocks[0], saved).ok());
  stage.time_s = time_s;
  for (int tick = 0; tick < 20; ++tick) stage.step();
  CHECK(same_bits(first, stage.joints(0)));
  const auto untouched = other.joints(0);
  const Status status = other.world.restore_state(other.blocks[0], saved);
  CHECK(status.code == StatusCode::kCorrupt);
  CHECK(std::string(status.message).find("rod_start") != std::string::npos);
  CHECK(same_bits(untouched, other.joints(0)));
}

TEST_CASE("iterations_and_the_residual_of_rods_are_reported") {
  StartStage stage({kLearned, {.rod_start = RodWarmStart::kLearned, .report_rod_residual = true}});
  for (int tick = 0; tick < 30; ++tick) stage.step();
  CHECK(stage.report(0).rod_iterations >= stage.info.rod_count);
  CHECK(stage.report(0).rod_iterations == stage.report(1).rod_iterations);
  CHECK(stage.report(0).rod_residual == 0);
  CHECK(stage.report(1).rod_residual > 0);
  CHECK(stage.report(1).rod_residual < 0.1f);
  CHECK(same_bits(stage.joints(0), stage.joints(1)));
  for (int tick = 0; tick < 3000; ++tick) stage.world.step(1.0f / 60);  // at rest
  CHECK(stage.report(0).rods_asleep == stage.info.rod_count);
  CHECK(stage.report(0).rod_iterations == 0);
  CHECK(stage.report(1).rod_residual == 0);
}
