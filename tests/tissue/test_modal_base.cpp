// test_modal_base.cpp  Frame terms, recurrences and warping on bodies whose answers are known.
#include "tissue/modes/modal_base.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "baker/pack/character/modes_pack.hpp"
#include "tests/simd/every_isa.hpp"
#include "tests/simd/test_data.hpp"
#include "tests/tissue/node_poses.hpp"
#include "tissue/modes/retuned.hpp"

using namespace sinew;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {

constexpr float kTick_s = 1.0f / 60;
constexpr float kFloat = 1e-6f;  // a few roundings of numbers of the size of one

// A region's matrices by hand.
struct Body {
  uint32_t nodes;
  std::vector<pack::ModeRecord> modes;
  uint32_t padded = static_cast<uint32_t>(simd::pad_to_block(3 * nodes));
  uint32_t padded_modes = static_cast<uint32_t>(simd::pad_to_block(modes.size()));
  test::Floats shape{modes.size() * padded}, turn{modes.size() * padded};
  test::Floats response{3 * nodes * (padded + padded_modes)}, project{3 * nodes * padded_modes};
  std::vector<float> q = std::vector<float>(modes.size()), q_before = q, q_hat = q;
  std::vector<float> theta = std::vector<float>(3 * nodes), u = theta, u_before = theta;
  float rest_a1 = 0, rest_a2 = 0, rest_gain = 1;
  std::vector<float> r = theta, r_before = theta, r_hat = theta;
  test::Floats scratch{padded + padded_modes}, l{padded};
  std::vector<float> felt_in_flesh = theta;

  tissue::ModalBase base() {
    return {modes,           nodes,          padded,  padded_modes, shape.data(), turn.data(),
            response.data(), project.data(), rest_a1, rest_a2,      rest_gain};
  }
  // What number i of the felt acceleration brings of number `to` of the rest, and of a mode.
  float& rest(size_t to, size_t i) { return response[i * (padded + padded_modes) + to]; }
  float& force(size_t mode, size_t i) { return response[i * (padded + padded_modes) + padded + mode]; }
  float& projection(size_t mode, size_t i) { return project[i * padded_modes + mode]; }
  // One tick of the modal tier.
  void step(const float* felt) {
    tissue::modal_hear(base(), felt, theta.data(), felt_in_flesh.data(), scratch.data());
    tissue::modal_answer(base(), scratch.data(), {q.data(), q_before.data(), r.data(), r_before.data()},
                         {q_hat.data(), r_hat.data(), l.data()});
    q_before = q;
    q = q_hat;
    r_before = r;
    r = r_hat;
    tissue::modal_turn(base(), q.data(), scratch.data(), theta.data());
    u_before = u;
    tissue::warp(theta.data(), l.data(), nodes, u.data());
  }
};

pack::ModeRecord mode(double rad_per_s, double damping_ratio) {
  const baker::Recurrence r = baker::modal_recurrence(rad_per_s, damping_ratio, 60);
  return {static_cast<float>(rad_per_s), static_cast<float>(damping_ratio), r.a1, r.a2, r.gain, {}};
}

// One node whose three modes are its three axes.
Body point(const pack::ModeRecord& record) {
  Body body{1, {record, record, record}};
  for (size_t k = 0; k < 3; ++k) body.shape[16 * k + k] = body.force(k, k) = body.projection(k, k) = 1;
  return body;
}

// A rod of a metre along y, held at its foot, with one bending mode: x = y^2 / 2, so that q is the curvature.
constexpr uint32_t kRodNodes = 20;
Body rod() {
  Body body{kRodNodes, {mode(20, 0.1)}};
  float squares = 0;
  for (uint32_t i = 0; i < kRodNodes; ++i) {
    const float y = static_cast<float>(i + 1) / kRodNodes;
    body.shape[3 * i] = y * y / 2;
    body.turn[3 * i + 2] = -y;
    squares += y * y * y * y / 4;
  }
  for (uint32_t i = 0; i < kRodNodes; ++i) {
    body.projection(0, 3 * i) = body.shape[3 * i] / squares;
    body.force(0, 3 * i) = 1.5f * body.projection(0, 3 * i);
  }
  return body;
}

// Of the line through the rod's nodes, displaced.
double rod_length(const float* displacement) {
  Vector3d before(0, 0, 0);
  double length = 0;
  for (uint32_t i = 0; i < kRodNodes; ++i) {
    const Vector3d now =
        Vector3d(0, (i + 1.0) / kRodNodes, 0) + Vector3f(displacement + 3 * i).cast<double>();
    length += (now - before).norm();
    before = now;
  }
  return length;
}

// The mean of the rotations from 0 to theta, by a sum of many.
Matrix3d mean_rotation(const Vector3d& theta) {
  constexpr int kSteps = 20000;
  Matrix3d sum = Matrix3d::Zero();
  for (int s = 0; s < kSteps; ++s)
    sum += Eigen::AngleAxisd(theta.norm() * (s + 0.5) / kSteps, theta.normalized()).toRotationMatrix();
  return sum / kSteps;
}

}  // namespace

