// stretch_limit.cpp  A region moves no further than its skin can stretch, unless its recipe says so.
#include "baker/truth/stretch_limit.hpp"

#include <catch2/catch.hpp>

#include "tests/baker/truth/bodies.hpp"

using namespace sinew::baker;

namespace {

// A post of a metre on one joint, one node at its top; its top ring moves with the node, all else is still,
// so that the edges between the two top rings take all of the stretch.
struct Post {
  Character character = sinew::test::bare_character({Vector3(0, 0, 0)});
  TissueLayout layout;
  std::vector<ModalBasis> bases;

  explicit Post(double ring_m) {
    sinew::test::add_box(character, {-0.1, 0, -0.1}, {0.1, 1, 0.1}, ring_m, 0);
    Region region;
    region.radius_m = 0.5;
    region.node_count = 1;
    region.carry.resize(1);
    for (size_t v = 0; v < character.positions.size(); ++v)
      if (character.positions[v].y() > 1 - 1e-6) {
        region.vertices.push_back(static_cast<int>(v));
        region.carry[0].push_back(1);
      }
    layout.regions = {region};
    ModalBasis basis;
    basis.rad_per_s = Eigen::VectorXd::Constant(1, 20);
    basis.damping_ratio = Eigen::VectorXd::Constant(1, 0.1);
    basis.shape = Eigen::MatrixXd::Zero(3, 1);
    basis.shape(0, 0) = 1;
    basis.turn = Eigen::MatrixXd::Zero(3, 1);
    basis.force = basis.shape.transpose();
    basis.rest = Eigen::MatrixXd::Zero(3, 3);
    bases = {basis};
  }
  double limit_m() const { return layout.regions[0].max_displacement * layout.regions[0].radius_m; }
};

}  // namespace

TEST_CASE("a_narrow_rim_lowers_the_limit_to_what_its_edges_stretch_by") {
  for (const double ring_m : {0.05, 0.1}) {
    Post post(ring_m);
    limit_by_stretch(post.character, post.bases, post.layout);
    CHECK(post.limit_m() == Approx((kMostStretch - 1) * ring_m).epsilon(1e-6));
  }
}

TEST_CASE("a_wide_rim_and_a_stated_limit_keep_the_limit") {
  Post wide(0.5), stated(0.05);
  limit_by_stretch(wide.character, wide.bases, wide.layout);
  CHECK(wide.layout.regions[0].max_displacement == 0.35);
  stated.layout.regions[0].states_limit = true;
  limit_by_stretch(stated.character, stated.bases, stated.layout);
  CHECK(stated.layout.regions[0].max_displacement == 0.35);
}

TEST_CASE("a_region_that_nothing_moves_keeps_its_limit") {
  Post still(0.05);
  still.bases[0].force.setZero();
  limit_by_stretch(still.character, still.bases, still.layout);
  CHECK(still.layout.regions[0].max_displacement == 0.35);
}
