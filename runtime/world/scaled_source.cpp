// scaled_source.cpp  see scaled_source.hpp.
#include "world/scaled_source.hpp"

#include <algorithm>

namespace sinew::world {
namespace {

constexpr size_t kAtOnce = 64;

ContactProbe scaled(ContactProbe probe, double scale) noexcept {
  for (auto& ends : {&probe.start_m, &probe.end_m})
    for (auto& end : *ends)
      for (double& place : end) place *= scale;
  probe.radius_m = static_cast<float>(scale * static_cast<double>(probe.radius_m));
  return probe;
}

ContactHit scaled(ContactHit hit, double scale) noexcept {
  hit.gap_m *= scale;
  for (float& velocity : hit.velocity_m_s)
    velocity = static_cast<float>(scale * static_cast<double>(velocity));
  return hit;
}

}  // namespace

uint32_t ScaledSource::find(std::span<const ContactProbe> probes, float dt_s,
                            std::span<ContactHit> hits) noexcept {
  if (scale_ == 1) return source_->find(probes, dt_s, hits);
  ContactProbe asked[kAtOnce];
  uint32_t found = 0;
  for (size_t first = 0; first < probes.size(); first += kAtOnce) {
    const size_t count = std::min(kAtOnce, probes.size() - first);
    for (size_t i = 0; i < count; ++i) asked[i] = scaled(probes[first + i], scale_);
    const size_t taken = std::min<size_t>(found, hits.size());
    const std::span<ContactHit> room = hits.subspan(taken);
    const uint32_t here = source_->find({asked, count}, dt_s, room);
    for (ContactHit& hit : room.first(std::min<size_t>(here, room.size()))) {
      hit = scaled(hit, 1 / scale_);
      hit.probe += static_cast<uint32_t>(first);
    }
    found += here;
  }
  return found;
}

void ScaledSource::push(const ContactHit& hit, const double (&point_m)[3],
                        const float (&impulse_n_s)[3]) noexcept {
  if (scale_ == 1) return source_->push(hit, point_m, impulse_n_s);
  const double point[3] = {scale_ * point_m[0], scale_ * point_m[1], scale_ * point_m[2]};
  source_->push(scaled(hit, scale_), point, impulse_n_s);
}

}  // namespace sinew::world
