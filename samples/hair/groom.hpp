// groom.hpp  Long hair on the bust at rest: strands that fall over neck and shoulders without touching them.
#pragma once
#include <vector>

#include "rods/strand.hpp"
#include "samples/hair/bust.hpp"

namespace sinew::sample {

struct HairStyle {
  uint32_t strands = 160, segments = 20;
  double length_m = 0.4;
  float radius_m = 0.0025f;  // of a lock that moves as one
};

// The first segment of each is held by the head.
std::vector<std::vector<rods::SegmentDef>> groom(const Bust& bust, const HairStyle& style);

}  // namespace sinew::sample
