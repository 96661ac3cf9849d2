// bust.hpp  Head, neck, shoulders and upper arms of a character, closed, and how its skin turns.
#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "baker/creature/body_field.hpp"

namespace sinew::sample {

struct Turning {
  double chest_rad = 0, head_rad = 0;  // about the vertical; the head's is its own, not added
};

// About a bone, in the bind pose.
struct BustProxy {
  Eigen::Vector3d from, to;
  double radius_m;
  double head_share;  // of the way from the chest's turn to the head's
};

struct Bust {
  baker::BodyField field;  // of the bind pose
  std::vector<Eigen::Vector3d> rest_m;
  std::vector<std::array<uint32_t, 3>> triangles;  // counter-clockwise from outside

  std::vector<BustProxy> proxies;  // fitted to what of the skin is nearest to each bone

  // Skinned: the neck's turn goes from the chest's to the head's with height.
  std::vector<float> places(const Turning& turning) const;
};

// At a place of the bind pose: how far it turns from the chest's way to the head's.
double turn_share(const Eigen::Vector3d& p);

// About so many vertices, at least 200.
Bust make_bust(size_t vertices);

// The head looks over one shoulder, then over the other, ever less alike; nothing moves at 0 s.
Turning turning_at(double time_s);

}  // namespace sinew::sample
