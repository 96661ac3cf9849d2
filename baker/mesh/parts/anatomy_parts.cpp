// anatomy_parts.cpp  Depths of the trunk before and behind its spine, and what they say.
#include "baker/mesh/parts/anatomy_parts.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>

#include "baker/mesh/anatomy/anatomy.hpp"
#include "baker/mesh/anatomy/bone_names.hpp"
#include "baker/mesh/anatomy/bones.hpp"
#include "baker/mesh/anatomy/joint_names.hpp"

namespace sinew::baker {
namespace {

constexpr double kMoves = 0.4;        // skin weight
constexpr double kDeep = 0.1;         // of the height, before the spine; a lean human's belly has 0.07
constexpr double kBulges = 1.5;       // times as deep before the spine as behind it
constexpr double kRound = 0.4;        // of the height, from front to back: a ball of a body
constexpr double kHangs = 0.05;       // of the spine's length, below one that lies
constexpr double kChestShare = 0.95;  // of the chest's depth: less is a chest, not a belly

struct Depth {
  double front = 0, back = 0;  // m, the farthest; of what lies: below and above
};

Depth depth_of(const Character& character, const Anatomy& anatomy, const std::vector<int>& joints) {
  const Vector3 front = anatomy.lies ? Vector3(-Vector3::UnitY()) : anatomy.forward;
  Depth depth;
  for (size_t v = 0; v < character.positions.size(); ++v) {
    double weight = 0;
    for (size_t k = 0; k < kInfluences; ++k)
      if (std::ranges::find(joints, character.skin[v].joint[k]) != joints.end())
        weight += character.skin[v].weight[k];
    if (weight < kMoves) continue;
    const Vector3& place = character.positions[v];
    const double out = (place - nearest_on(anatomy.line, place)).dot(front);
    depth.front = std::max(depth.front, out);
    depth.back = std::max(depth.back, -out);
  }
  return depth;
}

// A mesh that is named like something hard all over.
std::optional<std::string> hard_mesh(const Character& character) {
  for (const MeshSpan& mesh : character.meshes) {
    const std::string& name = character.nodes[static_cast<size_t>(mesh.node)].name;
    if (is_hard_body(name)) return name;
  }
  if (is_hard_body(character.name)) return character.name;
  return std::nullopt;
}

template <class... Values>
std::string text(const char* format, Values... values) {
  char buffer[200];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

class Shape {
 public:
  Shape(const Character& character, const Anatomy& anatomy, const std::vector<bool>& claimed)
      : character_(character),
        anatomy_(anatomy),
        claimed_(claimed),
        names_(character),
        hard_(hard_mesh(character)),
        height_m_(bind_height(character)) {}

  void add_belly(std::vector<Candidate>& parts) const {
    if (any_claimed(anatomy_.belly)) return;
    const Depth belly = depth_of(character_, anatomy_, anatomy_.belly);
    Candidate part{region("belly", SoftKind::kBelly, anatomy_.belly), Evidence::kShape, "", ""};
    if (anatomy_.lies) {
      const double length = (anatomy_.line.back() - anatomy_.line.front()).norm();
      part.why = text("the spine is horizontal, and soft tissue hangs %.2f of its length below it",
                      belly.front / length);
      if (belly.front < kHangs * length) part.doubt = text("less than %.2f is skin over bone", kHangs);
    } else {
      part.why = text("soft tissue before the spine is %.2f of the height deep, behind it %.2f",
                      belly.front / height_m_, belly.back / height_m_);
      part.doubt = against_belly(belly);
    }
    keep(std::move(part), parts);
  }

  void add_seat(std::vector<Candidate>& parts) const {
    if (anatomy_.lies) return;
    const std::vector<int> pelvis = {anatomy_.spine.front()};
    if (!any_claimed(pelvis) && pelvis != anatomy_.belly)
      keep({region("glute", SoftKind::kGlute, pelvis), Evidence::kShape, "soft tissue behind the pelvis",
            "shape alone does not distinguish buttocks from a coat"},
           parts);
    std::vector<int> thighs;
    for (const int joint : anatomy_.thighs)
      if (!any_claimed({joint})) thighs.push_back(joint);
    if (thighs.size() >= 2)
      keep({region("thigh", SoftKind::kThigh, thighs), Evidence::kShape, "soft tissue on the upper legs",
            "muscle holds most thighs; soft ones are a choice"},
           parts);
  }

 private:
  bool any_claimed(const std::vector<int>& joints) const {
    return std::ranges::any_of(joints, [&](int j) { return claimed_[static_cast<size_t>(j)]; });
  }

  RegionRecipe region(const char* name, SoftKind kind, const std::vector<int>& joints) const {
    RegionRecipe region;
    region.name = name;
    region.kind = kind;
    for (const int j : joints) region.joints.push_back(names_.unique(static_cast<size_t>(j)));
    return region;
  }

  std::string against_belly(const Depth& belly) const {
    std::vector<int> chest;
    for (const int joint : anatomy_.spine)
      if (std::ranges::find(anatomy_.belly, joint) == anatomy_.belly.end() && joint != anatomy_.spine.front())
        chest.push_back(joint);
    if (belly.front < kDeep * height_m_) return text("lean: less than %.2f before the spine", kDeep);
    const bool round = belly.front + belly.back >= kRound * height_m_;
    if (!round && belly.front < kBulges * belly.back) return "as deep behind the spine: a coat or a barrel";
    if (belly.front < kChestShare * depth_of(character_, anatomy_, chest).front)
      return "the chest stands out further";
    return "";
  }

  void keep(Candidate part, std::vector<Candidate>& parts) const {
    if (hard_ && part.doubt.empty()) part.doubt = "'" + *hard_ + "' is named like something hard";
    parts.push_back(std::move(part));
  }

  const Character& character_;
  const Anatomy& anatomy_;
  const std::vector<bool>& claimed_;
  JointNames names_;
  std::optional<std::string> hard_;
  double height_m_;
};

}  // namespace

std::vector<Candidate> anatomy_parts(const Character& character, const std::vector<bool>& claimed) {
  std::vector<Candidate> parts;
  const std::optional<Anatomy> anatomy = find_anatomy(character);
  if (!anatomy) return parts;
  const Shape shape(character, *anatomy, claimed);
  shape.add_belly(parts);
  shape.add_seat(parts);
  return parts;
}

}  // namespace sinew::baker
