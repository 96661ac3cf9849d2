// frame_run.cpp  see frame_run.hpp.
#include "perf/frames/frame_run.hpp"

#include <cmath>
#include <memory>

#include "baker/common/bad_input.hpp"
#include "perf/frames/neighbour.hpp"
#include "perf/frames/unreliable_pool.hpp"
#include "perf/scale/stopwatch.hpp"

namespace sinew::perf {
namespace {

constexpr double kFrame_s = 1.0 / 60, kHitch_s = 0.2, kPhase_s = 0.37;
constexpr uint32_t kSecond = 60;  // frames
constexpr double kSpacing_m = 1.5;

void require(const Status& status) {
  if (!status.ok()) throw baker::BadInput(status.message);
}

class Floor {
 public:
  Floor(const demo::CharacterFile& character, const PoseTape& tape, const Scene& scene)
      : scene_(scene), tape_(tape), instances_(scene.instances) {
    const bool two = scene.trouble == Trouble::kWorkerLost;
    require(World::create(
        {.max_assets = 1, .max_instances = scene.instances, .tasks = two ? pool_.hook() : TaskHook{}},
        &world_));
    require(world_.load_asset(character.file.bytes(), &asset_));
    enter();
    require(world_.set_budget_us(scene.budget_us));
  }

  FrameCost frame(uint32_t index) {
    const bool each_second = index % kSecond == 0 && index > 0;
    pool_.lose_worker(index / kSecond % 2 == 1);
    if (scene_.trouble == Trouble::kEntrance && index % (2 * kSecond) == 0 && index > 0) enter();
    if (index == 0 || scene_.trouble == Trouble::kCuts) look_from(index / kSecond);
    const double dt_s = scene_.trouble == Trouble::kHitch && each_second ? kHitch_s : kFrame_s;
    time_s_ += dt_s;
    pose();
    return timed_step(dt_s);
  }

 private:
  void enter() {
    for (InstanceId& instance : instances_) {
      if (entered_) require(world_.destroy_instance(instance));
    }
    for (uint32_t i = 0; i < instances_.size(); ++i)
      require(world_.create_instance({.asset = asset_, .root = place(i)}, &instances_[i]));
    entered_ = true;
    const bool hidden = scene_.trouble == Trouble::kHidden;
    for (const InstanceId instance : instances_) require(world_.set_hidden(instance, hidden));
    look_from(0);
  }

  RootTransform place(uint32_t index) const {
    const auto side = static_cast<uint32_t>(std::ceil(std::sqrt(static_cast<double>(instances_.size()))));
    return {.position_m = {kSpacing_m * (index % side), 0, kSpacing_m * (index / side)}};
  }

  // The camera stands at one of the characters, another one each time; what is near matters more.
  void look_from(uint32_t cut) {
    constexpr double kNear_m = 3;
    const RootTransform eye = place((cut * 37) % static_cast<uint32_t>(instances_.size()));
    for (uint32_t i = 0; i < instances_.size(); ++i) {
      const RootTransform at = place(i);
      const double away_m =
          std::hypot(at.position_m[0] - eye.position_m[0], at.position_m[2] - eye.position_m[2]);
      require(world_.set_importance(instances_[i], static_cast<float>(1 / (1 + away_m / kNear_m))));
    }
  }

  void pose() {
    const double moving = scene_.trouble == Trouble::kAsleep ? 0 : 1;
    for (uint32_t i = 0; i < instances_.size(); ++i)
      require(world_.set_pose(instances_[i],
                              {.joints = tape_.joints(moving * time_s_ + kPhase_s * i), .root = place(i)}));
  }

  FrameCost timed_step(double dt_s) {
    FrameCost cost;
    const double cpu = clock_us(CLOCK_THREAD_CPUTIME_ID), wall = clock_us(CLOCK_MONOTONIC);
    cost.report = world_.step(static_cast<float>(dt_s));
    cost.wall_us = static_cast<float>(clock_us(CLOCK_MONOTONIC) - wall);
    cost.cpu_us = static_cast<float>(clock_us(CLOCK_THREAD_CPUTIME_ID) - cpu);
    return cost;
  }

  const Scene& scene_;
  const PoseTape& tape_;
  UnreliablePool pool_;
  World world_;
  AssetId asset_;
  std::vector<InstanceId> instances_;
  double time_s_ = 0;
  bool entered_ = false;
};

}  // namespace

std::vector<FrameCost> run_frames(const demo::CharacterFile& character, const PoseTape& tape,
                                  const Scene& scene, uint32_t frames) {
  Floor floor(character, tape, scene);
  const auto neighbour = scene.trouble == Trouble::kNeighbour ? std::make_unique<Neighbour>() : nullptr;
  std::vector<FrameCost> costs;
  costs.reserve(frames);
  for (uint32_t f = 0; f < frames; ++f) costs.push_back(floor.frame(f));
  return costs;
}

}  // namespace sinew::perf
