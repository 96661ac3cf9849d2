// tissue_truth.cpp  The ground truth of a skinned character's soft tissue: the cage's moving part on the
// finite elements.
#include "baker/truth/tissue_truth.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "baker/common/bad_input.hpp"
#include "baker/truth/fem/fem.hpp"
#include "baker/truth/modes/body_parts.hpp"
#include "baker/truth/modes/moving_part.hpp"
#include "baker/truth/modes/region_frequency.hpp"
#include "baker/truth/numerics/polar.hpp"

namespace sinew::baker {
namespace {

constexpr double kTolerance =
    1e-5;  // of a body's weight: below a thousandth of a millimetre at the frequencies of flesh

}  // namespace

struct TissueTruth::Impl {
  Character character;
  Cage cage;
  MovingPart part;
  Fem fem;
  Motion motion;
  Vector3 gravity_m_s2 = Vector3::Zero();
  long ticks = 0;
  double time_s = 0;
  UndisturbedMotion skinned;
  std::vector<Eigen::Matrix3d> rotation;  // a node of the moving part, world from bind
  std::vector<double> intensity = std::vector<double>(character.positions.size(), 1);  // a vertex

  // Of each body, the mean of those of its regions by their free nodes; of one in no region the recipe's.
  std::vector<double> damping_ratios(const TissueLayout& layout, double otherwise) {
    std::vector<double> ratios;
    for (const FemLinear& body : fem.linear()) {
      double sum = 0, count = 0;
      for (const auto& [region, nodes] : split_by_region(body, layout, cage, part.cage_node)) {
        const auto weight = static_cast<double>(nodes.size());
        sum += weight * layout.regions[static_cast<size_t>(region)].damping_ratio;
        count += weight;
      }
      ratios.push_back(count > 0 ? sum / count : otherwise);
    }
    return ratios;
  }

  Impl(const Character& c, const TissueLayout& layout, const Recipe& recipe)
      : character(c),
        cage(with_frequencies(build_cage(c, layout, recipe), layout, recipe)),
        part(moving_part(cage, recipe)),
        fem(part.rest, part.tetrahedra, part.constrained, part.material) {
    fem.damp(damping_ratios(layout, recipe.damping_ratio));
    for (const Region& region : layout.regions)
      for (const int v : region.vertices) intensity[static_cast<size_t>(v)] = region.intensity;
    skinned.turn.resize(part.rest.size());
  }

