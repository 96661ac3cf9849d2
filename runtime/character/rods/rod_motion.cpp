// rod_motion.cpp  Bones that are rods, tick by tick.
#include "character/rods/rod_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "character/motion/pose.hpp"
#include "character/parameters/air.hpp"
#include "character/parameters/tuned_parts.hpp"
#include "character/rest/asleep.hpp"
#include "character/rest/rod_sleep.hpp"
#include "character/rods/own_body.hpp"
#include "character/rods/rod_contacts.hpp"
#include "math/rotation.hpp"
#include "tissue/frames/node_drive.hpp"
#include "tissue/modes/guard.hpp"

namespace sinew::world {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using MapTurn = Eigen::Map<Quaterniond>;
using MapPlace = Eigen::Map<Vector3d>;

constexpr double kGravity_m_s2 = 9.80665;  // along -Y, as tissue feels it

Quaterniond turn_of(const RodState& rods, uint32_t slot) noexcept {
  return Eigen::Map<const Eigen::Quaternionf>(rods.turn + 4 * slot).cast<double>().normalized();
}

Quaterniond rest_of(const RodState& rods, int tick, uint32_t slot) noexcept {
  return Eigen::Map<const Quaterniond>(rods.rest[tick] + size_t{4} * slot);
}

rods::SegmentPose pose_of(const Quaterniond& turn, const Vector3d& middle) noexcept {
  rods::SegmentPose pose;
  std::copy_n(middle.data(), 3, pose.position_m);
  Eigen::Map<Eigen::Vector4f>(pose.orientation) = turn.coeffs().cast<float>();
  return pose;
}

Vector3d half_axis(const RodSlot& slot, const Quaterniond& turn) noexcept {
  return turn * Vector3d(0, 0, slot.length_m / 2);
}

bool is_end(const RodSeat& seat, uint32_t slot) noexcept {
  return slot > seat.first_slot + seat.segment_count();
}

Vector3d hold_of_end(const Instance& instance, const RodSeat& seat, int tick) noexcept {
  const size_t hold = size_t{instance.asset->rods.rod_count} + seat.end_hold;
  return Eigen::Map<const Vector3d>(instance.rods.hold[tick] + 3 * hold);
}

// Where a segment is when its rod is turned as rod_turn says against the rest of a tick; parents first.
struct Placed {
  Quaterniond turn;
  Vector3d middle;
};
Placed place_segment(Instance& instance, const RodSeat& seat, uint32_t rod, uint32_t s, int tick) noexcept {
  const RodSlot& slot = instance.asset->rods.slots()[s];
  const Quaterniond turn = (rest_of(instance.rods, tick, s) * turn_of(instance.rods, s)).normalized();
  const Vector3d half = half_axis(slot, turn);
  MapPlace end(instance.rods.end[tick] + size_t{3} * s);
  if (s == seat.first_slot) {
    end = Eigen::Map<const Vector3d>(instance.rods.hold[tick] + size_t{3} * rod);
    return {turn, end - half};
  }
  if (is_end(seat, s)) return {turn, hold_of_end(instance, seat, tick) + half};
  const Vector3d begin = Eigen::Map<const Vector3d>(instance.rods.end[tick] + size_t{3} * slot.parent);
  end = begin + 2 * half;
  return {turn, begin + half};
}

// What the pose does with it in a tick, turned as it is.
struct Step {
  Placed before, now;
  Vector3d velocity_m_s, spin_rad_s;
};
Step step_of_pose(Instance& instance, const RodSeat& seat, uint32_t rod, uint32_t s) noexcept {
  const double tick_s = instance.asset->tick_s;
  const Placed before = place_segment(instance, seat, rod, s, 1),
               now = place_segment(instance, seat, rod, s, 0);
  return {before, now, (now.middle - before.middle) / tick_s,
          logarithm(now.turn * before.turn.conjugate()) / tick_s};
}

// What a segment does beside the pose, of what it does.
struct Beside {
  Vector3d velocity_m_s, spin_rad_s;
};

void put_segment(RodState& rods, const RodSeat& seat, uint32_t s, const Placed& place, const Step& step,
                 const Beside& beside) noexcept {
  rods::SegmentVelocity velocity;
  Eigen::Map<Eigen::Vector3f>(velocity.linear_m_s) = (step.velocity_m_s + beside.velocity_m_s).cast<float>();
  Eigen::Map<Eigen::Vector3f>(velocity.angular_rad_s) = (step.spin_rad_s + beside.spin_rad_s).cast<float>();
  // A refusal leaves the segment where it was: its joints pull it back, or the batch recovers the strand.
  (void)rods.batches[seat.batch].set_pose(seat.strand, s - seat.first_slot, pose_of(place.turn, place.middle),
                                          velocity);
}

Beside beside_pose(const RodState& rods, const RodSeat& seat, uint32_t s, const Step& step) noexcept {
  const rods::SegmentVelocity whole = rods.batches[seat.batch].velocity(seat.strand, s - seat.first_slot);
  return {Eigen::Map<const Eigen::Vector3f>(whole.linear_m_s).cast<double>() - step.velocity_m_s,
          Eigen::Map<const Eigen::Vector3f>(whole.angular_rad_s).cast<double>() - step.spin_rad_s};
}

// As it is shown at the tick before, moving as the pose does and, where it is carried, as it did beside that.
void take_along(Instance& instance, uint32_t rod) noexcept {
  const RodSeat& seat = instance.asset->rods.seats()[rod];
  for (uint32_t s = seat.first_slot; s < seat.first_slot + seat.slot_count; ++s) {
    const Step step = step_of_pose(instance, seat, rod, s);
    Beside beside{Vector3d::Zero(), Vector3d::Zero()};
    if (instance.motion.carried_rods[rod]) {
      const float* own = instance.rods.velocity + size_t{6} * s;
      beside = {step.before.turn * Eigen::Map<const Eigen::Vector3f>(own).cast<double>(),
                step.before.turn * Eigen::Map<const Eigen::Vector3f>(own + 3).cast<double>()};
    }
    put_segment(instance.rods, seat, s, step.before, step, beside);
  }
}

// It was off, and goes on from its pose.
bool returns_to_pose(const Instance& instance, uint32_t rod) noexcept {
  return tunes_parts(instance) && instance.parameters.rod_tunings[rod].off == kReturns;
}

// Those that begin anew, are carried or return; whether there is one.
bool take_some_along(Instance& instance) noexcept {
  const bool all = std::exchange(instance.rods.begin_as_shown, false);
  bool some = false;
  for (uint32_t rod = 0; rod < instance.asset->rods.rod_count; ++rod) {
    const bool returns = returns_to_pose(instance, rod);
    if (returns) instance.parameters.rod_tunings[rod].off = 0;
    if (!all && !instance.motion.carried_rods[rod] && !returns) continue;
    take_along(instance, rod);
    some = true;
  }
  return some;
}

Vector3d felt_gravity(const Instance& instance, uint32_t rod, const RodSeat& seat) noexcept {
  const pack::RodRecord& record = instance.level->pack.rods[rod];
  const Quaterniond bind(instance.asset->rods.slots()[seat.first_slot].bind_xyzw);
  const Quaterniond turned = rest_of(instance.rods, 0, seat.first_slot) * bind.conjugate();
  const Vector3d g =
      kGravity_m_s2 * Eigen::Map<const Eigen::Vector3f>(record.gravity_direction).cast<double>();
  return double{record.gravity} * (g - (1 - double{record.sag}) * (turned * g));
}

// Far damping leads beyond half a turn, which would be another way round: there the animation trails.
Vector3d held_lead(const Vector3d& turn) noexcept {
  constexpr double kMost_rad = 2;
  const double angle = turn.norm();
  return angle > kMost_rad ? Vector3d(kMost_rad / angle * turn) : turn;
}

// Damping resists all bending, the animation's too, which would trail by damping_s: (1 + t/h) C - (t/h) C_0
// of the joint (kernels/rods/rod_step-inl.hpp) counts both from this tick's rest. A rest that leads by t/h of
// its own step makes it resist only what the rod does beside it.
Quaterniond led_rest(const Instance& instance, uint32_t s, double ticks, double damping_share) noexcept {
  const RodSlot& slot = instance.asset->rods.slots()[s];
  const auto bent = [&](int tick) {
    return rest_of(instance.rods, tick, slot.parent).conjugate() * rest_of(instance.rods, tick, s);
  };
  const Quaterniond now = bent(0), step = bent(1).conjugate() * now;
  const double lead = damping_share * double{slot.damping_s} / (ticks * instance.asset->tick_s);
  const Vector3d led = lead * logarithm(step);
  return (now * exponential(damping_share == 1 ? led : held_lead(led))).normalized();
}

void drive_end(const Instance& instance, const RodSeat& seat, rods::RodBatch& batch) noexcept {
  const uint32_t k = seat.slot_count - 1, s = seat.first_slot + k;
  const Quaterniond held = rest_of(instance.rods, 0, s);
  const Vector3d half = half_axis(instance.asset->rods.slots()[s], held);
  (void)batch.set_target(seat.strand, k, pose_of(held, hold_of_end(instance, seat, 0) + half));
}

// What acts on all of a rod's bones alike.
struct RodDrive {
  Vector3d pull_m_s2, air_m_s;
  double damping_share;
};
RodDrive rod_drive(const Instance& instance, uint32_t rod, const RodSeat& seat,
                   const Vector3d& beside_m_s2) noexcept {
  RodDrive drive{felt_gravity(instance, rod, seat) + beside_m_s2, Vector3d::Zero(),
                 static_cast<double>(rod_damping_share(instance, rod))};
  if (!tunes_air(instance)) return drive;
  drive.pull_m_s2 += rod_pull(instance, rod);
  drive.air_m_s = air_at_rod(instance, rod);
  return drive;
}

// Where it is held, its shape at rest, what pulls at it: so many ticks after the pose before, and beside
// gravity.
void drive_rod(Instance& instance, uint32_t rod, double ticks, const Vector3d& beside_m_s2) noexcept {
  const RodRig& rig = instance.asset->rods;
  const RodSeat& seat = rig.seats()[rod];
  rods::RodBatch& batch = instance.rods.batches[seat.batch];
  const Quaterniond held = rest_of(instance.rods, 0, seat.first_slot);
  const Vector3d hold = Eigen::Map<const Vector3d>(instance.rods.hold[0] + size_t{3} * rod);
  // What is refused keeps its last value; poses have been checked.
  (void)batch.set_target(seat.strand, 0, pose_of(held, hold - half_axis(rig.slots()[seat.first_slot], held)));
  const RodDrive drive = rod_drive(instance, rod, seat, beside_m_s2);
  for (uint32_t k = 1; k < seat.slot_count; ++k) {
    const RodSlot& slot = rig.slots()[seat.first_slot + k];
    const bool is_bone = k <= seat.segment_count();
    float rest[4], force_n[3];
    Eigen::Vector4f::Map(rest) =
        led_rest(instance, seat.first_slot + k, ticks, is_bone ? drive.damping_share : 1)
            .coeffs()
            .cast<float>();
    (void)batch.set_rest(seat.strand, k, rest);
    if (!is_bone) continue;
    Vector3d force = double{slot.mass_kg} * drive.pull_m_s2;
    if (!drive.air_m_s.isZero(0))
      force += drag_n(slot, batch.pose(seat.strand, k), batch.velocity(seat.strand, k), drive.air_m_s,
                      instance.asset->tick_s);
    Eigen::Vector3f::Map(force_n) = force.cast<float>();
    (void)batch.set_force(seat.strand, k, force_n);
  }
  if (seat.end_hold != pack::kNoIndex) drive_end(instance, seat, batch);
}

void add_to_velocities(Instance& instance, const Vector3d& added_m_s) noexcept {
  const Eigen::Vector3f along_m_s = added_m_s.cast<float>();
  for (const RodSeat& seat : instance.asset->rods.seats()) {
    rods::RodBatch& batch = instance.rods.batches[seat.batch];
    for (uint32_t k = 1; k <= seat.segment_count(); ++k) {
      rods::SegmentVelocity velocity = batch.velocity(seat.strand, k);
      Eigen::Map<Eigen::Vector3f>(velocity.linear_m_s) += along_m_s;
      (void)batch.set_velocity(seat.strand, k, velocity);
    }
  }
}

// What of the root's acceleration is not felt.
Vector3d spared(const ParameterState& parameters, const Vector3d& acceleration_m_s2) noexcept {
  const double share = tissue::felt_share(static_cast<float>(acceleration_m_s2.norm()), parameters.most_m_s2);
  return (1 - share) * acceleration_m_s2;
}

Vector3d tick_root(const RootMotion& motion, int tick) noexcept {
  return Eigen::Map<const Vector3d>(motion.tick_root_m[tick]);
}

// They go along with it.
void spare_rods(Instance& instance) noexcept {
  const double tick_s = instance.asset->tick_s;
  const Vector3d change_m_s =
      (tick_root(instance.state->motion, 0) - 2 * tick_root(instance.state->motion, 1) +
       tick_root(instance.state->motion, 2)) /
      tick_s;
  const Vector3d spared_m_s2 = spared(instance.parameters, change_m_s / tick_s);
  if (!spared_m_s2.isZero(0)) add_to_velocities(instance, tick_s * spared_m_s2);
}

// As a region's displacement is held (tissue/modes/guard.hpp).
Quaterniond limited(const Quaterniond& turn, float limit_rad) noexcept {
  if (limit_rad == 0) return turn;
  const Vector3d vector = logarithm(turn);
  return exponential(double{tissue::limit_share(static_cast<float>(vector.norm()), limit_rad)} * vector);
}

// As much of it as is shown.
Quaterniond shown(const Quaterniond& turn, const RodShown& as) noexcept {
  const Quaterniond within = limited(turn, as.limit_rad);
  return as.intensity == 1 ? within : exponential(double{as.intensity} * logarithm(within));
}

// Against the rest, of a segment that is turned so in the world.
Quaterniond swung_turn(const RodState& rods, uint32_t s, const float* orientation) noexcept {
  return (rest_of(rods, 0, s).conjugate() * quaternion(orientation)).normalized();
}

Quaterniond swung_turn(const RodState& rods, const RodSeat& seat, uint32_t k) noexcept {
  const rods::SegmentPose pose = rods.batches[seat.batch].pose(seat.strand, k);
  return swung_turn(rods, seat.first_slot + k, pose.orientation);
}

void put_turn(float* turns, uint32_t s, const Quaterniond& turn) noexcept {
  Eigen::Map<Eigen::Vector4f>(turns + size_t{4} * s) = turn.coeffs().cast<float>();
}

// What holds a segment's swing, as a region's is held (tissue/modes/guard.hpp): further out it would come to
// rest on the other side of what it touches. Where an engine lets less be shown, it swings on beneath; a rod
// whose ends are both held is left alone.
double swing_share(const RodSeat& seat, float limit_rad, const Quaterniond& turn) noexcept {
  if (limit_rad == 0 || seat.end_hold != pack::kNoIndex) return 1;
  const float angle_rad = 2 * static_cast<float>(std::acos(std::min(1.0, std::abs(turn.w()))));
  return double{tissue::swing_share(angle_rad, std::max(limit_rad, seat.turn_limit_rad))};
}

// Of all segments, turns and what they do beside the pose.
void hold_swing(Instance& instance, uint32_t rod, const RodShown& as) noexcept {
  const RodSeat& seat = instance.asset->rods.seats()[rod];
  for (uint32_t k = 1; k <= seat.segment_count(); ++k) {
    const Quaterniond turn = swung_turn(instance.rods, seat, k);
    put_turn(instance.rods.turn, seat.first_slot + k,
             exponential(swing_share(seat, as.limit_rad, turn) * logarithm(turn)));
  }
  for (uint32_t k = 0; k < seat.slot_count; ++k) {
    const uint32_t s = seat.first_slot + k;
    const double share = k == 0 ? 1 : swing_share(seat, as.limit_rad, swung_turn(instance.rods, seat, k));
    const Step step = step_of_pose(instance, seat, rod, s);
    const Beside beside = beside_pose(instance.rods, seat, s, step);
    put_segment(instance.rods, seat, s, step.now, step,
                {share * beside.velocity_m_s, share * beside.spin_rad_s});
  }
}

// Puts what is shown; whether something swings too far.
bool read_turns_of(RodState& rods, const RodSeat& seat, const RodShown& as) noexcept {
  bool too_far = false;
  for (uint32_t k = 1; k <= seat.segment_count(); ++k) {
    const Quaterniond turn = swung_turn(rods, seat, k);
    too_far |= swing_share(seat, as.limit_rad, turn) != 1;
    put_turn(rods.turn, seat.first_slot + k, shown(turn, as));
  }
  return too_far;
}

void read_turns(Instance& instance) noexcept {
  for (uint32_t rod = 0; rod < instance.asset->rods.rod_count; ++rod) {
    const RodSeat& seat = instance.asset->rods.seats()[rod];
    const RodShown as = rod_shown(instance, rod);
    if (!read_turns_of(instance.rods, seat, as)) continue;
    hold_swing(instance, rod, as);
    read_turns_of(instance.rods, seat, as);
  }
}

// Its rest and where it is held in a pose, of a tick.
void rest_rod(Instance& instance, uint32_t rod, const Matrix34* joints, const RootTransform& root,
              int tick) noexcept {
  const RodRig& rig = instance.asset->rods;
  const RodSeat& seat = rig.seats()[rod];
  const Quaterniond world = quaternion(root.rotation_xyzw);
  const Vector3d place =
      Eigen::Map<const Vector3d>(root.position_m) - Eigen::Map<const Vector3d>(instance.state->rods.anchor_m);
  for (uint32_t s = seat.first_slot; s < seat.first_slot + seat.slot_count; ++s) {
    const RodSlot& slot = rig.slots()[s];
    Quaterniond joint;
    joint_rotation(joints[slot.joint], joint.coeffs().data());
    MapTurn(instance.rods.rest[tick] + size_t{4} * s) =
        (world * joint * Quaterniond(slot.offset_xyzw)).normalized();
  }
  const Matrix34& first = joints[rig.slots()[seat.first_slot + 1].bone];
  MapPlace(instance.rods.hold[tick] + size_t{3} * rod) =
      place + world * Vector3d(first.m[0][3], first.m[1][3], first.m[2][3]);
  if (seat.end_hold == pack::kNoIndex) return;
  const RodEnd& end = rig.ends()[seat.end_hold];
  const auto joint = Eigen::Map<const Eigen::Matrix<float, 3, 4, Eigen::RowMajor>>(&joints[end.joint].m[0][0])
                         .cast<double>();
  MapPlace(instance.rods.hold[tick] + 3 * (size_t{rig.rod_count} + seat.end_hold)) =
      place + world * (joint.leftCols<3>() * Eigen::Map<const Vector3d>(end.place_m) + joint.col(3));
}

}  // namespace

