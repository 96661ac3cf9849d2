// rods.cpp  Bones that swing as rods: which ones, and what they are made of.
//
// What springs of a VRM file become. UniVRM moves a bone's end by Verlet steps, 60 a second: each adds the
// pull stiffness / 60 s towards the rest direction, gravity_power / 60 s downwards, and keeps (1 -
// drag_force) of the velocity. Both pulls are accelerations of 60/s times their number, so that
//   stiffness      a bone of length L swings at w^2 = 60 stiffness / L; each joint is made so stiff that all
//                  that hangs on it does
//   gravity_power  bends a lone bone as far as there where gravity is 40 gravity_power / 9.80665 of the
//                  earth's (a rod's mass lies along it, not at its end); it bends the posed shape: sag is 1
//   drag_force d   takes 60 d / (1 - d) of the velocity a second
// A chain of version 1 has its own numbers at each joint, but for gravity. What collides is as thick as its
// hit radius, and passes colliders that are in none of its groups. Centres are not followed.
#include "baker/mesh/rods/rods.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "baker/common/bad_input.hpp"
#include "baker/mesh/anatomy/bone_names.hpp"
#include "baker/mesh/anatomy/joint_names.hpp"
#include "baker/mesh/rods/rod_bones.hpp"
#include "baker/mesh/rods/rod_end.hpp"
#include "rods/section.hpp"

