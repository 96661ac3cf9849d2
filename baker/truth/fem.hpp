// fem.hpp  Elastic bodies on tetrahedra: backward Euler by Newton, sparse Cholesky, Rayleigh damping.
#pragma once
#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "baker/import/character.hpp"

namespace sinew::baker {

enum class Elasticity { kLinear, kCorotational, kNeoHookean };  // stable neo-Hookean: Smith et al. 2018

struct FemMaterial {
  Elasticity elasticity = Elasticity::kNeoHookean;
  std::vector<double> young_pa;  // a tetrahedron, or one for all
  double poisson_ratio = 0.42;
  double density_kg_m3 = 1000;
  double rayleigh_mass_per_s = 0;  // alpha in C = alpha M + beta K
  double rayleigh_stiffness_s = 0; // beta
};

class Fem {
 public:
  Fem(std::vector<Vector3> rest, std::vector<std::array<int, 4>> tetrahedra, std::vector<bool> constrained, FemMaterial material);
  ~Fem();
  Fem(Fem&&) noexcept;

  Eigen::VectorXd positions, velocities;  // 3 a node; constrained entries are the caller's
  Eigen::VectorXd mass;                   // lumped, 1 a node

  // One backward Euler step to Newton residual `tolerance` (share of the force scale). `target` gives the constrained nodes' new positions (3 a node; others ignored);
  // `force` is added (3 a node). Returns the Newton iterations taken; throws std::runtime_error when it does not converge.
  int step(double dt_s, const Eigen::VectorXd& target, const Eigen::VectorXd& force, double tolerance = 1e-6);
  // Static equilibrium under `force`.
  int settle(const Eigen::VectorXd& force, double tolerance = 1e-8);

  Eigen::VectorXd elastic_force(const Eigen::VectorXd& positions) const;
  double elastic_energy() const;
  double kinetic_energy() const;
  std::vector<double> frequencies_hz(int count) const;  // lowest free modes about the rest pose

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sinew::baker
