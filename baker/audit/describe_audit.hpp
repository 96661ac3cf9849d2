// describe_audit.hpp  An audit as a table, and as JSON.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "baker/audit/audit.hpp"

namespace sinew::baker {

nlohmann::ordered_json audit_json(const Audit& audit, const AuditedPack& pack);
std::string audit_table(const Audit& audit, const AuditedPack& pack);

}  // namespace sinew::baker
