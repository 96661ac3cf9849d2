// fem.cpp  Steps: what is refused, energy, momentum, damping, and that shortcuts of the solver do not show.
#include "baker/truth/fem/fem.hpp"

#include <catch2/catch.hpp>

#include "baker/common/bad_input.hpp"
#include "tests/baker/truth/bodies.hpp"

using namespace sinew::baker;
using sinew::test::Body;
using sinew::test::box_body;

namespace {

bool left_end(const Vector3& p) { return p.x() == 0; }
bool nowhere(const Vector3&) { return false; }

FemMaterial rubber(Elasticity elasticity = Elasticity::kNeoHookean) {
  FemMaterial m;
  m.elasticity = elasticity;
  m.young_pa = {2e5};
  m.poisson_ratio = 0.3;
  return m;
}

Fem beam(const FemMaterial& material) {
  const Body body = box_body({6, 2, 2}, 0.05);
  return Fem(body.nodes, body.tetrahedra, body.held(left_end), material);
}

Eigen::VectorXd gravity(const Fem& fem, const Vector3& g) {
  Eigen::VectorXd force(fem.positions.size());
  for (Eigen::Index i = 0; i < fem.mass.size(); ++i) force.segment<3>(3 * i) = fem.mass[i] * g;
  return force;
}

double energy(const Fem& fem) { return fem.elastic_energy() + fem.kinetic_energy(); }

Vector3 linear_momentum(const Fem& fem) {
  Vector3 sum = Vector3::Zero();
  for (Eigen::Index i = 0; i < fem.mass.size(); ++i) sum += fem.mass[i] * fem.velocities.segment<3>(3 * i);
  return sum;
}

Vector3 angular_momentum(const Fem& fem) {
  Vector3 sum = Vector3::Zero();
  for (Eigen::Index i = 0; i < fem.mass.size(); ++i)
    sum += fem.mass[i] *
           Vector3(fem.positions.segment<3>(3 * i)).cross(Vector3(fem.velocities.segment<3>(3 * i)));
  return sum;
}

// A free block that flies, spins and rings.
Fem thrown() {
  const Body body = box_body({3, 2, 2}, 0.1);
  Fem fem(body.nodes, body.tetrahedra, body.held(nowhere), rubber());
  for (Eigen::Index i = 0; i < fem.mass.size(); ++i) {
    const Vector3 p = fem.positions.segment<3>(3 * i);
    fem.velocities.segment<3>(3 * i) =
        Vector3(1, 2, -3) + Vector3(0, 4, 2).cross(p) + 2 * Vector3(p.x(), -p.y(), 0);
  }
  return fem;
}

}  // namespace

TEST_CASE("fem_refuses_bad_meshes_and_materials_by_name") {
  const Body good = box_body({1, 1, 1}, 1);
  const std::vector<bool> none = good.held(nowhere);
  const auto refused = [&](const Body& body, const std::vector<bool>& held, const FemMaterial& m,
                           const std::string& why) {
    REQUIRE_THROWS_AS(Fem(body.nodes, body.tetrahedra, held, m), BadInput);
    REQUIRE_THROWS_WITH(Fem(body.nodes, body.tetrahedra, held, m), Catch::Contains(why));
  };
  refused(good, {true}, rubber(), "1 constraint flags for 8 nodes");
  Body body = good;
  body.tetrahedra[2][1] = 8;
  refused(body, none, rubber(), "tetrahedron 2 names node 8 of 8");
  body = good;
  std::swap(body.tetrahedra[3][0], body.tetrahedra[3][1]);
  refused(body, none, rubber(), "tetrahedron 3 is flat or inverted");
  body = good;
  body.nodes.push_back(Vector3::Zero());
  std::vector<bool> one_more = none;
  one_more.push_back(false);
  refused(body, one_more, rubber(), "free node 8 belongs to no tetrahedron");
  FemMaterial m = rubber();
  m.young_pa = {1, 2};
  refused(good, none, m, "2 values of young_pa for 5 tetrahedra");
  m.young_pa = {1, 1, -1, 1, 1};
  refused(good, none, m, "young_pa of tetrahedron 2");
  m = rubber();
  m.fill = {0};
  refused(good, none, m, "fill of tetrahedron 0");
  m = rubber();
  m.poisson_ratio = 0.5;
  refused(good, none, m, "poisson_ratio");
  m = rubber();
  m.density_kg_m3 = std::nan("");
  refused(good, none, m, "density");
  m = rubber();
  m.rayleigh_stiffness_s = -1;
  refused(good, none, m, "Rayleigh");
}

