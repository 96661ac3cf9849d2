// topology.cpp  Vertices at one place become one; edges find their two triangles.
#include "adapters/embree/topology.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sinew::embree {
namespace {

// Of a triangle's longest edge: a height below this is no area.
constexpr double kNoHeight = 1e-7;

// The first of all vertices at the same place, for each.
std::vector<uint32_t> welded(std::span<const float> places_m) {
  const auto place = [&](uint32_t v) {
    return std::array{places_m[3 * v], places_m[3 * v + 1], places_m[3 * v + 2]};
  };
  std::vector<uint32_t> order(places_m.size() / 3), first(order.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](uint32_t a, uint32_t b) { return std::pair(place(a), a) < std::pair(place(b), b); });
  for (size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && place(order[i]) == place(order[i - 1]);
    first[order[i]] = same ? first[order[i - 1]] : order[i];
  }
  return first;
}

bool has_area(const Corners& t, std::span<const float> places_m) {
  double edges[3][3], longest = 0;
  for (size_t k = 0; k < 3; ++k) {
    for (size_t c = 0; c < 3; ++c) {
      edges[k][c] =
          static_cast<double>(places_m[3 * t[(k + 1) % 3] + c]) - static_cast<double>(places_m[3 * t[k] + c]);
    }
    longest = std::max(longest, std::hypot(edges[k][0], edges[k][1], edges[k][2]));
  }
  const auto& [a, b, unused] = edges;
  const double twice =
      std::hypot(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
  return twice > kNoHeight * longest * longest;
}

struct Edge {
  uint32_t low, high, triangle, k;
  bool rises;  // from low to high
};

std::vector<Edge> sorted_edges(const std::vector<Corners>& triangles) {
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (uint32_t i = 0; i < triangles.size(); ++i) {
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t a = triangles[i][k], b = triangles[i][(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), i, k, a < b});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::array{a.low, a.high, a.triangle, a.k} < std::array{b.low, b.high, b.triangle, b.k};
  });
  return edges;
}

void connect_edges(Topology* to) {
  const std::vector<Edge> edges = sorted_edges(to->triangles);
  to->across.assign(to->triangles.size(), {kBorder, kBorder, kBorder});
  for (size_t i = 0, end; i < edges.size(); i = end) {
    for (end = i; end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high;)
      ++end;
    if (end == i + 2 && edges[i].rises != edges[i + 1].rises) {
      to->across[edges[i].triangle][edges[i].k] = edges[i + 1].triangle;
      to->across[edges[i + 1].triangle][edges[i + 1].k] = edges[i].triangle;
    } else {
      to->border[edges[i].low] = to->border[edges[i].high] = 1;
      ++to->border_edges;
    }
  }
}

void make_fans(size_t vertices, Topology* to) {
  to->fan_begin.assign(vertices + 1, 0);
  for (const Corners& t : to->triangles) {
    for (const uint32_t v : t) ++to->fan_begin[v + 1];
  }
  std::partial_sum(to->fan_begin.begin(), to->fan_begin.end(), to->fan_begin.begin());
  std::vector<uint32_t> next(to->fan_begin.begin(), to->fan_begin.end() - 1);
  to->fan.resize(to->fan_begin.back());
  for (uint32_t i = 0; i < to->triangles.size(); ++i) {
    for (const uint32_t v : to->triangles[i]) to->fan[next[v]++] = i;
  }
}

}  // namespace

Topology connect(std::span<const uint32_t> indices, std::span<const float> places_m) {
  Topology out;
  const std::vector<uint32_t> first = welded(places_m);
  for (uint32_t i = 0; i < indices.size() / 3; ++i) {
    const Corners t = {first[indices[3 * i]], first[indices[3 * i + 1]], first[indices[3 * i + 2]]};
    if (has_area(t, places_m)) {
      out.triangles.push_back(t);
      out.source.push_back(i);
    } else {
      ++out.skipped;
    }
  }
  out.border.assign(first.size(), 0);
  connect_edges(&out);
  make_fans(first.size(), &out);
  return out;
}

}  // namespace sinew::embree
