// bone_pieces.cpp  From names and islands to pieces, and what speaks against each.
#include "baker/mesh/parts/bone_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <tuple>

#include "baker/mesh/anatomy/bone_names.hpp"
#include "baker/mesh/anatomy/joint_names.hpp"
#include "baker/mesh/parts/piece_softness.hpp"
#include "baker/mesh/surface/flesh_shape.hpp"

namespace sinew::baker {
namespace {

constexpr size_t kFewestVertices = 4;
constexpr double kTooSmall = 0.03;   // extent, of the character's
constexpr double kLarge = 0.05;      // of what has no name
constexpr double kFarOut = 0.3;      // of its extent, of what has no name
constexpr double kBesidesIt = 0.25;  // of its vertices: a bone's other flesh, or it is the bone's body
constexpr size_t kMostUnnamed = 16;  // doubts to be read one by one

enum class Source { kNode, kMesh, kMaterial, kNone };

struct Naming {
  Source source = Source::kNone;
  std::string name = {};
  std::optional<SoftKind> kind = {};
  bool hard = false;
};

// What a vertex's names say: the mesh's, and where those say nothing, as of a body of one mesh, the
// material's.
class Names {
 public:
  explicit Names(const Character& character) : mesh_(character.positions.size(), -1), material_(mesh_) {
    for (size_t m = 0; m < character.meshes.size(); ++m) {
      const MeshSpan& mesh = character.meshes[m];
      for (size_t v = 0; v < mesh.vertex_count; ++v) mesh_[mesh.first_vertex + v] = static_cast<int>(m);
      of_mesh_.push_back(first_soft({{Source::kNode, character.nodes[static_cast<size_t>(mesh.node)].name},
                                     {Source::kMesh, mesh.name}}));
    }
    for (size_t m = 0; m < character.materials.size(); ++m) {
      for (const int v : character.materials[m].vertices)
        material_[static_cast<size_t>(v)] = static_cast<int>(m);
      of_material_.push_back(first_soft({{Source::kMaterial, character.materials[m].name}}));
    }
  }

  Naming of(size_t vertex) const {
    const Naming none,
        &mesh = mesh_[vertex] < 0 ? none : of_mesh_[static_cast<size_t>(mesh_[vertex])],
        &material = material_[vertex] < 0 ? none : of_material_[static_cast<size_t>(material_[vertex])];
    return mesh.hard || mesh.kind ? mesh : material;
  }
  int mesh(size_t vertex) const { return mesh_[vertex]; }
  int material(size_t vertex) const { return material_[vertex]; }

 private:
  static Naming first_soft(const std::vector<Naming>& namings) {
    Naming found;
    for (const Naming& naming : namings) {
      const NameMeaning meaning = meaning_of(naming.name);
      if (meaning.hard) return {.hard = true};
      if (!found.kind && meaning.piece) found = {naming.source, naming.name, meaning.piece};
    }
    return found;
  }

  std::vector<int> mesh_, material_;  // a vertex
  std::vector<Naming> of_mesh_, of_material_;
};

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f %%", 100 * share);
  return text;
}

class PieceFinder {
 public:
  PieceFinder(const Character& character, const Surface& surface)
      : character_(character),
        surface_(surface),
        names_(character),
        joints_(character),
        fastened_(fastened_to(character, surface)) {
    Eigen::AlignedBox3d box;
    for (const Vector3& place : character.positions) box.extend(place);
    extent_m_ = box.diagonal().norm();
  }

  std::vector<BonePiece> run(bool unnamed_too) {
    std::vector<bool> in_piece(character_.positions.size(), false);
    gather_named(in_piece);
    if (!found_.empty()) {
      const BodyUnder body(character_, in_piece);
      for (BonePiece& piece : found_) judge_named(body, in_piece, piece);
    }
    if (unnamed_too) add_unnamed(in_piece);
    return std::move(found_);
  }

 private:
  int joint_of(size_t vertex) const { return fastened_[static_cast<size_t>(character_.welded[vertex])]; }
  std::string bone(int joint) const { return joint_name(character_, static_cast<size_t>(joint)); }
  bool is_on(size_t vertex, int joint) const {
    const Influences& skin = character_.skin[vertex];
    for (size_t k = 0; k < kInfluences; ++k)
      if (skin.joint[k] == joint && skin.weight[k] > 0) return true;
    return false;
  }

