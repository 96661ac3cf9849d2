// rigid_motion.cpp  Sums of sines of a time that runs in bouts.
#include "baker/patches/rigid_motion.hpp"

#include <algorithm>
#include <cmath>

#include "baker/common/smooth_step.hpp"

namespace sinew::baker {
namespace {

constexpr int kSines = 3;

struct Sines {
  Vector3 along[kSines];
  double rad[kSines], phase[kSines];
  Vector3 at(double t) const {
    Vector3 sum = Vector3::Zero();
    for (int k = 0; k < kSines; ++k) sum += along[k] * (std::sin(rad[k] * t + phase[k]) - std::sin(phase[k]));
    return sum;
  }
};

Sines draw_sines(double acceleration, double most, const Liveliness& how, Random& random) {
  Sines sines{};
  for (int k = 0; k < kSines; ++k) {
    sines.rad[k] = how.least_rad * std::pow(how.most_rad / how.least_rad, random.uniform(0, 1));
    sines.phase[k] = random.uniform(0, kTau);
    sines.along[k] =
        random.direction() * std::min(most, acceleration / (kSines * sines.rad[k] * sines.rad[k]));
  }
  return sines;
}

// How fast time runs, 0 in a rest, step by step.
std::vector<double> draw_bouts(uint32_t ticks, uint32_t steps_a_tick, Random& random) {
  std::vector<double> speed;
  const size_t wanted = size_t{ticks} * steps_a_tick;
  const auto run = [&](double for_ticks, auto speed_at) {
    const auto steps = static_cast<size_t>(std::ceil(for_ticks * steps_a_tick));
    for (size_t s = 0; s < steps; ++s)
      speed.push_back(speed_at(static_cast<double>(s) / static_cast<double>(steps)));
  };
  run(2, [](double) { return 0.0; });
  while (speed.size() < wanted) {
    const double rise = random.uniform(2, 12), fall = random.uniform(1, 8);
    run(rise, [](double s) { return smooth_step(0, 1, s); });
    run(random.uniform(20, 80), [](double) { return 1.0; });
    run(fall, [](double s) { return 1 - smooth_step(0, 1, s); });
    run(random.chance(0.3) ? 0 : random.uniform(5, 40), [](double) { return 0.0; });
  }
  speed.resize(wanted);
  return speed;
}

Eigen::Matrix3d rotation(const Vector3& v) {
  const double angle = v.norm();
  if (angle == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, v / angle).toRotationMatrix();
}

}  // namespace

std::vector<RigidPose> random_rigid_motion(const Liveliness& how, uint32_t ticks, uint32_t steps_a_tick,
                                           Random& random) {
  constexpr double kMostTurn = 1.2, kAnywhere = 1e4;  // rad, cells: of one sine
  const double turning = random.uniform(0, 1), swinging = random.uniform(0.3, 1);
  const Sines place = draw_sines(swinging * how.acceleration, kAnywhere, how, random),
              turn = draw_sines(turning * how.acceleration / how.reach, kMostTurn, how, random);
  std::vector<RigidPose> poses = {RigidPose{}};
  double time = 0;
  for (const double speed : draw_bouts(ticks, steps_a_tick, random)) {
    time += speed / steps_a_tick;
    poses.push_back({place.at(time), rotation(turn.at(time))});
  }
  return poses;
}

}  // namespace sinew::baker
