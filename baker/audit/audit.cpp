// audit.cpp  Motion after motion, the worst of each part.
#include "baker/audit/audit.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "baker/audit/bounds.hpp"
#include "baker/audit/surface_wear.hpp"
#include "baker/common/bad_input.hpp"

namespace sinew::baker {
namespace {

constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();
constexpr double kLongRest_s = 60, kQuickBob_s = 2, kQuickClips_s = 60;
constexpr double kWatched_s = 10;  // a rod's residual: how far it still moves in the last of the rest

class Auditor {
 public:
  Auditor(const AuditedPack& pack, const AuditedParts& parts, const LayerGaps& gaps)
      : pack_(pack), parts_(parts), gaps_(gaps) {
    audit_.height_m = static_cast<double>(pack.view.character->height_m);
    audit_.vertices = parts_.of_vertex.size();
    farthest_m_.setZero(static_cast<Eigen::Index>(audit_.vertices));
    for (const AuditedPart& part : parts_.all) {
      PartAudit& audit = audit_.parts.emplace_back();
      audit.part = part;
      audit.residual_m = kNotMeasured;
    }
  }

  void play(
      const AuditMotion& motion, const std::function<void()>& told = [] {}) {
    Player player(pack_, motion);
    const size_t settled = std::min(player.ticks(), player.moving_ticks() + kTicksAfter);
    for (size_t tick = 1; tick <= player.ticks(); ++tick) {
      player.advance();
      if (tick <= settled && (tick % stride() == 0 || tick == settled)) {
        player.read();
        keep_worst(motion, tick, surface_wear(parts_, pack_.view, player), gaps_.of(player));
        if (motion.is_everyday)
          farthest_m_ =
              farthest_m_.cwiseMax((player.shown() - player.skinned()).colwise().norm().transpose());
      }
      watch_rods(player);
      told();
    }
    if (motion.resting_s >= kLongRest_s) resting_ = true, measure_residual(player);
    given_up_ += player.report().restarts + player.report().fallbacks;
    recovered_ += player.report().rod_recoveries;
  }

  Audit finish() {
    count_moving();
    for (const PartAudit& part : audit_.parts) judge(part);
    if (given_up_ > 0)
      audit_.failures.push_back("its state was given up " + std::to_string(given_up_) +
                                " times: numbers were no numbers");
    if (recovered_ > 0)
      audit_.failures.push_back("rods had to be put together again " + std::to_string(recovered_) + " times");
    return std::move(audit_);
  }

 private:
  static constexpr size_t kTicksAfter = 60;  // of rest that count as motion

