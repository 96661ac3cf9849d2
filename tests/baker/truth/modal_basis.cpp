// modal_basis.cpp  A region's modes are those of its finite elements, seen at the control nodes.
#include "baker/truth/modes/modal_basis.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "baker/common/bad_input.hpp"
#include "tests/baker/truth/bodies.hpp"

using namespace sinew::baker;
using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr double kHalf_m = 0.1, kHeight_m = 1;  // of a square post, held at its foot
constexpr double kRigidTo_m = 0.4;

// A post, or a wide pad, on one joint with a control node at every soft vertex, and the finite elements of
// its whole cage.
struct Post {
  Character character = sinew::test::bare_character({Vector3(0, 0, 0)});
  TissueLayout layout;
  Cage cage;
  std::vector<int> same;  // a node of the finite elements is one of the cage

  // halves: the post's left and right side are regions of their own.
  explicit Post(double young_pa = 2e4, bool halves = false, double half_m = kHalf_m) {
    sinew::test::add_box(character, {-half_m, 0, -half_m}, {half_m, kHeight_m, half_m}, 0.1, 0);
    layout.regions.resize(halves ? 2 : 1);
    for (int side = 0; side < static_cast<int>(layout.regions.size()); ++side) add_region(side, halves);
    for (const Vector3& p : character.positions) layout.stiffness.push_back(p.y() > kRigidTo_m ? 0 : 1);
    Recipe recipe;
    recipe.voxels_high = 10;
    recipe.coreless_joints = {"joint_0"};
    recipe.young_soft_pa = recipe.young_stiff_pa = young_pa;
    cage = build_cage(character, layout, recipe);
    for (size_t i = 0; i < cage.nodes.size(); ++i) same.push_back(static_cast<int>(i));
  }

  void add_region(int number, bool halves) {
    Region& region = layout.regions[static_cast<size_t>(number)];
    region.first_node = static_cast<int>(layout.nodes.size());
    for (size_t v = 0; v < character.positions.size(); ++v) {
      const Vector3& p = character.positions[v];
      if (p.y() <= kRigidTo_m || (halves && (p.x() > 0.01) != (number == 1))) continue;
      region.vertices.push_back(static_cast<int>(v));
      layout.nodes.push_back({static_cast<int>(v), number, p, character.normals[v], 0, character.skin[v]});
    }
    region.node_count = static_cast<int>(layout.nodes.size()) - region.first_node;
  }

  Fem fem() const {
    FemMaterial material;
    material.young_pa = cage.young_pa;
    material.fill = cage.fill;
    Fem out(cage.nodes, cage.tetrahedra, cage.constrained, material);
    out.damp(0.1);
    return out;
  }
  std::vector<ModalBasis> bases(int count) const {
    return modal_bases(layout, cage, fem().linear(), same, count);
  }
  // Of values at the cage's nodes, 3 each.
  Vector3 at_node(const VectorXd& in_cage, int node) const {
    const Cage::Place& place =
        cage.surface[static_cast<size_t>(layout.nodes[static_cast<size_t>(node)].vertex)];
    Vector3 sum = Vector3::Zero();
    for (size_t a = 0; a < 4; ++a)
      sum += place.weight[a] *
             in_cage.segment<3>(3 * cage.tetrahedra[static_cast<size_t>(place.tetrahedron)][a]);
    return sum;
  }
  int node_at(const Vector3& place) const {
    for (size_t n = 0; n < layout.nodes.size(); ++n)
      if ((layout.nodes[n].position - place).norm() < 1e-6) return static_cast<int>(n);
    FAIL("no control node at " << place.transpose());
    return 0;
  }
};

// One felt acceleration at every node.
VectorXd everywhere(const Vector3& felt, int nodes) { return felt.replicate(nodes, 1); }

// Displacement of the nodes under a steady felt acceleration, by the modes alone.
VectorXd static_answer(const ModalBasis& basis, const VectorXd& felt) {
  return basis.shape * (basis.force * felt).cwiseQuotient(basis.rad_per_s.cwiseAbs2());
}

