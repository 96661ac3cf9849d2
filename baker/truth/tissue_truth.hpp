// tissue_truth.hpp  The ground truth of a skinned character's soft tissue.
//
// The posed, standing character is its own rest state: the unstressed shape of every tetrahedron is the
// skinned one, and the force on a node is f_el(x) + m (g - R_skin g), R_skin the rotation of its blended skin
// matrix, world from bind. Tissue so departs from the artist's pose only by inertia and by turning against
// gravity. Each tetrahedron keeps the stiffness of its bound shape, turned with the skinned one: to be
// stiffened, softened or stressed by skinning's own distortions, which squeeze flesh at a joint flat or
// inside out, would make it buckle. Free nodes start on the skinning. Damping acts on motion relative to the
// skinning: the mass part on the displacement's rate in axes that turn with R_skin, the stiffness part on
// strain's rate less the skinning's own. A body that moves rigidly is not damped against the world. Stable
// neo-Hookean tetrahedra; each separate body's first mode and three times it are damped by the recipe's
// ratio; BDF2's own is below 0.001 at 6 Hz and 240 steps a second. A vertex is displaced by what the cage's
// nodes around it are: x = x_skinned + sum w u. The rigid surface is exactly the skinning.
#pragma once
#include <memory>

#include "baker/truth/cage/cage.hpp"
#include "baker/truth/modes/modal_basis.hpp"
#include "baker/truth/motion/motion.hpp"

namespace sinew::baker {

struct TruthFrame {
  WorldPose pose;
  std::vector<Vector3> skinned;  // world, a vertex
  std::vector<Vector3> truth;    // world, a vertex
  double elastic_energy_j = 0;   // of the tetrahedra around free nodes, above the skinned shape
  double kinetic_energy_j = 0;   // of the free nodes, in the world
};

class TissueTruth {
 public:
  // Throws BadInput when nothing is free to move.
  TissueTruth(const Character& character, const TissueLayout& layout, const Recipe& recipe);
  ~TissueTruth();
  // On the skinning of the motion's pose at time 0, at rest.
  TruthFrame start(const Motion& motion, const Vector3& gravity_m_s2 = {0, -9.80665, 0});
  // To the next tick of rate_hz, in `substeps` steps, sampling the motion at each. Throws
  // std::runtime_error when a step does not converge.
  TruthFrame advance(double rate_hz, int substeps);
  const Cage& cage() const;
  std::vector<double> frequencies_hz(int count) const;
  // A basis a region of the layout, about the shape that was last simulated: the bind pose before start().
  // finest: see modal_basis.hpp.
  std::vector<ModalBasis> modal_bases(const TissueLayout& layout, int count,
                                      const TissueLayout* finest = nullptr);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// A tick's substeps where nobody asks for others: 80 steps in a period of the first mode of the region that
// swings fastest, 240 to 480 a second. Against 64 substeps they leave up to 0.035 of the mean displacement.
int usual_substeps(const std::vector<ModalBasis>& modes, double rate_hz);

}  // namespace sinew::baker
