// stiffness.cpp  The three sources of stiffness.
#include "baker/mesh/stiffness.hpp"

#include <algorithm>
#include <array>
#include <cctype>

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
constexpr std::array<const char*, 9> kBony = {"head",   "skull", "hand", "foot", "toe",
                                              "finger", "thumb", "eye",  "teeth"};

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
void hold_seams(const Surface& surface, const std::vector<int>& owner, std::vector<double>& softness) {
  std::vector<double> held = softness;
  for (size_t v = 0; v < owner.size(); ++v)
    for (int next : surface.neighbours[v])
      if (softness[v] > 0 && softness[static_cast<size_t>(next)] > 0 &&
          owner[static_cast<size_t>(next)] != owner[v])
        held[v] = 0;
  softness = std::move(held);
}

class StatedRegions {
 public:
  StatedRegions(const Character& character, const Recipe& recipe)
      : character_(character),
        thickness_(flesh_thickness(character, find_bones(character))),
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

std::vector<bool> bony_joints(const Character& character) {
  std::vector<bool> bony(character.joint_node.size(), false);
  for (size_t j = 0; j < bony.size(); ++j) {
    std::string name = joint_name(character, j);
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    bony[j] = std::any_of(kBony.begin(), kBony.end(),
                          [&](const char* word) { return name.find(word) != std::string::npos; });
  }
  return bony;
}

// The limb segment that moves a vertex most, and its share.
std::pair<int, double> main_segment(const Influences& skin, const std::vector<int>& segment) {
  std::pair<int, double> best{-1, -1};
  for (size_t k = 0; k < kInfluences && skin.weight[k] > 0; ++k) {
    const int own = segment[static_cast<size_t>(skin.joint[k])];
    double share = 0;
    for (size_t other = 0; other < kInfluences; ++other)
      if (segment[static_cast<size_t>(skin.joint[other])] == own) share += skin.weight[other];
    if (share > best.second) best = {own, share};
  }
  return best;
}

std::vector<double> guessed_stiffness(const Character& character, const Surface& surface) {
  const Bones bones = find_bones(character);
  const double height = bind_height(character);
  const std::vector<double> thickness = flesh_thickness(character, bones);
  const std::vector<int> segment = limb_segments(character, bones, kSegmentLength * height);
  const std::vector<bool> bony = bony_joints(character);
  std::vector<double> softness;
  std::vector<int> owner;
  for (size_t v = 0; v < thickness.size(); ++v) {
    const auto [own, share] = main_segment(character.skin[v], segment);
    owner.push_back(own);
    softness.push_back(smooth_step(kThinFlesh * height, kThickFlesh * height, thickness[v]) *
                       smooth_step(kOneSegmentFrom, kOneSegmentTo, share) *
                       (1 - weight_of(character.skin[v], bony)));
  }
  hold_seams(surface, owner, softness);
  for (double& value : softness) value = 1 - (1 - kSoftest) * value;
  return softness;
}

}  // namespace

std::vector<double> find_stiffness(Character& character, const Surface& surface, const Recipe& recipe) {
  std::vector<double> stiffness = character.stiffness;
  if (!stiffness.empty() && !recipe.regions.empty())
    character.notes.push_back("the file paints _STIFFNESS: the recipe's regions only give names");
  if (stiffness.empty() && !recipe.regions.empty()) stiffness = stated_stiffness(character, surface, recipe);
  if (stiffness.empty()) {
    stiffness = guessed_stiffness(character, surface);
    character.notes.push_back(
        "no _STIFFNESS and no recipe regions: stiffness guessed from the flesh over the bones");
  }
  for (size_t v = 0; v < stiffness.size(); ++v)
    stiffness[v] = stiffness[static_cast<size_t>(character.welded[v])];
  return stiffness;
}

}  // namespace sinew::baker