void begin_rods(Instance& instance) noexcept {
  instance.rods.begin_as_shown = true;
  wake_rods(instance);
  std::copy_n(instance.state->motion.next_root.position_m, 3, instance.state->rods.anchor_m);
}

void rest_rods(Instance& instance, const Matrix34* joints, const RootTransform& root) noexcept {
  const RodRig& rig = instance.asset->rods;
  if (rig.rod_count == 0) return;
  std::copy_n(instance.rods.rest[0], size_t{4} * rig.slot_count, instance.rods.rest[1]);
  std::copy_n(instance.rods.hold[0], size_t{3} * rig.hold_count(), instance.rods.hold[1]);
  for (uint32_t rod = 0; rod < rig.rod_count; ++rod) rest_rod(instance, rod, joints, root, 0);
}

void rest_carried_rods(Instance& instance, const Matrix34* joints, const RootTransform& root,
                       int tick) noexcept {
  for (uint32_t rod = 0; rod < instance.asset->rods.rod_count; ++rod)
    if (instance.motion.carried_rods[rod]) rest_rod(instance, rod, joints, root, tick);
}

void move_rods(Instance& instance, const Quaterniond& turn, const Vector3d& from_m,
               const Vector3d& to_m) noexcept {
  InstanceState& state = *instance.state;
  MapPlace anchor(state.rods.anchor_m);
  const Vector3d centre = from_m - anchor;
  anchor += to_m - from_m;
  if (turn.vec().isZero(0)) return;
  turn_proxies(instance, turn, centre);
  const RodRig& rig = instance.asset->rods;
  for (int tick = 0; tick < 2; ++tick) {
    for (uint32_t s = 0; s < rig.slot_count; ++s) {
      MapTurn rest(instance.rods.rest[tick] + size_t{4} * s);
      rest = turn * Quaterniond(rest);
    }
    for (uint32_t h = 0; h < rig.hold_count(); ++h) {
      MapPlace hold(instance.rods.hold[tick] + size_t{3} * h);
      hold = (centre + turn * (hold - centre)).eval();
    }
  }
  for (uint32_t b = 0; b < instance.asset->rods.batch_count; ++b)
    instance.rods.batches[b].turn_all({turn.x(), turn.y(), turn.z(), turn.w()},
                                      {centre.x(), centre.y(), centre.z()});
}

