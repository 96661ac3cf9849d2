// surface_walk-inl.hpp  Walks through the tree over a surface's triangles, a node's children or a leaf's
// triangles at a time.
//
// As all of *-inl.hpp, once a target: no include guard.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

using SurfaceLanes = hn::CappedTag<float, kSurfaceWide>;
using SurfaceV = hn::Vec<SurfaceLanes>;

// body(first lane) returns a mask; bit k of lane k.
template <class Body>
HWY_INLINE uint32_t surface_bits(const Body& body) {
  const SurfaceLanes d;
  uint32_t bits = 0;
  for (size_t i = 0; i < kSurfaceWide; i += hn::MaxLanes(d)) {
    uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, body(i), bytes);
    bits |= uint32_t{bytes[0]} << i;
  }
  return bits;
}

HWY_INLINE Three<SurfaceV> surface_three(const float (&rows)[3][kSurfaceWide], size_t i) {
  const SurfaceLanes d;
  return {hn::Load(d, rows[0] + i), hn::Load(d, rows[1] + i), hn::Load(d, rows[2] + i)};
}
HWY_INLINE Three<SurfaceV> surface_three(const float (&v)[3]) {
  const SurfaceLanes d;
  return {hn::Set(d, v[0]), hn::Set(d, v[1]), hn::Set(d, v[2])};
}

HWY_INLINE SurfaceV surface_square(const SurfaceBoxes& boxes, const Three<SurfaceV>& point, size_t i) {
  const SurfaceLanes d;
  const Three<SurfaceV> below = surface_three(boxes.low, i) - point,
                        above = point - surface_three(boxes.high, i);
  const SurfaceV zero = hn::Zero(d);
  const Three<SurfaceV> out = {hn::Max(hn::Max(below.x, above.x), zero),
                               hn::Max(hn::Max(below.y, above.y), zero),
                               hn::Max(hn::Max(below.z, above.z), zero)};
  return dot(out, out);
}

HWY_INLINE uint32_t surface_overlaps(const SurfaceBoxes& boxes, const Three<SurfaceV>& low,
                                     const Three<SurfaceV>& high) {
  return surface_bits([&](size_t i) HWY_ATTR {
    const Three<SurfaceV> of_low = surface_three(boxes.low, i), of_high = surface_three(boxes.high, i);
    const auto x = hn::And(hn::Le(of_low.x, high.x), hn::Ge(of_high.x, low.x));
    const auto y = hn::And(hn::Le(of_low.y, high.y), hn::Ge(of_high.y, low.y));
    return hn::And(hn::And(x, y), hn::And(hn::Le(of_low.z, high.z), hn::Ge(of_high.z, low.z)));
  });
}

template <class Body>
HWY_INLINE void for_surface_bits(uint32_t bits, const Body& body) {
  for (; bits != 0; bits &= bits - 1) body(hwy::Num0BitsBelowLS1Bit_Nonzero32(bits));
}

HWY_INLINE hn::Mask<SurfaceLanes> surface_in_groups(const SurfaceLeaf& leaf, uint32_t groups, size_t i) {
  const SurfaceLanes d;
  const hn::Rebind<uint32_t, SurfaceLanes> bits;
  const auto shared = hn::And(hn::Load(bits, leaf.groups + i), hn::Set(bits, groups));
  return hn::Not(hn::RebindMask(d, hn::Eq(shared, hn::Zero(bits))));
}

