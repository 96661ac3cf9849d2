// rod_batch.hpp  Strands of one shape, simulated together.
//
// An implicit Euler step in its mixed form, iterated by Newton's method (kernels/rods/rod_linearise-inl.hpp):
// rods do not stretch, soft ones converge as stiff ones do, and where the iteration ends does not depend on
// where it starts. A strand is a lane of the vectors; its numbers do not depend on its neighbours. Results
// have the same bits on all instruction sets with fused multiply-adds. One thread at a time for a batch;
// several batches at once are several threads' work.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/aligned_block.hpp"
#include "kernels/rods/rod_job.hpp"
#include "rods/contacts/collider.hpp"
#include "rods/start/learned_start.hpp"
#include "rods/strand.hpp"
#include "rods/turn.hpp"

namespace sinew::rods {

// Where a step's iteration starts. Free motion is what a segment would do without joints.
enum class RodStart : uint32_t {
  kZero = 0,  // at free motion, no forces
  // Free motion with the last step's forces and what they did; as kZero for a strand that did not converge.
  kPrevious = 1,
  kGiven = 2,  // what set_start gave since the last step; segments given nothing as with kPrevious
  // The last steps' forces continued: by how much they change, and how that changed, in the shares that would
  // have served the last step best (kernels/rods/rod_start-inl.hpp). As kPrevious until four steps converged;
  // contacts' forces from two on, as the last step changed them.
  kContinued = 3,
  kLearned = 4,  // kContinued, corrected by RodSettings::network
};

// For comparing methods (baker/research): another solver's iteration of a group, as simd::RodCalls::direct
// does it, and what it does before the first; another correction of kContinued, as
// simd::RodStartCalls::add_network. None by default. `self` is handed on and outlives the batch; `width` is
// of the group.
struct RodSolver {
  void (*begin)(void* self, const simd::RodJob& job, uint32_t width) = nullptr;
  uint32_t (*iterate)(void* self, const simd::RodJob& job, uint32_t width) = nullptr;
  void* self = nullptr;
  bool knows_contacts = true;  // else its batches step without a collider alone
};
struct RodCorrection {
  void (*correct)(void* self, const simd::RodJob& job, const simd::RodStartJob& start,
                  uint32_t width) = nullptr;
  void* self = nullptr;
};

struct RodSettings {
  RodSolver solver = {};
  RodStart start = RodStart::kPrevious;
  uint32_t max_iterations = 12;  // 1 to 1000
  // 1e-6 to 1: the iteration ends where it turned no segment by more. Stretch is then at most its square over
  // two: 5e-5 at the default.
  float tolerance_rad = 0.01f;
  float gravity_m_s2[3] = {0, -9.81f, 0};
  // A pose given for a fixed segment further away than this many of its strand's lengths carries the strand
  // along as it is, without inertia. Finite, above 0.
  float teleport_lengths = 2;
  // Fills RodReport::residual, for a fifth of an iteration's time.
  bool report_residual = false;
  const CopingNet* network = nullptr;  // of kLearned; what it points to outlives the batch
  RodCorrection correction = {};       // of kContinued
  bool keeps_start_inputs = false;     // for training: kContinued then has start_inputs as well
};

// A strand that does not stretch ends no step with a segment further from the nearest one that is held than
// the way along it, and this less one of the longest such way, more; also where two are held further apart
// than it is long.
inline constexpr double kMostReach = 1.02;

struct SegmentPose {
  double position_m[3];
  float orientation[4];  // x y z w
};
struct SegmentVelocity {
  float linear_m_s[3], angular_rad_s[3];  // in the world
};

// A guess of what the joints do to a segment in the coming step, and of what its joint to the parent carries.
struct SegmentStart {
  float acceleration_m_s2[3] = {0, 0, 0};
  float angular_acceleration_rad_s2[3] = {0, 0, 0};  // along the segment's own axes
  float force_n[3] = {0, 0, 0};  // of the joint, on the parent, in the world; the root's is not read
  float moment_nm[3] = {0, 0,
                        0};  // minus the derivative of the bending energy by the Darboux vector times length
};

// What kLearned was told of a segment and its joint, and what it corrects: kernels/rods/rod_start_job.hpp.
// Numbers in the strand's own units: its mean segment's length and mass, and seconds.
struct StartInputs {
  float told[simd::kRodStartInputs];
  float joint[simd::kRodJointInputs];
  float scales[simd::kRodStartTriples];
  float continued[simd::kRodStartNumbers];
};

struct RodReport {
  uint32_t iterations = 0;      // most of any strand
  uint32_t iterations_sum = 0;  // of all strands
  uint32_t unconverged = 0;     // strands whose last iteration turned a segment by more than the tolerance
  uint32_t rejoined = 0;    // strands put together at their joints: torn by more than half a segment without
                            // having converged, or beyond kMostReach
  uint32_t recovered = 0;   // strands that were not finite: put back at rest shape where they are held
  uint32_t teleported = 0;  // strands carried along since the last step
  // With RodSettings::report_residual, of any strand: what the step's equations miss by, in the strand's mean
  // segments' lengths, radians, and shares of its largest force (kernels/rods/rod_residual-inl.hpp), with a
  // collider of contacts' forces, gaps and slips (lengths) too; infinite where a strand had to be recovered.
  // Otherwise 0.
  float residual = 0;
  // With a collider: contacts near enough to be looked at, and those that had no room; a source's hits that
  // were left out because a number was out of its range.
  uint32_t contacts = 0, contacts_dropped = 0, bad_hits = 0;
  uint32_t contacts_unconverged = 0;  // strands whose contacts, at the last iteration, were not exact enough
  // At the step's end, share of the segment's radius, as contacts measure it: along normals of the step.
  float deepest_penetration = 0;
};

class RodBatch {
 public:
  RodBatch() noexcept = default;
  // Every strand with as many segments as the first and the same parents. Refused: what check_strand refuses,
  // other shapes, settings outside their range, no strand, no memory, numbers that in a strand's own units
  // (its mean segment's length and mass) become 0 or leave float's range; `out` is then untouched.
  static Status create(std::span<const StrandDef> strands, const RodSettings& settings,
                       RodBatch* out) noexcept;

