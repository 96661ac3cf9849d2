// clip.cpp  Evaluates tracks, solves two-bone limbs, samples keys.
#include "baker/creature/clip.hpp"

#include <algorithm>
#include <cmath>

#include "baker/creature/body_field.hpp"

namespace sinew::baker {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Slope at a key that never overshoots (Fritsch and Carlson 1980), from the secants on both sides.
double key_slope(double before, double after) {
  return before * after <= 0 ? 0 : 2 * before * after / (before + after);
}

double periodic_spline(const std::vector<Vector2d>& keys, double t) {
  if (keys.size() == 1) return keys[0].y();
  const long count = static_cast<long>(keys.size());
  const auto key = [&](long i) -> Vector2d {
    const long turn = i < 0 ? -1 : i >= count ? 1 : 0;
    const Vector2d& k = keys[static_cast<size_t>(i - turn * count)];
    return {k.x() + static_cast<double>(turn), k.y()};
  };
  long span = -1;
  while (span + 1 < count && key(span + 1).x() <= t) ++span;
  const Vector2d a = key(span), b = key(span + 1);
  const auto secant = [](const Vector2d& p, const Vector2d& q) { return (q.y() - p.y()) / (q.x() - p.x()); };
  const double here = secant(a, b), width = b.x() - a.x(), u = (t - a.x()) / width;
  const Vector2d previous = key(span - 1), next = key(span + 2);
  const double slope_a = key_slope(secant(previous, a), here) * width;
  const double slope_b = key_slope(here, secant(b, next)) * width;
  const double u2 = u * u, u3 = u2 * u;
  return (2 * u3 - 3 * u2 + 1) * a.y() + (u3 - 2 * u2 + u) * slope_a + (3 * u2 - 2 * u3) * b.y() +
         (u3 - u2) * slope_b;
}

double swell(const Track& track, double t) {
  if (track.fade_in <= 0 && track.fade_out >= 1) return 1;
  const double u = (t - track.fade_in) / (track.fade_out - track.fade_in);
  return u <= 0 || u >= 1 ? 0 : std::pow(std::sin(M_PI * u), 2);
}

double track_value(const Track& track, double t) {
  t -= std::floor(t);
  double value = track.keys.empty() ? 0 : periodic_spline(track.keys, t);
  if (track.amplitude != 0)
    value += track.amplitude * swell(track, t) * std::sin(2 * M_PI * (track.cycles * t + track.phase));
  return value;
}

struct JointPose {
  Vector3d move = Vector3d::Zero(), turn_deg = Vector3d::Zero();
};

struct SolvedJoint {
  Matrix3d local, global;
  Vector3d offset, place;  // relative to the parent; in the character
};

class ClipSampler {
 public:
  ClipSampler(const CreatureRecipe& recipe, const ClipRecipe& clip) : recipe_(recipe), clip_(clip) {
    for (const JointRecipe& joint : recipe.joints)
      parents_.push_back(joint.parent.empty() ? -1 : joint_index(recipe, joint.parent));
  }

  std::vector<SolvedJoint> sample(double t) const {
    std::vector<JointPose> pose(recipe_.joints.size());
    add_tracks(recipe_.stance, t, pose);
    add_tracks(clip_.tracks, t, pose);
    std::vector<SolvedJoint> solved(pose.size());
    for (size_t j = 0; j < pose.size(); ++j) place(j, pose[j], solved);
    for (const LimbRecipe& limb : recipe_.limbs) solve_limb(limb, pose, solved);
    return solved;
  }

 private:
  void add_tracks(const std::vector<Track>& tracks, double t, std::vector<JointPose>& pose) const {
    for (const Track& track : tracks) {
      double gain = 1, delay = 0;
      for (const std::string& name : track.joints) {
        JointPose& joint = pose[static_cast<size_t>(joint_index(recipe_, name))];
        const int axis = static_cast<int>(track.axis);
        (axis < 3 ? joint.move[axis] : joint.turn_deg[axis - 3]) += gain * track_value(track, t - delay);
        gain *= track.gain;
        delay += track.lag;
      }
    }
  }

  void place(size_t j, const JointPose& pose, std::vector<SolvedJoint>& solved) const {
    SolvedJoint& joint = solved[j];
    joint.local = rotation_from_degrees(pose.turn_deg);
    joint.offset = rest_offset(recipe_, static_cast<int>(j)) + pose.move;
    attach(j, solved);
  }

  void attach(size_t j, std::vector<SolvedJoint>& solved) const {
    SolvedJoint& joint = solved[j];
    const int parent = parents_[j];
    joint.global = joint.local;
    joint.place = joint.offset;
    if (parent < 0) return;
    const SolvedJoint& above = solved[static_cast<size_t>(parent)];
    joint.global = above.global * joint.local;
    joint.place = above.place + above.global * joint.offset;
  }

  static Matrix3d basis(const Vector3d& along, const Vector3d& bend) {
    Matrix3d axes;
    axes.col(0) = along.normalized();
    axes.col(1) = (bend - axes.col(0) * axes.col(0).dot(bend)).normalized();
    axes.col(2) = axes.col(0).cross(axes.col(1));
    return axes;
  }

