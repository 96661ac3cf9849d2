// test_any_weights.cpp  Whatever weights a network has, and whatever flesh it is put on, it does no harm.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "tests/world/stage.hpp"

using namespace sinew;
using test::Stage;

namespace {

constexpr double kFrame_s = 1.0 / 60;

baker::Safetensors shipped(const char* name) {
  return baker::read_safetensors(std::string(SINEW_SOURCE_DIR "/assets/weights/") + name);
}

// All numbers Gaussian, of deviation 1.
baker::Safetensors random_weights(uint32_t seed) {
  baker::Safetensors weights = shipped("creature.safetensors");
  std::mt19937 random(seed);
  std::normal_distribution<float> gauss;
  for (auto& [name, tensor] : weights.tensors)
    for (size_t at = 0; at + sizeof(float) <= tensor.bytes.size(); at += sizeof(float)) {
      const float value = gauss(random);
      std::memcpy(tensor.bytes.data() + at, &value, sizeof value);
    }
  return weights;
}

// To and fro, up and down and round for two seconds at a random pace; then it stands.
struct Shaking {
  explicit Shaking(uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> pace(0.5, 4), size(0.01, 0.06);
    for (int axis = 0; axis < 3; ++axis) hz[axis] = pace(random), size_m[axis] = size(random);
    turn_rad = 10 * size(random);
  }
  scenes::BlockPose operator()(double t) const {
    const double eased = std::min(1.0, t / 0.3) * std::clamp((2 - t) / 0.3, 0.0, 1.0);
    scenes::BlockPose pose = scenes::bent_pose(0.5 * eased * turn_rad * std::sin(6 * t));
    for (int axis = 0; axis < 3; ++axis)
      pose.root.position_m[axis] = eased * size_m[axis] * std::sin(2 * M_PI * hz[axis] * t);
    return pose;
  }
  double hz[3], size_m[3], turn_rad;
};

struct Course {
  double largest_m = 0, left_m = 0;  // while it is shaken; after `rest_s`
};

float modal_cost_us(const scenes::PackBytes& pack) {
  pack::PackView view;
  REQUIRE(pack::open_pack(pack.bytes(), &view).ok());
  for (const pack::TierRecord& record : view.tiers)
    if (record.tier == static_cast<uint32_t>(Tier::kModal)) return record.cost_us;
  return 0;
}

// to_and_fro: the network is taken away and given back, half a second each.
Course run(const scenes::BlockOptions& options, const Shaking& shaking, double rest_s,
           bool to_and_fro = false) {
  const scenes::PackBytes pack = scenes::soft_block(options);
  Stage stage(1, {.sleep_tolerance = 0, .budget_mode = BudgetMode::kWorkUnits}, pack);
  Course course;
  for (int frame = 0; stage.time_s < 2; ++frame) {
    const bool less = to_and_fro && frame / 30 % 2 == 1;
    REQUIRE(stage.world.set_budget_us(less ? 1.01f * modal_cost_us(pack) : 1e6f).ok());
    stage.step(shaking, kFrame_s);
    course.largest_m = std::max(course.largest_m, test::largest_length(stage.read(0, Space::kBind)));
  }
  stage.play(shaking, rest_s);
  course.left_m = test::largest_length(stage.read(0, Space::kBind));
  CHECK(stage.report().restarts == 0);
  return course;
}

}  // namespace

// What it corrected goes on with the modes and counts when it is back: no new budget each time.
TEST_CASE("a_network_that_comes_and_goes_does_no_more_harm") {
  const baker::Safetensors wild = random_weights(4);
  for (int i = 0; i < 40; ++i) {
    const double hz = 0.05 * std::pow(20 / 0.05, i / 39.0);
    scenes::BlockOptions options{
        .cells = 3, .nodes = 8, .displacement_limit = 4, .frequency_share = hz / 3.5};
    const Shaking shaking(static_cast<uint32_t>(i));
    options.network = false;
    const Course base = run(options, shaking, 1);
    options.network = true;
    options.weights = &wild;
    const Course corrected = run(options, shaking, 1, true);
    INFO("region " << i << ", " << hz << " Hz: base " << base.largest_m << " m, corrected "
                   << corrected.largest_m);
    CHECK(corrected.largest_m < 1.75 * base.largest_m);
  }
}