  uint32_t strand_count() const noexcept { return strand_count_; }
  uint32_t segment_count() const noexcept { return segment_count_; }

  // Where a fixed segment is at the end of the coming step; without it the segment stays. Its velocity is
  // what takes it there. Refused: no such segment, one that is not fixed, numbers that are not finite or
  // leave float's range in the strand's own units, no unit quaternion; the last target then holds.
  Status set_target(uint32_t strand, uint32_t segment, const SegmentPose& pose) noexcept;
  // Newtons on the segment's middle, in every step until changed. Refused, here and below: no such segment,
  // numbers that are not finite or leave float's range in the strand's own units; the last ones then hold.
  // Refused as well: a fixed segment.
  Status set_force(uint32_t strand, uint32_t segment, const float (&force_n)[3]) noexcept;
  // What the coming step starts with. Refused as well: a fixed segment, whose velocity is its target's.
  Status set_velocity(uint32_t strand, uint32_t segment, const SegmentVelocity& velocity) noexcept;
  // For the coming step. Refused as well: RodSettings::start other than kGiven.
  Status set_start(uint32_t strand, uint32_t segment, const SegmentStart& start) noexcept;

  // dt_s in (0, 1]; otherwise refused, and nothing moves. Allocates nothing.
  Status step(float dt_s, RodReport* report) noexcept;
  // The same among obstacles and with one another. Refused as well: a collider made for another shape, a
  // solver that knows no contacts.
  Status step(float dt_s, RodCollider* collider, RodReport* report) noexcept;