void speed_rods(Instance& instance, const Vector3d& added_m_s) noexcept {
  InstanceState& state = *instance.state;
  const Vector3d tick_m = instance.asset->tick_s * added_m_s;
  MapPlace anchor(state.rods.anchor_m);
  anchor -= state.remainder_s * added_m_s;
  for (uint32_t h = 0; h < instance.asset->rods.hold_count(); ++h)
    MapPlace(instance.rods.hold[1] + size_t{3} * h) -= tick_m;
  move_last_proxies(instance, -tick_m);
  add_to_velocities(instance, added_m_s);
}

void remember_rod_velocities(Instance& instance) noexcept {
  const RodRig& rig = instance.asset->rods;
  for (uint32_t rod = 0; rod < rig.rod_count; ++rod) {
    if (!instance.motion.carried_rods[rod]) continue;
    const RodSeat& seat = rig.seats()[rod];
    for (uint32_t s = seat.first_slot; s < seat.first_slot + seat.slot_count; ++s) {
      const Step step = step_of_pose(instance, seat, rod, s);
      const Beside beside = beside_pose(instance.rods, seat, s, step);
      const Quaterniond into = step.now.turn.conjugate();
      float* own = instance.rods.velocity + size_t{6} * s;
      Eigen::Vector3f::Map(own) = (into * beside.velocity_m_s).cast<float>();
      Eigen::Vector3f::Map(own + 3) = (into * beside.spin_rad_s).cast<float>();
    }
  }
}

