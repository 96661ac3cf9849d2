// voxel_matter.cpp  Where a surface encloses matter, on a fine grid, and which fine cells hang together.
#include "baker/truth/cage/voxel_matter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sinew::baker {
namespace {

constexpr int kBorder = 1;  // coarse cells around the surface: the outside is connected

struct Corners {
  Vector3 a, b, c;
};

Corners corners(const Character& character, size_t triangle) {
  const auto& t = character.triangles[triangle];
  const auto at = [&](size_t k) { return character.positions[static_cast<size_t>(t[k])]; };
  return {at(0), at(1), at(2)};
}

}  // namespace

std::vector<SurfaceSample> sample_surface(const Character& character, double spacing) {
  std::vector<SurfaceSample> samples;
  for (size_t t = 0; t < character.triangles.size(); ++t) {
    const Corners p = corners(character, t);
    const Vector3 normal = (p.b - p.a).cross(p.c - p.a);
    if (!(normal.norm() > 0)) continue;
    const double longest = std::sqrt(
        std::max({(p.b - p.a).squaredNorm(), (p.c - p.b).squaredNorm(), (p.a - p.c).squaredNorm()}));
    const int parts = std::max(1, static_cast<int>(std::ceil(longest / spacing)));
    for (int i = 0; i <= parts; ++i)
      for (int j = 0; i + j <= parts; ++j) {
        const double u = static_cast<double>(i) / parts, v = static_cast<double>(j) / parts, w = 1 - u - v;
        samples.push_back(
            {static_cast<int>(t), {w, u, v}, w * p.a + u * p.b + v * p.c, -normal.normalized()});
      }
  }
  return samples;
}

VoxelMatter::VoxelMatter(const Character& character, double cell_m, int fine_per_cell)
    : fine_per_cell_(fine_per_cell), cell_m_(cell_m), fine_m_(cell_m / fine_per_cell) {
  Eigen::AlignedBox3d box;
  for (const Vector3& p : character.positions) box.extend(p);
  for (int a = 0; a < 3; ++a) {
    const auto axis = static_cast<size_t>(a);
    cells_[axis] = static_cast<int>(std::ceil(box.sizes()[a] / cell_m - 1e-9)) + 2 * kBorder;
    cells_[axis] = std::max(cells_[axis], 1 + 2 * kBorder);
    origin_[a] = box.center()[a] - 0.5 * cell_m * cells_[axis];
    fine_[axis] = cells_[axis] * fine_per_cell;
  }
  stride_ = {1, fine_[0], fine_[0] * fine_[1]};
  votes_.assign(static_cast<size_t>(fine_count()), 0);
  cut_.assign(votes_.size(), 0);
  matter_.assign(votes_.size(), false);
  for (int axis = 0; axis < 3; ++axis) cast_rays(character, axis);
  const std::vector<SurfaceSample> samples = sample_surface(character, 0.5 * fine_m_);
  fill_from_outside(samples);
  const std::vector<bool> enclosed = matter_;
  for (const SurfaceSample& sample : samples)
    matter_[static_cast<size_t>(home(sample.position, sample.inward))] = true;
  link_along_surface(character, samples, enclosed);
}

// From sample to sample along each triangle's rows, from row to row, and around every vertex; only where
// matter is thin, for in a cell that two touching parts share, a sample may find the other part.
void VoxelMatter::link_along_surface(const Character& character, const std::vector<SurfaceSample>& samples,
                                     const std::vector<bool>& enclosed) {
  std::vector<int> at_vertex(character.positions.size(), -1);
  const auto link = [&](int a, int b) {
    const bool thin = !enclosed[static_cast<size_t>(a)] || !enclosed[static_cast<size_t>(b)];
    if (a != b && thin) links_.emplace_back(std::min(a, b), std::max(a, b));
  };
  int last = -1, row = -1;  // homes of the sample before, and of the row's first
  for (size_t s = 0; s < samples.size(); ++s) {
    const SurfaceSample& sample = samples[s];
    const int here = home(sample.position, sample.inward);
    const bool same_triangle = s > 0 && samples[s - 1].triangle == sample.triangle;
    const bool starts_row = sample.weight[2] == 0;
    if (same_triangle) link(starts_row ? row : last, here);
    if (starts_row || !same_triangle) row = here;
    last = here;
    for (size_t c = 0; c < 3; ++c) {
      if (sample.weight[c] != 1) continue;
      const auto vertex = static_cast<size_t>(character.triangles[static_cast<size_t>(sample.triangle)][c]);
      int& first = at_vertex[static_cast<size_t>(character.welded[vertex])];
      if (first < 0) first = here;
      link(first, here);
    }
  }
  std::sort(links_.begin(), links_.end());
  links_.erase(std::unique(links_.begin(), links_.end()), links_.end());
}

