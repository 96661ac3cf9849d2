// fem_elements.hpp  Linear tetrahedra, eight at a time: energy, stress, force and stiffness.
//
// Materials: linear; corotational mu |F-R|^2 + lambda/2 tr(R^T F - I)^2; stable neo-Hookean (Smith, de Goes,
// Kim 2018, eq. 14 with the parameters of eq. 16, so that small strains obey Hooke's law). Viscosity is a
// quadratic well in strain about a target.
#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "baker/truth/fem/fem.hpp"

namespace sinew::baker {

inline constexpr int kLanes = 8;
using Lanes = Eigen::Array<double, kLanes, 1>;
using LaneMatrix = std::array<std::array<Lanes, 3>, 3>;
using LaneStrain = std::array<Lanes, 6>;  // xx yy zz xy yz zx

struct ElementBlock {
  std::array<std::array<int, 4>, kLanes> node;  // a short block repeats its last element with volume 0
  LaneMatrix bind_gradient;  // B, [a][j]: gradient of the shape function of corner a + 1, as bound
  LaneMatrix turn;           // R: how the unstressed shape has turned since
  LaneMatrix gradient;       // B R^T
  LaneMatrix offset;         // I - E(unstressed) B R^T
  Lanes volume, mu, lambda;  // Lame
};

// Blocks of the listed elements. Throws nothing: the caller has checked volumes and materials.
std::vector<ElementBlock> element_blocks(const std::vector<Vector3>& rest,
                                         const std::vector<std::array<int, 4>>& tetrahedra,
                                         const std::vector<int>& elements, const FemMaterial& material);

// Makes this shape s the unstressed one: with E(x) the edges of a tetrahedron,
//   F(x) = E(x) B R^T + (I - E(s) B R^T)
// and R the rotation nearest to E(s) B. Volume, mass and stiffness stay those of the bound shape, however s
// squeezes, draws or inverts the tetrahedron: only the axes turn.
void reshape(ElementBlock& block, const double* unstressed);
// The same, of a shape a little later: R follows by at most this angle. Where the nearest rotation jumps,
// by half a turn where two stretches of an inverted tetrahedron cross, a displaced one feels no jump.
void follow(ElementBlock& block, const double* unstressed, double most_rad);

LaneMatrix deformation_gradient(const ElementBlock& block, const double* positions);

// Green's strain; the linear material's is small strain. Neither sees a rotation that its material does not
// see.
LaneStrain strain(Elasticity elasticity, const LaneMatrix& f);
LaneStrain turned(const LaneMatrix& r, const LaneStrain& e);  // r e r^T
LaneMatrix transposed(const LaneMatrix& r);

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
