// convex.cpp  Closed forms, and Bullet's GJK and EPA for the rest.
#include "adapters/bullet/convex.hpp"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btConvexInternalShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>

#include <algorithm>
#include <limits>

namespace sinew::bullet {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Sine squared of a triangle's flattest angle: below float's resolution it has no normal.
constexpr double kFlat = 1e-12;
constexpr double kThin = 1e-6;    // share of its size: float's resolution
constexpr double kScaled = 1000;  // half the size of what GJK is asked
constexpr float kJitter = 0.02f;  // its resolution

Vector vector_of(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

// From a core without extent, thickened.
Distance from_core(const Vector& apart, double radius_m, const Vector& any) {
  const double d = rods::length(apart);
  return {d - radius_m, d > 0 ? rods::scaled(1 / d, apart) : any};
}

Distance from_box(const Vector& half, const Vector& p) {
  Vector out, normal = {};
  size_t nearest = 0;
  for (size_t k = 0; k < 3; ++k) {
    out[k] = std::fabs(p[k]) - half[k];
    if (out[k] > out[nearest]) nearest = k;
  }
  if (out[nearest] <= 0) {
    normal[nearest] = p[nearest] < 0 ? -1 : 1;
    return {out[nearest], normal};
  }
  for (size_t k = 0; k < 3; ++k) normal[k] = std::copysign(std::max(out[k], 0.0), p[k]);
  return from_core(normal, 0, {0, 1, 0});
}

Distance from_capsule(const Convex& c, Vector p) {
  p[c.axis] -= std::clamp(p[c.axis], -c.half_m, c.half_m);
  Vector any = {};
  any[(c.axis + 1) % 3] = 1;
  return from_core(p, c.radius_m, any);
}

Distance from_cylinder(const Convex& c, const Vector& p) {
  const size_t i = (c.axis + 1) % 3, j = (c.axis + 2) % 3;
  const double from_axis = std::sqrt(p[i] * p[i] + p[j] * p[j]);
  const double out[2] = {from_axis - c.radius_m, std::fabs(p[c.axis]) - c.half_m};
  Vector radial = {}, axial = {};
  radial[i] = from_axis > 0 ? p[i] / from_axis : 1;
  radial[j] = from_axis > 0 ? p[j] / from_axis : 0;
  axial[c.axis] = p[c.axis] < 0 ? -1 : 1;
  if (std::max(out[0], out[1]) <= 0)
    return out[0] > out[1] ? Distance{out[0], radial} : Distance{out[1], axial};
  const Vector apart =
      rods::sum(rods::scaled(std::max(out[0], 0.0), radial), rods::scaled(std::max(out[1], 0.0), axial));
  return from_core(apart, 0, axial);
}

// Ericson 2005, 5.1.5.
Vector nearest_on(const Triangle& t, const Vector& p) {
  const Vector &a = t.corners[0], &b = t.corners[1], &c = t.corners[2];
  const Vector ab = rods::difference(b, a), ac = rods::difference(c, a);
  const Vector ap = rods::difference(p, a), bp = rods::difference(p, b), cp = rods::difference(p, c);
  const double d1 = rods::dot(ab, ap), d2 = rods::dot(ac, ap), d3 = rods::dot(ab, bp), d4 = rods::dot(ac, bp),
               d5 = rods::dot(ab, cp), d6 = rods::dot(ac, cp);
  if (d1 <= 0 && d2 <= 0) return a;
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return rods::scaled_sum(d1 / (d1 - d3), ab, a);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return rods::scaled_sum(d2 / (d2 - d6), ac, a);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    return rods::scaled_sum((d4 - d3) / ((d4 - d3) + (d5 - d6)), rods::difference(c, b), b);
  }
  const double all = va + vb + vc;
  return rods::sum(a, rods::sum(rods::scaled(vb / all, ab), rods::scaled(vc / all, ac)));
}

Distance from_triangle(const Triangle& t, const Vector& p) {
  const Vector n = area(t);
  return from_core(rods::difference(p, nearest_on(t, p)), t.margin_m, rods::scaled(1 / rods::length(n), n));
}

// Bullet's GJK takes corners within a centimetre of each other for one: shapes are asked this much larger.
class Scaled final : public btConvexInternalShape {
 public:
  Scaled(const btConvexShape& shape, float scale) : shape_(shape), scale_(scale) {
    m_shapeType = CUSTOM_CONVEX_SHAPE_TYPE;
    setMargin(scale * shape.getMarginNonVirtual());
  }
  btVector3 localGetSupportingVertexWithoutMargin(const btVector3& way) const override {
    return scale_ * shape_.localGetSupportVertexWithoutMarginNonVirtual(way);
  }
  void batchedUnitVectorGetSupportingVertexWithoutMargin(const btVector3* ways, btVector3* out,
                                                         int count) const override {
    for (int i = 0; i < count; ++i) out[i] = localGetSupportingVertexWithoutMargin(ways[i]);
  }
  void calculateLocalInertia(btScalar, btVector3& inertia) const override { inertia.setZero(); }
  const char* getName() const override { return "scaled"; }

