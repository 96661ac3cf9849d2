// test_turn.cpp  Vectors turned by rotation vectors, against axis and angle in double.
#include <Eigen/Geometry>

#include "tests/simd/every_isa.hpp"
#include "tests/simd/test_data.hpp"

using namespace sinew;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

struct Turns {
  Turns(uint32_t vectors, size_t turn_stride)
      : count(vectors), stride(turn_stride), turns(count * stride), v(3 * count), out(3 * count, 99) {
    std::mt19937 random(count);
    for (float& value : turns) value = test::uniform(random, -1.1f, 1.1f);  // up to two radians
    for (float& value : v) value = test::uniform(random, -1, 1);
  }
  simd::TurnJob job() { return {turns.data(), stride, v.data(), out.data(), count}; }
  Vector3d turn(size_t i) const {
    return Eigen::Map<const Eigen::Vector3f>(&turns[stride * i]).cast<double>();
  }
  Vector3d vector(size_t i) const { return Eigen::Map<const Eigen::Vector3f>(&v[3 * i]).cast<double>(); }
  Vector3d answer(size_t i) const { return Eigen::Map<const Eigen::Vector3f>(&out[3 * i]).cast<double>(); }
  uint32_t count;
  size_t stride;
  std::vector<float> turns, v, out;
};

Matrix3d rotation(const Vector3d& turn) {
  return Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
}

// The mean of the rotations from 0 to turn, in closed form.
Matrix3d mean_rotation(const Vector3d& turn) {
  const double a = turn.norm();
  Matrix3d k;
  const Vector3d n = turn / a;
  k << 0, -n.z(), n.y(), n.z(), 0, -n.x(), -n.y(), n.x(), 0;
  return Matrix3d::Identity() + (1 - std::cos(a)) / a * k + (1 - std::sin(a) / a) * k * k;
}

// wanted(turn) times the vector; a dozen roundings of numbers of the size of one.
template <class Wanted>
void check_kernel(void (*simd::Kernels::*kernel)(const simd::TurnJob&), const Wanted& wanted) {
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    for (const uint32_t count : {0u, 1u, 3u, 15u, 16u, 17u, 40u}) {
      for (const size_t stride : {3u, 15u}) {
        Turns turns(count, stride);
        (kernels.*kernel)(turns.job());
        for (size_t i = 0; i < count; ++i)
          REQUIRE((turns.answer(i) - wanted(turns.turn(i)) * turns.vector(i)).norm() < 1e-6);
      }
    }
  });
}

}  // namespace

TEST_CASE("turn_is_the_rotation_and_turn_back_its_inverse") {
  check_kernel(&simd::Kernels::turn, [](const Vector3d& turn) { return rotation(turn); });
  check_kernel(&simd::Kernels::turn_back,
               [](const Vector3d& turn) { return Matrix3d(rotation(turn).transpose()); });
}

TEST_CASE("warp_is_the_mean_of_the_turns_on_the_way") { check_kernel(&simd::Kernels::warp, mean_rotation); }

TEST_CASE("a_vector_may_be_turned_where_it_stands") {
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    Turns apart(21, 3), there(21, 3);
    simd::TurnJob job = there.job();
    job.out = there.v.data();
    kernels.turn_back(apart.job());
    kernels.turn_back(job);
    REQUIRE(there.v == apart.out);
  });
}

TEST_CASE("turns_have_the_same_bits_on_all_targets_with_fma") {
  test::require_same_bits_where_fused(0x3f451ced73bff6a0, [](const simd::Kernels& kernels) {
    Turns turns(40, 3);
    kernels.turn_back(turns.job());
    std::vector<float> out = turns.out;
    kernels.turn(turns.job());
    out.insert(out.end(), turns.out.begin(), turns.out.end());
    kernels.warp(turns.job());
    out.insert(out.end(), turns.out.begin(), turns.out.end());
    return out;
  });
}
