// half_spaces.hpp  A contact source of walls, and one that answers nonsense.
#pragma once
#include <algorithm>
#include <limits>
#include <vector>

#include "sinew/contact_source.hpp"

namespace sinew::scenes {

// All space behind it is solid; pose and velocity as in sinew/contact_source.hpp.
struct Wall {
  double point_m[3];
  float normal[3];
  float velocity_m_s[3] = {0, 0, 0};
};

class HalfSpaces : public ContactSource {
 public:
  std::vector<Wall> walls;
  double near_m = 0.01;  // answered where a probe comes nearer

  uint32_t find(std::span<const ContactProbe> probes, float dt_s,
                std::span<ContactHit> hits) noexcept override {
    uint32_t count = 0;
    for (uint32_t p = 0; p < probes.size(); ++p) {
      for (const Wall& wall : walls) {
        for (int end = 0; end < 2; ++end) {
          const double radius = static_cast<double>(probes[p].radius_m);
          const double at_start = height(wall, probes[p].start_m[end], static_cast<double>(dt_s)) - radius;
          const double at_end = height(wall, probes[p].end_m[end], 0) - radius;
          if (!(std::min(at_start, at_end) < near_m)) continue;
          ContactHit hit{.probe = p, .along = end ? 1.0f : -1.0f, .gap_m = at_start};
          std::copy_n(wall.normal, 3, hit.normal);
          std::copy_n(wall.velocity_m_s, 3, hit.velocity_m_s);
          if (count++ < hits.size()) hits[count - 1] = hit;
        }
      }
    }
    return count;
  }

 private:
  // Over the wall as it was some time before the tick's end.
  static double height(const Wall& wall, const double (&point)[3], double before_s) {
    double sum = 0;
    for (int k = 0; k < 3; ++k)
      sum += static_cast<double>(wall.normal[k]) *
             (point[k] - wall.point_m[k] + before_s * static_cast<double>(wall.velocity_m_s[k]));
    return sum;
  }
};

// Everything that a hit may not be, one after the other.
class Nonsense : public ContactSource {
 public:
  uint32_t find(std::span<const ContactProbe> probes, float, std::span<ContactHit> hits) noexcept override {
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    std::vector<ContactHit> bad(11, ContactHit{.gap_m = -0.1});
    bad[0].probe = static_cast<uint32_t>(probes.size());
    bad[1].gap_m = static_cast<double>(nan);
    bad[2].normal[0] = nan;
    bad[3].normal[1] = 2;
    bad[4].velocity_m_s[2] = inf;
    bad[5].along = 1.5f;
    bad[6].friction = -1;
    bad[7].friction = inf;
    bad[8].restitution = 1.5f;
    bad[9].restitution = nan;
    bad[10].along = nan;
    std::copy_n(bad.begin(), std::min(bad.size(), hits.size()), hits.begin());
    return static_cast<uint32_t>(bad.size());
  }
};

}  // namespace sinew::scenes
