// bind_pose.cpp  Skins stood on one skeleton.
#include "baker/import/skeleton/bind_pose.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "baker/import/character/pose.hpp"

namespace sinew::baker {
namespace {

using Eigen::Matrix3d;

constexpr double kSingular = 1e-12;  // relative determinant of a matrix that flattens space
constexpr double kSamePlace = 1e-4;  // of the largest entry: rounding of files, not a pose
constexpr double kSameScale = 1e-2;

double scale_of(const Matrix4& m) { return std::cbrt(std::abs(m.topLeftCorner<3, 3>().determinant())); }

// The rotation nearest to it.
Matrix3d rotation_of(const Matrix4& m) {
  const Eigen::JacobiSVD<Matrix3d> svd(m.topLeftCorner<3, 3>(), Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

bool is_same(const Matrix4& a, const Matrix4& b) {
  return (a - b).cwiseAbs().maxCoeff() <= kSamePlace * a.cwiseAbs().maxCoeff();
}

bool is_mirrored(const Matrix4& m) { return m.topLeftCorner<3, 3>().determinant() < 0; }

// Larger is nearer.
double alikeness(const Matrix4& a, const Matrix4& b) {
  return is_mirrored(a) != is_mirrored(b) ? -4 : (rotation_of(a).transpose() * rotation_of(b)).trace();
}

bool has_same_scale(const Matrix4& a, const Matrix4& b) {
  return std::abs(scale_of(a) / scale_of(b) - 1) < kSameScale;
}

// scene-from-mesh as the rest pose of the root joint has it, turned as `frame` is.
Matrix4 turned_as(const Matrix4& frame, const Matrix4& at_rest, const Vector3& root_in_mesh) {
  Matrix4 turned = at_rest;
  turned.topLeftCorner<3, 3>() =
      rotation_of(frame) * rotation_of(at_rest).transpose() * at_rest.topLeftCorner<3, 3>();
  if (has_same_scale(frame, at_rest))
    turned.topRightCorner<3, 1>() = frame.topRightCorner<3, 1>();
  else  // a mesh space of the exporter's own: the root joint stays where it rests
    turned.topRightCorner<3, 1>() =
        (at_rest * root_in_mesh.homogeneous()).head<3>() - turned.topLeftCorner<3, 3>() * root_in_mesh;
  return turned;
}

}  // namespace

bool is_invertible(const Matrix4& matrix) {
  const Matrix3d linear = matrix.topLeftCorner<3, 3>();
  const double scale = linear.colwise().norm().prod();
  return matrix.allFinite() && scale > 0 && std::abs(linear.determinant()) > kSingular * scale;
}

BindPose::BindPose(const SceneGraph& graph)
    : graph_(graph), is_known_(graph.nodes.size(), false), bound_(graph.nodes.size(), Matrix4::Identity()) {}

const Matrix4* BindPose::known(int node) const {
  return is_known_[static_cast<size_t>(node)] ? &bound_[static_cast<size_t>(node)] : nullptr;
}

Matrix4 BindPose::of_node(int node) const {
  Matrix4 below = Matrix4::Identity();
  for (int at = node; at >= 0; at = graph_.nodes[static_cast<size_t>(at)].parent) {
    if (const Matrix4* bound = known(at)) return *bound * below;
    below = local_matrix(graph_.nodes[static_cast<size_t>(at)]) * below;
  }
  return graph_.rest[static_cast<size_t>(node)];
}

// In which a mesh may have been modelled: those of the nodes above the skeleton, of the mesh's own and those
// above it, unless that hangs on a bone, and the scene.
std::vector<Matrix4> BindPose::likely_frames(const SkinBinds& skin, int root_joint) const {
  constexpr int kMostFrames = 64;  // of the nearest nodes above
  std::vector<Matrix4> frames;
  const auto add_from = [&](int node) {
    for (int up = 0; node >= 0 && up < kMostFrames;
         ++up, node = graph_.nodes[static_cast<size_t>(node)].parent)
      if (is_invertible(graph_.rest[static_cast<size_t>(node)]))
        frames.push_back(graph_.rest[static_cast<size_t>(node)]);
  };
  add_from(graph_.nodes[static_cast<size_t>(root_joint)].parent);
  std::vector<bool> in_skin(graph_.nodes.size(), false);
  for (const int node : skin.nodes) in_skin[static_cast<size_t>(node)] = true;
  int above = skin.mesh_node;
  while (above >= 0 && !in_skin[static_cast<size_t>(above)])
    above = graph_.nodes[static_cast<size_t>(above)].parent;
  if (above < 0) add_from(skin.mesh_node);
  frames.push_back(Matrix4::Identity());
  return frames;
}

// The first joint with none of the skin above it whose rest pose tells where the mesh is; -1: none.
int BindPose::root_of(const SkinBinds& skin) const {
  std::vector<bool> in_skin(graph_.nodes.size(), false), below(graph_.nodes.size(), false);
  for (int node : skin.nodes) in_skin[static_cast<size_t>(node)] = true;
  for (size_t i = 0; i < below.size(); ++i) {
    const int up = graph_.nodes[i].parent;
    below[i] = up >= 0 && (in_skin[static_cast<size_t>(up)] || below[static_cast<size_t>(up)]);
  }
  for (size_t j = 0; j < skin.nodes.size(); ++j)
    if (!below[static_cast<size_t>(skin.nodes[j])] && is_invertible(at_rest(skin, j)))
      return static_cast<int>(j);
  return -1;
}

Matrix4 BindPose::at_rest(const SkinBinds& skin, size_t joint) const {
  return graph_.rest[static_cast<size_t>(skin.nodes[joint])] * skin.inverse_bind[joint];
}

bool BindPose::rests_as_bound(const SkinBinds& skin) const {
  const int root = root_of(skin);
  if (root < 0) return false;
  const Matrix4 rest = at_rest(skin, static_cast<size_t>(root));
  return std::ranges::any_of(likely_frames(skin, skin.nodes[static_cast<size_t>(root)]),
                             [&](const Matrix4& frame) { return is_same(rest, frame); });
}

Matrix4 BindPose::scene_from_mesh(const SkinBinds& skin) const {
  const int root = root_of(skin);
  if (root >= 0)
    if (const Matrix4* bound = known(skin.nodes[static_cast<size_t>(root)]))
      return *bound * skin.inverse_bind[static_cast<size_t>(root)];
  for (size_t j = 0; j < skin.nodes.size(); ++j)
    if (const Matrix4* bound = known(skin.nodes[j])) return *bound * skin.inverse_bind[j];
  if (root < 0) return Matrix4::Identity();
  const auto j = static_cast<size_t>(root);
  const int node = skin.nodes[j];
  for (int up = node; up >= 0; up = graph_.nodes[static_cast<size_t>(up)].parent)
    if (known(up)) return of_node(node) * skin.inverse_bind[j];
  const Matrix4 rest = at_rest(skin, j);
  if (rests_as_bound(skin)) return rest;
  const std::vector<Matrix4> frames = likely_frames(skin, node);
  const auto fitness = [&](const Matrix4& frame) {  // of like ones that of the same size
    return alikeness(frame, rest) + (has_same_scale(frame, rest) ? 1e-3 : 0);
  };
  const Matrix4& nearest = *std::ranges::max_element(frames, {}, fitness);
  if (is_mirrored(nearest) != is_mirrored(rest)) return rest;
  return turned_as(nearest, rest, skin.inverse_bind[j].inverse().topRightCorner<3, 1>());
}

Matrix4 BindPose::add_skin(const SkinBinds& skin) {
  const Matrix4 from_mesh = scene_from_mesh(skin);
  for (size_t j = 0; j < skin.nodes.size(); ++j) {
    const auto node = static_cast<size_t>(skin.nodes[j]);
    if (is_known_[node]) continue;
    bound_[node] = from_mesh * skin.inverse_bind[j].inverse();
    is_known_[node] = true;
  }
  return from_mesh;
}

void BindPose::add_resting_skin(const SkinBinds& skin) {
  for (const int joint : skin.nodes) {
    const auto node = static_cast<size_t>(joint);
    if (!is_known_[node] && is_invertible(graph_.rest[node])) bound_[node] = graph_.rest[node];
    is_known_[node] = true;
  }
}

}  // namespace sinew::baker
