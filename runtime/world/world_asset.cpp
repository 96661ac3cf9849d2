// world_asset.cpp  The public API of what assets tell: ids and arguments are checked here.
#include <cmath>

#include "character/motion/pose.hpp"
#include "core/floating_point.hpp"
#include "world/describe_asset.hpp"
#include "world/world_impl.hpp"

namespace sinew {
namespace {

using core::make_status;
using world::Asset;
using world::find_asset;
using world::invalid;

// One of so many of the asset's.
Status check_index(const char* what, uint32_t index, size_t count) noexcept {
  if (index < count) return {};
  return make_status(StatusCode::kInvalidArgument, "%s %u is not there, the asset has %zu", what, index,
                     count);
}

Status check_room(const char* what, size_t room, size_t joints) noexcept {
  if (room == joints) return {};
  return make_status(StatusCode::kInvalidArgument, "%s: out has room for %zu joints, the asset has %zu", what,
                     room, joints);
}

// Finds the asset, sees that there is a place for the answer and that the index is one, and answers.
template <class Info, class Count, class Describe>
Status tell(const world::WorldState* state, AssetId id, const char* what, uint32_t index, Info* out,
            Count count, Describe describe) noexcept {
  Asset* asset = nullptr;
  if (Status status = find_asset(state, id, &asset); !status.ok()) return status;
  if (!out) return make_status(StatusCode::kInvalidArgument, "%s: out is a null pointer", what);
  if (Status status = check_index(what, index, count(asset->pack)); !status.ok()) return status;
  *out = describe(*asset);
  return {};
}

}  // namespace

Status World::asset_info(AssetId id, AssetInfo* out) const noexcept {
  Asset* asset = nullptr;
  if (Status status = find_asset(impl_, id, &asset); !status.ok()) return status;
  if (!out) return invalid("asset_info: out is a null pointer");
  *out = world::describe(*asset);
  return {};
}

Status World::asset_arrays(AssetId id, AssetArrays* out) const noexcept {
  Asset* asset = nullptr;
  if (Status status = find_asset(impl_, id, &asset); !status.ok()) return status;
  if (!out) return invalid("asset_arrays: out is a null pointer");
  *out = world::arrays_of(*asset);
  return {};
}

Status World::mesh_info(AssetId id, uint32_t mesh, MeshInfo* out) const noexcept {
  return tell(
      impl_, id, "mesh_info: mesh", mesh, out, [](const pack::PackView& pack) { return pack.meshes.size(); },
      [&](const Asset& asset) { return world::describe_mesh(asset.pack, mesh); });
}

Status World::primitive_info(AssetId id, uint32_t primitive, PrimitiveInfo* out) const noexcept {
  return tell(
      impl_, id, "primitive_info: primitive", primitive, out,
      [](const pack::PackView& pack) { return pack.primitives.size(); },
      [&](const Asset& asset) { return world::describe_primitive(asset.pack, primitive); });
}

Status World::joint_info(AssetId id, uint32_t joint, JointInfo* out) const noexcept {
  return tell(
      impl_, id, "joint_info: joint", joint, out,
      [](const pack::PackView& pack) { return pack.joints.size(); },
      [&](const Asset& asset) { return world::describe_joint(asset, joint); });
}

Status World::region_info(AssetId id, uint32_t region, RegionInfo* out) const noexcept {
  return tell(
      impl_, id, "region_info: region", region, out,
      [](const pack::PackView& pack) { return pack.regions.size(); },
      [&](const Asset& asset) { return world::describe_region(asset.pack, region); });
}

Status World::rod_info(AssetId id, uint32_t rod, RodInfo* out) const noexcept {
  return tell(
      impl_, id, "rod_info: rod", rod, out, [](const pack::PackView& pack) { return pack.rods.size(); },
      [&](const Asset& asset) { return world::describe_rod(asset, rod); });
}

Status World::proxy_info(AssetId id, uint32_t proxy, ProxyInfo* out) const noexcept {
  return tell(
      impl_, id, "proxy_info: body collider", proxy, out,
      [](const pack::PackView& pack) { return pack.proxies.size(); },
      [&](const Asset& asset) { return world::describe_proxy(asset.pack, proxy); });
}

Status World::clip_info(AssetId id, uint32_t clip, ClipInfo* out) const noexcept {
  return tell(
      impl_, id, "clip_info: clip", clip, out, [](const pack::PackView& pack) { return pack.clips.size(); },
      [&](const Asset& asset) { return world::describe_clip(asset.pack, clip); });
}

const char* World::joint_name(AssetId id, uint32_t joint) const noexcept {
  Asset* asset = nullptr;
  if (!find_asset(impl_, id, &asset).ok() || joint >= asset->pack.joints.size()) return nullptr;
  return pack::string_at(asset->pack, asset->pack.joints[joint].name);
}

size_t World::joint_path(AssetId id, uint32_t joint, std::span<char> out) const noexcept {
  Asset* asset = nullptr;
  if (!find_asset(impl_, id, &asset).ok() || joint >= asset->pack.joints.size()) return 0;
  return world::write_joint_path(asset->pack, joint, out);
}

bool World::joint_is_on_rod(AssetId id, uint32_t joint) const noexcept {
  Asset* asset = nullptr;
  return find_asset(impl_, id, &asset).ok() && joint < asset->pack.joint_rods.size() &&
         asset->pack.joint_rods[joint] != pack::kNoIndex;
}

Status World::bind_pose(AssetId id, std::span<Matrix34> out) const noexcept {
  const core::FloatingPointScope mode;
  Asset* asset = nullptr;
  if (Status status = find_asset(impl_, id, &asset); !status.ok()) return status;
  if (Status status = check_room("bind_pose", out.size(), asset->pack.joints.size()); !status.ok())
    return status;
  world::bind_pose(asset->pack.joints, out.data());
  return {};
}

Status World::sample_clip(AssetId id, uint32_t clip, double time_s, ClipEnd end,
                          std::span<Matrix34> out) const noexcept {
  const core::FloatingPointScope mode;
  Asset* asset = nullptr;
  if (Status status = find_asset(impl_, id, &asset); !status.ok()) return status;
  if (Status status = check_index("sample_clip: clip", clip, asset->pack.clips.size()); !status.ok())
    return status;
  if (end != ClipEnd::kHold && end != ClipEnd::kLoop)
    return invalid("sample_clip: end is neither kHold nor kLoop");
  if (!std::isfinite(time_s))
    return make_status(StatusCode::kNotFinite, "sample_clip: time_s is NaN or infinite");
  if (Status status = check_room("sample_clip", out.size(), asset->pack.joints.size()); !status.ok())
    return status;
  world::sample_clip(asset->pack, clip, time_s, end, out.data());
  return {};
}

}  // namespace sinew
