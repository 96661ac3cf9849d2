// rod_end.cpp  Where a strap is sewn on: the bone that holds the end of a rod's last bone as well.
#include "baker/mesh/rods/rod_end.hpp"

#include <algorithm>
#include <set>

#include "baker/mesh/surface/surface.hpp"

namespace sinew::baker {
namespace {

constexpr double kHalf = 0.49;     // a weight, as files round it
constexpr size_t kFewestSewn = 3;  // vertices: fewer are no seam
constexpr int kNoBone = -1;

class Seams {
 public:
  Seams(const Character& character, const Rod& rod, const std::vector<bool>& on_rods)
      : character_(character), surface_(find_surface(character)), last_(rod.bones.back().joint) {
    for (size_t v = 0; v < character.positions.size(); ++v)
      owner_.push_back(owner_of(character.skin[static_cast<size_t>(character.welded[v])], on_rods));
    of_chain_.assign(on_rods.size(), false);
    for (const RodBone& bone : rod.bones)
      if (bone.joint >= 0) of_chain_[static_cast<size_t>(bone.joint)] = true;
  }

  // Bones beside the chain whose skin its last bone's touches, or that of the others.
  std::set<int> beside(bool last) const {
    std::set<int> found;
    for (size_t v = 0; v < owner_.size(); ++v) {
      if (owner_[v] == kNoBone || !is_of_chain(owner_[v]) || (owner_[v] == last_) != last) continue;
      for (const int n : surface_.neighbours[v])
        if (const int other = owner_[static_cast<size_t>(n)]; other != kNoBone && !is_of_chain(other))
          found.insert(other);
    }
    return found;
  }

  std::vector<Vector3> along(int joint) const {
    std::vector<Vector3> places;
    for (size_t v = 0; v < owner_.size(); ++v) {
      const auto is_last = [&](int n) { return owner_[static_cast<size_t>(n)] == last_; };
      if (owner_[v] == joint && std::ranges::any_of(surface_.neighbours[v], is_last))
        places.push_back(character_.positions[v]);
    }
    return places;
  }

  std::vector<Vector3> of_last() const {
    std::vector<Vector3> places;
    for (size_t v = 0; v < owner_.size(); ++v)
      if (owner_[v] == last_) places.push_back(character_.positions[v]);
    return places;
  }

 private:
  // What half belongs to a bone that no rod moves does not swing freely.
  static int owner_of(const Influences& skin, const std::vector<bool>& on_rods) {
    for (size_t k = 0; k < kInfluences; ++k)
      if (skin.weight[k] >= kHalf && !on_rods[static_cast<size_t>(skin.joint[k])]) return skin.joint[k];
    return skin.weight[0] > 0 ? static_cast<int>(skin.joint[0]) : kNoBone;
  }

  bool is_of_chain(int joint) const { return of_chain_[static_cast<size_t>(joint)]; }

  const Character& character_;
  Surface surface_;
  int last_;
  std::vector<int> owner_;  // of each vertex, the bone that it is most of
  std::vector<bool> of_chain_;
};

Vector3 middle_of(const std::vector<Vector3>& places) {
  Vector3 sum = Vector3::Zero();
  for (const Vector3& place : places) sum += place;
  return sum / static_cast<double>(places.size());
}

}  // namespace

bool is_chain(const Rod& rod) {
  for (size_t b = 0; b < rod.bones.size(); ++b)
    if (rod.bones[b].parent != static_cast<int>(b) - 1) return false;
  return true;
}

std::optional<SewnEnd> find_sewn_end(const Character& character, const Rod& rod,
                                     const std::vector<bool>& on_rods) {
  if (rod.bones.size() < 2 || !is_chain(rod)) return {};
  const Seams seams(character, rod, on_rods);
  const std::set<int> beside = seams.beside(true);
  if (beside.size() != 1) return {};
  const int joint = *beside.begin();
  if (joint == rod.attach || on_rods[static_cast<size_t>(joint)] || seams.beside(false).contains(joint))
    return {};
  const std::vector<Vector3> sewn = seams.along(joint), own = seams.of_last();
  if (sewn.size() < kFewestSewn || own.empty()) return {};
  const Vector3 begin = rod.bones.back().begin, place = middle_of(sewn);
  if ((place - begin).norm() <= (middle_of(own) - begin).norm()) return {};
  return SewnEnd{joint, place};
}

std::optional<Vector3> find_seam(const Character& character, const Rod& rod, int joint,
                                 const std::vector<bool>& on_rods) {
  const std::vector<Vector3> sewn = Seams(character, rod, on_rods).along(joint);
  if (sewn.empty()) return {};
  return middle_of(sewn);
}

}  // namespace sinew::baker
