// test_sight.cpp  What a view shows of a ball.
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "schedule/visibility/sight.hpp"

using namespace sinew;
using namespace sinew::frame;
using Eigen::Vector3d;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                kInfinity = std::numeric_limits<float>::infinity();

Sight sight_of(const View& view) {
  Sight sight;
  REQUIRE(make_sight(view, &sight).ok());
  return sight;
}

// Ahead along -Z, 1 rad high, twice as wide.
View ahead() { return {.aspect = 2}; }

}  // namespace

TEST_CASE("a_view_outside_its_ranges_is_refused_with_its_reason") {
  std::vector<View> bad(9);
  bad[0].position_m[1] = std::nan("");
  bad[1].position_m[1] = 2e12;
  bad[2].rotation_xyzw[3] = 0;
  bad[3].rotation_xyzw[0] = kNan;
  bad[4].height_rad = 0;
  bad[5].height_rad = 3.15f;
  bad[6].aspect = kInfinity;
  bad[7].aspect = -1;
  bad[8].far_m = 0;
  for (const View& view : bad) {
    Sight sight{.far_m = 7};
    const Status status = make_sight(view, &sight);
    INFO(status.message);
    CHECK_FALSE(status.ok());
    CHECK(sight.far_m == 7);
  }
}

TEST_CASE("a_ball_is_seen_ahead_and_neither_behind_nor_beside_nor_beyond") {
  View view = ahead();
  view.far_m = 100;
  const Sight sight = sight_of(view);
  const auto size = [&](double x, double y, double z) { return seen_size(sight, {{x, y, z}, 1}); };
  CHECK(size(0, 0, -10) > 0);
  CHECK(size(0, 0, 10) == 0);
  CHECK(size(0, 0, -102) == 0);
  CHECK(size(0, 0, -100.5) > 0);
  // The upper edge rises by tan 0.5 a metre, and the ball's radius reaches 1 / cos 0.5 beyond it.
  const double edge = 10 * std::tan(0.5), reach = 1 / std::cos(0.5);
  CHECK(size(0, edge + 0.99 * reach, -10) > 0);
  CHECK(size(0, edge + 1.01 * reach, -10) == 0);
  CHECK(size(2 * edge, 0, -10) > 0);
  CHECK(size(4 * edge, 0, -10) == 0);
}

TEST_CASE("a_ball_s_size_is_its_share_of_the_view_s_height") {
  const Sight sight = sight_of(ahead());
  CHECK(seen_size(sight, {{0, 0, -10}, 1}) == Approx(1 / (10 * std::tan(0.5))));
  CHECK(seen_size(sight, {{0, 0, -20}, 1}) == Approx(seen_size(sight, {{0, 0, -10}, 1}) / 2));
  CHECK(seen_size(sight, {{0, 0, -1.1}, 1}) == 1);  // more than all of it
  CHECK(seen_size(sight, {{0, 0, 0.5}, 1}) == 1);   // the eye is inside, looking away
}

TEST_CASE("an_eye_in_a_ball_s_very_middle_sees_all_of_it_and_no_more_than_the_view") {
  for (const float height_rad : {1e-6f, 0.01f, 1.0f, 3.1415f}) {
    View view{.height_rad = height_rad, .far_m = 1e-6f};
    view.position_m[0] = 3;
    for (const float radius_m : {0.0f, 1.0f, 1e30f})
      CHECK(seen_size(sight_of(view), {{3, 0, 0}, radius_m}) == 1);
  }
}

TEST_CASE("a_ball_with_a_point_in_view_is_never_taken_for_outside") {
  std::mt19937 engine(5);
  std::normal_distribution<double> normal;
  int shown = 0;
  for (int i = 0; i < 2000; ++i) {
    View view{.height_rad = 0.3f + static_cast<float>(std::fabs(normal(engine))) / 2, .aspect = 1.5f};
    Eigen::Quaternionf turn(Eigen::Vector4f::Random());
    Eigen::Map<Eigen::Vector4f>(view.rotation_xyzw) = turn.coeffs();
    Eigen::Map<Vector3d>{view.position_m} = Vector3d(normal(engine), normal(engine), normal(engine)) * 1e4;
    if (view.height_rad > 3) continue;
    const Vector3d away = Vector3d(normal(engine), normal(engine), normal(engine)) * 5;
    Ball ball{.radius_m = 2};
    Eigen::Map<Vector3d>{ball.middle_m} = Eigen::Map<Vector3d>(view.position_m) + away;
    const Vector3d point =
        away + Vector3d(normal(engine), normal(engine), normal(engine)).normalized() * 1.99;
    const Vector3d at = turn.normalized().conjugate().cast<double>() * point;
    const double high = std::tan(static_cast<double>(view.height_rad) / 2) * -at.z();
    if (at.z() >= 0 || std::fabs(at.y()) > high || std::fabs(at.x()) > 1.5 * high) continue;
    ++shown;
    CHECK(seen_size(sight_of(view), ball) > 0);
  }
  CHECK(shown > 100);
}

TEST_CASE("points_of_a_ball_lie_on_its_disc_and_all_over_it") {
  const Sight sight = sight_of(ahead());
  const Ball ball{{3, 4, -12}, 2};
  const Vector3d middle = Eigen::Map<const Vector3d>(ball.middle_m);
  int quadrants[4] = {}, outer = 0;
  for (uint32_t n = 0; n < 400; ++n) {
    double point[3];
    point_on(sight, ball, n, point);
    const Vector3d off = Eigen::Map<Vector3d>(point) - middle;
    CHECK(off.norm() <= 2);
    CHECK(std::fabs(off.dot(middle.normalized())) < 1e-9);
    const Vector3d side = middle.normalized().unitOrthogonal(), up = middle.normalized().cross(side);
    ++quadrants[(off.dot(side) > 0) + 2 * (off.dot(up) > 0)];
    outer += off.norm() > std::sqrt(2.0);  // half of the area
  }
  for (const int count : quadrants) CHECK(std::abs(count - 100) < 15);
  CHECK(std::abs(outer - 200) < 20);
}