TEST_CASE("a_region_without_modes_stands_still") {
  Body body{2, {}};
  std::fill_n(body.l.data(), body.padded, 99.0f);
  const float felt[6] = {1, 2, 3, 4, 5, 6};
  body.step(felt);
  for (size_t i = 0; i < 6; ++i) CHECK((body.l[i] == 0 && body.theta[i] == 0 && body.u[i] == 0));
}

TEST_CASE("nan_goes_through_to_the_answer") {
  Body body = rod();
  std::vector<float> felt(3 * kRodNodes);
  felt[30] = std::numeric_limits<float>::quiet_NaN();
  body.step(felt.data());
  CHECK(std::isnan(body.q[0]));
  CHECK(std::isnan(body.u[3]));
}

// ---- the frame term ----

TEST_CASE("frame_term_is_zero_in_a_straight_moving_frame") {
  tissue::NodePose pose[3];
  for (int tick = 0; tick < 3; ++tick)
    pose[tick] = test::node_pose(test::turned(0.7), Vector3d(3, -1, 2) * tick);
  const tissue::NodePose* const poses[3] = {&pose[0], &pose[1], &pose[2]};
  const float u[3] = {0.1f, -0.2f, 0.3f}, u_before[3] = {0.3f, 0.1f, 0.2f};
  float phi[3] = {9, 9, 9};
  tissue::frame_term(poses, u, u_before, kTick_s, 1, phi);
  for (const float value : phi) CHECK(value == 0);
}

// At rest in a frame that spins at w, flesh a distance r from the axis feels w^2 r outwards: two differences
// of a circle give 2 (1 - cos wh) / h^2.
TEST_CASE("frame_term_of_a_steady_spin_is_centrifugal") {
  constexpr double kRate = 6;
  tissue::NodePose pose[3];
  for (int tick = 0; tick < 3; ++tick)
    pose[tick] = test::node_pose(Eigen::AngleAxisd(-kRate * tick / 60, Vector3d::UnitZ()).toRotationMatrix());
  const tissue::NodePose* const poses[3] = {&pose[0], &pose[1], &pose[2]};
  const float u[3] = {0.2f, 0, 0.5f};
  float phi[3];
  tissue::frame_term(poses, u, u, kTick_s, 1, phi);
  const double want = 0.2 * 3600 * (2 * std::cos(kRate / 60) - std::cos(2 * kRate / 60) - 1);
  CHECK(phi[0] == Approx(want).margin(1e-3));
  CHECK(want == Approx(kRate * kRate * 0.2).epsilon(0.01));
  CHECK(std::fabs(phi[2]) < 1e-6);
}

// With the recurrence of no spring, u'' = phi, a node goes straight on in the world while its frame tumbles.
// Each tick adds a few roundings of R u; the second differences sum them up twice.
TEST_CASE("a_free_node_in_a_spinning_frame_moves_in_a_straight_line") {
  constexpr int kTicks = 60;
  Body body = point({1, 0, 2, -1, kTick_s * kTick_s, {}});
  const auto frame = [](int t) { return test::turned(0.15 * t + 0.001 * t * t); };
  const Vector3d start(0.1, 0.2, -0.1), velocity(0.3, -0.4, 0.5);
  const auto world = [&](int t) { return Vector3d(start + velocity * t / 60.0); };
  Eigen::Map<Vector3f>{body.q.data()} = (frame(0).transpose() * world(0)).cast<float>();
  Eigen::Map<Vector3f>{body.q_before.data()} = (frame(-1).transpose() * world(-1)).cast<float>();
  body.u = body.q;
  body.u_before = body.q_before;
  double worst_m = 0;
  for (int t = 1; t <= kTicks; ++t) {
    tissue::NodePose pose[3];
    for (int tick = 0; tick < 3; ++tick) pose[tick] = test::node_pose(frame(t - tick));
    const tissue::NodePose* const poses[3] = {&pose[0], &pose[1], &pose[2]};
    float phi[3];
    tissue::frame_term(poses, body.u.data(), body.u_before.data(), kTick_s, 1, phi);
    body.step(phi);
    worst_m = std::max(worst_m, (frame(t) * Vector3f(body.u.data()).cast<double>() - world(t)).norm());
  }
  INFO("worst " << worst_m << " m after " << world(kTicks).norm() << " m");
  CHECK(worst_m < kTicks * kTicks * 1e-7);
}

