// assets.cpp  Assets: loaded, described.
#include "c/convert.hpp"
#include "c/worlds.hpp"

using namespace sinew;
using namespace sinew::c;

namespace {

// Asks the world for one, and hands it over as it is.
template <class Cpp, class C, class Ask>
sinew_status ask(sinew_world world, C* out, Ask ask_for) noexcept {
  Cpp info;
  const sinew_status status = on(world, [&](World& w) { return ask_for(w, out ? &info : nullptr); });
  if (status == SINEW_OK) *out = same<C>(info);
  return status;
}

template <class Load>
sinew_status load(sinew_world world, sinew_asset* out, Load load_it) noexcept {
  if (!out) return invalid("sinew_load_asset: out is a null pointer");
  AssetId id;
  const sinew_status status = on(world, [&](World& w) { return load_it(w, &id); });
  if (status == SINEW_OK) *out = {id.index1, id.generation};
  return status;
}

}  // namespace

sinew_status sinew_load_asset(sinew_world world, const void* bytes, size_t byte_count, sinew_asset* out) {
  if (!bytes) return invalid("sinew_load_asset: bytes is a null pointer");
  return load(world, out, [&](World& w, AssetId* id) {
    return w.load_asset({static_cast<const std::byte*>(bytes), byte_count}, id);
  });
}

sinew_status sinew_load_asset_file(sinew_world world, const char* path, sinew_asset* out) {
  return load(world, out, [&](World& w, AssetId* id) { return w.load_asset_file(path, id); });
}

sinew_status sinew_unload_asset(sinew_world world, sinew_asset asset) {
  return on(world, [&](World& w) { return w.unload_asset(to_id(asset)); });
}

sinew_status sinew_replace_asset(sinew_world world, sinew_asset asset, sinew_asset by) {
  return on(world, [&](World& w) { return w.replace_asset(to_id(asset), to_id(by)); });
}

sinew_status sinew_get_asset_info(sinew_world world, sinew_asset asset, sinew_asset_info* out) {
  return ask<AssetInfo>(world, out,
                        [&](World& w, AssetInfo* info) { return w.asset_info(to_id(asset), info); });
}

sinew_status sinew_get_asset_arrays(sinew_world world, sinew_asset asset, sinew_asset_arrays* out) {
  AssetArrays arrays;
  const sinew_status status =
      on(world, [&](World& w) { return w.asset_arrays(to_id(asset), out ? &arrays : nullptr); });
  if (status == SINEW_OK)
    *out = {arrays.positions_m.data(),
            arrays.normals.data(),
            arrays.tangents.empty() ? nullptr : arrays.tangents.data(),
            arrays.triangles.data(),
            arrays.moved_vertices.data(),
            arrays.skin_joints,
            arrays.skin_weights,
            arrays.skin_stride_bytes};
  return status;
}

sinew_status sinew_get_mesh_info(sinew_world world, sinew_asset asset, uint32_t mesh, sinew_mesh_info* out) {
  return ask<MeshInfo>(world, out,
                       [&](World& w, MeshInfo* info) { return w.mesh_info(to_id(asset), mesh, info); });
}

sinew_status sinew_get_primitive_info(sinew_world world, sinew_asset asset, uint32_t primitive,
                                      sinew_primitive_info* out) {
  return ask<PrimitiveInfo>(world, out, [&](World& w, PrimitiveInfo* info) {
    return w.primitive_info(to_id(asset), primitive, info);
  });
}

sinew_status sinew_get_joint_info(sinew_world world, sinew_asset asset, uint32_t joint,
                                  sinew_joint_info* out) {
  return ask<JointInfo>(world, out,
                        [&](World& w, JointInfo* info) { return w.joint_info(to_id(asset), joint, info); });
}

sinew_status sinew_get_region_info(sinew_world world, sinew_asset asset, uint32_t region,
                                   sinew_region_info* out) {
  RegionInfo info;
  const sinew_status status =
      on(world, [&](World& w) { return w.region_info(to_id(asset), region, out ? &info : nullptr); });
  if (status == SINEW_OK)
    *out = {info.name,
            info.vertices.data(),
            static_cast<uint32_t>(info.vertices.size()),
            info.node_count,
            {info.center_m[0], info.center_m[1], info.center_m[2]},
            info.radius_m,
            info.displacement_limit_m,
            info.frequency_hz,
            info.damping_ratio};
  return status;
}

sinew_status sinew_get_rod_info(sinew_world world, sinew_asset asset, uint32_t rod, sinew_rod_info* out) {
  return ask<RodInfo>(world, out,
                      [&](World& w, RodInfo* info) { return w.rod_info(to_id(asset), rod, info); });
}

sinew_status sinew_get_proxy_info(sinew_world world, sinew_asset asset, uint32_t proxy,
                                  sinew_proxy_info* out) {
  return ask<ProxyInfo>(world, out,
                        [&](World& w, ProxyInfo* info) { return w.proxy_info(to_id(asset), proxy, info); });
}

sinew_status sinew_get_clip_info(sinew_world world, sinew_asset asset, uint32_t clip, sinew_clip_info* out) {
  return ask<ClipInfo>(world, out,
                       [&](World& w, ClipInfo* info) { return w.clip_info(to_id(asset), clip, info); });
}

const char* sinew_joint_name(sinew_world world, sinew_asset asset, uint32_t joint) {
  const HeldWorld* held = c::find(world);
  return held ? held->world.joint_name(to_id(asset), joint) : nullptr;
}

size_t sinew_joint_path(sinew_world world, sinew_asset asset, uint32_t joint, char* out, size_t capacity) {
  const HeldWorld* held = c::find(world);
  return held ? held->world.joint_path(to_id(asset), joint, {out, out ? capacity : 0}) : 0;
}

bool sinew_joint_is_on_rod(sinew_world world, sinew_asset asset, uint32_t joint) {
  const HeldWorld* held = c::find(world);
  return held && held->world.joint_is_on_rod(to_id(asset), joint);
}

sinew_status sinew_bind_pose(sinew_world world, sinew_asset asset, sinew_matrix34* out,
                             uint32_t joint_count) {
  if (!out) return invalid("sinew_bind_pose: out is a null pointer");
  return on(world, [&](World& w) { return w.bind_pose(to_id(asset), {as<Matrix34>(out), joint_count}); });
}

sinew_status sinew_sample_clip(sinew_world world, sinew_asset asset, uint32_t clip, double time_s,
                               sinew_clip_end end, sinew_matrix34* out, uint32_t joint_count) {
  if (!out) return invalid("sinew_sample_clip: out is a null pointer");
  return on(world, [&](World& w) {
    return w.sample_clip(to_id(asset), clip, time_s, static_cast<ClipEnd>(end),
                         {as<Matrix34>(out), joint_count});
  });
}
