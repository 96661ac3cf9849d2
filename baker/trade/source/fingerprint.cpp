// fingerprint.cpp  see fingerprint.hpp.
#include "baker/trade/source/fingerprint.hpp"

#include <cstdio>

#include "baker/common/files/read_file.hpp"
#include "core/hash.hpp"

namespace sinew::baker {

Fingerprint& Fingerprint::add(std::span<const std::byte> bytes) {
  value_ = value_ * 31 + core::hash64(bytes) + bytes.size();
  return *this;
}

Fingerprint& Fingerprint::add(const std::string& text) { return add(std::as_bytes(std::span(text))); }

Fingerprint& Fingerprint::add_file(const std::string& path) {
  return path.empty() ? add(std::string()) : add(read_file(path));
}

std::string Fingerprint::text() const {
  char text[24];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value_));
  return text;
}

}  // namespace sinew::baker
