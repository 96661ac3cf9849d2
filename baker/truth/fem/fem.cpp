// fem.cpp  Elastic bodies on tetrahedra: BDF2 over each separate body's component.
#include "baker/truth/fem/fem.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <string>

#include "baker/common/bad_input.hpp"
#include "baker/truth/fem/fem_component.hpp"
#include "baker/truth/numerics/disjoint_sets.hpp"
#include "baker/truth/numerics/modes.hpp"

namespace sinew::baker {
namespace {

using Tetrahedra = std::vector<std::array<int, 4>>;

[[noreturn]] void refuse(const std::string& what) { throw BadInput("fem: " + what); }

double rest_volume(const std::vector<Vector3>& rest, const std::array<int, 4>& t) {
  const auto at = [&](size_t a) { return rest[static_cast<size_t>(t[a])]; };
  return (at(1) - at(0)).dot((at(2) - at(0)).cross(at(3) - at(0))) / 6;
}

void check_mesh(const std::vector<Vector3>& rest, const Tetrahedra& tetrahedra,
                const std::vector<bool>& constrained) {
  if (constrained.size() != rest.size())
    refuse(std::to_string(constrained.size()) + " constraint flags for " + std::to_string(rest.size()) +
           " nodes: give one a node");
  for (size_t e = 0; e < tetrahedra.size(); ++e) {
    for (const int node : tetrahedra[e])
      if (node < 0 || static_cast<size_t>(node) >= rest.size())
        refuse("tetrahedron " + std::to_string(e) + " names node " + std::to_string(node) + " of " +
               std::to_string(rest.size()));
    if (!(rest_volume(rest, tetrahedra[e]) > 0))
      refuse("tetrahedron " + std::to_string(e) +
             " is flat or inverted at rest: order its corners for a positive volume");
  }
}

void check_share(const std::vector<double>& values, size_t tetrahedra, const char* name) {
  if (values.size() != 1 && values.size() != tetrahedra)
    refuse(std::to_string(values.size()) + " values of " + name + " for " + std::to_string(tetrahedra) +
           " tetrahedra: give one, or one each");
  for (size_t e = 0; e < values.size(); ++e)
    if (!(values[e] > 0) || !std::isfinite(values[e]))
      refuse(std::string(name) + " of tetrahedron " + std::to_string(e) + " is " + std::to_string(values[e]) +
             ": give a number above 0");
}

void check_material(const FemMaterial& m, size_t tetrahedra) {
  check_share(m.young_pa, tetrahedra, "young_pa");
  check_share(m.fill, tetrahedra, "fill");
  if (!(m.poisson_ratio >= 0 && m.poisson_ratio < 0.5))
    refuse("poisson_ratio is " + std::to_string(m.poisson_ratio) + ": give 0 or more, less than 0.5");
  if (!(m.density_kg_m3 > 0))
    refuse("density_kg_m3 is " + std::to_string(m.density_kg_m3) + ": give a number above 0");
  if (!(m.rayleigh_mass_per_s >= 0) || !(m.rayleigh_stiffness_s >= 0)) refuse("Rayleigh damping is below 0");
}

}  // namespace

struct Fem::Impl {
  Eigen::VectorXd unstressed;
  Elasticity elasticity;
  std::vector<bool> constrained;
  std::deque<FemComponent> components;
  Eigen::VectorXd
      relative_velocity;  // against the undisturbed motion, in its turning axes: the next step's first guess

  // What a step remembers for the next: where it began. dt_s 0: nothing.
  struct StepStart {
    double dt_s = 0;
    Eigen::VectorXd positions, velocities;
    Eigen::VectorXd displacement;                  // from the undisturbed motion, in axes that turn with it
    std::vector<std::vector<LaneStrain>> strains;  // a component's blocks, in each element's bound axes
  } last;

