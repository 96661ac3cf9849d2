// turning_camera.hpp  The view of one who stands before the crowd and looks to and fro.
#pragma once
#include "sinew/view.hpp"

namespace sinew::demo {

// From eye height, three spacings before the first row, 24 degrees to either side and back in eight seconds:
// the first of the crowd is always shown.
View turning_camera(double t_s, double height_m, double spacing_m);

}  // namespace sinew::demo
