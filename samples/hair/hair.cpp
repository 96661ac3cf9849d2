// hair.cpp  see hair.hpp.
#include "samples/hair/hair.hpp"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "rods/rod_batch.hpp"
#include "tests/rods/rod_scenes.hpp"

namespace sinew::sample {
namespace {

constexpr float kTick_s = 1.0f / 120;
constexpr uint32_t kMostIterations = 40;  // contacts of locks that slide over a ridge take some
constexpr uint32_t kHitsASegment = 3;

void accept(const Status& status) {
  if (!status.ok()) throw std::runtime_error(status.message);
}

// Both ends of a segment's axis.
void put_ends(const rods::SegmentPose& pose, double length_m, double (&ends)[2][3]) {
  const rods::Vector axis = test::axis_of(pose);
  for (size_t k = 0; k < 3; ++k) {
    ends[0][k] = pose.position_m[k] - 0.5 * length_m * axis[k];
    ends[1][k] = pose.position_m[k] + 0.5 * length_m * axis[k];
  }
}

}  // namespace

double thread_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

SurfaceContacts skin_of(const Bust& bust, SurfaceId* id) {
  std::vector<uint32_t> indices;
  for (const auto& t : bust.triangles) indices.insert(indices.end(), t.begin(), t.end());
  const std::vector<float> rest = bust.places({});
  SurfaceContacts out;
  accept(SurfaceContacts::create({.max_surfaces = 1, .max_owners = 0}, &out));
  accept(out.add_surface({.triangles = indices, .rest_m = rest, .friction = 0.3f}, id));
  return out;
}

Hair::Hair(const HairStyle& style, Against against, size_t vertices)
    : bust_(make_bust(vertices)), strands_(groom(bust_, style)), against_(against) {
  std::vector<rods::StrandDef> defs;
  for (const auto& s : strands_) defs.push_back({s});
  rods::RodSettings settings{.start = rods::RodStart::kContinued};
  settings.max_iterations = kMostIterations;
  accept(rods::RodBatch::create(defs, settings, &batch_));
  const uint32_t most = kHitsASegment * style.strands * style.segments;
  accept(rods::RodCollider::create(
      batch_, {.rods_collide = false, .contact_capacity = most, .point_capacity = 0, .source_capacity = most},
      &collider_));
  skin_ = skin_of(bust_, &skin_id_);
  if (against_ == Against::kSkin) accept(collider_.set_source(&skin_));
  looked_at_ = skin_of(bust_, &looked_id_);
  hits_.resize(most);
}

void Hair::hold_roots(const Turning& turning) {
  const double c = std::cos(turning.head_rad), s = std::sin(turning.head_rad);
  const rods::Turn by = {0, std::sin(0.5 * turning.head_rad), 0, std::cos(0.5 * turning.head_rad)};
  for (uint32_t i = 0; i < strands_.size(); ++i) {
    const rods::SegmentDef& root = strands_[i].front();
    const double* p = root.position_m;
    rods::SegmentPose pose = {{c * p[0] + s * p[2], p[1], c * p[2] - s * p[0]}, {}};
    const rods::Turn turn = rods::product(by, rods::turn_of(root.orientation));
    for (size_t k = 0; k < 4; ++k) pose.orientation[k] = static_cast<float>(turn[k]);
    accept(batch_.set_target(i, 0, pose));
  }
}

// Turned about the vertical, as the bones are.
void Hair::place_proxies(const Turning& before, const Turning& now) {
  std::vector<rods::Capsule> capsules;
  for (const BustProxy& proxy : bust_.proxies) {
    const auto angle = [&](const Turning& t) {
      return t.chest_rad + proxy.head_share * (t.head_rad - t.chest_rad);
    };
    const Eigen::AngleAxisd turn(angle(now), Eigen::Vector3d::UnitY());
    const Eigen::Vector3d spin =
        (angle(now) - angle(before)) / static_cast<double>(kTick_s) * Eigen::Vector3d::UnitY();
    const Eigen::Vector3d from = turn * proxy.from, to = turn * proxy.to,
                          moves = spin.cross(0.5 * (from + to));
    rods::Capsule capsule = {.radius_m = static_cast<float>(proxy.radius_m), .friction = 0.3f, .motion = {}};
    for (int k = 0; k < 3; ++k) {
      capsule.ends_m[0][k] = from[k], capsule.ends_m[1][k] = to[k];
      capsule.motion.linear_m_s[k] = static_cast<float>(moves[k]);
      capsule.motion.angular_rad_s[k] = static_cast<float>(spin[k]);
    }
    capsules.push_back(capsule);
  }
  accept(collider_.set_capsules(capsules));
}

void Hair::step(bool measures) {
  const Turning before = turning_at(time_s_);
  time_s_ += static_cast<double>(kTick_s);
  const Turning turning = turning_at(time_s_);
  const std::vector<float> places = bust_.places(turning);
  hold_roots(turning);
  const double begin = thread_us();
  if (against_ == Against::kProxies) place_proxies(before, turning);
  if (against_ == Against::kSkin) {
    accept(skin_.move_surface(skin_id_, {.places_m = places, .dt_s = kTick_s}));
    measure_.refit_us.push_back(thread_us() - begin);
  }
  rods::RodReport report;
  accept(batch_.step(kTick_s, &collider_, &report));
  measure_.rods_us.push_back(thread_us() - begin);
  ++measure_.steps;
  measure_.unconverged += report.unconverged;
  measure_.contacts_unconverged += report.contacts_unconverged;
  measure_.recovered += report.recovered + report.rejoined;
  measure_.contacts += report.contacts;
  measure_.contacts_most = std::max<uint64_t>(measure_.contacts_most, report.contacts);
  measure_.dropped += report.contacts_dropped;
  if (!measures) return;
  accept(looked_at_.move_surface(looked_id_, {.places_m = places}));
  look();
}

// With a surface of its own that stands where the skin is now.
void Hair::look() {
  probes_.clear();
  for (uint32_t s = 0; s < strands_.size(); ++s) {
    for (uint32_t i = 1; i < strands_[s].size(); ++i) {
      ContactProbe probe;
      put_ends(batch_.pose(s, i), static_cast<double>(strands_[s][i].length_m), probe.start_m);
      std::copy_n(&probe.start_m[0][0], 6, &probe.end_m[0][0]);
      probe.radius_m = strands_[s][i].radius_m;
      probes_.push_back(probe);
    }
    measure_.longest = std::max(measure_.longest, test::length_ratio(batch_, strands_[s], s));
  }
  const uint32_t found = looked_at_.find(probes_, kTick_s, hits_);
  if (found > hits_.size()) throw std::runtime_error("more hits than room");
  measure_.looked_at += probes_.size();
  for (const ContactHit& hit : std::span(hits_).first(found)) {
    const double deep = -hit.gap_m / static_cast<double>(probes_[hit.probe].radius_m);
    measure_.deepest = std::max(measure_.deepest, deep);
    measure_.deeper_than_a_twentieth += deep > 0.05;
  }
}

std::string report_line(const Hair& hair, const char* name) {
  const HairMeasure& m = hair.measure();
  const auto steps = static_cast<double>(std::max<uint64_t>(m.steps, 1));
  char text[400];
  std::snprintf(
      text, sizeof text,
      "%-8s %zu locks x %u segments on %zu triangles, %llu steps: deepest %.3f of a radius, %.4f %% deeper "
      "than a twentieth, l/l0 %.5f, %.0f contacts (most %llu, dropped %llu), not converged %.2f strands a "
      "step and %.2f by contacts, put together %llu, %.0f us a step (refit %.0f)",
      name, hair.strands().size(), hair.batch().segment_count(), hair.bust().triangles.size(),
      static_cast<unsigned long long>(m.steps), m.deepest,
      100.0 * static_cast<double>(m.deeper_than_a_twentieth) /
          static_cast<double>(std::max<uint64_t>(m.looked_at, 1)),
      m.longest, static_cast<double>(m.contacts) / steps, static_cast<unsigned long long>(m.contacts_most),
      static_cast<unsigned long long>(m.dropped), static_cast<double>(m.unconverged) / steps,
      static_cast<double>(m.contacts_unconverged) / steps, static_cast<unsigned long long>(m.recovered),
      median(m.rods_us), median(m.refit_us));
  return text;
}

}  // namespace sinew::sample
