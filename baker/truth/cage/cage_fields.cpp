// cage_fields.cpp  What the surface knows, spread over a cage's nodes: skin influences, stiffness, distance
// to the surface.
#include "baker/truth/cage/cage_fields.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <limits>
#include <queue>

namespace sinew::baker {
namespace {

constexpr double kSmoothness = 0.1;  // weight of one cage edge against one sample

using Triplets = std::vector<Eigen::Triplet<double>>;

void add_edges(const CageTopology& topology, Triplets& normal) {
  for (const auto& t : topology.tetrahedra)
    for (const int a : t)
      for (const int b : t) {
        if (a == b) continue;
        normal.emplace_back(a, a, kSmoothness);
        normal.emplace_back(a, b, -kSmoothness);
      }
}

Eigen::SparseMatrix<double> normal_matrix(const CageTopology& topology,
                                          const std::vector<PlacedSample>& samples) {
  constexpr double kRegular = 1e-9;  // a part without samples has no values; zero then
  Triplets normal;
  add_edges(topology, normal);
  for (const PlacedSample& sample : samples) {
    const auto& t = topology.tetrahedra[static_cast<size_t>(sample.place.tetrahedron)];
    for (size_t a = 0; a < 4; ++a)
      for (size_t b = 0; b < 4; ++b)
        normal.emplace_back(t[a], t[b], sample.place.weight[a] * sample.place.weight[b]);
  }
  const auto count = static_cast<Eigen::Index>(topology.nodes.size());
  for (int i = 0; i < count; ++i) normal.emplace_back(i, i, kRegular);
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(normal.begin(), normal.end());
  return matrix;
}

// Right-hand sides: a column a joint, and the last for stiffness.
Eigen::MatrixXd surface_values(const Character& character, const std::vector<double>& vertex_stiffness,
                               const CageTopology& topology, const std::vector<PlacedSample>& samples) {
  const auto joints = static_cast<Eigen::Index>(character.joint_node.size());
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(topology.nodes.size()), joints + 1);
  Eigen::RowVectorXd value(joints + 1);
  for (const PlacedSample& sample : samples) {
    value.setZero();
    for (size_t c = 0; c < 3; ++c) {
      const auto vertex =
          static_cast<size_t>(character.triangles[static_cast<size_t>(sample.at.triangle)][c]);
      const Influences& skin = character.skin[vertex];
      for (size_t k = 0; k < kInfluences; ++k) value[skin.joint[k]] += sample.at.weight[c] * skin.weight[k];
      value[joints] += sample.at.weight[c] * vertex_stiffness[vertex];
    }
    const auto& t = topology.tetrahedra[static_cast<size_t>(sample.place.tetrahedron)];
    for (size_t a = 0; a < 4; ++a) sum.row(t[a]) += sample.place.weight[a] * value;
  }
  return sum;
}

Influences strongest(const Eigen::MatrixXd& fields, Eigen::Index node, Eigen::Index joints) {
  std::vector<std::pair<double, int>> all;
  for (int j = 0; j < joints; ++j)
    if (fields(node, j) > 1e-4) all.emplace_back(-fields(node, j), j);
  std::sort(all.begin(), all.end());
  if (all.size() > kInfluences) all.resize(kInfluences);
  Influences skin;
  double sum = 0;
  for (const auto& entry : all) sum -= entry.first;
  for (size_t k = 0; k < all.size(); ++k) {
    skin.joint[k] = all[k].second;
    skin.weight[k] = -all[k].first / sum;
  }
  if (all.empty()) skin.weight[0] = 1;
  return skin;
}

}  // namespace

CageFields fit_fields(const Character& character, const std::vector<double>& vertex_stiffness,
                      const CageTopology& topology, const std::vector<PlacedSample>& samples) {
  constexpr double kTolerance = 1e-6;
  const Eigen::SparseMatrix<double> matrix = normal_matrix(topology, samples);
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver(matrix);
  solver.setTolerance(kTolerance);
  Eigen::MatrixXd values = surface_values(character, vertex_stiffness, topology, samples);
  for (Eigen::Index j = 0; j < values.cols(); ++j)
    if (!values.col(j).isZero(0)) values.col(j) = solver.solve(values.col(j)).eval();
  CageFields fields;
  const Eigen::Index joints = values.cols() - 1;
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    fields.skin.push_back(strongest(values, i, joints));
    fields.stiffness.push_back(std::clamp(values(i, joints), 0.0, 1.0));
  }
  return fields;
}

std::vector<double> surface_distance(const CageTopology& topology, const std::vector<PlacedSample>& samples) {
  std::vector<std::vector<int>> around(topology.nodes.size());
  for (const auto& t : topology.tetrahedra)
    for (const int a : t)
      for (const int b : t)
        if (a != b) around[static_cast<size_t>(a)].push_back(b);
  struct Candidate {
    double distance;
    int node;
    size_t sample;
    bool operator<(const Candidate& other) const { return distance > other.distance; }
  };
  std::priority_queue<Candidate> queue;
  std::vector<double> best(topology.nodes.size(), std::numeric_limits<double>::max());
  const auto offer = [&](int node, size_t sample) {
    const double distance = (samples[sample].at.position - topology.nodes[static_cast<size_t>(node)]).norm();
    if (distance >= best[static_cast<size_t>(node)]) return;
    best[static_cast<size_t>(node)] = distance;
    queue.push({distance, node, sample});
  };
  for (size_t s = 0; s < samples.size(); ++s)
    for (const int node : topology.tetrahedra[static_cast<size_t>(samples[s].place.tetrahedron)])
      offer(node, s);
  while (!queue.empty()) {
    const Candidate next = queue.top();
    queue.pop();
    if (next.distance > best[static_cast<size_t>(next.node)]) continue;
    for (const int node : around[static_cast<size_t>(next.node)]) offer(node, next.sample);
  }
  return best;
}

}  // namespace sinew::baker
