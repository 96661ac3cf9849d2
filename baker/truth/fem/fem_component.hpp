// fem_component.hpp  One connected set of free nodes: its elements, its equations, and the solver that keeps
// a factorisation.
//
// An implicit step minimises the incremental potential (Ortiz and Stainier 1999)
//   sum m k/2 |x - anchor|^2 + W(x) + viscosity/2 (E(x) - strain):C:(E(x) - strain) - force.x
// by L-BFGS around the factor of the Hessian at some earlier state. The factor is kept while it serves,
// turned with the body (Procrustes): a body that only turned needs no new one. It decides speed alone;
// convergence is the true gradient's.
#pragma once
#include <Eigen/SparseCore>

#include "baker/truth/fem/fem_elements.hpp"
#include "baker/truth/numerics/sparse_cholesky.hpp"

namespace sinew::baker {

struct Potential {
  double inertia_per_s2 = 0;       // k: 0 in statics
  Eigen::VectorXd anchor, force;   // 3 a node of the whole body
  double viscosity = 0;            // beta / h
  std::vector<LaneStrain> strain;  // a block of this component; empty without viscosity
};

class FemComponent {
 public:
  FemComponent(std::vector<int> free_nodes, std::vector<ElementBlock> blocks, Elasticity elasticity,
               const Eigen::VectorXd& mass);

  const std::vector<int>& nodes() const { return nodes_; }
  const std::vector<ElementBlock>& blocks() const { return blocks_; }
  void reshape(const Eigen::VectorXd& unstressed);
  void follow(const Eigen::VectorXd& unstressed, double most_rad);
  bool supported() const { return supported_; }  // some element reaches a constrained node

  // Moves the free entries of x to the minimum; returns the iterations taken. `patience`: poor iterations
  // before a new factor. Throws std::runtime_error when it does not converge.
  int minimize(const Potential& potential, double tolerance, int patience, Eigen::VectorXd& x);

  double energy(const Potential& potential, const Eigen::VectorXd& x) const;
  Eigen::VectorXd gradient(const Potential& potential, const Eigen::VectorXd& x) const;  // 3 a free node
  // Free rows and columns; both triangles.
  const Eigen::SparseMatrix<double>& assemble(const Potential& potential, const Eigen::VectorXd& x,
                                              bool project);
  const Eigen::VectorXd& free_mass() const { return mass_; }  // 3 a free node

  long factorizations() const { return factorizations_; }

  double rayleigh_mass_per_s = 0, rayleigh_stiffness_s = 0;

 private:
  using Matrix3 = Eigen::Matrix3d;
  void lay_out_matrix();
  void factor(const Potential& potential, const Eigen::VectorXd& x);
  bool factored_for(const Potential& potential) const;
  void solve_turned(const Matrix3& turn, Eigen::VectorXd& v) const;
  Matrix3 turn_since_factor(const Eigen::VectorXd& x) const;
  double force_scale(const Potential& potential) const;
  double search(const Potential& potential, const Eigen::VectorXd& start, const Eigen::VectorXd& g,
                const Eigen::VectorXd& direction, Eigen::VectorXd& x, Eigen::VectorXd& g_next) const;
  Eigen::VectorXd gather(const Eigen::VectorXd& x) const;
  void scatter(const Eigen::VectorXd& free, Eigen::VectorXd& x) const;

  std::vector<int> nodes_;
  std::vector<ElementBlock> blocks_;
  Elasticity elasticity_;
  bool supported_ = false;
  Eigen::VectorXd mass_;
  Eigen::SparseMatrix<double> matrix_;
  std::vector<std::array<int, 48>>
      slots_;  // an element: first value of each of its 4x4 node blocks' 3 columns, or -1
  mutable Eigen::VectorXd scratch_;  // gradient of the whole body
  SparseCholesky cholesky_;
  Eigen::VectorXd factor_positions_;  // free nodes when it was made
  double factor_inertia_ = -1, factor_viscosity_ = -1;
  long factorizations_ = 0;
};

}  // namespace sinew::baker
