// packed_model.hpp  Weights of a network of chains packed as a model and read back, as the runtime reads it.
#pragma once
#include <catch2/catch.hpp>
#include <memory>

#include "baker/pack/network/dense_pack.hpp"
#include "tests/pack/pack_editor.hpp"

namespace sinew::test {

class PackedModel {
 public:
  explicit PackedModel(const baker::Safetensors& weights) {
    baker::PackWriter writer(pack::FileKind::kModel);
    baker::add_chains(weights, writer);
    bytes_ = std::make_unique<PackEditor>(writer.finish());
    const Status status = bytes_->open(&view_);
    INFO(status.message);
    REQUIRE(status.ok());
  }
  const pack::PackView& view() const { return view_; }

 private:
  std::unique_ptr<PackEditor> bytes_;
  pack::PackView view_;
};

}  // namespace sinew::test
