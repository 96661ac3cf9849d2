// anatomy.cpp  The spine by heads and limbs, forward by feet.
#include "baker/mesh/anatomy/anatomy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "baker/mesh/anatomy/bone_names.hpp"
#include "baker/mesh/anatomy/bones.hpp"
#include "baker/mesh/anatomy/joint_names.hpp"

namespace sinew::baker {
namespace {

constexpr double kMovesFlesh = 0.02;  // largest skin weight
constexpr double kMedian = 0.02;      // of the height, from the plane of symmetry
constexpr double kSoles = 0.04;       // of the height: what is lower is foot
constexpr double kFewestFeet = 1e-3;  // of the height: toes that point less far forward say nothing

// What is left and right of it is alike.
struct MiddlePlane {
  int axis = 0;  // across it: 0 x, 2 z
  double at_m = 0;
  double aside(const Vector3& place) const { return place[axis] - at_m; }
};

struct Skin {
  std::vector<double> most, sum, aside;  // of a joint: largest and summed weight, that times the way aside
};

Skin weigh(const Character& character, const MiddlePlane& middle) {
  Skin skin{std::vector<double>(character.joint_node.size(), 0), {}, {}};
  skin.sum = skin.aside = skin.most;
  for (size_t v = 0; v < character.skin.size(); ++v)
    for (size_t k = 0; k < kInfluences; ++k) {
      const auto joint = static_cast<size_t>(character.skin[v].joint[k]);
      const double weight = character.skin[v].weight[k];
      skin.most[joint] = std::max(skin.most[joint], weight);
      skin.sum[joint] += weight;
      skin.aside[joint] += weight * middle.aside(character.positions[v]);
    }
  return skin;
}

// From a joint to the root, and the other way round.
std::vector<int> path_to(const Character& character, int joint) {
  std::vector<int> path;
  for (; joint >= 0; joint = character.joint_parent[static_cast<size_t>(joint)]) path.push_back(joint);
  std::ranges::reverse(path);
  return path;
}

// The joints of the trunk end at the head with most flesh, else at the median joint with most flesh above it.
int upper_end(const Character& character, const std::vector<NameMeaning>& meaning, const Skin& skin,
              const std::vector<bool>& median) {
  int head = -1, other = -1;
  double most_flesh = 0, most_above = 0;
  std::vector<double> above = skin.sum;  // with all that it hangs on
  for (size_t j = 0; j < above.size(); ++j) {
    if (character.joint_parent[j] >= 0) above[j] += above[static_cast<size_t>(character.joint_parent[j])];
    if (meaning[j].face && skin.sum[j] > most_flesh) most_flesh = skin.sum[j], head = static_cast<int>(j);
    const bool body = !meaning[j].kind && !meaning[j].helper;
    if (body && median[j] && skin.most[j] > kMovesFlesh && above[j] > most_above)
      most_above = above[j], other = static_cast<int>(j);
  }
  return head >= 0 ? head : other;
}

std::vector<bool> on_median(const std::vector<Vector3>& heads, const MiddlePlane& middle, double height) {
  std::vector<bool> median;
  for (const Vector3& place : heads) median.push_back(std::abs(middle.aside(place)) <= kMedian * height);
  return median;
}

// Limbs come in pairs: the joint in the middle of all is the spine's, wherever the character stands.
MiddlePlane plane_across(const std::vector<Vector3>& heads, int axis) {
  std::vector<double> places;
  for (const Vector3& place : heads) places.push_back(place[axis]);
  const auto middle = places.begin() + static_cast<std::ptrdiff_t>(places.size() / 2);
  std::ranges::nth_element(places, middle);
  return {axis, *middle};
}

// Of each joint, whether a pair of limbs hangs on it: flesh to the left and to the right, each on two bones
// or on one that is called a limb.
std::vector<bool> carries_limbs(const Character& character, const std::vector<NameMeaning>& meaning,
                                const Skin& skin, double height) {
  const size_t count = skin.sum.size();
  std::vector<int> bones(count, 0);
  std::vector<double> weight = skin.sum, aside = skin.aside;  // with all that hangs on it
  for (size_t j = count; j-- > 0;) {
    bones[j] += skin.most[j] > kMovesFlesh ? 1 + (meaning[j].body ? 1 : 0) : 0;
    if (character.joint_parent[j] < 0) continue;
    const auto up = static_cast<size_t>(character.joint_parent[j]);
    bones[up] += bones[j];
    weight[up] += weight[j];
    aside[up] += aside[j];
  }
  std::vector<bool> left(count, false), right = left, both = left;
  for (size_t j = 0; j < count; ++j) {
    const int up = character.joint_parent[j];
    if (up < 0 || meaning[j].kind || meaning[j].face || bones[j] < 2 || !(weight[j] > 0)) continue;
    const double way = aside[j] / weight[j];
    if (std::abs(way) > kMedian * height) (way > 0 ? left : right)[static_cast<size_t>(up)] = true;
  }
  for (size_t j = 0; j < count; ++j) both[j] = left[j] && right[j];
  return both;
}

// Where the soles lie before the joints that move them; else +Z, as glTF has it, or +X.
Vector3 where_feet_point(const Character& character, const std::vector<Vector3>& heads,
                         const MiddlePlane& middle) {
  const int along = 2 - middle.axis;
  double low = std::numeric_limits<double>::infinity();
  for (const Vector3& place : character.positions) low = std::min(low, place.y());
  const double height = bind_height(character);
  double ahead = 0, count = 0;
  for (size_t v = 0; v < character.positions.size(); ++v) {
    if (character.positions[v].y() > low + kSoles * height) continue;
    ahead += character.positions[v][along] - heads[static_cast<size_t>(character.skin[v].joint[0])][along];
    ++count;
  }
  const bool back = count > 0 && ahead / count < -kFewestFeet * height;
  return (back ? -1 : 1) * Vector3::Unit(along);
}

// Between the first joint of the spine that carries limbs and the next one.
std::vector<int> between_limbs(const std::vector<int>& spine, const std::vector<bool>& limbs) {
  std::vector<int> between;
  bool hind = false;
  for (const int joint : spine) {
    if (limbs[static_cast<size_t>(joint)] && hind) return between.empty() ? spine : between;
    if (limbs[static_cast<size_t>(joint)])
      hind = true;
    else if (hind)
      between.push_back(joint);
  }
  return spine;
}

// Of each limb that hangs on the lowest joint with limbs, the first bone that moves flesh.
std::vector<int> upper_legs(const Character& character, const std::vector<int>& spine,
                            const std::vector<bool>& limbs, const Skin& skin, double height) {
  const auto hind = std::ranges::find_if(spine, [&](int j) { return limbs[static_cast<size_t>(j)]; });
  std::vector<int> legs;
  if (hind == spine.end()) return legs;
  std::vector<bool> below(skin.most.size(), false);  // of a limb, above its first bone with flesh
  for (size_t j = 0; j < below.size(); ++j) {
    const int up = character.joint_parent[j];
    const bool on_spine = std::ranges::find(spine, static_cast<int>(j)) != spine.end();
    if (up < 0 || on_spine || (up != *hind && !below[static_cast<size_t>(up)])) continue;
    if (skin.most[j] <= kMovesFlesh)
      below[j] = true;
    else if (std::abs(skin.aside[j]) > kMedian * height * skin.sum[j])
      legs.push_back(static_cast<int>(j));
  }
  return legs;
}

}  // namespace

Vector3 nearest_on(const std::vector<Vector3>& line, const Vector3& place) {
  Vector3 best = line.front();
  for (size_t i = 0; i + 1 < line.size(); ++i) {
    const Vector3 along = line[i + 1] - line[i];
    const double length2 = along.squaredNorm();
    const double share = length2 > 0 ? std::clamp((place - line[i]).dot(along) / length2, 0.0, 1.0) : 0.0;
    const Vector3 here = line[i] + share * along;
    if ((place - here).squaredNorm() < (place - best).squaredNorm()) best = here;
  }
  return best;
}

namespace {

std::optional<Anatomy> anatomy_about(const Character& character, const Bones& bones,
                                     const std::vector<NameMeaning>& meaning, const MiddlePlane& middle) {
  const double height = bind_height(character);
  const Skin skin = weigh(character, middle);
  const std::vector<bool> median = on_median(bones.head, middle, height);
  const int end = upper_end(character, meaning, skin, median);
  if (end < 0) return std::nullopt;
  const std::vector<bool> limbs = carries_limbs(character, meaning, skin, height);
  Anatomy found;
  bool any_limbs = false;
  int after = -1;
  for (const int joint : path_to(character, end)) {
    const auto j = static_cast<size_t>(joint);
    any_limbs = any_limbs || limbs[j];
    if (meaning[j].face) {
      after = joint;
      break;
    }
    if (skin.most[j] <= kMovesFlesh) continue;
    found.spine.push_back(joint);
    found.line.push_back(bones.head[j]);
  }
  if (found.spine.empty() || !any_limbs) return std::nullopt;
  found.line.push_back(after >= 0 ? bones.head[static_cast<size_t>(after)]
                                  : bones.tail[static_cast<size_t>(found.spine.back())]);
  const Vector3 along = found.line.back() - found.line.front();
  if (!(along.norm() > 0)) return std::nullopt;
  found.axis = along.normalized();
  found.lies = std::abs(found.axis.y()) < std::sqrt(0.5);
  found.forward = found.lies ? Vector3(Vector3(along.x(), 0, along.z()).normalized())
                             : where_feet_point(character, bones.head, middle);
  found.aside = Vector3::Unit(middle.axis);
  found.middle_m = middle.at_m;
  found.belly = between_limbs(found.spine, limbs);
  found.thighs = upper_legs(character, found.spine, limbs, skin, height);
  found.trunk.assign(bones.head.size(), false);
  for (const int joint : found.spine) found.trunk[static_cast<size_t>(joint)] = true;
  for (size_t j = 0; j < found.trunk.size(); ++j) {
    const int up = character.joint_parent[j];
    const bool added = up >= 0 && found.trunk[static_cast<size_t>(up)] && !meaning[j].face &&
                       (meaning[j].kind ? !swings_as_chain(*meaning[j].kind) : median[j]);
    found.trunk[j] = found.trunk[j] || added;
  }
  return found;
}

}  // namespace

std::optional<Anatomy> find_anatomy(const Character& character) {
  const Bones bones = find_bones(character, {});
  if (bones.head.empty()) return std::nullopt;
  std::vector<NameMeaning> meaning;
  for (size_t j = 0; j < bones.head.size(); ++j) meaning.push_back(meaning_of(joint_name(character, j)));
  for (const int axis : {0, 2})
    if (auto found = anatomy_about(character, bones, meaning, plane_across(bones.head, axis))) return found;
  return std::nullopt;
}

}  // namespace sinew::baker