  // Where segments will be by a fraction of the coming step of dt_s, in which fixed segments have come to
  // their targets: nothing changes but targets, which the next set_target replaces. At 1 it is where the step
  // takes them; at 0 they leave with the velocity at which the last step's fraction arrived. What touched
  // rods in the last step, by this collider, is taken to push as it did; null: nothing. turns_xyzw:
  // [strands][segments][4], orientations; of a strand that is not finite those that it has. Refused: dt_s as
  // in step; a fraction not in (0, 1]. Allocates nothing, remembers nothing. Cost: of a step that finds no
  // contacts.
  Status step_between(float dt_s, float fraction, const RodCollider* touched,
                      float* turns_xyzw) const noexcept;

  // What `from` has come to, its targets and forces too, with this batch's own settings. Refused: one not
  // made of the same strands, as far as counts and parents tell. What kContinued and those after it remember
  // comes along from a batch that remembers it too; otherwise they begin anew. Allocates nothing.
  Status take_state(const RodBatch& from) noexcept;

  // Of an existing segment.
  SegmentPose pose(uint32_t strand, uint32_t segment) const noexcept;
  SegmentVelocity velocity(uint32_t strand, uint32_t segment) const noexcept;
  // What kPrevious starts from: of the last step; zeros where the strand did not converge.
  SegmentStart last_forces(uint32_t strand, uint32_t segment) const noexcept;

  // For training, of the last step; zeros but with kLearned, a correction or keeps_start_inputs.
  StartInputs start_inputs(uint32_t strand, uint32_t segment) const noexcept;

  // ---- rod_state.cpp: for what keeps a batch in a pose, in a snapshot, with a character ----

  // Puts a segment there, fixed or not, moving so, without forces; a fixed one stays until its next target.
  // Refused: no such segment, numbers as in set_target and set_velocity.
  Status set_pose(uint32_t strand, uint32_t segment, const SegmentPose& pose,
                  const SegmentVelocity& velocity) noexcept;
  // The segment's orientation in its parent's axes at which their joint is at rest, until changed. Refused:
  // no such segment, the root, no unit quaternion.
  Status set_rest(uint32_t strand, uint32_t segment, const float (&to_parent)[4]) noexcept;
  // The segment's joint to its parent as it was created, but so many times as stiff against bending and
  // twisting, and with so many times its damping_s, until changed. No state: a snapshot leaves it as it is.
  // What a network for starts was told of joints stays. Refused: no such segment, the root; a stiffness that
  // is not finite and above 0, a damping that is not finite and 0 or more, either that leaves float's range
  // in the strand's own units; the joint stays as it was.
  struct JointChange {
    float stiffness = 1, damping = 1;
  };
  Status set_joint(uint32_t strand, uint32_t segment, const JointChange& change) noexcept;
  // Turns everything rigidly about a point: poses, velocities, forces. Targets not yet stepped to are
  // dropped.
  void turn_all(const std::array<double, 4>& by_xyzw, const std::array<double, 3>& centre_m) noexcept;
  // What steps change, as bytes: after a restore into a batch of the same strands and settings the same steps
  // give the same bits. A collider has a state of its own.
  size_t state_bytes() const noexcept;
  void save_state(std::byte* out) const noexcept;
  void restore_state(const std::byte* from) noexcept;
  // What a batch of so many strands of so many segments takes, with settings that create takes.
  static size_t memory_bytes(uint32_t strands, uint32_t segments, const RodSettings& settings) noexcept;

