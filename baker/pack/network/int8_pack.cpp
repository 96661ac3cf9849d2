// int8_pack.cpp  Float weights to the int8 sections of a pack.
#include "baker/pack/network/int8_pack.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "baker/common/bad_input.hpp"
#include "pack/weight_layout.hpp"

namespace sinew::baker {
namespace {

constexpr float kLargest = 127, kNarrowest = 1.0f / 16;
constexpr uint32_t kGates = 4;

// ---- what is refused ----

[[noreturn]] void refuse(const std::string& what) {
  throw BadInput("int8 ranges: " + what + "; calibrate again, with a finite roll-out of this network");
}

void check_range(const std::vector<float>& range, size_t wanted, const std::string& what) {
  if (range.size() != wanted)
    refuse(what + " has " + std::to_string(range.size()) + " channels, wanted " + std::to_string(wanted));
  if (std::ranges::any_of(range, [](float r) { return !(r >= 0 && std::isfinite(r)); }))
    refuse(what + " holds a number below 0 or not finite");
}

void check_ranges(std::span<const pack::LayerRecord> layers, std::span<const HeardRanges> ranges) {
  if (ranges.size() + 1 != layers.size())
    refuse(std::to_string(ranges.size()) + " layers, wanted " + std::to_string(layers.size() - 1));
  for (size_t l = 0; l < ranges.size(); ++l) {
    const std::string layer = "layer " + std::to_string(l) + ": ";
    check_range(ranges[l].px, layers[l].inputs, layer + "P x");
    check_range(ranges[l].x, layers[l].inputs, layer + "x");
    check_range(ranges[l].h, layers[l].channels, layer + "P h");
    check_range(ranges[l].y, layers[l].channels, layer + "P y");
  }
}

// ---- what is made ----

// What the integer sums of one layer are made of: v[k] heard, times w[k][gate][channel].
class LayerProducts {
 public:
  LayerProducts(const pack::LayerRecord& layer, bool is_first, std::span<const float> floats,
                const HeardRanges& ranges)
      : layer_(layer), floats_(floats) {
    if (!is_first) append(layer.inputs, layer.w_x, ranges.px);
    if (!is_first && layer.has_self != 0) append(layer.inputs, layer.w_s, ranges.x);
    append(layer.channels, layer.w_h, ranges.h);
    first_y_ = static_cast<uint32_t>(unit_.size());
    append(layer.channels, layer.w_y, ranges.y);
  }

  uint32_t depth() const { return static_cast<uint32_t>(unit_.size()); }
  uint32_t first_y() const { return first_y_; }
  float per_unit(uint32_t k) const { return unit_[k] > 0 ? 1 / unit_[k] : 0; }

  // Gate 4 is gate o's share of P y, a sum of its own; gate c hears no P y.
  float weight(uint32_t k, uint32_t gate, uint32_t channel) const {
    const bool hears_y = gate < 2 || gate == kGates, hears_others = gate < kGates;
    if (unit_[k] == 0 || !(k < first_y_ ? hears_others : hears_y)) return 0;
    const Row& row = row_[k];
    const uint64_t at = k < first_y_ ? pack::gate_weight_at(row.of, kGates, row.index, gate, channel)
                                     : pack::peephole_at(layer_, row.index, std::min(gate, 2u), channel);
    return unit_[k] * floats_[row.tensor + at];
  }

  float scale(uint32_t gate, uint32_t channel) const {
    float largest = 0;
    for (uint32_t k = 0; k < depth(); ++k) largest = std::max(largest, std::fabs(weight(k, gate, channel)));
    return largest / kLargest;
  }

 private:
  // Of the weights, all gates.
  struct Row {
    uint64_t tensor;
    uint32_t index, of;
  };

  void append(uint32_t rows, uint64_t tensor, const std::vector<float>& ranges) {
    const float widest = *std::ranges::max_element(ranges);
    const float narrowest = widest > 0 ? widest * kNarrowest : 1;
    for (uint32_t k = 0; k < pack::round_up_16(rows); ++k) {
      unit_.push_back(k < rows ? std::max(ranges[k], narrowest) / kLargest : 0);
      row_.push_back({tensor, k, rows});
    }
  }

  const pack::LayerRecord& layer_;
  std::span<const float> floats_;
  std::vector<float> unit_;  // of a quantised 1
  std::vector<Row> row_;
  uint32_t first_y_ = 0;
};

// Columns in the order of kInt8Sums: gates of 16 channels after another, then gate o's share of P y.
struct Column {
  uint32_t gate, channel;
};

std::vector<Column> columns_of(const pack::LayerRecord& layer) {
  std::vector<Column> columns;
  for (uint32_t block = 0; block < layer.padded; block += 16) {
    for (uint32_t gate = 0; gate < kGates; ++gate) {
      for (uint32_t j = 0; j < 16; ++j) columns.push_back({gate, block + j});
    }
  }
  for (uint32_t j = 0; j < layer.padded; ++j) columns.push_back({kGates, j});
  return columns;
}

class LayerWriter {
 public:
  LayerWriter(const LayerProducts& products, const std::vector<Column>& columns)
      : products_(products), columns_(columns) {
    for (const Column& column : columns) scales_.push_back(products.scale(column.gate, column.channel));
    sums_.assign(columns.size(), 0);
  }

  // Rows k, in fours, of the columns first .. first + count - 1.
  void write(uint32_t k_first, uint32_t k_last, size_t first, size_t count) {
    for (uint32_t k = k_first; k < k_last; k += 4) {
      for (size_t column = first; column < first + count; ++column) {
        for (uint32_t i = 0; i < 4; ++i) write_one(k + i, column);
      }
    }
  }

  void append_to(Int8Sections* out) const {
    out->weights.insert(out->weights.end(), weights_.begin(), weights_.end());
    out->sums.insert(out->sums.end(), sums_.begin(), sums_.end());
    for (uint32_t k = 0; k < products_.depth(); ++k) out->scales.push_back(products_.per_unit(k));
    out->scales.insert(out->scales.end(), scales_.begin(), scales_.end());
  }

 private:
  void write_one(uint32_t k, size_t column) {
    const float weight = products_.weight(k, columns_[column].gate, columns_[column].channel);
    const float rounded = scales_[column] > 0 ? std::nearbyint(weight / scales_[column]) : 0;
    const auto w = static_cast<int8_t>(std::clamp(rounded, -kLargest, kLargest));
    weights_.push_back(w);
    sums_[column] += 128 * w;
  }

  const LayerProducts& products_;
  const std::vector<Column>& columns_;
  std::vector<int8_t> weights_;
  std::vector<int32_t> sums_;
  std::vector<float> scales_;
};

void append_layer(const LayerProducts& products, const pack::LayerRecord& layer, Int8Sections* out) {
  const std::vector<Column> columns = columns_of(layer);
  const uint32_t y = products.first_y(), depth = products.depth();
  LayerWriter writer(products, columns);
  for (size_t block = 0; block < layer.padded / 16; ++block) {
    writer.write(0, y, block * 64, 64);
    writer.write(y, depth, block * 64, 32);
  }
  writer.write(y, depth, size_t{kGates} * layer.padded, layer.padded);
  writer.append_to(out);
}

}  // namespace

Int8Sections quantize_network(std::span<const pack::LayerRecord> layers, std::span<const float> floats,
                              std::span<const HeardRanges> ranges) {
  check_ranges(layers, ranges);
  Int8Sections out;
  for (size_t l = 0; l + 1 < layers.size(); ++l)
    append_layer(LayerProducts(layers[l], l == 0, floats, ranges[l]), layers[l], &out);
  return out;
}

}  // namespace sinew::baker
