// press_region.cpp  see press_region.hpp.
#include "character/contacts/press_region.hpp"

#include <Eigen/Core>
#include <algorithm>

#include "character/output/displacement_bound.hpp"
#include "character/parameters/tuned_parts.hpp"
#include "tissue/modes/contact_response.hpp"
#include "tissue/modes/guard.hpp"
#include "tissue/modes/modal_base.hpp"

namespace sinew::world {
namespace {

using Eigen::Vector3f;
using Rows33 = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;
using MapVector = Eigen::Map<Vector3f>;
using ConstVector = Eigen::Map<const Vector3f>;

constexpr float kMostAsked = 0.9f;  // of the displacement limit

// A touch as its node feels it: the normal along l, turned by half of what warping turns.
tissue::NodeContact contact_of(const Instance& instance, const pack::RegionRecord& region,
                               const Touch& touch) {
  const Vector3f in_frame =
      Eigen::Map<const Rows33>(instance.motion.poses[0][touch.node].rotation).transpose() *
      ConstVector(touch.normal);
  const float* turn = instance.tissue.theta + size_t{3} * touch.node;
  const float half_turn[3] = {0.5f * turn[0], 0.5f * turn[1], 0.5f * turn[2]};
  tissue::NodeContact contact{.node = touch.node - region.first_node};
  tissue::turn_back(half_turn, in_frame.data(), 1, contact.normal);
  const float along = in_frame.dot(ConstVector(instance.tissue.u[0] + size_t{3} * touch.node));
  const float most = std::max(0.0f, kMostAsked * limit_m(instance, touch.region) - along);
  contact.gap_m = std::max(touch.gap_m, -most);
  return contact;
}

// Of all that the node's patch touches on this side, by depth. On a curved body the deepest alone slides, as
// the node follows it, until another is deepest and pushes it back, again and again.
Vector3f mean_normal(std::span<const Touch> touches, const Touch& deepest) {
  constexpr float kSameSide = 0.25f;  // cosine
  const ConstVector normal(deepest.normal);
  Vector3f sum = Vector3f::Zero();
  for (const Touch& touch : touches) {
    const bool with = touch.node == deepest.node && touch.gap_m < 0;
    if (with && ConstVector(touch.normal).dot(normal) > kSameSide)
      sum -= touch.gap_m * ConstVector(touch.normal);
  }
  const float size = sum.norm();
  return size > 0 ? Vector3f(sum / size) : Vector3f(normal);
}

// The deepest touch of each node, of the region's most deeply touched nodes.
size_t gather(ContactState& contacts, std::span<const Touch> touches, const Touch** out) {
  for (const Touch& touch : touches) contacts.deepest[touch.node] = 0;
  for (uint32_t t = 0; t < touches.size(); ++t) {
    uint32_t& deepest = contacts.deepest[touches[t].node];
    if (deepest == 0 || touches[t].gap_m < touches[deepest - 1].gap_m) deepest = t + 1;
  }
  size_t count = 0;
  for (uint32_t t = 0; t < touches.size(); ++t) {
    if (contacts.deepest[touches[t].node] != t + 1) continue;
    if (count < tissue::kMostNodeContacts) {
      out[count++] = &touches[t];
      continue;
    }
    const Touch** shallowest =
        std::max_element(out, out + count, [](auto* a, auto* b) { return a->gap_m < b->gap_m; });
    if (touches[t].gap_m < (*shallowest)->gap_m) *shallowest = &touches[t];
  }
  return count;
}

void press_modes(Instance& instance, uint32_t r, std::span<tissue::NodeContact> contacts) {
  const GraphLevel& level = *instance.level;
  const pack::RegionRecord& region = level.pack.regions[r];
  const size_t vector = size_t{3} * region.first_node, mode = level.pack.region_modes[r].first_mode;
  const tissue::ModalTick tick{.q = instance.tissue.q[0] + mode,
                               .r = instance.tissue.r[0] + vector,
                               .l = instance.tissue.l[0] + vector,
                               .theta = instance.tissue.theta + vector,
                               .u = instance.tissue.u[0] + vector};
  // From one side of its limit to the other.
  const float most_m = 2 * std::min(limit_m(instance, r), displacement_bound_m(*instance.asset, r));
  if (!tissue::press(base_of(instance, r), most_m, contacts, instance.tissue.felt + vector,
                     instance.tissue.region[0], instance.tissue.region[1], tick))
    return;
  tissue::hold_within(limit_m(instance, r), region.node_count, instance.tissue.u[0] + vector);
  if (instance.state->tier == Tier::kNetwork)
    tissue::write_output(instance.asset->network, level.pack.regions.subspan(r, 1), level.node_count(),
                         instance.tissue.l[0] + vector, instance.tissue.network_memory);
}

}  // namespace

void press_region(Instance& instance, uint32_t r, std::span<const Touch> touches) noexcept {
  const pack::RegionRecord& region = instance.level->pack.regions[r];
  const Touch* chosen[tissue::kMostNodeContacts];
  tissue::NodeContact contacts[tissue::kMostNodeContacts];
  const size_t count = gather(instance.contacts, touches, chosen);
  for (size_t c = 0; c < count; ++c) {
    Touch mean = *chosen[c];
    MapVector(mean.normal) = mean_normal(touches, *chosen[c]);
    contacts[c] = contact_of(instance, region, mean);
  }
  press_modes(instance, r, {contacts, count});
  instance.tissue.quiet_ticks[r] = 0;
}

}  // namespace sinew::world
