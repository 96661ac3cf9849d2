// skin.cpp  Skin weights from parts and bones.
#include "baker/creature/skin.hpp"

#include <algorithm>
#include <cmath>

#include "baker/creature/body_field.hpp"

namespace sinew::baker {
namespace {

using Eigen::Vector3d;
using WeightTable = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;  // vertex, joint

double distance_to_bone(const JointRecipe& joint, const Vector3d& point) {
  const Vector3d along = joint.tip - joint.at;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp((point - joint.at).dot(along) / length2, 0.0, 1.0) : 0;
  return (point - joint.at - t * along).norm();
}

struct Muscle {  // a part and the joints that move it
  SolidField solid;
  std::vector<int> joints;
};

std::vector<Muscle> muscles_of(const CreatureRecipe& recipe) {
  std::vector<Muscle> muscles;
  for (const BodyPart& part : recipe.body)
    if (!part.carve) muscles.push_back({SolidField(part.solid), matching_joints(recipe, part.joints)});
  return muscles;
}

void add_shares(const CreatureRecipe& recipe, const Muscle& muscle, const Vector3d& point, double weight,
                WeightTable& table, long row) {
  constexpr double kOnBone_m = 0.005;
  std::vector<double> shares;
  double sum = 0;
  for (int joint : muscle.joints) {
    const double distance = distance_to_bone(recipe.joints[static_cast<size_t>(joint)], point) + kOnBone_m;
    shares.push_back(std::pow(distance, -recipe.skin.sharpness));
    sum += shares.back();
  }
  for (size_t i = 0; i < shares.size(); ++i) table(row, muscle.joints[i]) += weight * shares[i] / sum;
}

void weigh_vertex(const CreatureRecipe& recipe, const std::vector<Muscle>& muscles, const Vector3d& point,
                  WeightTable& table, long row) {
  std::vector<double> distance;
  for (const Muscle& muscle : muscles) distance.push_back(muscle.solid.sample(point).distance);
  const double nearest = *std::min_element(distance.begin(), distance.end());
  for (size_t i = 0; i < muscles.size(); ++i) {
    const double closeness = 1 - (distance[i] - nearest) / recipe.skin.overlap_m;
    if (closeness > 0) add_shares(recipe, muscles[i], point, closeness * closeness, table, row);
  }
  table.row(row) /= table.row(row).sum();
}

double mean_edge(const Surface& surface, const std::vector<std::vector<int>>& neighbours) {
  double sum = 0, count = 0;
  for (size_t v = 0; v < neighbours.size(); ++v)
    for (int n : neighbours[v]) {
      sum += (surface.positions[v] - surface.positions[static_cast<size_t>(n)]).norm();
      ++count;
    }
  return sum / count;
}

// Diffusion over a length: each round of averaging spreads by about edge / sqrt(2).
void smooth(const Surface& surface, double width_m, WeightTable& table) {
  const auto neighbours = vertex_neighbours(surface);
  const double edges = width_m / mean_edge(surface, neighbours);
  const int rounds = static_cast<int>(std::ceil(2 * edges * edges));
  for (int round = 0; round < rounds; ++round) {
    const WeightTable before = table;
    for (size_t v = 0; v < neighbours.size(); ++v) {
      const long row = static_cast<long>(v);
      for (int n : neighbours[v]) table.row(row) += before.row(n);
      table.row(row) *= 1 / (1 + static_cast<double>(neighbours[v].size()));
    }
  }
}

SkinWeights strongest(const Eigen::RowVectorXd& row) {
  constexpr double kNegligible = 0.01;
  std::vector<int> order(static_cast<size_t>(row.size()));
  for (size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return row[a] > row[b]; });
  SkinWeights skin;
  double sum = 0;
  for (size_t i = 0; i < std::min(kCreatureInfluences, order.size()); ++i) {
    if (row[order[i]] < kNegligible) break;
    skin.joint[i] = order[i];
    skin.weight[i] = row[order[i]];
    sum += skin.weight[i];
  }
  for (double& weight : skin.weight) weight /= sum;
  return skin;
}

}  // namespace

std::vector<int> matching_joints(const CreatureRecipe& recipe, const std::vector<std::string>& names) {
  std::vector<int> found;
  for (size_t j = 0; j < recipe.joints.size(); ++j)
    for (const std::string& name : names) {
      const std::string& joint = recipe.joints[j].name;
      const bool prefix = !name.empty() && name.back() == '*';
      if (prefix ? joint.starts_with(name.substr(0, name.size() - 1)) : joint == name) {
        found.push_back(static_cast<int>(j));
        break;
      }
    }
  return found;
}

std::vector<SkinWeights> skin_body(const CreatureRecipe& recipe, const Surface& surface) {
  const std::vector<Muscle> muscles = muscles_of(recipe);
  WeightTable table =
      WeightTable::Zero(static_cast<long>(surface.positions.size()), static_cast<long>(recipe.joints.size()));
  for (size_t v = 0; v < surface.positions.size(); ++v)
    weigh_vertex(recipe, muscles, surface.positions[v], table, static_cast<long>(v));
  smooth(surface, recipe.skin.smooth_m, table);
  std::vector<SkinWeights> skin;
  for (long v = 0; v < table.rows(); ++v) skin.push_back(strongest(table.row(v)));
  return skin;
}

}  // namespace sinew::baker
