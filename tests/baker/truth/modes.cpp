// modes.cpp  Factors and modes of sparse matrices against dense methods.
#include "baker/truth/numerics/modes.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <random>

#include "baker/truth/numerics/sparse_cholesky.hpp"

using namespace sinew::baker;

namespace {

// Masses on a grid of springs, three directions each: a matrix as flesh has it, positive definite where
// `ground` is above 0, singular at 0.
Eigen::SparseMatrix<double> spring_grid(int side, double ground) {
  const int count = side * side * side;
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> stiffness(0.5, 2);
  std::vector<Eigen::Triplet<double>> entries;
  const auto add_spring = [&](int a, int b) {
    for (int axis = 0; axis < 3; ++axis) {
      const double k = stiffness(generator);
      entries.insert(entries.end(), {{3 * a + axis, 3 * a + axis, k},
                                     {3 * b + axis, 3 * b + axis, k},
                                     {3 * a + axis, 3 * b + axis, -k},
                                     {3 * b + axis, 3 * a + axis, -k}});
    }
  };
  for (int n = 0; n < count; ++n) {
    if (n % side + 1 < side) add_spring(n, n + 1);
    if (n / side % side + 1 < side) add_spring(n, n + side);
    if (n / side / side + 1 < side) add_spring(n, n + side * side);
    for (int axis = 0; axis < 3; ++axis) entries.emplace_back(3 * n + axis, 3 * n + axis, ground);
  }
  Eigen::SparseMatrix<double> matrix(3 * count, 3 * count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Eigen::VectorXd masses(Eigen::Index size) { return Eigen::VectorXd::LinSpaced(size, 0.5, 3); }

}  // namespace

TEST_CASE("a_matrix_that_is_not_positive_definite_has_no_factor") {
  Eigen::SparseMatrix<double> matrix = spring_grid(4, 0.01);
  SparseCholesky cholesky;
  cholesky.analyze(matrix);
  CHECK(cholesky.factor(matrix));
  Eigen::SparseMatrix<double> indefinite = matrix;
  indefinite.coeffRef(20, 20) = -1;
  CHECK_FALSE(cholesky.factor(indefinite));
  CHECK(cholesky.factor(matrix));  // and the layout still serves
  CHECK_THROWS_AS(lowest_modes(indefinite, masses(matrix.rows()), 3), std::runtime_error);
}

TEST_CASE("a_factor_solves_as_a_dense_one_does_and_with_the_same_bits_each_time") {
  const Eigen::SparseMatrix<double> matrix = spring_grid(6, 0.01);
  const Eigen::MatrixXd right = Eigen::MatrixXd::Random(matrix.rows(), 5);
  SparseCholesky cholesky, again;
  for (SparseCholesky* one : {&cholesky, &again}) one->analyze(matrix), one->factor(matrix);
  const Eigen::MatrixXd x = cholesky.solve(right);
  CHECK((matrix * x - right).norm() < 1e-11 * right.norm());  // rounding times a condition of about 1e3
  CHECK(again.solve(right) == x);
}

TEST_CASE("lanczos_modes_are_those_of_a_dense_solver") {
  const double ground = GENERATE(0.0, 0.1);  // 0: a free body, whose first three modes are rigid
  const Eigen::SparseMatrix<double> stiffness = spring_grid(6, ground);
  const Eigen::VectorXd mass = masses(stiffness.rows());
  const int count = GENERATE(1, 7, 33);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> dense{Eigen::MatrixXd(stiffness),
                                                                        Eigen::MatrixXd(mass.asDiagonal())};
  const Eigenmodes modes = lowest_modes(stiffness, mass, count);
  REQUIRE(modes.squared_rad_per_s.size() == count);
  for (int k = 0; k < count; ++k)
    CHECK(modes.squared_rad_per_s[k] == Approx(dense.eigenvalues()[k]).epsilon(1e-8).margin(1e-8));
  CHECK((modes.shape.transpose() * mass.asDiagonal() * modes.shape).isIdentity(1e-9));
  const Eigen::MatrixXd residual =
      stiffness * modes.shape - mass.asDiagonal() * modes.shape * modes.squared_rad_per_s.asDiagonal();
  CHECK(residual.norm() < 1e-4 * stiffness.norm() / std::sqrt(static_cast<double>(mass.size())));
}

TEST_CASE("a_matrix_smaller_than_the_modes_asked_for_has_as_many_as_rows") {
  const Eigen::SparseMatrix<double> stiffness = spring_grid(2, 0.1);
  const Eigenmodes modes = lowest_modes(stiffness, masses(stiffness.rows()), 40);
  CHECK(modes.squared_rad_per_s.size() == 24);
  CHECK(modes.shape.cols() == 24);
}
