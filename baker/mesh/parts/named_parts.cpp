// named_parts.cpp  From names to parts, and what speaks against each.
#include "baker/mesh/parts/named_parts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "baker/common/bad_input.hpp"
#include "baker/mesh/anatomy/bone_names.hpp"
#include "baker/mesh/anatomy/bones.hpp"
#include "baker/mesh/anatomy/joint_names.hpp"
#include "baker/mesh/parts/anatomy_parts.hpp"
#include "baker/mesh/parts/bone_pieces.hpp"
#include "baker/mesh/rods/rod_bones.hpp"
#include "baker/mesh/surface/flesh_shape.hpp"
#include "baker/mesh/surface/skin_weight.hpp"

namespace sinew::baker {
namespace {

constexpr double kTooSmall = 0.03;      // extent, of the character's longest side
constexpr double kMostOfBody = 0.5;     // share of the vertices: more is the body itself
constexpr double kThickBelly = 0.075;   // flesh of the height; a lean human's is 0.05 .. 0.06
constexpr double kMoves = 0.5;          // skin weight of a part's joints, of its largest
constexpr double kMovesNothing = 0.02;  // largest skin weight
constexpr double kThickPercentile = 0.75;
constexpr double kNaturalDamping = 0.5;  // of rods: they trail and settle in a swing or two
constexpr double kNaturalReach = 0.5;    // of a rod's length: it is not shown further from its pose

// Hair and cloth hang down in every pose; muscles hold a tail or an ear where the artist posed it.
bool hangs(SoftKind kind) { return kind == SoftKind::kHair || kind == SoftKind::kCloth; }
constexpr size_t kFewestVertices = 4;

constexpr const char* kGiveChain =
    "give it a chain of bones, or one bone and an end at its tip, to let it swing";

// What names and the tree say, once for all joints.
struct Skeleton {
  explicit Skeleton(const Character& character)
      : parent(character.joint_parent), most_weight(parent.size(), 0) {
    for (size_t j = 0; j < parent.size(); ++j) meaning.push_back(meaning_of(joint_name(character, j)));
    for (const Influences& skin : character.skin)
      for (size_t k = 0; k < kInfluences; ++k) {
        double& most = most_weight[static_cast<size_t>(skin.joint[k])];
        most = std::max(most, skin.weight[k]);
      }
    body_below.assign(parent.size(), -1);
    for (size_t j = parent.size(); j-- > 1;) {
      if (parent[j] < 0) continue;
      int& above = body_below[static_cast<size_t>(parent[j])];
      if (meaning[j].body)
        above = static_cast<int>(j);
      else if (body_below[j] >= 0)
        above = body_below[j];
    }
  }

  bool moves_flesh(size_t joint) const { return most_weight[joint] > kMovesNothing; }

  std::vector<size_t> subtree(size_t root) const {
    std::vector<bool> in(parent.size(), false);
    std::vector<size_t> joints;
    for (size_t j = root; j < parent.size(); ++j) {
      in[j] = j == root || (parent[j] >= 0 && in[static_cast<size_t>(parent[j])]);
      if (in[j]) joints.push_back(j);
    }
    return joints;
  }

  bool hangs_on_face(size_t joint) const {
    for (int up = parent[joint]; up >= 0; up = parent[static_cast<size_t>(up)])
      if (meaning[static_cast<size_t>(up)].face) return true;
    return false;
  }

  std::vector<int> parent;
  std::vector<NameMeaning> meaning;
  std::vector<double> most_weight;  // of any vertex
  std::vector<int> body_below;      // a joint of the body that hangs on this one; -1: none
};

// Welded vertices that these joints move, as much as they move any.
std::vector<int> flesh_of(const Character& character, const std::vector<size_t>& joints) {
  std::vector<bool> in(character.joint_node.size(), false);
  for (const size_t j : joints) in[j] = true;
  double most = kMovesNothing;
  for (const Influences& skin : character.skin) most = std::max(most, weight_on(skin, in));
  std::vector<int> flesh;
  for (size_t v = 0; v < character.skin.size(); ++v)
    if (character.welded[v] == static_cast<int>(v) && weight_on(character.skin[v], in) > kMoves * most)
      flesh.push_back(static_cast<int>(v));
  return flesh;
}

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, at);
  return *at;
}

double longest_side(const Character& character) {
  Eigen::AlignedBox3d box;
  for (const Vector3& place : character.positions) box.extend(place);
  return box.sizes().maxCoeff();
}

