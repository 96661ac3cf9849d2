// shown_pack.hpp  One instance of a pack in a world of its own, posed and read frame by frame.
#pragma once
#include <limits>
#include <span>
#include <vector>

#include "baker/common/bad_input.hpp"
#include "baker/measure/loaded_pack.hpp"
#include "sinew/world.hpp"

namespace sinew::perf {

inline void must(const Status& status) {
  if (!status.ok()) throw baker::BadInput(status.message);
}

class ShownPack {
 public:
  // budget_us 0: skinning.
  explicit ShownPack(const baker::LoadedPack& pack,
                     float budget_us = std::numeric_limits<float>::infinity()) {
    must(
        World::create({.max_assets = 1, .max_instances = 1, .budget_mode = BudgetMode::kWorkUnits}, &world_));
    must(world_.load_asset(pack.bytes(), &asset_));
    must(world_.asset_info(asset_, &info_));
    must(world_.create_instance({.asset = asset_}, &instance_));
    must(world_.set_budget_us(budget_us));
    positions_.resize(size_t{3} * info_.vertex_count);
  }
  const AssetInfo& info() const { return info_; }
  World& world() { return world_; }
  InstanceId instance() const { return instance_; }
  InstanceReport report() const {
    InstanceReport out;
    must(world_.report(instance_, &out));
    return out;
  }
  std::span<const float> read() {
    must(world_.read_positions(instance_, {.out = positions_.data(), .capacity = info_.vertex_count}));
    return positions_;
  }
  std::span<const float> step(const Pose& pose, float dt_s) {
    must(world_.set_pose(instance_, pose));
    world_.step(dt_s);
    return read();
  }

  // Without a pose.
  void skip(float dt_s) {
    must(world_.skip_pose(instance_));
    world_.step(dt_s);
  }

 private:
  World world_;
  AssetId asset_;
  InstanceId instance_;
  AssetInfo info_;
  std::vector<float> positions_;
};

}  // namespace sinew::perf
