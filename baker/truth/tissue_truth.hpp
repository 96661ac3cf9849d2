// tissue_truth.hpp  The ground truth of a skinned character's soft tissue.
//
// The posed, standing character is its own rest state: f = f_el(x) - f_el(x_skinned) + m (g - R_skin g), so that tissue departs from the
// artist's pose only by inertia and by turning against gravity. Free nodes start on the skinning.
#pragma once
#include <memory>

#include "baker/truth/cage.hpp"
#include "baker/truth/motion.hpp"

namespace sinew::baker {

struct TruthFrame {
  WorldPose pose;
  std::vector<Vector3> skinned;  // world, a vertex
  std::vector<Vector3> truth;    // world, a vertex
  double elastic_energy_j = 0, kinetic_energy_j = 0;
};

class TissueTruth {
 public:
  TissueTruth(const Character& character, const TissueLayout& layout, const Recipe& recipe);
  ~TissueTruth();
  // At rest on the motion's pose at time 0.
  TruthFrame start(const Motion& motion);
  // To the next tick of rate_hz, in `substeps` backward Euler steps, sampling the motion at each.
  TruthFrame advance(double rate_hz, int substeps);
  const Cage& cage() const;
  std::vector<double> frequencies_hz(int count) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sinew::baker
