// start_files.hpp  Weights and examples of starts from files, as the runtime reads them.
#pragma once
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "baker/common/bad_input.hpp"
#include "baker/pack/network/dense_pack.hpp"
#include "baker/research/rods/nearest_start.hpp"
#include "core/aligned_block.hpp"
#include "pack/reader.hpp"
#include "rods/start/coping_net.hpp"

namespace sinew::perf {

// Throws BadInput where the file holds no COPINGNet.
class StartNetwork {
 public:
  explicit StartNetwork(const std::string& path) {
    baker::PackWriter writer(pack::FileKind::kModel);
    baker::add_chains(baker::read_safetensors(path), writer);
    const std::vector<std::byte> bytes = writer.finish();
    memory_ = core::AlignedBlock(bytes.size());
    std::memcpy(memory_.data(), bytes.data(), bytes.size());
    const Status status = pack::open_pack({memory_.data(), bytes.size()}, &view_);
    if (!status.ok()) throw baker::BadInput(path + ": " + status.message);
    net_ = {view_.network, view_.dense, view_.weights.data()};
    name_ = std::filesystem::path(path).stem().string();
  }
  const rods::CopingNet* net() const { return &net_; }
  // The file's, without folder and ending.
  const std::string& name() const { return name_; }

 private:
  core::AlignedBlock memory_;
  pack::PackView view_;
  rods::CopingNet net_;
  std::string name_;
};

// Throws BadInput where the file holds no examples.
class ExampleFile {
 public:
  explicit ExampleFile(const std::string& path) {
    const baker::Safetensors file = baker::read_safetensors(path);
    inputs_ = file.need("inputs", {-1, simd::kRodStartInputs}).as_f32();
    answers_ = file.need("answers", {-1, simd::kRodStartNumbers}).as_f32();
    nearest_ = std::make_unique<baker::NearestStart>(inputs_, answers_);
  }
  rods::RodCorrection nearest() const { return nearest_->correction(); }

 private:
  std::vector<float> inputs_, answers_;
  std::unique_ptr<baker::NearestStart> nearest_;
};

}  // namespace sinew::perf
