// rod_start_job.hpp  What the kernels of starts work on, beside a group's records (rod_job.hpp).
#pragma once
#include <cstddef>
#include <cstdint>

#include "pack/format.hpp"

namespace sinew::simd {

struct RodJob;

// Of a start, a segment: acceleration (world), angular acceleration (own axes), force (world), moment.
inline constexpr uint32_t kRodStartNumbers = 12, kRodStartTriples = 4;
// Results kept before the last, and how many one after the other continue_start needs.
inline constexpr uint32_t kRodStartAges = 3, kRodStartKnown = kRodStartAges + 1;

// What is told of a segment to what guesses by example: by how much the last step's continuation missed, in
// the segment's own axes at the step's start, each triple over its root mean square over the strand (12);
// place along the strand 0..1; the share of the continuation's miss in force, r.m.s. against the force
// itself, 0..1.
inline constexpr uint32_t kRodStartInputs = 14, kRodJointInputs = 5;

// A small COPINGNet with strands as lanes: a row of rods/start/coping_net.hpp is a column here.
struct RodStartNet {
  const pack::DenseRecord* layers;  // of chains of depth + 1, as pack/dense_layout.hpp orders them
  const float* weights;
  uint32_t latent, blocks, depth;  // latent a multiple of 8, at most pack::kPanel
};

// Arrays of a group are aligned like its records.
struct RodStartJob {
  float* history;    // [segments][kRodStartAges][kRodStartNumbers][width]
  uint32_t newest;   // of the ages: the last result but one; the one after it, in turn, is the oldest
  float* continued;  // [segments][kRodStartNumbers][width]: as continue_start left it, before corrections; or
                     // null
  float* inputs;     // [segments][kRodStartInputs][width]; where they are told, else null
  float* scales;     // [kRodStartTriples][width]: the root mean squares that inputs were divided by
  const float* encodings;  // [segments][latent][width], as encode_joints leaves them; the root's is not read
  float* planes;           // rod_net_floats(...) floats, of any group
};

// Of planes.
constexpr size_t rod_net_floats(uint32_t segments, uint32_t latent, uint32_t width) {
  return (3 * size_t{segments} * latent + 3 * size_t{pack::kPanel}) * width;
}

// For one width of a group; all before predict, on every lane.
struct RodStartCalls {
  // Puts a start that continues the last steps in place of the last step's result, which goes to the oldest
  // age: `newest` moves on by one. Strands with less than kRodStartKnown results start from the last one.
  // Where `inputs` are, they and scales are told first, and `continued` is kept for the next step.
  void (*continue_start)(const RodJob& job, const RodStartJob& start);
  // Adds the network's outputs, times scales, to what continue_start left; to strands alone whose inputs mean
  // something: kRodStartKnown + 1 results.
  void (*add_network)(const RodJob& job, const RodStartJob& start, const RodStartNet& net);
  // joints [segments][kRodJointInputs][width] to encodings.
  void (*encode_joints)(const RodJob& job, const RodStartNet& net, const float* joints, float* encodings,
                        float* planes);
};

}  // namespace sinew::simd