 private:
  friend struct RodBatchBuilder;
  friend class RodCollider;
  friend struct ColliderBuilder;
  friend struct ContactFinder;
  friend struct ContactForces;
  friend class ContactLooks;
  friend class ContactPushes;
  friend struct StrandPacker;
  struct Units {
    double origin_m[3];
    float length_m, mass_kg, total_lengths;
  };
  // Without a division: contacts ask at every row.
  uint32_t group_of(uint32_t strand) const noexcept { return width_ == 16 ? strand / 16 : strand / 4; }
  uint32_t lane_of(uint32_t strand) const noexcept { return strand & (width_ - 1); }
  size_t row(uint32_t strand, uint32_t segment, uint32_t field) const noexcept {
    const size_t record = size_t{group_of(strand)} * segment_count_ + slots_[segment];
    return (record * simd::kRodKeptFields + field) * width_ + lane_of(strand);
  }
  // -1 where the record tells the joint to the parent from its other end: its force is minus that on the
  // parent.
  float joint_side(uint32_t segment) const noexcept { return joint_segments_[segment] == segment ? 1 : -1; }
  float& at(uint32_t strand, uint32_t segment, uint32_t field) const noexcept {
    return records_[row(strand, segment, field)];
  }
  float& radius_m(uint32_t strand, uint32_t segment) const noexcept {
    const size_t slot = size_t{group_of(strand)} * segment_count_ + slots_[segment];
    return radii_m_[slot * width_ + lane_of(strand)];
  }
  // Steps that its start may go back to.
  float& known_steps(uint32_t strand) const noexcept {
    return lanes_[(size_t{group_of(strand)} * simd::kLaneFields + simd::kLaneKnownSteps) * width_ +
                  lane_of(strand)];
  }
  void put_place(uint32_t strand, uint32_t segment, uint32_t axis, double place) const noexcept {
    const float high = static_cast<float>(place);
    at(strand, segment, simd::kRodPlace + axis) = high;
    at(strand, segment, simd::kRodPlaceLow + axis) = static_cast<float>(place - static_cast<double>(high));
  }
  void put_target(uint32_t strand, uint32_t segment, const Vector& move, const Turn& turn) const noexcept;
  template <class Run>
  void for_each_run(Run run) const noexcept;
  Status check_place(uint32_t strand, uint32_t segment) const noexcept;
  Status check_simulated(uint32_t strand, uint32_t segment, const char* what) const noexcept;
  bool held(uint32_t strand, uint32_t segment) const noexcept;
  uint32_t group_count() const noexcept { return (strand_count_ + width_ - 1) / width_; }
  simd::RodJob group_job(uint32_t group, float dt_s, float* scratch) const noexcept;
  // Of the group in one of the collider's places.
  simd::RodJob home_job(uint32_t place, float dt_s, const RodCollider& collider) const noexcept;
  void activate(uint32_t group, const simd::RodJob& job) const noexcept;
  void begin_group(uint32_t group, const simd::RodJob& job) const noexcept;
  void read_turns(uint32_t group, const simd::RodJob& job, float* turns_xyzw) const noexcept;
  uint32_t iterate(const simd::RodJob& job) const noexcept;
  void iterate_homes(float dt_s, const RodCollider& collider) const noexcept;
  uint32_t begin_range(uint32_t first_group, float dt_s, RodCollider* collider, uint32_t left) const noexcept;
  uint32_t go_on(float dt_s, RodCollider* collider, uint32_t active, uint32_t left) const noexcept;
  void end_range(const GroupRange& range, float dt_s, RodCollider* collider, RodReport* report) noexcept;
  void step_alone(uint32_t group, float dt_s, RodReport* report) noexcept;
  uint32_t begin_together(uint32_t group, float dt_s, RodCollider* collider, RodReport* report,
                          uint32_t* active) noexcept;
  uint32_t step_together(uint32_t group, float dt_s, RodCollider* collider, RodReport* report) noexcept;
  void end_group(uint32_t group, const simd::RodJob& job, RodReport* report) noexcept;
  bool has_history() const noexcept { return settings_.start >= RodStart::kContinued; }
  bool has_inputs() const noexcept {
    return settings_.start == RodStart::kLearned ||
           (has_history() && (settings_.keeps_start_inputs || settings_.correction.correct));
  }
  simd::RodStartJob start_job(uint32_t group) const noexcept;
  void tell_fixed_inputs() noexcept;
  void tell_joint(uint32_t strand, uint32_t slot, float (&out)[simd::kRodJointInputs]) const noexcept;
  void make_start(uint32_t group, const simd::RodJob& job) const noexcept;
  void take_history(const RodBatch& from) noexcept;
  void carry(uint32_t strand, uint32_t segment, const SegmentPose& to) noexcept;
  void carry_place(uint32_t strand, uint32_t segment, const Turn& by, const SegmentPose& from,
                   const SegmentPose& to) noexcept;
  void turn_row(uint32_t strand, uint32_t segment, uint32_t field, const Turn& by) noexcept;
  void forget_start(uint32_t strand) noexcept;
  bool rejoin(uint32_t strand, bool converged, float dt_s) noexcept;
  void find_ways(uint32_t strand, const float* joints, float* nearest, float* way) const noexcept;
  bool is_beyond_reach(uint32_t strand, float* joints) const noexcept;
  Vector place(uint32_t strand, uint32_t segment) const noexcept;
  Vector half_axis(uint32_t strand, uint32_t segment) const noexcept;
  Vector joint_offset(uint32_t strand, uint32_t segment) const noexcept;
  double largest_gap(uint32_t strand) const noexcept;
  void count_joints_to_held(uint32_t strand, float* joints) const noexcept;
  void shift(uint32_t strand, uint32_t segment, const Vector& to, float dt_s) noexcept;
  void recover(uint32_t strand) noexcept;
  void forget_motion(uint32_t strand, uint32_t segment) noexcept;

