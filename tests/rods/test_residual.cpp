// test_residual.cpp  What a step says its equations miss by.
#include <catch2/catch.hpp>

#include "tests/rods/contact_scenes.hpp"

using namespace sinew;

namespace {

// One more step of a soft rod that has fallen for a while, with this many iterations.
struct Tried {
  rods::RodReport report;
  double stretch, error;  // of its own segment's length; from the step with all iterations, of the mean's
};

class Fallen {
 public:
  explicit Fallen(rods::RodStart start) : start_(start) {
    now_ = test::batch_of({rod_}, {.max_iterations = 50, .tolerance_rad = 1e-4f});
    for (int i = 0; i < 12; ++i) test::step(now_, 0.02f);
    converged_ = test::batch_of({rod_}, {.max_iterations = 50, .tolerance_rad = 1e-5f});
    REQUIRE(converged_.take_state(now_).ok());
    test::step(converged_, 0.02f);
  }
  Tried with(uint32_t iterations) const {
    test::RodBatch batch = test::batch_of(
        {rod_},
        {.start = start_, .max_iterations = iterations, .tolerance_rad = 1e-6f, .report_residual = true});
    REQUIRE(batch.take_state(now_).ok());
    const rods::RodReport report = test::step(batch, 0.02f);
    double error = 0;
    for (uint32_t i = 0; i < rod_.size(); ++i) {
      error = std::max(error, test::distance(batch.pose(0, i).position_m, converged_.pose(0, i).position_m));
    }
    return {report, test::largest_stretch(batch, rod_), error / static_cast<double>(rod_[0].length_m)};
  }

 private:
  test::Segments rod_ = test::straight_rod({.segments = 20, .young_pa = 1e5f});
  rods::RodStart start_;
  test::RodBatch now_, converged_;
};

// The same in double by constraints.hpp, of a first step from rest: d* is h^2 g there and q* the rest's.
struct Residuals {
  double miss = 0, momentum = 0;
};

Residuals plain_residuals(const test::RodBatch& batch, const test::Segments& rod, double dt_s) {
  const double l = static_cast<double>(rod[0].length_m), mass = rods::segment_inertia(rod[0]).mass_kg;
  const double square = dt_s * dt_s, gravity = 9.81;
  Residuals out;
  double force = mass * gravity * square / (mass * l);
  std::vector<std::array<double, 6>> g(rod.size());
  for (uint32_t i = 0; i < rod.size(); ++i) {
    const rods::SegmentPose pose = batch.pose(0, i);
    const rods::SegmentInertia inertia = rods::segment_inertia(rod[i]);
    const rods::Turn turn =
        rods::product(rods::conjugate(rods::turn_of(rod[i].orientation)), rods::turn_of(pose.orientation));
    for (size_t k = 0; k < 3; ++k) {
      const double falls = k == 1 ? -gravity * square : 0;
      g[i][k] = mass * (pose.position_m[k] - rod[i].position_m[k] - falls);
      g[i][3 + k] = 2 * turn[k] * (k == 2 ? inertia.axial_inertia_kg_m2 : inertia.inertia_kg_m2);
    }
  }
  for (uint32_t i = 1; i < rod.size(); ++i) {
    const rods::SegmentStart joint = batch.last_forces(0, i);
    const rods::JointCompliance soft = rods::joint_compliance(rod[i - 1], rod[i]);
    rods::Constraint stretch, bend;
    const double straight[3] = {};
    const rods::JointEnd a = test::joint_end(batch.pose(0, i - 1), l),
                         b = test::joint_end(batch.pose(0, i), l);
    REQUIRE(rods::stretch_shear(a, b, &stretch));
    REQUIRE(rods::bend_twist(a, b, straight, &bend));
    double gap = 0, angle = 0, pull = 0, moment = 0;
    for (int k = 0; k < 3; ++k) {
      const double f = square * static_cast<double>(joint.force_n[k]);
      const double t = square * static_cast<double>(joint.moment_nm[k]);
      const double compliance = (k == 2 ? soft.twist_rad_nm : soft.bend_rad_nm) / square;
      gap += std::pow(stretch.value[k] / l, 2);
      angle += std::pow(bend.value[k] + compliance * t, 2);
      pull += std::pow(f / (mass * l), 2);
      moment += std::pow(t / (mass * l * l), 2);
      for (size_t c = 0; c < 3; ++c) {
        g[i - 1][c] -= stretch.by_parent_position[k][c] * f;
        g[i][c] -= stretch.by_child_position[k][c] * f;
        g[i - 1][3 + c] -= stretch.by_parent_rotation[k][c] * f + bend.by_parent_rotation[k][c] * t;
        g[i][3 + c] -= stretch.by_child_rotation[k][c] * f + bend.by_child_rotation[k][c] * t;
      }
    }
    out.miss = std::max({out.miss, std::sqrt(gap), std::sqrt(angle)});
    force = std::max({force, std::sqrt(pull), std::sqrt(moment)});
  }
  for (uint32_t i = 1; i < rod.size(); ++i) {
    const double push = std::hypot(g[i][0], g[i][1], g[i][2]) / (mass * l);
    const double twist = std::hypot(g[i][3], g[i][4], g[i][5]) / (mass * l * l);
    out.momentum = std::max({out.momentum, push, twist});
  }
  out.momentum /= force;
  return out;
}

}  // namespace

