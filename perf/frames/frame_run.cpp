// frame_run.cpp  see frame_run.hpp.
#include "perf/frames/frame_run.hpp"

#include <memory>

#include "perf/frames/camera.hpp"
#include "perf/frames/floor.hpp"
#include "perf/frames/neighbour.hpp"
#include "perf/frames/unreliable_pool.hpp"
#include "perf/frames/walls.hpp"
#include "perf/scale/require.hpp"
#include "perf/scale/stopwatch.hpp"

namespace sinew::perf {
namespace {

constexpr double kFrame_s = 1.0 / kFrames_a_second, kHitch_s = 0.2, kPhase_s = 0.37;
constexpr uint32_t kSecond = kFrames_a_second;

class Floor {
 public:
  Floor(const demo::CharacterFile& character, const PoseTape& tape, const Scene& scene)
      : scene_(scene), tape_(tape), instances_(scene.instances) {
    const bool two = scene.trouble == Trouble::kWorkerLost;
    if (scene.trouble == Trouble::kWalls) walls_ = make_walls(scene.instances);
    require(World::create({.max_assets = 1,
                           .max_instances = scene.instances,
                           .occlusion = walls_.get(),
                           .tasks = two ? pool_.hook() : TaskHook{}},
                          &world_));
    require(world_.load_asset(character.file.bytes(), &asset_));
    enter();
    require(world_.set_budget_us(scene.budget_us));
  }

  FrameCost frame(uint32_t index) {
    const bool each_second = index % kSecond == 0 && index > 0;
    pool_.lose_worker(index / kSecond % 2 == 1);
    if (scene_.trouble == Trouble::kEntrance && index % (2 * kSecond) == 0 && index > 0) enter();
    look(camera_of(scene_, index));
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
  }

  RootTransform place(uint32_t index) const { return place_on_floor(index, scene_.instances); }
  void look(const View& view) { require(world_.set_views({&view, 1})); }

  void pose() {
    const double moving = scene_.trouble == Trouble::kAsleep ? 0 : 1;
    for (uint32_t i = 0; i < instances_.size(); ++i)
      require(world_.set_pose(instances_[i],
                              {.joints = tape_.joints(moving * time_s_ + kPhase_s * i), .root = place(i)}));
  }

  FrameCost timed_step(double dt_s) {
    FrameCost cost;
    let_interrupts_by();
    const double cpu = clock_us(CLOCK_THREAD_CPUTIME_ID), wall = clock_us(CLOCK_MONOTONIC);
    cost.report = world_.step(static_cast<float>(dt_s));
    cost.wall_us = static_cast<float>(clock_us(CLOCK_MONOTONIC) - wall);
    cost.cpu_us = static_cast<float>(clock_us(CLOCK_THREAD_CPUTIME_ID) - cpu);
    return cost;
  }

  const Scene& scene_;
  const PoseTape& tape_;
  UnreliablePool pool_;
  std::unique_ptr<OcclusionSource> walls_;
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
