// capsule_source.hpp  Contact sources of a few capsules and of a floor: what an engine's would be.
#pragma once
#include "rods/contacts/find/sweep.hpp"
#include "sinew/contact_source.hpp"
#include "tests/rods/contact_scenes.hpp"

namespace sinew::test {

// Capsules that do not turn, each at its place at the step's end.
class CapsuleSource : public ContactSource {
 public:
  explicit CapsuleSource(std::vector<rods::Capsule> capsules) : capsules_(std::move(capsules)) {}

  uint32_t find(std::span<const ContactProbe> probes, float dt_s,
                std::span<ContactHit> hits) noexcept override {
    uint32_t count = 0;
    for (uint32_t p = 0; p < probes.size(); ++p) {
      for (uint32_t c = 0; c < capsules_.size(); ++c) find(probes[p], p, c, dt_s, hits, &count);
    }
    return count;
  }

 private:
  static rods::Vector vector(const double (&v)[3]) { return {v[0], v[1], v[2]}; }

  void find(const ContactProbe& probe, uint32_t index, uint32_t c, float dt_s, std::span<ContactHit> hits,
            uint32_t* count) const {
    const rods::Capsule& capsule = capsules_[c];
    const auto radius = static_cast<double>(probe.radius_m);
    const rods::Sweep a = {{vector(probe.start_m[0]), vector(probe.start_m[1])},
                           {vector(probe.end_m[0]), vector(probe.end_m[1])},
                           radius};
    const rods::Vector move = rods::scaled(dt_s, rods::vector_of(capsule.motion.linear_m_s));
    const rods::Axis end = {vector(capsule.ends_m[0]), vector(capsule.ends_m[1])};
    const rods::Sweep b = {{rods::difference(end.from, move), rods::difference(end.to, move)},
                           end,
                           static_cast<double>(capsule.radius_m)};
    const rods::Touch touch = rods::first_touch(a, b, 256);  // small gaps are advanced through slowly
    const rods::Vector own = rods::difference(a.end.from, a.start.from);
    if (!(touch.gap_m < 0.5 * radius + 0.25 * rods::length(rods::difference(own, move)))) return;
    const rods::Vector apart = rods::difference(rods::between(a.start.from, a.start.to, touch.at.a),
                                                rods::between(b.start.from, b.start.to, touch.at.b));
    ContactHit hit = {.probe = index,
                      .along = static_cast<float>(2 * touch.at.a - 1),
                      .gap_m = rods::dot(apart, touch.normal) - a.radius_m - b.radius_m,
                      .friction = capsule.friction,
                      .restitution = capsule.restitution,
                      .name = c,
                      .body = c};
    for (size_t k = 0; k < 3; ++k) {
      hit.normal[k] = static_cast<float>(touch.normal[k]);
      hit.velocity_m_s[k] = capsule.motion.linear_m_s[k];
    }
    if (*count < hits.size()) hits[*count] = hit;
    ++*count;
  }

  std::vector<rods::Capsule> capsules_;
};

// Everything below y = 0; keeps what it was pushed with since `pushed` was last cleared.
class FloorSource : public ContactSource {
 public:
  FloorSource(float friction, const rods::Vector& velocity_m_s, float restitution = 0)
      : friction_(friction), restitution_(restitution), velocity_m_s_(velocity_m_s) {}

  uint32_t find(std::span<const ContactProbe> probes, float, std::span<ContactHit> hits) noexcept override {
    uint32_t count = 0;
    for (uint32_t p = 0; p < probes.size(); ++p) {
      for (uint32_t e = 0; e < 2; ++e) {
        ContactHit hit = {.probe = p,
                          .along = e == 0 ? -1.0f : 1.0f,
                          .gap_m = probes[p].start_m[e][1] - static_cast<double>(probes[p].radius_m),
                          .friction = friction_,
                          .restitution = restitution_,
                          .name = e};
        for (size_t k = 0; k < 3; ++k) hit.velocity_m_s[k] = static_cast<float>(velocity_m_s_[k]);
        if (count < hits.size()) hits[count] = hit;
        ++count;
      }
    }
    return count;
  }

  void push(const ContactHit&, const double (&point_m)[3], const float (&impulse_n_s)[3]) noexcept override {
    for (size_t k = 0; k < 3; ++k) pushed[k] += static_cast<double>(impulse_n_s[k]);
    lowest_m = std::min(lowest_m, point_m[1]);
    highest_m = std::max(highest_m, point_m[1]);
  }

  rods::Vector pushed = {};
  double lowest_m = 0, highest_m = 0;

 private:
  float friction_, restitution_;
  rods::Vector velocity_m_s_;
};

}  // namespace sinew::test
