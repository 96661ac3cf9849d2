// roll_out_deep_emulator.cpp  DeepEmulator over reference vectors, its own output fed back.
#include <utility>

#include "baker/common/bad_input.hpp"
#include "baker/measure/network/roll_out.hpp"

namespace sinew::baker {
namespace {

std::vector<float> positions(const Safetensors& vectors, const char* name, size_t nodes) {
  return vectors.need(name, {static_cast<long>(nodes), 3}).as_f32();
}

std::vector<uint8_t> read_constrained(const Safetensors& vectors, size_t nodes) {
  const std::vector<int32_t> values = vectors.need("constrained", {static_cast<long>(nodes)}).as_i32();
  std::vector<uint8_t> constrained;
  for (const int32_t value : values) constrained.push_back(value != 0);
  return constrained;
}

// How all patches of a step are seen.
std::vector<tissue::PatchView> views_of(const std::vector<float>& axes, size_t step, size_t nodes) {
  tissue::PatchView view{.axes = {}, .length_m = 1, .fall_m = {}};
  std::copy_n(axes.begin() + static_cast<std::ptrdiff_t>(9 * step), 9, view.axes);
  return std::vector(nodes, view);
}

}  // namespace

RollOutError roll_out_deep_emulator(const tissue::DeepEmulator& network, bool moving,
                                    const Safetensors& vectors) {
  check_vectors(vectors, "deep_emulator");
  const std::vector<size_t> shape = vectors.need("y", {-1, -1, 3}).shape;
  const size_t steps = shape[0], nodes = shape[1], frame = 3 * nodes;
  if (nodes == 0 || steps == 0)
    throw BadInput(vectors.path + ": holds " + std::to_string(nodes) + " nodes and " + std::to_string(steps) +
                   " steps, nothing to check; write the vectors again");
  const std::vector<float> y = vectors.tensors.at("y").as_f32(),
                           material = positions(vectors, "material", nodes),
                           x = vectors.need("x", {static_cast<long>(steps + 3), static_cast<long>(nodes), 3})
                                   .as_f32();
  std::vector<float> axes;
  if (moving) axes = vectors.need("axes", {static_cast<long>(steps), 9}).as_f32();
  const std::vector<uint8_t> constrained = read_constrained(vectors, nodes);
  const GraphRows graph = neighbour_rows(nodes, read_edges(vectors), vectors.path + ": tensor 'edges'");
  std::vector<float> now = positions(vectors, "u_1", nodes), before = positions(vectors, "u_0", nodes),
                     before_that(frame), next(frame);
  if (!moving) before_that = positions(vectors, "u_m1", nodes);
  AlignedFloats scratch(tissue::deep_emulator_scratch_floats());
  ErrorSum error;
  for (size_t t = 1; t <= steps; ++t) {
    std::vector<tissue::PatchView> views;
    if (moving) views = views_of(axes, t - 1, nodes);
    tissue::deep_emulator_step(
        network, {graph.rows.data(), graph.columns.data()},
        {now.data(), before.data(), before_that.data(), &x[(t + 1) * frame], &x[t * frame],
         &x[(t - 1) * frame], material.data(), constrained.data(), moving ? views.data() : nullptr},
        0, static_cast<uint32_t>(nodes), next.data(), scratch.data());
    for (size_t k = 0; k < frame; ++k) error.add(next[k], y[(t - 1) * frame + k]);
    before_that.swap(before);
    before.swap(now);
    now.swap(next);
  }
  return error.result(steps);
}

}  // namespace sinew::baker