// ---- modes ----

TEST_CASE("modal_base_answers_a_constant_acceleration_with_its_static_shape") {
  Body body = point(mode(25, 0.2));
  const float felt[3] = {3, -9.8f, 1};
  for (int t = 0; t < 600; ++t) body.step(felt);
  for (size_t k = 0; k < 3; ++k) CHECK(body.l[k] == Approx(felt[k] / 625).epsilon(1e-5));
}

// One oscillator for all that the modes leave out: rest e when it has died down.
TEST_CASE("what_the_modes_left_out_answers_as_one_oscillator") {
  Body body = point(mode(25, 0.2));
  const baker::Recurrence oscillator = baker::modal_recurrence(90, 0.2, 60);
  body.rest_a1 = oscillator.a1;
  body.rest_a2 = oscillator.a2;
  body.rest_gain = 1 - oscillator.a1 - oscillator.a2;
  for (size_t row = 0; row < 3; ++row) body.rest(row, (row + 1) % 3) = 1e-3f;
  const float felt[3] = {3, -9.8f, 1};
  body.step(felt);
  CHECK(body.r[0] == Approx(body.rest_gain * 1e-3f * felt[1]));
  CHECK(body.l[0] == Approx(body.q[0] + body.r[0]));
  for (int t = 0; t < 600; ++t) body.step(felt);
  for (size_t k = 0; k < 3; ++k)
    CHECK(body.l[k] == Approx(felt[k] / 625 + 1e-3f * felt[(k + 1) % 3]).epsilon(1e-5));
}

TEST_CASE("turned_flesh_feels_along_its_own_axes") {
  Body body = point(mode(25, 0.2));
  body.theta = {0, 0, static_cast<float>(M_PI / 2)};
  const float felt[3] = {3, 0, 0};
  body.step(felt);
  CHECK(body.felt_in_flesh[1] == Approx(-3));
  CHECK(std::fabs(body.q[0]) < kFloat);
  CHECK(body.q[1] < -1e-4f);  // x seen from flesh turned by a quarter about z is -y
}

TEST_CASE("projection_adds_what_a_displacement_holds_of_the_modes") {
  Body body = rod();
  const float q = 0.37f;
  for (uint32_t i = 0; i < 3 * kRodNodes; ++i) body.l[i] = q * body.shape[i];
  float added = 2;
  tissue::modal_project(body.base(), body.l.data(), &added);
  CHECK(added == Approx(2 + q).epsilon(1e-5));
}

// Energy from two positions: q_t and q_{t-1} tell the velocity at t-1 through one tick's matrix P.
TEST_CASE("modal_energy_never_grows_without_drive") {
  for (const double w : {8.0, 25.0, 60.0, 188.0}) {
    for (const double zeta : {0.0, 0.1, 0.8}) {
      INFO(w << " rad/s, damping " << zeta);
      const double t = 1.0 / 60, s = w * std::sqrt(1 - zeta * zeta), decay = std::exp(-zeta * w * t);
      const double c = decay * std::cos(s * t), b = decay * std::sin(s * t) / s;
      Eigen::Matrix2d tick;
      tick << c + zeta * w * b, b, -w * w * b, c - zeta * w * b;
      Body body = point(mode(w, zeta));
      body.q = {0.05f, 0, 0};
      body.q_before = {static_cast<float>((0.05 - tick(0, 1) * 0.3) / tick(0, 0)), 0, 0};
      const float felt[3] = {};
      double before = std::numeric_limits<double>::infinity(), first = 0;
      for (int t = 0; t < 300; ++t) {
        const double q = static_cast<double>(body.q[0]);
        body.step(felt);
        const double v = (static_cast<double>(body.q[0]) - tick(0, 0) * q) / tick(0, 1);
        const double energy = (v * v + w * w * q * q) / 2;
        if (t == 0) first = energy;
        CHECK(energy <= before + 1e-4 * first);  // the velocity is a difference of floats over a tick
        before = energy;
      }
      CHECK(before < (zeta > 0 ? 1 : 1.001) * first);
    }
  }
}

