// proxies.cpp  see proxies.hpp.
#include "baker/mesh/rods/proxies.hpp"

#include <algorithm>

#include "baker/mesh/anatomy/fit_capsule.hpp"
#include "baker/mesh/anatomy/joint_names.hpp"
#include "pack/format.hpp"

namespace sinew::baker {
namespace {

constexpr size_t kFewestVertices = 20;
constexpr double kLeastRadius_m = 1e-3;

std::vector<std::vector<Vector3>> flesh_of_joints(const Character& character) {
  std::vector<std::vector<Vector3>> flesh(character.joint_node.size());
  for (size_t v = 0; v < character.positions.size(); ++v) {
    if (character.welded[v] != static_cast<int>(v)) continue;
    flesh[static_cast<size_t>(character.skin[v].joint[0])].push_back(character.positions[v]);
  }
  return flesh;
}

std::vector<Proxy> fitted(const Character& character, const Bones& bones, const std::vector<bool>& left_out) {
  std::vector<Proxy> proxies;
  const std::vector<std::vector<Vector3>> flesh = flesh_of_joints(character);
  for (size_t j = 0; j < flesh.size(); ++j) {
    if (left_out[j] || flesh[j].size() < kFewestVertices) continue;
    const FittedCapsule fit = fit_capsule(flesh[j], bones.tail[j] - bones.head[j]);
    if (fit.radius_m >= kLeastRadius_m)
      proxies.push_back({static_cast<int>(j), fit.from, fit.to, fit.radius_m});
  }
  return proxies;
}

std::vector<Proxy> stated(const Character& character) {
  std::vector<Proxy> proxies;
  for (const BodyCollider& c : character.colliders) {
    const Matrix4 bind = character.inverse_bind[static_cast<size_t>(c.joint)].inverse();
    const auto placed = [&](const Vector3& p) { return Vector3((bind * p.homogeneous()).head<3>()); };
    const double scale = std::cbrt(std::abs(bind.topLeftCorner<3, 3>().determinant()));
    proxies.push_back({c.joint, placed(c.from), placed(c.to), scale * c.radius_m, c.groups});
  }
  return proxies;
}

void override_radii(const Character& character, const Recipe& recipe, std::vector<Proxy>& proxies) {
  for (const ProxyRecipe& own : recipe.proxies) {
    const std::vector<bool> named =
        match_joints(character, {own.joint}, "recipe: \"proxies\": '" + own.joint + "'");
    for (Proxy& proxy : proxies)
      if (named[static_cast<size_t>(proxy.joint)]) proxy.radius_m = own.radius_m;
  }
}

void keep_largest(Character& character, std::vector<Proxy>& proxies) {
  if (proxies.size() <= pack::kMostProxies) return;
  std::ranges::stable_sort(proxies, std::greater{}, &Proxy::radius_m);
  proxies.resize(pack::kMostProxies);
  character.notes.push_back("more than 64 capsules about bones: the thinnest are left out");
}

bool are_touched(const std::vector<bool>& on_rods, const Recipe& recipe) {
  return std::ranges::find(on_rods, true) != on_rods.end() ||
         std::ranges::any_of(recipe.regions, &RegionRecipe::touches_body);
}

}  // namespace

uint64_t proxies_outside(const std::vector<Proxy>& proxies, const std::vector<int>& groups) {
  uint64_t outside = 0;
  for (size_t p = 0; p < proxies.size(); ++p) {
    const auto is_own = [&](int group) { return std::ranges::binary_search(groups, group); };
    if (std::ranges::none_of(proxies[p].groups, is_own)) outside |= uint64_t{1} << p;
  }
  return outside;
}

std::vector<Proxy> find_proxies(Character& character, const Bones& bones, const std::vector<bool>& on_rods,
                                const Recipe& recipe) {
  std::vector<bool> left_out = match_joints(character, recipe.without_proxies, "recipe: without_proxies");
  if (!are_touched(on_rods, recipe)) return {};
  for (size_t j = 0; j < left_out.size(); ++j) left_out[j] = left_out[j] || on_rods[j];
  std::vector<Proxy> proxies = stated(character);
  std::erase_if(proxies, [&](const Proxy& p) { return left_out[static_cast<size_t>(p.joint)]; });
  if (character.colliders.empty()) proxies = fitted(character, bones, left_out);
  override_radii(character, recipe, proxies);
  keep_largest(character, proxies);
  std::ranges::stable_sort(proxies, {}, &Proxy::joint);
  return proxies;
}

}  // namespace sinew::baker
