// trajectory.cpp  A simulated motion as the file the trainer and the demo read.
#include "baker/truth/trajectory.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstring>

#include "baker/common/bad_input.hpp"
#include "baker/mesh/graph/node_record.hpp"
#include "sinew/types.hpp"
#include "tissue/frames/node_bend.hpp"
#include "tissue/frames/node_drive.hpp"

namespace sinew::baker {
namespace {

void push(std::vector<float>* to, const Vector3& value) {
  for (int k = 0; k < 3; ++k) to->push_back(static_cast<float>(value[k]));
}

template <class T>
Tensor tensor_of(Dtype dtype, std::vector<size_t> shape, const std::vector<T>& values) {
  Tensor out{dtype, std::move(shape), std::vector<unsigned char>(values.size() * sizeof(T))};
  if (!values.empty()) std::memcpy(out.bytes.data(), values.data(), out.bytes.size());
  return out;
}

}  // namespace

TrajectoryRecorder::TrajectoryRecorder(const Character& character, const TissueLayout& layout,
                                       const TrajectoryOptions& options, std::vector<ModalBasis> modes)
    : character_(character),
      layout_(layout),
      options_(options),
      modes_(std::move(modes)),
      most_m_s2_(TeleportDef{}.acceleration * static_cast<float>(height_m(character))) {
  if (modes_.size() != layout.regions.size())
    throw BadInput("trajectory: " + std::to_string(modes_.size()) + " modal bases for " +
                   std::to_string(layout.regions.size()) + " regions");
  for (const ControlNode& node : layout.nodes) nodes_.push_back(node_record(node));
  for (size_t r = 0; r < layout.regions.size() && options.surface; ++r)
    for (const int vertex : layout.regions[r].vertices) {
      const auto v = static_cast<size_t>(vertex);
      carried_.push_back(node_record(
          {vertex, static_cast<int>(r), character.positions[v], character.normals[v], 0, character.skin[v]}));
    }
}

std::vector<tissue::NodePose> TrajectoryRecorder::poses_of(const std::vector<pack::NodeRecord>& points,
                                                           const WorldPose& pose) const {
  std::vector<float> skin;
  for (size_t j = 0; j < pose.joints.size(); ++j) {
    const Matrix4 matrix = pose.joints[j] * character_.inverse_bind[j];
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column) skin.push_back(static_cast<float>(matrix(row, column)));
  }
  const Eigen::Quaternionf turn(Eigen::Quaterniond(pose.root.topLeftCorner<3, 3>()).cast<float>());
  std::vector<tissue::NodePose> poses(points.size());
  tissue::pose_nodes(points, skin.data(), turn.coeffs().data(), poses.data());
  return poses;
}

void TrajectoryRecorder::add(const TruthFrame& frame) {
  add_nodes(frame);
  if (options_.surface) add_surface(frame);
  add_pose(frame);
  energy_.push_back(frame.elastic_energy_j);
  energy_.push_back(frame.kinetic_energy_j);
  ++ticks_;
}

namespace {

// The truth less the skinning, along a node's frame, or along the flesh of a point on the surface.
Vector3 displacement_of(const TruthFrame& frame, int vertex, const tissue::NodePose& pose) {
  const auto v = static_cast<size_t>(vertex);
  const Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>> axes(pose.rotation);
  return axes.cast<double>().transpose() * (frame.truth[v] - frame.skinned[v]);
}

}  // namespace

void TrajectoryRecorder::add_nodes(const TruthFrame& frame) {
  constexpr size_t kTicks = 3;
  poses_.insert(poses_.begin(), poses_of(nodes_, frame.pose));
  for (size_t r = 0; r < layout_.regions.size(); ++r)
    tissue::share_bend(static_cast<uint32_t>(modes_[r].anchor_node),
                       static_cast<uint32_t>(layout_.regions[r].node_count),
                       poses_[0].data() + layout_.regions[r].first_node);
  roots_.insert(roots_.begin(), frame.pose.root.topRightCorner<3, 1>());
  while (poses_.size() < kTicks) poses_.push_back(poses_.back()), roots_.push_back(roots_.back());
  poses_.resize(kTicks), roots_.resize(kTicks);

  tissue::NodeMotion motion;
  motion.most_m_s2 = most_m_s2_;
  for (size_t tick = 0; tick < kTicks; ++tick) {
    motion.pose[tick] = poses_[tick].data();
    for (int k = 0; k < 3; ++k) motion.root_position_m[tick][k] = roots_[tick][k];
  }
  drive_.resize(drive_.size() + nodes_.size() * tissue::kNodeDriveWidth);
  tissue::compute_node_drive(motion, static_cast<float>(1 / options_.rate_hz),
                             static_cast<uint32_t>(nodes_.size()),
                             &drive_[drive_.size() - nodes_.size() * tissue::kNodeDriveWidth]);
  for (size_t n = 0; n < nodes_.size(); ++n) {
    rotation_.insert(rotation_.end(), poses_[0][n].rotation, poses_[0][n].rotation + 9);
    push(&displacement_, displacement_of(frame, layout_.nodes[n].vertex, poses_[0][n]));
  }
}

void TrajectoryRecorder::add_surface(const TruthFrame& frame) {
  const std::vector<tissue::NodePose> poses = poses_of(carried_, frame.pose);
  size_t next = 0;
  for (const Region& region : layout_.regions)
    for (const int vertex : region.vertices) {
      const Vector3 u = displacement_of(frame, vertex, poses[next++]);
      for (int k = 0; k < 3; ++k) surface_.push_back(Eigen::half(static_cast<float>(u[k])));
    }
}

