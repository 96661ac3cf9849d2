// golden_scenes.hpp  Scenes of soft blocks through the public API, and hashes of everything they put out.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "sinew/sinew.hpp"
#include "tests/world/stage.hpp"

namespace sinew::test {

// Hashes of what every frame of a scene put out.
struct GoldenOutput {
  uint64_t positions = 0, normals = 0, joints = 0;
  uint64_t decisions = 0;  // tiers, their reasons, control graphs, counters, ticks
  bool operator==(const GoldenOutput&) const = default;
};

class GoldenRecorder {
 public:
  // Reads all that each block of the stage puts out after a step.
  void add_frame(const Stage& stage, const FrameReport& frame);
  GoldenOutput output() const;

 private:
  std::vector<uint64_t> positions_, normals_, joints_, decisions_;
};

struct GoldenScene {
  const char* name;
  void (*play)(GoldenRecorder& recorder);
};

// The names are unique.
std::span<const GoldenScene> golden_scenes();

}  // namespace sinew::test