TEST_CASE("the_residual_is_what_the_constraints_and_momentum_say_in_double") {
  for (const float young_pa : {1e3f, 1e6f, 1e9f}) {
    const test::Segments rod = test::straight_rod({.segments = 6, .young_pa = young_pa});
    // So large a tolerance that the forces of an unfinished iteration are kept.
    test::RodBatch batch = test::batch_of(
        {rod},
        {.start = rods::RodStart::kZero, .max_iterations = 1, .tolerance_rad = 1, .report_residual = true});
    const rods::RodReport report = test::step(batch, 0.1f);
    const Residuals plain = plain_residuals(batch, rod, 0.1);
    INFO("E " << young_pa << ", miss " << plain.miss << ", momentum " << plain.momentum);
    REQUIRE(report.unconverged == 0);
    CHECK(plain.miss > 1e-4);
    CHECK(static_cast<double>(report.residual) ==
          Approx(std::max(plain.miss, plain.momentum)).epsilon(1e-3));  // floats against doubles
  }
}

TEST_CASE("a_residual_is_reported_only_where_it_is_asked_for") {
  test::RodBatch batch = test::batch_of({test::straight_rod({})}, {.max_iterations = 1});
  for (int i = 0; i < 5; ++i) CHECK(test::step(batch, 0.02f).residual == 0);
}

TEST_CASE("asking_for_the_residual_changes_no_step") {
  test::RodBatch asked = test::batch_of({test::helix(20)}, {.report_residual = true});
  test::RodBatch plain = test::batch_of({test::helix(20)});
  for (int i = 0; i < 30; ++i) {
    CHECK(test::step(asked, 0.02f).residual > 0);
    test::step(plain, 0.02f);
    for (uint32_t k = 0; k < 20; ++k) {
      CHECK(test::distance(asked.pose(0, k).position_m, plain.pose(0, k).position_m) == 0);
    }
  }
}

TEST_CASE("the_residual_falls_with_iterations_and_never_hides_a_stretch_or_an_error") {
  const auto start = GENERATE(rods::RodStart::kZero, rods::RodStart::kPrevious);
  const Fallen fallen(start);
  double first = 0, before = HUGE_VAL;
  for (const uint32_t k : {1u, 2u, 3u, 5u, 12u}) {
    const Tried tried = fallen.with(k);
    const double residual = static_cast<double>(tried.report.residual);
    if (k == 1) first = residual;
    INFO(k << " iterations: residual " << residual << ", stretch " << tried.stretch << ", error "
           << tried.error);
    // What the last iterations leave is rounding: 1e-6, here and in stretch.
    CHECK(residual < std::max(1.01 * before, 2e-6));
    CHECK(tried.stretch < 1.01 * residual + 1e-6);
    // Errors add up along the rod, over 20 segments.
    CHECK(tried.error < 20 * residual + 1e-5);
    before = residual;
  }
  CHECK(first > 1e-4);
  CHECK(before < 3e-6);
}

TEST_CASE("a_body_in_free_fall_leaves_no_residual") {
  const test::Segments rod = test::straight_rod({.held = false});
  test::RodBatch batch = test::batch_of({rod}, {.max_iterations = 1, .report_residual = true});
  for (int i = 0; i < 10; ++i) CHECK(test::step(batch, 0.02f).residual < 1e-6f);  // rounding
}

TEST_CASE("the_residual_of_a_rod_at_rest_on_a_plane_balances_its_weight_with_the_planes_force") {
  const uint32_t strands = GENERATE(1u, 5u);  // narrow and wide groups
  const std::vector<test::Segments> rods(strands, test::lying_rod(0.01));
  // Alone, a step's fall is a momentum of its weight: the plane's part is all that can make it small.
  test::RodBatch batch =
      test::batch_of(rods, {.max_iterations = 100, .tolerance_rad = 1e-6f, .report_residual = true});
  rods::RodCollider collider = test::collider_of(batch, {.rods_collide = false, .tolerance = 1e-4f});
  const rods::Plane floor;
  REQUIRE(collider.set_planes({&floor, 1}).ok());
  rods::RodReport report;
  for (int i = 0; i < 20; ++i) report = test::step(batch, collider);
  INFO("residual " << report.residual << ", penetration " << report.deepest_penetration);
  CHECK(report.contacts >= 2 * strands);
  CHECK(report.contacts_unconverged == 0);
  CHECK(report.deepest_penetration < 4e-4f);  // twice the tolerance is left alone, and once it is the error
  // Without the plane's forces 1.5. Orientations round to 6e-8, at half a length, times a gain of 1e3 masses,
  // over a step's fall of 2.7e-2 lengths: 1e-3 at each end.
  CHECK(report.residual < 5e-3f);
}
