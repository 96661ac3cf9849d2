// describe_asset.hpp  What an asset tells of itself, out of its pack. An index has been checked.
#pragma once
#include "character/asset/asset.hpp"

namespace sinew::world {

AssetInfo describe(const Asset& asset) noexcept;
AssetArrays arrays_of(const Asset& asset) noexcept;
MeshInfo describe_mesh(const pack::PackView& pack, uint32_t mesh) noexcept;
PrimitiveInfo describe_primitive(const pack::PackView& pack, uint32_t primitive) noexcept;
JointInfo describe_joint(const Asset& asset, uint32_t joint) noexcept;
RegionInfo describe_region(const pack::PackView& pack, uint32_t region) noexcept;
RodInfo describe_rod(const Asset& asset, uint32_t rod) noexcept;
ProxyInfo describe_proxy(const pack::PackView& pack, uint32_t proxy) noexcept;
ClipInfo describe_clip(const pack::PackView& pack, uint32_t clip) noexcept;

// As World::joint_path.
size_t write_joint_path(const pack::PackView& pack, uint32_t joint, std::span<char> out) noexcept;

// As World::sample_clip; time_s is finite.
void sample_clip(const pack::PackView& pack, uint32_t clip, double time_s, ClipEnd end,
                 Matrix34* out) noexcept;

}  // namespace sinew::world
