// crowd_error.cpp  see crowd_error.hpp.
#include "perf/frames/crowd_error.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "perf/frames/camera.hpp"
#include "perf/frames/floor.hpp"
#include "perf/scale/require.hpp"
#include "perf/scale/stopwatch.hpp"
#include "sinew/sinew.hpp"

namespace sinew::perf {
namespace {

using demo::Trajectory;

uint32_t ticks_of(const Trajectory& motion) {
  return static_cast<uint32_t>(std::lround(motion.seconds() * motion.rate_hz()));
}

uint32_t longest(std::span<const Trajectory> motions) {
  uint32_t ticks = 0;
  for (const Trajectory& motion : motions) ticks = std::max(ticks, ticks_of(motion));
  return ticks;
}

// A world of one character, and how far what it shows is from the truth.
class Stage {
 public:
  Stage(const demo::CharacterFile& character, std::span<const Trajectory> motions, const CrowdDef& def)
      : motions_(motions),
        soft_(soft_vertices(character)),
        joints_(character.view.joints.size()),
        shown_(character.view.character->vertex_count),
        true_(shown_.size()) {
    require(
        World::create({.max_assets = 1, .max_instances = def.instances, .budget_mode = def.mode}, &world_));
    require(world_.load_asset(character.file.bytes(), &asset_));
    require(world_.set_budget_us(def.budget_us));
  }

  InstanceId add(const RootTransform& place, double importance) {
    InstanceId id;
    require(world_.create_instance(
        {.asset = asset_, .importance = static_cast<float>(importance), .root = place}, &id));
    return id;
  }

  void begin_anew(InstanceId id) { require(world_.reset(id)); }

  void pose(InstanceId id, const RootTransform& place, uint32_t motion, uint32_t tick) {
    RootTransform root;
    motions_[motion].pose_at(seconds(motion, tick), joints_, &root);
    for (size_t i = 0; i < 3; ++i) root.position_m[i] += place.position_m[i];
    require(world_.set_pose(id, {.joints = joints_, .root = root}));
  }

  void step() { world_.step(static_cast<float>(1 / motions_[0].rate_hz())); }

  double error_mm(InstanceId id, uint32_t motion, uint32_t tick) {
    require(world_.read_positions(id, {.out = shown_.data()->data(), .capacity = shown_.size()}));
    motions_[motion].positions_at(seconds(motion, tick), true_);
    double sum_m = 0;
    for (const uint32_t v : soft_) sum_m += static_cast<double>((shown_[v] - true_[v]).norm());
    return 1e3 * sum_m / static_cast<double>(soft_.size());
  }

  InstanceReport report(InstanceId id) const {
    InstanceReport report;
    require(world_.report(id, &report));
    return report;
  }

 private:
  double seconds(uint32_t motion, uint32_t tick) const { return tick / motions_[motion].rate_hz(); }

  std::span<const Trajectory> motions_;
  std::vector<uint32_t> soft_;
  std::vector<Matrix34> joints_;
  std::vector<Eigen::Vector3f> shown_, true_;
  World world_;
  AssetId asset_;
};

// [motion][tick]: what skinning alone is off.
std::vector<std::vector<double>> skinning_errors(const demo::CharacterFile& character,
                                                 std::span<const Trajectory> motions) {
  std::vector<std::vector<double>> out(motions.size());
  Stage stage(character, motions, {.instances = 1, .budget_us = 0});
  const InstanceId id = stage.add({}, 1);
  for (uint32_t m = 0; m < motions.size(); ++m) {
    for (uint32_t tick = 0; tick <= ticks_of(motions[m]); ++tick) {
      stage.pose(id, {}, m, tick);
      stage.step();
      out[m].push_back(stage.error_mm(id, m, tick));
    }
  }
  return out;
}

struct Member {
  InstanceId id;
  RootTransform place;
  double importance;
  uint32_t motion, tick;
  bool from_start = false;  // has been with its motion since that began
};

class Crowd {
 public:
  Crowd(const demo::CharacterFile& character, std::span<const Trajectory> motions, const CrowdDef& def)
      : motions_(motions),
        stage_(character, motions, def),
        skinning_mm_(skinning_errors(character, motions)) {
    for (uint32_t i = 0; i < def.instances; ++i) members_.push_back(member(i, def.instances));
  }