namespace sinew::baker {
namespace {

constexpr double kFrames_hz = 60, kGravity = 9.80665, kOfLoneBone = 40;
constexpr double kMostGravity =
    100;  // of the earth's: what a pack may hold, runtime/pack/checks/check_rods.cpp
constexpr double kLeastStiffness = 0.01,
                 kMostDrag = 0.95;       // of springs: beyond them bones fall, or stand still
constexpr double kLinkStiffness = 1000;  // times the stiffest joint of its rod

rods::SegmentDef segment_of(const RodBone& bone) {
  rods::SegmentDef s;
  s.length_m = static_cast<float>((bone.end - bone.begin).norm());
  s.radius_m = static_cast<float>(bone.radius_m);
  s.density_kg_m3 = static_cast<float>(bone.density_kg_m3);
  s.young_modulus_pa = 1;
  return s;
}

// Of a bone and all that hangs on it, about the bone's beginning, kg m^2; turning about the own axis aside.
std::vector<double> outboard_inertia(const std::vector<RodBone>& bones) {
  std::vector<double> inertia(bones.size(), 0);
  for (size_t b = 0; b < bones.size(); ++b) {
    const rods::SegmentInertia own = rods::segment_inertia(segment_of(bones[b]));
    const Vector3 middle = (bones[b].begin + bones[b].end) / 2;
    for (int at = static_cast<int>(b); at >= 0; at = bones[static_cast<size_t>(at)].parent) {
      const double arm = (middle - bones[static_cast<size_t>(at)].begin).norm();
      inertia[static_cast<size_t>(at)] += own.inertia_kg_m2 + own.mass_kg * arm * arm;
    }
  }
  return inertia;
}

int longest_chain(const std::vector<RodBone>& bones) {
  std::vector<int> depth(bones.size(), 1);
  for (size_t b = 0; b < bones.size(); ++b)
    if (bones[b].parent >= 0) depth[b] = depth[static_cast<size_t>(bones[b].parent)] + (bones[b].joint >= 0);
  return *std::ranges::max_element(depth);
}

// Each joint's modulus from the square of the frequency at which all that hangs on it is to swing, rad/s.
void stiffen(std::vector<RodBone>& bones, const std::vector<double>& square_frequency) {
  const std::vector<double> inertia = outboard_inertia(bones);
  for (size_t b = 0; b < bones.size(); ++b) {
    const RodBone& parent = bones[b].parent < 0 ? bones[b] : bones[static_cast<size_t>(bones[b].parent)];
    const rods::JointCompliance unit = rods::joint_compliance(segment_of(parent), segment_of(bones[b]));
    bones[b].young_modulus_pa = square_frequency[b] * inertia[b] * unit.bend_rad_nm;
    bones[b].torsion_modulus_pa = bones[b].young_modulus_pa;
  }
}

void stiffen_links(std::vector<RodBone>& bones) {
  double stiffest = 0;
  for (const RodBone& bone : bones)
    if (bone.joint >= 0) stiffest = std::max({stiffest, bone.young_modulus_pa, bone.torsion_modulus_pa});
  for (RodBone& bone : bones)
    if (bone.joint < 0) bone.young_modulus_pa = bone.torsion_modulus_pa = kLinkStiffness * stiffest;
}

}  // namespace

double slowest_swing_rad_per_s(const std::vector<RodBone>& bones) {
  const std::vector<double> inertia = outboard_inertia(bones);
  std::vector<double> square_period(bones.size(), 0);
  for (size_t b = 0; b < bones.size(); ++b) {
    const size_t above = bones[b].parent < 0 ? b : static_cast<size_t>(bones[b].parent);
    const rods::JointCompliance unit = rods::joint_compliance(segment_of(bones[above]), segment_of(bones[b]));
    square_period[b] = inertia[b] * unit.bend_rad_nm / bones[b].young_modulus_pa;
    if (bones[b].parent >= 0) square_period[b] += square_period[above];
  }
  return 1 / std::sqrt(*std::ranges::max_element(square_period));
}

namespace {

void set_damping(const RodRecipe& recipe, std::vector<RodBone>& bones) {
  const double damping_s =
      recipe.damping_ratio ? 2 * *recipe.damping_ratio / slowest_swing_rad_per_s(bones) : recipe.damping_s;
  for (RodBone& bone : bones) bone.damping_s = damping_s;
}

// Joints in a row give more than one: by Dunkerley the whole swings no slower than this when each swings
// sqrt(joints in a row) times as fast.
void apply(const RodRecipe& recipe, std::vector<RodBone>& bones) {
  const double usual_density = RodRecipe().density_kg_m3;
  for (RodBone& bone : bones) {
    if (recipe.radius_m > 0) bone.radius_m = recipe.radius_m;
    bone.density_kg_m3 = recipe.frequency_hz > 0 ? usual_density : recipe.density_kg_m3;
    bone.young_modulus_pa = recipe.young_modulus_pa;
    bone.torsion_modulus_pa =
        recipe.torsion_modulus_pa > 0 ? recipe.torsion_modulus_pa : recipe.young_modulus_pa;
    bone.drag_per_s = recipe.drag_per_s * usual_density / recipe.density_kg_m3;
  }
  if (recipe.frequency_hz > 0) {
    const double w = 2 * std::numbers::pi * recipe.frequency_hz;
    stiffen(bones, std::vector<double>(bones.size(), w * w * longest_chain(bones)));
    for (RodBone& bone : bones) bone.density_kg_m3 = recipe.density_kg_m3;
  }
  stiffen_links(bones);
  set_damping(recipe, bones);
}

const SpringNumbers& numbers_at(const SpringBones& spring, int joint) {
  const auto own = std::ranges::find(spring.of_joints, joint, [](const auto& bone) { return bone.first; });
  return own == spring.of_joints.end() ? spring.numbers : own->second;
}

void apply(const SpringBones& spring, std::vector<RodBone>& bones) {
  std::vector<double> square_frequency;
  for (RodBone& bone : bones) {
    const SpringNumbers& numbers = numbers_at(spring, bone.joint);
    const double drag = std::min(numbers.drag_force, kMostDrag), length = (bone.end - bone.begin).norm();
    bone.density_kg_m3 = RodRecipe{}.density_kg_m3;
    bone.drag_per_s = kFrames_hz * drag / (1 - drag);
    if (!spring.collider_groups.empty() && numbers.hit_radius_m > 0)
      bone.radius_m = bone_radius_m(numbers.hit_radius_m, length);
    square_frequency.push_back(kFrames_hz * std::max(numbers.stiffness, kLeastStiffness) / length);
  }
  stiffen(bones, square_frequency);
  stiffen_links(bones);
}

double gravity_of(const SpringBones& spring, const std::string& where, Character& character) {
  const double gravity = kOfLoneBone * spring.numbers.gravity_power / kGravity;
  if (gravity > kMostGravity)
    character.notes.push_back(character.name + ": " + where + ": its gravityPower is " +
                              std::to_string(gravity) + " times the earth's gravity: taken as 100");
  return std::min(gravity, kMostGravity);
}

int joint_called(const Character& character, const std::string& name, const std::string& where) {
  if (name.ends_with('*'))
    throw BadInput(character.name + ": " + where + ": '" + name +
                   "' may be many; a rod has one root and at most one end");
  return static_cast<int>(find_joint(character, name, where));
}

// Of bones that have the name of the end those below the root are meant.
int end_called(const Character& character, const std::string& name, int root, const std::string& where) {
  if (name.ends_with('*')) return joint_called(character, name, where);
  const std::vector<bool> matched = match_joints(character, {name}, where);
  int below = -1;
  for (size_t j = 0; j < matched.size(); ++j) {
    if (!matched[j]) continue;
    int up = static_cast<int>(j);
    while (up >= 0 && up != root) up = character.joint_parent[static_cast<size_t>(up)];
    if (up != root) continue;
    if (below >= 0) return joint_called(character, name, where);
    below = static_cast<int>(j);
  }
  return below >= 0 ? below : joint_called(character, name, where);
}

// Which rod a joint is a bone of; -1: none.
class Owners {
 public:
  explicit Owners(const Character& character)
      : character_(character), owner_(character.joint_node.size(), -1) {}