int VoxelMatter::home(const Vector3& surface, const Vector3& inward) const {
  for (const double depth : {0.5, 1.0, 1.5}) {
    const int fine = fine_of(surface + depth * fine_m_ * inward);
    if (matter_[static_cast<size_t>(fine)]) return fine;
  }
  return matter_beside(surface + 0.5 * fine_m_ * inward);
}

// Of the cell that holds p and the 26 around it, the matter whose centre is nearest; the cell itself where
// none is.
int VoxelMatter::matter_beside(const Vector3& p) const {
  const int middle = fine_of(p);
  int best = middle;
  double nearest = std::numeric_limits<double>::max();
  for (int i = 0; i < 27; ++i) {
    const int fine = fine_of(p + fine_m_ * Vector3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
    const auto at = fine_place(fine);
    const double distance =
        (origin_ + fine_m_ * Vector3(at[0] + 0.5, at[1] + 0.5, at[2] + 0.5) - p).squaredNorm();
    if (!matter_[static_cast<size_t>(fine)] || distance >= nearest) continue;
    nearest = distance;
    best = fine;
  }
  return best;
}

Vector3 VoxelMatter::corner(int i, int j, int k) const { return origin_ + cell_m_ * Vector3(i, j, k); }

int VoxelMatter::fine_of(const Vector3& p) const {
  int index = 0;
  for (int a = 0; a < 3; ++a) {
    const auto axis = static_cast<size_t>(a);
    index += stride_[axis] *
             std::clamp(static_cast<int>(std::floor((p[a] - origin_[a]) / fine_m_)), 0, fine_[axis] - 1);
  }
  return index;
}

std::array<int, 3> VoxelMatter::fine_place(int fine) const {
  return {fine % fine_[0], fine / stride_[1] % fine_[1], fine / stride_[2]};
}

int VoxelMatter::coarse_of(int fine) const {
  const auto place = fine_place(fine);
  return (place[2] / fine_per_cell_ * cells_[1] + place[1] / fine_per_cell_) * cells_[0] +
         place[0] / fine_per_cell_;
}

int VoxelMatter::neighbour(int fine, int axis) const {
  const auto a = static_cast<size_t>(axis);
  return fine_place(fine)[a] + 1 < fine_[a] ? fine + stride_[a] : -1;
}

bool VoxelMatter::connected(int fine, int axis) const {
  return (cut_[static_cast<size_t>(fine)] >> axis & 1) == 0;
}

// Every triangle against the grid lines along one axis through the fine cells' centres. An edge is shifted by
// an irrational sliver of a cell, so that no ray runs exactly through an edge of round coordinates.
void VoxelMatter::cast_rays(const Character& character, int axis) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const auto nu = fine_[static_cast<size_t>(u)], nv = fine_[static_cast<size_t>(v)];
  const double shift_u = 1e-6 * M_SQRT2 * fine_m_, shift_v = 1e-6 * M_PI * fine_m_;
  std::vector<std::vector<std::pair<double, int>>> lines(static_cast<size_t>(nu * nv));
  for (size_t t = 0; t < character.triangles.size(); ++t) {
    const Corners p = corners(character, t);
    const Vector3 normal = (p.b - p.a).cross(p.c - p.a);
    if (normal[axis] == 0) continue;
    const auto first = [&](int w, double shift) {
      return static_cast<int>(
          std::ceil((std::min({p.a[w], p.b[w], p.c[w]}) - shift - origin_[w]) / fine_m_ - 0.5));
    };
    const auto last = [&](int w, double shift) {
      return static_cast<int>(
          std::floor((std::max({p.a[w], p.b[w], p.c[w]}) - shift - origin_[w]) / fine_m_ - 0.5));
    };
    for (int j = first(v, shift_v); j <= last(v, shift_v); ++j)
      for (int i = first(u, shift_u); i <= last(u, shift_u); ++i) {
        const double x = origin_[u] + (i + 0.5) * fine_m_ + shift_u,
                     y = origin_[v] + (j + 0.5) * fine_m_ + shift_v;
        const auto side = [&](const Vector3& from, const Vector3& to) {
          return (to[u] - from[u]) * (y - from[v]) - (to[v] - from[v]) * (x - from[u]);
        };
        const double ab = side(p.a, p.b), bc = side(p.b, p.c), ca = side(p.c, p.a);
        if (!((ab > 0 && bc > 0 && ca > 0) || (ab < 0 && bc < 0 && ca < 0))) continue;
        const double depth = (bc * p.a[axis] + ca * p.b[axis] + ab * p.c[axis]) / (ab + bc + ca);
        lines[static_cast<size_t>(j * nu + i)].push_back({depth, normal[axis] < 0 ? 1 : -1});
      }
  }
  for (int j = 0; j < nv; ++j)
    for (int i = 0; i < nu; ++i) {
      auto& line = lines[static_cast<size_t>(j * nu + i)];
      std::sort(line.begin(), line.end());
      cast_ray(line, axis, i * stride_[static_cast<size_t>(u)] + j * stride_[static_cast<size_t>(v)]);
    }
}

