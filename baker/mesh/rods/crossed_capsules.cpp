// crossed_capsules.cpp  see crossed_capsules.hpp.
#include "baker/mesh/rods/crossed_capsules.hpp"

#include <algorithm>
#include <limits>

#include "baker/mesh/anatomy/joint_names.hpp"

namespace sinew::baker {
namespace {

constexpr int kSamplesAClip = 12;
constexpr int kPointsABone = 4;
constexpr double kDeeper = 0.1;  // of the bone's radius

Vector3 moved(const Matrix4& by, const Vector3& p) { return (by * p.homogeneous()).head<3>(); }

double distance_to_segment(const Vector3& p, const Vector3& from, const Vector3& to) {
  const Vector3 along = to - from;
  const double length2 = along.squaredNorm();
  const double share = length2 > 0 ? std::clamp(along.dot(p - from) / length2, 0.0, 1.0) : 0;
  return (p - from - share * along).norm();
}

// A pose as what it does to the bind pose, a joint.
using Motions = std::vector<Matrix4>;

Motions motions_of(const Character& character, const Clip& clip, double t_s) {
  Motions motions = joint_matrices(character, &clip, t_s);
  for (size_t j = 0; j < motions.size(); ++j) motions[j] = motions[j] * character.inverse_bind[j];
  return motions;
}

// How deep the bone's axis, as thick as the bone, is in the capsule.
double depth(const RodBone& bone, const Proxy& proxy, const Motions& motions) {
  const Matrix4 &of_bone = motions[static_cast<size_t>(bone.joint)],
                &of_capsule = motions[static_cast<size_t>(proxy.joint)];
  const Vector3 from = moved(of_capsule, proxy.from), to = moved(of_capsule, proxy.to);
  double nearest = std::numeric_limits<double>::infinity();
  for (int k = 0; k <= kPointsABone; ++k) {
    const Vector3 p = bone.begin + (bone.end - bone.begin) * k / kPointsABone;
    nearest = std::min(nearest, distance_to_segment(moved(of_bone, p), from, to));
  }
  return proxy.radius_m + bone.radius_m - nearest;
}

bool crosses(const RodBone& bone, const Proxy& proxy, const Motions& bind,
             const std::vector<Motions>& poses) {
  const double allowed = std::max(0.0, depth(bone, proxy, bind)) + kDeeper * bone.radius_m;
  return std::ranges::any_of(poses, [&](const Motions& pose) { return depth(bone, proxy, pose) > allowed; });
}

std::vector<Motions> sampled_poses(const Character& character) {
  std::vector<Motions> poses;
  for (const Clip& clip : character.clips)
    for (int i = 0; i < kSamplesAClip; ++i)
      poses.push_back(motions_of(character, clip, clip.duration_s * i / kSamplesAClip));
  return poses;
}

}  // namespace

void drop_crossed(Character& character, const std::vector<Rod>& rods, const Recipe& recipe,
                  std::vector<Proxy>& proxies) {
  if (rods.empty() || proxies.empty() || !character.colliders.empty()) return;
  std::vector<std::string> stated_names;
  for (const ProxyRecipe& own : recipe.proxies) stated_names.push_back(own.joint);
  const std::vector<bool> stated = match_joints(character, stated_names, "recipe: \"proxies\"");
  const Motions bind(character.joint_node.size(), Matrix4::Identity());
  const std::vector<Motions> poses = sampled_poses(character);
  std::string dropped;
  std::erase_if(proxies, [&](const Proxy& proxy) {
    if (stated[static_cast<size_t>(proxy.joint)]) return false;
    const bool crossed = std::ranges::any_of(rods, [&](const Rod& rod) {
      return std::ranges::any_of(rod.bones, [&](const RodBone& bone) {
        return bone.joint >= 0 && crosses(bone, proxy, bind, poses);
      });
    });
    if (crossed)
      dropped +=
          (dropped.empty() ? "'" : ", '") + joint_name(character, static_cast<size_t>(proxy.joint)) + "'";
    return crossed;
  });
  if (!dropped.empty())
    character.notes.push_back("rods do not collide with the capsules about " + dropped +
                              ", which clips lead them through; a recipe's \"proxies\" keeps one");
}

}  // namespace sinew::baker