double longest_chain_m(const std::vector<RodBone>& bones) {
  std::vector<double> length(bones.size(), 0);
  for (size_t b = 0; b < bones.size(); ++b) {
    length[b] = (bones[b].end - bones[b].begin).norm();
    if (bones[b].parent >= 0) length[b] += length[static_cast<size_t>(bones[b].parent)];
  }
  return *std::ranges::max_element(length);
}

class Finder {
 public:
  Finder(const Character& character, const Surface& surface, const std::vector<bool>& claimed,
         NamedPartsWanted wanted)
      : character_(character),
        names_(character),
        surface_(surface),
        skeleton_(character),
        fastened_(fastened_to(character, surface)),
        wanted_(std::move(wanted)),
        done_(claimed),
        taken_(claimed),
        longest_m_(longest_side(character)) {
    done_.resize(skeleton_.parent.size(), false);
    taken_.resize(done_.size(), false);
    wanted_.has_region.resize(character.positions.size(), false);
    listed_.assign(character.positions.size(), false);
    found_.coreless.assign(done_.size(), false);
    for (size_t v = 0; v < character.welded.size(); ++v)
      welded_ += character.welded[v] == static_cast<int>(v) ? 1 : 0;
  }

  NamedParts run() {
    for (size_t j = 0; j < done_.size(); ++j)
      if (!done_[j] && skeleton_.meaning[j].kind) look_at(j, *skeleton_.meaning[j].kind);
    look_at_pieces();
    look_at_meshes();
    if (wanted_.regions) look_at_shape();
    return std::move(found_);
  }

 private:
  const std::string& name(size_t joint) const { return joint_name(character_, joint); }

  void skip(const std::string& part, SoftKind kind, const std::string& why,
            Evidence evidence = Evidence::kBoneName) {
    found_.skipped.push_back({part, evidence, kind, why});
  }

  void look_at(size_t joint, SoftKind kind) {
    const std::vector<size_t> joints = skeleton_.subtree(joint);
    const std::vector<int> flesh = flesh_of(character_, joints);
    if (flesh.empty() || skeleton_.parent[joint] < 0) return;
    if (kind == SoftKind::kTrunk && !skeleton_.hangs_on_face(joint)) return;  // a torso, or a tree
    if (const int body = skeleton_.body_below[joint]; body >= 0) return look_at_body(joint, kind, body);
    if (is_organiser(joint)) return;
    const bool claimed = std::ranges::any_of(joints, [&](size_t j) { return done_[j]; });
    for (const size_t j : joints) done_[j] = true;
    if (claimed) return;
    if (!hangs(kind) &&  // a wig or a cape is a file of its own
        static_cast<double>(flesh.size()) > kMostOfBody * static_cast<double>(welded_))
      return skip(name(joint), kind, "moves more than half of the character: a body, not a part of one");
    if (extent_m(character_, flesh) < kTooSmall * longest_m_)
      return skip(name(joint), kind, "too small to be seen swinging");
    if (!swings_as_chain(kind))
      add_region(joint, kind, joints);
    else if (wanted_.rods)
      add_chain(joint, kind, joints);
  }

  // A bone that carries many chains and does not swing itself.
  bool is_organiser(size_t joint) const {
    size_t chains = 0;
    for (size_t j = joint + 1; j < done_.size(); ++j)
      if (skeleton_.parent[j] == static_cast<int>(joint) && skeleton_.meaning[j].kind) ++chains;
    return chains >= 3 || (chains == 2 && !skeleton_.moves_flesh(joint));
  }

  void look_at_body(size_t joint, SoftKind kind, int body) {
    done_[joint] = true;
    if (!skeleton_.moves_flesh(joint)) return;
    const std::string held = "'" + name(static_cast<size_t>(body)) + "' hangs on it";
    if (kind != SoftKind::kBelly) return skip(name(joint), kind, "part of the body: " + held);
    if (!wanted_.regions) return;
    const double share = thickness_of(joint) / bind_height(character_);
    if (share >= kThickBelly) return add_region(joint, kind, {joint});
    char text[96];
    std::snprintf(text, sizeof text,
                  "a lean spine bone: its soft tissue is %.1f %% of the height thick, below %.1f %%",
                  100 * share, 100 * kThickBelly);
    skip(name(joint), kind, text);
  }

