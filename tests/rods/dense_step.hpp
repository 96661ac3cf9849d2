// dense_step.hpp  One implicit Euler step of a tree of segments in double, its whole system solved at once.
//
// Shares only the constraints with the runtime: momentum and constraints of
// kernels/rods/rod_linearise-inl.hpp written as one Karush-Kuhn-Tucker matrix, iterated until nothing
// changes.
#pragma once
#include <Eigen/Dense>

#include "tests/rods/rod_scenes.hpp"

namespace sinew::test {

struct DenseSegment {
  Eigen::Vector3d position, velocity, spin;  // spin along own axes
  Eigen::Quaterniond turn;
};

class DenseRod {
 public:
  DenseRod(const RodBatch& batch, const Segments& segments, const Eigen::Vector3d& gravity,
           uint32_t strand = 0)
      : segments_(segments), gravity_(gravity) {
    for (uint32_t i = 0; i < segments.size(); ++i) {
      const rods::SegmentPose pose = batch.pose(strand, i);
      const rods::SegmentVelocity v = batch.velocity(strand, i);
      DenseSegment s;
      for (int k = 0; k < 3; ++k) {
        s.position[k] = pose.position_m[k];
        s.velocity[k] = static_cast<double>(v.linear_m_s[k]);
        s.spin[k] = static_cast<double>(v.angular_rad_s[k]);
      }
      const float* q = pose.orientation;
      s.turn = Eigen::Quaternionf(q[3], q[0], q[1], q[2]).cast<double>().normalized();
      s.spin = s.turn.conjugate() * s.spin;
      state_.push_back(s);
    }
    for (uint32_t i = 1; i < segments.size(); ++i) rest_.push_back(rest_of(i));
  }

  // Returns how many iterations it took; 200 if it did not converge.
  int step(double dt_s) {
    dt_ = dt_s;
    free_ = state_;
    for (uint32_t i = 0; i < segments_.size(); ++i) {
      if (!segments_[i].fixed) free_[i] = free_motion(i);
    }
    now_ = free_;
    force_ = Eigen::VectorXd::Zero(6 * joints());
    int iteration = 0;
    while (iteration < 200 && iterate() > 1e-12) ++iteration;
    return iteration;
  }
  const std::vector<DenseSegment>& now() const { return now_; }
  // What the step leaves, in the world; forces and moments as in SegmentStart.
  Eigen::Vector3d velocity(uint32_t i) const { return (now_[i].position - state_[i].position) / dt_; }
  Eigen::Vector3d spin(uint32_t i) const {
    const Eigen::Vector3d own =
        segments_[i].fixed ? Eigen::Vector3d(chord(state_[i].turn, now_[i].turn) / dt_)
                           : Eigen::Vector3d(free_[i].spin + chord(free_[i].turn, now_[i].turn) / dt_);
    return now_[i].turn * own;
  }
  Eigen::Vector3d force(uint32_t i) const { return force_.segment<3>(6 * (i - 1)) / (dt_ * dt_); }
  Eigen::Vector3d moment(uint32_t i) const { return force_.segment<3>(6 * (i - 1) + 3) / (dt_ * dt_); }

 private:
  Eigen::Index joints() const { return static_cast<Eigen::Index>(segments_.size()) - 1; }

  rods::JointEnd end(const std::vector<DenseSegment>& from, uint32_t i) const {
    const DenseSegment& s = from[i];
    return {{s.position[0], s.position[1], s.position[2]},
            {s.turn.x(), s.turn.y(), s.turn.z(), s.turn.w()},
            static_cast<double>(segments_[i].length_m)};
  }

  Eigen::Vector3d rest_of(uint32_t i) const {
    std::vector<DenseSegment> at_rest(segments_.size());
    for (const uint32_t k : {i, segments_[i].parent}) {
      const float* q = segments_[k].orientation;
      at_rest[k].turn = Eigen::Quaternionf(q[3], q[0], q[1], q[2]).cast<double>().normalized();
      at_rest[k].position.setZero();
    }
    Eigen::Vector3d out;
    rods::darboux(end(at_rest, segments_[i].parent), end(at_rest, i), out.data());
    return out;
  }

  // A free symmetric top, exactly: its axis and its spin turn about the angular momentum.
  DenseSegment free_motion(uint32_t i) const {
    DenseSegment s = state_[i];
    const rods::SegmentInertia inertia = rods::segment_inertia(segments_[i]);
    s.position += dt_ * s.velocity + dt_ * dt_ * gravity_;
    const double flat = inertia.axial_inertia_kg_m2 / inertia.inertia_kg_m2;
    const Eigen::Vector3d about(s.spin[0], s.spin[1], flat * s.spin[2]);
    const double own = (1 - flat) * s.spin[2];
    s.turn = s.turn * rotation(dt_ * about) * rotation({0, 0, dt_ * own});
    s.spin = rotation({0, 0, -dt_ * own}) * s.spin;
    return s;
  }

