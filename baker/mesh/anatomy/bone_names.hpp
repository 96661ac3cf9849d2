// bone_names.hpp  What the name of a bone or mesh says about its part of the body.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "baker/mesh/anatomy/soft_kind.hpp"

namespace sinew::baker {

// Lower-case words between separators, digits and changes of case: "b_LeftEar01.R" is b left ear r. Words
// that mean something only together are one: "PonyTail" is ponytail.
std::vector<std::string> words_of(const std::string& name);

struct NameMeaning {
  std::optional<SoftKind> kind;   // of a part that swings
  std::optional<SoftKind> piece;  // of a piece of surface with that name: hair, cloth, a hat, ...
  bool hard = false;              // horn, metal, leather: what is so named never swings
  bool body = false;              // of the skeleton that animators move: head, spine, limbs, wings, the face
  bool face = false;              // of it, a head or what is on one
  bool helper = false;            // of the rig: controls, targets, ends, twists; it says nothing of its own
};

// By whole words, as Mixamo, Rigify, Unreal, VRoid, MakeHuman, Biped, KayKit and Quaternius use them. The
// last word decides: a hair ribbon is a ribbon, an ear ring is neither. Thighs, legs and pectorals are flesh
// only where the name says so ("thigh_jiggle_l"), and a limb otherwise.
NameMeaning meaning_of(const std::string& name);

// A mesh or file whose name says that it is hard all over: armour, a robot, a skeleton.
bool is_hard_body(const std::string& name);

// Chains of bones of this kind swing as rods.
bool swings_as_chain(SoftKind kind);

}  // namespace sinew::baker
