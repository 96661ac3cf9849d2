// calibrate.hpp  What each layer of a network hears over a roll-out, for the scales of its int8 form.
#pragma once
#include <string>
#include <vector>

#include "baker/common/files/safetensors.hpp"
#include "baker/pack/network/int8_pack.hpp"
#include "tissue/network/network.hpp"

namespace sinew::baker {

// Of each hidden layer. vectors: as roll_out takes them; what they expect is not looked at. Throws BadInput
// as roll_out does, and when the network leaves finite numbers.
std::vector<HeardRanges> heard_ranges(const tissue::Network& network, const Safetensors& vectors);

// Fifty steps of a made-up motion for a network that comes without reference vectors: a sphere that sways and
// turns (the paper's wiring), or inputs that wander within their envelope.
Safetensors made_up_vectors(const tissue::Network& network);

// Reference vectors beside a weights file: W.vectors.safetensors of W.safetensors or W.weights.safetensors;
// empty if they are not there.
std::string vectors_beside(const std::string& weights_path);

}  // namespace sinew::baker