  static Eigen::Quaterniond rotation(const Eigen::Vector3d& v) {
    const double angle = v.norm();
    return angle == 0 ? Eigen::Quaterniond::Identity()
                      : Eigen::Quaterniond(Eigen::AngleAxisd(angle, v / angle));
  }

  static Eigen::Vector3d chord(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
    const Eigen::Quaterniond e = from.conjugate() * to;
    return (e.w() < 0 ? -2 : 2) * e.vec();
  }

  double iterate() {
    const Eigen::Index n = 6 * static_cast<Eigen::Index>(segments_.size()), c = 6 * joints();
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n + c, n + c);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(n + c);
    for (uint32_t i = 0; i < segments_.size(); ++i) add_mass(i, &matrix, &right);
    for (uint32_t i = 1; i < segments_.size(); ++i) add_joint(i, n, &matrix, &right);
    for (uint32_t i = 0; i < segments_.size(); ++i) {
      if (segments_[i].fixed) hold(i, &matrix, &right);
    }
    const Eigen::VectorXd change = matrix.partialPivLu().solve(right);
    double largest = 0;
    for (uint32_t i = 0; i < segments_.size(); ++i) largest = std::max(largest, move(i, change));
    force_ += change.tail(c);
    return largest;
  }

  void add_mass(uint32_t i, Eigen::MatrixXd* matrix, Eigen::VectorXd* right) const {
    const rods::SegmentInertia inertia = rods::segment_inertia(segments_[i]);
    const Eigen::Vector3d about(inertia.inertia_kg_m2, inertia.inertia_kg_m2, inertia.axial_inertia_kg_m2);
    const Eigen::Index at = 6 * static_cast<Eigen::Index>(i);
    matrix->diagonal().segment<3>(at).setConstant(inertia.mass_kg);
    matrix->diagonal().segment<3>(at + 3) = about;
    right->segment<3>(at) = -inertia.mass_kg * (now_[i].position - free_[i].position);
    right->segment<3>(at + 3) = -about.cwiseProduct(chord(free_[i].turn, now_[i].turn));
  }

  // J and J^T, the constraint, what its force does, and tension's stiffness on the matrix alone.
  void add_joint(uint32_t i, Eigen::Index n, Eigen::MatrixXd* matrix, Eigen::VectorXd* right) const {
    using Rows = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
    const uint32_t parent = segments_[i].parent;
    const rods::JointCompliance soft = rods::joint_compliance(segments_[parent], segments_[i]);
    const double t = static_cast<double>(segments_[i].damping_s), share = t / (dt_ + t);
    rods::Constraint stretch{}, bend{}, stretch_before{}, bend_before{};
    rods::stretch_shear(end(now_, parent), end(now_, i), &stretch);
    rods::bend_twist(end(now_, parent), end(now_, i), rest_[i - 1].data(), &bend);
    rods::bend_twist(end(state_, parent), end(state_, i), rest_[i - 1].data(), &bend_before);
    rods::stretch_shear(end(state_, parent), end(state_, i), &stretch_before);
    const Eigen::Index row = n + 6 * (static_cast<Eigen::Index>(i) - 1),
                       a = 6 * static_cast<Eigen::Index>(parent), b = 6 * static_cast<Eigen::Index>(i);
    Eigen::MatrixXd j = Eigen::MatrixXd::Zero(6, matrix->cols());
    j.block<3, 3>(0, a) = Rows(&stretch.by_parent_position[0][0]);
    j.block<3, 3>(0, a + 3) = Rows(&stretch.by_parent_rotation[0][0]);
    j.block<3, 3>(0, b) = Rows(&stretch.by_child_position[0][0]);
    j.block<3, 3>(0, b + 3) = Rows(&stretch.by_child_rotation[0][0]);
    j.block<3, 3>(3, a + 3) = Rows(&bend.by_parent_rotation[0][0]);
    j.block<3, 3>(3, b + 3) = Rows(&bend.by_child_rotation[0][0]);
    Eigen::Matrix<double, 6, 1> compliance, value;
    const double by_damping = 1 / (dt_ * (dt_ + t)), stiff = soft.stretch_m_n * by_damping;
    compliance << stiff, stiff, stiff, soft.bend_rad_nm * by_damping, soft.bend_rad_nm * by_damping,
        soft.twist_rad_nm * by_damping;
    for (int k = 0; k < 3; ++k) {
      value[k] = stretch.value[k] - (soft.stretch_m_n > 0 ? share * stretch_before.value[k] : 0);
      value[3 + k] = bend.value[k] - share * bend_before.value[k];
    }
    const Eigen::Matrix<double, 6, 1> force = force_.segment<6>(row - n);
    matrix->middleRows<6>(row) = j;
    matrix->middleCols<6>(row).topRows(n) = -j.leftCols(n).transpose();
    matrix->block<6, 6>(row, row).diagonal() = compliance;
    right->segment<6>(row) = -(value + compliance.cwiseProduct(force));
    right->head(n) += j.leftCols(n).transpose() * force;
    for (const uint32_t s : {parent, i}) {
      const double pull = force.head<3>().dot(now_[s].turn * Eigen::Vector3d::UnitZ());
      const double more = std::max(0.0, 0.5 * static_cast<double>(segments_[s].length_m) * pull);
      matrix->diagonal().segment<2>(6 * static_cast<Eigen::Index>(s) + 3).array() += more;
    }
  }

