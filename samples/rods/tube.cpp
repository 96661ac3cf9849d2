// tube.cpp  see tube.hpp.
#include "samples/rods/tube.hpp"

#include <cmath>

namespace sinew::sample {
namespace {

using Vector = Eigen::Vector3f;
using Turn = Eigen::Quaternionf;

Turn turn_of(const rods::SegmentPose& pose) {
  const float* q = pose.orientation;
  return Turn(q[3], q[0], q[1], q[2]).normalized();
}

// A place on the rod's middle line, with its frame and radius.
struct Station {
  Vector place, along;
  Turn turn;
  float radius;
};

class Tube {
 public:
  Tube(const Actor& actor, const Poses& poses, render::Mesh* mesh)
      : segments_(actor.segments), look_(actor.look), poses_(poses), mesh_(*mesh) {
    // A segment goes on from the one before it in the list if that is its parent.
    follower_.assign(segments_.size(), 0);
    for (uint32_t i = 1; i < segments_.size(); ++i) {
      if (segments_[i].parent == i - 1) follower_[i - 1] = i;
    }
  }

  void draw() {
    for (uint32_t i = 0; i < segments_.size(); ++i) {
      if (!follows(i)) begin(i);
      for (uint32_t k = 1; k <= look_.rings; ++k) {
        join_row(between(start_of(i), end_of(i), static_cast<float>(k) / static_cast<float>(look_.rings)));
      }
      if (follower_[i] == 0) round_off(end_of(i));
    }
  }

 private:
  bool follows(uint32_t i) const { return i > 0 && segments_[i].parent == i - 1; }

  Vector end(uint32_t i, float side) const {
    const Vector middle = Eigen::Vector3d(poses_[i].position_m).cast<float>();
    return middle + side * 0.5f * segments_[i].length_m * (turn_of(poses_[i]) * Vector::UnitZ());
  }

  Station start_of(uint32_t i) const {
    if (follows(i)) return meeting(i - 1, i);
    const Turn turn = turn_of(poses_[i]);
    return {end(i, -1), turn * Vector::UnitZ(), turn, segments_[i].radius_m};
  }
  Station end_of(uint32_t i) const {
    if (follower_[i] != 0) return meeting(i, follower_[i]);
    const Turn turn = turn_of(poses_[i]);
    return {end(i, 1), turn * Vector::UnitZ(), turn, segments_[i].radius_m};
  }
  Station meeting(uint32_t a, uint32_t b) const {
    const Turn turn = turn_of(poses_[a]).slerp(0.5f, turn_of(poses_[b]));
    return {0.5f * (end(a, 1) + end(b, -1)), turn * Vector::UnitZ(), turn,
            0.5f * (segments_[a].radius_m + segments_[b].radius_m)};
  }

  // Hermite's cubic through both places along both directions.
  static Station between(const Station& a, const Station& b, float t) {
    const float length = (b.place - a.place).norm(), u = 1 - t;
    const Vector place = (1 + 2 * t) * u * u * a.place + t * t * (3 - 2 * t) * b.place +
                         length * (t * u * u * a.along - t * t * u * b.along);
    return {place, (u * a.along + t * b.along).normalized(), a.turn.slerp(t, b.turn),
            u * a.radius + t * b.radius};
  }

  // A ring of vertices, whose normals lean along the rod; returns its first.
  uint32_t row(const Station& s, float lean = 0) {
    const auto first = static_cast<uint32_t>(mesh_.positions.size());
    const float slope = std::sqrt(1 - lean * lean);
    for (uint32_t j = 0; j < look_.sides; ++j) {
      const float angle = 6.2831853f * static_cast<float>(j) / static_cast<float>(look_.sides);
      const Vector out = s.turn * Vector(std::cos(angle), std::sin(angle), 0);
      mesh_.positions.push_back(s.place + s.radius * out);
      mesh_.normals.push_back(slope * out + lean * s.along);
      mesh_.colors.push_back(4 * j < look_.sides ? look_.stripe : look_.color);
    }
    return first;
  }

  void join_row(const Station& s, float lean = 0) {
    const uint32_t next = row(s, lean);
    for (uint32_t j = 0; j < look_.sides; ++j) {
      const uint32_t k = (j + 1) % look_.sides;
      mesh_.triangles.push_back({first_row_ + j, first_row_ + k, next + j});
      mesh_.triangles.push_back({first_row_ + k, next + k, next + j});
    }
    first_row_ = next;
  }

  // Half a ball's ring, this far towards its pole.
  static Station ring(const Station& s, float angle) {
    Station out = s;
    out.place += std::sin(angle) * s.radius * s.along;
    out.radius = std::cos(angle) * s.radius;
    return out;
  }

