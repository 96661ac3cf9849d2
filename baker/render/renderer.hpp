// renderer.hpp  A mesh and a camera to a picture.
#pragma once
#include "baker/render/camera.hpp"
#include "baker/render/light.hpp"
#include "baker/render/mesh.hpp"
#include "baker/render/picture/image.hpp"

namespace sinew::render {

struct RenderOptions {
  int width = 640, height = 480;
  int samples = 16;      // a pixel; noise falls with the root, best as a power of two
  int threads = 0;       // 0: all
  float floor_y = 0;     // metres
  float grid_m = 0.25f;  // between lines of the floor; 0: no lines
  float gloss = 1;       // strength of highlights; 0 for pictures whose colour is data
  Studio studio;
};

// The same bytes for the same input, whatever the number of threads.
Image render(const Mesh& mesh, const Camera& camera, const RenderOptions& options = {});

// A grid spacing of 1, 2 or 5 x 10^n metres that puts a few lines under something of this height.
float grid_for_height(float height_m);

}  // namespace sinew::render
