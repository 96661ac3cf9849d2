// tiers.cpp  see tiers.hpp.
#include "samples/hair/tiers.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "character/rods/rod_publish.hpp"

namespace sinew::sample {
namespace {

constexpr uint32_t kApart = 15, kWatched = 44;  // ticks
constexpr uint32_t kHitsAtOnce = 64;

void accept(const Status& status) {
  if (!status.ok()) throw std::runtime_error(status.message);
}

core::AlignedBlock copied(const std::vector<std::byte>& bytes) {
  core::AlignedBlock out(bytes.size());
  if (!out.data()) throw std::bad_alloc();
  std::memcpy(out.data(), bytes.data(), bytes.size());
  return out;
}

Eigen::Vector3d moved(const Matrix34& m, const Eigen::Vector3d& p) {
  const auto matrix =
      Eigen::Map<const Eigen::Matrix<float, 3, 4, Eigen::RowMajor>>(&m.m[0][0]).cast<double>();
  return matrix.leftCols<3>() * p + matrix.col(3);
}

}  // namespace

TieredHair::TieredHair(const HairStyle& style, size_t vertices)
    : bust_(make_bust(vertices)), locks_(groom(bust_, style)), bones_(lock_bones(locks_)) {
  const std::vector<std::byte> bytes = pack_haired(bust_, locks_);
  pack_ = copied(bytes);
  skin_ = skin_of(bust_, &skin_id_);
  looked_at_ = skin_of(bust_, &looked_id_);
  lone_ = std::make_unique<baker::LoneInstance>(std::span(pack_.data(), bytes.size()),
                                                ContactDef{.own_body = true, .surface = &skin_});
}

void TieredHair::step(Touches touches, bool measures) {
  ++tick_;
  const Turning turning = turning_at(time_s());
  const std::vector<float> skin = haired_skin(bust_, turning);
  const double begin_us = thread_us();
  accept(skin_.move_surface(skin_id_, {.places_m = skin, .dt_s = static_cast<float>(lone_->tick_s())}));
  if (touches == Touches::kSkin) measure_.refit_us.push_back(thread_us() - begin_us);
  std::ranges::copy(haired_pose(bones_, turning), lone_->joints().begin());
  lone_->step({.tier = Tier::kModal, .level = touches == Touches::kSkin ? 0u : 1u});
  ++measure_.steps;
  measure_.rods_us.push_back(1e-3 * static_cast<double>(lone_->instance().times.rods_ns));
  const InstanceReport told = report();
  measure_.contacts += told.rod_contacts;
  measure_.contacts_most = std::max<uint64_t>(measure_.contacts_most, told.rod_contacts);
  measure_.dropped += told.contacts_dropped;
  measure_.recovered = told.rod_recoveries;
  if (!measures) return;
  accept(looked_at_.move_surface(looked_id_, {.places_m = skin}));
  look();
}

TieredHair::Places TieredHair::places() const {
  const Matrix34* joints = world::shown_joints(lone_->instance()) + kBustJoints;
  Places out;
  for (size_t b = 0; b < bones_.size(); ++b) {
    out.push_back(moved(joints[b], Eigen::Vector3d::Zero()));
    out.push_back(moved(joints[b], bones_[b].end - bones_[b].begin));
  }
  return out;
}

void TieredHair::look() {
  const Places ends = places();
  ContactHit hits[kHitsAtOnce];
  for (size_t b = 0; b < bones_.size(); ++b) {
    ContactProbe probe{.radius_m = bones_[b].radius_m};
    for (size_t e = 0; e < 2; ++e)
      for (double(*at)[3] : {probe.start_m, probe.end_m}) std::copy_n(ends[2 * b + e].data(), 3, at[e]);
    const uint32_t found = looked_at_.find({&probe, 1}, static_cast<float>(lone_->tick_s()), hits);
    ++measure_.looked_at;
    for (const ContactHit& hit : std::span(hits).first(std::min(found, kHitsAtOnce))) {
      const double deep = -hit.gap_m / static_cast<double>(probe.radius_m);
      measure_.deepest = std::max(measure_.deepest, deep);
      measure_.deeper_than_a_twentieth += deep > 0.05;
    }
  }
}

TieredHair::Mark TieredHair::mark() const { return {lone_->save(), tick_}; }

void TieredHair::go_back(const Mark& mark) {
  lone_->restore(mark.state);
  tick_ = mark.tick;
  accept(skin_.move_surface(skin_id_, {.places_m = haired_skin(bust_, turning_at(time_s()))}));
}

std::string tier_line(TieredHair& hair, const char* name) {
  const HairMeasure m = hair.take_measure();
  char text[300];
  std::snprintf(
      text, sizeof text,
      "%s: rods touch %s, %.0f us a tick (refit %.0f), %.0f contacts (dropped %llu), deepest %.3f of a "
      "radius, %.4f %% deeper than a twentieth",
      name, hair.report().rods_touch_surface ? "the skin" : "capsules", median(m.rods_us), median(m.refit_us),
      static_cast<double>(m.contacts) / static_cast<double>(m.steps),
      static_cast<unsigned long long>(m.dropped), m.deepest,
      100.0 * static_cast<double>(m.deeper_than_a_twentieth) /
          static_cast<double>(std::max<uint64_t>(m.looked_at, 1)));
  return text;
}

// ---- changes ----

namespace {

using Places = TieredHair::Places;
using Steps = std::vector<double>;  // metres from one frame to the next

// A tier all along.
struct Run {
  std::vector<Places> frames;
  std::vector<Steps> steps;             // of this frame and the two before it the longest
  std::vector<TieredHair::Mark> marks;  // after every kApart ticks
};

Steps steps_between(const Places& before, const Places& after) {
  Steps out;
  for (size_t i = 0; i < after.size(); ++i) out.push_back((after[i] - before[i]).norm());
  return out;
}

Run run_in(TieredHair& hair, Touches touches, uint32_t ticks) {
  const TieredHair::Mark start = hair.mark();
  Run run;
  std::vector<Steps> own;
  run.frames.push_back(hair.places());
  for (uint32_t t = 1; t <= ticks; ++t) {
    hair.step(touches);
    run.frames.push_back(hair.places());
    own.push_back(steps_between(run.frames[t - 1], run.frames[t]));
    run.steps.push_back(own.back());
    for (size_t back = 2; back <= std::min<size_t>(3, own.size()); ++back)
      for (size_t i = 0; i < own.back().size(); ++i)
        run.steps.back()[i] = std::max(run.steps.back()[i], own[own.size() - back][i]);
    if (t % kApart == 0) run.marks.push_back(hair.mark());
  }
  hair.go_back(start);
  return run;
}

// Beyond both, of all changes from one to the other.
TierJump largest_jump(TieredHair& hair, const Run& from, const Run& to, Touches touches) {
  TierJump largest;
  for (size_t m = 0; m < from.marks.size(); ++m) {
    const size_t first = (m + 1) * kApart;
    Places before = from.frames[first];
    hair.go_back(from.marks[m]);
    for (size_t t = first; t < std::min(first + 2 * kWatched, from.steps.size()); ++t) {
      hair.step(touches);
      Places now = hair.places();
      const Steps steps = steps_between(before, now);
      double& most = t < first + kWatched ? largest.after_m : largest.later_m;
      for (size_t i = 0; i < steps.size(); ++i)
        most = std::max(most, steps[i] - std::max(from.steps[t][i], to.steps[t][i]));
      before = std::move(now);
    }
  }
  return largest;
}

}  // namespace

TierJumps tier_jumps(TieredHair& hair, uint32_t ticks) {
  const TieredHair::Mark start = hair.mark();
  const Run skin = run_in(hair, Touches::kSkin, ticks), capsules = run_in(hair, Touches::kCapsules, ticks);
  const TierJumps jumps = {largest_jump(hair, skin, capsules, Touches::kCapsules),
                           largest_jump(hair, capsules, skin, Touches::kSkin)};
  hair.go_back(start);
  return jumps;
}

}  // namespace sinew::sample