  // A branch begins inside its parent.
  void begin(uint32_t i) {
    const Station s = start_of(i);
    if (i > 0) {
      first_row_ = row(s);
      return;
    }
    first_row_ = row(ring(s, -1.35f), std::sin(-1.35f));
    close(s.place - s.radius * s.along, -s.along, true);
    for (const float angle : {-1.0f, -0.5f}) join_row(ring(s, angle), std::sin(angle));
    join_row(s);
  }

  void round_off(const Station& s) {
    for (const float angle : {0.5f, 1.0f, 1.35f}) join_row(ring(s, angle), std::sin(angle));
    close(s.place + s.radius * s.along, s.along, false);
  }

  // A fan over the last ring; its triangles turn like the tube's.
  void close(const Vector& tip, const Vector& normal, bool before) {
    const auto index = static_cast<uint32_t>(mesh_.positions.size());
    mesh_.positions.push_back(tip);
    mesh_.normals.push_back(normal);
    mesh_.colors.push_back(look_.color);
    for (uint32_t j = 0; j < look_.sides; ++j) {
      const uint32_t a = first_row_ + j, b = first_row_ + (j + 1) % look_.sides;
      mesh_.triangles.push_back(before ? std::array{b, a, index} : std::array{a, b, index});
    }
  }

  const Segments& segments_;
  const Look& look_;
  const Poses& poses_;
  render::Mesh& mesh_;
  std::vector<uint32_t> follower_;  // 0: none
  uint32_t first_row_ = 0;
};

// Two folded halves with a bent tip.
void add_leaf(const Vector& base, const Turn& turn, float length, const render::Rgb& color,
              render::Mesh* mesh) {
  const auto first = static_cast<uint32_t>(mesh->positions.size());
  const Vector shape[] = {{0, 0, 0},        {0.24f, 0.09f, 0.38f}, {-0.24f, 0.09f, 0.38f},
                          {0, 0, 0.45f},    {0.15f, 0.03f, 0.75f}, {-0.15f, 0.03f, 0.75f},
                          {0, -0.12f, 1.0f}};
  for (const Vector& p : shape) {
    mesh->positions.push_back(base + length * (turn * p));
    mesh->normals.push_back(turn * Vector(-0.5f * p.x(), 1, 0.2f).normalized());
    mesh->colors.push_back(p.x() == 0 ? render::Rgb(1.15f * color) : color);
  }
  for (const auto& [a, b, c] :
       {std::array<uint32_t, 3>{0, 3, 1}, {0, 2, 3}, {1, 3, 4}, {2, 5, 3}, {3, 6, 4}, {3, 5, 6}}) {
    mesh->triangles.push_back({first + a, first + b, first + c});
  }
}

// 0..1, of a leaf's number.
float scatter(uint32_t n, uint32_t salt) {
  uint32_t x = (n * 2654435761u) ^ (salt * 2246822519u);
  x = (x ^ (x >> 15)) * 2246822519u;
  x = (x ^ (x >> 13)) * 3266489917u;
  return static_cast<float>((x ^ (x >> 16)) >> 8) / 16777216.0f;
}

}  // namespace

void add_tube(const Actor& actor, const Poses& poses, render::Mesh* mesh) { Tube(actor, poses, mesh).draw(); }

void add_leaves(const Actor& actor, const Poses& poses, render::Mesh* mesh) {
  constexpr uint32_t kLeaves = 4;  // a segment
  const render::Rgb young(0.16f, 0.34f, 0.04f), old(0.05f, 0.17f, 0.03f);
  for (const uint32_t i : actor.leafy) {
    const Turn turn = turn_of(poses[i]);
    const Vector middle = Eigen::Vector3d(poses[i].position_m).cast<float>();
    for (uint32_t k = 0; k < kLeaves; ++k) {
      const uint32_t n = kLeaves * i + k;
      const float along = (static_cast<float>(k) + 0.5f) / kLeaves - 0.5f;
      const Turn leaf = turn * Turn(Eigen::AngleAxisf(2.4f * static_cast<float>(n), Vector::UnitZ())) *
                        Turn(Eigen::AngleAxisf(0.7f + 0.5f * scatter(n, 1), Vector::UnitX())) *
                        Turn(Eigen::AngleAxisf(2 * scatter(n, 2) - 1, Vector::UnitZ()));
      const Vector base = middle + along * actor.segments[i].length_m * (turn * Vector::UnitZ());
      const float mix = scatter(n, 3);
      add_leaf(base, leaf, 0.075f + 0.04f * scatter(n, 4), mix * young + (1 - mix) * old, mesh);
    }
  }
}

}  // namespace sinew::sample