TEST_CASE("fem_refuses_bad_steps") {
  Fem fem = beam(rubber());
  const Eigen::VectorXd x = fem.positions, none = Eigen::VectorXd::Zero(x.size());
  REQUIRE_THROWS_AS(fem.step(0, x, none), BadInput);
  REQUIRE_THROWS_AS(fem.step(0.01, x.head(3), none), BadInput);
  REQUIRE_THROWS_AS(fem.step(0.01, x, none.head(3)), BadInput);
  REQUIRE_THROWS_AS(fem.settle(none.head(3)), BadInput);
  REQUIRE_THROWS_AS(fem.damp(-0.1), BadInput);
  REQUIRE_THROWS_WITH(thrown().settle(Eigen::VectorXd::Zero(3 * thrown().mass.size())),
                      Catch::Contains("no static equilibrium"));
  CHECK(fem.positions == x);
}

TEST_CASE("constrained_nodes_are_exactly_where_they_are_told") {
  Fem fem = beam(rubber());
  const Body body = box_body({6, 2, 2}, 0.05);
  const Eigen::VectorXd target = body.flat().array() + 0.0123;
  fem.step(0.01, target, gravity(fem, {0, -9.8, 0}));
  for (size_t i = 0; i < body.nodes.size(); ++i)
    if (left_end(body.nodes[i])) {
      const auto at = 3 * static_cast<Eigen::Index>(i);
      CHECK(fem.positions.segment<3>(at) == target.segment<3>(at));
    }
}

TEST_CASE("a_step_of_endless_length_is_the_static_equilibrium") {
  constexpr double kAgree = 1e-5;  // inertia is left with a share of about 1 / (w dt)^2
  for (const Elasticity elasticity :
       {Elasticity::kLinear, Elasticity::kCorotational, Elasticity::kNeoHookean}) {
    Fem still = beam(rubber(elasticity)), slow = beam(rubber(elasticity));
    const Eigen::VectorXd force = gravity(still, {0, -9.8, 0}), rest = still.positions;
    still.settle(force);
    for (int i = 0; i < 3; ++i) slow.step(1e3, rest, force, 1e-8);
    CHECK((still.positions - rest).norm() > 1e-2 * rest.norm());  // it does sag
    CHECK((slow.positions - still.positions).norm() < kAgree * (still.positions - rest).norm());
  }
}

TEST_CASE("free_linear_vibration_loses_what_bdf2_predicts") {
  constexpr double kSwung = 0.3, kWithin = 0.1;  // (w dt)^2: the next term of the loss, and higher modes
  constexpr int kSteps = 200;
  Fem fem = beam(rubber(Elasticity::kLinear));
  const Eigen::VectorXd rest = fem.positions, none = Eigen::VectorXd::Zero(rest.size());
  fem.settle(gravity(fem, {0, -0.1, 0}), 1e-10);
  const double dt = kSwung / (2 * M_PI * fem.frequencies_hz(1)[0]);
  for (int i = 0; i < 20; ++i) fem.step(dt, rest, none, 1e-10);  // until the first step is forgotten
  const auto mean_energy = [&] {
    double sum = 0;
    for (int i = 0; i < 21; ++i, fem.step(dt, rest, none, 1e-10)) sum += energy(fem) / 21;  // a period
    return sum;
  };
  const double before = mean_energy();
  for (int i = 0; i < kSteps - 21; ++i) fem.step(dt, rest, none, 1e-10);
  const double lost = std::log(before / mean_energy());
  CHECK(lost == Approx(0.5 * std::pow(kSwung, 4) * kSteps).epsilon(2 * kWithin));
}

// Its energy in BDF2's own norm never grows; kinetic and elastic energy alternate within a swing, by a share
// of (w dt)^2.
TEST_CASE("free_neo_hookean_vibration_gains_no_energy") {
  constexpr double kWithinASwing = 0.01;
  Fem fem = beam(rubber());
  const Eigen::VectorXd rest = fem.positions, none = Eigen::VectorXd::Zero(rest.size());
  fem.settle(gravity(fem, {0, -30, 0}));
  double least = energy(fem);
  for (int i = 0; i < 400; ++i) {
    fem.step(2e-3, rest, none, 1e-8);
    CHECK(energy(fem) <= least * (1 + kWithinASwing));
    least = std::min(least, energy(fem));
  }
}

