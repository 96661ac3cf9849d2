// test_vertex_normals.cpp  Area vectors by place and side; normals that turn with skin and surface.
#include "kernels/surface/vertex_normals.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

using namespace sinew;

namespace {

constexpr float kRounding = 1e-6f;

//   3-------2        two faces of a box corner, seen from +x +y +z; vertices 4, 5 are twins of 0, 1 (a seam)
//   |  +z   |        the second face lies below, along -z
//   0-------1
//   4-------5
//      -y
const std::vector<float> kPositions = {0, 0, 0, 1, 0, 0, 1,  1, 0, 0,  1, 0, 0, 0,
                                       0, 1, 0, 0, 1, 0, -1, 0, 0, -1, 9, 9, 9};
const std::vector<uint32_t> kTriangles = {0, 1, 2, 0, 2, 3, 7, 6, 5, 7, 5, 4};

std::vector<float> areas_of(const std::vector<uint32_t>& welded) {
  std::vector<float> out(kPositions.size(), 5);
  simd::sum_areas({kPositions.data(), kTriangles, welded, out.data()});
  return out;
}

using Vector = std::vector<float>;

Vector turned(const Vector& normal, const Vector& bind_face, const Vector& face,
              std::vector<float> m = {1, 0, 0, 0, 1, 0, 0, 0, 1}) {
  // Two vertices of one joint each, so that strides count; the second one is looked at.
  const std::vector<float> normals = {1, 0, 0, normal[0], normal[1], normal[2]};
  const std::vector<float> faces = {1, 0, 0, bind_face[0], bind_face[1], bind_face[2]};
  const std::vector<float> areas = {face[0], face[1], face[2], 0, 0, 0};
  const std::vector<uint32_t> welded = {0, 0};
  struct Skin {
    uint16_t joint[simd::kSkinInfluences];
    float weight[simd::kSkinInfluences];
  };
  const Skin skin[2] = {{{0}, {1}}, {{1, 1}, {0.75f, 0.25f}}};
  std::vector<float> matrices = {1, 0, 0, 7, 0, 1, 0, 7, 0, 0, 1, 7};
  for (size_t row = 0; row < 3; ++row) {
    matrices.insert(matrices.end(), m.begin() + static_cast<long>(3 * row),
                    m.begin() + static_cast<long>(3 * row + 3));
    matrices.push_back(7);  // a translation, which turns nothing
  }
  float both[6];
  simd::turn_normals({.normals = normals.data(),
                      .bind_faces = faces.data(),
                      .welded = welded.data(),
                      .areas = areas.data(),
                      .joints = skin[0].joint,
                      .weights = skin[0].weight,
                      .skin_stride = sizeof(Skin),
                      .matrices = matrices.data(),
                      .count = 2,
                      .out = both});
  const float* out = both + 3;
  return {out[0], out[1], out[2]};
}

bool near(const Vector& a, const Vector& b) {
  for (size_t k = 0; k < 3; ++k)
    if (!(std::abs(a[k] - b[k]) < kRounding)) return false;
  return true;
}

}  // namespace

TEST_CASE("area_vectors_are_summed_at_the_first_vertex_of_a_place_that_faces_alike") {
  const std::vector<float> seam = areas_of({0, 1, 2, 3, 0, 1, 6, 7, 8});
  REQUIRE((seam[0] == 0 && seam[1] == -1 && seam[2] == 2));  // two triangles of +z, one of -y
  REQUIRE((seam[12] == 0 && seam[13] == 0 && seam[14] == 0));
  const std::vector<float> edge = areas_of({0, 1, 2, 3, 4, 5, 6, 7, 8});
  REQUIRE((edge[0] == 0 && edge[1] == 0 && edge[2] == 2));
  REQUIRE((edge[12] == 0 && edge[13] == -1 && edge[14] == 0));
  REQUIRE((edge[24] == 0 && edge[25] == 0 && edge[26] == 0));  // of no triangle
}

TEST_CASE("a_normal_turns_with_the_skin_and_then_as_its_triangles_do") {
  const Vector tilted = {0.6f, 0, 0.8f}, up = {0, 0, 1};
  REQUIRE(near(turned(tilted, up, {0, 0, 7}), tilted));
  // A quarter about z by the skin alone: a shortest arc of the face would leave it where it was.
  REQUIRE(near(turned(tilted, up, {0, 0, 1}, {0, -1, 0, 1, 0, 0, 0, 0, 1}), {0, 0.6f, 0.8f}));
  // The triangles turn by a quarter about y: +z to +x, and +x to -z.
  REQUIRE(near(turned(tilted, up, {2, 0, 0}), {0.8f, 0, -0.6f}));
  // Stretched to twice its length along x, a slope of 45 degrees has a normal that is steeper.
  const float s = std::sqrt(0.5f), t = 1 / std::sqrt(5.0f);
  REQUIRE(near(turned({s, 0, s}, {s, 0, s}, {t, 0, 2 * t}, {2, 0, 0, 0, 1, 0, 0, 0, 1}), {t, 0, 2 * t}));
  // Mirrored, the triangles run the other way round, and the normal faces outwards still.
  REQUIRE(near(turned(tilted, up, {0, 0, -1}, {-1, 0, 0, 0, 1, 0, 0, 0, 1}), {-0.6f, 0, 0.8f}));
}

TEST_CASE("a_normal_has_unit_length_whatever_its_triangles_are") {
  const Vector up = {0, 0, 1}, none = {0, 0, 0};
  REQUIRE(near(turned(up, none, {1, 0, 0}), up));
  REQUIRE(near(turned(up, up, none), up));
  REQUIRE(near(turned(up, up, {0, 0, -1}), {0, 0, -1}));
  REQUIRE(near(turned(up, up, {0, 0, 1}, {0, 0, 0, 0, 0, 0, 0, 0, 0}), up));
  REQUIRE(near(turned(up, up, {NAN, 0, 0}), up));
}