  // The end goes where the clip puts it in the root's space and keeps its own turn there; the two bones
  // follow.
  void solve_limb(const LimbRecipe& limb, const std::vector<JointPose>& pose,
                  std::vector<SolvedJoint>& solved) const {
    const size_t upper = static_cast<size_t>(joint_index(recipe_, limb.upper));
    const size_t lower = static_cast<size_t>(joint_index(recipe_, limb.lower));
    const size_t end = static_cast<size_t>(joint_index(recipe_, limb.end));
    const Vector3d bone_1 = recipe_.joints[lower].at - recipe_.joints[upper].at;
    const Vector3d bone_2 = recipe_.joints[end].at - recipe_.joints[lower].at;
    const SolvedJoint& root = solved[0];
    const SolvedJoint& above = solved[static_cast<size_t>(parents_[upper])];
    const Vector3d start = solved[upper].place;
    const Vector3d goal =
        root.place + root.global * (recipe_.joints[end].at - recipe_.joints[0].at + pose[end].move);

    constexpr double kNearlyStraight = 0.999;
    const double a = bone_1.norm(), b = bone_2.norm();
    const double reach = std::clamp((goal - start).norm(), std::abs(a - b) + 1e-3, kNearlyStraight * (a + b));
    const Matrix3d plane = basis(goal - start, above.global * limb.bend);
    const double along = (a * a - b * b + reach * reach) / (2 * reach);
    const double aside = std::sqrt(std::max(0.0, a * a - along * along));
    const Vector3d middle = start + along * plane.col(0) + aside * plane.col(1);
    const Vector3d stop = start + reach * plane.col(0);

    solved[upper].local =
        above.global.transpose() * basis(middle - start, plane.col(1)) * basis(bone_1, limb.bend).transpose();
    attach(upper, solved);
    solved[lower].local = solved[upper].global.transpose() * basis(stop - middle, plane.col(1)) *
                          basis(bone_2, limb.bend).transpose();
    solved[lower].offset = bone_1;
    attach(lower, solved);
    solved[end].local =
        solved[lower].global.transpose() * root.global * rotation_from_degrees(pose[end].turn_deg);
    solved[end].offset = bone_2;
    attach(end, solved);
    for (size_t j = end + 1; j < solved.size(); ++j)
      if (parents_[j] == static_cast<int>(end)) attach(j, solved);
  }

  const CreatureRecipe& recipe_;
  const ClipRecipe& clip_;
  std::vector<int> parents_;
};

bool moves(const JointKeys& keys, const Vector3d& rest) {
  return std::any_of(keys.translation.begin(), keys.translation.end(),
                     [&](const Vector3d& v) { return (v - rest).norm() > 1e-6; });
}

bool turns(const JointKeys& keys) {
  return std::any_of(keys.rotation.begin(), keys.rotation.end(),
                     [](const Quaterniond& q) { return q.vec().norm() > 1e-6; });
}

}  // namespace

int joint_index(const CreatureRecipe& recipe, const std::string& name) {
  for (size_t j = 0; j < recipe.joints.size(); ++j)
    if (recipe.joints[j].name == name) return static_cast<int>(j);
  return -1;
}

Vector3d rest_offset(const CreatureRecipe& recipe, int joint) {
  const JointRecipe& own = recipe.joints[static_cast<size_t>(joint)];
  if (own.parent.empty()) return own.at;
  return own.at - recipe.joints[static_cast<size_t>(joint_index(recipe, own.parent))].at;
}

ClipKeys key_clip(const CreatureRecipe& recipe, const ClipRecipe& clip) {
  const ClipSampler sampler(recipe, clip);
  const size_t spans =
      std::max<size_t>(2, static_cast<size_t>(std::lround(clip.duration_s * recipe.key_rate_hz)));
  ClipKeys keys{clip.name, {}, std::vector<JointKeys>(recipe.joints.size())};
  for (size_t k = 0; k <= spans; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(spans);
    keys.times_s.push_back(share * clip.duration_s);
    const std::vector<SolvedJoint> pose = sampler.sample(k == spans ? 0 : share);
    for (size_t j = 0; j < pose.size(); ++j) {
      Quaterniond rotation(pose[j].local);
      auto& row = keys.joints[j].rotation;
      if (!row.empty() && row.back().dot(rotation) < 0) rotation.coeffs() *= -1;
      row.push_back(rotation.normalized());
      keys.joints[j].translation.push_back(pose[j].offset);
    }
  }
  for (size_t j = 0; j < keys.joints.size(); ++j) {
    keys.joints[j].joint = static_cast<int>(j);
    if (!moves(keys.joints[j], rest_offset(recipe, static_cast<int>(j)))) keys.joints[j].translation.clear();
    if (!turns(keys.joints[j])) keys.joints[j].rotation.clear();
  }
  return keys;
}

}  // namespace sinew::baker
