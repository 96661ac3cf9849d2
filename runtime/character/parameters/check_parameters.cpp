// check_parameters.cpp  see check_parameters.hpp.
#include "character/parameters/check_parameters.hpp"

#include <cmath>
#include <limits>
#include <span>

#include "character/parameters/tuning_state.hpp"
#include "core/status.hpp"

namespace sinew::world {
namespace {

struct Number {
  const char* name;
  float value, least, most;
};

Status check(const char* function, std::span<const Number> numbers) noexcept {
  for (const Number& n : numbers) {
    if (n.value >= n.least && n.value <= n.most) continue;
    const bool nan = std::isnan(n.value);
    return core::make_status(nan ? StatusCode::kNotFinite : StatusCode::kInvalidArgument,
                             "%s: %s is %g, not in %g..%g; nothing was changed", function, n.name,
                             static_cast<double>(n.value), static_cast<double>(n.least),
                             static_cast<double>(n.most));
  }
  return {};
}

Status check_vector(const char* function, const char* name, const float (&vector)[3], float most) noexcept {
  const Number numbers[] = {
      {name, vector[0], -most, most}, {name, vector[1], -most, most}, {name, vector[2], -most, most}};
  return check(function, numbers);
}

constexpr float kMostGravity_m_s2 = 1000, kMostAcceleration_m_s2 = 10000, kMostWind_m_s = 200;

Status check_moving(const char* function, const float (&acceleration)[3], const float (&wind)[3]) noexcept {
  const Status status = check_vector(function, "acceleration_m_s2", acceleration, kMostAcceleration_m_s2);
  return status.ok() ? check_vector(function, "the wind's velocity_m_s", wind, kMostWind_m_s) : status;
}

}  // namespace

Status check_parameters(const char* function, const PartParameters& given) noexcept {
  const Number numbers[] = {{"intensity", given.intensity, 0, kMostIntensity},
                            {"stiffness", given.stiffness, kLeastStiffness, kMostStiffness},
                            {"damping", given.damping, 0, kMostDamping},
                            {"displacement", given.displacement, 0, kMostDisplacement}};
  return check(function, numbers);
}

Status check_environment(const Environment& given) noexcept {
  constexpr const char* kFunction = "set_environment";
  constexpr float kFastest_hz = 10, kLeast_hz = std::numeric_limits<float>::min();
  Status status = check_vector(kFunction, "gravity_m_s2", given.gravity_m_s2, kMostGravity_m_s2);
  if (status.ok()) status = check_moving(kFunction, given.acceleration_m_s2, given.wind.velocity_m_s);
  const Number numbers[] = {{"gust", given.wind.gust, 0, 1},
                            {"gust_hz", given.wind.gust_hz, kLeast_hz, kFastest_hz}};
  return status.ok() ? check(kFunction, numbers) : status;
}

Status check_added(const AddedEnvironment& given) noexcept {
  return check_moving("set_added_environment", given.acceleration_m_s2, given.wind_m_s);
}

}  // namespace sinew::world