 private:
  const btConvexShape& shape_;
  float scale_;
};

// Where the point is so near to the surface without margin that GJK gives up, a neighbour of it is not; and
// a shape is nowhere nearer than its box.
Distance from_other(const Convex& c, const Vector& p) {
  const auto scale = static_cast<float>(kScaled / std::max({c.size[0], c.size[1], c.size[2]}));
  const Scaled shape(*c.other, scale);
  for (int k = 0; k < 4; ++k) {
    btGjkEpaSolver2::sResults found;
    btVector3 point(static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]));
    point *= scale;
    if (k > 0) point[k - 1] += kJitter;
    found.normal.setZero();
    const double d = btGjkEpaSolver2::SignedDistance(point, 0, &shape, btTransform::getIdentity(), found);
    const Vector n = vector_of(found.normal);
    if (std::isfinite(d) && std::fabs(rods::dot(n, n) - 1) < 1e-3) {
      return {d / static_cast<double>(scale), rods::scaled(1 / rods::length(n), n)};
    }
  }
  return from_box(c.size, rods::difference(p, c.middle));
}

// A shape without thickness, whichever way it lies: across the plane of any three points of it that are on no
// line there is nothing.
bool is_flat(const btConvexShape& shape) {
  const auto support = [&](const Vector& way) {
    return vector_of(shape.localGetSupportVertexWithoutMarginNonVirtual(
        {static_cast<float>(way[0]), static_cast<float>(way[1]), static_cast<float>(way[2])}));
  };
  const auto across = [&](const Vector& way) {
    return rods::difference(support(way), support(rods::scaled(-1, way)));
  };
  Vector longest = {};
  for (size_t k = 0; k < 3; ++k) {
    Vector way = {};
    way[k] = 1;
    const Vector d = across(way);
    if (rods::dot(d, d) > rods::dot(longest, longest)) longest = d;
  }
  const double size = rods::length(longest);
  if (!(size > 0)) return true;
  const Vector along = rods::scaled(1 / size, longest);
  size_t least = 0;
  for (size_t k = 1; k < 3; ++k)
    if (std::fabs(along[k]) < std::fabs(along[least])) least = k;
  Vector axis = {};
  axis[least] = 1;
  Vector sideways = rods::cross(along, axis);
  sideways = rods::scaled(1 / rods::length(sideways), sideways);
  Vector normal = rods::cross(along, across(sideways));
  if (!(rods::length(normal) > kThin * size)) {
    sideways = rods::cross(along, sideways);
    normal = rods::cross(along, across(sideways));
  }
  const double area = rods::length(normal);
  if (!(area > kThin * size)) return true;
  normal = rods::scaled(1 / area, normal);
  return !(std::fabs(rods::dot(normal, across(normal))) > kThin * size);
}

Convex by_gjk(const btConvexShape& shape) {
  Convex out = {.kind = Convex::kOther, .other = &shape};
  const bool empty = shape.getShapeType() == CONVEX_HULL_SHAPE_PROXYTYPE &&
                     static_cast<const btConvexHullShape&>(shape).getNumVertices() == 0;
  if (empty) return out;  // its box is nonsense
  if (!(shape.getMarginNonVirtual() > 0) && is_flat(shape)) return out;
  btVector3 low, high;
  shape.getAabb(btTransform::getIdentity(), low, high);
  out.middle = vector_of(0.5f * (low + high));
  out.size = vector_of(0.5f * (high - low));
  return out;
}

}  // namespace

