// fold.hpp  The other face of a fold: what a point comes to that slides along the face it touches first.
#pragma once
#include <optional>

#include "adapters/embree/triangle.hpp"

namespace sinew::embree {

// Of the radius: a fold that takes less of it is left alone. A second contact at one point costs iterations.
inline constexpr double kFoldDeeper = 0.05;

// A point of an axis on its way through a tick, as far as a contact lets it.
struct HeldPoint {
  Vector start, end;
  double radius_m;
  Vector normal;  // of the contact
  double gap_m;   // to its plane where the tick begins
};

struct FoldTouch {
  double time;    // share of the tick
  OnTriangle on;  // then
  Vector normal;  // the face's, to the point
  double gap_m;   // to the face's plane where the tick begins; no deeper than the face
};
// Of a triangle that rises over the contact's plane, as the other side of a valley does, and that the point
// goes into. An edge in a valley touches nothing that its faces do not: normals are theirs.
std::optional<FoldTouch> touch_in_fold(const HeldPoint& held, const MovingTriangle& triangle,
                                       bool two_sided) noexcept;

}  // namespace sinew::embree
