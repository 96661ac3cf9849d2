// world_read.cpp  The public API of what is read back: ids and arguments are checked here.
#include <algorithm>
#include <cmath>

#include "character/describe_instance.hpp"
#include "character/output/debug_lines.hpp"
#include "character/output/read.hpp"
#include "character/output/read_points.hpp"
#include "character/rods/rod_publish.hpp"
#include "core/floating_point.hpp"
#include "world/world_impl.hpp"

namespace sinew {
namespace {

using core::make_status;
using world::find_instance;
using world::Instance;
using world::invalid;

SurfaceReadDef as_surface(const ReadDef& def, VertexStream SurfaceReadDef::*stream) noexcept {
  SurfaceReadDef surface{.space = def.space, .capacity = def.capacity};
  std::copy_n(def.origin_m, 3, surface.origin_m);
  surface.*stream = {.out = def.out, .stride_bytes = def.stride_bytes};
  return surface;
}

Status check_alone(const ReadDef& def) noexcept {
  if (!def.out) return invalid("read: out is a null pointer");
  if (def.stride_bytes == 0)
    return invalid("read: stride_bytes is 0; it must be a multiple of 4, at least 12");
  return {};
}

}  // namespace

size_t World::history(std::span<FrameReport> out) const noexcept {
  if (!impl_) return 0;
  const uint64_t kept = std::min<uint64_t>(impl_->frames, impl_->def.report_history);
  const auto count = std::min<size_t>(kept, out.size());
  for (size_t back = 0; back < count; ++back)
    out[back] = impl_->history[(impl_->frames - 1 - back) % impl_->def.report_history];
  return count;
}

Status World::read_surface(InstanceId id, const SurfaceReadDef& def) const noexcept {
  const core::FloatingPointScope mode;
  Instance* instance = nullptr;
  if (Status status = find_instance(impl_, id, &instance); !status.ok()) return status;
  if (Status status = world::check_read(def, *instance->asset); !status.ok()) return status;
  world::read_surface(*instance, def);
  return {};
}

Status World::read_positions(InstanceId id, const ReadDef& def) const noexcept {
  Instance* instance = nullptr;
  Status status = find_instance(impl_, id, &instance);
  if (status.ok()) status = check_alone(def);
  return status.ok() ? read_surface(id, as_surface(def, &SurfaceReadDef::positions)) : status;
}

Status World::read_normals(InstanceId id, const ReadDef& def) const noexcept {
  Instance* instance = nullptr;
  Status status = find_instance(impl_, id, &instance);
  if (status.ok()) status = check_alone(def);
  return status.ok() ? read_surface(id, as_surface(def, &SurfaceReadDef::normals)) : status;
}

Status World::read_points(InstanceId id, const PointsDef& def, std::span<const SurfacePlace> places,
                          std::span<Matrix34> out) const noexcept {
  const core::FloatingPointScope mode;
  Instance* instance = nullptr;
  if (Status status = find_instance(impl_, id, &instance); !status.ok()) return status;
  if (places.size() != out.size())
    return make_status(StatusCode::kInvalidArgument, "read_points: %zu points, but room for %zu",
                       places.size(), out.size());
  if (Status status = world::check_points(def, places, *instance->asset); !status.ok()) return status;
  world::read_points(*instance, def, places, out.data());
  return {};
}

Status World::bounds(InstanceId id, Bounds* out) const noexcept {
  Instance* instance = nullptr;
  if (Status status = find_instance(impl_, id, &instance); !status.ok()) return status;
  if (!out) return invalid("bounds: out is a null pointer");
  std::copy_n(instance->bound.middle_m, 3, out->center_m);
  out->radius_m = instance->bound.radius_m;
  return {};
}

size_t World::debug_lines(InstanceId id, uint32_t parts, const double (&origin_m)[3],
                          std::span<DebugLine> out) const noexcept {
  const core::FloatingPointScope mode;
  Instance* instance = nullptr;
  if (!find_instance(impl_, id, &instance).ok()) return 0;
  return world::draw_lines(*instance, parts, origin_m, out);
}

size_t World::take_events(std::span<Event> out) noexcept {
  if (!impl_ || world::busy(*impl_)) return 0;
  return world::take_events(impl_->events, out);
}

uint64_t World::events_lost() const noexcept { return impl_ ? impl_->events.lost : 0; }

Status World::read_joint_matrices(InstanceId id, std::span<Matrix34> out) const noexcept {
  const core::FloatingPointScope mode;
  Instance* instance = nullptr;
  if (Status status = find_instance(impl_, id, &instance); !status.ok()) return status;
  const uint32_t joints = instance->asset->pack.character->joint_count;
  if (out.size() != joints) {
    return make_status(StatusCode::kInvalidArgument,
                       "read_joint_matrices: out has room for %zu joints, the asset has %u", out.size(),
                       joints);
  }
  std::copy_n(world::shown_joints(*instance), joints, out.data());
  return {};
}

Status World::report(InstanceId id, InstanceReport* out) const noexcept {
  const core::FloatingPointScope mode;
  Instance* instance = nullptr;
  if (Status status = find_instance(impl_, id, &instance); !status.ok()) return status;
  if (!out) return invalid("report: out is a null pointer");
  *out = world::describe(*instance, id);
  return {};
}

}  // namespace sinew
