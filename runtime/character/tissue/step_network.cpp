// step_network.cpp  see step_network.hpp.
#include "character/tissue/step_network.hpp"

#include "character/rest/asleep.hpp"
#include "character/tissue/emulate.hpp"
#include "character/tissue/region_part.hpp"
#include "tissue/frames/node_drive.hpp"
#include "tissue/modes/guard.hpp"
#include "tissue/network/inputs.hpp"
#include "tissue/network/network.hpp"

namespace sinew::world {
namespace {

void assemble(Instance& instance) noexcept {
  const Asset& asset = *instance.asset;
  const size_t stride = tissue::input_stride(asset.network);
  for_each_awake_part(instance, [&](const Part& part) {
    if (is_emulated(part)) return;
    const tissue::NodeSources sources{.region = &part.record,
                                      .nodes = instance.level->pack.nodes.data() + part.node,
                                      .drive = instance.tissue.drive + tissue::kNodeDriveWidth * part.node,
                                      .felt = instance.tissue.felt + part.vector,
                                      .l = instance.tissue.l[0] + part.vector,
                                      .l_before = instance.tissue.l[1] + part.vector,
                                      .l_hat = instance.tissue.l_hat + part.vector,
                                      .theta = instance.tissue.theta + part.vector,
                                      .first_rad_per_s = part.first_rad_per_s,
                                      .tick_s = static_cast<float>(asset.tick_s)};
    const uint32_t clamped =
        tissue::assemble_inputs(asset.network, sources, instance.tissue.inputs + stride * part.node);
    instance.state->tissue.input_clamps += clamped;
    instance.tissue.trust[part.index] = tissue::trust_in(asset.network, sources, clamped);
    tissue::carry_to(asset.network, part.record, instance.level->node_count(),
                     instance.tissue.l_hat + part.vector, instance.tissue.network_memory,
                     instance.tissue.carry + part.vector);
  });
}

void give_up_network(Instance& instance) noexcept {
  InstanceState& state = *instance.state;
  state.tier = Tier::kModal;
  state.fallback_ticks = kFallbackTicks;
  state.tissue.forgotten = 1;
  wake_regions(instance);
  ++state.tissue.fallbacks;
  instance.marks.fell_back = true;
}

// Runs of awake regions that are its.
std::span<const tissue::NodeRun> awake_nodes(Instance& instance) noexcept {
  size_t count = 0;
  for_each_awake_part(instance, [&](const Part& part) {
    if (is_emulated(part)) return;
    const auto first = static_cast<uint32_t>(part.node), last = first + part.record.node_count;
    if (count > 0 && instance.tissue.awake[count - 1].last == first)
      instance.tissue.awake[count - 1].last = last;
    else
      instance.tissue.awake[count++] = {first, last};
  });
  return {instance.tissue.awake, count};
}

}  // namespace

bool step_network(Instance& instance) noexcept {
  const tissue::Network& network = instance.asset->network;
  bool sound = !instance.asset->emulates() || emulate(instance);
  if (!network.layers.empty()) {
    assemble(instance);
    tissue::network_step(network, instance.level->graph, awake_nodes(instance), instance.tissue.inputs,
                         instance.tissue.carry, instance.tissue.network_memory,
                         instance.tissue.network_scratch);
    sound = sound &&
            tissue::network_is_finite(network, instance.level->node_count(), instance.tissue.network_memory);
  }
  if (!sound) give_up_network(instance);
  return sound;
}

void take_back_to_network(Instance& instance) noexcept {
  for_each_awake_part(instance, [&](const Part& part) {
    tissue::write_output(instance.asset->network, instance.level->pack.regions.subspan(part.index, 1),
                         instance.level->node_count(), instance.tissue.l[0] + part.vector,
                         instance.tissue.network_memory);
  });
}

}  // namespace sinew::world
