// groom.cpp  Each lock is laid down from its root, a segment at a time, kept off the body.
#include "samples/hair/groom.hpp"

#include <cmath>

#include "tests/scenes/rod_through.hpp"

namespace sinew::sample {
namespace {

using Eigen::Vector3d;

const Vector3d kSkull(0, 1.64, 0.005);
constexpr double kFall = 0.35;       // of a segment's direction, what the one before leaves to gravity
constexpr double kClearRadii = 1.6;  // of the lock's axis from the skin

// Evenly over the skull's back and top (a spiral of golden angles), parted in the middle.
Vector3d root_direction(uint32_t strand, uint32_t count) {
  const double up = 1 - 1.15 * (strand + 0.5) / count, around = 2.399963 * strand;
  const double flat = std::sqrt(1 - up * up);
  const Vector3d out(flat * std::cos(around), up, flat * std::sin(around));
  // Off the face: what looks forward below the hairline is turned to the back.
  return out.z() > 0.55 * up + 0.1 ? Vector3d(out.x(), out.y(), -out.z()) : out;
}

Vector3d kept_off(const Bust& bust, Vector3d point, double clear_m) {
  for (int i = 0; i < 4; ++i) {
    const baker::FieldSample here = bust.field.sample(point);
    if (here.distance < clear_m) point += (clear_m - here.distance) * here.gradient.normalized();
  }
  return point;
}

std::vector<Vector3d> lay_down(const Bust& bust, const HairStyle& style, const Vector3d& root) {
  const double step = style.length_m / style.segments,
               clear = kClearRadii * static_cast<double>(style.radius_m);
  const Vector3d out = bust.field.sample(root).gradient.normalized();
  const Vector3d aside(0.4 * (root.x() > 0 ? 1 : -1), 0, root.z() > 0 ? -0.3 : 0);
  std::vector<Vector3d> points = {root};
  Vector3d along = (0.8 * out + aside - 0.3 * Vector3d::UnitY()).normalized();
  for (uint32_t i = 0; i < style.segments; ++i) {
    along = ((1 - kFall) * along - kFall * Vector3d::UnitY()).normalized();
    const Vector3d next = kept_off(bust, points.back() + step * along, clear);
    along = (next - points.back()).normalized();
    points.push_back(points.back() + step * along);
  }
  return points;
}

}  // namespace

std::vector<std::vector<rods::SegmentDef>> groom(const Bust& bust, const HairStyle& style) {
  rods::SegmentDef like;
  like.radius_m = style.radius_m;
  like.density_kg_m3 = 600;
  like.young_modulus_pa = like.torsion_modulus_pa = 4e6f;
  like.damping_s = 0.02f;
  like.drag_per_s = 0.5f;
  std::vector<std::vector<rods::SegmentDef>> out;
  for (uint32_t s = 0; s < style.strands; ++s) {
    const Vector3d root = bust.field.project(kSkull + 0.095 * root_direction(s, style.strands));
    out.push_back(test::rod_through(lay_down(bust, style, root), like));
    out.back().front().fixed = true;
  }
  return out;
}

}  // namespace sinew::sample