TEST_CASE("a_thrown_body_keeps_its_linear_momentum") {
  constexpr double kKept = 1e-9;  // as a share: what the tolerance below leaves
  Fem fem = thrown();
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(fem.positions.size());
  const Vector3 start = linear_momentum(fem);
  for (int i = 0; i < 100; ++i) fem.step(5e-3, none, none, 1e-9);
  CHECK((linear_momentum(fem) - start).norm() < kKept * start.norm());
}

TEST_CASE("a_thrown_bodys_angular_momentum_drifts_with_the_step_only") {
  const auto drift = [](double dt) {
    Fem fem = thrown();
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(fem.positions.size());
    const Vector3 start = angular_momentum(fem);
    for (double t = 0; t < 0.2 - dt / 2; t += dt) fem.step(dt, none, none, 1e-9);
    return (angular_momentum(fem) - start).norm() / start.norm();
  };
  const double coarse = drift(2e-3), fine = drift(1e-3);
  CHECK(coarse < 0.003);
  CHECK(fine / coarse < 0.4);  // a quarter, but for the first step
}

TEST_CASE("damping_is_the_ratio_asked_for_at_the_first_mode") {
  constexpr double kRatio = 0.1, kDt = 5e-4, kWithin = 0.05;
  Fem fem = beam(rubber(Elasticity::kLinear));
  const double w = 2 * M_PI * fem.frequencies_hz(1)[0];
  fem.damp(kRatio);
  const Eigen::VectorXd rest = fem.positions, none = Eigen::VectorXd::Zero(rest.size());
  fem.settle(gravity(fem, {0, -0.1, 0}), 1e-10);
  const double start = energy(fem), periods = 3;
  const int steps = static_cast<int>(periods * 2 * M_PI / w / std::sqrt(1 - kRatio * kRatio) / kDt);
  for (int i = 0; i < steps; ++i) fem.step(kDt, rest, none, 1e-10);
  const double ratio = std::log(start / energy(fem)) / (2 * w * kDt * steps);
  CHECK(ratio == Approx(kRatio).epsilon(kWithin));
}

TEST_CASE("a_body_that_follows_a_turning_motion_is_not_damped_against_the_world") {
  Fem fem = beam(rubber());
  fem.damp(0.5);
  const Eigen::VectorXd rest = fem.positions, none = Eigen::VectorXd::Zero(rest.size());
  const auto turned = [&](double angle) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Vector3::UnitZ()).toRotationMatrix();
    Eigen::VectorXd x = rest;
    for (Eigen::Index i = 0; i < x.size(); i += 3)
      x.segment<3>(i) = turn * rest.segment<3>(i) + 0.05 * angle * Vector3(0, 1, 0);
    return x;
  };
  // Started at the motion's own pace, with the centripetal force that the motion takes, there is nothing left
  // to damp.
  constexpr double kDt = 1e-3, kPace = 0.01;
  fem.reset(turned(0));
  Eigen::VectorXd speed = (turned(0) - turned(-kPace)) / kDt, speed_before = speed;
  fem.velocities = speed;
  UndisturbedMotion motion{turned(0), {}, std::vector<Eigen::Matrix3d>(static_cast<size_t>(fem.mass.size()))};
  double largest = 0;
  for (int i = 1; i <= 50; ++i) {
    motion.before = turned((i - 1) * kPace);
    motion.after = turned(i * kPace);
    for (auto& turn : motion.turn) turn = Eigen::AngleAxisd(kPace, Vector3::UnitZ()).toRotationMatrix();
    const double h = i == 1 ? kDt : kDt * 2 / 3, share = i == 1 ? 0 : 1.0 / 3;
    const auto from = [&](const Eigen::VectorXd& last, const Eigen::VectorXd& before) -> Eigen::VectorXd {
      return last + share * (last - before);
    };
    const Eigen::VectorXd v = (motion.after - from(turned((i - 1) * kPace), turned((i - 2) * kPace))) / h;
    Eigen::VectorXd force = (v - from(speed, speed_before)) / h;
    speed_before = speed;
    speed = v;
    for (Eigen::Index k = 0; k < fem.mass.size(); ++k) force.segment<3>(3 * k) *= fem.mass[k];
    fem.step(kDt, motion.after, force, 1e-9, &motion);
    largest = std::max(largest, (fem.positions - motion.after).cwiseAbs().maxCoeff());
  }
  CHECK(largest < 1e-9);
}