  // Throws BadInput where bones of `rod` are another's.
  void take(const std::vector<Rod>& rods, const Rod& rod, const std::string& where) {
    std::vector<int> owner = owner_;
    for (const RodBone& bone : rod.bones) {
      if (bone.joint < 0) continue;
      int& own = owner[static_cast<size_t>(bone.joint)];
      if (own >= 0)
        refuse(where, "bone '" + name_of(bone.joint) + "' is moved by rod '" +
                          rods[static_cast<size_t>(own)].name + "' as well; let it be in one of them");
      own = static_cast<int>(rods.size());
    }
    const std::vector<int> carrier = carriers(owner);
    if (const int by = carrier[static_cast<size_t>(rod.attach)]; by >= 0)
      refuse(where, "it hangs on bone '" + name_of(rod.attach) + "', which rod '" +
                        rods[static_cast<size_t>(by)].name +
                        "' moves; make them one tree by naming that one's root alone");
    for (const Rod& other : rods)
      if (carrier[static_cast<size_t>(other.attach)] >= 0)
        refuse(where, "rod '" + other.name + "' hangs on its bone '" + name_of(other.attach) +
                          "'; make them one tree by naming this root alone");
    owner_ = std::move(owner);
  }

 private:
  // What hangs on a rod's bone is moved by it.
  std::vector<int> carriers(std::vector<int> owner) const {
    for (size_t j = 0; j < owner.size(); ++j) {
      const int up = character_.joint_parent[j];
      if (owner[j] < 0 && up >= 0) owner[j] = owner[static_cast<size_t>(up)];
    }
    return owner;
  }
  const std::string& name_of(int joint) const { return joint_name(character_, static_cast<size_t>(joint)); }
  [[noreturn]] void refuse(const std::string& where, const std::string& what) const {
    throw BadInput(character_.name + ": " + where + ": " + what);
  }
  const Character& character_;
  std::vector<int> owner_;
};

Rod make_rod(const Character& character, const RodPlace& place, const std::string& name) {
  Rod rod;
  rod.name = name;
  rod.attach = character.joint_parent[static_cast<size_t>(place.root)];
  if (rod.attach < 0)
    throw BadInput(character.name + ": " + place.where + ": its root '" +
                   joint_name(character, static_cast<size_t>(place.root)) +
                   "' hangs on no bone; name one below it");
  rod.bones = segment_bones(character, place);
  return rod;
}

SoftKind kind_of(const Character& character, const Rod& rod) {
  if (const auto kind = meaning_of(rod.name).kind) return *kind;
  const std::string& root = joint_name(character, static_cast<size_t>(rod.bones.front().joint));
  return meaning_of(root).kind.value_or(SoftKind::kOther);
}

void describe(const Character& character, Evidence evidence, Rod& rod) {
  rod.evidence = evidence;
  rod.kind = kind_of(character, rod);
  rod.frequency_hz = slowest_swing_rad_per_s(rod.bones) / (2 * std::numbers::pi);
}

// What the recipe's rods move, whether they can be made or not.
std::vector<bool> joints_on_stated(const Character& character, const std::vector<RodRecipe>& recipes) {
  std::vector<bool> on(character.joint_node.size(), false);
  for (const RodRecipe& recipe : recipes)
    on[static_cast<size_t>(joint_called(character, recipe.root, "recipe: rod '" + recipe.name + "'"))] = true;
  for (size_t j = 0; j < on.size(); ++j)
    if (const int up = character.joint_parent[j]; up >= 0 && on[static_cast<size_t>(up)]) on[j] = true;
  return on;
}

// The bone that a strap's end is sewn to, as the recipe says.
SewnEnd stated_end(const Character& character, const RodRecipe& recipe, const Rod& rod,
                   const std::vector<bool>& on_rods, const std::string& where) {
  const int joint = joint_called(character, recipe.end_joint, where + ": end_joint");
  if (on_rods[static_cast<size_t>(joint)])
    throw BadInput(character.name + ": " + where + ": end_joint '" + recipe.end_joint +
                   "' is moved by a rod; name a bone that none moves");
  if (!is_chain(rod))
    throw BadInput(character.name + ": " + where +
                   ": it has branches, and end_joint holds the end of one; state the rod's end");
  return {joint, find_seam(character, rod, joint, on_rods).value_or(rod.bones.back().end)};
}

// The same bones, the last one up to where it is sewn on.
void hold_end(const Character& character, const SewnEnd& sewn, RodPlace place, Rod& rod) {
  place.end = rod.bones.back().joint;
  place.end_place = sewn.place;
  rod.bones = segment_bones(character, place);
  rod.end_joint = sewn.joint;
}

std::string end_note(const Character& character, const Rod& rod, const std::string& where) {
  return character.name + ": " + where + ": its last bone's skin goes on to bone '" +
         joint_name(character, static_cast<size_t>(rod.end_joint)) +
         "', which holds its end as well; state end_joint for another one, or max_displacement to let it "
         "swing";
}

// Before its bones get their stiffness, which counts on their lengths.
void hold_end(Character& character, const RodRecipe& recipe, const std::vector<bool>& on_rods,
              const RodPlace& place, Rod& rod) {
  if (!recipe.end_joint.empty())
    return hold_end(character, stated_end(character, recipe, rod, on_rods, place.where), place, rod);
  if (recipe.max_displacement > 0) return;
  const std::optional<SewnEnd> found = find_sewn_end(character, rod, on_rods);
  if (!found) return;
  hold_end(character, *found, place, rod);
  character.notes.push_back(end_note(character, rod, place.where));
}

void apply(const RodRecipe& recipe, Rod& rod) {
  apply(recipe, rod.bones);
  rod.gravity = recipe.gravity;
  rod.sag = recipe.sag;
  rod.max_displacement = recipe.max_displacement;
}

// As the file states it.
Rod rod_of_spring(Character& character, const SpringBones& spring, const RodPlace& place,
                  const std::string& name) {
  Rod rod = make_rod(character, place, name);
  apply(spring, rod.bones);
  rod.sag = 1;
  rod.states_limit = false;
  describe(character, Evidence::kSpringBone, rod);
  rod.gravity = gravity_of(spring, place.where, character);
  rod.gravity_direction = spring.numbers.gravity_direction;
  rod.collider_groups = spring.collider_groups;
  return rod;
}

Rod rod_as_in_file(Character& character, const RodRecipe& recipe, const RodPlace& place) {
  const auto spring = std::ranges::find(character.springs, place.root, &SpringBones::root);
  if (spring == character.springs.end()) {
    const JointNames names(character);
    std::string known;
    for (const SpringBones& other : character.springs)
      known += (known.empty() ? "" : ", ") + names.unique(static_cast<size_t>(other.root));
    throw BadInput(character.name + ": " + place.where +
                   ": \"as_in_file\": no spring bones of the file begin at '" + recipe.root + "'; " +
                   (known.empty() ? "it has none: state frequency_hz" : "they begin at " + known));
  }
  const RodPlace in_file{place.where, spring->root, spring->end, spring->end_node, spring->tail_m};
  Rod rod = rod_of_spring(character, *spring, in_file, recipe.name);
  if (recipe.max_displacement > 0) rod.max_displacement = recipe.max_displacement, rod.states_limit = true;
  return rod;
}

std::vector<Rod> stated_rods(Character& character, const std::vector<RodRecipe>& recipes) {
  std::vector<Rod> rods;
  const std::vector<bool> on_rods = joints_on_stated(character, recipes);
  Owners owners(character);
  for (const RodRecipe& recipe : recipes) {
    RodPlace place{"recipe: rod '" + recipe.name + "'"};
    place.root = joint_called(character, recipe.root, place.where);
    if (!recipe.end.empty()) place.end = end_called(character, recipe.end, place.root, place.where);
    Rod rod;
    if (recipe.as_in_file) {
      rod = rod_as_in_file(character, recipe, place);
    } else {
      rod = make_rod(character, place, recipe.name);
      hold_end(character, recipe, on_rods, place, rod);
      apply(recipe, rod);
      describe(character, Evidence::kRecipe, rod);
    }
    rod.learned_start = recipe.learned_start;
    owners.take(rods, rod, place.where);
    rods.push_back(std::move(rod));
  }
  return rods;
}

bool moves_claimed(const Rod& rod, const std::vector<bool>& claimed) {
  return std::ranges::any_of(rod.bones, [&](const RodBone& bone) {
    return bone.joint >= 0 && static_cast<size_t>(bone.joint) < claimed.size() &&
           claimed[static_cast<size_t>(bone.joint)];
  });
}

std::vector<Rod> rods_of_springs(Character& character, const std::vector<bool>& claimed,
                                 std::vector<SkippedPart>* skipped) {
  std::vector<Rod> rods;
  Owners owners(character);
  const JointNames names(character);
  bool collides = false;
  for (const SpringBones& spring : character.springs) {
    const std::string name = names.unique(static_cast<size_t>(spring.root));
    const RodPlace place{"spring bone '" + name + "'", spring.root, spring.end, spring.end_node,
                         spring.tail_m};
    try {
      Rod rod = rod_of_spring(character, spring, place, name);
      if (moves_claimed(rod, claimed)) {
        if (skipped != nullptr)
          skipped->push_back(
              {name, rod.evidence, rod.kind, "its bones are in a soft region, which comes first"});
        continue;
      }
      owners.take(rods, rod, place.where);
      collides |= !spring.collider_groups.empty();
      rods.push_back(std::move(rod));
    } catch (const BadInput& refused) {
      character.notes.push_back(std::string(refused.what()) + ": left out");
    }
  }
  if (!rods.empty())
    character.notes.push_back("spring bones of the file became " + std::to_string(rods.size()) +
                              " rods; a recipe's \"rods\" takes their place");
  if (collides)
    character.notes.push_back(
        "spring bones: the file's colliders are what rods collide with, each with its own groups");
  return rods;
}

void sort_by_root(std::vector<Rod>& rods) {
  std::ranges::sort(rods, {}, [](const Rod& rod) { return rod.bones.front().joint; });
}

}  // namespace

std::vector<Rod> find_rods(Character& character, const Recipe& recipe, const std::vector<bool>& claimed,
                           std::vector<SkippedPart>* skipped) {
  std::vector<Rod> rods =
      recipe.rods ? stated_rods(character, *recipe.rods) : rods_of_springs(character, claimed, skipped);
  sort_by_root(rods);
  return rods;
}

void add_named_rods(const Character& character, const std::vector<RodRecipe>& named, std::vector<Rod>& rods,
                    std::vector<SkippedPart>& skipped) {
  Owners owners(character);
  std::vector<Rod> taken;
  for (Rod& rod : rods) {
    owners.take(taken, rod, "rod '" + rod.name + "'");
    taken.push_back(std::move(rod));
  }
  for (const RodRecipe& recipe : named) {
    RodPlace place{"bone '" + recipe.name + "'"};
    place.root = joint_called(character, recipe.root, place.where);
    try {
      Rod rod = make_rod(character, place, recipe.name);
      apply(recipe, rod);
      rod.states_limit = false;
      describe(character, Evidence::kBoneName, rod);
      owners.take(taken, rod, place.where);
      taken.push_back(std::move(rod));
    } catch (const BadInput& refused) {
      skipped.push_back({recipe.name, Evidence::kBoneName,
                         meaning_of(recipe.name).kind.value_or(SoftKind::kOther), refused.what()});
    }
  }
  rods = std::move(taken);
  sort_by_root(rods);
}

std::vector<bool> joints_on_rods(const Character& character, const std::vector<Rod>& rods) {
  std::vector<bool> on(character.joint_node.size(), false);
  for (const Rod& rod : rods)
    for (const RodBone& bone : rod.bones)
      if (bone.joint >= 0) on[static_cast<size_t>(bone.joint)] = true;
  for (size_t j = 0; j < on.size(); ++j) {
    const int up = character.joint_parent[j];
    if (up >= 0 && on[static_cast<size_t>(up)]) on[j] = true;
  }
  return on;
}

}  // namespace sinew::baker