  void gather_named(std::vector<bool>& in_piece) {
    std::map<std::tuple<Source, std::string, int>, size_t> piece_of;
    for (size_t v = 0; v < in_piece.size(); ++v) {
      const int joint = joint_of(v);
      const Naming naming = names_.of(v);
      if (joint < 0 || !naming.kind || is_slot(joint)) continue;
      const auto [at, fresh] = piece_of.try_emplace({naming.source, naming.name, joint}, found_.size());
      if (fresh) found_.push_back(named(naming, joint));
      found_[at->second].vertices.push_back(static_cast<int>(v));
      in_piece[v] = true;
    }
  }

  // Bones that hold what a hand carries.
  bool is_slot(int joint) const { return meaning_of(bone(joint)).hard; }

  BonePiece named(const Naming& naming, int joint) const {
    BonePiece piece;
    piece.joint = joint;
    piece.is_named = true;
    piece.region.name = naming.name;
    piece.region.kind = naming.kind;
    const bool by_material = naming.source == Source::kMaterial;
    (by_material ? piece.region.material : piece.region.mesh) = naming.name;
    piece.evidence = by_material ? Evidence::kMaterialName : Evidence::kMeshName;
    piece.why = std::string(by_material ? "material '" : "mesh '") + naming.name + "' hangs on one bone, '" +
                bone(joint) + "'";
    return piece;
  }

  void judge_named(const BodyUnder& body, const std::vector<bool>& in_piece, BonePiece& piece) const {
    std::vector<bool> own(in_piece.size(), false);
    for (const int v : piece.vertices) own[static_cast<size_t>(v)] = true;
    const RegionScope scope = scope_of(character_, surface_, piece.region);
    bool elsewhere = false, blended = false;
    for (size_t v = 0; v < own.size(); ++v) {
      if (!scope.vertices[v] || own[static_cast<size_t>(character_.welded[v])]) continue;
      elsewhere = true;
      blended = blended || is_on(v, piece.joint);
    }
    if (elsewhere) piece.region.joints = {joints_.unique(static_cast<size_t>(piece.joint))};
    const PieceReach reach = piece_reach(character_, body, own);
    if (!body.is_there())
      piece.doubt = "there is no body for it to hang on";
    else if (piece.vertices.size() < kFewestVertices || reach.extent_m < kTooSmall * extent_m_)
      piece.doubt = "too small to be seen swinging";
    else if (blended)
      piece.doubt = "some of it moves with several bones";
    else if (!reach.swings())
      piece.doubt = "it sticks out of the soft tissue of '" + bone(piece.joint) + "' by " +
                    percent(reach.sticks_out_m / std::max(reach.extent_m, 1e-9)) +
                    " of its extent, and pieces stay rigid below " + percent(kSticksOut);
  }

  // Vertices of no piece that names speak of, a joint they follow most.
  std::vector<size_t> flesh_counts(const std::vector<bool>& in_named) const {
    std::vector<size_t> count(character_.joint_node.size(), 0);
    for (size_t v = 0; v < in_named.size(); ++v)
      if (!in_named[v]) ++count[static_cast<size_t>(character_.skin[v].joint[0])];
    return count;
  }

  // Figures of rigid parts have their limbs fastened to one bone, too.
  bool is_body(int mesh, size_t vertices, size_t flesh) const {
    if (static_cast<double>(flesh - vertices) < kBesidesIt * static_cast<double>(vertices)) return true;
    return mesh >= 0 && meaning_of(node_name(mesh)).body;
  }

  const std::string& node_name(int mesh) const {
    return character_.nodes[static_cast<size_t>(character_.meshes[static_cast<size_t>(mesh)].node)].name;
  }

  struct Unnamed {
    double extent_m = 0;
    int mesh = -1;  // that it is the whole of; -1: it is an island
    std::vector<int> vertices = {};
  };

