// player.cpp  The public API, and skinning beside it.
#include "baker/audit/player.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "baker/common/bad_input.hpp"

namespace sinew::baker {
namespace {

using RowMajor = Eigen::Matrix<float, 3, 4, Eigen::RowMajor>;

void must(const Status& status) {
  if (!status.ok()) throw BadInput(status.message);
}

Eigen::Matrix<float, 3, 4> matrix_of(const Matrix34& matrix) {
  return Eigen::Map<const RowMajor>(&matrix.m[0][0]);
}

Eigen::Affine3f bind_of(const pack::JointRecord& joint) {
  Eigen::Affine3f inverse = Eigen::Affine3f::Identity();
  inverse.affine() = Eigen::Map<const RowMajor>(joint.inverse_bind);
  return inverse;
}

}  // namespace

Player::Player(const AuditedPack& pack, const AuditMotion& motion) : pack_(pack), motion_(motion) {
  const pack::PackView& view = pack.view;
  WorldDef def;
  constexpr float kNever = std::numeric_limits<float>::infinity();
  def.teleport = {kNever, kNever, kNever, kNever};  // an audit's motions have no cuts
  must(World::create(def, &world_));
  AssetId asset;
  must(world_.load_asset(pack.bytes, &asset));
  must(world_.create_instance({.asset = asset}, &instance_));
  tick_s_ = 1 / static_cast<double>(view.network->rate_hz);
  moving_ticks_ = static_cast<size_t>(std::lround(motion.moving_s / tick_s_));
  ticks_ = moving_ticks_ + static_cast<size_t>(std::lround(motion.resting_s / tick_s_));
  posed_.resize(view.joints.size());
  displayed_.resize(view.joints.size());
  shown_.resize(3, view.character->vertex_count);
  skinned_.resize(3, view.character->vertex_count);
  set_pose();
  world_.step(static_cast<float>(tick_s_));  // the first pose was held for ever
}

void Player::set_pose() {
  RootTransform root;
  motion_.pose_at(static_cast<double>(tick_) * tick_s_, posed_, &root);
  must(world_.set_pose(instance_, {.joints = posed_, .root = root}));
}

void Player::advance() {
  ++tick_;
  set_pose();
  world_.step(static_cast<float>(tick_s_));
  must(world_.read_joint_matrices(instance_, displayed_));
}

void Player::read() {
  const pack::PackView& view = pack_.view;
  must(world_.read_positions(instance_, {.out = shown_.data(), .capacity = view.character->vertex_count}));
  std::vector<Eigen::Matrix<float, 3, 4>> matrix(posed_.size());
  for (size_t j = 0; j < matrix.size(); ++j) {
    Eigen::Affine3f joint = Eigen::Affine3f::Identity();
    joint.affine() = matrix_of(posed_[j]);
    matrix[j] = (joint * bind_of(view.joints[j])).affine();
  }
  for (Eigen::Index v = 0; v < skinned_.cols(); ++v) {
    const pack::SkinRecord& skin = view.skin[static_cast<size_t>(v)];
    Eigen::Matrix<float, 3, 4> blended = Eigen::Matrix<float, 3, 4>::Zero();
    for (size_t k = 0; k < pack::kInfluences && skin.weight[k] > 0; ++k)
      blended += skin.weight[k] * matrix[skin.joint[k]];
    const Eigen::Map<const Eigen::Vector3f> bind(view.positions.data() + 3 * v);
    skinned_.col(v) = blended.leftCols<3>() * bind + blended.col(3);
  }
}

Eigen::Matrix3f Player::turn_of(uint32_t joint) const {
  const pack::PackView& view = pack_.view;
  if (view.joint_rods.empty() || view.joint_rods[joint] == pack::kNoIndex) return Eigen::Matrix3f::Identity();
  return matrix_of(displayed_[joint]).leftCols<3>() * matrix_of(posed_[joint]).leftCols<3>().inverse();
}

Eigen::Matrix3Xf Player::rod_ends(const pack::RodRecord& rod, bool posed) const {
  const pack::PackView& view = pack_.view;
  const std::vector<Matrix34>& joints = posed ? posed_ : displayed_;
  Eigen::Matrix3Xf ends(3, rod.segment_count);
  for (uint32_t s = 0; s < rod.segment_count; ++s) {
    const pack::RodSegmentRecord* segment = &view.rod_segments[rod.first_segment + s];
    const Eigen::Vector3f end = Eigen::Map<const Eigen::Vector3f>(segment->end_m);
    while (segment->joint == pack::kNoIndex &&
           segment->parent != pack::kNoIndex)  // a link moves with its bone
      segment = &view.rod_segments[rod.first_segment + segment->parent];
    const uint32_t joint = segment->joint == pack::kNoIndex ? rod.attach : segment->joint;
    Eigen::Affine3f placed = Eigen::Affine3f::Identity();
    placed.affine() = matrix_of(joints[joint]);
    ends.col(s) = placed * (bind_of(view.joints[joint]) * end);
  }
  return ends;
}

InstanceReport Player::report() const {
  InstanceReport report;
  must(world_.report(instance_, &report));
  return report;
}

}  // namespace sinew::baker
