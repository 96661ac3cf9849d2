// modes_pack.cpp  Modal bases go into the file as recurrences and matrices that say the same.
#include "baker/pack/character/modes_pack.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "baker/common/bad_input.hpp"
#include "baker/pack/character/character_pack.hpp"
#include "tests/pack/pack_editor.hpp"
#include "tests/pack/small_pack.hpp"

using namespace sinew;
using namespace sinew::baker;
using Catch::Contains;

namespace {

constexpr double kRate_hz = 60;

// q'' + 2 zeta w q' + w^2 q = p by small Runge-Kutta steps (order 4); the positions at the ticks.
std::vector<double> swung(double w, double zeta, double q, double v, double p, int ticks) {
  constexpr int kSteps = 400;
  const double h = 1 / (kRate_hz * kSteps);
  const auto force = [&](double place, double speed) { return p - 2 * zeta * w * speed - w * w * place; };
  std::vector<double> out{q};
  for (int t = 0; t < ticks; ++t) {
    for (int s = 0; s < kSteps; ++s) {
      const double v1 = v, f1 = force(q, v1), v2 = v + h / 2 * f1, f2 = force(q + h / 2 * v1, v2);
      const double v3 = v + h / 2 * f2, f3 = force(q + h / 2 * v2, v3);
      const double v4 = v + h * f3, f4 = force(q + h * v3, v4);
      q += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
      v += h / 6 * (f1 + 2 * f2 + 2 * f3 + f4);
    }
    out.push_back(q);
  }
  return out;
}

}  // namespace

