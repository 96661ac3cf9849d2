// scenes.cpp  see scenes.hpp.
#include "samples/contacts/scenes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace sinew::sample {
namespace {

using Eigen::Vector3d;

// From 0 to 1 while t goes from a to b, at rest at both ends.
double rise(double t, double a, double b) {
  const double s = std::clamp((t - a) / (b - a), 0.0, 1.0);
  return s * s * s * (10 - 15 * s + 6 * s * s);
}

std::function<Vector3d(double)> still(const Vector3d& at) {
  return [at](double) { return at; };
}

const render::Rgb kWood = {0.55f, 0.38f, 0.22f}, kWall = {0.45f, 0.5f, 0.58f};

}  // namespace

ContactScene onto_a_crate() {
  constexpr double kLeap_s = 0.5, kLanded_s = 1.1, kTurn_rad = 1.45;
  constexpr double kTop_m = 0.36, kBelly_m = 0.31, kFront_m = 0.205, kPress_m = 0.04;
  const Vector3d half(0.16, kTop_m / 2, 0.15), crate(0, kTop_m / 2, 0.6);
  // Lying, the belly's front is kFront_m - kPress_m over the crate, its middle over the crate's.
  const auto root = [=](double t) {
    const double turn = kTurn_rad * rise(t, kLeap_s, kLanded_s);
    const double up = rise(t, kLeap_s, kLanded_s),
                 s = std::clamp((t - kLeap_s) / (kLanded_s - kLeap_s), 0.0, 1.0);
    const Eigen::Quaterniond q(Eigen::AngleAxisd(turn, Vector3d::UnitX()));
    const Vector3d lying = crate + Vector3d(0, kTop_m / 2 + kFront_m - kPress_m, 0) -
                           Eigen::AngleAxisd(kTurn_rad, Vector3d::UnitX()) * Vector3d(0, kBelly_m, 0);
    const Vector3d place = up * lying + Vector3d(0, 0.35 * 4 * s * (1 - s), 0);
    RootTransform out;
    std::copy_n(place.data(), 3, out.position_m);
    for (int k = 0; k < 4; ++k) out.rotation_xyzw[k] = static_cast<float>(q.coeffs()[k]);
    return out;
  };
  return {.name = "crate",
          .title = "Onto a crate",
          .boxes = {{half, still(crate), kWood}},
          .root = root,
          .seconds = 5,
          .moments_s = {0.4, 0.85, 1.1, 1.2, 4.9},
          .rest_from_s = 4,
          .view = {.yaw_deg = 62, .pitch_deg = 12}};
}

ContactScene between_walls() {
  constexpr double kClose_s = 0.3, kClosed_s = 1.3, kOpen_s = 4, kOpened_s = 4.4;
  const Vector3d half(0.45, 0.3, 0.1);
  // Closed, the front one is 5 cm into the belly, the other 10 cm into the tail.
  const auto wall = [=](double open_z, double closed_z) {
    return [=](double t) {
      const double closed = rise(t, kClose_s, kClosed_s) - rise(t, kOpen_s, kOpened_s);
      return Vector3d(0, 0.3, open_z + closed * (closed_z - open_z));
    };
  };
  return {.name = "walls",
          .title = "Between two walls",
          .boxes = {{half, wall(0.5, 0.155 + 0.1), kWall}, {half, wall(-0.95, -0.55 - 0.1), kWall}},
          .root = [](double) { return RootTransform{}; },
          .seconds = 5.5,
          .moments_s = {0.2, 0.9, 3.9, 4.25, 4.45},
          .rest_from_s = 3,
          .view = {.yaw_deg = 80, .pitch_deg = 14}};
}

}  // namespace sinew::sample
