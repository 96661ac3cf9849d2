// safetensors.hpp  Reader and writer of the safetensors container (little-endian u64 header length, JSON
// header, raw data).
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace sinew::baker {

enum class Dtype { kF32, kF64, kF16, kI32, kI64, kU8, kBool };

struct Tensor {
  Dtype dtype = Dtype::kF32;
  std::vector<size_t> shape;
  std::vector<unsigned char> bytes;  // row-major, as in the file
  std::string where{};               // "file: tensor 'name'", for messages
  size_t count() const;
  // Any dtype, rounded; BadInput for an integer that a float cannot hold.
  std::vector<float> as_f32() const;
  // Integers and booleans; BadInput for floats and for what is out of range.
  std::vector<int32_t> as_i32() const;
};

struct Safetensors {
  std::string path;  // for messages
  std::map<std::string, std::string> metadata;
  std::map<std::string, Tensor> tensors;
  // The tensor, or BadInput naming the file, the tensor and the shape wanted; -1 in `shape` is any size.
  const Tensor& need(const std::string& name, const std::vector<long>& shape) const;
};

Tensor tensor_f32(std::vector<size_t> shape, const std::vector<float>& values);
Tensor tensor_i32(std::vector<size_t> shape, const std::vector<int32_t>& values);

// Throws BadInput: unreadable, truncated, data that overlaps, leaves gaps or ends elsewhere than the file,
// unknown dtype, shape and bytes that disagree, header over 16 MiB.
Safetensors read_safetensors(const std::string& path);
// Atomic; the data start 64-byte aligned.
void write_safetensors(const std::string& path, const Safetensors& file);

}  // namespace sinew::baker