// The same of the finite elements, for an acceleration so small that they are linear.
VectorXd settled(const Post& post, const Vector3& felt) {
  constexpr double kSmall = 1e-7, kTolerance = 1e-13;  // of gravity
  Fem fem = post.fem();
  VectorXd force(3 * fem.mass.size());
  for (Index i = 0; i < fem.mass.size(); ++i) force.segment<3>(3 * i) = kSmall * fem.mass[i] * felt;
  const VectorXd before = fem.positions;
  fem.settle(force, kTolerance);
  const VectorXd moved = (fem.positions - before) / kSmall;
  VectorXd out(3 * static_cast<Index>(post.layout.nodes.size()));
  for (int n = 0; n < out.size() / 3; ++n) out.segment<3>(3 * n) = post.at_node(moved, n);
  return out;
}

// So soft that every mode lies below the highest that is kept.
constexpr double kAllModes_pa = 4;
constexpr int kEvery = 100000;

}  // namespace

TEST_CASE("modal_bases_refuse_to_have_no_modes") {
  const Post post;
  CHECK_THROWS_AS(post.bases(0), BadInput);
  CHECK_THROWS_AS(post.bases(-3), BadInput);
}

TEST_CASE("modes_have_the_bodys_frequencies_and_damping") {
  const Post post;
  const ModalBasis basis = post.bases(12)[0];
  const std::vector<double> hz = post.fem().frequencies_hz(12);
  REQUIRE(basis.rad_per_s.size() == 12);
  for (Index k = 0; k < 12; ++k)
    CHECK(basis.rad_per_s[k] == Approx(2 * std::numbers::pi * hz[static_cast<size_t>(k)])
                                    .epsilon(1e-6));  // two subspaces' convergence
  CHECK(basis.damping_ratio[0] == Approx(0.1).epsilon(1e-6));
  const double x = basis.rad_per_s[11] / basis.rad_per_s[0];
  CHECK(basis.damping_ratio[11] == Approx(0.1 * (0.75 / x + 0.25 * x)).epsilon(1e-6));
}

TEST_CASE("all_modes_together_give_a_uniform_field_back") {
  // sum phi phi^T M = 1 on free flesh: modes are orthogonal over mass, force and shape are in one scale, and
  // what is felt at the nodes reaches all flesh.
  const Post post(kAllModes_pa);
  const ModalBasis basis = post.bases(kEvery)[0];
  const int nodes = post.layout.regions[0].node_count;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3 felt = Vector3::Unit(axis);
    const VectorXd back = basis.shape * (basis.force * everywhere(felt, nodes));
    const int top = post.node_at(Vector3(0, kHeight_m, 0));
    CHECK((back.segment<3>(3 * top) - felt).norm() < 1e-6);  // the eigenvectors' own accuracy
  }
}

TEST_CASE("the_static_answer_of_all_modes_is_that_of_the_finite_elements") {
  const Post post(kAllModes_pa);
  const ModalBasis basis = post.bases(kEvery)[0];
  for (const Vector3& felt : {Vector3(1, 0, 0), Vector3(0, -1, 0), Vector3(0.3, 0.2, -1)}) {
    const VectorXd want = settled(post, felt);
    const VectorXd got = static_answer(basis, everywhere(felt, post.layout.regions[0].node_count));
    CHECK((got - want).norm() < 1e-3 * want.norm());  // what is left of the material's curvature
  }
}

TEST_CASE("few_modes_and_what_they_leave_out_hold_all_of_the_static_answer") {
  const Post post(kAllModes_pa);
  for (const int count : {1, 5, kMostModes}) {
    const ModalBasis basis = post.bases(count)[0];
    const VectorXd felt = everywhere(Vector3(0.5, -1, 0.2), post.layout.regions[0].node_count);
    const VectorXd want = settled(post, Vector3(0.5, -1, 0.2));
    const VectorXd got = static_answer(basis, felt) + basis.rest * felt;
    CHECK((got - want).norm() < 1e-3 * want.norm());  // what is left of the material's curvature
    if (count == 1) CHECK((basis.rest * felt).norm() > 0.01 * want.norm());
  }
}

