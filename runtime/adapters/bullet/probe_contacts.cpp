// probe_contacts.cpp  see probe_contacts.hpp.
#include "adapters/bullet/probe_contacts.hpp"

#include <BulletCollision/BroadphaseCollision/btDbvt.h>
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConvexShape.h>
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>

#include <algorithm>

namespace sinew::bullet {
namespace {

// Contacts are given for what comes this near, shares of the radius and of how much body and probe may near
// each other in the tick.
constexpr double kNearRadii = 0.25, kNearWay = 0.25;
// The same of an axis' ends, where another point of it is nearer.
constexpr double kEndRadii = 0.02;
// On a mesh: normals and places that are the same, places a share of the radius.
constexpr double kTouches = 0.05;  // gap at the moment it was found at, share of the radius
constexpr double kSameNormal = 0.999, kSamePlace = 0.05;

Vector vector_of(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

btVector3 bullet_vector(const Vector& v) {
  return {static_cast<btScalar>(v[0]), static_cast<btScalar>(v[1]), static_cast<btScalar>(v[2])};
}

uint32_t mixed(uint32_t a, uint32_t b) {
  const uint32_t h = (a ^ b) * 0x85ebca6bu;
  return h ^ h >> 15;
}

// The same from tick to tick: one of the axis' ends, or before or behind its nearest point.
uint32_t feature_of(double share, double nearest) {
  if (share == 0 || share == 1) return share == 0 ? 1 : 2;
  return share <= nearest ? 3 : 4;
}

void put(const Vector& from, float (&to)[3]) {
  for (size_t k = 0; k < 3; ++k) to[k] = static_cast<float>(from[k]);
}

}  // namespace

struct TriangleCollector final : btTriangleCallback {
  ProbeContacts& to;
  const Body& body;
  const ProbeContacts::Part& part;
  Vector up;
  double margin_m;

  TriangleCollector(ProbeContacts& contacts, const Body& of, const ProbeContacts::Part& in,
                    const Vector& solid, double margin)
      : to(contacts), body(of), part(in), up(solid), margin_m(margin) {}

