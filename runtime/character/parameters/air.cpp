// air.cpp  see air.hpp.
#include "character/parameters/air.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "character/parameters/glide.hpp"
#include "character/rest/asleep.hpp"
#include "math/rotation.hpp"
#include "math/turn_between.hpp"
#include "tissue/frames/node_drive.hpp"

namespace sinew::world {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr float kAir_kg_m3 = 1.2f, kDragCoefficient = 1.1f, kFlesh_kg_m3 = 1000;
constexpr float kHalfDrag = kAir_kg_m3 * kDragCoefficient / 2;
constexpr float kRounding = 1e-3f;      // m/s^2, m/s
constexpr double kLeastWind_m_s = 0.1;  // slower gusts travel nowhere

const Environment& environment_of(const ParameterState& parameters) noexcept {
  static constexpr Environment kUsual;
  return parameters.environment ? *parameters.environment : kUsual;
}

// Of the last tick or the coming one.
enum class When { kNow, kNext };

struct AirTargets {
  float numbers[kAirNumbers];
};

AirTargets targets_of(const Instance& instance) noexcept {
  constexpr Environment kUsual;
  const Environment& world = environment_of(instance.parameters);
  const AddedEnvironment& added = instance.state->parameters.air.added;
  AirTargets to;
  for (uint32_t k = 0; k < 3; ++k) {
    to.numbers[kGravityChange + k] = world.gravity_m_s2[k] - kUsual.gravity_m_s2[k];
    to.numbers[kAcceleration + k] = world.acceleration_m_s2[k] + added.acceleration_m_s2[k];
    to.numbers[kWindVelocity + k] = world.wind.velocity_m_s[k] + added.wind_m_s[k];
  }
  to.numbers[kGust] = world.wind.gust;
  Eigen::Map<Vector3f> acceleration(to.numbers + kAcceleration);
  acceleration *= tissue::felt_share(acceleration.norm(), instance.parameters.most_m_s2);
  return to;
}

// Gusts without wind are none.
bool is_still_air(const AirTargets& targets) noexcept {
  return std::all_of(targets.numbers, targets.numbers + kGust, [](float number) { return number == 0; });
}

Vector3f vector_of(const AirState& air, uint32_t first, When when) noexcept {
  Vector3f out;
  for (uint32_t k = 0; k < 3; ++k) {
    const Gliding& number = air.numbers[first + k];
    out[static_cast<Eigen::Index>(k)] = when == When::kNow ? number.now : number.next;
  }
  return out;
}

bool has_wind(const AirState& air, When when) noexcept {
  return !vector_of(air, kWindVelocity, when).isZero(0);
}

// ---- gusts ----

// Whole numbers of all sines' periods.
double within_period(double cycles) noexcept { return cycles - 100 * std::floor(cycles / 100); }

// -1..1.
float gust_at(double cycles) noexcept {
  const auto wave = [cycles](double times, double phase) {
    return std::sin(2 * std::numbers::pi * times * cycles + phase);
  };
  return static_cast<float>(0.55 * wave(1, 0) + 0.3 * wave(2.53, 1.1) + 0.15 * wave(6.17, 2.3));
}

Vector3f air_velocity(const AirState& air, When when, double cycles_behind = 0) noexcept {
  const Gliding& gust = air.numbers[kGust];
  const float share = when == When::kNow ? gust.now : gust.next;
  const Vector3f wind = vector_of(air, kWindVelocity, when);
  if (share == 0) return wind;
  const double cycles = when == When::kNow ? air.gust_cycles : air.next_gust_cycles;
  return (1 + share * gust_at(cycles - cycles_behind)) * wind;
}

// How many gusts lie along a way.
double cycles_along(const Instance& instance, const Vector3d& way_m) noexcept {
  const Vector3d wind = vector_of(instance.state->parameters.air, kWindVelocity, When::kNext).cast<double>();
  const double speed_m_s = wind.norm(), gust_hz = double{environment_of(instance.parameters).wind.gust_hz};
  return speed_m_s > kLeastWind_m_s ? gust_hz * way_m.dot(wind) / (speed_m_s * speed_m_s) : 0;
}

Vector3d root_of_tick(const RootMotion& motion, int tick) noexcept {
  return Eigen::Map<const Vector3d>(motion.tick_root_m[tick]);
}

void begin_gusts(Instance& instance) noexcept {
  const InstanceState& state = *instance.state;
  const RootTransform& root = state.poses.has_next ? state.motion.next_root : state.motion.root;
  const double cycles = -cycles_along(instance, Eigen::Map<const Vector3d>(root.position_m));
  instance.state->parameters.air.gust_cycles = instance.state->parameters.air.next_gust_cycles =
      within_period(cycles);
}

// No faster than three times against the wind's own speed: what moves so fast is not blown upon.
void advance_gusts(Instance& instance) noexcept {
  constexpr double kMost = 3;
  const double own = double{environment_of(instance.parameters).wind.gust_hz} * instance.asset->tick_s;
  const double along = cycles_along(
      instance, root_of_tick(instance.state->motion, 0) - root_of_tick(instance.state->motion, 1));
  AirState& air = instance.state->parameters.air;
  air.next_gust_cycles = within_period(air.gust_cycles + own - std::clamp(along, -kMost * own, kMost * own));
}

// ---- what flesh feels ----

Vector3f pull_of(const Instance& instance, size_t region, When when) noexcept {
  const AirState& air = instance.state->parameters.air;
  const Vector3f wind = air_velocity(air, when);
  const float radius_m = instance.level->pack.regions[region].radius_m;
  return vector_of(air, kGravityChange, when) + vector_of(air, kAcceleration, when) +
         kHalfDrag * wind.norm() / (kFlesh_kg_m3 * radius_m) * wind;
}

}  // namespace