  template <typename Visit>  // visit(block)
  void each_block(const Visit& visit) const {
    for (const FemComponent& component : components)
      for (const ElementBlock& block : component.blocks()) visit(block);
  }
  StepStart start_of(const Eigen::VectorXd& x, const Eigen::VectorXd& v,
                     const UndisturbedMotion* motion) const;
  void follow(const Eigen::VectorXd& shape, double dt_s);
};

namespace {

struct Grouping {
  std::map<size_t, std::vector<int>> nodes, elements;  // by component root
};

Grouping group(const Tetrahedra& tetrahedra, const std::vector<bool>& constrained) {
  DisjointSets sets(constrained.size());
  const auto first_free = [&](const std::array<int, 4>& t) {
    return *std::find_if(t.begin(), t.end(), [&](int n) { return !constrained[static_cast<size_t>(n)]; });
  };
  const auto has_free = [&](const std::array<int, 4>& t) {
    return std::any_of(t.begin(), t.end(), [&](int n) { return !constrained[static_cast<size_t>(n)]; });
  };
  for (const auto& t : tetrahedra)
    for (const int node : t)
      if (!constrained[static_cast<size_t>(node)])
        sets.join(static_cast<size_t>(first_free(t)), static_cast<size_t>(node));
  Grouping groups;
  for (size_t e = 0; e < tetrahedra.size(); ++e) {
    if (has_free(tetrahedra[e]))
      groups.elements[sets.find(static_cast<size_t>(first_free(tetrahedra[e])))].push_back(
          static_cast<int>(e));
  }
  for (size_t i = 0; i < constrained.size(); ++i)
    if (!constrained[i]) groups.nodes[sets.find(i)].push_back(static_cast<int>(i));
  return groups;
}

Eigen::VectorXd lumped_mass(const std::vector<Vector3>& rest, const Tetrahedra& tetrahedra,
                            const FemMaterial& material) {
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(rest.size()));
  for (size_t e = 0; e < tetrahedra.size(); ++e) {
    const double fill = material.fill.size() == 1 ? material.fill[0] : material.fill[e];
    for (const int node : tetrahedra[e])
      mass[node] += rest_volume(rest, tetrahedra[e]) * fill * material.density_kg_m3 / 4;
  }
  return mass;
}

}  // namespace

Fem::Fem(std::vector<Vector3> rest, Tetrahedra tetrahedra, std::vector<bool> constrained,
         FemMaterial material)
    : impl_(std::make_unique<Impl>()) {
  check_mesh(rest, tetrahedra, constrained);
  check_material(material, tetrahedra.size());
  mass = lumped_mass(rest, tetrahedra, material);
  for (size_t i = 0; i < rest.size(); ++i)
    if (!constrained[i] && mass[static_cast<Eigen::Index>(i)] == 0)
      refuse("free node " + std::to_string(i) + " belongs to no tetrahedron: drop it or constrain it");
  Grouping groups = group(tetrahedra, constrained);
  for (auto& [root, nodes] : groups.nodes) {
    impl_->components.emplace_back(std::move(nodes),
                                   element_blocks(rest, tetrahedra, groups.elements[root], material),
                                   material.elasticity, mass);
    impl_->components.back().rayleigh_mass_per_s = material.rayleigh_mass_per_s;
    impl_->components.back().rayleigh_stiffness_s = material.rayleigh_stiffness_s;
  }
  impl_->elasticity = material.elasticity;
  impl_->constrained = std::move(constrained);
  impl_->unstressed = Eigen::Map<const Eigen::VectorXd>(rest.data()->data(), 3 * mass.size());
  reset(impl_->unstressed);
}

Fem::~Fem() = default;
Fem::Fem(Fem&&) noexcept = default;

void Fem::reset(const Eigen::VectorXd& at) {
  positions = at;
  velocities = impl_->relative_velocity = Eigen::VectorXd::Zero(at.size());
  impl_->last.dt_s = 0;
}

void Fem::reshape(const Eigen::VectorXd& unstressed) {
  impl_->last.dt_s = 0;
  impl_->unstressed = unstressed;
  for (FemComponent& component : impl_->components) component.reshape(unstressed);
}

void Fem::Impl::follow(const Eigen::VectorXd& shape, double dt_s) {
  constexpr double kFastest_rad_per_s = 60;  // ten turns a second: limbs are slower
  unstressed = shape;
  for (FemComponent& component : components) component.follow(shape, kFastest_rad_per_s * dt_s);
}

Fem::Impl::StepStart Fem::Impl::start_of(const Eigen::VectorXd& x, const Eigen::VectorXd& v,
                                         const UndisturbedMotion* motion) const {
  StepStart start{.dt_s = 0, .positions = x, .velocities = v, .displacement = x, .strains = {}};
  if (motion) start.displacement -= motion->before;
  start.strains.resize(components.size());
  for (size_t c = 0; c < components.size(); ++c)
    if (components[c].rayleigh_stiffness_s > 0)
      for (const ElementBlock& block : components[c].blocks())
        start.strains[c].push_back(
            turned(transposed(block.turn), strain(elasticity, deformation_gradient(block, x.data()))));
  return start;
}

