// trajectory.cpp  A simulated motion as the file the trainer and the demo read.
#include "baker/truth/trajectory.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstring>

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
                                       const TrajectoryOptions& options)
    : character_(character),
      layout_(layout),
      options_(options),
      motions_(layout.regions.size()),
      places_(3) {}

tissue::RegionFrame TrajectoryRecorder::frame_of(const Region& region, const WorldPose& pose) const {
  const auto joint = static_cast<size_t>(region.frame_joint);
  const Matrix4 skin = pose.joints[joint] * character_.inverse_bind[joint];
  const Eigen::Matrix<float, 3, 4, Eigen::RowMajor> skin_rows = skin.topRows<3>().cast<float>();
  const Eigen::Vector3f center = region.center.cast<float>();
  const Vector3 place = pose.root.topRightCorner<3, 1>();
  const Eigen::Quaternionf turn(Eigen::Quaterniond(pose.root.topLeftCorner<3, 3>()).cast<float>());
  return tissue::region_frame(skin_rows.data(), center.data(), place.data(), turn.coeffs().data());
}

void TrajectoryRecorder::add(const TruthFrame& frame) {
  std::rotate(places_.begin(), places_.end() - 1, places_.end());
  places_[0].clear();
  for (size_t region = 0; region < layout_.regions.size(); ++region) add_region(region, frame);
  add_pose(frame);
  energy_.push_back(frame.elastic_energy_j);
  energy_.push_back(frame.kinetic_energy_j);
  ++ticks_;
}

void TrajectoryRecorder::add_region(size_t index, const TruthFrame& frame) {
  const Region& region = layout_.regions[index];
  const tissue::RegionFrame now = frame_of(region, frame.pose);
  const Eigen::Matrix3d axes = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(now.rotation);
  const Vector3 origin = Eigen::Map<const Vector3>(now.place_m);
  const Eigen::Matrix3d region_from_world = axes.transpose();

  const auto first = static_cast<size_t>(region.first_node), count = static_cast<size_t>(region.node_count);
  for (size_t n = first; n < first + count; ++n) {
    const auto vertex = static_cast<size_t>(layout_.nodes[n].vertex);
    push(&places_[0], region_from_world * (frame.skinned[vertex] - origin));
    push(&displacement_, region_from_world * (frame.truth[vertex] - frame.skinned[vertex]));
  }

  if (ticks_ == 0) {  // at rest: the history is the present
    motions_[index].frame[0] = motions_[index].frame[1] = motions_[index].frame[2] = now;
    for (const size_t k : {size_t{1}, size_t{2}})
      places_[k].insert(places_[k].end(), places_[0].end() - static_cast<long>(3 * count), places_[0].end());
  } else {
    tissue::push_frame(&motions_[index], now);
  }
  drive_.resize(drive_.size() + count * tissue::kDriveWidth);
  tissue::compute_drive(motions_[index], static_cast<float>(1 / options_.rate_hz), &places_[0][3 * first],
                        &places_[1][3 * first], &places_[2][3 * first], static_cast<uint32_t>(count),
                        &drive_[drive_.size() - count * tissue::kDriveWidth]);
  if (options_.surface) add_surface(region_from_world, region, frame);
}

void TrajectoryRecorder::add_surface(const Eigen::Matrix3d& region_from_world, const Region& region,
                                     const TruthFrame& frame) {
  for (int v : region.vertices) {
    const auto vertex = static_cast<size_t>(v);
    const Vector3 u = region_from_world * (frame.truth[vertex] - frame.skinned[vertex]);
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
  std::vector<int32_t> node_region, edges, vertices, vertex_count;
  for (const ControlNode& node : layout_.nodes) {
    const Region& region = layout_.regions[static_cast<size_t>(node.region)];
    push(&position, (node.position - region.center) / region.radius_m);
    push(&normal, node.normal);
    stiffness.push_back(static_cast<float>(node.stiffness));
    node_region.push_back(node.region);
  }
  for (const auto& [a, b] : layout_.edges) edges.insert(edges.end(), {a, b});
  for (const Region& region : layout_.regions) {
    radius.push_back(static_cast<float>(region.radius_m));
    vertices.insert(vertices.end(), region.vertices.begin(), region.vertices.end());
    vertex_count.push_back(static_cast<int32_t>(region.vertices.size()));
  }
  const size_t nodes = layout_.nodes.size(), regions = layout_.regions.size();
  file->tensors["node.rest_position"] = tensor_f32({nodes, 3}, position);
  file->tensors["node.rest_normal"] = tensor_f32({nodes, 3}, normal);
  file->tensors["node.stiffness"] = tensor_f32({nodes, 1}, stiffness);
  file->tensors["node.region"] = tensor_i32({nodes}, node_region);
  file->tensors["edges"] = tensor_i32({layout_.edges.size(), 2}, edges);
  file->tensors["region.radius_m"] = tensor_f32({regions}, radius);
  if (!options_.surface) return;
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

Safetensors TrajectoryRecorder::finish(std::map<std::string, std::string> metadata) const {
  Safetensors file;
  const size_t nodes = layout_.nodes.size();
  file.metadata = std::move(metadata);
  file.metadata["sinew.trajectory"] = "1";
  file.tensors["drive"] = tensor_f32({ticks_, nodes, tissue::kDriveWidth}, drive_);
  file.tensors["displacement"] = tensor_f32({ticks_, nodes, 3}, displacement_);
  file.tensors["joints"] = tensor_f32({ticks_, character_.joint_node.size(), 12}, joints_);
  file.tensors["root"] = tensor_of(Dtype::kF64, {ticks_, 7}, root_);
  file.tensors["energy"] = tensor_of(Dtype::kF64, {ticks_, 2}, energy_);
  if (options_.surface)
    file.tensors["surface"] = tensor_of(Dtype::kF16, {ticks_, surface_.size() / ticks_ / 3, 3}, surface_);
  if (options_.positions)
    file.tensors["positions"] = tensor_f32({ticks_, character_.positions.size(), 3}, positions_);
  add_statics(&file);
  return file;
}

}  // namespace sinew::baker
