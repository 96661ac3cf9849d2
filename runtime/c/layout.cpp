// layout.cpp  Structs that cross the C interface as they are: field by field alike in both headers.
#include <cstddef>

#include "sinew/contact_source.hpp"
#include "sinew/sinew.h"
#include "sinew/types.hpp"

namespace sinew {
namespace {

#define SAME_SIZE(c, cpp) static_assert(sizeof(c) == sizeof(cpp) && alignof(c) == alignof(cpp))
#define SAME_PLACE(c, cpp, field) \
  static_assert(offsetof(c, field) == offsetof(cpp, field) && sizeof(c::field) == sizeof(cpp::field))

SAME_SIZE(sinew_matrix34, Matrix34);
SAME_PLACE(sinew_matrix34, Matrix34, m);

SAME_SIZE(sinew_root, RootTransform);
SAME_PLACE(sinew_root, RootTransform, position_m);
SAME_PLACE(sinew_root, RootTransform, rotation_xyzw);
SAME_PLACE(sinew_root, RootTransform, scale);

SAME_SIZE(sinew_contact_probe, ContactProbe);
SAME_PLACE(sinew_contact_probe, ContactProbe, start_m);
SAME_PLACE(sinew_contact_probe, ContactProbe, end_m);
SAME_PLACE(sinew_contact_probe, ContactProbe, radius_m);
SAME_PLACE(sinew_contact_probe, ContactProbe, owner);

SAME_SIZE(sinew_contact_hit, ContactHit);
SAME_PLACE(sinew_contact_hit, ContactHit, probe);
SAME_PLACE(sinew_contact_hit, ContactHit, along);
SAME_PLACE(sinew_contact_hit, ContactHit, gap_m);
SAME_PLACE(sinew_contact_hit, ContactHit, normal);
SAME_PLACE(sinew_contact_hit, ContactHit, velocity_m_s);
SAME_PLACE(sinew_contact_hit, ContactHit, friction);
SAME_PLACE(sinew_contact_hit, ContactHit, restitution);
SAME_PLACE(sinew_contact_hit, ContactHit, name);
SAME_PLACE(sinew_contact_hit, ContactHit, body);

SAME_SIZE(sinew_frame_report, FrameReport);
SAME_PLACE(sinew_frame_report, FrameReport, frame);
SAME_PLACE(sinew_frame_report, FrameReport, ticks);
SAME_PLACE(sinew_frame_report, FrameReport, dropped_s);
SAME_PLACE(sinew_frame_report, FrameReport, budget_us);
SAME_PLACE(sinew_frame_report, FrameReport, total_us);
SAME_PLACE(sinew_frame_report, FrameReport, schedule_us);
SAME_PLACE(sinew_frame_report, FrameReport, drive_us);
SAME_PLACE(sinew_frame_report, FrameReport, tissue_us);
SAME_PLACE(sinew_frame_report, FrameReport, rods_us);
SAME_PLACE(sinew_frame_report, FrameReport, publish_us);
SAME_PLACE(sinew_frame_report, FrameReport, instances_network);
SAME_PLACE(sinew_frame_report, FrameReport, instances_modal);
SAME_PLACE(sinew_frame_report, FrameReport, instances_extrapolated);
SAME_PLACE(sinew_frame_report, FrameReport, instances_skinned);
SAME_PLACE(sinew_frame_report, FrameReport, instances_hidden);
SAME_PLACE(sinew_frame_report, FrameReport, instances_dormant);
SAME_PLACE(sinew_frame_report, FrameReport, instances_cut);
SAME_PLACE(sinew_frame_report, FrameReport, restarts);
SAME_PLACE(sinew_frame_report, FrameReport, fallbacks);
SAME_PLACE(sinew_frame_report, FrameReport, regions_asleep);
SAME_PLACE(sinew_frame_report, FrameReport, rejected_poses);
SAME_PLACE(sinew_frame_report, FrameReport, unspent_us);
SAME_PLACE(sinew_frame_report, FrameReport, expected_error);
SAME_PLACE(sinew_frame_report, FrameReport, over_budget);

SAME_SIZE(sinew_instance_report, InstanceReport);
SAME_PLACE(sinew_instance_report, InstanceReport, instance);
SAME_PLACE(sinew_instance_report, InstanceReport, tier);
SAME_PLACE(sinew_instance_report, InstanceReport, why);
SAME_PLACE(sinew_instance_report, InstanceReport, error);
SAME_PLACE(sinew_instance_report, InstanceReport, graph_level);
SAME_PLACE(sinew_instance_report, InstanceReport, blend);
SAME_PLACE(sinew_instance_report, InstanceReport, ticks_since_network);
SAME_PLACE(sinew_instance_report, InstanceReport, input_clamps);
SAME_PLACE(sinew_instance_report, InstanceReport, displacement_clamps);
SAME_PLACE(sinew_instance_report, InstanceReport, fallbacks);
SAME_PLACE(sinew_instance_report, InstanceReport, restarts);
SAME_PLACE(sinew_instance_report, InstanceReport, regions_asleep);
SAME_PLACE(sinew_instance_report, InstanceReport, regions_left_out);
SAME_PLACE(sinew_instance_report, InstanceReport, teleports);
SAME_PLACE(sinew_instance_report, InstanceReport, part_teleports);
SAME_PLACE(sinew_instance_report, InstanceReport, rod_recoveries);
SAME_PLACE(sinew_instance_report, InstanceReport, rods_asleep);
SAME_PLACE(sinew_instance_report, InstanceReport, rod_iterations);
SAME_PLACE(sinew_instance_report, InstanceReport, rod_residual);
SAME_PLACE(sinew_instance_report, InstanceReport, rod_contacts);
SAME_PLACE(sinew_instance_report, InstanceReport, rods_touch_surface);
SAME_PLACE(sinew_instance_report, InstanceReport, vertices_touched);
SAME_PLACE(sinew_instance_report, InstanceReport, contacts_refused);
SAME_PLACE(sinew_instance_report, InstanceReport, contacts_dropped);
SAME_PLACE(sinew_instance_report, InstanceReport, contact_volume_m3);
SAME_PLACE(sinew_instance_report, InstanceReport, deepest_penetration_m);
SAME_PLACE(sinew_instance_report, InstanceReport, cost_us);
SAME_PLACE(sinew_instance_report, InstanceReport, planned_us);
SAME_PLACE(sinew_instance_report, InstanceReport, hidden);
SAME_PLACE(sinew_instance_report, InstanceReport, dormant);

SAME_SIZE(sinew_event, Event);
SAME_PLACE(sinew_event, Event, kind);
SAME_PLACE(sinew_event, Event, instance);
SAME_PLACE(sinew_event, Event, frame);

SAME_SIZE(sinew_asset_info, AssetInfo);
SAME_PLACE(sinew_asset_info, AssetInfo, vertex_count);
SAME_PLACE(sinew_asset_info, AssetInfo, triangle_count);
SAME_PLACE(sinew_asset_info, AssetInfo, joint_count);
SAME_PLACE(sinew_asset_info, AssetInfo, region_count);
SAME_PLACE(sinew_asset_info, AssetInfo, node_count);
SAME_PLACE(sinew_asset_info, AssetInfo, clip_count);
SAME_PLACE(sinew_asset_info, AssetInfo, mesh_count);
SAME_PLACE(sinew_asset_info, AssetInfo, primitive_count);
SAME_PLACE(sinew_asset_info, AssetInfo, moved_vertex_count);
SAME_PLACE(sinew_asset_info, AssetInfo, proxy_count);
SAME_PLACE(sinew_asset_info, AssetInfo, rod_count);
SAME_PLACE(sinew_asset_info, AssetInfo, rod_network);
SAME_PLACE(sinew_asset_info, AssetInfo, graph_levels);
SAME_PLACE(sinew_asset_info, AssetInfo, tick_hz);
SAME_PLACE(sinew_asset_info, AssetInfo, height_m);
SAME_PLACE(sinew_asset_info, AssetInfo, unit_m);
SAME_PLACE(sinew_asset_info, AssetInfo, instance_bytes);

SAME_SIZE(sinew_mesh_info, MeshInfo);
SAME_PLACE(sinew_mesh_info, MeshInfo, name);
SAME_PLACE(sinew_mesh_info, MeshInfo, first_vertex);
SAME_PLACE(sinew_mesh_info, MeshInfo, vertex_count);
SAME_PLACE(sinew_mesh_info, MeshInfo, first_primitive);
SAME_PLACE(sinew_mesh_info, MeshInfo, primitive_count);
SAME_PLACE(sinew_mesh_info, MeshInfo, mesh_from_bind);

SAME_SIZE(sinew_primitive_info, PrimitiveInfo);
SAME_PLACE(sinew_primitive_info, PrimitiveInfo, mesh);
SAME_PLACE(sinew_primitive_info, PrimitiveInfo, index);
SAME_PLACE(sinew_primitive_info, PrimitiveInfo, material);
SAME_PLACE(sinew_primitive_info, PrimitiveInfo, first_vertex);
SAME_PLACE(sinew_primitive_info, PrimitiveInfo, vertex_count);
SAME_PLACE(sinew_primitive_info, PrimitiveInfo, first_triangle);
SAME_PLACE(sinew_primitive_info, PrimitiveInfo, triangle_count);

SAME_SIZE(sinew_joint_info, JointInfo);
SAME_PLACE(sinew_joint_info, JointInfo, name);
SAME_PLACE(sinew_joint_info, JointInfo, parent);
SAME_PLACE(sinew_joint_info, JointInfo, rod);
SAME_PLACE(sinew_joint_info, JointInfo, inverse_bind);

SAME_SIZE(sinew_rod_info, RodInfo);
SAME_PLACE(sinew_rod_info, RodInfo, name);
SAME_PLACE(sinew_rod_info, RodInfo, attach_joint);
SAME_PLACE(sinew_rod_info, RodInfo, end_joint);
SAME_PLACE(sinew_rod_info, RodInfo, segment_count);
SAME_PLACE(sinew_rod_info, RodInfo, length_m);
SAME_PLACE(sinew_rod_info, RodInfo, frequency_hz);
SAME_PLACE(sinew_rod_info, RodInfo, gravity);
SAME_PLACE(sinew_rod_info, RodInfo, turn_limit_rad);
SAME_PLACE(sinew_rod_info, RodInfo, damping_ratio);

SAME_SIZE(sinew_proxy_info, ProxyInfo);
SAME_PLACE(sinew_proxy_info, ProxyInfo, joint);
SAME_PLACE(sinew_proxy_info, ProxyInfo, from_m);
SAME_PLACE(sinew_proxy_info, ProxyInfo, to_m);
SAME_PLACE(sinew_proxy_info, ProxyInfo, radius_m);

SAME_SIZE(sinew_clip_info, ClipInfo);
SAME_PLACE(sinew_clip_info, ClipInfo, name);
SAME_PLACE(sinew_clip_info, ClipInfo, duration_s);
SAME_PLACE(sinew_clip_info, ClipInfo, frame_count);
SAME_PLACE(sinew_clip_info, ClipInfo, rate_hz);

SAME_SIZE(sinew_surface_place, SurfacePlace);
SAME_PLACE(sinew_surface_place, SurfacePlace, triangle);
SAME_PLACE(sinew_surface_place, SurfacePlace, weights);

SAME_SIZE(sinew_bounds, Bounds);
SAME_PLACE(sinew_bounds, Bounds, center_m);
SAME_PLACE(sinew_bounds, Bounds, radius_m);

SAME_SIZE(sinew_debug_line, DebugLine);
SAME_PLACE(sinew_debug_line, DebugLine, from_m);
SAME_PLACE(sinew_debug_line, DebugLine, to_m);
SAME_PLACE(sinew_debug_line, DebugLine, rgba);

SAME_SIZE(sinew_added_environment, AddedEnvironment);
SAME_PLACE(sinew_added_environment, AddedEnvironment, acceleration_m_s2);
SAME_PLACE(sinew_added_environment, AddedEnvironment, wind_m_s);

#define SAME_VALUE(c, cpp) static_assert(static_cast<uint32_t>(cpp) == c)

SAME_VALUE(SINEW_OK, StatusCode::kOk);
SAME_VALUE(SINEW_INVALID_ARGUMENT, StatusCode::kInvalidArgument);
SAME_VALUE(SINEW_UNREADABLE, StatusCode::kUnreadable);
SAME_VALUE(SINEW_NOT_A_PACK, StatusCode::kNotAPack);
SAME_VALUE(SINEW_WRONG_VERSION, StatusCode::kWrongVersion);
SAME_VALUE(SINEW_TRUNCATED, StatusCode::kTruncated);
SAME_VALUE(SINEW_CORRUPT, StatusCode::kCorrupt);
SAME_VALUE(SINEW_UNSUPPORTED, StatusCode::kUnsupported);
SAME_VALUE(SINEW_OUT_OF_CAPACITY, StatusCode::kOutOfCapacity);
SAME_VALUE(SINEW_STALE_ID, StatusCode::kStaleId);
SAME_VALUE(SINEW_NOT_FINITE, StatusCode::kNotFinite);

SAME_VALUE(SINEW_BUDGET_TIME, BudgetMode::kTime);
SAME_VALUE(SINEW_BUDGET_WORK_UNITS, BudgetMode::kWorkUnits);

SAME_VALUE(SINEW_CLIP_HOLD, ClipEnd::kHold);
SAME_VALUE(SINEW_CLIP_LOOP, ClipEnd::kLoop);

SAME_VALUE(SINEW_ROD_START_AS_BAKED, RodWarmStart::kAsBaked);
SAME_VALUE(SINEW_ROD_START_CONTINUED, RodWarmStart::kContinued);
SAME_VALUE(SINEW_ROD_START_LEARNED, RodWarmStart::kLearned);

SAME_VALUE(SINEW_TIER_SKINNING, Tier::kSkinning);
SAME_VALUE(SINEW_TIER_EXTRAPOLATE, Tier::kExtrapolate);
SAME_VALUE(SINEW_TIER_NETWORK, Tier::kNetwork);
SAME_VALUE(SINEW_TIER_MODAL, Tier::kModal);

SAME_VALUE(SINEW_REASON_BEST, TierReason::kBest);
SAME_VALUE(SINEW_REASON_BUDGET, TierReason::kBudget);
SAME_VALUE(SINEW_REASON_HELD, TierReason::kHeld);
SAME_VALUE(SINEW_REASON_TURN, TierReason::kTurn);
SAME_VALUE(SINEW_REASON_WAITING, TierReason::kWaiting);
SAME_VALUE(SINEW_REASON_CUT, TierReason::kCut);
SAME_VALUE(SINEW_REASON_HIDDEN, TierReason::kHidden);
SAME_VALUE(SINEW_REASON_GUARD, TierReason::kGuard);
SAME_VALUE(SINEW_REASON_STILL, TierReason::kStill);

SAME_VALUE(SINEW_EVENT_TELEPORT, EventKind::kTeleport);
SAME_VALUE(SINEW_EVENT_PART_TELEPORT, EventKind::kPartTeleport);
SAME_VALUE(SINEW_EVENT_NETWORK_GIVEN_UP, EventKind::kNetworkGivenUp);
SAME_VALUE(SINEW_EVENT_RESTART, EventKind::kRestart);
SAME_VALUE(SINEW_EVENT_ROD_RECOVERY, EventKind::kRodRecovery);

SAME_VALUE(SINEW_SPACE_CHARACTER, Space::kCharacter);
SAME_VALUE(SINEW_SPACE_WORLD, Space::kWorld);
SAME_VALUE(SINEW_SPACE_BIND, Space::kBind);

SAME_VALUE(SINEW_FLOAT3, VertexFormat::kFloat3);
SAME_VALUE(SINEW_FLOAT4, VertexFormat::kFloat4);
SAME_VALUE(SINEW_HALF4, VertexFormat::kHalf4);

SAME_VALUE(SINEW_DEBUG_NODES, kDebugNodes);
SAME_VALUE(SINEW_DEBUG_RODS, kDebugRods);
SAME_VALUE(SINEW_DEBUG_PROXIES, kDebugProxies);
SAME_VALUE(SINEW_DEBUG_TOUCHES, kDebugTouches);
SAME_VALUE(SINEW_DEBUG_BOUNDS, kDebugBounds);
SAME_VALUE(SINEW_DEBUG_ALL, kDebugAll);
SAME_VALUE(SINEW_NONE, kNone);

}  // namespace
}  // namespace sinew
