// dense_pack.hpp  Weights of a network of chains of dense layers to the network sections of a pack.
#pragma once
#include "baker/common/safetensors.hpp"
#include "baker/pack/pack_writer.hpp"

namespace sinew::baker {

// deep_emulator: metadata rate_hz; tensors alpha.{0..4}, beta.{0..4}, gamma.{0..4}, .weight (out, in) and
// .bias (out) each. coping_net: metadata latent, blocks, depth; tensors {encoder,decoder}.{node,edge}.{k} and
// blocks.{m}.{node,edge}.{k}, .weight and .bias each, norm.node (6), norm.edge (6), not negative. Throws
// BadInput naming file, tensor or key: missing, misshaped, NaN, out of range, or a tensor that is none of
// these.
void add_chains(const Safetensors& weights, PackWriter& pack);

}  // namespace sinew::baker
