// patches_pack.cpp  see patches_pack.hpp.
#include "baker/pack/character/patches_pack.hpp"

#include <cmath>

#include "baker/common/bad_input.hpp"
#include "baker/pack/network/dense_pack.hpp"
#include "baker/pack/network/network_pack.hpp"

namespace sinew::baker {
namespace {

// Of one node and of one neighbour.
struct PatchWork {
  uint64_t node, neighbour;
};

PatchWork work_of(uint64_t latent) {
  const uint64_t beta = 2 * latent, gamma = 3 * latent;
  return {
      .node = 18 * latent + 4 * latent * latent + 15 * beta + beta * beta + 4 * gamma * gamma + 16 * gamma,
      .neighbour = 22 * beta + 3 * beta * beta};
}

}  // namespace

void check_emulator(const Safetensors& weights, double rate_hz) {
  if (model_of(weights) != pack::ModelKind::kDeepEmulator)
    throw BadInput(weights.path + ": metadata key 'sinew.model' is '" +
                   metadata_text(weights, "sinew.model") + "'; patches are predicted by a deep_emulator");
  if (!weights.metadata.contains("frame"))
    throw BadInput(weights.path +
                   ": metadata key 'frame' is missing (the paper's wiring), which characters cannot run; use "
                   "weights of baker/train's train-patches");
  const double own = static_cast<double>(metadata_number(weights, "rate_hz", 0, 1, 1000));
  if (own != rate_hz)
    throw BadInput(weights.path + ": metadata key 'rate_hz' is " + std::to_string(std::lround(own)) +
                   ", the character ticks at " + std::to_string(std::lround(rate_hz)) +
                   "; use weights of one rate");
}

uint64_t add_patches(const TissueLayout& layout, const Safetensors& weights, double rate_hz,
                     PackWriter& pack) {
  check_emulator(weights, rate_hz);
  const uint32_t latent = add_patch_network(weights, pack);
  std::vector<float> material;
  std::vector<uint8_t> held;
  std::vector<uint64_t> free_neighbours(layout.nodes.size(), 0);
  for (const auto& [a, b] : layout.edges)
    ++free_neighbours[static_cast<size_t>(a)], ++free_neighbours[static_cast<size_t>(b)];
  uint64_t operations = 0;
  const PatchWork work = work_of(latent);
  for (size_t n = 0; n < layout.nodes.size(); ++n) {
    const ControlNode::Corner& corner = layout.nodes[n].corner;
    held.push_back(corner.is_held);
    if (!corner.is_corner) {
      material.insert(material.end(), {0, 0, 0});
      continue;
    }
    const double k = corner.stiffness_per_s2 / (rate_hz * rate_hz);
    for (const double value : {std::log(k), corner.mass, std::log(k / corner.mass)})
      material.push_back(static_cast<float>(value));
    if (!corner.is_held) operations += work.node + free_neighbours[n] * work.neighbour;
  }
  pack.section(pack::SectionKind::kPatchMaterial, material, 3);
  pack.section(pack::SectionKind::kPatchHeld, held);
  return operations;
}

}  // namespace sinew::baker
