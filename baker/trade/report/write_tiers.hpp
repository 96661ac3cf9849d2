// write_tiers.hpp  The measured tiers that are worth having, baked into the character.
#pragma once
#include <string>
#include <vector>

#include "baker/measure/loaded_pack.hpp"
#include "baker/trade/rows/row.hpp"

namespace sinew::baker {

// The pack's records: what the scheduler buys and is not dominated, and what every character has
// (pack::TierRecord).
std::vector<pack::TierRecord> tier_records(const std::vector<Row>& rows);
// The character with these in the place of its own; all else is the same.
void write_with_tiers(const std::string& path, const LoadedPack& character,
                      const std::vector<pack::TierRecord>& tiers);

}  // namespace sinew::baker