constexpr int kRegions = 300;

double region_hz(int i) { return 0.05 * std::pow(20 / 0.05, i / (kRegions - 1.0)); }

std::vector<baker::Safetensors> all_weights() {
  return {shipped("creature.safetensors"), random_weights(1), random_weights(2), random_weights(3)};
}

constexpr double kSmall = 0.02;

// Of 0.05 to 20 Hz, without limits, beside the same flesh on its modal base alone, while frames do not turn:
// the proof bounds the norm over modes by 1.5 of the base's; a vertex adds a little
// (tissue/modes/correction_budget.hpp).
TEST_CASE("no_weights_move_flesh_much_further_than_its_base_nor_keep_it_from_rest") {
  const std::vector<baker::Safetensors> all = all_weights();
  double most = 0, left = 0;
  for (int i = 0; i < kRegions; ++i) {
    const double hz = region_hz(i);
    scenes::BlockOptions options{
        .cells = 3, .nodes = 8, .displacement_limit = 1000, .frequency_share = hz / 3.5};
    Shaking shaking(static_cast<uint32_t>(i));
    shaking.turn_rad = 0;
    // Within what the world's bound leaves alone (character/output/displacement_bound.hpp).
    for (double& size_m : shaking.size_m) size_m *= kSmall;
    const double rest_s = std::min(20.0, 2 + 4 / hz);
    options.network = false;
    const Course base = run(options, shaking, rest_s);
    options.network = true;
    options.weights = &all[static_cast<size_t>(i) % all.size()];
    const Course corrected = run(options, shaking, rest_s);
    INFO("region " << i << ", " << hz << " Hz: base " << base.largest_m << " m, left " << base.left_m
                   << "; corrected " << corrected.largest_m << " m, left " << corrected.left_m);
    most = std::max(most, corrected.largest_m / base.largest_m);
    left = std::max(left, (corrected.left_m - base.left_m) / base.largest_m);
    CHECK(corrected.largest_m < 1.6 * base.largest_m);
    // What it may add, half of the largest above, fades as the flesh does.
    CHECK(corrected.left_m < base.left_m +
                                 0.5 * std::exp(-0.1 * 2 * M_PI * hz * rest_s) * corrected.largest_m +
                                 1e-4 * base.largest_m);
  }
  WARN("corrected flesh moves " << most << " times as far as its base at most, and is left further off by "
                                << left << " of that");
}

// Turning frames hear of corrections, which the proof leaves out: of flesh slower than a third of a hertz,
// whose frames turn faster than it swings, a limit keeps what is shown. Four radii are the widest.
TEST_CASE("where_frames_turn_no_weights_show_flesh_much_further_out_than_its_base_does") {
  const std::vector<baker::Safetensors> all = all_weights();
  double most = 0;
  for (int i = 0; i < kRegions; ++i) {
    scenes::BlockOptions options{
        .cells = 3, .nodes = 8, .displacement_limit = 4, .frequency_share = region_hz(i) / 3.5};
    const Shaking shaking(static_cast<uint32_t>(i));
    options.network = false;
    const Course base = run(options, shaking, 0);
    options.network = true;
    options.weights = &all[static_cast<size_t>(i) % all.size()];
    const Course corrected = run(options, shaking, 0);
    INFO("region " << i << ", " << region_hz(i) << " Hz: base " << base.largest_m << " m, corrected "
                   << corrected.largest_m << " m");
    most = std::max(most, corrected.largest_m / base.largest_m);
    CHECK(corrected.largest_m < 1.6 * base.largest_m);
  }
  WARN("corrected flesh is shown " << most << " times as far out as its base at most");
}