void notice_environment(Instance& instance) noexcept {
  const AirTargets targets = targets_of(instance);
  InstanceState& state = *instance.state;
  if (!tunes_air(instance) && is_still_air(targets)) return;
  bool stands = true;
  for (uint32_t k = 0; k < kAirNumbers; ++k)
    stands = stands && stands_at(state.parameters.air.numbers[k], targets.numbers[k]);
  if (stands) return;
  state.parameters.tuned |= kTunedAir;
  state.parameters.moves = 1;
  wake(instance);
}

void begin_air_tick(Instance& instance) noexcept {
  AirState& air = instance.state->parameters.air;
  for (Gliding& number : air.numbers) number.now = number.next;
  air.gust_cycles = air.next_gust_cycles;
}

void end_air_tick(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  AirState& air = state.parameters.air;
  const AirTargets targets = targets_of(instance);
  const bool blew = has_wind(air, When::kNow);
  bool glides = false;
  for (uint32_t k = 0; k < kAirNumbers; ++k) {
    glide(targets.numbers[k], kRounding, kAnySpeed, air.numbers[k]);
    glides |= moves(air.numbers[k]);
  }
  const bool blows = has_wind(air, When::kNext);
  if (!blew && blows) begin_gusts(instance);
  if (blew && blows) advance_gusts(instance);
  glides |= (blew || blows) && air.numbers[kGust].next > 0;
  if (glides) {
    state.parameters.moves = 1;
    wake_rods(instance);
  } else if (is_still_air(targets)) {
    air.numbers[kGust] = {};
    state.parameters.tuned &= static_cast<uint16_t>(~kTunedAir);
  }
}

void settle_air(Instance& instance) noexcept {
  const AirTargets targets = targets_of(instance);
  const bool blew = has_wind(instance.state->parameters.air, When::kNext);
  for (uint32_t k = 0; k < kAirNumbers; ++k)
    instance.state->parameters.air.numbers[k] = {targets.numbers[k], targets.numbers[k], 0};
  if (!blew && has_wind(instance.state->parameters.air, When::kNext)) begin_gusts(instance);
}

void add_air(Instance& instance) noexcept {
  for (size_t r = 0; r < instance.level->pack.regions.size(); ++r) {
    const pack::RegionRecord& region = instance.level->pack.regions[r];
    tissue::add_pull(instance.motion.poses[0] + region.first_node, pull_of(instance, r, When::kNow).data(),
                     region.node_count,
                     instance.tissue.drive + size_t{tissue::kNodeDriveWidth} * region.first_node);
  }
}

void add_air_between(const Instance& instance, size_t region, const FractionPoses& poses, float x,
                     float* felt) noexcept {
  const Vector3f before = pull_of(instance, region, When::kNow),
                 next = pull_of(instance, region, When::kNext);
  const Vector3f now = before + x * (next - before);
  tissue::add_fraction_pull({poses.now, poses.before, instance.level->pack.regions[region].node_count},
                            now.data(), before.data(), x, felt);
}

Vector3d rod_pull(const Instance& instance, uint32_t rod) noexcept {
  const pack::RodRecord& record = instance.level->pack.rods[rod];
  const AirState& air = instance.state->parameters.air;
  const Vector3d towards = Eigen::Map<const Vector3f>(record.gravity_direction).cast<double>();
  const Vector3d change = vector_of(air, kGravityChange, When::kNext).cast<double>();
  return double{record.gravity} * (core::turn_between(-Vector3d::UnitY(), towards) * change) +
         vector_of(air, kAcceleration, When::kNext).cast<double>();
}

Vector3d air_at_rod(const Instance& instance, uint32_t rod) noexcept {
  const AirState& air = instance.state->parameters.air;
  if (!has_wind(air, When::kNext)) return Vector3d::Zero();
  const Vector3d hold = Eigen::Map<const Vector3d>(instance.rods.hold[0] + size_t{3} * rod) +
                        Eigen::Map<const Vector3d>(instance.state->rods.anchor_m);
  return air_velocity(air, When::kNext,
                      cycles_along(instance, hold - root_of_tick(instance.state->motion, 0)))
      .cast<double>();
}

Vector3d drag_n(const RodSlot& slot, const rods::SegmentPose& pose, const rods::SegmentVelocity& velocity,
                const Vector3d& air_m_s, double tick_s) noexcept {
  const Vector3d axis = quaternion(pose.orientation) * Vector3d::UnitZ();
  Vector3d u = air_m_s - Eigen::Map<const Vector3f>(velocity.linear_m_s).cast<double>();
  u -= u.dot(axis) * axis;
  const double k = double{kHalfDrag} * 2 * double{slot.radius_m} * double{slot.length_m} * air_m_s.norm();
  return k / (1 + tick_s * k / double{slot.mass_kg}) * u;
}

}  // namespace sinew::world