  void skin_cage(const WorldPose& pose);
  void substep(double dt_s);
  TruthFrame frame() const;
};

TissueTruth::TissueTruth(const Character& character, const TissueLayout& layout, const Recipe& recipe)
    : impl_(std::make_unique<Impl>(character, layout, recipe)) {}
TissueTruth::~TissueTruth() = default;

// The moving part's nodes under the pose: their places and rotations become the newest.
void TissueTruth::Impl::skin_cage(const WorldPose& pose) {
  std::vector<Matrix4> matrix(pose.joints.size());
  for (size_t j = 0; j < matrix.size(); ++j)
    matrix[j] = pose.root * pose.joints[j] * character.inverse_bind[j];
  skinned.after.resize(3 * static_cast<Eigen::Index>(part.rest.size()));
  rotation.resize(part.rest.size());
  for (size_t i = 0; i < part.rest.size(); ++i) {
    const Influences& skin = cage.skin[static_cast<size_t>(part.cage_node[i])];
    Matrix4 blended = Matrix4::Zero();
    for (size_t k = 0; k < kInfluences; ++k)
      if (skin.weight[k] > 0) blended += skin.weight[k] * matrix[static_cast<size_t>(skin.joint[k])];
    skinned.after.segment<3>(3 * static_cast<Eigen::Index>(i)) =
        blended.block<3, 3>(0, 0) * part.rest[i] + blended.block<3, 1>(0, 3);
    rotation[i] = nearest_rotation(blended.block<3, 3>(0, 0));
  }
}

void TissueTruth::Impl::substep(double dt_s) {
  const std::vector<Eigen::Matrix3d> before = rotation;
  skinned.before = skinned.after;
  skin_cage(motion(time_s));
  Eigen::VectorXd force(skinned.after.size());
  for (size_t i = 0; i < rotation.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    skinned.turn[i] = rotation[i] * before[i].transpose();
    force.segment<3>(3 * at) = fem.mass[at] * (gravity_m_s2 - rotation[i] * gravity_m_s2);
  }
  fem.step(dt_s, skinned.after, force, kTolerance, &skinned);
}

TruthFrame TissueTruth::Impl::frame() const {
  TruthFrame frame;
  frame.pose = motion(time_s);
  frame.skinned = skin_positions(character, frame.pose.joints);
  for (Vector3& p : frame.skinned)
    p = frame.pose.root.block<3, 3>(0, 0) * p + frame.pose.root.block<3, 1>(0, 3);
  const Eigen::VectorXd displacement = fem.positions - skinned.after;
  frame.truth = frame.skinned;
  for (size_t v = 0; v < frame.truth.size(); ++v) {
    const Cage::Place& place = cage.surface[v];
    for (size_t a = 0; a < 4; ++a) {
      const int node =
          part.node_of_cage[static_cast<size_t>(cage.tetrahedra[static_cast<size_t>(place.tetrahedron)][a])];
      if (node >= 0) frame.truth[v] += intensity[v] * place.weight[a] * displacement.segment<3>(3 * node);
    }
  }
  frame.elastic_energy_j = fem.elastic_energy();
  for (size_t i = 0; i < part.rest.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (!part.constrained[i])
      frame.kinetic_energy_j += 0.5 * fem.mass[at] * fem.velocities.segment<3>(3 * at).squaredNorm();
  }
  return frame;
}

TruthFrame TissueTruth::start(const Motion& motion, const Vector3& gravity_m_s2) {
  impl_->motion = motion;
  impl_->gravity_m_s2 = gravity_m_s2;
  impl_->ticks = 0;
  impl_->time_s = 0;
  impl_->skin_cage(motion(0));
  impl_->fem.reshape(impl_->skinned.after);
  impl_->fem.reset(impl_->skinned.after);
  return impl_->frame();
}

TruthFrame TissueTruth::advance(double rate_hz, int substeps) {
  if (!impl_->motion) throw BadInput("truth: advance before start: start a motion first");
  if (!(rate_hz > 0) || substeps < 1)
    throw BadInput("truth: rate_hz " + std::to_string(rate_hz) + " and substeps " + std::to_string(substeps) +
                   ": give both above 0");
  const double dt_s = 1 / (rate_hz * substeps), from = static_cast<double>(impl_->ticks) / rate_hz;
  for (int s = 1; s <= substeps; ++s) {
    impl_->time_s = from + s * dt_s;
    impl_->substep(dt_s);
  }
  impl_->time_s = static_cast<double>(++impl_->ticks) / rate_hz;
  return impl_->frame();
}

const Cage& TissueTruth::cage() const { return impl_->cage; }
std::vector<ModalBasis> TissueTruth::modal_bases(const TissueLayout& layout, int count,
                                                 const TissueLayout* finest) {
  return sinew::baker::modal_bases(layout, impl_->cage, impl_->fem.linear(), impl_->part.cage_node, count,
                                   finest);
}
std::vector<double> TissueTruth::frequencies_hz(int count) const { return impl_->fem.frequencies_hz(count); }

int usual_substeps(const std::vector<ModalBasis>& modes, double rate_hz) {
  constexpr double kStepsAPeriod = 80, kFewest_hz = 240, kMost_hz = 480, kRounding = 1e-9;
  double fastest_hz = 0;
  for (const ModalBasis& basis : modes) fastest_hz = std::max(fastest_hz, basis.first_rad_per_s / (2 * M_PI));
  const double steps_hz = std::clamp(kStepsAPeriod * fastest_hz, kFewest_hz, kMost_hz);
  return std::max(1, static_cast<int>(std::ceil(steps_hz / rate_hz - kRounding)));
}

}  // namespace sinew::baker
