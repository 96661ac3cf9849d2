// bounds.hpp  What an audit allows. A character beyond one of these looks broken to anybody.
#pragma once

namespace sinew::baker {

// An edge's length over its length on the skinned surface, or over that in the bind pose where the pose
// presses it together. A painted texture is seen to smear from here on; below it flesh only looks soft.
inline constexpr double kMostEdgeStretch = 1.5;
// Of rods, which turn bones and nothing else: what their skin stretches by is the file's own weights, under a
// bend that its animator did not try.
inline constexpr double kMostRodStretch = 2;
constexpr double most_stretch(bool is_rod) { return is_rod ? kMostRodStretch : kMostEdgeStretch; }
// Edges shorter than this share of the height are left out: two lines where a character fills a screen of a
// thousand, they are seams and folds of the model, and a hair's breadth doubles them.
inline constexpr double kShortestEdge = 2e-3;
// Triangles of flesh that face away from where they face on the skinned surface, as a share of its triangles
// in the worst tick; one triangle is allowed everywhere. Single slivers at a rim do no harm; a hundredth of a
// part is a visible fold.
inline constexpr double kMostInverted = 0.01;
// What is left of the displacement after a minute of rest, over the height: a tenth of a pixel where a
// character fills a screen of a thousand lines.
inline constexpr double kMostResidual = 1e-4;
// Largest displacement of flesh over the height, while the root bobs by a twentieth of the height: flesh does
// not move much further than what shakes it. Rods are free to: a tail swings.
inline constexpr double kMostDisplacement = 0.08;

// From here on a vertex visibly moves, over the height: five pixels where a character fills a screen of a
// thousand lines. No bound: what moves less passes, and is hardly seen.
inline constexpr double kVisible = 5e-3;

// How deep one layer of surface may sink into another from which skinning keeps it, over the height: a
// tenth of a pixel where a character fills a screen of a thousand lines. Beyond, skin shows through clothes.
inline constexpr double kMostCrossing = 1e-4;

}  // namespace sinew::baker
