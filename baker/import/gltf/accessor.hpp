// accessor.hpp  Numbers out of a glTF file. tinygltf checks no bounds: every reach into a buffer is checked
// here.
#pragma once
#include <tiny_gltf.h>

#include <cstdint>
#include <string>
#include <vector>

#include "baker/import/gltf/source.hpp"

namespace sinew::baker {

class AccessorReader {
 public:
  AccessorReader(const tinygltf::Model& model, const Source& source) : model_(model), source_(source) {}

  // Elements, after checking that the index is one. `where` says who asks: "mesh 0 primitive 1 POSITION".
  size_t count(int accessor, const std::string& where) const;
  // Numbers an element: SCALAR 1 .. VEC4 4, MAT4 16.
  int components(int accessor, const std::string& where) const;
  // Row after row, [count][components]; integers that are marked as normalised become 0..1 or -1..1.
  std::vector<double> numbers(int accessor, int components, const std::string& where) const;
  // Of integers that are not marked as normalised the largest that their type holds; else 0.
  double largest_integer(int accessor, const std::string& where) const;
  // Whether it holds unsigned integers, plain ones.
  bool holds_indices(int accessor, const std::string& where) const;
  // Unsigned integers of one component.
  std::vector<uint32_t> indices(int accessor, const std::string& where) const;
  // The largest value the accessor's index type holds: glTF forbids it, it means primitive restart.
  uint32_t restart_value(int accessor, const std::string& where) const;

 private:
  struct Bytes {
    const unsigned char* data = nullptr;  // first element
    size_t stride = 0;
  };
  const tinygltf::Accessor& at(int accessor, const std::string& where) const;
  Bytes bytes(int view, size_t offset, size_t count, size_t element_bytes, const std::string& where) const;
  void overwrite_sparse(const tinygltf::Accessor& accessor, int components, const std::string& where,
                        std::vector<double>* values) const;

  const tinygltf::Model& model_;
  const Source& source_;
};

}  // namespace sinew::baker
