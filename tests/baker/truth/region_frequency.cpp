// region_frequency.cpp  Regions swing at the frequency that they are to have, whatever their size.
#include "baker/truth/modes/region_frequency.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numbers>

#include "baker/common/bad_input.hpp"
#include "baker/truth/motion/motion.hpp"
#include "baker/truth/tissue_truth.hpp"
#include "tests/baker/truth/bodies.hpp"

using namespace sinew::baker;

namespace {

constexpr double kClose = 0.011;  // what the tuning stops at, and a rounding

// Two posts on one joint, a region each, soft above 0.4 of their height; `scale` is that in metres. From the
// plane between them they are `aside` heights away, and 0.1 wide to either side.
struct Posts {
  Character character;
  TissueLayout layout;
  Recipe recipe;

  Posts(double scale, double first_hz, double second_hz, double aside = 0.6)
      : character(sinew::test::bare_character({Vector3(0, 0, 0)})) {
    for (const double x : {-aside * scale, aside * scale})
      sinew::test::add_box(character, {x - 0.1 * scale, 0, -0.1 * scale},
                           {x + 0.1 * scale, scale, 0.1 * scale}, 0.1 * scale, 0);
    layout.regions.resize(2);
    layout.regions[0].frequency_hz = first_hz;
    layout.regions[1].frequency_hz = second_hz;
    for (int r = 0; r < 2; ++r) add_region(r, scale);
    for (const Vector3& p : character.positions) layout.stiffness.push_back(p.y() > 0.4 * scale ? 0 : 1);
    recipe.voxels_high = 10;
    recipe.coreless_joints = {"joint_0"};
    recipe.states_regions = true;
  }
  void add_region(int number, double scale) {
    Region& region = layout.regions[static_cast<size_t>(number)];
    region.name = number == 0 ? "left" : "right";
    region.first_node = static_cast<int>(layout.nodes.size());
    for (size_t v = 0; v < character.positions.size(); ++v) {
      const Vector3& p = character.positions[v];
      if (p.y() <= 0.4 * scale || (p.x() > 0) != (number == 1)) continue;
      region.vertices.push_back(static_cast<int>(v));
      layout.nodes.push_back({static_cast<int>(v), number, p, character.normals[v], 0, character.skin[v]});
    }
    region.node_count = static_cast<int>(layout.nodes.size()) - region.first_node;
  }
  std::vector<ModalBasis> bases() const {
    return TissueTruth(character, layout, recipe).modal_bases(layout, kMostModes);
  }
};

double first_hz(const ModalBasis& basis) { return basis.first_rad_per_s / (2 * std::numbers::pi); }

}  // namespace

TEST_CASE("a_stated_region_without_free_nodes_is_refused_by_name") {
  Posts posts(1, 3, 3);
  for (size_t v = 0; v < posts.character.positions.size(); ++v)
    if (posts.character.positions[v].x() > 0) posts.layout.stiffness[v] = 1;
  CHECK_THROWS_WITH(posts.bases(), Catch::Contains("region 'right'") && Catch::Contains("coreless_joints"));
  posts.recipe.states_regions = false;
  CHECK(posts.bases()[1].rad_per_s.size() == 0);
}

TEST_CASE("regions_swing_at_their_frequencies_from_five_centimetres_to_fifty_metres") {
  for (const double scale : {0.05, 1.0, 50.0}) {
    const std::vector<ModalBasis> bases = Posts(scale, 2, 7.5).bases();
    INFO("height " << scale << " m");
    CHECK(first_hz(bases[0]) == Approx(2).epsilon(kClose));
    CHECK(first_hz(bases[1]) == Approx(7.5).epsilon(kClose));
  }
}

TEST_CASE("regions_that_share_cells_of_the_cage_swing_at_their_frequencies_all_the_same") {
  const std::vector<ModalBasis> bases = Posts(1, 2, 40, 0.1).bases();  // the posts touch
  CHECK(first_hz(bases[0]) == Approx(2).epsilon(kClose));
  CHECK(first_hz(bases[1]) == Approx(40).epsilon(kClose));
}

TEST_CASE("a_region_without_a_frequency_keeps_its_moduli") {
  const double by_moduli = first_hz(Posts(1, 0, 0).bases()[0]);
  const std::vector<ModalBasis> bases = Posts(1, 0, 5).bases();
  CHECK(first_hz(bases[0]) == Approx(by_moduli).epsilon(1e-9));
  CHECK(first_hz(bases[1]) == Approx(5).epsilon(kClose));
}

TEST_CASE("a_region_is_damped_by_its_own_ratio") {
  Posts posts(1, 3, 3);
  posts.layout.regions[0].damping_ratio = 0.3;
  posts.layout.regions[1].damping_ratio = 0.05;
  const std::vector<ModalBasis> bases = posts.bases();
  CHECK(bases[0].damping_ratio[0] == Approx(0.3).epsilon(1e-6));
  CHECK(bases[1].damping_ratio[0] == Approx(0.05).epsilon(1e-6));
  posts.layout.regions[0].damping_ratio = 0.9;  // of the third mode and beyond it would be above one
  CHECK(posts.bases()[0].damping_ratio.maxCoeff() < 1);
}

TEST_CASE("intensity_scales_what_a_load_moves") {
  Posts posts(1, 3, 3);
  posts.layout.regions[0].intensity = 2;
  posts.layout.regions[1].intensity = 0;
  const std::vector<ModalBasis> plain = Posts(1, 3, 3).bases(), scaled = posts.bases();
  CHECK((scaled[0].force - 2 * plain[0].force).norm() <= 1e-9 * plain[0].force.norm());
  CHECK((scaled[0].rest - 2 * plain[0].rest).norm() <= 1e-9 * plain[0].rest.norm());
  CHECK(scaled[1].force.norm() == 0);
}

TEST_CASE("intensity_scales_the_truth_as_it_scales_the_base") {
  // Of the regions' vertices: what moves a little outside of every region keeps its physical way.
  const auto largest_m = [](double intensity) {
    Posts posts(1, 3, 3);
    for (Region& region : posts.layout.regions) region.intensity = intensity;
    TissueTruth truth(posts.character, posts.layout, posts.recipe);
    truth.start(shake_motion(posts.character));
    double most = 0;
    for (int tick = 0; tick < 30; ++tick) {
      const TruthFrame frame = truth.advance(60, 2);
      for (const Region& region : posts.layout.regions)
        for (const int v : region.vertices)
          most = std::max(
              most, (frame.truth[static_cast<size_t>(v)] - frame.skinned[static_cast<size_t>(v)]).norm());
    }
    return most;
  };
  const double physical_m = largest_m(1);
  CHECK(physical_m > 1e-3);
  CHECK(largest_m(2) == Approx(2 * physical_m));
  CHECK(largest_m(0) == 0);
}
