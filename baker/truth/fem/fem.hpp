// fem.hpp  Elastic bodies on tetrahedra: BDF2, sparse Cholesky, Rayleigh damping.
//
// Damping C = alpha M + beta K: the stiffness part is the rest stiffness, acting on the rate of Green's
// strain, so that no rotation is damped; the mass part acts on velocity. BDF2's own damping of a mode of
// w rad/s is a ratio of about (w dt)^3 / 4; the first step, and each of another length than the one before,
// is backward Euler.
// A body may be given the motion that it has when nothing disturbs it (a skinned character's). Its unstressed
// shape then follows that motion step by step, its stiffness turning with it, and damping acts on what
// departs from it.
#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <memory>
#include <vector>

#include "baker/import/character/character.hpp"

namespace sinew::baker {

enum class Elasticity { kLinear, kCorotational, kNeoHookean };  // stable neo-Hookean: Smith et al. 2018

struct FemMaterial {
  Elasticity elasticity = Elasticity::kNeoHookean;
  std::vector<double> young_pa = {1e5};  // a tetrahedron, or one for all; > 0
  double poisson_ratio = 0.42;           // 0 .. below 0.5
  double density_kg_m3 = 1000;           // > 0
  std::vector<double> fill = {1};        // share of matter in it, or one for all; scales its mass only
  double rayleigh_mass_per_s = 0;        // alpha, >= 0
  double rayleigh_stiffness_s = 0;       // beta, >= 0
};

// Where a body would be if nothing disturbed it, over one step. `before` is the last step's `after`, or what
// the body was reshaped to.
struct UndisturbedMotion {
  Eigen::VectorXd before, after;      // 3 a node, at the step's two ends
  std::vector<Eigen::Matrix3d> turn;  // a node: how its surroundings turn in between
};

// One separate body about its unstressed shape: M u'' + (alpha M + beta K) u' + K u = f over its free nodes.
struct FemLinear {
  std::vector<int> nodes;                 // free ones; row 3 i + axis below is node i's
  Eigen::SparseMatrix<double> stiffness;  // both triangles
  Eigen::VectorXd mass;                   // diagonal, 3 a node
  double rayleigh_mass_per_s = 0, rayleigh_stiffness_s = 0;
};

class Fem {
 public:
  // Throws BadInput: an index out of range, a flat or inverted tetrahedron, a free node in none, a material
  // out of its range.
  Fem(std::vector<Vector3> rest, std::vector<std::array<int, 4>> tetrahedra, std::vector<bool> constrained,
      FemMaterial material);
  ~Fem();
  Fem(Fem&&) noexcept;

  // 3 a node; constrained entries are the caller's. Whoever writes others between steps calls reset() first.
  Eigen::VectorXd positions, velocities;
  Eigen::VectorXd mass;         // lumped, 1 a node
  bool backward_euler = false;  // every step, as published emulators' data has it

  // At rest at these positions; forgets the past.
  void reset(const Eigen::VectorXd& at);
  // These positions become the unstressed shape; mass and stiffness stay (fem_elements.hpp).
  void reshape(const Eigen::VectorXd& unstressed);

  // One step until the gradient of the step's potential is below `tolerance` times the weight
  // and `force` of each separate body. `target` gives the constrained nodes' new positions (3 a node; others
  // ignored); `force` is added (3 a node). Returns the iterations taken, the most of any body; throws
  // std::runtime_error when it does not converge.
  int step(double dt_s, const Eigen::VectorXd& target, const Eigen::VectorXd& force, double tolerance = 1e-6,
           const UndisturbedMotion* undisturbed = nullptr);
  // Static equilibrium under `force`.
  int settle(const Eigen::VectorXd& force, double tolerance = 1e-8);

  // Sets alpha and beta of each separate body so that its first mode and three times that frequency are
  // damped by this ratio.
  void damp(double ratio);
  void damp(const std::vector<double>& ratios);  // one a separate body, in the order of linear()

  // Of the tetrahedra around free nodes; force: 3 a node, constrained ones too.
  Eigen::VectorXd elastic_force(const Eigen::VectorXd& at) const;
  double elastic_energy(const Eigen::VectorXd& at) const;
  double elastic_energy() const { return elastic_energy(positions); }
  double kinetic_energy() const;
  std::vector<double> frequencies_hz(int count) const;  // lowest free modes about the unstressed shape
  std::vector<FemLinear> linear();                      // one a separate body
  int body_count() const;                               // separate sets of free nodes
  long factorizations() const;                          // since the start

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sinew::baker