  void processTriangle(btVector3* corners, int mesh_part, int index) override {
    const Triangle triangle = {{vector_of(corners[0]), vector_of(corners[1]), vector_of(corners[2])},
                               margin_m};
    const uint32_t number = mixed(static_cast<uint32_t>(mesh_part), static_cast<uint32_t>(index));
    to.add_triangle(body, part, triangle, up, number);
  }
};

void ProbeContacts::add(const Body& body, double closing_m) noexcept {
  closing_m_ = closing_m;
  add_shape(body, {kHere, 0}, *body.object->getCollisionShape());
}

double ProbeContacts::reach_m() const noexcept { return kNearRadii * path_.radius_m + kNearWay * closing_m_; }

double ProbeContacts::end_reach_m() const noexcept {
  return kEndRadii * path_.radius_m + kNearWay * closing_m_;
}

double ProbeContacts::length_m() const noexcept {
  return rods::length(rods::difference(path_.start[1], path_.start[0]));
}

// What the probe passes through of the part's own space. Between the moments looked at ends leave their chord
// by no more than arm (1 - cos(spin / 4)).
Box ProbeContacts::own_box(const Body& body, const Place& part) const noexcept {
  Box box = {{1e30, 1e30, 1e30}, {-1e30, -1e30, -1e30}};
  double arm = 0;
  for (const double time : {0.0, 0.5, 1.0}) {
    const Place place = body.motion.at(time, part);
    for (size_t k = 0; k < 2; ++k) {
      const Vector own = place.own_point(path_.at(time, k));
      arm = std::max(arm, rods::length(part.point(own)));
      box.widen(own);
    }
  }
  const double spin = rods::length(body.motion.spin_rad);
  box.grow(path_.radius_m + reach_m() + arm * spin * spin / 32);
  return box;
}

void ProbeContacts::add_shape(const Body& body, const Part& part, const btCollisionShape& shape) noexcept {
  const int type = shape.getShapeType();
  if (btBroadphaseProxy::isCompound(type)) {
    add_children(body, part, static_cast<const btCompoundShape&>(shape));
  } else if (btBroadphaseProxy::isConvex(type)) {
    add_convex(body, part, convex_of(static_cast<const btConvexShape&>(shape)));
  } else if (type == STATIC_PLANE_PROXYTYPE) {
    add_convex(body, part, convex_of(static_cast<const btStaticPlaneShape&>(shape)));
  } else if (type == TRIANGLE_MESH_SHAPE_PROXYTYPE || type == SCALED_TRIANGLE_MESH_SHAPE_PROXYTYPE ||
             type == MULTIMATERIAL_TRIANGLE_MESH_PROXYTYPE || type == TERRAIN_SHAPE_PROXYTYPE) {
    add_concave(body, part, static_cast<const btConcaveShape&>(shape));
  } else if (type != EMPTY_SHAPE_PROXYTYPE) {
    problems_.note(BulletProblem::kUnsupportedShape, *body.object, type);
  }
}

namespace {

// Bullet's own walks of this tree may allocate.
template <class Visit>
void visit_leaves(const btDbvtNode* node, const btDbvtVolume& volume, const Visit& visit) {
  if (!node || !Intersect(node->volume, volume)) return;
  if (node->isleaf()) return visit(node->dataAsInt);
  for (const btDbvtNode* child : node->childs) visit_leaves(child, volume, visit);
}

}  // namespace

void ProbeContacts::add_children(const Body& body, const Part& part, const btCompoundShape& shape) noexcept {
  const auto visit = [&](int i) {
    const Place child = place_of(shape.getChildTransform(i));
    if (!finite(child)) return;
    const uint32_t number = mixed(part.number, static_cast<uint32_t>(i) + 1);
    add_shape(body, {product(part.place, child), number}, *shape.getChildShape(i));
  };
  if (const btDbvt* tree = shape.getDynamicAabbTree(); tree && !body.lost_child) {
    const Box box = own_box(body, part.place);
    visit_leaves(tree->m_root, btDbvtVolume::FromMM(bullet_vector(box.low), bullet_vector(box.high)), visit);
  } else {
    for (int i = 0; i < shape.getNumChildShapes(); ++i) visit(i);
  }
}

void ProbeContacts::add_convex(const Body& body, const Part& part, const Convex& shape) noexcept {
  if (!shape.has_volume()) {
    const int type = body.object->getCollisionShape()->getShapeType();
    return problems_.note(BulletProblem::kZeroVolume, *body.object, type);
  }
  const double reach = reach_m();
  const Touch touch = first_touch(shape, part.place, body.motion, path_, closing_m_, reach);
  if (!(touch.near.distance.m - path_.radius_m <= reach)) return;
  const Axis axis = own_axis(path_, touch.time, body.motion.at(touch.time, part.place));
  Near points[4];
  const size_t count = supports(shape, axis, touch.near, path_.radius_m, end_reach_m(), points);
  const Axis ends = own_axis(path_, 1, body.motion.at(1, part.place));
  for (size_t i = 0; i < count; ++i) {
    const double at_end_m = distance(shape, ends.at(points[i].share)).m;
    add_contact(body, part, touch.time, points[i], at_end_m,
                {feature_of(points[i].share, touch.near.share), false, false});
  }
}

void ProbeContacts::add_concave(const Body& body, const Part& part, const btConcaveShape& shape) noexcept {
  Vector up = {};
  if (shape.getShapeType() == TERRAIN_SHAPE_PROXYTYPE) {
    up[static_cast<size_t>(static_cast<const btHeightfieldTerrainShape&>(shape).getUpAxis())] = 1;
  }
  TriangleCollector collector(*this, body, part, up, shape.getMargin());
  const Box box = own_box(body, part.place);
  const btVector3 margin(shape.getMargin(), shape.getMargin(), shape.getMargin());
  shape.processAllTriangles(&collector, bullet_vector(box.low) - margin, bullet_vector(box.high) + margin);
}

void ProbeContacts::add_triangle(const Body& body, const Part& part, const Triangle& t, const Vector& up,
                                 uint32_t number) noexcept {
  if (!is_triangle(t)) {
    const int type = body.object->getCollisionShape()->getShapeType();
    return problems_.note(BulletProblem::kDegenerateTriangle, *body.object, type);
  }
  const Vector n = area(t);
  const Axis begins = own_axis(path_, 0, body.motion.at(0, part.place));
  const bool solid = rods::dot(up, up) > 0;
  const double height = rods::dot(n, solid ? up : rods::difference(begins.at(0.5), t.corners[0]));
  const double side = height < 0 ? -1 : 1, reach = reach_m(), r = path_.radius_m;
  Near faces[2];
  Touch touch = {};
  const bool behind = solid && face_supports(t, side, begins, r, 0, faces) > 0;
  if (!behind) touch = first_touch(convex_of(t), part.place, body.motion, path_, closing_m_, reach);
  if (!behind && !(touch.near.distance.m - r <= reach)) return;
  const Axis axis = own_axis(path_, touch.time, body.motion.at(touch.time, part.place));
  const size_t count = face_supports(t, side, axis, r, reach, faces);
  const Part own = {part.place, mixed(part.number, number)};
  const Axis ends = own_axis(path_, 1, body.motion.at(1, part.place));
  for (size_t i = 0; i < count; ++i) {
    const Vector end = rods::difference(ends.at(faces[i].share), t.corners[0]);
    const double at_end_m = rods::dot(end, faces[i].distance.normal) - t.margin_m;
    add_contact(body, own, touch.time, faces[i], at_end_m, {feature_of(faces[i].share, 0.5), true, true});
  }
  if (count == 0 && touch.near.distance.m + t.margin_m > 0) {
    const double at_end_m = distance(convex_of(t), ends.at(touch.near.share)).m;
    add_contact(body, own, touch.time, touch.near, at_end_m, {0, true, false});
  }
}

// Where there is no room, that of the contact with the widest gap, if that is wider.
ProbeContacts::Found* ProbeContacts::free_slot(double gap_m) noexcept {
  if (count_ < kMost) return &found_[count_++];
  Found* widest = std::max_element(found_, found_ + kMost,
                                   [](const Found& a, const Found& b) { return a.hit.gap_m < b.hit.gap_m; });
  return widest->hit.gap_m > gap_m ? widest : nullptr;
}

// The obstacle's surface goes straight from where it is at the tick's start to where it is touched, or, from
// a touch at the start, to its end.
void ProbeContacts::add_contact(const Body& body, const Part& part, double time, const Near& near,
                                double at_end_m, const Feature& feature) noexcept {
  const Place begin = body.motion.at(0, part.place), then = body.motion.at(time, part.place);
  const Axis axis = own_axis(path_, time, then);
  const Vector own = rods::scaled_sum(-near.distance.m, near.distance.normal, axis.at(near.share));
  const Vector normal = then.direction(near.distance.normal), surface = begin.point(own);
  const double later = time > 0 ? time : 1;
  const Vector moved = time > 0 ? then.point(own) : body.motion.at(1, part.place).point(own);
  Vector velocity = rods::scaled(1 / later, rods::difference(moved, surface));
  const Axis start = {path_.start[0], path_.start[1]}, end = {path_.end[0], path_.end[1]};
  const double gap = rods::dot(normal, rods::difference(start.at(near.share), surface)) - path_.radius_m;
  // What passes by would be caught by the plane, which goes straight on: it goes no nearer than the shape.
  const double near_m = near.distance.m - path_.radius_m;
  const double least_m = std::min(near_m, at_end_m - path_.radius_m);
  const Vector way = rods::difference(end.at(near.share), start.at(near.share));
  const double gap_then = gap + rods::dot(normal, rods::difference(way, velocity));
  if (near_m > kTouches * path_.radius_m && least_m > 0 && gap_then < least_m) {
    velocity = rods::scaled_sum(gap_then - least_m, normal, velocity);
  }
  Found* to = rods::finite(normal) && std::isfinite(gap) ? free_slot(gap) : nullptr;
  if (!to) return;
  *to = {{}, then.point(own), normal, near.share, body.name, feature.mesh, feature.face};
  ContactHit& hit = to->hit;
  hit.along = static_cast<float>(2 * near.share - 1);
  hit.gap_m = gap;
  put(normal, hit.normal);
  put(rods::scaled(1 / dt_s_, velocity), hit.velocity_m_s);
  hit.friction = body.friction;
  hit.restitution = body.restitution;
  hit.name = mixed(mixed(body.name, part.number), feature.number);
  hit.body = body.handle;
}

bool ProbeContacts::coplanar(const Found& a, const Found& b) const noexcept {
  const double off = rods::dot(a.normal, rods::difference(b.surface, a.surface));
  return rods::dot(a.normal, b.normal) > kSameNormal && std::fabs(off) < kSamePlace * path_.radius_m + 1e-6;
}

bool ProbeContacts::said_by_others(uint32_t i) const noexcept {
  const Found& f = found_[i];
  if (!f.mesh) return false;
  const double slack = f.face ? 0 : path_.radius_m / std::max(length_m(), path_.radius_m);
  bool before = false, after = false, again = false;
  for (uint32_t k = 0; k < count_; ++k) {
    const Found& other = found_[k];
    if (k == i || other.body != f.body || !other.mesh) continue;
    const bool same_share =
        std::fabs(other.share - f.share) * length_m() <= kSamePlace * path_.radius_m + 1e-9;
    if (other.face == f.face && coplanar(other, f)) {
      again |= same_share && k < i;
      before |= f.face && !same_share && other.share < f.share;
      after |= f.face && !same_share && other.share > f.share;
    } else if (other.face && !f.face) {
      const double off = rods::dot(other.normal, rods::difference(f.surface, other.surface));
      if (!(off < kSamePlace * path_.radius_m + 1e-6)) continue;
      before |= other.share <= f.share + slack;
      after |= other.share >= f.share - slack;
    }
  }
  return again || (before && after);
}

void ProbeContacts::reduce() noexcept {
  bool drop[kMost];
  for (uint32_t i = 0; i < count_; ++i) drop[i] = said_by_others(i);
  uint32_t kept = 0;
  for (uint32_t i = 0; i < count_; ++i) {
    if (!drop[i]) found_[kept++] = found_[i];
  }
  count_ = kept;
}

}  // namespace sinew::bullet
