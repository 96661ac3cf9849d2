// dense_pack.hpp  Weights of a network of chains of dense layers to the network sections of a pack.
#pragma once
#include "baker/common/files/safetensors.hpp"
#include "baker/pack/pack_writer.hpp"

namespace sinew::baker {

// deep_emulator: metadata rate_hz and, if it is not the paper's, latent (16, 32, 48; 64) and frame
// ("going_on"); tensors alpha.{0..4}, beta.{0..4}, gamma.{0..4}, .weight (out, in) and .bias (out) each.
// coping_net: metadata latent, blocks, depth; tensors {encoder,decoder}.{node,edge}.{k} and
// blocks.{m}.{node,edge}.{k}, .weight and .bias each, norm.node (6), norm.edge (6), not negative. Throws
// BadInput naming file, tensor or key: missing, misshaped, NaN, out of range, or a tensor that is none of
// these.
void add_chains(const Safetensors& weights, PackWriter& pack);

// A coping_net for a character's rods (RodRecipe::learned_start) to the sections kRodNetwork, kRodDense and
// kRodWeights; returns its multiply-adds a segment. Throws BadInput as above, and naming the key: another
// model, a latent width that is no multiple of 8 up to 64, a norm above 1000.
uint64_t add_rod_network(const Safetensors& weights, PackWriter& pack);

// A deep_emulator for a character's patches to the sections kPatchNetwork, kPatchDense and kPatchWeights;
// returns its latent width. Throws BadInput as add_chains does.
uint32_t add_patch_network(const Safetensors& weights, PackWriter& pack);

}  // namespace sinew::baker