  // Large surfaces are looked at less often: swings last many ticks.
  size_t stride() const { return 1 + parts_.of_vertex.size() / 50'000; }

  void keep_worst(const AuditMotion& motion, size_t tick, const std::vector<Wear>& wear,
                  const std::vector<LayerGap>& gaps) {
    const auto keep = [&](Moment& worst, double value) {
      if (value > worst.value || std::isnan(value)) worst = {value, motion.name, tick};
    };
    for (size_t p = 0; p < wear.size(); ++p) {
      PartAudit& part = audit_.parts[p];
      keep(part.displacement_m, wear[p].displacement_m);
      keep(part.edge_stretch, wear[p].edge_stretch);
      keep(part.inverted_share, static_cast<double>(wear[p].inverted) /
                                    static_cast<double>(std::max<size_t>(1, part.part.triangles)));
      keep(part.layers_cross_m, gaps[p].crossed_m);
      part.layers.take(gaps[p]);
      if (motion.name == "bob") part.bob_m = std::max(part.bob_m, wear[p].displacement_m);
    }
  }

  void count_moving() {
    for (size_t v = 0; v < parts_.of_vertex.size(); ++v)
      if (parts_.of_vertex[v] != AuditedParts::kNone &&
          static_cast<double>(farthest_m_(static_cast<Eigen::Index>(v))) >= kVisible * audit_.height_m)
        ++audit_.parts[static_cast<size_t>(parts_.of_vertex[v])].moving;
  }

  // In the last of a long rest, the box about each segment's end.
  void watch_rods(const Player& player) {
    const auto watched = static_cast<size_t>(kWatched_s * static_cast<double>(pack_.view.network->rate_hz));
    if (player.tick() + watched < player.ticks() || player.tick() <= player.moving_ticks()) return;
    const bool first = rod_low_.empty() || player.tick() + watched == player.ticks();
    rod_low_.resize(pack_.view.rods.size());
    rod_high_.resize(rod_low_.size());
    for (size_t r = 0; r < rod_low_.size(); ++r) {
      const Eigen::Matrix3Xf ends = player.rod_ends(pack_.view.rods[r], false);
      rod_low_[r] = first ? ends : rod_low_[r].cwiseMin(ends);
      rod_high_[r] = first ? ends : rod_high_[r].cwiseMax(ends);
    }
  }

  // Flesh comes back to the skinning; a rod that sags stays where it hangs.
  void measure_residual(Player& player) {
    player.read();
    const std::vector<double> left = displacements_m(parts_, pack_.view, player);
    for (size_t p = 0; p < left.size(); ++p)
      audit_.parts[p].residual_m =
          p < parts_.regions
              ? left[p]
              : (rod_high_[p - parts_.regions] - rod_low_[p - parts_.regions]).colwise().norm().maxCoeff();
  }

  // One line a part, with all that is wrong with it.
  void judge(const PartAudit& part) {
    std::string wrong;
    const auto hold = [&](double value, double bound, const char* what, const Moment* when) {
      if (value <= bound) return;  // NaN is beyond any bound
      char text[160];
      std::snprintf(text, sizeof text, "%s%s %.3g, at most %.3g", wrong.empty() ? "" : "; ", what, value,
                    bound);
      wrong += text;
      if (when != nullptr) wrong += " (" + when->motion + ", tick " + std::to_string(when->tick) + ")";
    };
    hold(part.edge_stretch.value, most_stretch(part.part.is_rod), "an edge is stretched by",
         &part.edge_stretch);
    if (!part.part.is_rod) {
      hold(part.inverted_share.value, most_inverted(part.part), "fraction of triangles turned over",
           &part.inverted_share);
      hold(part.bob_m / audit_.height_m, kMostDisplacement, "bobbing moves it by heights", nullptr);
      const double crossed = part.layers_cross_m.value / audit_.height_m;
      hold(crossed, kMostCrossing, "its layers cross, which skinning keeps apart, by heights",
           &part.layers_cross_m);
      if (crossed > kMostCrossing)
        wrong += ": paint or state both soft, weigh both on the same bones, or raise the recipe's layer_m";
    }
    if (!std::isnan(part.residual_m) || resting_)
      hold(part.residual_m / audit_.height_m, kMostResidual, "after a minute of rest it is off by heights",
           nullptr);
    if (!wrong.empty()) audit_.failures.push_back("'" + part.part.name + "': " + wrong);
  }

  const AuditedPack pack_;
  const AuditedParts& parts_;
  const LayerGaps& gaps_;
  Audit audit_;
  Eigen::VectorXf farthest_m_;  // of a vertex from its skinned place, in everyday motions
  std::vector<Eigen::Matrix3Xf> rod_low_, rod_high_;
  size_t given_up_ = 0, recovered_ = 0;
  bool resting_ = false;  // a long rest was played
};

void check(const AuditedPack& pack) {
  if (pack.view.character == nullptr)
    throw BadInput("is a model without a character; bake one with: sinew-bake character IN.glb -o C.sinew");
}

}  // namespace

Audit run_audit(const AuditedPack& pack, const std::function<void(size_t, size_t)>& progress) {
  check(pack);
  const std::vector<AuditMotion> motions = audit_motions(pack.view);
  double total_s = 0;
  for (const AuditMotion& motion : motions) total_s += motion.moving_s + motion.resting_s;
  const auto total = static_cast<size_t>(total_s * static_cast<double>(pack.view.network->rate_hz));
  const AuditedParts parts = find_parts(pack.view);
  const LayerGaps gaps(pack.view, parts);
  Auditor auditor(pack, parts, gaps);
  size_t done = 0;
  for (const AuditMotion& motion : motions) auditor.play(motion, [&] { progress(++done, total); });
  return auditor.finish();
}

double most_inverted(const AuditedPart& part) {
  return std::max(kMostInverted, 1.0 / static_cast<double>(std::max<size_t>(1, part.triangles)));
}

Audit quick_audit(const AuditedPack& pack) {
  check(pack);
  const AuditedParts parts = find_parts(pack.view);
  return quick_audit(pack, parts, LayerGaps(pack.view, parts));
}

Audit quick_audit(const AuditedPack& pack, const AuditedParts& parts, const LayerGaps& gaps) {
  check(pack);
  Auditor auditor(pack, parts, gaps);
  auditor.play(bob_motion(pack.view, kQuickBob_s, 0.5));
  for (const AuditMotion& motion : root_motions(pack.view)) auditor.play(motion);
  double left_s = kQuickClips_s;
  for (size_t c = 0; c < pack.view.clips.size() && left_s > 0; ++c) {
    AuditMotion clip = clip_motion(pack.view, c);
    clip.moving_s = std::min(clip.moving_s, left_s);
    left_s -= clip.moving_s;
    auditor.play(clip);
  }
  return auditor.finish();
}

}  // namespace sinew::baker
