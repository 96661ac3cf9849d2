// body_side.cpp  Directions of sides, and how far out on them the skin lies.
#include "baker/mesh/anatomy/body_side.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "baker/common/smooth_step.hpp"
#include "baker/mesh/anatomy/bone_names.hpp"
#include "baker/mesh/anatomy/bones.hpp"
#include "baker/mesh/anatomy/joint_names.hpp"

namespace sinew::baker {
namespace {

constexpr std::array<const char*, 7> kNames = {"around", "front",  "back",   "above",
                                               "below",  "inside", "outside"};
constexpr double kMiddle = 0.75;     // of the farthest distance: from here on all is as soft as the middle
constexpr double kBelowEyes = 0.15;  // of the head's height: where cheeks begin below the eyes

// Unit, away from the bones.
Vector3 direction_of(const Anatomy& anatomy, BodySide side, const Vector3& place) {
  const Vector3 outward = anatomy.aside * (place.dot(anatomy.aside) < anatomy.middle_m ? -1 : 1);
  switch (side) {
    case BodySide::kFront:
      return anatomy.forward;
    case BodySide::kBack:
      return -anatomy.forward;
    case BodySide::kAbove:
      return Vector3::UnitY();
    case BodySide::kBelow:
      return -Vector3::UnitY();
    case BodySide::kInside:
      return -outward;
    case BodySide::kOutside:
      return outward;
    case BodySide::kAround:
      break;
  }
  return Vector3::Zero();
}

// The sides of a kind, added up: a thigh is soft inside and behind.
std::vector<BodySide> sides_of(SoftKind kind, bool lies) {
  switch (kind) {
    case SoftKind::kBelly:
    case SoftKind::kBreast:
      return {lies ? BodySide::kBelow : BodySide::kFront};
    case SoftKind::kGlute:
      return {BodySide::kBack};
    case SoftKind::kThigh:
      return {BodySide::kInside, BodySide::kBack};
    case SoftKind::kCheek:
      return {BodySide::kFront, BodySide::kOutside};
    case SoftKind::kUdder:
      return {BodySide::kBelow};
    case SoftKind::kHump:
      return {BodySide::kAbove};
    default:
      return {};
  }
}

double eye_height(const Character& character, const std::vector<bool>& reached) {
  double low = std::numeric_limits<double>::infinity(), high = -low, eyes = 0, count = 0;
  for (size_t v = 0; v < reached.size(); ++v) {
    if (!reached[v]) continue;
    low = std::min(low, character.positions[v].y());
    high = std::max(high, character.positions[v].y());
  }
  for (size_t j = 0; j < character.inverse_bind.size(); ++j) {
    const std::vector<std::string> words = words_of(joint_name(character, j));
    if (std::ranges::none_of(words, [](const std::string& word) { return word == "eye" || word == "eyes"; }))
      continue;
    eyes += character.inverse_bind[j].inverse()(1, 3);
    ++count;
  }
  return count > 0 ? eyes / count : (low + high) / 2;
}

// The bones that a region lies about: the spine where it is on it, else its own.
std::vector<Vector3> line_of(const Character& character, const Anatomy& anatomy,
                             const std::vector<bool>& joints) {
  bool on_trunk = false;
  for (size_t j = 0; j < joints.size(); ++j) on_trunk = on_trunk || (joints[j] && anatomy.trunk[j]);
  if (on_trunk) return anatomy.line;
  const Bones bones = find_bones(character, {});
  std::vector<Vector3> line;
  for (size_t j = 0; j < joints.size(); ++j)
    if (joints[j]) line.push_back(bones.head[j]), line.push_back(bones.tail[j]);
  return line;
}

}  // namespace

std::optional<BodySide> side_called(const std::string& name) {
  for (size_t side = 1; side < kNames.size(); ++side)
    if (name == kNames[side]) return static_cast<BodySide>(side);
  return std::nullopt;
}

std::string side_names() {
  std::string names;
  for (size_t side = 1; side < kNames.size(); ++side)
    names += (side > 1 ? ", " : "") + std::string(kNames[side]);
  return names;
}

std::optional<std::vector<double>> side_share(const Character& character,
                                              const std::optional<Anatomy>& anatomy, SoftKind kind,
                                              std::optional<BodySide> side, const std::vector<bool>& joints,
                                              const std::vector<bool>& reached) {
  if (!anatomy || side == BodySide::kAround) return std::nullopt;
  const std::vector<BodySide> sides = side ? std::vector<BodySide>{*side} : sides_of(kind, anatomy->lies);
  if (sides.empty()) return std::nullopt;
  const std::vector<Vector3> line = line_of(character, *anatomy, joints);
  std::vector<double> out(character.positions.size(), 0);
  double farthest = 0;
  for (size_t v = 0; v < out.size(); ++v) {
    const Vector3& place = character.positions[v];
    Vector3 towards = Vector3::Zero();
    for (const BodySide one : sides) towards += direction_of(*anatomy, one, place);
    out[v] = (place - nearest_on(line, place)).dot(towards.normalized());
    if (reached[v]) farthest = std::max(farthest, out[v]);
  }
  if (!(farthest > 0)) return std::nullopt;
  for (double& share : out) share = smooth_step(0, kMiddle * farthest, share);
  if (side || kind != SoftKind::kCheek) return out;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (size_t v = 0; v < out.size(); ++v)
    if (reached[v])
      low = std::min(low, character.positions[v].y()), high = std::max(high, character.positions[v].y());
  const double eyes = eye_height(character, reached);
  for (size_t v = 0; v < out.size(); ++v)
    out[v] *= smooth_step(0, kBelowEyes * (high - low), eyes - character.positions[v].y());
  return out;
}

}  // namespace sinew::baker
