// labels.hpp  Where names stand beside dots: over no dot, no line and no other name, and inside the axes.
#pragma once
#include <Eigen/Geometry>
#include <span>
#include <vector>

namespace sinew::baker {

using LabelBox = Eigen::AlignedBox2f;  // pixels, y down

struct Labelled {
  Eigen::Vector2f dot;
  Eigen::Vector2f size;  // of the name's box
};

inline constexpr float kDotRadius = 6;
inline constexpr float kThreadFrom = 15;  // as far from its dot as that a name has a thread to it

// Of each a free place, all in all near their dots, to the right of them where it can be. front: a polyline
// that names keep off. If it can be so, a thread from the dot to the nearest point of its name crosses no
// dot, no name and no other thread, and a name without a thread has no other dot as near. Where the room is
// too full, a name stands to the right all the same.
std::vector<LabelBox> place_labels(std::span<const Labelled> all, std::span<const Eigen::Vector2f> front,
                                   const LabelBox& room);

// Of the box's points the one nearest to that.
Eigen::Vector2f nearest(const LabelBox& box, const Eigen::Vector2f& to);

}  // namespace sinew::baker
