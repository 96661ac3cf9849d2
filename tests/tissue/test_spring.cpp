// test_spring.cpp  Springs of single nodes against their closed form.
#include "tissue/spring.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "baker/pack/modes_pack.hpp"

using namespace sinew;

namespace {

constexpr double kFirst = 2 * std::numbers::pi * 4;

pack::SpringRecord spring_record() {
  const baker::Recurrence r = baker::modal_recurrence(kFirst, 0.1, 60);
  return {r.a1, r.a2, 1 - r.a1 - r.a2, 0};
}

struct Nodes {
  std::vector<float> compliance = {1e-3f, 0, 0, 0, 2e-3f, 0, 5e-4f, 0, 1e-3f, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  std::vector<float> u = std::vector<float>(6), u_before = u;
  void step(const std::vector<float>& felt) {
    tissue::spring_step(spring_record(), compliance.data(), felt.data(), 4, 2, u.data(), u_before.data());
  }
};

}  // namespace

TEST_CASE("a_spring_settles_where_its_compliance_says") {
  Nodes nodes;
  for (int t = 0; t < 600; ++t) nodes.step({10, -5, 2, 99, 10, 10, 10, 99});
  CHECK(nodes.u[0] == Approx(0.010).epsilon(1e-4));
  CHECK(nodes.u[1] == Approx(-0.010).epsilon(1e-4));
  CHECK(nodes.u[2] == Approx(0.007).epsilon(1e-4));
  for (size_t k = 3; k < 6; ++k) CHECK(nodes.u[k] == 0);  // no compliance, no answer
}

TEST_CASE("a_spring_that_is_let_go_swings_at_its_first_mode_and_dies_down") {
  Nodes nodes;
  nodes.u = nodes.u_before = {0.01f, 0, 0, 0, 0, 0};
  int crossings = 0;
  float last = 0.01f;
  for (int t = 0; t < 60; ++t) {
    nodes.step(std::vector<float>(8));
    crossings += (last > 0) != (nodes.u[0] > 0);
    last = nodes.u[0];
  }
  CHECK(std::abs(crossings - 8) <= 1);  // two a swing, four swings a second
  for (int t = 0; t < 240; ++t) nodes.step(std::vector<float>(8));
  CHECK(std::fabs(nodes.u[0]) < 1e-5f);
}
