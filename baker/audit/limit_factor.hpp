// limit_factor.hpp  What would bring a part within the audit's bounds by moving less.
#pragma once
#include "baker/audit/audit.hpp"

namespace sinew::baker {

// What the part's displacement limit is to be scaled by, 1 where it is within the bounds that a smaller limit
// helps against: stretched edges, triangles turned over, and how far a bobbing root moves it.
double limit_factor(const PartAudit& part, double height_m);

}  // namespace sinew::baker