TEST_CASE("bases_that_do_not_fit_are_refused_by_region") {
  const Character character = test::small_character();
  const TissueLayout layout = test::small_layout(character);
  const auto refusal = [&](auto damage) {
    std::vector<ModalBasis> modes = test::small_modes(layout);
    damage(modes);
    try {
      pack_character(character, layout, modes);
    } catch (const BadInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THAT(refusal([](auto& m) { m.pop_back(); }), Contains("1 for 2 regions"));
  CHECK_THAT(refusal([](auto& m) { m[1].shape.conservativeResize(3, 2); }),
             Contains("'tip': a modal basis of"));
  CHECK_THAT(refusal([](auto& m) { m[1].force.conservativeResize(1, 6); }),
             Contains("'tip': a modal basis of"));
  CHECK_THAT(refusal([](auto& m) { m[1].damping_ratio.conservativeResize(1); }), Contains("'tip'"));
  CHECK_THAT(refusal([](auto& m) { m[0].rad_per_s[0] = 0; }), Contains("'belly': its modes hold"));
  CHECK_THAT(refusal([](auto& m) { m[0].rad_per_s[2] = kNan; }), Contains("'belly': its modes hold"));
  CHECK_THAT(refusal([](auto& m) { m[0].damping_ratio[2] = -1; }), Contains("'belly': its modes hold"));
  CHECK_THAT(refusal([](auto& m) { m[0].turn(1, 1) = kNan; }), Contains("'belly': its modes hold"));
  CHECK_THAT(refusal([](auto& m) { m[1].rest.conservativeResize(6, 5); }),
             Contains("'tip': a modal basis of"));
  CHECK_THAT(refusal([](auto& m) { m[0].rest(3, 3) = kNan; }), Contains("'belly': its modes hold"));
  CHECK_THAT(refusal([](auto& m) { m[0].rest_rad_per_s = kNan; }), Contains("'belly': its modes hold"));
  CHECK_THAT(refusal([](auto& m) { m[0].rest_damping_ratio = -1; }), Contains("'belly': its modes hold"));
  CHECK_THAT(refusal([](auto& m) { m[0].first_rad_per_s = 0; }), Contains("'belly': its modes hold"));
  CHECK_THAT(refusal([](auto& m) { m[0].first_damping_ratio = kNan; }), Contains("'belly': its modes hold"));
  const auto too_many = [](auto& m) {
    m[0] = {Eigen::VectorXd::Ones(65),
            Eigen::VectorXd::Ones(65),
            Eigen::MatrixXd::Ones(9, 65),
            Eigen::MatrixXd::Ones(9, 65),
            Eigen::MatrixXd::Ones(65, 9),
            Eigen::MatrixXd::Ones(9, 9),
            50,
            0.1};
  };
  CHECK_THAT(refusal(too_many), Contains("'belly': a modal basis of"));
}

// Rounding a1 and a2 to float shifts a frequency by 2^-24 / (w h)^2: 1e-5 at the lowest, over 60 ticks.
TEST_CASE("the_recurrence_is_the_oscillator_s_at_the_ticks") {
  for (const double zeta : {0.0, 0.08, 1.0, 1.6})
    for (const double w : {6.0, 25.0, 60.0, 180.0}) {
      INFO(w << " rad/s, damped by " << zeta);
      const Recurrence r = modal_recurrence(w, zeta, kRate_hz);
      const std::vector<double> want = swung(w, zeta, 0.03, -0.4, 7, 60);
      double q = want[1], before = want[0];
      for (size_t t = 2; t < want.size(); ++t) {
        const double next = double{r.a1} * q + double{r.a2} * before + double{r.gain} * 7;
        before = q;
        q = next;
        CHECK(q == Approx(want[t]).margin(1e-4 * 0.05));
      }
    }
}

TEST_CASE("what_swings_faster_than_ticks_can_tell_answers_at_once") {
  for (const double w : {190.0, 377.0, 5000.0}) {
    const Recurrence r = modal_recurrence(w, 0.1, kRate_hz);
    CHECK(r.a1 == 0);
    CHECK(r.a2 == 0);
    CHECK(double{r.gain} == Approx(1 / (w * w)).epsilon(1e-6));
  }
}

TEST_CASE("undamped_flesh_is_packed") {
  const Character character = test::small_character();
  const TissueLayout layout = test::small_layout(character);
  std::vector<ModalBasis> modes = test::small_modes(layout);
  for (ModalBasis& basis : modes) basis.damping_ratio.setZero(), basis.rest_damping_ratio = 0;
  test::PackEditor editor(pack_character(character, layout, modes));
  pack::PackView view;
  const Status status = editor.open(&view);
  INFO(status.message);
  CHECK(status.ok());
}

TEST_CASE("the_recurrence_rests_where_the_spring_does") {
  for (const double w : {0.5, 6.0, 60.0, 600.0}) {
    const Recurrence r = modal_recurrence(w, 0.1, kRate_hz);
    CHECK(double{r.gain} / (1 - double{r.a1} - double{r.a2}) == Approx(1 / (w * w)).epsilon(1e-6));
  }
}

TEST_CASE("matrices_lie_where_the_format_says") {
  const Character character = test::small_character();
  const TissueLayout layout = test::small_layout(character);
  const std::vector<ModalBasis> modes = test::small_modes(layout);
  test::PackEditor editor(pack_character(character, layout, modes));
  pack::PackView view;
  REQUIRE(editor.open(&view).ok());
  for (size_t r = 0; r < modes.size(); ++r) {
    const pack::RegionModesRecord& record = view.region_modes[r];
    const Eigen::Index count = modes[r].rad_per_s.size(), floats = modes[r].shape.rows();
    REQUIRE(record.mode_count == count);
    CHECK(record.first_rad_per_s == 20);
    using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const float* at = view.mode_matrices.data() + record.matrices;
    const Eigen::Index padded_modes = (count + 15) / 16 * 16;
    const auto matrix = [&](Eigen::Index rows, Eigen::Index padded) {
      const Rows all = Eigen::Map<const Rows>(at, rows, padded);
      at += rows * padded;
      return Eigen::MatrixXd(all.cast<double>());
    };
    const auto same = [](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
      constexpr double kFloatRounding = 1e-6;  // of numbers up to 1
      return (a - b).cwiseAbs().maxCoeff() < kFloatRounding;
    };
    const Eigen::MatrixXd shape = matrix(count, record.padded).leftCols(floats),
                          turn = matrix(count, record.padded).leftCols(floats),
                          response = matrix(floats, record.padded + padded_modes),
                          project = matrix(floats, padded_modes).leftCols(count);
    CHECK(same(shape.transpose(), modes[r].shape));
    CHECK(same(turn.transpose(), modes[r].turn));
    CHECK(same(response.leftCols(floats).transpose(), modes[r].rest));
    CHECK(same(response.middleCols(record.padded, count).transpose(), modes[r].force));
    // Within a hundredth, stiff modes as the ridge has it.
    CHECK((shape * project - Eigen::MatrixXd::Identity(count, count)).cwiseAbs().maxCoeff() < 0.1);
    CHECK((shape.row(0) * project)[0] == Approx(1).epsilon(0.02));
  }
}

// Two shapes that the nodes cannot tell apart: the softer one takes the displacement.
TEST_CASE("a_displacement_that_two_modes_explain_goes_to_the_softer") {
  const Character character = test::small_character();
  const TissueLayout layout = test::small_layout(character);
  std::vector<ModalBasis> modes = test::small_modes(layout);
  modes[1].shape.col(1) = modes[1].shape.col(0);
  test::PackEditor editor(pack_character(character, layout, modes));
  pack::PackView view;
  REQUIRE(editor.open(&view).ok());
  const pack::RegionModesRecord& record = view.region_modes[1];
  // Behind shape and turn of two modes and the response of six numbers, rows of 16.
  const float* project =
      view.mode_matrices.data() + record.matrices + 2 * 2 * record.padded + 6 * (record.padded + 16);
  double q[2] = {0, 0};
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i < 6; ++i) q[k] += static_cast<double>(project[i * 16 + k]) * modes[1].shape(i, 0);
  CHECK(q[0] + q[1] == Approx(1).epsilon(0.01));
  CHECK(q[0] > 5 * q[1]);  // by the square of their frequencies, 20 and 60 rad/s
}

TEST_CASE("a_region_without_modes_is_packed_and_stands_still") {
  const Character character = test::small_character();
  const TissueLayout layout = test::small_layout(character);
  std::vector<ModalBasis> modes = test::small_modes(layout);
  modes[0] = {Eigen::VectorXd(0),
              Eigen::VectorXd(0),
              Eigen::MatrixXd(9, 0),
              Eigen::MatrixXd(9, 0),
              Eigen::MatrixXd(0, 9),
              Eigen::MatrixXd::Zero(9, 9),
              0,
              0};
  test::PackEditor editor(pack_character(character, layout, modes));
  pack::PackView view;
  const Status status = editor.open(&view);
  INFO(status.message);
  REQUIRE(status.ok());
  CHECK(view.region_modes[0].mode_count == 0);
  CHECK(view.modes.size() == 2);
  CHECK((view.region_modes[0].rest_a1 == 0 && view.region_modes[0].rest_a2 == 0));
}
