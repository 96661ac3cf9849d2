// fem_component.cpp  One connected set of free nodes: its elements, its equations, and the solver that keeps
// a factorisation.
#include "baker/truth/fem/fem_component.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "baker/truth/numerics/polar.hpp"
#include "baker/truth/numerics/quasi_newton.hpp"

namespace sinew::baker {
namespace {

constexpr int kMaxIterations = 200;
constexpr double kPoorContraction = 0.3;
constexpr double kStandardGravity = 9.80665;

}  // namespace

FemComponent::FemComponent(std::vector<int> free_nodes, std::vector<ElementBlock> blocks,
                           Elasticity elasticity, const Eigen::VectorXd& mass)
    : nodes_(std::move(free_nodes)), blocks_(std::move(blocks)), elasticity_(elasticity) {
  mass_.resize(3 * static_cast<Eigen::Index>(nodes_.size()));
  for (size_t i = 0; i < nodes_.size(); ++i)
    mass_.segment<3>(3 * static_cast<Eigen::Index>(i)).setConstant(mass[nodes_[i]]);
  scratch_ = Eigen::VectorXd::Zero(3 * mass.size());
  lay_out_matrix();
}

void FemComponent::lay_out_matrix() {
  std::vector<int> index(static_cast<size_t>(scratch_.size() / 3), -1);
  for (size_t i = 0; i < nodes_.size(); ++i) index[static_cast<size_t>(nodes_[i])] = static_cast<int>(i);
  std::vector<Eigen::Triplet<double>> pattern;
  const auto each_pair = [&](const auto& visit) {
    for (size_t e = 0; e < blocks_.size() * kLanes; ++e)
      for (size_t pair = 0; pair < 16; ++pair) {
        const auto& node = blocks_[e / kLanes].node[e % kLanes];
        visit(e, pair, index[static_cast<size_t>(node[pair / 4])],
              index[static_cast<size_t>(node[pair % 4])]);
      }
  };
  each_pair([&](size_t, size_t, int row, int column) {
    if (row < 0 || column < 0) supported_ = true;
    if (row < 0 || column < 0) return;
    for (int k = 0; k < 9; ++k) pattern.emplace_back(3 * row + k % 3, 3 * column + k / 3, 0.0);
  });
  matrix_.resize(mass_.size(), mass_.size());
  matrix_.setFromTriplets(pattern.begin(), pattern.end());
  slots_.assign(blocks_.size() * kLanes, {});
  each_pair([&](size_t e, size_t pair, int row, int column) {
    for (int c = 0; c < 3; ++c)
      slots_[e][3 * pair + static_cast<size_t>(c)] =
          row < 0 || column < 0
              ? -1
              : static_cast<int>(&matrix_.coeffRef(3 * row, 3 * column + c) - matrix_.valuePtr());
  });
}

Eigen::VectorXd FemComponent::gather(const Eigen::VectorXd& x) const {
  Eigen::VectorXd free(mass_.size());
  for (size_t i = 0; i < nodes_.size(); ++i)
    free.segment<3>(3 * static_cast<Eigen::Index>(i)) = x.segment<3>(3 * nodes_[i]);
  return free;
}

void FemComponent::scatter(const Eigen::VectorXd& free, Eigen::VectorXd& x) const {
  for (size_t i = 0; i < nodes_.size(); ++i)
    x.segment<3>(3 * nodes_[i]) = free.segment<3>(3 * static_cast<Eigen::Index>(i));
}

void FemComponent::reshape(const Eigen::VectorXd& unstressed) {
  for (ElementBlock& block : blocks_) sinew::baker::reshape(block, unstressed.data());
}

void FemComponent::follow(const Eigen::VectorXd& unstressed, double most_rad) {
  for (ElementBlock& block : blocks_) sinew::baker::follow(block, unstressed.data(), most_rad);
}

double FemComponent::energy(const Potential& potential, const Eigen::VectorXd& x) const {
  double sum = 0;
  for (size_t b = 0; b < blocks_.size(); ++b) {
    const LaneMatrix f = deformation_gradient(blocks_[b], x.data());
    Lanes density = energy_density(elasticity_, blocks_[b], f);
    if (potential.viscosity > 0)
      density += viscous_energy_density(elasticity_, blocks_[b], f, potential.viscosity, potential.strain[b]);
    sum += (blocks_[b].volume * density).sum();
  }
  for (size_t i = 0; i < nodes_.size(); ++i) {
    const Eigen::Index at = 3 * nodes_[i];
    const double k = mass_[3 * static_cast<Eigen::Index>(i)] * potential.inertia_per_s2;
    sum += 0.5 * k * (x.segment<3>(at) - potential.anchor.segment<3>(at)).squaredNorm();
    sum -= potential.force.segment<3>(at).dot(x.segment<3>(at));
  }
  return sum;
}

Eigen::VectorXd FemComponent::gradient(const Potential& potential, const Eigen::VectorXd& x) const {
  for (const int node : nodes_) {
    const Eigen::Index at = 3 * node;
    scratch_.segment<3>(at).setZero();
  }
  for (size_t b = 0; b < blocks_.size(); ++b) {
    const LaneMatrix f = deformation_gradient(blocks_[b], x.data());
    LaneMatrix p = stress(elasticity_, blocks_[b], f);
    if (potential.viscosity > 0)
      add_viscous_stress(elasticity_, blocks_[b], f, potential.viscosity, potential.strain[b], p);
    add_gradient(blocks_[b], p, scratch_.data());
  }
  Eigen::VectorXd g(mass_.size());
  for (size_t i = 0; i < nodes_.size(); ++i) {
    const Eigen::Index at = 3 * nodes_[i], to = 3 * static_cast<Eigen::Index>(i);
    const double k = mass_[to] * potential.inertia_per_s2;
    g.segment<3>(to) = scratch_.segment<3>(at) - potential.force.segment<3>(at);
    if (k > 0) g.segment<3>(to) += k * (x.segment<3>(at) - potential.anchor.segment<3>(at));
  }
  return g;
}

const Eigen::SparseMatrix<double>& FemComponent::assemble(const Potential& potential,
                                                          const Eigen::VectorXd& x, bool project) {
  double* values = matrix_.valuePtr();
  std::fill(values, values + matrix_.nonZeros(), 0.0);
  for (size_t b = 0; b < blocks_.size(); ++b) {
    const LaneMatrix f = deformation_gradient(blocks_[b], x.data());
    const LaneStrain* target = potential.strain.empty() ? nullptr : &potential.strain[b];
    for (size_t lane = 0; lane < kLanes && blocks_[b].volume[static_cast<int>(lane)] > 0; ++lane) {
      const ElementStiffness k = element_stiffness(elasticity_, blocks_[b], static_cast<int>(lane), f,
                                                   potential.viscosity, target, project);
      const auto& slot = slots_[b * kLanes + lane];
      for (int column = 0; column < 12; ++column)
        for (int a = 0; a < 4; ++a) {
          const int at = slot[static_cast<size_t>(3 * (4 * a + column / 3) + column % 3)];
          if (at >= 0) Eigen::Map<Vector3>(values + at) += k.block<3, 1>(3 * a, column);
        }
    }
  }
  for (int i = 0; i < mass_.size(); ++i) matrix_.coeffRef(i, i) += mass_[i] * potential.inertia_per_s2;
  return matrix_;
}

void FemComponent::factor(const Potential& potential, const Eigen::VectorXd& x) {
  if (factorizations_ == 0) cholesky_.analyze(matrix_);
  if (!cholesky_.factor(assemble(potential, x, false)) && !cholesky_.factor(assemble(potential, x, true)))
    throw std::runtime_error(
        "fem: the stiffness matrix is singular: no constrained node holds this body in place");
  factor_positions_ = gather(x);
  ++factorizations_;
  factor_inertia_ = potential.inertia_per_s2;
  factor_viscosity_ = potential.viscosity;
}

bool FemComponent::factored_for(const Potential& potential) const {
  return factor_inertia_ == potential.inertia_per_s2 && factor_viscosity_ == potential.viscosity;
}

FemComponent::Matrix3 FemComponent::turn_since_factor(const Eigen::VectorXd& x) const {
  if (elasticity_ == Elasticity::kLinear || nodes_.size() < 3) return Matrix3::Identity();
  const Eigen::VectorXd now = gather(x);
  const Eigen::Map<const Eigen::Matrix3Xd> a(now.data(), 3, now.size() / 3),
      b(factor_positions_.data(), 3, now.size() / 3);
  const Vector3 center_a = a.rowwise().mean(), center_b = b.rowwise().mean();
  return nearest_rotation_by_svd((a.colwise() - center_a) * (b.colwise() - center_b).transpose());
}

void FemComponent::solve_turned(const Matrix3& turn, Eigen::VectorXd& v) const {
  Eigen::Map<Eigen::Matrix3Xd> columns(v.data(), 3, v.size() / 3);
  columns = turn.transpose() * columns;
  v = cholesky_.solve(v);
  columns = turn * columns;
}

double FemComponent::force_scale(const Potential& potential) const {
  return kStandardGravity * mass_.norm() + gather(potential.force).norm();
}

// Backtracks along `direction` until the gradient shrinks or Armijo's condition holds; the share of the
// direction that was taken.
double FemComponent::search(const Potential& potential, const Eigen::VectorXd& start,
                            const Eigen::VectorXd& g, const Eigen::VectorXd& direction, Eigen::VectorXd& x,
                            Eigen::VectorXd& g_next) const {
  constexpr double kArmijo = 1e-4, kClearlySmaller = 0.9, kShortest = 1e-6;
  const double slope = g.dot(direction), size = g.norm();
  scatter(start, x);
  double before = std::nan("");
  for (double share = 1; share > kShortest; share *= 0.5) {
    if (std::isnan(before) && share < 1) {
      scatter(start, x);
      before = energy(potential, x);
    }
    scatter(start + share * direction, x);
    g_next = gradient(potential, x);
    if (g_next.norm() < kClearlySmaller * size) return share;
    if (share < 1 && energy(potential, x) <= before + kArmijo * share * slope) return share;
  }
  return 0;
}

int FemComponent::minimize(const Potential& potential, double tolerance, int patience, Eigen::VectorXd& x) {
  const double enough = tolerance * force_scale(potential);
  Eigen::VectorXd g = gradient(potential, x), g_next, free = gather(x);
  if (g.norm() <= enough) return 0;
  if (!factored_for(potential)) factor(potential, x);
  Matrix3 turn = turn_since_factor(x);
  QuasiNewtonMemory memory;
  int poor = 0;
  bool fresh = false;
  for (int iteration = 1; iteration <= kMaxIterations; ++iteration) {
    Eigen::VectorXd step = memory.direction(g, [&](Eigen::VectorXd& v) { solve_turned(turn, v); });
    const double share = step.dot(g) < 0 ? search(potential, free, g, step, x, g_next) : 0;
    if (share > 0) {
      step *= share;
      free += step;
      if (g_next.norm() <= enough) return iteration;
      poor += g_next.norm() > kPoorContraction * g.norm();
      memory.learn(std::move(step), g_next - g);
      g = g_next;
      fresh = false;
    }
    if (share == 0 && fresh) break;
    if (share == 0 || poor > patience) {
      scatter(free, x);
      factor(potential, x);
      turn.setIdentity();
      memory.clear();
      poor = 0;
      fresh = true;
    }
  }
  std::ostringstream what;
  what << "fem: no equilibrium of " << nodes_.size() << " free nodes after " << kMaxIterations
       << " iterations: residual " << g.norm() << " N, wanted " << enough
       << " N; take more substeps or loosen the tolerance";
  throw std::runtime_error(what.str());
}

}  // namespace sinew::baker