// Shares of the edges from a triangle's first corner; which of them is chosen may be wrong by rounding.
struct SurfaceShares {
  SurfaceV v, w;
};
HWY_INLINE SurfaceV surface_share(SurfaceV part, SurfaceV of) {
  const SurfaceLanes d;
  return hn::Min(hn::Max(hn::Div(part, of), hn::Zero(d)), hn::Set(d, 1));
}
HWY_INLINE SurfaceShares surface_nearest_shares(const Three<SurfaceV>& ab, const Three<SurfaceV>& ac,
                                                const Three<SurfaceV>& ap) {
  const SurfaceLanes d;
  const SurfaceV zero = hn::Zero(d), one = hn::Set(d, 1);
  const SurfaceV bb = dot(ab, ab), bc = dot(ab, ac), cc = dot(ac, ac), b = dot(ab, ap), c = dot(ac, ap);
  // Half of the squared distance, but for a constant.
  const auto height = [&](SurfaceV v, SurfaceV w) HWY_ATTR {
    const SurfaceV vv = hn::Mul(v, hn::Sub(hn::Mul(hn::Set(d, 0.5f), hn::Mul(v, bb)), b));
    const SurfaceV ww = hn::Mul(w, hn::Sub(hn::Mul(hn::Set(d, 0.5f), hn::Mul(w, cc)), c));
    return hn::MulAdd(hn::Mul(v, w), bc, hn::Add(vv, ww));
  };
  SurfaceV v = surface_share(b, bb), w = zero, best = height(v, zero);
  const SurfaceV on_ac = surface_share(c, cc), of_ac = height(zero, on_ac);
  const auto is_ac = hn::Lt(of_ac, best);
  v = hn::IfThenElse(is_ac, zero, v), w = hn::IfThenElse(is_ac, on_ac, w);
  best = hn::Min(best, of_ac);
  const SurfaceV across = hn::Sub(hn::Add(bb, cc), hn::Add(bc, bc));
  const SurfaceV on_bc = surface_share(hn::Add(hn::Sub(c, b), hn::Sub(bb, bc)), across);
  const SurfaceV off_bc = hn::Sub(one, on_bc);
  const auto is_bc = hn::Lt(height(off_bc, on_bc), best);
  v = hn::IfThenElse(is_bc, off_bc, v), w = hn::IfThenElse(is_bc, on_bc, w);
  const SurfaceV square = hn::Sub(hn::Mul(bb, cc), hn::Mul(bc, bc));
  const SurfaceV in_v = hn::Div(hn::Sub(hn::Mul(b, cc), hn::Mul(c, bc)), square);
  const SurfaceV in_w = hn::Div(hn::Sub(hn::Mul(c, bb), hn::Mul(b, bc)), square);
  const auto inside =
      hn::And(hn::And(hn::Ge(in_v, zero), hn::Ge(in_w, zero)), hn::Le(hn::Add(in_v, in_w), one));
  return {hn::IfThenElse(inside, in_v, v), hn::IfThenElse(inside, in_w, w)};
}

// From a point to each triangle: at least by the plane across the way to what seems nearest, whatever that
// is, and at most to that.
struct SurfaceBounds {
  SurfaceV at_least, at_most;
  hn::Mask<SurfaceLanes> above;
};
HWY_INLINE SurfaceBounds surface_bounds(const SurfaceLeaf& leaf, const Three<SurfaceV>& point,
                                        float rounding_m, size_t i) {
  const SurfaceLanes d;
  const Three<SurfaceV> a = surface_three(leaf.corners[0], i);
  const Three<SurfaceV> ab = surface_three(leaf.corners[1], i) - a,
                        ac = surface_three(leaf.corners[2], i) - a;
  const Three<SurfaceV> ap = point - a;
  const SurfaceShares on = surface_nearest_shares(ab, ac, ap);
  const Three<SurfaceV> away = less_scaled(on.v, ab, less_scaled(on.w, ac, ap));
  const SurfaceV at_most = hn::Sqrt(dot(away, away)), of_a = dot(away, ap);
  const SurfaceV lowest = hn::Min(of_a, hn::Min(hn::Sub(of_a, dot(away, ab)), hn::Sub(of_a, dot(away, ac))));
  // Where the point lies on the triangle there is no way to it.
  const SurfaceV by_plane = hn::Div(lowest, at_most);
  const SurfaceV at_least = hn::IfThenElse(hn::Lt(by_plane, at_most), by_plane, at_most);
  // The normal is as long as its edges' product at most, and off by a share of that.
  const SurfaceV arm = hn::Add(hn::Abs(ap.x), hn::Add(hn::Abs(ap.y), hn::Abs(ap.z)));
  const SurfaceV doubt = hn::MulAdd(hn::Set(d, 2e-6f), arm, hn::Set(d, rounding_m));
  const SurfaceV edges = hn::Mul(dot(ab, ab), dot(ac, ac)), height = dot(cross(ab, ac), ap);
  const auto above = hn::And(hn::Gt(height, hn::Zero(d)),
                             hn::Gt(hn::Mul(height, height), hn::Mul(edges, hn::Mul(doubt, doubt))));
  return {hn::IfThenElse(hn::Gt(at_least, hn::Zero(d)), at_least, hn::Zero(d)), at_most, above};
}

HWY_INLINE void surface_keep_near(float within_m, SurfaceWalk* walk) {
  uint32_t kept = 0;
  for (uint32_t i = 0; i < walk->found_count; ++i) {
    walk->found[kept] = walk->found[i];
    walk->above[kept] = walk->above[i];
    walk->at_least_m[kept] = walk->at_least_m[i];
    kept += walk->at_least_m[i] <= within_m;
  }
  walk->found_count = kept;
}