TEST_CASE("a_reshaped_body_is_unstressed_in_its_new_shape") {
  const auto distorted = [](const Fem& fem, double squeeze) {
    Eigen::VectorXd x = fem.positions;
    for (Eigen::Index i = 0; i < x.size(); i += 3) {
      const Vector3 p = x.segment<3>(i);
      x.segment<3>(i) = Vector3(1.3 * p.x(), squeeze * p.y() + 2 * p.x() * p.x(), p.z() + 0.4 * p.y());
    }
    return x;
  };
  Fem fem = beam(rubber());
  const Eigen::VectorXd bent = distorted(fem, 0.8), flattened = distorted(fem, 0);
  CHECK(fem.elastic_force(bent).norm() > 1);
  fem.reshape(bent);
  CHECK(fem.elastic_force(bent).norm() < 1e-9);
  CHECK(std::abs(fem.elastic_energy(bent)) < 1e-9);
  CHECK(fem.frequencies_hz(1)[0] > 0);
  fem.reshape(flattened);
  CHECK(fem.elastic_force(flattened).norm() < 1e-9);
}

TEST_CASE("the_unstressed_shape_follows_the_undisturbed_motion") {
  Fem fem = beam(rubber());
  const Eigen::VectorXd rest = fem.positions, none = Eigen::VectorXd::Zero(rest.size());
  UndisturbedMotion motion{rest, 1.2 * rest, {}};
  motion.turn.assign(static_cast<size_t>(fem.mass.size()), Eigen::Matrix3d::Identity());
  fem.step(1e-3, motion.after, none, 1e-9, &motion);
  CHECK(fem.elastic_force(motion.after).norm() < 1e-9);
  CHECK(fem.elastic_force(rest).norm() > 1);
}

TEST_CASE("kept_factorisations_do_not_change_the_result") {
  // The same steps twice: of a body that has been bent and shaken before, and keeps that factorisation.
  Fem used = beam(rubber()), fresh = beam(rubber());
  const Eigen::VectorXd rest = used.positions, force = gravity(used, {0, -9.8, 3});
  for (int i = 0; i < 30; ++i) used.step(5e-3, rest, 3 * gravity(used, {0, 9.8, -9.8}), 1e-10);
  const long before = used.factorizations();
  used.reset(rest);
  for (int i = 0; i < 30; ++i) {
    used.step(5e-3, rest, force, 1e-10);
    fresh.step(5e-3, rest, force, 1e-10);
  }
  CHECK(used.factorizations() - before < 5);
  CHECK(fresh.factorizations() < 10);
  CHECK((used.positions - fresh.positions).cwiseAbs().maxCoeff() < 1e-9);
}

namespace {

// One tetrahedron, held by its base. Skinning carries its tip through the base and squeezes it from a side,
// so that its two mirrored stretches cross: the rotation nearest to it there jumps by half a turn.
Body tetrahedron() {
  Body body;
  body.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  body.tetrahedra = {{0, 1, 2, 3}};
  return body;
}

Eigen::VectorXd turned_inside_out(double t) {
  Eigen::VectorXd x = tetrahedron().flat();
  x[7] = 1 - 0.7 * t * t;
  x[11] = 1 - 2 * t;
  x[8] = 0.002;
  return x;
}

}  // namespace

TEST_CASE("a_displaced_element_feels_no_jump_while_skinning_turns_it_inside_out") {
  const Body body = tetrahedron();
  const std::vector<bool> held = {true, true, true, false};
  constexpr int kSteps = 400;
  const Vector3 aside(0.05, -0.03, 0.04);
  Fem fem(body.nodes, body.tetrahedra, held, rubber());
  const auto force_at = [&](const Eigen::VectorXd& skinned) {
    Eigen::VectorXd x = skinned;
    x.tail<3>() += aside;
    return Vector3(fem.elastic_force(x).tail<3>());
  };
  const double at_rest = force_at(body.flat()).norm();
  UndisturbedMotion motion{body.flat(), {}, std::vector<Eigen::Matrix3d>(4, Eigen::Matrix3d::Identity())};
  Vector3 before = force_at(body.flat());
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(12);
  for (int i = 1; i <= kSteps; ++i) {
    motion.after = turned_inside_out(static_cast<double>(i) / kSteps);
    fem.step(1.0 / 240, motion.after, none, 1e-9, &motion);
    motion.before = motion.after;
    const Vector3 now = force_at(motion.after);
    CHECK((now - before).norm() < 0.3 * at_rest);  // a quarter turn takes five steps and more
    CHECK(now.norm() < 3 * at_rest);               // as stiff as bound
    CHECK((fem.positions - motion.after).cwiseAbs().maxCoeff() < 0.5);
    before = now;
  }
}
