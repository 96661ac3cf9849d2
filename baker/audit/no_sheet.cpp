// no_sheet.cpp  Of a build that cannot draw.
#include "baker/audit/sheet.hpp"
#include "baker/common/bad_input.hpp"

namespace sinew::baker {

void write_audit_sheet(const std::string& path, const Audit&, const AuditedPack&) {
  throw BadInput(path + ": this build draws no pictures; leave -o out, or build with SINEW_BUILD_SAMPLES");
}

}  // namespace sinew::baker
