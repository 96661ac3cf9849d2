// creature.cpp  The made file: valid glTF, one closed body, skinned, painted, the same every time.
#include "baker/creature/creature.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "baker/common/bad_input.hpp"
#include "creature_file.hpp"

using namespace sinew;
using baker::BadInput;
using test::default_creature;
using test::shipped_recipe;

TEST_CASE("creatures_that_cannot_be_made_are_refused") {
  CHECK_THROWS_WITH(baker::make_creature(shipped_recipe(), 199), Catch::Contains("200 .. 50000"));
  CHECK_THROWS_WITH(baker::make_creature(shipped_recipe(), 50001), Catch::Contains("200 .. 50000"));
  baker::CreatureRecipe apart = shipped_recipe();
  apart.body[0].solid.at.x() += 3;
  CHECK_THROWS_WITH(baker::make_creature(apart, 500), Catch::Contains("2 pieces"));
}

TEST_CASE("two_runs_make_the_same_bytes") {
  CHECK(baker::make_creature(shipped_recipe(), 1000) == baker::make_creature(shipped_recipe(), 1000));
}

TEST_CASE("the_body_is_closed_and_the_count_is_met_at_every_size") {
  for (size_t wanted : {500u, 2000u, 7000u, 50000u}) {
    const test::CreatureFile file = test::parse(baker::make_creature(shipped_recipe(), wanted));
    size_t vertices = 0;
    for (size_t p = 0; p < file.model.meshes[0].primitives.size(); ++p)
      vertices += file.surface(p).positions.size();
    CHECK(static_cast<double>(vertices) == Approx(static_cast<double>(wanted)).epsilon(0.1));
    CHECK(baker::why_not_a_sphere(file.surface(0)) == "");
  }
}

TEST_CASE("tinygltf_reads_the_file_without_a_word") {
  const test::CreatureFile& file = default_creature();
  CHECK(file.complaints == "");
  CHECK(file.model.skins.at(0).joints.size() >= 20);
  CHECK(file.model.animations.size() >= 4);
  for (const auto& primitive : file.model.meshes[0].primitives) {
    const auto& accessor = file.model.accessors.at(static_cast<size_t>(primitive.attributes.at("POSITION")));
    CHECK(accessor.minValues.size() == 3);
    CHECK(accessor.maxValues.size() == 3);
  }
}

TEST_CASE("attributes_keep_the_rules_of_gltf") {
  const test::CreatureFile& file = default_creature();
  const size_t joints = file.model.skins[0].joints.size();
  constexpr double kRounding = 1e-5;
  for (size_t p = 0; p < file.model.meshes[0].primitives.size(); ++p) {
    const std::vector<double> weights = file.attribute(p, "WEIGHTS_0"), joint = file.attribute(p, "JOINTS_0"),
                              normals = file.attribute(p, "NORMAL"),
                              stiffness = file.attribute(p, "_STIFFNESS");
    for (size_t v = 0; v < stiffness.size(); ++v) {
      CHECK(std::abs(weights[4 * v] + weights[4 * v + 1] + weights[4 * v + 2] + weights[4 * v + 3] - 1) <
            kRounding);
      CHECK(std::abs(std::hypot(normals[3 * v], normals[3 * v + 1], normals[3 * v + 2]) - 1) < kRounding);
      CHECK((stiffness[v] >= 0 && stiffness[v] <= 1));
      for (size_t i = 4 * v; i < 4 * v + 4; ++i)
        CHECK((joint[i] < static_cast<double>(joints) && (weights[i] > 0 || joint[i] == 0)));
    }
  }
}

TEST_CASE("normals_agree_with_the_triangles") {
  const test::CreatureFile& file = default_creature();
  constexpr double kRim = 0.1;  // at the sharp rim of an eyelid the normals of both faces cancel
  for (size_t p = 0; p < file.model.meshes[0].primitives.size(); ++p) {
    const baker::Surface surface = file.surface(p);
    const std::vector<double> normals = file.attribute(p, "NORMAL");
    size_t against = 0;
    for (const auto& t : surface.triangles) {
      const auto at = [&](size_t i) { return surface.positions[static_cast<size_t>(t[i])]; };
      Eigen::Vector3d mean = Eigen::Vector3d::Zero();
      for (int v : t) mean += Eigen::Map<const Eigen::Vector3d>(&normals[3 * static_cast<size_t>(v)]);
      const Eigen::Vector3d face = (at(1) - at(0)).cross(at(2) - at(0));
      against += face.dot(mean) < -kRim * face.norm();
    }
    CHECK(against == 0);
  }
}

TEST_CASE("inverse_bind_matrices_undo_the_rest_pose") {
  const test::CreatureFile& file = default_creature();
  const std::vector<double> inverse = file.numbers(file.model.skins[0].inverseBindMatrices);
  for (size_t j = 0; j < shipped_recipe().joints.size(); ++j)
    for (size_t axis = 0; axis < 3; ++axis)
      CHECK(inverse[16 * j + 12 + axis] ==
            Approx(-shipped_recipe().joints[j].at[static_cast<long>(axis)]).margin(1e-6));
}

TEST_CASE("belly_cheeks_ears_and_tail_are_soft_and_feet_and_skull_are_rigid") {
  const test::CreatureFile& file = default_creature();
  const baker::Surface body = file.surface(0);
  const std::vector<double> stiffness = file.attribute(0, "_STIFFNESS");
  const auto mean_near = [&](const Eigen::Vector3d& place) {
    double sum = 0, count = 0;
    for (size_t v = 0; v < stiffness.size(); ++v)
      if ((body.positions[v] - place).norm() < 0.06) sum += stiffness[v], ++count;
    REQUIRE(count >= 10);
    return sum / count;
  };
  const double rigid = nlohmann::json::parse(std::ifstream(SINEW_SOURCE_DIR "/assets/creature/tissue.json"))
                           .at("rigid_stiffness");
  for (double side : {-1.0, 1.0}) {
    CHECK(mean_near({0.21 * side, 0.68, 0.1}) < rigid);
    CHECK(mean_near({0.42 * side, 0.62, -0.03}) < rigid);
    CHECK(mean_near({0.14 * side, 0.04, 0.1}) > rigid);
  }
  CHECK(mean_near({0, 0.3, 0.24}) < 0.5 * rigid);
  CHECK(mean_near({0, 0.5, -0.43}) < rigid);
  CHECK(mean_near({0, 0.95, -0.02}) > rigid);
}

TEST_CASE("the_creature_stands_on_the_ground_and_is_about_a_metre_tall") {
  const baker::Surface body = default_creature().surface(0);
  double low = 1, high = 0;
  for (const auto& p : body.positions) low = std::min(low, p.y()), high = std::max(high, p.y());
  CHECK(low == Approx(0).margin(0.004));
  CHECK(high == Approx(1).margin(0.05));
}
