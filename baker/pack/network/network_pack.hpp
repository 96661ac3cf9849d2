// network_pack.hpp  A weights file (safetensors) to the network sections of a pack.
#pragma once
#include <string>

#include "baker/common/files/safetensors.hpp"
#include "baker/pack/network/int8_pack.hpp"
#include "baker/pack/pack_writer.hpp"

namespace sinew::baker {

// Metadata of a weights file; absent: the paper's wiring.
//   inputs         comma-separated names, in the order of the network's columns: rest_position rest_normal
//                  stiffness angular_acceleration angular_velocity gravity_change displacement velocity
//                  felt_step base_step turn frequency bend bent_force bent_step bent_displacement
//                  turned_force turned_step turned_velocity spun_step spun_velocity
//   input_scales   one number an input
//   envelope       one number an input (scaled units); absent: unbounded
//   output_scale output_leak hidden_leak state_clamp
//   length_unit    of the output; in a character a share of each region's radius
// Tensors: layers.{l}.W_x (F_in,4F) W_h (F,4F) W_y (F,3F) b (4F), and optionally W_s (F_in,4F).
// precision: what the network runs in; ranges: of each hidden layer, for int8. Returns the layers as packed.
// Throws BadInput naming file, tensor or key: missing, misshaped, NaN, unknown model or version, unknown
// input; for int8, ranges that are not this network's or not finite.
std::vector<pack::LayerRecord> add_network(const Safetensors& weights, PackWriter& pack,
                                           pack::Precision precision = pack::Precision::kFloat32,
                                           std::span<const HeardRanges> ranges = {});

// Throws BadInput where the file is not of trained weights, of an unknown model, or of another version's.
pack::ModelKind model_of(const Safetensors& weights);
// The same, and where the model is not alt_conv_lstm.
void check_model(const Safetensors& weights);

// What stands under a key. Throws BadInput naming file and key where it is absent.
const std::string& metadata_text(const Safetensors& weights, const std::string& key);

// A number among the metadata; `fallback` where the key is absent. Throws BadInput naming file and key: not a
// number, or outside low .. high.
float metadata_number(const Safetensors& weights, const std::string& key, float fallback, float low,
                      float high);

// A tensor's numbers. Throws BadInput naming file and tensor: missing, misshaped, NaN or infinity.
std::vector<float> finite_values(const Safetensors& weights, const std::string& name,
                                 const std::vector<long>& shape);

// As in `inputs` above; "unknown" for what this version does not know.
const char* input_name(pack::InputKind kind);
uint32_t input_width(pack::InputKind kind);  // floats a node; 0 for what this version does not know

}  // namespace sinew::baker
