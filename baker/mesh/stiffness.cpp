// stiffness.cpp  The three sources of stiffness.
#include "baker/mesh/stiffness.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>

#include "baker/mesh/bones.hpp"
#include "baker/mesh/joint_names.hpp"

namespace sinew::baker {
namespace {

// Recipe regions: share of skin weight, and of the region's thickest flesh, between which softness comes in.
constexpr double kWeightFrom = 0.25, kWeightTo = 0.75, kFleshFrom = 0.25, kFleshTo = 0.7;
// No recipe: flesh as a share of the character's height. A human's forearm has 0.025, the thigh 0.05, the
// belly 0.1.
constexpr double kThinFlesh = 0.04, kThickFlesh = 0.09, kSoftest = 0.1;
constexpr double kSegmentLength = 0.3;  // of the height: a thigh, or the spine from the pelvis to the chest
constexpr double kOneSegmentFrom = 0.6,
                 kOneSegmentTo = 0.9;  // skin weight of one segment: less is a joint, which stays rigid
constexpr std::array kBony = {"head", "skull", "hand", "foot", "toe", "finger", "thumb", "eye", "teeth"};
// Joints that riggers add to move flesh: what they move is soft, and goes with the bone that they hang on.
constexpr std::array kFleshy = {"breast", "bust",  "boob",  "belly", "stomach",
                                "butt",   "glute", "cheek", "jiggle"};
constexpr double kWorthwhileSize = 0.08,
                 kWorthwhileStiffness = 0.6;  // a smaller (of the height) or stiffer part would not be seen

double smooth_step(double low, double high, double value) {
  const double t = std::clamp((value - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

double weight_of(const Influences& skin, const std::vector<bool>& joints) {
  double sum = 0;
  for (size_t k = 0; k < kInfluences; ++k)
    if (joints[static_cast<size_t>(skin.joint[k])]) sum += skin.weight[k];
  return sum;
}

// Between vertices that belong to different parts the skin is held: each part moves in its own bone's frame.
// -1 belongs to all.
void hold_seams(const Surface& surface, const std::vector<int>& owner, std::vector<double>& softness) {
  std::vector<double> held = softness;
  for (size_t v = 0; v < owner.size(); ++v)
    for (int other : surface.neighbours[v]) {
      const auto next = static_cast<size_t>(other);
      const bool both = softness[v] > 0 && softness[next] > 0 && owner[v] >= 0 && owner[next] >= 0;
      if (both && owner[v] != owner[next]) held[v] = 0;
    }
  softness = std::move(held);
}

class StatedRegions {
 public:
  StatedRegions(const Character& character, const Recipe& recipe)
      : character_(character),
        thickness_(flesh_thickness(character, find_bones(character, {}))),
        coreless_(match_joints(character, recipe.coreless_joints, "recipe: coreless_joints")) {}

  std::vector<double> softness(const RegionRecipe& region) const {
    const std::vector<bool> joints =
        match_joints(character_, region.joints, "recipe: region '" + region.name + "'");
    double thickest = 0;
    for (size_t v = 0; v < thickness_.size(); ++v)
      if (weight_of(character_.skin[v], joints) > kWeightTo) thickest = std::max(thickest, thickness_[v]);
    std::vector<double> soft;
    for (size_t v = 0; v < thickness_.size(); ++v) {
      const Influences& skin = character_.skin[v];
      const double flesh = smooth_step(kFleshFrom * thickest, kFleshTo * thickest, thickness_[v]);
      const double coreless = weight_of(skin, coreless_);
      soft.push_back(smooth_step(kWeightFrom, kWeightTo, weight_of(skin, joints)) *
                     (coreless + (1 - coreless) * flesh));
    }
    return soft;
  }

 private:
  const Character& character_;
  std::vector<double> thickness_;
  std::vector<bool> coreless_;
};

std::vector<double> stated_stiffness(const Character& character, const Surface& surface,
                                     const Recipe& recipe) {
  const StatedRegions regions(character, recipe);
  std::vector<double> best(character.positions.size(), 0), stiffness(best.size(), 1);
  std::vector<int> owner(best.size(), -1);
  for (size_t r = 0; r < recipe.regions.size(); ++r) {
    const std::vector<double> soft = regions.softness(recipe.regions[r]);
    for (size_t v = 0; v < best.size(); ++v)
      if (soft[v] > best[v]) best[v] = soft[v], owner[v] = static_cast<int>(r);
  }
  hold_seams(surface, owner, best);
  for (size_t v = 0; v < best.size(); ++v)
    if (best[v] > 0)
      stiffness[v] = 1 - (1 - recipe.regions[static_cast<size_t>(owner[v])].stiffness) * best[v];
  return stiffness;
}

template <size_t N>
std::vector<bool> joints_called(const Character& character, const std::array<const char*, N>& words) {
  std::vector<bool> called(character.joint_node.size(), false);
  for (size_t j = 0; j < called.size(); ++j) {
    std::string name = joint_name(character, j);
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    called[j] = std::any_of(words.begin(), words.end(),
                            [&](const char* word) { return name.find(word) != std::string::npos; });
  }
  return called;
}

// The limb segment that moves a vertex most, and its share among segments; -1 where only helper joints move
// it.
std::pair<int, double> main_segment(const Influences& skin, const std::vector<int>& segment) {
  std::map<int, double> shares;
  double all = 0;
  for (size_t k = 0; k < kInfluences && skin.weight[k] > 0; ++k) {
    const int own = segment[static_cast<size_t>(skin.joint[k])];
    if (own >= 0) shares[own] += skin.weight[k], all += skin.weight[k];
  }
  std::pair<int, double> best{-1, 1};
  for (const auto& [own, share] : shares)
    if (best.first < 0 || share / all > best.second) best = {own, share / all};
  return best;
}

void hold_small_parts(const Character& character, const Surface& surface, double height,
                      double rigid_stiffness, std::vector<double>& softness) {
  std::vector<bool> soft(softness.size());
  for (size_t v = 0; v < soft.size(); ++v) soft[v] = 1 - (1 - kSoftest) * softness[v] < rigid_stiffness;
  const std::vector<int> part = connected_parts(surface, soft);
  std::vector<Eigen::AlignedBox3d> box;
  std::vector<double> softest;
  for (size_t v = 0; v < part.size(); ++v) {
    if (part[v] < 0) continue;
    const auto id = static_cast<size_t>(part[v]);
    box.resize(std::max(box.size(), id + 1));
    softest.resize(box.size(), 0);
    box[id].extend(character.positions[v]);
    softest[id] = std::max(softest[id], softness[v]);
  }
  for (size_t v = 0; v < part.size(); ++v) {
    if (part[v] < 0) continue;
    const auto id = static_cast<size_t>(part[v]);
    if (box[id].diagonal().norm() < 2 * kWorthwhileSize * height ||
        1 - (1 - kSoftest) * softest[id] > kWorthwhileStiffness)
      softness[v] = 0;
  }
}

std::vector<double> guessed_stiffness(const Character& character, const Surface& surface,
                                      double rigid_stiffness) {
  const std::vector<bool> fleshy = joints_called(character, kFleshy), bony = joints_called(character, kBony);
  const Bones bones = find_bones(character, fleshy);
  const double height = bind_height(character);
  const std::vector<double> thickness = flesh_thickness(character, bones);
  const std::vector<int> segment = limb_segments(character, bones, kSegmentLength * height);
  std::vector<double> softness;
  std::vector<int> owner;
  for (size_t v = 0; v < thickness.size(); ++v) {
    const Influences& skin = character.skin[v];
    const auto [own, share] = main_segment(skin, segment);
    owner.push_back(own);
    const double flesh =
        smooth_step(kThinFlesh * height, kThickFlesh * height, thickness[v]) * (1 - weight_of(skin, bony));
    const double added = smooth_step(kWeightFrom, kWeightTo, weight_of(skin, fleshy));
    softness.push_back(std::max(flesh, added) * smooth_step(kOneSegmentFrom, kOneSegmentTo, share));
  }
  hold_seams(surface, owner, softness);
  hold_small_parts(character, surface, height, rigid_stiffness, softness);
  for (double& value : softness) value = 1 - (1 - kSoftest) * value;
  return softness;
}

}  // namespace

std::vector<double> find_stiffness(Character& character, const Surface& surface, const Recipe& recipe) {
  std::vector<double> stiffness = character.stiffness;
  if (!stiffness.empty() && !recipe.regions.empty())
    character.notes.push_back(
        "the file paints _STIFFNESS: the recipe's regions only say names and what they touch");
  if (stiffness.empty() && !recipe.regions.empty()) stiffness = stated_stiffness(character, surface, recipe);
  if (stiffness.empty()) {
    stiffness = guessed_stiffness(character, surface, recipe.rigid_stiffness);
    character.notes.push_back(
        "no _STIFFNESS and no recipe regions: stiffness guessed from the flesh over the bones");
  }
  for (size_t v = 0; v < stiffness.size(); ++v)
    stiffness[v] = stiffness[static_cast<size_t>(character.welded[v])];
  return stiffness;
}

}  // namespace sinew::baker
