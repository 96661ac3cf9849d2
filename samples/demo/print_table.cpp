// print_table.cpp  The run's summary for a person; see summary.hpp.
#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdio>

#include "samples/demo/summary.hpp"

namespace sinew::demo {
namespace {

void print_head(const Run& run, const CharacterFile& character, const Options& options) {
  std::printf("%s: %u vertices, %u soft regions, %u control nodes, ", character.name().c_str(),
              run.asset.vertex_count, run.asset.region_count, run.asset.node_count);
  if (run.asset.rod_count > 0) std::printf("%u rods, ", run.asset.rod_count);
  std::printf("ticks at %g Hz\n", static_cast<double>(run.asset.tick_hz));
  std::printf("%d instance%s, %zu frames of %.2f ms, %d thread%s, ", run.instances,
              run.instances == 1 ? "" : "s", run.frames.size(), 1e3 / run.fps, options.threads,
              options.threads == 1 ? "" : "s");
  if (std::isfinite(options.budget_us)) {
    std::printf("budget %g us a frame, ", options.budget_us);
  } else {
    std::printf("no budget, ");
  }
  std::printf(run.contacts ? "contacts with its body colliders\n" : "no contacts\n");
}

void print_parts(const std::string& name, const Run& run) {
  if (run.parts.empty()) {
    std::printf("\n  %s: no soft part and no rod\n", name.c_str());
    return;
  }
  const double height_mm = 1000 * static_cast<double>(run.asset.height_m);
  size_t width = std::max<size_t>(16, name.size());
  for (const PartMotion& part : run.parts) width = std::max(width, part.name.size());
  std::printf("\n  %-*s %5s %8s %15s %10s %17s %10s\n", static_cast<int>(width), name.c_str(), "kind", "Hz",
              "most moved, mm", "of height", "2 s still, mm", "of height");
  for (const PartMotion& part : run.parts) {
    std::printf("  %-*s %5s ", static_cast<int>(width), part.name.c_str(), part.is_rod ? "rod" : "soft");
    if (part.frequency_hz > 0)
      std::printf("%8.2f", part.frequency_hz);
    else
      std::printf("%8s", "");
    std::printf(" %15.1f %8.2f %% %17.2f %8.3f %%\n", part.largest_mm, 100 * part.largest_mm / height_mm,
                part.still_mm, 100 * part.still_mm / height_mm);
  }
}

void print_rods(const RodWork& rods, const Run& run, const Options& options) {
  if (run.asset.rod_count == 0 || rods.iterations.max == 0) return;
  const std::string start = options.start.empty() ? "baked" : options.start;
  std::printf("\n  %s: rods' solver, start %s: %.2f iterations a rod and tick, at most %.2f",
              run.name.c_str(), start.c_str(), rods.iterations.mean, rods.iterations.max);
  if (!options.start.empty())
    std::printf("; residual in the median %.1e, at most %.1e", rods.residual.median, rods.residual.max);
  std::printf("\n");
}

void print_stage(const StageTime& stage) {
  std::printf("  %-16s %10.1f %10.1f %10.1f\n", stage.name.c_str(), stage.us.median, stage.us.p99,
              stage.us.max);
}

void print_known(double value, const char* format) {
  if (std::isnan(value)) {
    std::printf("%18s", "not measured");
  } else {
    std::printf(format, value);
  }
}

// Of several control graphs the finest stands for a tier.
void print_tiers(const Summary& summary, const Run& run) {
  std::printf("\n  %-16s %10s %18s %18s\n", run.asset.graph_levels > 1 ? "tier, finest" : "tier", "share",
              "baked cost, us", "baked error, mm");
  for (const TierShare& tier : summary.tiers) {
    std::printf("  %-16s %8.1f %% ", tier.name.c_str(), 100 * tier.share);
    print_known(tier.baked_cost_us, "%18.1f");
    std::printf(" ");
    print_known(tier.baked_error_mm, "%18.2f");
    std::printf("\n");
  }
  std::printf("  %-16s %29s ", "as used", "");
  print_known(summary.expected_error_mm, "%18.2f");
  std::printf("\n");
}

void print_budget(const Summary& summary, const Run& run, const Options& options) {
  std::printf("\n  ");
  if (std::isfinite(options.budget_us)) {
    std::printf("over budget in %" PRIu64 " of %zu frames (worst %.0f us), ", summary.over_budget,
                run.frames.size(), summary.step.back().us.max);
  }
  std::printf("instances cut short %" PRIu64 ", restarts %" PRIu64 "\n", summary.cut, summary.restarts);
  std::printf("  inputs clamped %" PRIu64 ", displacements clamped %" PRIu64, summary.input_clamps,
              summary.displacement_clamps);
  if (summary.dropped_s > 0)
    std::printf(", time dropped %.3f s (frames longer than the world's cap of ticks)", summary.dropped_s);
  std::printf("\n");
}

void print_reasons(const Summary& summary) {
  std::printf("\n  why:");
  for (const ReasonShare& reason : summary.reasons)
    std::printf(" %s %.1f %%", reason.name.c_str(), 100 * reason.share);
  std::printf("\n  expected error, of skinning's: ");
  if (summary.expected_error)
    std::printf("mean %.2f, worst frame %.2f", summary.expected_error->mean, summary.expected_error->max);
  else
    std::printf("not measured");
  std::printf("; left unspent while one was denied: median %.1f %%, p99 %.1f %%\n",
              100 * summary.unspent.median, 100 * summary.unspent.p99);
}

void print_error(const char* name, const Spread& error, double of_skinning) {
  std::printf("  %-16s %10.2f %10.2f %10.2f", name, error.mean, error.p99, error.max);
  if (of_skinning > 0) std::printf(" %13.0f %%", 100 * error.mean / of_skinning);
  std::printf("\n");
}

void print_errors(const Summary& summary) {
  std::printf("\n  %-16s %10s %10s %10s %15s\n", "against truth", "mean, mm", "p99", "worst",
              "of skinning's");
  print_error("skinning alone", summary.skinning_error_mm, 0);
  print_error("Sinew", summary.sinew_error_mm, summary.skinning_error_mm.mean);
}

}  // namespace

void print_table(const Summary& summary, const Run& run, const Run* other, const CharacterFile& character,
                 const Options& options) {
  print_head(run, character, options);
  print_parts(run.name, run);
  if (other != nullptr) print_parts(other->name, *other);
  print_rods(summary.rods, run, options);
  if (other != nullptr) print_rods(rod_work(*other), *other, options);
  std::printf("\n  %-16s %10s %10s %10s\n", "stage, us", "median", "p99", "worst");
  for (const StageTime& stage : summary.step) print_stage(stage);
  std::printf("  around it:\n");
  for (const StageTime& stage : summary.engine) print_stage(stage);
  print_tiers(summary, run);
  print_reasons(summary);
  print_budget(summary, run, options);
  if (!options.truth.empty()) print_errors(summary);
}

}  // namespace sinew::demo
