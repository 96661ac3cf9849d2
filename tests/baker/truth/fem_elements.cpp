// fem_elements.cpp  Forces are the energy's gradient, stiffness is the forces' gradient, rotations cost
// nothing.
#include "baker/truth/fem/fem_elements.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

#include "baker/truth/fem/fem_component.hpp"
#include "tests/baker/truth/bodies.hpp"

using namespace sinew::baker;
using sinew::test::box_body;

namespace {

constexpr double kStep = 1e-6;  // of a body of about a metre: the best of central differences in double
constexpr double kDifferenced = 1e-6;  // what they then resolve, as a share
constexpr double kRounding = 1e-11;

struct Sheared {
  sinew::test::Body body = box_body({2, 1, 1}, 0.4);
  FemMaterial material;
  Eigen::VectorXd x = body.flat();
  Eigen::VectorXd mass = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(body.nodes.size()));

  Sheared(double amount) {
    std::mt19937 generator(7);
    for (double& value : x) value += amount * (static_cast<double>(generator()) / 4294967296.0 - 0.5);
    material.young_pa = {1e4};
    material.poisson_ratio = 0.4;
  }
  FemComponent component(Elasticity elasticity) const {
    std::vector<int> elements(body.tetrahedra.size()), nodes(body.nodes.size());
    for (size_t i = 0; i < elements.size(); ++i) elements[i] = static_cast<int>(i);
    for (size_t i = 0; i < nodes.size(); ++i) nodes[i] = static_cast<int>(i);
    return FemComponent(nodes, element_blocks(body.nodes, body.tetrahedra, elements, material), elasticity,
                        mass);
  }
  // Inertia, damping and a force: every term of a step at once.
  Potential potential(const FemComponent& component, Elasticity elasticity) const {
    Potential p;
    p.inertia_per_s2 = 100;
    p.anchor = body.flat();
    p.force = Eigen::VectorXd::LinSpaced(x.size(), -3, 5);
    p.viscosity = 0.7;
    for (const ElementBlock& block : component.blocks())
      p.strain.push_back(strain(elasticity, deformation_gradient(block, p.anchor.data())));
    return p;
  }
};

const auto kEveryElasticity = {Elasticity::kLinear, Elasticity::kCorotational, Elasticity::kNeoHookean};

}  // namespace

TEST_CASE("gradient_is_the_slope_of_the_energy") {
  for (const Elasticity elasticity : kEveryElasticity) {
    const Sheared s(0.3);
    const FemComponent component = s.component(elasticity);
    const Potential p = s.potential(component, elasticity);
    const Eigen::VectorXd g = component.gradient(p, s.x);
    for (Eigen::Index i = 0; i < s.x.size(); ++i) {
      Eigen::VectorXd up = s.x, down = s.x;
      up[i] += kStep, down[i] -= kStep;
      const double slope = (component.energy(p, up) - component.energy(p, down)) / (2 * kStep);
      CHECK(std::abs(slope - g[i]) < kDifferenced * g.cwiseAbs().maxCoeff());
    }
  }
}

TEST_CASE("stiffness_is_the_slope_of_the_gradient") {
  for (const Elasticity elasticity : kEveryElasticity) {
    const Sheared s(0.3);
    FemComponent component = s.component(elasticity);
    const Potential p = s.potential(component, elasticity);
    const Eigen::MatrixXd k = component.assemble(p, s.x, false);
    for (Eigen::Index i = 0; i < s.x.size(); ++i) {
      Eigen::VectorXd up = s.x, down = s.x;
      up[i] += kStep, down[i] -= kStep;
      const Eigen::VectorXd slope = (component.gradient(p, up) - component.gradient(p, down)) / (2 * kStep);
      CHECK((slope - k.col(i)).cwiseAbs().maxCoeff() < kDifferenced * k.cwiseAbs().maxCoeff());
    }
  }
}

TEST_CASE("materials_agree_with_hooke_for_small_strains") {
  const Sheared s(0);
  const auto rest_stiffness = [&](Elasticity elasticity) {
    FemComponent component = s.component(elasticity);
    return Eigen::MatrixXd(component.assemble(Potential{}, s.x, false));
  };
  const Eigen::MatrixXd hooke = rest_stiffness(Elasticity::kLinear);
  CHECK((rest_stiffness(Elasticity::kCorotational) - hooke).norm() < kRounding * hooke.norm());
  CHECK((rest_stiffness(Elasticity::kNeoHookean) - hooke).norm() < kRounding * hooke.norm());
}

TEST_CASE("projected_stiffness_has_no_negative_eigenvalue_even_inverted") {
  const Sheared s(1.5);  // several elements inside out
  FemComponent component = s.component(Elasticity::kNeoHookean);
  const auto lowest = [&](bool project) {
    const Eigen::MatrixXd k = component.assemble(Potential{}, s.x, project);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(k);
    return eigen.eigenvalues()[0] / eigen.eigenvalues()[k.rows() - 1];
  };
  CHECK(lowest(false) < -1e-3);  // the case is one where it matters
  CHECK(lowest(true) > -kRounding);
}

TEST_CASE("a_turned_body_has_the_same_energy_and_turned_forces") {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.1, Vector3(1, -2, 0.5).normalized()).toRotationMatrix();
  for (const Elasticity elasticity : {Elasticity::kCorotational, Elasticity::kNeoHookean}) {
    const Sheared s(0.3);
    const FemComponent component = s.component(elasticity);
    Potential p = s.potential(component, elasticity);
    p.inertia_per_s2 = 0;
    p.force.setZero();
    Eigen::VectorXd turned(s.x.size()), g = component.gradient(p, s.x);
    for (Eigen::Index i = 0; i < s.x.size(); i += 3) {
      turned.segment<3>(i) = turn * s.x.segment<3>(i) + Vector3(3, 4, 5);
      g.segment<3>(i) = (turn * g.segment<3>(i)).eval();
    }
    CHECK(component.energy(p, turned) == Approx(component.energy(p, s.x)).epsilon(kRounding));
    CHECK((component.gradient(p, turned) - g).norm() < kRounding * g.norm());
  }
}
