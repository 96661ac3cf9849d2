// voxel_matter.hpp  Where a surface encloses matter, on a fine grid, and which fine cells hang together.
//
// Inside is what at least two of the three axes' rays agree on (signed crossings, so that overlapping and
// nested components count once; a ray whose crossings do not close, as through an open mesh, abstains), or
// what no way from outside reaches. Where neither finds matter under the surface, the cell half a fine cell
// in is matter, so that nothing is too thin. Two neighbouring inside cells between whose centres the ray
// leaves matter are not connected: an arm that touches a belly stays apart from it.
#pragma once
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "baker/import/character/character.hpp"

namespace sinew::baker {

struct SurfaceSample {
  int triangle = 0;
  std::array<double, 3> weight{};  // barycentric
  Vector3 position, inward;        // inward: against the outward unit normal
};

// Points no further apart than `spacing` on every triangle of positive area, triangle after triangle, corners
// included; those of one triangle lie row by row.
std::vector<SurfaceSample> sample_surface(const Character& character, double spacing);

class VoxelMatter {
 public:
  VoxelMatter(const Character& character, double cell_m, int fine_per_cell);

  std::array<int, 3> cells() const { return cells_; }  // coarse
  Vector3 corner(int i, int j, int k) const;           // of a coarse cell
  int fine_per_cell() const { return fine_per_cell_; }
  double cell_m() const { return cell_m_; }

  int fine_of(const Vector3& p) const;  // clamped to the grid
  // The matter under a place on the surface: the first such fine cell on the way in, else the nearest beside
  // it, else the cell half a fine cell in.
  int home(const Vector3& surface, const Vector3& inward) const;
  std::array<int, 3> fine_place(int fine) const;
  int coarse_of(int fine) const;
  bool matter(int fine) const { return matter_[static_cast<size_t>(fine)]; }
  bool connected(int fine, int axis) const;  // with the next fine cell along the axis
  // Further pairs that hang together although their cells share no face: neighbours along the surface. They
  // join what is thinner than a fine cell and lies aslant.
  const std::vector<std::pair<int, int>>& links() const { return links_; }
  int neighbour(int fine, int axis) const;  // the next along the axis, -1 at the border
  int fine_count() const { return fine_[0] * fine_[1] * fine_[2]; }
  int coarse_count() const { return cells_[0] * cells_[1] * cells_[2]; }

 private:
  void link_along_surface(const Character& character, const std::vector<SurfaceSample>& samples,
                          const std::vector<bool>& enclosed);
  int matter_beside(const Vector3& p) const;
  void cast_rays(const Character& character, int axis);
  void cast_ray(const std::vector<std::pair<double, int>>& crossings, int axis, int start);
  void fill_from_outside(const std::vector<SurfaceSample>& samples);

  std::array<int, 3> cells_{}, fine_{}, stride_{};
  int fine_per_cell_ = 1;
  double cell_m_ = 0, fine_m_ = 0;
  Vector3 origin_;
  std::vector<uint8_t> votes_;  // axes that found the centre inside
  std::vector<uint8_t> cut_;    // a bit an axis: the ray leaves matter between this cell and the next
  std::vector<bool> matter_;
  std::vector<std::pair<int, int>> links_;
};

}  // namespace sinew::baker