HWY_INLINE void surface_nearest_in_leaf(const SurfaceLeaf& leaf, const Three<SurfaceV>& point,
                                        SurfacePoint* of, SurfaceWalk* walk) {
  const SurfaceLanes d;
  alignas(32) float at_least[kSurfaceWide];
  float within = of->within_m;
  const uint32_t above = surface_bits([&](size_t i) HWY_ATTR {
    const SurfaceBounds bounds = surface_bounds(leaf, point, of->rounding_m, i);
    const auto there = surface_in_groups(leaf, walk->groups, i);
    hn::Store(hn::IfThenElse(there, bounds.at_least, hn::Inf(d)), d, at_least + i);
    const auto known = hn::And(there, hn::Lt(bounds.at_most, hn::Inf(d)));
    const SurfaceV most = hn::IfThenElse(known, bounds.at_most, hn::Inf(d));
    within = std::min(within, hn::GetLane(hn::MinOfLanes(d, most)) + of->rounding_m);
    return bounds.above;
  });
  of->within_m = within;
  const uint32_t near = surface_bits([&](size_t i) HWY_ATTR {
    return hn::Le(hn::Load(d, at_least + i), hn::Set(d, within + of->rounding_m));
  });
  for_surface_bits(near, [&](size_t k) HWY_ATTR {
    walk->found[walk->found_count] = leaf.triangles[k];
    walk->above[walk->found_count] = (above >> k & 1) != 0;
    walk->at_least_m[walk->found_count++] = at_least[k];
  });
}

// The nearest is the last.
HWY_INLINE void surface_put_off(SurfaceWalk::Pending child, uint32_t first, SurfaceWalk* walk) {
  uint32_t i = walk->pending_count++;
  for (; i > first && walk->pending[i - 1].square_m2 < child.square_m2; --i) {
    walk->pending[i] = walk->pending[i - 1];
  }
  walk->pending[i] = child;
}

HWY_INLINE void surface_nearest_in_node(const SurfaceNode& node, const Three<SurfaceV>& point,
                                        float within_m2, SurfaceWalk* walk) {
  const SurfaceLanes d;
  alignas(32) float squares[kSurfaceWide];
  const uint32_t near = surface_bits([&](size_t i) HWY_ATTR {
    const SurfaceV square = surface_square(node.boxes, point, i);
    hn::Store(square, d, squares + i);
    return hn::Le(square, hn::Set(d, within_m2));
  });
  const uint32_t first = walk->pending_count;
  for_surface_bits(near, [&](size_t k) HWY_ATTR {
    if (node.children[k] == 0) return;  // empty: far out, infinity is as near as it
    surface_put_off({squares[k], node.children[k]}, first, walk);
  });
}

HWY_INLINE float surface_within2(const SurfacePoint& of) {
  const float within = of.within_m + of.rounding_m;
  return within * within * 1.00001f;
}

void surface_nearest(const SurfaceTree& tree, SurfacePoint* of, SurfaceWalk* walk) {
  const Three<SurfaceV> point = surface_three(of->point_m);
  walk->found_count = 0;
  while (walk->pending_count > 0) {
    const SurfaceWalk::Pending next = walk->pending[walk->pending_count - 1];
    const bool reached = next.square_m2 <= surface_within2(*of), leaf = (next.child & kSurfaceLeaf) != 0;
    if (reached && leaf && walk->found_count + kSurfaceWide > SurfaceWalk::kMostFound) {
      surface_keep_near(of->within_m + of->rounding_m, walk);
      if (walk->found_count + kSurfaceWide > SurfaceWalk::kMostFound) return;
    }
    --walk->pending_count;
    if (!reached) continue;
    if (leaf) {
      if (next.child == walk->first_leaf && next.square_m2 >= 0) continue;  // it was the first
      surface_nearest_in_leaf(tree.leaves[next.child & ~kSurfaceLeaf], point, of, walk);
    } else {
      surface_nearest_in_node(tree.nodes[next.child], point, surface_within2(*of), walk);
    }
  }
  surface_keep_near(of->within_m + of->rounding_m, walk);
}

// Of lanes, where all have the same.
struct SurfaceAxes {
  Three<SurfaceV> start[2], end[2];
};
HWY_INLINE SurfaceV surface_lower(const Three<SurfaceV> (&axis)[2], const Three<SurfaceV>& n) {
  return hn::Min(dot(n, axis[0]), dot(n, axis[1]));
}

