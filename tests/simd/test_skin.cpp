// test_skin.cpp  Blended matrices on points, against double, with the records' own strides.
#include "pack/format.hpp"
#include "tests/simd/every_isa.hpp"
#include "tests/simd/test_data.hpp"

using namespace sinew;

namespace {

constexpr double kRounding =
    4e-6;  // matrices and points below 2 and 3: some twenty roundings of sums below 10
constexpr uint32_t kJoints = 9;

struct SkinCase {
  std::vector<pack::NodeRecord> nodes;  // control nodes: 80 bytes apart
  std::vector<float> matrices;
};

// Node i has i % 9 influences, so that lists of every length, the empty one too, are there.
SkinCase skin_case(uint32_t count) {
  std::mt19937 random(count);
  SkinCase c{std::vector<pack::NodeRecord>(count), std::vector<float>(kJoints * 12)};
  for (float& m : c.matrices) m = test::uniform(random, -2, 2);
  for (uint32_t i = 0; i < count; ++i) {
    for (float& axis : c.nodes[i].position_m) axis = test::uniform(random, -3, 3);
    const uint32_t influences = i % 9;
    for (uint32_t k = 0; k < influences; ++k) {
      c.nodes[i].skin.joint[k] = static_cast<uint16_t>(random() % kJoints);
      c.nodes[i].skin.weight[k] = 1 / static_cast<float>(influences);
    }
  }
  return c;
}

std::vector<float> skinned(const simd::Kernels& kernels, const SkinCase& c) {
  constexpr size_t kFloatsApart = 5;  // an interleaved vertex of the caller
  std::vector<float> out(c.nodes.size() * kFloatsApart, 33);
  kernels.skin({c.nodes[0].position_m, sizeof(pack::NodeRecord), c.nodes[0].skin.joint,
                c.nodes[0].skin.weight, sizeof(pack::NodeRecord), c.matrices.data(), out.data(),
                kFloatsApart * sizeof(float), static_cast<uint32_t>(c.nodes.size())});
  return out;
}

double exact_place(const SkinCase& c, size_t node, size_t axis) {
  double sum = 0;
  for (size_t k = 0; k < pack::kInfluences; ++k) {
    const float* m = &c.matrices[c.nodes[node].skin.joint[k] * size_t{12} + 4 * axis];
    const float* p = c.nodes[node].position_m;
    sum += c.nodes[node].skin.weight[k] *
           (double{m[0]} * p[0] + double{m[1]} * p[1] + double{m[2]} * p[2] + m[3]);
  }
  return sum;
}

}  // namespace

TEST_CASE("skin_blends_matrices_and_writes_three_floats_a_stride") {
  const SkinCase c = skin_case(50);
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    const std::vector<float> out = skinned(kernels, c);
    for (size_t i = 0; i < c.nodes.size(); ++i) {
      for (size_t axis = 0; axis < 3; ++axis)
        REQUIRE(std::fabs(out[5 * i + axis] - exact_place(c, i, axis)) <= kRounding);
      REQUIRE((out[5 * i + 3] == 33 && out[5 * i + 4] == 33));
    }
  });
}

TEST_CASE("skin_has_the_same_bits_on_all_targets_with_fma") {
  const SkinCase c = skin_case(50);
  test::require_same_bits_where_fused(0x42a5dfeb197dbf19,
                                      [&](const simd::Kernels& kernels) { return skinned(kernels, c); });
}