void TrajectoryRecorder::add_pose(const TruthFrame& frame) {
  for (const Matrix4& joint : frame.pose.joints)
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column) joints_.push_back(static_cast<float>(joint(row, column)));
  const Matrix4& root = frame.pose.root;
  const Eigen::Quaterniond turn(Eigen::Matrix3d(root.topLeftCorner<3, 3>()));
  for (int k = 0; k < 3; ++k) root_.push_back(root(k, 3));
  for (int k = 0; k < 4; ++k) root_.push_back(turn.coeffs()[k]);
  if (!options_.positions) return;
  const Matrix4 character_from_world = root.inverse();
  for (const Vector3& p : frame.truth) push(&positions_, (character_from_world * p.homogeneous()).head<3>());
}

void TrajectoryRecorder::add_statics(Safetensors* file) const {
  std::vector<float> position, normal, stiffness, radius;
  std::vector<int32_t> node_region, edges;
  for (const ControlNode& node : layout_.nodes) {
    const Region& region = layout_.regions[static_cast<size_t>(node.region)];
    push(&position, (node.position - region.center) / region.radius_m);
    push(&normal, node.normal);
    stiffness.push_back(static_cast<float>(node.stiffness));
    node_region.push_back(node.region);
  }
  for (const auto& [a, b] : layout_.edges) edges.insert(edges.end(), {a, b});
  for (const Region& region : layout_.regions) radius.push_back(static_cast<float>(region.radius_m));
  const size_t nodes = layout_.nodes.size(), regions = layout_.regions.size();
  file->tensors["node.rest_position"] = tensor_f32({nodes, 3}, position);
  file->tensors["node.rest_normal"] = tensor_f32({nodes, 3}, normal);
  file->tensors["node.stiffness"] = tensor_f32({nodes, 1}, stiffness);
  file->tensors["node.region"] = tensor_i32({nodes}, node_region);
  file->tensors["edges"] = tensor_i32({layout_.edges.size(), 2}, edges);
  file->tensors["region.radius_m"] = tensor_f32({regions}, radius);
}

void TrajectoryRecorder::add_carry(Safetensors* file) const {
  std::vector<int32_t> vertices, vertex_count;
  for (const Region& region : layout_.regions) {
    vertices.insert(vertices.end(), region.vertices.begin(), region.vertices.end());
    vertex_count.push_back(static_cast<int32_t>(region.vertices.size()));
  }
  const size_t regions = layout_.regions.size();
  file->tensors["region.vertices"] = tensor_i32({vertices.size()}, vertices);
  file->tensors["region.vertex_count"] = tensor_i32({regions}, vertex_count);
  for (size_t r = 0; r < regions; ++r) {
    std::vector<float> carry;
    for (const std::vector<double>& row : layout_.regions[r].carry)
      for (double weight : row) carry.push_back(static_cast<float>(weight));
    const std::vector<size_t> shape{layout_.regions[r].carry.size(), layout_.regions[r].vertices.size()};
    file->tensors["carry." + std::to_string(r)] = tensor_f32(shape, carry);
  }
}

void TrajectoryRecorder::add_modes(Safetensors* file) const {
  const auto rows = [](const Eigen::MatrixXd& m) {
    std::vector<float> out;
    for (Eigen::Index r = 0; r < m.rows(); ++r)
      for (Eigen::Index c = 0; c < m.cols(); ++c) out.push_back(static_cast<float>(m(r, c)));
    return tensor_f32({static_cast<size_t>(m.rows()), static_cast<size_t>(m.cols())}, out);
  };
  for (size_t r = 0; r < modes_.size(); ++r) {
    const std::string name = "modes." + std::to_string(r);
    file->tensors[name + ".rad_per_s"] = rows(modes_[r].rad_per_s.transpose());
    file->tensors[name + ".damping_ratio"] = rows(modes_[r].damping_ratio.transpose());
    file->tensors[name + ".shape"] = rows(modes_[r].shape);
    file->tensors[name + ".turn"] = rows(modes_[r].turn);
    file->tensors[name + ".force"] = rows(modes_[r].force);
    file->tensors[name + ".rest"] = rows(modes_[r].rest);
    file->tensors[name + ".rest_oscillator"] =
        rows(Eigen::RowVector2d(modes_[r].rest_rad_per_s, modes_[r].rest_damping_ratio));
    file->tensors[name + ".first"] =
        rows(Eigen::RowVector2d(modes_[r].first_rad_per_s, modes_[r].first_damping_ratio));
  }
}

Safetensors TrajectoryRecorder::finish(std::map<std::string, std::string> metadata) const {
  Safetensors file;
  const size_t nodes = layout_.nodes.size();
  file.metadata = std::move(metadata);
  file.metadata["sinew.trajectory"] = kTrajectoryVersion;
  file.tensors["drive"] = tensor_f32({ticks_, nodes, tissue::kNodeDriveWidth}, drive_);
  file.tensors["rotation"] = tensor_f32({ticks_, nodes, 9}, rotation_);
  file.tensors["displacement"] = tensor_f32({ticks_, nodes, 3}, displacement_);
  file.tensors["joints"] = tensor_f32({ticks_, character_.joint_node.size(), 12}, joints_);
  file.tensors["root"] = tensor_of(Dtype::kF64, {ticks_, 7}, root_);
  file.tensors["energy"] = tensor_of(Dtype::kF64, {ticks_, 2}, energy_);
  if (options_.surface)
    file.tensors["surface"] = tensor_of(Dtype::kF16, {ticks_, surface_.size() / ticks_ / 3, 3}, surface_);
  if (options_.positions)
    file.tensors["positions"] = tensor_f32({ticks_, character_.positions.size(), 3}, positions_);
  add_statics(&file);
  if (options_.surface) add_carry(&file);
  add_modes(&file);
  return file;
}

}  // namespace sinew::baker
