// load_weights.hpp  Felt accelerations at a few control nodes, estimated for all flesh around them.
//
// Kriging (Matheron 1963). Accelerations by linear blend skinning are affine in the place under each joint,
// and flesh that answers loads moves as its modes do, so that what places p and q feel goes together by
//   k(p, q) = (a + (p - c).(q - c) / r^2) (1 + sum_j w_pj w_qj) + C(p, q)
// with a large, w the skin weights, c and r the middle and size of the nodes, and C what the modes answer to
// loads of all kinds: what of a node's acceleration is its own swinging is not taken for that of flesh far
// away. The best estimate however few the nodes and however they lie, in a plane or on a line; what all nodes
// of one bone feel alike all its flesh feels, and flesh of another bone half of it.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "baker/import/character/character.hpp"

namespace sinew::baker {

struct LoadPlaces {
  std::vector<Vector3> place;
  std::vector<Influences> skin;
  Eigen::MatrixXd answers;  // (3 places, modes): how far each mode takes them, over squared frequency

  void push_back(const Vector3& at, const Influences& weights) {
    place.push_back(at);
    skin.push_back(weights);
  }
  size_t size() const { return place.size(); }
};

// (flesh, nodes): what flesh feels is the sum of weight x what a node feels.
Eigen::MatrixXd load_weights(const LoadPlaces& nodes, const LoadPlaces& flesh);

}  // namespace sinew::baker
