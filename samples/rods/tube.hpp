// tube.hpp  Rods as lit tubes, and leaves on them.
#pragma once
#include "baker/render/mesh.hpp"
#include "samples/rods/story.hpp"

namespace sinew::sample {

// Smooth across joints: where a segment goes on from the one before it, both meet in the mean of their poses.
// Free ends are round.
void add_tube(const Actor& actor, const Poses& poses, render::Mesh* mesh);

// On the segments that actor.leafy names; they turn with their segment. The same leaves every time.
void add_leaves(const Actor& actor, const Poses& poses, render::Mesh* mesh);

}  // namespace sinew::sample
