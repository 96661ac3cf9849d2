// parameters.cpp  How parts swing, and what moves them beside their pose.
#include "c/convert.hpp"
#include "c/worlds.hpp"

using namespace sinew;
using namespace sinew::c;

namespace {

sinew_part_parameters from_parameters(const PartParameters& from) noexcept {
  return {kMadeByDefault, from.intensity, from.stiffness, from.damping, from.displacement, from.enabled};
}

sinew_environment from_environment(const Environment& from) noexcept {
  sinew_environment out = {};
  out.made_by = kMadeByDefault;
  std::copy_n(from.gravity_m_s2, 3, out.gravity_m_s2);
  std::copy_n(from.acceleration_m_s2, 3, out.acceleration_m_s2);
  std::copy_n(from.wind.velocity_m_s, 3, out.wind_m_s);
  out.gust = from.wind.gust;
  out.gust_hz = from.wind.gust_hz;
  return out;
}

Environment to_environment(const sinew_environment& from) noexcept {
  Environment out;
  std::copy_n(from.gravity_m_s2, 3, out.gravity_m_s2);
  std::copy_n(from.acceleration_m_s2, 3, out.acceleration_m_s2);
  std::copy_n(from.wind_m_s, 3, out.wind.velocity_m_s);
  out.wind.gust = from.gust;
  out.wind.gust_hz = from.gust_hz;
  return out;
}

template <class Set>
sinew_status set(sinew_world world, const sinew_part_parameters* from, Set set_them) noexcept {
  if (!from) return invalid("sinew_set_parameters: the parameters are a null pointer");
  if (from->made_by != kMadeByDefault) return not_made("sinew_default_part_parameters");
  const PartParameters given{from->intensity, from->stiffness, from->damping, from->displacement,
                             from->enabled};
  return on(world, [&](World& w) { return set_them(w, given); });
}

template <class Get>
sinew_status get(sinew_world world, sinew_part_parameters* out, Get get_them) noexcept {
  PartParameters found;
  const sinew_status status = on(world, [&](World& w) { return get_them(w, out ? &found : nullptr); });
  if (status == SINEW_OK) *out = from_parameters(found);
  return status;
}

}  // namespace

sinew_part_parameters sinew_default_part_parameters(void) { return from_parameters({}); }

sinew_environment sinew_default_environment(void) { return from_environment({}); }

sinew_status sinew_set_parameters(sinew_world world, sinew_instance instance,
                                  const sinew_part_parameters* of_all) {
  return set(world, of_all,
             [&](World& w, const PartParameters& given) { return w.set_parameters(to_id(instance), given); });
}

sinew_status sinew_set_region_parameters(sinew_world world, sinew_instance instance, uint32_t region,
                                         const sinew_part_parameters* own) {
  return set(world, own, [&](World& w, const PartParameters& given) {
    return w.set_region_parameters(to_id(instance), region, given);
  });
}

sinew_status sinew_set_rod_parameters(sinew_world world, sinew_instance instance, uint32_t rod,
                                      const sinew_part_parameters* own) {
  return set(world, own, [&](World& w, const PartParameters& given) {
    return w.set_rod_parameters(to_id(instance), rod, given);
  });
}

sinew_status sinew_get_parameters(sinew_world world, sinew_instance instance, sinew_part_parameters* out) {
  return get(world, out,
             [&](World& w, PartParameters* found) { return w.parameters(to_id(instance), found); });
}

sinew_status sinew_get_region_parameters(sinew_world world, sinew_instance instance, uint32_t region,
                                         sinew_part_parameters* out) {
  return get(world, out, [&](World& w, PartParameters* found) {
    return w.region_parameters(to_id(instance), region, found);
  });
}

sinew_status sinew_get_rod_parameters(sinew_world world, sinew_instance instance, uint32_t rod,
                                      sinew_part_parameters* out) {
  return get(world, out,
             [&](World& w, PartParameters* found) { return w.rod_parameters(to_id(instance), rod, found); });
}

sinew_status sinew_set_environment(sinew_world world, const sinew_environment* environment) {
  if (!environment) return invalid("sinew_set_environment: environment is a null pointer");
  if (environment->made_by != kMadeByDefault) return not_made("sinew_default_environment");
  return on(world, [&](World& w) { return w.set_environment(to_environment(*environment)); });
}

sinew_status sinew_get_environment(sinew_world world, sinew_environment* out) {
  Environment found;
  const sinew_status status = on(world, [&](World& w) { return w.environment(out ? &found : nullptr); });
  if (status == SINEW_OK) *out = from_environment(found);
  return status;
}

sinew_status sinew_set_added_environment(sinew_world world, sinew_instance instance,
                                         const sinew_added_environment* added) {
  if (!added) return invalid("sinew_set_added_environment: added is a null pointer");
  return on(world, [&](World& w) {
    return w.set_added_environment(to_id(instance), same<AddedEnvironment>(*added));
  });
}

sinew_status sinew_get_added_environment(sinew_world world, sinew_instance instance,
                                         sinew_added_environment* out) {
  AddedEnvironment found;
  const sinew_status status =
      on(world, [&](World& w) { return w.added_environment(to_id(instance), out ? &found : nullptr); });
  if (status == SINEW_OK) *out = same<sinew_added_environment>(found);
  return status;
}
