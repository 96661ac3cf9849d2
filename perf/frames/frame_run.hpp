// frame_run.hpp  One scene, frame by frame: what each step cost and what it bought.
#pragma once
#include <cstdint>
#include <vector>

#include "perf/frames/pose_tape.hpp"
#include "perf/frames/scene.hpp"
#include "samples/demo/character_file.hpp"
#include "sinew/sinew.hpp"

namespace sinew::perf {

struct FrameCost {
  float cpu_us = 0, wall_us = 0;  // of the step: of the stepping thread; from its start to its end
  FrameReport report;
};

// Poses and views are set outside of what is timed. Throws baker::BadInput.
std::vector<FrameCost> run_frames(const demo::CharacterFile& character, const PoseTape& tape,
                                  const Scene& scene, uint32_t frames);

}  // namespace sinew::perf
