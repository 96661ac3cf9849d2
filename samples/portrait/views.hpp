// views.hpp  The pictures of a portrait: round the character, and through its clips.
#pragma once
#include <string>
#include <vector>

#include "baker/render/picture/layout.hpp"
#include "baker/render/renderer.hpp"
#include "samples/portrait/character_mesh.hpp"

namespace sinew::portrait {

struct PictureSize {
  int width = 480, height = 480, samples = 32, threads = 0;
};

struct Pose {
  const baker::Clip* clip = nullptr;
  double t_s = 0;
  Paint paint = Paint::kColors;
};

// One picture of each named side: front left, front, side, back.
std::vector<render::Cell> sides(const baker::Character& character, const Pose& pose, const PictureSize& size);
// count pictures on a full circle, the camera at the same distance in all.
std::vector<render::Cell> turntable(const baker::Character& character, const Pose& pose, int count,
                                    const PictureSize& size);
// columns pictures of each clip at even times, one camera for all of a clip.
std::vector<render::Cell> through_clips(const baker::Character& character, Paint paint, int columns,
                                        const PictureSize& size);

}  // namespace sinew::portrait