TEST_CASE("what_the_modes_leave_out_swings_as_the_first_of_them") {
  const Post post;
  const ModalBasis few = post.bases(2)[0], more = post.bases(3)[0];
  CHECK(few.rest_rad_per_s == Approx(more.rad_per_s[2]).epsilon(1e-6));
  CHECK(few.rest_damping_ratio == Approx(more.damping_ratio[2]).epsilon(1e-6));
  const ModalBasis all = Post(kAllModes_pa).bases(kEvery)[0];
  CHECK(all.rest.norm() < 1e-6 * (all.shape * all.force).norm() / all.rad_per_s.cwiseAbs2().minCoeff());
}

// Of a slender beam the share would be kTurnShare; a post three times as high as wide bends and shears.
TEST_CASE("turn_is_a_share_of_the_slope_of_a_bending_mode") {
  const Post post;
  const ModalBasis basis = post.bases(2)[0];
  const auto shape = [&](Index k, const Vector3& place) -> Vector3 {
    return basis.shape.col(k).segment<3>(3 * post.node_at(place));
  };
  const double step = 0.1;
  for (Index k = 0; k < 2; ++k) {
    const Vector3 place(0, 0.6, kHalf_m);
    // The front face holds the slopes along x and y; of d/dz, the other face.
    const Vector3 dx =
        (shape(k, place + step * Vector3::UnitX()) - shape(k, place - step * Vector3::UnitX())) / (2 * step);
    const Vector3 dy =
        (shape(k, place + step * Vector3::UnitY()) - shape(k, place - step * Vector3::UnitY())) / (2 * step);
    const Vector3 dz = (shape(k, place) - shape(k, place - 2 * kHalf_m * Vector3::UnitZ())) / (2 * kHalf_m);
    const Vector3 slope = 0.5 * Vector3(dy.z() - dz.y(), dz.x() - dx.z(), dx.y() - dy.x());
    const Vector3 turn = basis.turn.col(k).segment<3>(3 * post.node_at(place));
    INFO("mode " << k << ": turn " << turn.transpose() << ", slope " << slope.transpose());
    CHECK(slope.norm() > 1);  // rad for a metre of the mode: it does bend
    const double share = turn.norm() / slope.norm();
    CHECK((turn - share * slope).norm() < 0.05 * turn.norm());
    CHECK(share > 0.6 * kTurnShare);
    CHECK(share < kTurnShare);
  }
}

TEST_CASE("a_pad_that_shears_is_hardly_warped") {
  constexpr double kWide_m = 0.6;
  const Post post, pad(2e4, false, kWide_m);
  const ModalBasis bends = post.bases(2)[0], shears = pad.bases(2)[0];
  for (Index k = 0; k < 2; ++k) {
    // Radians at the top for a displacement of a metre there: half the height's inverse for a shear.
    const auto turn_of = [&](const Post& of, const ModalBasis& basis) {
      const int top = 3 * of.node_at({0, kHeight_m, 0});
      return basis.turn.col(k).segment<3>(top).norm() / basis.shape.col(k).segment<3>(top).norm();
    };
    CHECK(turn_of(pad, shears) < 0.25 * turn_of(post, bends));
  }
}

TEST_CASE("a_post_is_held_at_its_foot") {
  const Post post;
  const ModalBasis basis = post.bases(6)[0];
  const ControlNode& anchor = post.layout.nodes[static_cast<size_t>(basis.anchor_node)];
  CHECK(anchor.position.y() == Approx(kRigidTo_m + 0.1));  // the lowest of the soft ones
}