  // What the step took.
  double frame() {
    for (Member& member : members_) pose(member);
    const double before_us = clock_us(CLOCK_THREAD_CPUTIME_ID);
    stage_.step();
    return clock_us(CLOCK_THREAD_CPUTIME_ID) - before_us;
  }

  void measure(std::span<ErrorSums> sums) {
    for (const Member& m : members_) {
      const double error_mm = stage_.error_mm(m.id, m.motion, m.tick);
      if (m.from_start && m.tick > 0)
        sums[m.motion].add(m.importance, skinning_mm_[m.motion][m.tick], error_mm, stage_.report(m.id));
    }
  }

 private:
  // As large as the scene's view shows it.
  static double importance_at(const RootTransform& place, uint32_t count) {
    using Place = Eigen::Map<const Eigen::Vector3d>;
    const View view = overview(count);
    return 1 / (Place(place.position_m) - Place(view.position_m)).norm();
  }

  Member member(uint32_t index, uint32_t count) {
    const auto motion = static_cast<uint32_t>(index % motions_.size());
    const RootTransform place = place_on_floor(index, count);
    const double importance = importance_at(place, count);
    const uint32_t phase = ticks_of(motions_[motion]) * index / count;
    return {stage_.add(place, importance), place, importance, motion, phase};
  }

  void pose(Member& m) {
    if (++m.tick > ticks_of(motions_[m.motion])) {
      stage_.begin_anew(m.id);
      m.tick = 0;
      m.from_start = true;
    }
    stage_.pose(m.id, m.place, m.motion, m.tick);
  }

  std::span<const Trajectory> motions_;
  Stage stage_;
  std::vector<std::vector<double>> skinning_mm_;
  std::vector<Member> members_;
};

}  // namespace

void ErrorSums::add(double weight, double skinning_mm, double error_mm, const InstanceReport& report) {
  const auto expected = static_cast<double>(report.error);
  count_ += 1;
  left_alone_ += report.tier == Tier::kSkinning || report.tier == Tier::kExtrapolate;
  cut_ += report.why == TierReason::kCut;
  expected_ += expected;
  skinning_mm_ += skinning_mm;
  expected_mm_ += expected * skinning_mm;
  error_mm_ += error_mm;
  weighted_skinning_mm_ += weight * skinning_mm;
  weighted_expected_mm_ += weight * expected * skinning_mm;
  weighted_error_mm_ += weight * error_mm;
}

void ErrorSums::add(const ErrorSums& other) {
  count_ += other.count_;
  left_alone_ += other.left_alone_;
  cut_ += other.cut_;
  expected_ += other.expected_;
  skinning_mm_ += other.skinning_mm_;
  expected_mm_ += other.expected_mm_;
  error_mm_ += other.error_mm_;
  weighted_skinning_mm_ += other.weighted_skinning_mm_;
  weighted_expected_mm_ += other.weighted_expected_mm_;
  weighted_error_mm_ += other.weighted_error_mm_;
}

CrowdError measure_crowd(const demo::CharacterFile& character, std::span<const Trajectory> motions,
                         const CrowdDef& def) {
  CrowdError out{.motions = std::vector<ErrorSums>(motions.size()), .cpu_us = {}};
  Crowd crowd(character, motions, def);
  const uint32_t frames = longest(motions) + 1;  // then all have begun anew
  std::vector<ErrorSums> untold(motions.size());
  for (uint32_t f = 0; f < frames; ++f) crowd.frame(), crowd.measure(untold);
  for (uint32_t f = 0; f < frames; ++f) {
    out.cpu_us.push_back(crowd.frame());
    crowd.measure(out.motions);
  }
  return out;
}

}  // namespace sinew::perf