  // Islands, or whole meshes on one bone. None of the large ones is flesh that another hangs on.
  void add_unnamed(const std::vector<bool>& in_named) {
    const std::vector<int> island = connected_parts(surface_, std::vector<bool>(in_named.size(), true));
    std::map<std::pair<int, int>, std::vector<int>> groups;  // (mesh, -1) or (-1, island)
    for (size_t v = 0; v < in_named.size(); ++v) {
      const auto welded = static_cast<size_t>(character_.welded[v]);
      if (island[welded] < 0 || joint_of(v) < 0 || in_named[v] || names_.of(v).hard || is_slot(joint_of(v)))
        continue;
      const bool whole = names_.mesh(v) >= 0 && one_joint(names_.mesh(v)) >= 0;
      groups[whole ? std::pair(names_.mesh(v), -1) : std::pair(-1, island[welded])].push_back(
          static_cast<int>(v));
    }
    const std::vector<size_t> flesh = flesh_counts(in_named);
    std::vector<Unnamed> large;
    std::vector<bool> no_flesh = in_named;
    for (auto& [key, vertices] : groups) {
      const double extent = extent_m(character_, vertices);
      if (extent < kLarge * extent_m_ || vertices.size() < kFewestVertices) continue;
      const auto joint = static_cast<size_t>(joint_of(static_cast<size_t>(vertices.front())));
      if (is_body(key.first, vertices.size(), flesh[joint])) continue;
      for (const int v : vertices) no_flesh[static_cast<size_t>(v)] = true;
      large.push_back({extent, key.first, std::move(vertices)});
    }
    if (large.empty()) return;
    std::ranges::stable_sort(large, std::greater{}, &Unnamed::extent_m);
    const BodyUnder body(character_, no_flesh);
    if (body.is_there()) add_far_out(body, std::move(large));
  }

  void add_far_out(const BodyUnder& body, std::vector<Unnamed> large) {
    size_t count = 0;
    for (Unnamed& piece : large) {
      if (count == kMostUnnamed) return;
      std::vector<bool> own(character_.positions.size(), false);
      for (const int v : piece.vertices) own[static_cast<size_t>(v)] = true;
      const PieceReach reach = piece_reach(character_, body, own);
      if (!reach.swings() || reach.farthest_m < kFarOut * piece.extent_m) continue;
      found_.push_back(unnamed(piece.mesh, reach, std::move(piece.vertices)));
      ++count;
    }
  }

  int one_joint(int mesh) const {
    const MeshSpan& span = character_.meshes[static_cast<size_t>(mesh)];
    const int joint = joint_of(span.first_vertex);
    for (size_t v = 0; v < span.vertex_count; ++v)
      if (joint_of(span.first_vertex + v) != joint) return -1;
    return joint;
  }

  BonePiece unnamed(int mesh, const PieceReach& reach, std::vector<int> vertices) const {
    BonePiece piece;
    piece.joint = joint_of(static_cast<size_t>(vertices.front()));
    const std::string name = mesh < 0 ? "" : node_name(mesh);
    if (!name.empty()) {
      piece.region.name = piece.region.mesh = name;
      piece.why = "mesh '" + name + "'";
    } else {
      const auto softness = [&](int v) { return reach.softness[static_cast<size_t>(v)]; };
      const Vector3& tip =
          character_.positions[static_cast<size_t>(*std::ranges::max_element(vertices, {}, softness))];
      piece.region.name = "piece_on_" + bone(piece.joint);
      piece.region.island_at = (1000 * tip.array()).round() / 1000;  // as a recipe is read and edited
      piece.why = "a piece of its own";
    }
    piece.why += " hangs on one bone, '" + bone(piece.joint) + "', and sticks out by " +
                 percent(reach.farthest_m / reach.extent_m) + " of its extent";
    piece.doubt = "no name says that it is soft";
    piece.vertices = std::move(vertices);
    return piece;
  }

  const Character& character_;
  const Surface& surface_;
  Names names_;
  JointNames joints_;
  std::vector<int> fastened_;
  double extent_m_ = 0;
  std::vector<BonePiece> found_;
};

}  // namespace

std::vector<BonePiece> named_pieces(const Character& character, const Surface& surface) {
  return PieceFinder(character, surface).run(false);
}

std::vector<BonePiece> bone_pieces(const Character& character, const Surface& surface) {
  return PieceFinder(character, surface).run(true);
}

}  // namespace sinew::baker
