// pack_editor.hpp  A pack that a test may damage, with or without mending its checksums.
#pragma once
#include <cstring>
#include <span>
#include <vector>

#include "core/aligned_block.hpp"
#include "core/hash.hpp"
#include "pack/format.hpp"
#include "pack/reader.hpp"

namespace sinew::test {

class PackEditor {
 public:
  explicit PackEditor(std::span<const std::byte> bytes) : block_(bytes.size()), size_(bytes.size()) {
    std::memcpy(block_.data(), bytes.data(), bytes.size());
  }

  std::span<std::byte> bytes() { return {block_.data(), size_}; }
  pack::FileHeader& header() { return *reinterpret_cast<pack::FileHeader*>(block_.data()); }
  std::span<pack::SectionEntry> table() {
    return {reinterpret_cast<pack::SectionEntry*>(block_.data() + sizeof(pack::FileHeader)),
            header().section_count};
  }

  // Elements, or the plain numbers that elements are made of; empty if the pack has no such section.
  template <class T>
  std::span<T> section(pack::SectionKind kind) {
    for (const pack::SectionEntry& entry : table())
      if (entry.kind == static_cast<uint32_t>(kind))
        return {reinterpret_cast<T*>(block_.data() + entry.offset),
                entry.count * entry.element_bytes / sizeof(T)};
    return {};
  }

  // Makes every checksum right again, so that what reads the content is reached.
  void seal() {
    for (pack::SectionEntry& entry : table())
      entry.checksum = core::hash64(bytes().subspan(entry.offset, entry.count * entry.element_bytes));
    seal_table();
  }
  void seal_table() { header().table_checksum = core::hash64(std::as_bytes(table())); }

  Status open(pack::PackView* view) { return pack::open_pack(bytes(), view); }
  Status open() {
    pack::PackView view;
    return open(&view);
  }

 private:
  core::AlignedBlock block_;
  size_t size_;
};

}  // namespace sinew::test
