// scaled_source.cpp  see scaled_source.hpp.
#include "character/contacts/scaled_source.hpp"

#include <algorithm>

namespace sinew::world {
namespace {

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
  const size_t count = std::min(most_, probes.size());
  for (size_t i = 0; i < count; ++i) asked_[i] = scaled(probes[i], scale_);
  const uint32_t found = source_->find({asked_.get(), count}, dt_s, hits);
  for (ContactHit& hit : hits.first(std::min<size_t>(found, hits.size()))) hit = scaled(hit, 1 / scale_);
  return found;
}

void ScaledSource::push(const ContactHit& hit, const double (&point_m)[3],
                        const float (&impulse_n_s)[3]) noexcept {
  if (scale_ == 1) return source_->push(hit, point_m, impulse_n_s);
  const double point[3] = {scale_ * point_m[0], scale_ * point_m[1], scale_ * point_m[2]};
  source_->push(scaled(hit, scale_), point, impulse_n_s);
}

}  // namespace sinew::world