TEST_CASE("modal_base_has_the_same_bits_on_all_targets_with_fma") {
  test::require_same_bits_where_fused(0xa18a7ea9e3a3d300, [](const simd::Kernels&) {
    Body body = rod();
    std::mt19937 random(1);  // not a sine: its last bit differs between processors
    std::vector<float> felt(3 * kRodNodes), out;
    for (int t = 0; t < 50; ++t) {
      for (float& value : felt) value = test::uniform(random, -1, 1);
      body.step(felt.data());
      out.insert(out.end(), body.u.begin(), body.u.end());
    }
    return out;
  });
}

// ---- warping ----

TEST_CASE("warp_of_no_turn_is_exactly_nothing") {
  const float theta[3] = {0, 0, 0}, l[3] = {0.1f, -0.2f, 0.3f};
  float out[3];
  tissue::warp(theta, l, 1, out);
  for (size_t k = 0; k < 3; ++k) CHECK(out[k] == l[k]);
  tissue::turn_back(theta, l, 1, out);
  for (size_t k = 0; k < 3; ++k) CHECK(out[k] == l[k]);
}

// W = I + [theta]x / 2 + O(theta^2 / 6).
TEST_CASE("warp_of_a_small_turn_is_linear") {
  const Vector3f l(0.1f, -0.2f, 0.3f), axis = Vector3f(1, 2, -0.5f).normalized();
  for (const float angle : {1e-6f, 1e-4f, 1e-2f}) {
    const Vector3f theta = angle * axis;
    Vector3f out;
    tissue::warp(theta.data(), l.data(), 1, out.data());
    CHECK((out - l - theta.cross(l) / 2).norm() <= angle * angle / 6 * l.norm() + 1e-7f);
  }
}

TEST_CASE("warp_is_the_mean_rotation_and_turn_back_the_inverse_one_up_to_two_radians") {
  const Vector3d l(0.1, -0.2, 0.3);
  for (const double angle : {0.01, 0.3, 1.0, 1.7, 2.0}) {
    const Vector3d theta = angle * Vector3d(1, 2, -0.5).normalized();
    const Vector3f theta_f = theta.cast<float>(), l_f = l.cast<float>();
    Vector3f out;
    tissue::warp(theta_f.data(), l_f.data(), 1, out.data());
    CHECK((out.cast<double>() - mean_rotation(theta) * l).norm() < static_cast<double>(kFloat));
    tissue::turn_back(theta_f.data(), l_f.data(), 1, out.data());
    const Matrix3d turn = Eigen::AngleAxisd(angle, theta.normalized()).toRotationMatrix();
    CHECK((out.cast<double>() - turn.transpose() * l).norm() < static_cast<double>(kFloat));
  }
}

TEST_CASE("a_turn_beyond_two_radians_is_held_there") {
  Body body = rod();
  const float q = 3;  // the tip turns by three radians, the middle by one and a half
  tissue::modal_turn(body.base(), &q, body.scratch.data(), body.theta.data());
  CHECK(body.theta[3 * (kRodNodes - 1) + 2] == Approx(-2));
  CHECK(body.theta[3 * (kRodNodes / 2 - 1) + 2] == Approx(-1.5));
}

// A quadratic bend by the angle a is a^2 / 6 too long as it is, and a^2 / 12 too short when warped.
TEST_CASE("a_bent_rod_keeps_its_length_better_warped_than_linear") {
  for (const float curvature : {0.5f, 1.0f, 1.8f}) {
    Body body = rod();
    for (uint32_t i = 0; i < 3 * kRodNodes; ++i) body.l[i] = curvature * body.shape[i];
    tissue::modal_turn(body.base(), &curvature, body.scratch.data(), body.theta.data());
    tissue::warp(body.theta.data(), body.l.data(), kRodNodes, body.u.data());
    const double linear = std::fabs(rod_length(body.l.data()) - 1),
                 warped = std::fabs(rod_length(body.u.data()) - 1);
    INFO("curvature " << curvature << ": linear off by " << linear << ", warped by " << warped);
    CHECK(warped < 0.55 * linear);
  }
}
