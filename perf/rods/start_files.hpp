// start_files.hpp  Weights and examples of starts from files, as the runtime reads them.
#pragma once
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "baker/common/bad_input.hpp"
#include "baker/pack/dense_pack.hpp"
#include "core/aligned_block.hpp"
#include "pack/reader.hpp"
#include "rods/coping_net.hpp"
#include "rods/knn_start.hpp"

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
    view_ = {inputs_, answers_};
  }
  const rods::StartExamples* examples() const { return &view_; }

 private:
  std::vector<float> inputs_, answers_;
  rods::StartExamples view_;
};

}  // namespace sinew::perf
