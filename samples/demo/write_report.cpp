// write_report.cpp  The run as JSON, for plot_budget.py and other machines; see summary.hpp.
#include <cmath>
#include <nlohmann/json.hpp>

#include "baker/common/files/write_file.hpp"
#include "samples/demo/summary.hpp"

namespace sinew::demo {
namespace {

using Json = nlohmann::ordered_json;

// JSON knows neither infinity nor NaN.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json spread(const Spread& s) {
  return {{"median", s.median}, {"p99", s.p99}, {"max", s.max}, {"mean", s.mean}};
}

Json stages(const std::vector<StageTime>& list) {
  Json out = Json::object();
  for (const StageTime& stage : list) out[stage.name] = spread(stage.us);
  return out;
}

Json tiers(const std::vector<TierShare>& list) {
  Json out = Json::object();
  for (const TierShare& tier : list) {
    out[tier.name] = {{"share", tier.share},
                      {"baked_cost_us", number(tier.baked_cost_us)},
                      {"baked_error_mm", number(tier.baked_error_mm)}};
  }
  return out;
}

Json reasons(const std::vector<ReasonShare>& list) {
  Json out = Json::object();
  for (const ReasonShare& reason : list) out[reason.name] = reason.share;
  return out;
}

Json summary_json(const Summary& s, bool truth) {
  Json out = {{"step_us", stages(s.step)},
              {"engine_us", stages(s.engine)},
              {"tiers", tiers(s.tiers)},
              {"expected_error_mm", number(s.expected_error_mm)},
              {"rod_iterations", spread(s.rods.iterations)},
              {"rod_residual", spread(s.rods.residual)},
              {"why", reasons(s.reasons)},
              {"expected_error", s.expected_error ? spread(*s.expected_error) : Json(nullptr)},
              {"unspent", spread(s.unspent)},
              {"frames_over_budget", s.over_budget},
              {"instances_cut", s.cut},
              {"restarts", s.restarts},
              {"input_clamps", s.input_clamps},
              {"displacement_clamps", s.displacement_clamps},
              {"rejected_poses", s.rejected_poses},
              {"dropped_s", s.dropped_s}};
  if (truth)
    out["error_mm"] = {{"skinning", spread(s.skinning_error_mm)}, {"sinew", spread(s.sinew_error_mm)}};
  return out;
}

Json parts_json(const Run& run) {
  const double height_mm = 1000 * static_cast<double>(run.asset.height_m);
  Json out = Json::array();
  for (const PartMotion& part : run.parts)
    out.push_back({{"name", part.name},
                   {"kind", part.is_rod ? "rod" : "soft"},
                   {"frequency_hz", part.frequency_hz > 0 ? number(part.frequency_hz) : nullptr},
                   {"largest_mm", part.largest_mm},
                   {"largest_of_height", part.largest_mm / height_mm},
                   {"still_mm", part.still_mm},
                   {"still_of_height", part.still_mm / height_mm}});
  return out;
}

const char* name_of(Tier tier) {
  constexpr const char* kNames[kTierCount] = {"skinning", "extrapolated", "network", "", "modal"};
  return kNames[static_cast<size_t>(tier)];
}

Json frame_json(const FrameRecord& frame, bool truth) {
  const FrameReport& r = frame.step;
  Json out = {{"time_s", frame.time_s},
              {"ticks", r.ticks},
              {"budget_us", number(static_cast<double>(r.budget_us))},
              {"total_us", r.total_us},
              {"schedule_us", r.schedule_us},
              {"drive_us", r.drive_us},
              {"tissue_us", r.tissue_us},
              {"rods_us", r.rods_us},
              {"publish_us", r.publish_us},
              {"poses_us", frame.poses_us},
              {"read_us", frame.read_us},
              {"network", r.instances_network},
              {"modal", r.instances_modal},
              {"extrapolated", r.instances_extrapolated},
              {"skinning", r.instances_skinned},
              {"cut", r.instances_cut},
              {"expected_error", number(static_cast<double>(r.expected_error))},
              {"unspent_us", r.unspent_us},
              {"restarts", r.restarts},
              {"over_budget", r.over_budget},
              {"first", {{"tier", name_of(frame.first.tier)}, {"blend", frame.first.blend}}}};
  if (truth) out["error_mm"] = {{"skinning", frame.error.skinning_mm}, {"sinew", frame.error.sinew_mm}};
  return out;
}

}  // namespace

void write_report(const std::string& path, const Summary& summary, const Run& run, const Run* other,
                  const CharacterFile& character, const Options& options) {
  const bool truth = !options.truth.empty();
  Json out = {{"character", character.name()},
              {"vertices", run.asset.vertex_count},
              {"nodes", run.asset.node_count},
              {"tick_hz", run.asset.tick_hz},
              {"instances", run.instances},
              {"fps", run.fps},
              {"threads", options.threads},
              {"budget_us", number(options.budget_us)},
              {"own_body_contacts", run.contacts},
              {"parts", parts_json(run)},
              {"summary", summary_json(summary, truth)},
              {"frames", Json::array()}};
  if (other != nullptr) out["compared"] = {{"name", other->name}, {"parts", parts_json(*other)}};
  for (const FrameRecord& frame : run.frames) out["frames"].push_back(frame_json(frame, truth));
  baker::write_file(path, std::string_view(out.dump(1)));
}

}  // namespace sinew::demo
