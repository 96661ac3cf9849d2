// check_batch.cpp  Refuses settings and strands that make no batch, by name and place.
#include "rods/create/check_batch.hpp"

#include <cmath>

#include "core/status.hpp"

namespace sinew::rods {
namespace {

Status bad_setting(const char* name, double value, const char* range) {
  return core::make_status(StatusCode::kInvalidArgument, "RodSettings::%s is %g; give %s", name, value,
                           range);
}

Status check_settings(const RodSettings& s) {
  if (s.start > RodStart::kLearned) {
    return bad_setting("start", static_cast<double>(s.start),
                       "kZero, kPrevious, kGiven, kContinued or kLearned");
  }
  if (s.max_iterations < 1 || s.max_iterations > 1000) {
    return bad_setting("max_iterations", s.max_iterations, "1 to 1000");
  }
  if (!(s.tolerance_rad >= 1e-6f && s.tolerance_rad <= 1)) {
    return bad_setting("tolerance_rad", static_cast<double>(s.tolerance_rad), "1e-6 to 1");
  }
  if (!(s.teleport_lengths > 0 && std::isfinite(s.teleport_lengths))) {
    return bad_setting("teleport_lengths", static_cast<double>(s.teleport_lengths),
                       "a finite number above 0");
  }
  if (s.correction.correct && s.start != RodStart::kContinued) {
    return bad_setting("start", static_cast<double>(s.start), "kContinued, which a correction corrects");
  }
  for (const float g : s.gravity_m_s2) {
    if (!std::isfinite(g)) return bad_setting("gravity_m_s2", static_cast<double>(g), "finite numbers");
  }
  return s.start == RodStart::kLearned ? check_learned_start(s.network) : Status{};
}

Status check_shape(const StrandDef& first, const StrandDef& strand, uint32_t index) {
  if (strand.segments.size() != first.segments.size()) {
    return core::make_status(StatusCode::kInvalidArgument,
                             "strand %u: %zu segments where strand 0 has %zu; put it into another batch",
                             index, strand.segments.size(), first.segments.size());
  }
  for (size_t i = 1; i < first.segments.size(); ++i) {
    if (strand.segments[i].parent != first.segments[i].parent) {
      return core::make_status(StatusCode::kInvalidArgument,
                               "strand %u, segment %zu: its parent is %u where strand 0 has %u; put it into "
                               "another batch",
                               index, i, strand.segments[i].parent, first.segments[i].parent);
    }
  }
  return {};
}

}  // namespace

Status check_batch(std::span<const StrandDef> strands, const RodSettings& settings) noexcept {
  Status status = check_settings(settings);
  if (status.ok() && strands.empty()) {
    status = core::make_status(StatusCode::kInvalidArgument, "no strand; give one or more");
  }
  for (uint32_t i = 0; i < strands.size() && status.ok(); ++i) {
    status = check_strand(strands[i], i);
    if (status.ok()) status = check_shape(strands[0], strands[i], i);
  }
  return status;
}

}  // namespace sinew::rods