// Gaps along a direction change evenly: what is apart along it at both ends of the tick is so all the way.
HWY_INLINE hn::Mask<SurfaceLanes> surface_near_along(const SurfaceLeaf& leaf, const SurfaceAxes& axes,
                                                     const SurfaceSweep& sweep, const Three<SurfaceV>& n,
                                                     size_t i) {
  const SurfaceLanes d;
  const SurfaceV share = hn::Set(d, sweep.share), none = hn::Neg(hn::Inf(d));
  SurfaceV at_start = none, at_end = none;
  for (size_t c = 0; c < 3; ++c) {
    const SurfaceV start = dot(n, surface_three(leaf.corners[c], i)),
                   end = dot(n, surface_three(leaf.ends[c], i));
    at_start = hn::Max(at_start, start);
    at_end = hn::Max(at_end, hn::MulAdd(share, hn::Sub(end, start), start));
  }
  const SurfaceV gap =
      hn::Min(hn::Sub(surface_lower(axes.start, n), at_start), hn::Sub(surface_lower(axes.end, n), at_end));
  return hn::Not(
      hn::Gt(gap, hn::Mul(hn::Set(d, sweep.within_m), hn::Sqrt(dot(n, n)))));  // a NaN tells nothing
}

// By planes across the way from the triangle's middle to the axis, and, of what these do not tell, along it.
HWY_INLINE uint32_t surface_near(const SurfaceLeaf& leaf, const SurfaceAxes& axes, const SurfaceSweep& sweep,
                                 uint32_t groups) {
  const SurfaceLanes d;
  const Three<SurfaceV> way = axes.start[1] - axes.start[0];
  const SurfaceV length2 = dot(way, way);
  const auto is_axis = hn::Gt(length2, hn::Zero(d));
  const auto away = [&](size_t i) HWY_ATTR {
    const Three<SurfaceV> sum = surface_three(leaf.corners[0], i) + surface_three(leaf.corners[1], i) +
                                surface_three(leaf.corners[2], i);
    const Three<SurfaceV> middle = scaled(hn::Set(d, 1.0f / 3), sum);
    const SurfaceV share = surface_share(dot(middle - axes.start[0], way), length2);
    return choose(is_axis, scaled_sum(share, way, axes.start[0]), axes.start[0]) - middle;
  };
  const uint32_t near = surface_bits([&](size_t i) HWY_ATTR {
    return hn::And(surface_in_groups(leaf, groups, i), surface_near_along(leaf, axes, sweep, away(i), i));
  });
  if (near == 0) return 0;
  return near & surface_bits([&](size_t i) HWY_ATTR {
           const Three<SurfaceV> a = surface_three(leaf.corners[0], i);
           const Three<SurfaceV> up =
               cross(surface_three(leaf.corners[1], i) - a, surface_three(leaf.corners[2], i) - a);
           const auto above = hn::Ge(dot(up, away(i)), hn::Zero(d));
           return surface_near_along(leaf, axes, sweep, choose(above, up, scaled(hn::Set(d, -1.0f), up)), i);
         });
}

void surface_near_sweep(const SurfaceTree& tree, const SurfaceSweep& sweep, SurfaceWalk* walk) {
  const Three<SurfaceV> low = surface_three(sweep.low_m), high = surface_three(sweep.high_m);
  const SurfaceAxes axes = {{surface_three(sweep.start_m[0]), surface_three(sweep.start_m[1])},
                            {surface_three(sweep.end_m[0]), surface_three(sweep.end_m[1])}};
  walk->found_count = 0;
  while (walk->pending_count > 0) {
    const uint32_t next = walk->pending[walk->pending_count - 1].child;
    if (next & kSurfaceLeaf) {
      if (walk->found_count + kSurfaceWide > SurfaceWalk::kMostFound) return;
      --walk->pending_count;
      const SurfaceLeaf& leaf = tree.leaves[next & ~kSurfaceLeaf];
      const uint32_t hit = surface_near(leaf, axes, sweep, walk->groups);
      for_surface_bits(hit, [&](size_t k) HWY_ATTR { walk->found[walk->found_count++] = leaf.triangles[k]; });
    } else {
      const SurfaceNode& node = tree.nodes[next];
      --walk->pending_count;
      for_surface_bits(surface_overlaps(node.boxes, low, high), [&](size_t k) HWY_ATTR {
        if (node.children[k] != 0) walk->pending[walk->pending_count++] = {0, node.children[k]};
      });
    }
  }
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
