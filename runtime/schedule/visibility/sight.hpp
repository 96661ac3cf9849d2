// sight.hpp  What a view shows of a ball.
#pragma once
#include <cstdint>
#include <span>

#include "sinew/status.hpp"
#include "sinew/view.hpp"

namespace sinew::frame {

struct Ball {
  double middle_m[3] = {};
  float radius_m = 0;
};

// A view as its axes and edges.
struct Sight {
  double eye_m[3] = {};
  float axes[3][3] = {};                    // camera's right, up and back, in the world
  float half_width = 0, half_height = 0;    // tangents of half the angles
  float slant_width = 1, slant_height = 1;  // over their cosines
  float far_m = 0;
};

// kInvalidArgument, kNotFinite: a field outside its range; *out is then untouched.
Status make_sight(const View& view, Sight* out) noexcept;

// Share of the view's height that the ball takes, at most 1; 0: wholly outside. An eye inside it: 1.
float seen_size(const Sight& sight, const Ball& ball) noexcept;
// Of many: the larger of that and what is there already.
void enlarge_seen_sizes(const Sight& sight, std::span<const Ball> balls, float* sizes) noexcept;

// A point of the disc that the ball shows to the eye. Points of consecutive numbers spread evenly over it.
void point_on(const Sight& sight, const Ball& ball, uint32_t number, double (&point_m)[3]) noexcept;

}  // namespace sinew::frame
