// crowd.cpp  see crowd.hpp.
#include "perf/scale/crowd.hpp"

#include "perf/scale/require.hpp"

namespace sinew::perf {
namespace {

constexpr double kStagger_s = 0.37;

}  // namespace

Crowd::Crowd(const demo::CharacterFile& character, unsigned instances, const std::string& clip,
             const TaskHook& tasks, float sleep_tolerance)
    : motion_(demo::make_motion(character, clip)), instances_(instances) {
  require(World::create(
      {.max_assets = 1, .max_instances = instances, .sleep_tolerance = sleep_tolerance, .tasks = tasks},
      &world_));
  AssetId asset;
  require(world_.load_asset(character.file.bytes(), &asset));
  require(world_.asset_info(asset, &info_));
  for (InstanceId& instance : instances_) require(world_.create_instance({.asset = asset}, &instance));
  joints_.resize(info_.joint_count);
  surface_.resize(size_t{3} * info_.vertex_count);
}

void Crowd::pose() {
  const double time_s = frame_++ / 60.0;
  for (size_t i = 0; i < instances_.size(); ++i) {
    RootTransform root;
    motion_->pose_at(time_s + kStagger_s * static_cast<double>(i), joints_, &root);
    require(world_.set_pose(instances_[i], {.joints = joints_, .root = root}));
  }
}

void Crowd::read(unsigned instance, Space space) {
  require(world_.read_positions(instances_[instance],
                                {.space = space, .out = surface_.data(), .capacity = info_.vertex_count}));
}

void Crowd::read_normals(unsigned instance) {
  require(
      world_.read_normals(instances_[instance], {.out = surface_.data(), .capacity = info_.vertex_count}));
}

}  // namespace sinew::perf
