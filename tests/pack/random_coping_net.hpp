// random_coping_net.hpp  Weights of a COPINGNet, made up.
#pragma once
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "baker/common/files/safetensors.hpp"
#include "rods/start/coping_net.hpp"
#include "tests/simd/test_data.hpp"

namespace sinew::test {

// It answers with numbers of about `norm`.
inline baker::Safetensors random_coping_net(uint32_t latent = 8, uint32_t blocks = 2, uint32_t depth = 1,
                                            float norm = 1) {
  baker::Safetensors file;
  file.path = "random";
  file.metadata = {{"sinew.model", "coping_net"},
                   {"sinew.version", "1"},
                   {"latent", std::to_string(latent)},
                   {"blocks", std::to_string(blocks)},
                   {"depth", std::to_string(depth)}};
  std::mt19937 random(latent + blocks);
  const auto numbers = [&](size_t count, float size) {
    std::vector<float> out(count);
    for (float& x : out) x = uniform(random, -size, size);
    return out;
  };
  const auto chain = [&](const std::string& name, uint32_t inputs, uint32_t outputs) {
    for (uint32_t k = 0; k <= depth; ++k) {
      const uint32_t in = k == 0 ? inputs : latent, out = k == depth ? outputs : latent;
      const std::string layer = name + "." + std::to_string(k);
      file.tensors[layer + ".weight"] = baker::tensor_f32({out, in}, numbers(size_t{out} * in, 0.5f));
      file.tensors[layer + ".bias"] = baker::tensor_f32({out}, numbers(out, 0.2f));
    }
  };
  const auto both = [&](const std::string& name, uint32_t of_node, uint32_t of_edge, uint32_t outputs) {
    chain(name + ".node", of_node, outputs);
    chain(name + ".edge", of_edge, outputs);
  };
  both("encoder", rods::kRodNodeInputs, rods::kRodEdgeInputs, latent);
  for (uint32_t m = 0; m < blocks; ++m) both("blocks." + std::to_string(m), 2 * latent, 3 * latent, latent);
  both("decoder", latent, latent, rods::kRodOutputs);
  for (const char* name : {"norm.node", "norm.edge"}) {
    file.tensors[name] = baker::tensor_f32({6}, std::vector<float>(6, norm));
  }
  return file;
}

}  // namespace sinew::test