  double thickness_of(size_t joint) {
    if (thickness_.empty()) thickness_ = flesh_thickness(character_, find_bones(character_, {}));
    std::vector<double> own;
    for (const int v : flesh_of(character_, {joint})) own.push_back(thickness_[static_cast<size_t>(v)]);
    return percentile(own, kThickPercentile);
  }

  // Why these joints' flesh cannot be tissue; empty where it can.
  std::string against_tissue(const std::vector<size_t>& joints) const {
    const std::vector<int> moved = flesh_of(character_, joints);
    std::vector<int> skin;
    for (const int v : moved)
      if (fastened_[static_cast<size_t>(v)] < 0) skin.push_back(v);
    if (moved.size() < kFewestVertices) return "moves fewer than four vertices";
    if (skin.size() < kFewestVertices) return "a piece of its own that is fastened to one bone";
    if (thickness_share(character_, skin) < kThinSheet) return "a thin sheet, without soft tissue in it";
    return "";
  }

  void add_region(size_t joint, SoftKind kind, const std::vector<size_t>& joints) {
    if (!wanted_.regions) return;
    const std::string why = against_tissue(joints);
    if (!why.empty()) return skip(name(joint), kind, why);
    RegionRecipe region;
    region.name = names_.unique(joint);
    region.kind = kind;
    for (const size_t j : joints) region.joints.push_back(names_.unique(j)), taken_[j] = true;
    found_.regions.push_back({region, Evidence::kBoneName, "bone '" + name(joint) + "'", ""});
  }

  void add_chain(size_t joint, SoftKind kind, const std::vector<size_t>& joints) {
    try {
      const std::vector<RodBone> bones =
          segment_bones(character_, {"bone name", static_cast<int>(joint), -1, -1});
      RodRecipe rod;
      rod.name = rod.root = names_.unique(joint);
      rod.frequency_hz = default_frequency_hz(kind, longest_chain_m(bones));
      rod.damping_ratio = kNaturalDamping;
      rod.gravity = hangs(kind) ? 1 : 0;
      rod.max_displacement = kNaturalReach;
      found_.rods.push_back(rod);
      for (const size_t j : joints) taken_[j] = true;
    } catch (const BadInput& refused) {
      if (moves_one_bone(joints)) return add_single(joint, kind);
      skip(name(joint), kind, refused.what());
    }
  }

  bool moves_one_bone(const std::vector<size_t>& joints) const {
    return std::ranges::none_of(joints.begin() + 1, joints.end(),
                                [&](size_t j) { return skeleton_.moves_flesh(j); });
  }

  // No chain: a fleshy one is tissue, anything else cannot swing.
  void add_single(size_t joint, SoftKind kind) {
    const bool fleshy = kind == SoftKind::kTail || kind == SoftKind::kEar || kind == SoftKind::kTrunk ||
                        kind == SoftKind::kTentacle;
    const std::string why = fleshy ? against_tissue({joint}) : "on one bone without an end";
    if (!why.empty()) return skip(name(joint), kind, why + "; " + kGiveChain);
    found_.coreless[joint] = true;
    add_region(joint, kind, {joint});
  }

  // What a name has said already is not said again.
  void look_at_shape() {
    for (Candidate& part : anatomy_parts(character_, done_)) {
      const bool named = std::ranges::any_of(
          found_.regions, [&](const Candidate& other) { return other.region.kind == part.region.kind; });
      if (named) continue;
      (part.doubt.empty() ? found_.regions : found_.doubtful).push_back(std::move(part));
    }
  }

  // What mesh and material names promise of what hangs on one bone.
  void look_at_pieces() {
    for (const BonePiece& piece : named_pieces(character_, surface_)) {
      const auto joint = static_cast<size_t>(piece.joint);
      for (const int v : piece.vertices) listed_[static_cast<size_t>(v)] = true;
      const bool has_region = std::ranges::any_of(
          piece.vertices, [&](int v) { return wanted_.has_region[static_cast<size_t>(v)]; });
      if (has_region || taken_[joint]) continue;
      const std::string part = piece.region.name;
      if (!piece.doubt.empty()) {
        skip(part, *piece.region.kind, piece.doubt, piece.evidence);
      } else if (wanted_.regions) {
        std::erase_if(found_.skipped, [&](const SkippedPart& other) { return other.part == name(joint); });
        found_.regions.push_back({piece.region, piece.evidence, piece.why, ""});
      } else {
        skip(part, *piece.region.kind,
             "hangs on one bone, '" + name(joint) + "'; a region of the recipe that names it lets it swing",
             piece.evidence);
      }
    }
  }

