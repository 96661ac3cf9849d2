// skin_weights.cpp  Influences: decoded, checked, mended, merged.
#include "baker/import/meshes/skin_weights.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::baker {
namespace {

constexpr const char* kMend = "the file is damaged; export it again";
constexpr double kSumTolerance =
    2e-2;  // four weights of 8 bits may be off by this and still be what the artist meant
constexpr int kMaxSets = 16;

struct WeightSet {
  std::vector<double> joints, weights;  // 4 a vertex
};

struct Mended {
  size_t not_finite = 0, negative = 0, unnormalised = 0, without = 0, cut = 0;
};

std::vector<double> read_set(const tinygltf::Primitive& primitive, const std::string& name,
                             size_t vertex_count, const AccessorReader& accessors, const std::string& where,
                             const Source& source) {
  const auto found = primitive.attributes.find(name);
  if (found == primitive.attributes.end()) return {};
  const std::string place = where + " " + name;
  if (name.starts_with("JOINTS") && !accessors.holds_indices(found->second, place))
    source.refuse(place, "does not hold unsigned integers", kMend);
  if (accessors.count(found->second, place) != vertex_count)
    source.refuse(place,
                  "has " + std::to_string(accessors.count(found->second, place)) + " elements for " +
                      std::to_string(vertex_count) + " vertices",
                  kMend);
  return accessors.numbers(found->second, 4, place);
}

std::vector<WeightSet> read_sets(const tinygltf::Primitive& primitive, size_t vertex_count,
                                 const AccessorReader& accessors, const std::string& where, Source& source) {
  std::vector<WeightSet> sets;
  for (int i = 0; i < kMaxSets; ++i) {
    WeightSet set{
        read_set(primitive, "JOINTS_" + std::to_string(i), vertex_count, accessors, where, source),
        read_set(primitive, "WEIGHTS_" + std::to_string(i), vertex_count, accessors, where, source)};
    if (set.joints.empty() && set.weights.empty()) break;
    if (set.joints.empty() || set.weights.empty())
      source.note(where, "JOINTS_" + std::to_string(i) + " or WEIGHTS_" + std::to_string(i) +
                             " is missing: the other is left out");
    else
      sets.push_back(std::move(set));
  }
  return sets;
}

double usable_weight(double weight, Mended& mended) {
  if (!std::isfinite(weight)) return ++mended.not_finite, 0.0;
  if (weight < 0) return ++mended.negative, 0.0;
  return weight;
}

using Pairs = std::vector<std::pair<int, double>>;  // joint, weight

void add(Pairs& pairs, int joint, double weight) {
  for (auto& pair : pairs)
    if (pair.first == joint) return void(pair.second += weight);
  pairs.emplace_back(joint, weight);
}

Influences normalised(Pairs& pairs, int fallback, Mended& mended) {
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  double all = 0, kept = 0;
  for (size_t k = 0; k < pairs.size(); ++k) {
    all += pairs[k].second;
    if (k < kInfluences) kept += pairs[k].second;
  }
  Influences influences;
  if (!(kept > 0) || !std::isfinite(all)) {
    ++mended.without;
    influences.joint[0] = fallback;
    influences.weight[0] = 1;
    return influences;
  }
  if (std::abs(all - 1) > kSumTolerance) ++mended.unnormalised;
  if (pairs.size() > kInfluences) ++mended.cut;
  for (size_t k = 0; k < std::min<size_t>(kInfluences, pairs.size()); ++k) {
    influences.joint[k] = pairs[k].first;
    influences.weight[k] = pairs[k].second / kept;
  }
  return influences;
}

void note_mended(const Mended& mended, const std::string& where, int fallback, Source& source) {
  const auto note = [&](size_t count, const std::string& what) {
    if (count > 0) source.note(where, std::to_string(count) + what);
  };
  note(mended.not_finite, " weights are NaN or infinite: taken as zero");
  note(mended.negative, " weights are negative: taken as zero");
  note(mended.unnormalised, " vertices have weights that do not sum to one: normalised");
  note(mended.cut, " vertices have more than eight joints: the eight strongest are kept");
  note(mended.without, " vertices have no weight: bound to joint " + std::to_string(fallback));
}

int joint_at(const WeightSet& set, size_t slot, const std::vector<int>& of_skin, const std::string& where,
             const Source& source) {
  const double index = set.joints[slot];
  if (!(index >= 0 && index < static_cast<double>(of_skin.size())))
    source.refuse(where,
                  "vertex " + std::to_string(slot / 4) + " is weighted to joint " +
                      std::to_string(static_cast<long>(index)) + " of a skin of " +
                      std::to_string(of_skin.size()),
                  kMend);
  return of_skin[static_cast<size_t>(index)];
}

}  // namespace

std::vector<Influences> read_influences(const tinygltf::Primitive& primitive, size_t vertex_count,
                                        const MeshInstance& instance, const Joints& joints,
                                        const AccessorReader& accessors, const std::string& where,
                                        Source& source) {
  std::vector<Influences> result(vertex_count);
  if (instance.skin < 0) {
    for (Influences& influences : result) influences.joint[0] = instance.joint, influences.weight[0] = 1;
    return result;
  }
  const std::vector<WeightSet> sets = read_sets(primitive, vertex_count, accessors, where, source);
  const std::vector<int>& of_skin = joints.of_skin[static_cast<size_t>(instance.skin)];
  Mended mended;
  Pairs pairs;
  for (size_t v = 0; v < vertex_count; ++v) {
    pairs.clear();
    for (const WeightSet& set : sets)
      for (size_t slot = 4 * v; slot < 4 * v + 4; ++slot) {
        const double weight = usable_weight(set.weights[slot], mended);
        if (weight > 0) add(pairs, joint_at(set, slot, of_skin, where, source), weight);
      }
    result[v] = normalised(pairs, instance.joint, mended);
  }
  note_mended(mended, where, instance.joint, source);
  return result;
}

}  // namespace sinew::baker