TEST_CASE("regions_that_share_a_body_have_its_modes") {
  const Post whole, post(2e4, true);
  const std::vector<ModalBasis> bases = post.bases(8);
  const double lowest = whole.bases(1)[0].rad_per_s[0];
  REQUIRE(bases.size() == 2);
  for (size_t r = 0; r < 2; ++r) {
    REQUIRE(bases[r].rad_per_s.size() == 8);
    CHECK(bases[r].shape.rows() == 3 * post.layout.regions[r].node_count);
    CHECK(bases[r].rad_per_s[0] == Approx(lowest).epsilon(1e-6));
    CHECK(bases[r].first_rad_per_s > lowest);  // the other half holds still
    for (Index k = 1; k < 8; ++k) CHECK(bases[r].rad_per_s[k] >= bases[r].rad_per_s[k - 1]);
    const double mean = bases[r].shape.col(0).squaredNorm() / post.layout.regions[r].node_count;
    CHECK(mean == Approx(1).epsilon(1e-9));
  }
}

TEST_CASE("modes_are_the_lowest_and_no_more_than_asked_for") {
  const Post soft;
  const ModalBasis few = soft.bases(5)[0], many = soft.bases(20)[0];
  CHECK(few.rad_per_s.size() == 5);
  CHECK((few.rad_per_s - many.rad_per_s.head(5)).norm() < 1e-6 * few.rad_per_s.norm());
  // Above 30 Hz a mode answers within a tick; a region that has none below keeps its first six.
  const ModalBasis stiff = Post(1e9).bases(20)[0];
  CHECK(stiff.rad_per_s.size() == 6);
  CHECK(stiff.rad_per_s[0] > 2 * std::numbers::pi * 30);
  CHECK(many.rad_per_s[many.rad_per_s.size() - 1] <= 2 * std::numbers::pi * 30);
}

TEST_CASE("a_region_without_free_flesh_has_no_modes") {
  Post post;
  post.layout.regions.emplace_back();
  Region& foot = post.layout.regions.back();
  foot.first_node = static_cast<int>(post.layout.nodes.size());
  for (size_t v = 0; v < post.character.positions.size(); ++v)
    if (post.character.positions[v].y() == 0)
      post.layout.nodes.push_back({static_cast<int>(v), 1, post.character.positions[v],
                                   post.character.normals[v], 1, post.character.skin[v]});
  foot.node_count = static_cast<int>(post.layout.nodes.size()) - foot.first_node;
  const std::vector<ModalBasis> bases = post.bases(8);
  CHECK(bases[0].rad_per_s.size() == 8);
  CHECK(bases[1].rad_per_s.size() == 0);
  CHECK(bases[1].shape.rows() == 3 * foot.node_count);
  CHECK(bases[1].rest.isZero());
}

// Every third node of the post, as if it were a coarser control graph.
TEST_CASE("a_coarser_graph_s_modes_are_the_finest_s_at_its_own_nodes") {
  const Post post;
  TissueLayout coarse = post.layout;
  coarse.nodes.clear();
  for (size_t n = 0; n < post.layout.nodes.size(); n += 3) coarse.nodes.push_back(post.layout.nodes[n]);
  coarse.regions[0].node_count = static_cast<int>(coarse.nodes.size());
  constexpr int kModes = 12;
  const ModalBasis finest = post.bases(kModes)[0];
  const ModalBasis coarser =
      modal_bases(coarse, post.cage, post.fem().linear(), post.same, kModes, &post.layout)[0];
  CHECK(coarser.rad_per_s == finest.rad_per_s);
  CHECK(coarser.damping_ratio == finest.damping_ratio);
  for (Index n = 0; n < coarser.shape.rows() / 3; ++n) {
    CHECK(coarser.shape.middleRows<3>(3 * n) == finest.shape.middleRows<3>(9 * n));
    CHECK(coarser.turn.middleRows<3>(3 * n) == finest.turn.middleRows<3>(9 * n));
  }
  // What pushes all flesh alike pushes a mode alike, however many nodes tell of it.
  const Vector3 felt(1, 2, 3);
  const VectorXd of_finest = finest.force * everywhere(felt, post.layout.regions[0].node_count),
                 of_coarser = coarser.force * everywhere(felt, coarse.regions[0].node_count);
  CHECK((of_finest - of_coarser).norm() < 1e-6 * of_finest.norm());
}
