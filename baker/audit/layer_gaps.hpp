// layer_gaps.hpp  How far layers of surface stand apart where one of them is soft: clothes and skin.
#pragma once
#include <limits>
#include <vector>

#include "baker/audit/parts.hpp"
#include "baker/audit/player.hpp"
#include "baker/mesh/regions/layers.hpp"

namespace sinew::baker {

// Along the normal of the layer that leads (mesh/regions/layers.hpp), positive as the character is bound.
struct LayerGap {
  double least_m = std::numeric_limits<double>::infinity(), largest_m = -least_m;  // as it is shown
  double file_least_m = least_m, file_largest_m = -least_m;                        // as it is skinned
  double crossed_m = 0;  // how deep what is shown has crossed where skinning keeps it apart

  bool any() const { return least_m <= largest_m; }
  void take(const LayerGap& other);  // the extremes of both
};

class LayerGaps {
 public:
  LayerGaps(const pack::PackView& character, const AuditedParts& parts);

  // A gap for each part, of the player's last read.
  std::vector<LayerGap> of(const Player& player) const;

 private:
  struct Pair {
    Eigen::Index vertex = 0;
    std::array<Eigen::Index, 3> beneath{};
    std::array<float, 3> share{};
    float side = 1;  // on which of the triangle's sides the vertex is bound
    float bound_m = 0;
    size_t part = 0;
  };
  static float gap_m(const Pair& pair, const Player::Surface& surface);

  std::vector<Pair> pairs_;
  size_t parts_ = 0;
};

}  // namespace sinew::baker