namespace {

void turn_by(const std::vector<Eigen::Matrix3d>& turn, Eigen::VectorXd& v) {
  for (Eigen::Index i = 0; i < v.size(); i += 3)
    v.segment<3>(i) = (turn[static_cast<size_t>(i / 3)] * v.segment<3>(i)).eval();
}

// BDF2 with equal steps is backward Euler over two thirds of one, from the last state and a third of how it
// differs from the one before (Hairer and Wanner 1996, III.1); without a step before it is backward Euler.
struct Formula {
  double h_s, extrapolated;
};

Formula formula_of(double dt_s, double dt_before_s) {
  if (dt_s != dt_before_s) return {dt_s, 0};
  return {dt_s * 2 / 3, 1.0 / 3};
}

Eigen::VectorXd from(const Formula& f, const Eigen::VectorXd& last, const Eigen::VectorXd& before) {
  if (f.extrapolated == 0) return last;
  return last + f.extrapolated * (last - before);
}

// Turned back into the world's axes. Empty without viscosity.
std::vector<LaneStrain> from(const Formula& f, const std::vector<LaneStrain>& last,
                             const std::vector<LaneStrain>& before, const FemComponent& component) {
  std::vector<LaneStrain> out = last;
  for (size_t b = 0; b < out.size(); ++b) {
    for (size_t k = 0; k < 6 && f.extrapolated != 0; ++k)
      out[b][k] += f.extrapolated * (last[b][k] - before[b][k]);
    out[b] = turned(component.blocks()[b].turn, out[b]);
  }
  return out;
}

Potential step_potential(const FemComponent& component, double h_s, const Eigen::VectorXd& x,
                         const Eigen::VectorXd& v, const Eigen::VectorXd& carried_x) {
  Potential p;
  const double inertia = 1 / (h_s * h_s), drag = component.rayleigh_mass_per_s / h_s;
  p.inertia_per_s2 = inertia + drag;
  p.anchor = (inertia * (x + h_s * v) + drag * carried_x) / p.inertia_per_s2;
  p.viscosity = component.rayleigh_stiffness_s / h_s;
  return p;
}

}  // namespace

int Fem::step(double dt_s, const Eigen::VectorXd& target, const Eigen::VectorXd& force, double tolerance,
              const UndisturbedMotion* undisturbed) {
  if (!(dt_s > 0)) refuse("dt_s is " + std::to_string(dt_s) + ": give a number above 0");
  if (target.size() != positions.size() || force.size() != positions.size())
    refuse("target and force need 3 values for each of " + std::to_string(mass.size()) + " nodes");
  constexpr int kPatience = 6;
  Impl::StepStart start = impl_->start_of(positions, velocities, undisturbed), &last = impl_->last;
  const Formula formula = backward_euler ? Formula{dt_s, 0} : formula_of(dt_s, last.dt_s);
  last.dt_s = 0;  // until this step is over
  Eigen::VectorXd& relative = impl_->relative_velocity;
  Eigen::VectorXd along = start.displacement;
  if (undisturbed) {
    for (Eigen::VectorXd* v : {&start.displacement, &last.displacement, &relative})
      turn_by(undisturbed->turn, *v);
    along = undisturbed->after + start.displacement;
    impl_->follow(undisturbed->after, dt_s);
  } else {
    relative = velocities;
  }
  positions = along + dt_s * relative;
  for (Eigen::Index i = 0; i < mass.size(); ++i)
    if (impl_->constrained[static_cast<size_t>(i)]) positions.segment<3>(3 * i) = target.segment<3>(3 * i);
  const Eigen::VectorXd x = from(formula, start.positions, last.positions),
                        v = from(formula, start.velocities, last.velocities);
  Eigen::VectorXd carried = from(formula, start.displacement, last.displacement);
  if (undisturbed) carried += undisturbed->after;
  int most = 0;
  for (size_t c = 0; c < impl_->components.size(); ++c) {
    FemComponent& component = impl_->components[c];
    Potential p = step_potential(component, formula.h_s, x, v, carried);
    p.force = force;
    p.strain = from(formula, start.strains[c], formula.extrapolated == 0 ? start.strains[c] : last.strains[c],
                    component);
    most = std::max(most, component.minimize(p, tolerance, kPatience, positions));
  }
  velocities = (positions - x) / formula.h_s;
  relative = (positions - carried) / formula.h_s;
  last = std::move(start);
  last.dt_s = dt_s;
  return most;
}