  // Other meshes that hang on one bone as a whole, in one line.
  void look_at_meshes() {
    if (character_.meshes.size() < 2) return;
    std::string others;
    size_t count = 0;
    for (const MeshSpan& mesh : character_.meshes) {
      const int joint = one_joint(mesh);
      if (joint < 0 || done_[static_cast<size_t>(joint)]) continue;
      if (mesh.skinned || listed_[mesh.first_vertex] || wanted_.has_region[mesh.first_vertex]) continue;
      others += (count++ > 0 ? ", " : "") + character_.nodes[static_cast<size_t>(mesh.node)].name;
    }
    if (count > 0) skip(others, SoftKind::kOther, "each is fastened to one bone", Evidence::kMeshName);
  }

  int one_joint(const MeshSpan& mesh) const {
    int joint = -1;
    for (size_t v = mesh.first_vertex; v < mesh.first_vertex + mesh.vertex_count; ++v) {
      const int own = fastened_[static_cast<size_t>(character_.welded[v])];
      if (own < 0 || (joint >= 0 && own != joint)) return -1;
      joint = own;
    }
    return joint;
  }

  const Character& character_;
  JointNames names_;
  const Surface& surface_;
  Skeleton skeleton_;
  std::vector<int> fastened_;
  NamedPartsWanted wanted_;
  std::vector<bool> done_;
  std::vector<bool> taken_;   // joints of stronger evidence, and of what was found
  std::vector<bool> listed_;  // vertices of pieces that names speak of
  double longest_m_;
  size_t welded_ = 0;
  std::vector<double> thickness_;
  NamedParts found_;
};

}  // namespace

NamedParts named_parts(const Character& character, const Surface& surface, const std::vector<bool>& claimed,
                       NamedPartsWanted wanted) {
  return Finder(character, surface, claimed, wanted).run();
}

std::vector<bool> flesh_joints(const Character& character) {
  const Skeleton skeleton(character);
  std::vector<bool> flesh(skeleton.parent.size(), false);
  for (size_t j = 0; j < flesh.size(); ++j) {
    const std::optional<SoftKind> kind = skeleton.meaning[j].kind;
    const bool own = kind && !swings_as_chain(*kind) && skeleton.body_below[j] < 0;
    const bool above = skeleton.parent[j] >= 0 && flesh[static_cast<size_t>(skeleton.parent[j])];
    flesh[j] = skeleton.parent[j] >= 0 && (own || above);
  }
  return flesh;
}

std::string how_to_make_soft(const Character& character, const std::vector<Candidate>& doubtful) {
  std::string parts;
  for (const Candidate& part : doubtful) parts += (parts.empty() ? "" : ", ") + part.region.name;
  if (!parts.empty())
    return "nothing swings: nothing of it is certain; in doubt are " + parts +
           ": sinew-bake propose writes a recipe of them, to switch on";

  const Skeleton skeleton(character);
  const std::vector<double> thickness = flesh_thickness(character, find_bones(character, {}));
  std::vector<bool> leaf(skeleton.parent.size(), true);
  for (const int up : skeleton.parent)
    if (up >= 0) leaf[static_cast<size_t>(up)] = false;
  std::vector<std::pair<double, size_t>> bones;
  for (size_t j = 0; j < skeleton.parent.size(); ++j) {
    const NameMeaning& meaning = skeleton.meaning[j];
    if (meaning.face || meaning.helper || !skeleton.moves_flesh(j)) continue;
    if (skeleton.parent[j] < 0 && skeleton.parent.size() == 1) continue;  // nothing would hold it
    std::vector<double> own;
    for (const int v : flesh_of(character, {j})) own.push_back(thickness[static_cast<size_t>(v)]);
    bones.emplace_back((leaf[j] ? -1 : 0) + percentile(own, kThickPercentile) / bind_height(character), j);
  }
  std::ranges::sort(bones, std::greater{});
  const std::string nothing =
      "nothing swings: no recipe, paint, spring bone, name or shape says what is soft";
  if (bones.empty()) return nothing;
  const JointNames called(character);
  nlohmann::json joints;
  for (size_t i = 0; i < std::min<size_t>(2, bones.size()); ++i)
    joints.push_back(called.unique(bones[i].second));
  return nothing +
         ". For the bones with the thickest soft tissue, a recipe: {\"regions\": [{\"name\": \"belly\", "
         "\"joints\": " +
         joints.dump() + "}]}";
}

}  // namespace sinew::baker
