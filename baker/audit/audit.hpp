// audit.hpp  Plays a character's clips and standard motions as an engine would, and says where it looks
// broken.
//
// A Player makes a world, so that rods, guards and the smooth limits are what an engine gets. Bounds and
// their reasons: bounds.hpp.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "baker/audit/audited_pack.hpp"
#include "baker/audit/layer_gaps.hpp"
#include "baker/audit/parts.hpp"

namespace sinew::baker {

// When something was worst.
struct Moment {
  double value = 0;
  std::string motion;  // empty: never
  size_t tick = 0;
};

struct PartAudit {
  AuditedPart part;
  Moment displacement_m, edge_stretch, inverted_share;
  Moment layers_cross_m;  // how deep layers have crossed that skinning keeps apart
  LayerGap layers = {};   // between them, over all motions
  double bob_m = 0;       // largest displacement while the root bobs
  double residual_m = 0;  // after a minute of rest, what is left of it; NaN: not measured
  size_t moving = 0;      // vertices that visibly move in the bob or a clip
};

struct Audit {
  double height_m = 0;
  size_t vertices = 0;  // of the character, rigid ones too
  std::vector<PartAudit> parts;
  std::vector<std::string> failures;  // a line each: part, what, how much, in which motion, the bound
};

// progress(done, of all) is called now and then; a pack without a character is refused with BadInput.
Audit run_audit(const AuditedPack& pack, const std::function<void(size_t, size_t)>& progress);

// The root's motions and the first minute of the clips, without the minute of rest: a fraction of a second.
Audit quick_audit(const AuditedPack& pack);
// With parts and layers of the same character, found in a pack that has other limits at most.
Audit quick_audit(const AuditedPack& pack, const AuditedParts& parts, const LayerGaps& gaps);

// Of a part's triangles that may be turned over: kMostInverted, or one.
double most_inverted(const AuditedPart& part);

}  // namespace sinew::baker