int Fem::settle(const Eigen::VectorXd& force, double tolerance) {
  if (force.size() != positions.size())
    refuse("force needs 3 values for each of " + std::to_string(mass.size()) + " nodes");
  Potential p;
  p.anchor = positions;
  p.force = force;
  int most = 0;
  for (FemComponent& component : impl_->components) {
    if (!component.supported())
      refuse("a body without a constrained node has no static equilibrium: constrain some of its nodes");
    most = std::max(most, component.minimize(p, tolerance, 0, positions));
  }
  velocities.setZero();
  impl_->last.dt_s = 0;
  return most;
}

Eigen::VectorXd Fem::elastic_force(const Eigen::VectorXd& at) const {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(at.size());
  impl_->each_block([&](const ElementBlock& block) {
    add_gradient(block, stress(impl_->elasticity, block, deformation_gradient(block, at.data())),
                 gradient.data());
  });
  return -gradient;
}

double Fem::elastic_energy(const Eigen::VectorXd& at) const {
  double sum = 0;
  impl_->each_block([&](const ElementBlock& block) {
    sum += (block.volume * energy_density(impl_->elasticity, block, deformation_gradient(block, at.data())))
               .sum();
  });
  return sum;
}

double Fem::kinetic_energy() const {
  double sum = 0;
  for (Eigen::Index i = 0; i < mass.size(); ++i)
    sum += 0.5 * mass[i] * velocities.segment<3>(3 * i).squaredNorm();
  return sum;
}

std::vector<double> Fem::frequencies_hz(int count) const {
  std::vector<double> hz;
  for (FemComponent& component : impl_->components) {
    const Eigenmodes modes =
        lowest_modes(component.assemble(Potential{}, impl_->unstressed, false), component.free_mass(), count);
    for (const double value : modes.squared_rad_per_s) hz.push_back(std::sqrt(value) / (2 * M_PI));
  }
  std::sort(hz.begin(), hz.end());
  hz.resize(std::min(hz.size(), static_cast<size_t>(count)));
  return hz;
}

void Fem::damp(double ratio) { damp(std::vector<double>(impl_->components.size(), ratio)); }

void Fem::damp(const std::vector<double>& ratios) {
  constexpr double kStill = 1e-2;  // rad/s: a free body's rigid motions are not modes
  if (ratios.size() != impl_->components.size())
    refuse(std::to_string(ratios.size()) + " damping ratios for " + std::to_string(impl_->components.size()) +
           " bodies: give one a body");
  impl_->last.dt_s = 0;
  for (size_t c = 0; c < ratios.size(); ++c) {
    FemComponent& component = impl_->components[c];
    const double ratio = ratios[c];
    if (!(ratio >= 0)) refuse("the damping ratio is " + std::to_string(ratio) + ": give 0 or more");
    const Eigen::VectorXd squared =
        lowest_modes(component.assemble(Potential{}, impl_->unstressed, false), component.free_mass(), 7)
            .squared_rad_per_s;
    const double first = std::sqrt(
        *std::find_if(squared.begin(), squared.end() - 1, [](double w2) { return w2 > kStill * kStill; }));
    component.rayleigh_mass_per_s = 1.5 * ratio * first;  // ratio = alpha / (2 w) + beta w / 2 at w and 3 w
    component.rayleigh_stiffness_s = 0.5 * ratio / first;
  }
}

std::vector<FemLinear> Fem::linear() {
  std::vector<FemLinear> bodies;
  for (FemComponent& component : impl_->components)
    bodies.push_back({component.nodes(), component.assemble(Potential{}, impl_->unstressed, false),
                      component.free_mass(), component.rayleigh_mass_per_s, component.rayleigh_stiffness_s});
  return bodies;
}

int Fem::body_count() const { return static_cast<int>(impl_->components.size()); }

long Fem::factorizations() const {
  long sum = 0;
  for (const FemComponent& component : impl_->components) sum += component.factorizations();
  return sum;
}

}  // namespace sinew::baker
