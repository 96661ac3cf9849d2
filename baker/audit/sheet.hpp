// sheet.hpp  The worst moments of an audit as one picture.
#pragma once
#include <string>

#include "baker/audit/audit.hpp"

namespace sinew::baker {

// A PNG with a cell for each of the parts that are worst, a dozen at most: where its edges are stretched
// most, or where it is displaced most if none is beyond the bound; red is stretched beyond it. Throws
// BadInput when the path cannot be written, or when this build has no renderer.
void write_audit_sheet(const std::string& path, const Audit& audit, const AuditedPack& pack);

}  // namespace sinew::baker