void simulate_rods(Instance& instance) noexcept {
  const RodRig& rig = instance.asset->rods;
  if (rig.rod_count == 0 || rods_are_off(instance)) return;
  if (take_some_along(instance)) {
    wake_rods(instance);
    forget_rod_contacts(instance);
  }
  if (rods_sleep_on(instance)) return;
  for (uint32_t rod = 0; rod < rig.rod_count; ++rod) drive_rod(instance, rod, 1, Vector3d::Zero());
  spare_rods(instance);
  for (uint32_t b = 0; b < rig.batch_count; ++b) {
    rods::RodReport report;
    (void)instance.rods.batches[b].step(static_cast<float>(instance.asset->tick_s), rod_collider(instance, b),
                                        &report);
    instance.state->rods.recoveries += report.rejoined + report.recovered;
    instance.told.rod_iterations += report.iterations_sum;
    instance.told.rod_residual = std::max(instance.told.rod_residual, report.residual);
    instance.told.rod_contacts += report.contacts;
    instance.told.refused += report.bad_hits;
    instance.told.dropped += report.contacts_dropped;
  }
  read_turns(instance);
  watch_rods(instance);
}

namespace {

// As long as it lives, the present pose is the newest of an instance's rods, and the last tick's the one
// before.
class PresentRest {
 public:
  explicit PresentRest(Instance& instance) noexcept
      : instance_(instance),
        rest_{instance.rods.rest[0], instance.rods.rest[1]},
        hold_{instance.rods.hold[0], instance.rods.hold[1]} {
    put({instance.rods.rest_now, rest_[0]}, {instance.rods.hold_now, hold_[0]});
    for (uint32_t rod = 0; rod < instance.asset->rods.rod_count; ++rod)
      rest_rod(instance, rod, instance.motion.joints, instance.state->motion.root, 0);
  }
  PresentRest(const PresentRest&) = delete;
  PresentRest& operator=(const PresentRest&) = delete;
  ~PresentRest() { put(rest_, hold_); }

