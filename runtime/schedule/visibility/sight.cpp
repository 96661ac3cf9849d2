// sight.cpp  see sight.hpp.
#include "schedule/visibility/sight.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/status.hpp"

namespace sinew::frame {
namespace {

using core::make_status;
using Eigen::Vector3d;

constexpr double kFarthest_m = 1e12;
constexpr float kHalfTurn_rad = 3.14159265f;

Status check_place(const double (&place_m)[3]) noexcept {
  for (const double x : place_m) {
    if (!std::isfinite(x))
      return make_status(StatusCode::kNotFinite, "view: position_m holds NaN or infinity");
    if (std::fabs(x) > kFarthest_m)
      return make_status(StatusCode::kInvalidArgument, "view: position_m %g lies beyond +-1e12 m", x);
  }
  return {};
}

Status check_edges(const View& view) noexcept {
  if (!(view.height_rad > 0 && view.height_rad < kHalfTurn_rad))
    return make_status(StatusCode::kInvalidArgument, "view: height_rad is %g; give an angle between 0 and pi",
                       static_cast<double>(view.height_rad));
  if (!(view.aspect > 0) || !std::isfinite(view.aspect))
    return make_status(StatusCode::kInvalidArgument, "view: aspect is %g; give width over height, above 0",
                       static_cast<double>(view.aspect));
  if (view.far_m > 0) return {};
  return make_status(StatusCode::kInvalidArgument, "view: far_m is %g; give metres above 0, or infinity",
                     static_cast<double>(view.far_m));
}

// Some balls from the eye, along the camera's axes: each loop over them is one that a compiler makes vectors
// of.
struct SeenBalls {
  static constexpr size_t kMost = 32;
  float side[kMost], up[kMost], depth[kMost], radius[kMost], away[kMost];

  SeenBalls(const Sight& sight, std::span<const Ball> balls) noexcept {
    float from_eye[3][kMost];
    for (size_t i = 0; i < balls.size(); ++i) {
      for (size_t axis = 0; axis < 3; ++axis)
        from_eye[axis][i] = static_cast<float>(balls[i].middle_m[axis] - sight.eye_m[axis]);
      radius[i] = balls[i].radius_m;
    }
    const auto along = [&](const float(&axis)[3], size_t i) {
      return axis[0] * from_eye[0][i] + axis[1] * from_eye[1][i] + axis[2] * from_eye[2][i];
    };
    for (size_t i = 0; i < balls.size(); ++i) {
      side[i] = along(sight.axes[0], i);
      up[i] = along(sight.axes[1], i);
      depth[i] = -along(sight.axes[2], i);
      away[i] = side[i] * side[i] + up[i] * up[i] + depth[i] * depth[i];
    }
    for (size_t i = 0; i < balls.size(); ++i) away[i] = std::sqrt(away[i]);
  }
};

// How far a ball lies beyond an edge of the view, above 0 where wholly: `across` of it lies along the edge's
// axis.
float beyond(float across, float depth, float half, float slant, float radius) noexcept {
  return std::fabs(across) - half * depth - radius * slant;
}

// Of as many as `sizes` has room for: the larger of what the ball takes and what is there already.
void enlarge(const Sight& sight, const SeenBalls& seen, std::span<float> sizes) noexcept {
  for (size_t i = 0; i < sizes.size(); ++i) {
    const float depth = seen.depth[i], radius = seen.radius[i], away = seen.away[i];
    const float behind = -radius - depth, far = depth - radius - sight.far_m;
    const float outside =
        std::max(std::max(behind, far),
                 std::max(beyond(seen.side[i], depth, sight.half_width, sight.slant_width, radius),
                          beyond(seen.up[i], depth, sight.half_height, sight.slant_height, radius)));
    const float shown = radius / (away * sight.half_height), part = shown < 1 ? shown : 1;
    const float in_view = outside > 0 ? 0 : part, size = away <= radius ? 1 : in_view;
    sizes[i] = sizes[i] > size ? sizes[i] : size;
  }
}

}  // namespace

Status make_sight(const View& view, Sight* out) noexcept {
  if (Status status = check_place(view.position_m); !status.ok()) return status;
  if (Status status = check_edges(view); !status.ok()) return status;
  const Eigen::Quaternionf turn = Eigen::Map<const Eigen::Quaternionf>(view.rotation_xyzw);
  if (!(turn.norm() > 1e-6f) || !std::isfinite(turn.norm()))
    return make_status(StatusCode::kInvalidArgument,
                       "view: rotation_xyzw is no rotation; the identity is 0 0 0 1");
  Sight made;
  std::copy_n(view.position_m, 3, made.eye_m);
  Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(&made.axes[0][0]) =
      turn.normalized().toRotationMatrix().transpose();
  made.half_height = std::tan(view.height_rad / 2);
  made.half_width = made.half_height * view.aspect;
  made.slant_width = std::sqrt(1 + made.half_width * made.half_width);
  made.slant_height = std::sqrt(1 + made.half_height * made.half_height);
  made.far_m = view.far_m;
  *out = made;
  return {};
}

float seen_size(const Sight& sight, const Ball& ball) noexcept {
  float size = 0;
  enlarge_seen_sizes(sight, {&ball, 1}, &size);
  return size;
}

void enlarge_seen_sizes(const Sight& sight, std::span<const Ball> balls, float* sizes) noexcept {
  for (; !balls.empty(); balls = balls.subspan(std::min(balls.size(), SeenBalls::kMost))) {
    const auto some = balls.first(std::min(balls.size(), SeenBalls::kMost));
    enlarge(sight, SeenBalls(sight, some), {sizes, some.size()});
    sizes += some.size();
  }
}

// A spiral by the golden angle over a disc, its radius by a sequence that never repeats.
void point_on(const Sight& sight, const Ball& ball, uint32_t number, double (&point_m)[3]) noexcept {
  constexpr double kGoldenAngle = 2.39996323, kGoldenShare = 0.61803398875;
  const Vector3d middle = Eigen::Map<const Vector3d>(ball.middle_m);
  const Vector3d back = (Eigen::Map<const Vector3d>(sight.eye_m) - middle).normalized();
  const Vector3d side = back.unitOrthogonal(), up = back.cross(side);
  const double angle = kGoldenAngle * number;
  const double share = kGoldenShare * number - std::floor(kGoldenShare * number);
  const double radius = static_cast<double>(ball.radius_m) * std::sqrt(share);
  Eigen::Map<Vector3d>{point_m} = middle + radius * (std::cos(angle) * side + std::sin(angle) * up);
}

}  // namespace sinew::frame
