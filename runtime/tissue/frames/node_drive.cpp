// node_drive.cpp  Differences of the last three ticks, turned into each node's frame.
#include "tissue/frames/node_drive.hpp"

#include <cmath>

namespace sinew::tissue {
namespace {

constexpr float kGravity = 9.80665f;  // m/s^2, along -Y

struct Vector {
  float x, y, z;
};

Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vector operator*(float s, const Vector& v) { return {s * v.x, s * v.y, s * v.z}; }
Vector vector_at(const float* v) { return {v[0], v[1], v[2]}; }
Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

void put(const Vector& v, float*& out) {
  *out++ = v.x;
  *out++ = v.y;
  *out++ = v.z;
}

// R^T v, rows of R weighted by v.
Vector into_axes(const NodePose& pose, const Vector& v) {
  const float* r = pose.rotation;
  return {r[0] * v.x + r[3] * v.y + r[6] * v.z, r[1] * v.x + r[4] * v.y + r[7] * v.z,
          r[2] * v.x + r[5] * v.y + r[8] * v.z};
}

// exp([bend]x) v by series, exact to float for the bends there are (tissue/frames/node_bend.hpp).
Vector turned(const float* bend, const Vector& v) {
  const Vector b = vector_at(bend);
  const float squared = b.x * b.x + b.y * b.y + b.z * b.z;
  const float sine = 1 - squared * (1.0f / 6 - squared * (1.0f / 120 - squared / 5040));
  const float cosine = 0.5f - squared * (1.0f / 24 - squared * (1.0f / 720 - squared / 40320));
  const Vector once = cross(b, v), twice = cross(b, once);
  return {v.x + sine * once.x + cosine * twice.x, v.y + sine * once.y + cosine * twice.y,
          v.z + sine * once.z + cosine * twice.z};
}

// Second difference of the root's place, by a fraction of a tick: in double first, since places may be
// millions of metres from the origin.
Vector root_step_change(const NodeMotion& motion, double fraction = 1) {
  float change[3];
  for (int k = 0; k < 3; ++k) {
    const double step = motion.root_position_m[0][k] - motion.root_position_m[1][k];
    const double before = motion.root_position_m[1][k] - motion.root_position_m[2][k];
    change[k] = static_cast<float>(step - fraction * before);
  }
  return vector_at(change);
}

// vee((A - A^T) / 2) of A = B^T R: half the sum of cross products of the rows of B and of R.
Vector turn_a_tick(const NodePose& before, const NodePose& now) {
  Vector sum{0, 0, 0};
  for (int row = 0; row < 3; ++row) {
    const Vector b = vector_at(before.rotation + 3 * row), r = vector_at(now.rotation + 3 * row);
    sum.x += b.z * r.y - b.y * r.z;
    sum.y += b.x * r.z - b.z * r.x;
    sum.z += b.y * r.x - b.x * r.y;
  }
  return 0.5f * sum;
}

// The acceleration by the sum of two changes a tick; `whole` times as much where they are those of a
// fraction.
Vector felt(float rate2, const Vector& node, const Vector& root, float most_m_s2, float whole = 1) {
  const Vector all{rate2 * (node.x + root.x), rate2 * (node.y + root.y), rate2 * (node.z + root.z)};
  const float squared = all.x * all.x + all.y * all.y + all.z * all.z, free = most_m_s2 / (2 * whole);
  if (squared <= free * free) return all;
  return felt_share(whole * std::sqrt(squared), most_m_s2) * all;
}

// Of what pulls at a fraction, b and b - s of tissue/frames/fraction_step.hpp.
struct LoadShares {
  float now, before;
};
LoadShares load_shares(float x) {
  const float before = (1 - x) * (1 - x);
  return {before + x * (1 + x) / 2, before};
}

void add(const Vector& v, float* to) {
  to[0] += v.x;
  to[1] += v.y;
  to[2] += v.z;
}

Vector gravity_change(const NodePose& pose) {
  const Vector gravity{0, -kGravity, 0};
  return into_axes(pose, gravity) - turned(pose.bend, gravity);
}

}  // namespace

float felt_share(float acceleration_m_s2, float most_m_s2) noexcept {
  const float free = most_m_s2 / 2;
  if (!(acceleration_m_s2 > free)) return 1;
  return free * (1 + std::tanh(acceleration_m_s2 / free - 1)) / acceleration_m_s2;
}

void compute_node_drive(const NodeMotion& motion, float tick_s, uint32_t count, float* out) noexcept {
  const Vector root = root_step_change(motion);
  const float rate = 1 / tick_s, rate2 = rate * rate;
  for (uint32_t i = 0; i < count; ++i) {
    const NodePose &now = motion.pose[0][i], &before = motion.pose[1][i], &before2 = motion.pose[2][i];
    const Vector step = vector_at(now.place_m) - vector_at(before.place_m);
    const Vector step_before = vector_at(before.place_m) - vector_at(before2.place_m);
    const float rate2_own = motion.size ? rate2 / motion.size[i] : rate2;
    const Vector change = felt(rate2_own, step - step_before, root, motion.most_m_s2);
    const Vector push{-change.x, -change.y - kGravity, -change.z};
    const Vector gravity{0, -kGravity, 0}, bound = turned(now.bend, gravity);
    const Vector omega = rate * turn_a_tick(before, now), omega_before = rate * turn_a_tick(before2, before);
    put(into_axes(now, push) - bound, out);
    put(into_axes(now, gravity) - bound, out);
    put(omega, out);
    put(rate * (omega - omega_before), out);
    put(vector_at(now.bend), out);
  }
}

void fraction_felt(const NodeMotion& motion, float tick_s, float x, uint32_t count, float* out) noexcept {
  const Vector root = root_step_change(motion, static_cast<double>(x));
  const float rate2 = 1 / (tick_s * tick_s), whole = 2 / (x * (1 + x));
  const auto [of_now, of_before] = load_shares(x);
  for (uint32_t i = 0; i < count; ++i) {
    const NodePose &now = motion.pose[0][i], &before = motion.pose[1][i], &before2 = motion.pose[2][i];
    const Vector step = vector_at(now.place_m) - vector_at(before.place_m);
    const Vector step_before = x * (vector_at(before.place_m) - vector_at(before2.place_m));
    const float rate2_own = motion.size ? rate2 / motion.size[i] : rate2;
    const Vector change = felt(rate2_own, step - step_before, root, motion.most_m_s2, whole);
    put(of_now * gravity_change(now) - of_before * gravity_change(before) - into_axes(now, change), out);
  }
}

void add_pull(const NodePose* now, const float* pull_m_s2, uint32_t count, float* drive) noexcept {
  const Vector pull = vector_at(pull_m_s2);
  for (uint32_t i = 0; i < count; ++i, drive += kNodeDriveWidth) {
    const Vector own = into_axes(now[i], pull);
    add(own, drive);
    add(own, drive + 3);
  }
}

void add_fraction_pull(const PulledNodes& nodes, const float* pull_m_s2, const float* pull_before_m_s2,
                       float x, float* felt) noexcept {
  const auto [of_now, of_before] = load_shares(x);
  const Vector pull = vector_at(pull_m_s2), before = vector_at(pull_before_m_s2);
  for (uint32_t i = 0; i < nodes.count; ++i, felt += 3)
    add(of_now * into_axes(nodes.now[i], pull) - of_before * into_axes(nodes.before[i], before), felt);
}

}  // namespace sinew::tissue