void VoxelMatter::cast_ray(const std::vector<std::pair<double, int>>& crossings, int axis, int start) {
  int sum = 0;
  for (const auto& crossing : crossings) sum += crossing.second;
  if (sum != 0) return;
  int depth = 0, shallowest = 0;
  size_t next = 0;
  for (int n = 0; n < fine_[static_cast<size_t>(axis)]; ++n) {
    const auto cell = static_cast<size_t>(start + n * stride_[static_cast<size_t>(axis)]);
    const int before = depth;
    shallowest = std::abs(depth);
    for (; next < crossings.size() && crossings[next].first < origin_[axis] + (n + 0.5) * fine_m_; ++next) {
      depth += crossings[next].second;
      shallowest = std::min(shallowest, std::abs(depth));
    }
    votes_[cell] = static_cast<uint8_t>(votes_[cell] + (depth != 0));
    if (n > 0 && before != 0 && depth != 0 && shallowest == 0)
      cut_[cell - static_cast<size_t>(stride_[static_cast<size_t>(axis)])] |= static_cast<uint8_t>(1 << axis);
  }
}

void VoxelMatter::fill_from_outside(const std::vector<SurfaceSample>& samples) {
  std::vector<bool> wall(matter_.size(), false), outside(matter_.size(), false);
  for (const SurfaceSample& sample : samples) wall[static_cast<size_t>(fine_of(sample.position))] = true;
  std::vector<int> front = {0};
  outside[0] = true;
  while (!front.empty()) {
    const int cell = front.back();
    front.pop_back();
    const auto place = fine_place(cell);
    for (int way = 0; way < 6; ++way) {
      const auto axis = static_cast<size_t>(way / 2);
      const int step = way % 2 ? 1 : -1, to = place[axis] + step;
      if (to < 0 || to >= fine_[axis]) continue;
      const auto next = static_cast<size_t>(cell + step * stride_[axis]);
      if (wall[next] || outside[next]) continue;
      outside[next] = true;
      front.push_back(static_cast<int>(next));
    }
  }
  for (size_t cell = 0; cell < matter_.size(); ++cell)
    matter_[cell] = votes_[cell] >= 2 || (!wall[cell] && !outside[cell]);
}

}  // namespace sinew::baker
