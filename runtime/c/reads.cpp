// reads.cpp  What is read back.
#include "c/convert.hpp"
#include "c/worlds.hpp"

using namespace sinew;
using namespace sinew::c;

namespace {

constexpr double kNoOrigin[3] = {0, 0, 0};

VertexStream to_stream(const sinew_vertex_stream& stream) noexcept {
  return {stream.out, stream.stride_bytes, static_cast<VertexFormat>(stream.format)};
}

ReadDef packed(sinew_space space, float* out, size_t capacity) noexcept {
  return {.space = static_cast<Space>(space), .out = out, .capacity = capacity};
}

}  // namespace

sinew_surface_def sinew_default_surface_def(void) {
  sinew_surface_def def = {};
  def.made_by = kMadeByDefault;
  return def;
}

sinew_status sinew_read_surface(sinew_world world, sinew_instance instance, const sinew_surface_def* def) {
  if (!def) return invalid("sinew_read_surface: def is a null pointer");
  if (def->made_by != kMadeByDefault) return not_made("sinew_default_surface_def");
  const SurfaceReadDef surface{.space = static_cast<Space>(def->space),
                               .origin_m = {def->origin_m[0], def->origin_m[1], def->origin_m[2]},
                               .moved_only = def->moved_only,
                               .capacity = def->capacity,
                               .positions = to_stream(def->positions),
                               .normals = to_stream(def->normals),
                               .tangents = to_stream(def->tangents)};
  return on(world, [&](World& w) { return w.read_surface(to_id(instance), surface); });
}

sinew_status sinew_read_positions(sinew_world world, sinew_instance instance, sinew_space space, float* out,
                                  size_t capacity) {
  return on(world, [&](World& w) { return w.read_positions(to_id(instance), packed(space, out, capacity)); });
}

sinew_status sinew_read_normals(sinew_world world, sinew_instance instance, sinew_space space, float* out,
                                size_t capacity) {
  return on(world, [&](World& w) { return w.read_normals(to_id(instance), packed(space, out, capacity)); });
}

sinew_status sinew_read_joint_matrices(sinew_world world, sinew_instance instance, sinew_matrix34* out,
                                       uint32_t joint_count) {
  if (!out) return invalid("sinew_read_joint_matrices: out is a null pointer");
  return on(world, [&](World& w) {
    return w.read_joint_matrices(to_id(instance), {as<Matrix34>(out), joint_count});
  });
}

sinew_status sinew_read_points(sinew_world world, sinew_instance instance, sinew_space space,
                               const double* origin_m, const sinew_surface_place* places, size_t count,
                               sinew_matrix34* out) {
  if (count > 0 && (!places || !out)) return invalid("sinew_read_points: places or out is a null pointer");
  const double* origin = origin_m ? origin_m : kNoOrigin;
  const PointsDef def{.space = static_cast<Space>(space), .origin_m = {origin[0], origin[1], origin[2]}};
  return on(world, [&](World& w) {
    return w.read_points(to_id(instance), def, {as<const SurfacePlace>(places), count},
                         {as<Matrix34>(out), count});
  });
}

sinew_status sinew_get_bounds(sinew_world world, sinew_instance instance, sinew_bounds* out) {
  Bounds bounds;
  const sinew_status status =
      on(world, [&](World& w) { return w.bounds(to_id(instance), out ? &bounds : nullptr); });
  if (status == SINEW_OK) *out = same<sinew_bounds>(bounds);
  return status;
}

size_t sinew_debug_lines(sinew_world world, sinew_instance instance, uint32_t parts, const double* origin_m,
                         sinew_debug_line* out, size_t capacity) {
  const HeldWorld* held = c::find(world);
  if (!held) return 0;
  const double* from = origin_m ? origin_m : kNoOrigin;
  const double origin[3] = {from[0], from[1], from[2]};
  return held->world.debug_lines(to_id(instance), parts, origin, {as<DebugLine>(out), out ? capacity : 0});
}