  static void hold(uint32_t i, Eigen::MatrixXd* matrix, Eigen::VectorXd* right) {
    const Eigen::Index at = 6 * static_cast<Eigen::Index>(i);
    matrix->middleRows<6>(at).setZero();
    matrix->block<6, 6>(at, at).setIdentity();
    right->segment<6>(at).setZero();
  }

  double move(uint32_t i, const Eigen::VectorXd& change) {
    const Eigen::Index at = 6 * static_cast<Eigen::Index>(i);
    now_[i].position += change.segment<3>(at);
    now_[i].turn = (now_[i].turn * rotation(change.segment<3>(at + 3))).normalized();
    return std::max(change.segment<3>(at).norm() / static_cast<double>(segments_[i].length_m),
                    change.segment<3>(at + 3).norm());
  }

  Segments segments_;
  Eigen::Vector3d gravity_;
  double dt_ = 0;
  std::vector<DenseSegment> state_, free_, now_;
  std::vector<Eigen::Vector3d> rest_;
  Eigen::VectorXd force_;
};

// The largest of each over a strand: of a segment's length, in radians, of what a step makes of speeds alike,
// of the strand's largest force or its weight, and of its largest moment or its weight over a segment.
struct DenseDifference {
  double place = 0, turn = 0, velocity = 0, spin = 0, force = 0, moment = 0;
};

inline Eigen::Vector3d dense_vector(const float (&v)[3]) { return Eigen::Vector3f(v).cast<double>(); }

inline DenseDifference difference(const RodBatch& batch, const DenseRod& dense, const Segments& segments,
                                  double dt_s, uint32_t strand = 0) {
  DenseDifference out;
  double weight = 0;
  for (const SegmentDef& s : segments) weight += 9.81 * rods::segment_inertia(s).mass_kg;
  double force = weight, moment = weight * static_cast<double>(segments[0].length_m);
  for (uint32_t i = 0; i < segments.size(); ++i) {
    const auto length = static_cast<double>(segments[i].length_m);
    const rods::SegmentPose pose = batch.pose(strand, i);
    const rods::SegmentVelocity v = batch.velocity(strand, i);
    const float* q = pose.orientation;
    const Eigen::Quaterniond turn = Eigen::Quaternionf(q[3], q[0], q[1], q[2]).cast<double>();
    const Eigen::Vector3d place(pose.position_m);
    out.place = std::max(out.place, (place - dense.now()[i].position).norm() / length);
    out.turn = std::max(out.turn, turn.angularDistance(dense.now()[i].turn));
    const Eigen::Vector3d slip = dense_vector(v.linear_m_s) - dense.velocity(i);
    out.velocity = std::max(out.velocity, slip.norm() * dt_s / length);
    out.spin = std::max(out.spin, (dense_vector(v.angular_rad_s) - dense.spin(i)).norm() * dt_s);
    if (i == 0 || (segments[i].fixed && segments[segments[i].parent].fixed)) continue;
    const rods::SegmentStart joint = batch.last_forces(strand, i);
    out.force = std::max(out.force, (dense_vector(joint.force_n) - dense.force(i)).norm());
    out.moment = std::max(out.moment, (dense_vector(joint.moment_nm) - dense.moment(i)).norm());
    force = std::max(force, dense.force(i).norm());
    moment = std::max(moment, dense.moment(i).norm());
  }
  out.force /= force;
  out.moment /= moment;
  return out;
}

}  // namespace sinew::test