bool Convex::has_volume() const noexcept {
  const bool has_radius = radius_m > 0 && std::isfinite(radius_m);
  switch (kind) {
    case kSphere:
      return has_radius;
    case kCapsule:
      return has_radius && std::isfinite(half_m);
    case kCylinder:
      return has_radius && half_m > 0 && std::isfinite(half_m);
    case kBox:
    case kOther:
      return std::min({size[0], size[1], size[2]}) > 0 && rods::finite(size);
    case kPlane:
      return std::fabs(rods::dot(size, size) - 1) < 1e-3 && std::isfinite(half_m);
    case kTriangle:
      return true;
  }
  return false;
}

double Convex::core_m() const noexcept {
  if (kind == kTriangle) return triangle.margin_m;
  return kind == kSphere || kind == kCapsule || kind == kCylinder ? radius_m : 0;
}

Convex convex_of(const btConvexShape& shape) noexcept {
  switch (shape.getShapeType()) {
    case SPHERE_SHAPE_PROXYTYPE:
      return {.kind = Convex::kSphere, .radius_m = static_cast<const btSphereShape&>(shape).getRadius()};
    case BOX_SHAPE_PROXYTYPE: {
      const auto& box = static_cast<const btBoxShape&>(shape);
      return {.kind = Convex::kBox, .size = vector_of(box.getHalfExtentsWithMargin())};
    }
    case CAPSULE_SHAPE_PROXYTYPE: {
      const auto& capsule = static_cast<const btCapsuleShape&>(shape);
      return {.kind = Convex::kCapsule,
              .axis = static_cast<size_t>(capsule.getUpAxis()),
              .radius_m = capsule.getRadius(),
              .half_m = capsule.getHalfHeight()};
    }
    case CYLINDER_SHAPE_PROXYTYPE: {
      const auto& cylinder = static_cast<const btCylinderShape&>(shape);
      const int axis = cylinder.getUpAxis();
      return {.kind = Convex::kCylinder,
              .axis = static_cast<size_t>(axis),
              .radius_m = cylinder.getRadius(),
              .half_m = cylinder.getHalfExtentsWithMargin()[axis]};
    }
    default:
      return by_gjk(shape);
  }
}

Convex convex_of(const btStaticPlaneShape& plane) noexcept {
  const Vector n = vector_of(plane.getPlaneNormal());
  const double size = rods::length(n);
  return {
      .kind = Convex::kPlane, .half_m = plane.getPlaneConstant() / size, .size = rods::scaled(1 / size, n)};
}

Distance distance(const Convex& c, const Vector& p) noexcept {
  switch (c.kind) {
    case Convex::kSphere:
      return from_core(p, c.radius_m, {0, 1, 0});
    case Convex::kBox:
      return from_box(c.size, p);
    case Convex::kCapsule:
      return from_capsule(c, p);
    case Convex::kCylinder:
      return from_cylinder(c, p);
    case Convex::kPlane:
      return {rods::dot(c.size, p) - c.half_m, c.size};
    case Convex::kTriangle:
      return from_triangle(c.triangle, p);
    case Convex::kOther:
      return from_other(c, p);
  }
  return {kInfinity, {0, 1, 0}};
}

Vector area(const Triangle& t) noexcept {
  return rods::cross(rods::difference(t.corners[1], t.corners[0]),
                     rods::difference(t.corners[2], t.corners[0]));
}

bool is_triangle(const Triangle& t) noexcept {
  const Vector n = area(t);
  double longest = 0;
  for (size_t k = 0; k < 3; ++k) {
    const Vector side = rods::difference(t.corners[(k + 1) % 3], t.corners[k]);
    longest = std::max(longest, rods::dot(side, side));
  }
  return rods::finite(n) && rods::dot(n, n) > kFlat * longest * longest;
}

}  // namespace sinew::bullet
