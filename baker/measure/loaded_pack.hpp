// loaded_pack.hpp  A pack in memory, checked, for the programs.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "baker/common/files/safetensors.hpp"
#include "baker/research/precision/reduced_network.hpp"
#include "core/aligned_block.hpp"
#include "pack/mapped_file.hpp"
#include "pack/reader.hpp"
#include "rods/start/coping_net.hpp"
#include "tissue/network/deep_emulator.hpp"
#include "tissue/network/network.hpp"

namespace sinew::baker {

class LoadedPack {
 public:
  // Throws BadInput with the reader's reason, opening with `path`.
  static LoadedPack from_file(const std::string& path);
  static LoadedPack from_bytes(std::span<const std::byte> bytes, const std::string& path);
  // Trained weights packed as they would be baked in this precision. calibration: a file of reference vectors
  // that int8 takes its scales from; empty: those beside the weights, else a made-up motion.
  static LoadedPack from_weights(const std::string& path, pack::Precision precision,
                                 const std::string& calibration);

  const pack::PackView& view() const { return view_; }
  std::span<const std::byte> bytes() const { return bytes_; }
  // Runs in another precision than float32; a network of one layer, which has nothing to reduce, does not.
  bool is_reduced() const;
  // Each where the pack's model is that one.
  tissue::Network network() const;  // its float tensors, whatever its precision
  ReducedNetwork reduced_network() const;
  tissue::DeepEmulator deep_emulator() const;
  rods::CopingNet coping_net() const;

 private:
  void open(std::span<const std::byte> bytes, const std::string& path);

  pack::MappedFile file_;
  core::AlignedBlock copy_, narrow_;  // narrow_: tissue/network/narrow_layer.hpp
  pack::PackView view_;
  std::span<const std::byte> bytes_;
};

// By the first bytes, or by its name where they are missing or damaged.
bool looks_like_pack(const std::string& path);

}  // namespace sinew::baker