 private:
  using Ticks = std::array<double*, 2>;
  void put(const Ticks& rest, const Ticks& hold) noexcept {
    std::ranges::copy(rest, instance_.rods.rest);
    std::ranges::copy(hold, instance_.rods.hold);
  }
  Instance& instance_;
  Ticks rest_, hold_;
};

// As it went.
void go_on(const RodState& rods, const RodSeat& seat, const RodShown& as, double ticks,
           float* turns) noexcept {
  for (uint32_t k = 1; k <= seat.segment_count(); ++k) {
    const size_t at = size_t{4} * (seat.first_slot + k);
    const Quaterniond step = quaternion(rods.shown[1] + at).conjugate() * quaternion(rods.shown[0] + at);
    const Quaterniond turn = quaternion(rods.turn + at) * exponential(ticks * logarithm(step));
    Eigen::Map<Eigen::Vector4f>(turns + at) = limited(turn, as.limit_rad).coeffs().cast<float>();
  }
}

}  // namespace

void turn_rods_between(Instance& instance, float x, float* turns) noexcept {
  const RodRig& rig = instance.asset->rods;
  std::copy_n(instance.rods.turn, size_t{4} * rig.slot_count, turns);
  const bool asleep = rods_asleep(instance) == rig.rod_count;
  if (instance.rods.begin_as_shown || rods_are_off(instance) ||
      (asleep && instance.state->poses.still_ticks > 0))
    return;
  const PresentRest present(instance);
  if (asleep && rods_are_held_as_asleep(instance)) return;
  const double tick_s = instance.asset->tick_s, ticks = static_cast<double>(x);
  const Vector3d step = Eigen::Map<const Vector3d>(instance.state->motion.root.position_m) -
                        tick_root(instance.state->motion, 0),
                 before = tick_root(instance.state->motion, 0) - tick_root(instance.state->motion, 1);
  const Vector3d beside_m_s2 =
      spared(instance.parameters, (step - ticks * before) / (tick_s * tick_s * ticks * (1 + ticks) / 2));
  for (uint32_t rod = 0; rod < rig.rod_count; ++rod)
    if (!instance.motion.carried_rods[rod]) drive_rod(instance, rod, ticks, beside_m_s2);
  for (uint32_t b = 0; b < rig.batch_count; ++b) {
    const rods::RodBatch& batch = instance.rods.batches[b];
    (void)batch.step_between(static_cast<float>(tick_s), x, rod_collider(instance, b),
                             instance.rods.orientations);
    for (uint32_t rod = 0; rod < rig.rod_count; ++rod) {
      const RodSeat& seat = rig.seats()[rod];
      if (seat.batch != b) continue;
      const RodShown as = rod_shown(instance, rod, x);
      if (instance.motion.carried_rods[rod]) {
        go_on(instance.rods, seat, as, ticks, turns);
        continue;
      }
      const float* first = instance.rods.orientations + size_t{4} * seat.strand * batch.segment_count();
      for (uint32_t k = 1; k <= seat.segment_count(); ++k) {
        const Quaterniond turn = swung_turn(instance.rods, seat.first_slot + k, first + size_t{4} * k);
        // As the tick will hold it, by so much of it.
        const double share = std::pow(swing_share(seat, as.limit_rad, turn), ticks);
        const Quaterniond held = share == 1 ? turn : exponential(share * logarithm(turn));
        put_turn(turns, seat.first_slot + k, shown(held, as));
      }
    }
  }
}

}  // namespace sinew::world
