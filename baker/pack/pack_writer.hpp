// pack_writer.hpp  Sections to a .sinew file. Byte-identical for equal input.
#pragma once
#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "pack/format.hpp"

namespace sinew::baker {

class PackWriter {
 public:
  explicit PackWriter(pack::FileKind kind) : kind_(kind) {}
  // Plain numbers make elements of `per_element` numbers: 3, 12 ...
  // What a whole, checked pack holds, to put other sections in the place of some.
  static PackWriter from_pack(std::span<const std::byte> bytes);
  template <class T>
  void section(pack::SectionKind kind, const std::vector<T>& elements, size_t per_element = 1);
  // Behind what the section holds already.
  template <class T>
  void append(pack::SectionKind kind, const std::vector<T>& elements, size_t per_element = 1);
  uint32_t string(const std::string& text);  // offset in kStrings; equal texts share one
  std::vector<std::byte> finish() const;     // a section without elements is left out

 private:
  void add(pack::SectionKind kind, uint32_t element_bytes, const void* data, size_t bytes);
  void add_behind(pack::SectionKind kind, uint32_t element_bytes, const void* data, size_t bytes);
  struct Section {
    uint32_t element_bytes;
    std::vector<std::byte> bytes;
  };
  pack::FileKind kind_;
  std::map<uint32_t, Section> sections_;  // ascending by kind: the order in the file
  std::string strings_;
};

template <class T>
void PackWriter::section(pack::SectionKind kind, const std::vector<T>& elements, size_t per_element) {
  add(kind, static_cast<uint32_t>(sizeof(T) * per_element), elements.data(), elements.size() * sizeof(T));
}

template <class T>
void PackWriter::append(pack::SectionKind kind, const std::vector<T>& elements, size_t per_element) {
  add_behind(kind, static_cast<uint32_t>(sizeof(T) * per_element), elements.data(),
             elements.size() * sizeof(T));
}

}  // namespace sinew::baker
