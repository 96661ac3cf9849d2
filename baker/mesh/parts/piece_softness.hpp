// piece_softness.hpp  How soft pieces of surface are that a region names: held at the body, softest where
// they stick out of it furthest.
#pragma once
#include <optional>
#include <vector>

#include "baker/import/character/character.hpp"
#include "baker/mesh/anatomy/bones.hpp"
#include "baker/mesh/anatomy/fit_capsule.hpp"
#include "baker/mesh/recipe/recipe.hpp"
#include "baker/mesh/recipe/region_scope.hpp"
#include "baker/mesh/surface/closest_place.hpp"
#include "baker/mesh/surface/surface.hpp"

namespace sinew::baker {

// Pieces of less than this share of their extent out of the body stay rigid.
inline constexpr double kSticksOut = 0.1;

// The body that pieces hang on: of each bone the capsule of its flesh, and that flesh's surface. A bone
// without flesh of its own is its parent's.
class BodyUnder {
 public:
  // is_piece: vertices that are no flesh.
  BodyUnder(const Character& character, const std::vector<bool>& is_piece);

  bool is_there() const;                                             // any flesh at all
  double out_m(const Influences& skin, const Vector3& place) const;  // of the capsules, weighted as the skin
  double gap_m(int joint, const Vector3& place, double reach_m) const;  // to that flesh, at most the reach

 private:
  int flesh_joint(int joint) const;

  const Character& character_;
  Bones bones_;
  std::vector<std::optional<FittedCapsule>> capsule_;  // a joint
  std::vector<ClosestPlace> surface_;                  // of a joint's flesh
};

// How far one piece sticks out.
struct PieceReach {
  std::vector<double> softness;  // a vertex: 0 held, 1 at the farthest; 0 where it is not of the piece
  double sticks_out_m =
      0;  // its farthest vertex, of the capsules and of the flesh; more than kSticksOut is not told apart
  double farthest_m = 0;  // its farthest vertex, of the capsules alone
  double extent_m = 0;
  bool swings() const { return sticks_out_m >= kSticksOut * extent_m && extent_m > 0; }
};

PieceReach piece_reach(const Character& character, const BodyUnder& body, const std::vector<bool>& piece);

// Of a recipe's regions those that name pieces. What one of them has, regions of bones leave.
class PieceRegions {
 public:
  PieceRegions(const Character& character, const Surface& surface, const std::vector<RegionRecipe>& regions);

  bool are_there() const;
  bool claims(size_t vertex) const { return claimed_[vertex]; }
  std::vector<double> softness(size_t region) const;  // a vertex; 0 where too little sticks out
  // Of islands that meet, one number; -1 for vertices of no piece.
  const std::vector<int>& pieces(size_t region) const { return pieces_[region]; }
  // The share of its extent that the farthest piece sticks out by, told apart below kSticksOut.
  double share_out(size_t region) const;

 private:
  std::vector<PieceReach> reaches(size_t region) const;

  const Character& character_;
  std::vector<RegionScope> scopes_;       // a region
  std::vector<std::vector<int>> pieces_;  // a region; empty where it names bones alone
  std::vector<bool> claimed_;
  std::optional<BodyUnder> body_;
};

}  // namespace sinew::baker