  static constexpr uint32_t kRestNumbers = 10;
  static constexpr uint32_t kMadeJoint = 3;  // compliances against bending and twisting, damping
  float& made_joint(uint32_t strand, uint32_t record, uint32_t number) const noexcept {
    const size_t slot = size_t{group_of(strand)} * segment_count_ + slots_[record];
    return made_joints_[(slot * kMadeJoint + number) * width_ + lane_of(strand)];
  }

  core::AlignedBlock memory_;
  float* records_ = nullptr;    // [groups][segments][kRodKeptFields][width]
  float* scratch_ = nullptr;    // of one group
  float* work_ = nullptr;       // the same
  float* lanes_ = nullptr;      // [groups][kLaneFields][width]
  float* history_ = nullptr;    // [groups][segments][kRodStartAges][kRodStartNumbers][width]
  float* inputs_ = nullptr;     // [groups][segments][kRodStartInputs][width]
  float* continued_ = nullptr;  // [groups][segments][kRodStartNumbers][width]
  float* scales_ = nullptr;     // [groups][kRodStartTriples][width]
  float* encodings_ = nullptr;  // [groups][segments][latent][width]
  float* planes_ = nullptr;     // of one group
  float* rest_ = nullptr;  // [strands][segments][kRestNumbers] place, high and low, and orientation at rest
  float* radii_m_ = nullptr;            // [groups][slots][width]
  float* made_joints_ = nullptr;        // [groups][slots][kMadeJoint][width] what set_joint takes shares of
  Units* units_ = nullptr;              // [strands]
  uint32_t* parents_ = nullptr;         // [segments] as listed
  uint32_t* slots_ = nullptr;           // [segments] where a segment's record is; slot 0 is held if one is
  uint32_t* joint_segments_ = nullptr;  // [segments] whose record holds the joint to the parent
  uint32_t* slot_parents_ = nullptr;    // [slots] slots
  RodSettings settings_;
  simd::RodStartNet net_{};
  uint32_t strand_count_ = 0, segment_count_ = 0, width_ = 0, teleported_ = 0, newest_ = 0;
};

inline float* RodCollider::scratch(uint32_t place) const noexcept {
  return places_.scratch + size_t{place} * segment_count_ * simd::kRodScratchRows * width_;
}

inline float* RodCollider::scratch_row(const RodBatch& batch, uint32_t strand, uint32_t segment,
                                       uint32_t field) const noexcept {
  const uint32_t at = seat(strand);
  const size_t record = size_t{batch.group_of(at)} * segment_count_ + batch.slots_[segment];
  const size_t row = record * simd::kRodScratchRows + field - simd::kRodKeptFields;
  return places_.scratch + row * width_ + batch.lane_of(at);
}

}  // namespace sinew::rods
