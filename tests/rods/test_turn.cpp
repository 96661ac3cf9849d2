// test_turn.cpp  Rotations in double against what they do to axes.
#include "rods/turn.hpp"

#include <catch2/catch.hpp>

using namespace sinew;

namespace {

constexpr double kRounding = 1e-15;  // some units in the last place of numbers up to 1

const double kHalf = std::sqrt(0.5);
const rods::Turn kAboutX = {kHalf, 0, 0, kHalf}, kAboutZ = {0, 0, kHalf, kHalf};  // by a quarter

void same(const rods::Vector& a, const rods::Vector& b) {
  for (size_t k = 0; k < 3; ++k) CHECK(std::fabs(a[k] - b[k]) < kRounding);
}

}  // namespace

TEST_CASE("a_quarter_turn_about_z_takes_x_to_y_and_back") {
  same(rods::turned(kAboutZ, {1, 0, 0}), {0, 1, 0});
  same(rods::turned_back(kAboutZ, {0, 1, 0}), {1, 0, 0});
}

TEST_CASE("a_product_turns_by_its_second_factor_first") {
  same(rods::turned(rods::product(kAboutX, kAboutZ), {1, 0, 0}), {0, 0, 1});
  same(rods::turned(rods::product(kAboutZ, kAboutX), {1, 0, 0}), {0, 1, 0});
}

TEST_CASE("a_normalised_turn_has_length_one_and_turns_about_the_same_axis") {
  const rods::Turn q = rods::normalised({0, 0, 3, 3});
  CHECK(std::fabs(rods::norm(q) - 1) < kRounding);
  same(rods::turned(q, {1, 0, 0}), {0, 1, 0});
}
