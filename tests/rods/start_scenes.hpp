// start_scenes.hpp  Networks for starts, made up, and a group of lanes to try kernels on.
#pragma once
#include <array>
#include <vector>

#include "kernels/kernels.hpp"
#include "kernels/rods/rod_job.hpp"
#include "rods/start/coping_net.hpp"
#include "tests/pack/packed_model.hpp"
#include "tests/pack/random_coping_net.hpp"
#include "tests/rods/rod_scenes.hpp"
#include "tests/simd/test_data.hpp"

namespace sinew::test {

// A network of random weights that answers with numbers of about `norm`.
class RandomCopingNet {
 public:
  explicit RandomCopingNet(uint32_t latent = 8, uint32_t blocks = 2, uint32_t depth = 1, float norm = 1)
      : packed_(random_coping_net(latent, blocks, depth, norm)) {
    net_ = {packed_.view().network, packed_.view().dense, packed_.view().weights.data()};
  }
  const rods::CopingNet& net() const { return net_; }

 private:
  PackedModel packed_;
  rods::CopingNet net_;
};

// Memory of a group, all zeros but for orientations, which are none.
template <uint32_t kWidth>
struct StartLanes {
  explicit StartLanes(std::vector<uint32_t> parent_list, uint32_t latent = 8)
      : parents(std::move(parent_list)), segments(static_cast<uint32_t>(parents.size())) {
    for (auto* plane :
         {&records, &scratch, &work, &lanes, &history, &continued, &inputs, &scales, &encodings, &planes}) {
      *plane = std::make_unique<Floats>(1, 0.0f);
    }
    const auto take = [&](std::unique_ptr<Floats>& to, size_t rows, float value = 0) {
      to = std::make_unique<Floats>(rows * kWidth, value);
      return to->data();
    };
    job.records = take(records, size_t{segments} * simd::kRodKeptFields);
    job.scratch = take(scratch, size_t{segments} * simd::kRodScratchRows);
    job.work = take(work, size_t{segments} * simd::kRodWorkRows);
    job.lanes = take(lanes, simd::kLaneFields);
    job.parents = parents.data();
    job.segments = segments;
    job.dt_s = 0.02f;
    start.history = take(history, size_t{segments} * simd::kRodStartAges * simd::kRodStartNumbers);
    start.continued = take(continued, size_t{segments} * simd::kRodStartNumbers);
    start.inputs = take(inputs, size_t{segments} * simd::kRodStartInputs);
    start.scales = take(scales, simd::kRodStartTriples, 1);
    start.encodings = take(encodings, size_t{segments} * latent);
    start.planes = take(planes, simd::rod_net_floats(segments, latent, kWidth) / kWidth);
    for (uint32_t i = 0; i < segments; ++i) fill(at(i, simd::kRodTurn + 3), 1);
    know(simd::kRodStartKnown + 1);
  }
  float* at(uint32_t segment, uint32_t field) const {
    return job.records + (size_t{segment} * simd::kRodKeptFields + field) * kWidth;
  }
  static void fill(float* row, float value) { std::fill_n(row, kWidth, value); }
  void know(uint32_t steps) { fill(job.lanes + simd::kLaneKnownSteps * kWidth, static_cast<float>(steps)); }
  static const simd::RodStartCalls& calls(const simd::Kernels& kernels) {
    return kWidth == 16 ? kernels.rods->wide.start : kernels.rods->narrow.start;
  }

  std::vector<uint32_t> parents;
  uint32_t segments;
  std::unique_ptr<Floats> records, scratch, work, lanes, history, continued, inputs, scales, encodings,
      planes;
  simd::RodJob job{};
  simd::RodStartJob start{};
};

}  // namespace sinew::test
