// load_weights.cpp  Felt accelerations carried from a few nodes to flesh around them.
#include "baker/truth/modes/load_weights.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace sinew::baker;
using Eigen::Index;
using Eigen::MatrixXd;

namespace {

// Of flesh that never swings by itself.
LoadPlaces places(const std::vector<Vector3>& at, int joint = 0) {
  LoadPlaces out;
  Influences skin{};
  skin.joint[0] = joint;
  skin.weight[0] = 1;
  for (const Vector3& place : at) out.push_back(place, skin);
  out.answers = MatrixXd::Zero(3 * static_cast<Index>(at.size()), 1);
  return out;
}

// A grid of a decimetre's cells, half a metre across, around the origin.
LoadPlaces flesh() {
  std::vector<Vector3> at;
  for (int x = -2; x <= 2; ++x)
    for (int y = -2; y <= 2; ++y)
      for (int z = -2; z <= 2; ++z) at.emplace_back(0.1 * x, 0.1 * y, 0.1 * z);
  return places(at);
}

double most_together(const MatrixXd& weights) { return weights.cwiseAbs().rowwise().sum().maxCoeff(); }
double least_sum(const MatrixXd& weights) { return weights.rowwise().sum().minCoeff(); }
double most_sum(const MatrixXd& weights) { return weights.rowwise().sum().maxCoeff(); }

const std::vector<Vector3> kCorners = {{-0.2, -0.2, -0.2}, {0.2, -0.2, -0.2}, {-0.2, 0.2, -0.2},
                                       {0.2, 0.2, -0.2},   {-0.2, -0.2, 0.2}, {0.2, -0.2, 0.2},
                                       {-0.2, 0.2, 0.2},   {0.2, 0.2, 0.2}};

}  // namespace

// The noise of load_weights.cpp takes a hundredth of one node's share, less of many.
TEST_CASE("what_all_nodes_feel_alike_all_flesh_feels") {
  const MatrixXd weights = load_weights(places(kCorners), flesh());
  CHECK(least_sum(weights) > 0.99);
  CHECK(most_sum(weights) < 1.01);
}

TEST_CASE("what_is_affine_in_the_place_is_carried_as_it_is") {
  const LoadPlaces nodes = places(kCorners), around = flesh();
  const MatrixXd weights = load_weights(nodes, around);
  const Vector3 slope(3, -1, 2);
  Eigen::VectorXd felt(static_cast<Index>(nodes.size()));
  for (Index n = 0; n < felt.size(); ++n) felt[n] = slope.dot(nodes.place[static_cast<size_t>(n)]);
  const Eigen::VectorXd got = weights * felt;
  for (Index c = 0; c < got.size(); ++c)
    CHECK(got[c] == Approx(slope.dot(around.place[static_cast<size_t>(c)])).margin(0.02));
}

// A thigh's five nodes in a box 1.5 mm thick made forces of 1027 where their sum was 0.81: the slope across
// the plane, which they do not tell, was taken from their difference over 1.5 mm.
TEST_CASE("nodes_nearly_in_a_plane_tell_nothing_across_it") {
  const std::vector<Vector3> thigh = {
      {-0.05, 0, -0.07}, {0.05, 0.0015, -0.07}, {-0.05, 0.0015, 0.07}, {0.05, 0, 0.07}, {0, 0.0008, 0}};
  const MatrixXd weights = load_weights(places(thigh), flesh());
  CHECK(most_together(weights) < 10);  // along the plane flesh is four sizes away: some 2 x 4
  CHECK(least_sum(weights) > 0.9);
}

TEST_CASE("nodes_on_a_line_two_nodes_and_one_answer_for_all_flesh") {
  const std::vector<std::vector<Vector3>> few = {
      {{-0.2, 0, 0}, {-0.1, 0, 0}, {0, 0, 0}, {0.1, 0, 0}, {0.2, 0, 0}},
      {{-0.2, 0, 0}, {0.2, 0, 0}},
      {{0.05, 0, 0}}};
  for (const std::vector<Vector3>& at : few) {
    const MatrixXd weights = load_weights(places(at), flesh());
    INFO(at.size() << " nodes");
    CHECK(weights.allFinite());
    CHECK(most_together(weights) < 2);
    CHECK(least_sum(weights) > 0.98);
    CHECK(most_sum(weights) < 1.02);
  }
}

TEST_CASE("nodes_in_one_place_share_what_it_feels") {
  const MatrixXd weights = load_weights(places({{0.1, 0, 0}, {0.1, 0, 0}}), flesh());
  CHECK((weights.col(0) - weights.col(1)).norm() < 1e-9);
}

TEST_CASE("flesh_of_another_bone_hears_half_as_much") {
  const MatrixXd own = load_weights(places(kCorners), places({{0, 0, 0}})),
                 other = load_weights(places(kCorners), places({{0, 0, 0}}, 1));
  CHECK(other.sum() == Approx(0.5 * own.sum()).epsilon(0.01));
}

// Nodes that swing by themselves, and flesh far from them that does not.
TEST_CASE("what_nodes_swing_by_is_not_taken_for_far_flesh_s") {
  LoadPlaces nodes = places(kCorners);
  nodes.answers.setZero();
  nodes.answers.col(0)(Eigen::seq(0, Eigen::last, 6)).setConstant(1);  // every second node along x
  Eigen::VectorXd swing = Eigen::VectorXd::Zero(8);
  for (Index n = 0; n < 8; n += 2) swing[n] = 1;
  const LoadPlaces far = places({{0, 0.5, 0}});
  const double with = (load_weights(nodes, far) * swing).norm();
  nodes.answers.setZero();
  CHECK(with < 0.9 * (load_weights(nodes, far) * swing).norm());
}
