// fem_elements.hpp  Linear tetrahedra, eight at a time: energy, stress, force and stiffness.
//
// Materials: linear; corotational mu |F-R|^2 + lambda/2 tr(R^T F - I)^2; stable neo-Hookean (Smith, de Goes,
// Kim 2018, eq. 14 with the parameters of eq. 16, so that small strains obey Hooke's law). Viscosity is a
// quadratic well in strain about a target.
#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "baker/truth/fem.hpp"

namespace sinew::baker {

inline constexpr int kLanes = 8;
using Lanes = Eigen::Array<double, kLanes, 1>;
using LaneMatrix = std::array<std::array<Lanes, 3>, 3>;
using LaneStrain = std::array<Lanes, 6>;  // xx yy zz xy yz zx

struct ElementBlock {
  std::array<std::array<int, 4>, kLanes> node;  // a short block repeats its last element with volume 0
  LaneMatrix gradient;       // [a][j]: gradient of the shape function of corner a + 1 in the unstressed shape
  LaneMatrix bind_gradient;  // the same in the shape that gave volume and mass
  Lanes volume, mu, lambda;  // Lame
};

// Blocks of the listed elements. Throws nothing: the caller has checked volumes and materials.
std::vector<ElementBlock> element_blocks(const std::vector<Vector3>& rest,
                                         const std::vector<std::array<int, 4>>& tetrahedra,
                                         const std::vector<int>& elements, const FemMaterial& material);

// Makes this shape the unstressed one. Volume and mass stay. A tetrahedron that the shape squeezes below
// kLeastStretch of its bind size along some axis, turns inside out, or draws beyond kMostStretch is
// unstressed at that stretch only.
inline constexpr double kLeastStretch = 0.3, kMostStretch = 3;
void reshape(ElementBlock& block, const double* unstressed);

LaneMatrix deformation_gradient(const ElementBlock& block, const double* positions);

// Green's strain; the linear material's is small strain. Neither sees a rotation that its material does not
// see.
LaneStrain strain(Elasticity elasticity, const LaneMatrix& f);

Lanes energy_density(Elasticity elasticity, const ElementBlock& block, const LaneMatrix& f);
// First Piola-Kirchhoff.
LaneMatrix stress(Elasticity elasticity, const ElementBlock& block, const LaneMatrix& f);

// (viscosity / 2) (E - target) : C : (E - target): added to `p`; and its energy density.
void add_viscous_stress(Elasticity elasticity, const ElementBlock& block, const LaneMatrix& f,
                        double viscosity, const LaneStrain& target, LaneMatrix& p);
Lanes viscous_energy_density(Elasticity elasticity, const ElementBlock& block, const LaneMatrix& f,
                             double viscosity, const LaneStrain& target);

// gradient += V P g_a at each corner a, 3 a node.
void add_gradient(const ElementBlock& block, const LaneMatrix& p, double* gradient);

// One lane's 12x12 stiffness; viscosity 0: elastic only. `project`: negative eigenvalues of dP/dF are cut
// (Teran et al. 2005).
using ElementStiffness = Eigen::Matrix<double, 12, 12>;
ElementStiffness element_stiffness(Elasticity elasticity, const ElementBlock& block, int lane,
                                   const LaneMatrix& f, double viscosity, const LaneStrain* target,
                                   bool project);

}  // namespace sinew::baker
