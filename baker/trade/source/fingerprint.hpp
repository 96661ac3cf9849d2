// fingerprint.hpp  One number of many bytes: what was kept is used again only for what it was made from.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace sinew::baker {

class Fingerprint {
 public:
  Fingerprint& add(std::span<const std::byte> bytes);
  Fingerprint& add(const std::string& text);
  // Throws BadInput where it cannot be read; no path counts as an empty file.
  Fingerprint& add_file(const std::string& path);
  // Of numbers alone, with no bytes between them.
  template <class Numbers>
  Fingerprint& add_all(const std::vector<Numbers>& values) {
    return add(std::as_bytes(std::span(values)));
  }
  std::string text() const;  // 16 hexadecimal digits

 private:
  uint64_t value_ = 0;
};

}  // namespace sinew::baker
