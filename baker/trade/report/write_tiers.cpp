// write_tiers.cpp  see write_tiers.hpp.
#include "baker/trade/report/write_tiers.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

#include "baker/common/files/write_file.hpp"
#include "baker/pack/pack_writer.hpp"

namespace sinew::baker {
namespace {

bool is_kept(const Row& row) { return row.kind == "tier" && (row.level == 0 || row.dominated_by.empty()); }

// base_us: what a step takes without simulation.
pack::TierRecord to_record(const Row& row, double base_us) {
  const auto number = [](double value) { return static_cast<float>(std::max(0.0, value)); };
  return {.tier = static_cast<uint32_t>(row.tier),
          .cost_us = number(row.warm.p50_us - base_us),
          .cost_p99_us = number(row.warm.p99_us - base_us),
          .error_mm = number(row.error.mean_mm),
          .error_ratio = number(row.error.ratio),
          .error_p95_mm = number(row.error.p95_mm),
          .level = row.level,
          .worst_error_ratio = std::numeric_limits<float>::quiet_NaN(),
          .worst_clip = pack::kNoIndex};
}

}  // namespace

std::vector<pack::TierRecord> tier_records(const std::vector<Row>& rows) {
  double base_us = 0;
  for (const Row& row : rows)
    if (row.kind == "tier" && row.tier == Tier::kSkinning) base_us = row.warm.p50_us;
  std::vector<pack::TierRecord> out;
  for (const Row& row : rows)
    if (is_kept(row)) out.push_back(to_record(row, row.tier == Tier::kSkinning ? 0 : base_us));
  std::ranges::sort(out, {}, [](const pack::TierRecord& r) { return std::tuple(r.tier, r.level); });
  return out;
}

void write_with_tiers(const std::string& path, const LoadedPack& character,
                      const std::vector<pack::TierRecord>& tiers) {
  PackWriter pack = PackWriter::from_pack(character.bytes());
  pack.section(pack::SectionKind::kTiers, tiers);
  const std::vector<std::byte> bytes = pack.finish();
  LoadedPack::from_bytes(bytes, path);  // what the runtime would refuse is not written
  write_file(path, bytes);
}

}  // namespace sinew::baker
