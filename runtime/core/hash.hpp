// hash.hpp  A fast 64-bit hash for checksums and for comparing results; not for secrets.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace sinew::core {

// The same on every little-endian machine. Bytes that differ inside a single aligned 8-byte word never
// collide (each mixing step is a bijection of the word and of the lane); other differences go unseen once in
// 2^64.
uint64_t hash64(std::span<const std::byte> bytes) noexcept;

// A build of the fuzz targets takes every checksum as right, so that what lies behind it is reached.
bool has_checksum(std::span<const std::byte> bytes, uint64_t checksum) noexcept;

}  // namespace sinew::core
