// mapped_file.hpp  A read-only memory-mapped file.
#pragma once
#include <cstddef>
#include <span>

#include "sinew/status.hpp"

namespace sinew::pack {

class MappedFile {
 public:
  MappedFile() noexcept = default;
  ~MappedFile();
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) noexcept;
  // kUnreadable with the path and the system's reason; an empty file maps to an empty span.
  static Status open(const char* path, MappedFile* out) noexcept;
  std::span<const std::byte> bytes() const noexcept { return {data_, size_}; }

 private:
  const std::byte* data_ = nullptr;
  size_t size_ = 0;
};

}  // namespace sinew::pack
