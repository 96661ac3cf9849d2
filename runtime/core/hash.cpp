// hash.cpp  Four independent multiply-rotate lanes over 8-byte words, folded at the end.
#include "core/hash.hpp"

#include <bit>
#include <cstring>

namespace sinew::core {
namespace {

static_assert(std::endian::native == std::endian::little, "words are hashed as they lie in memory");

constexpr uint64_t kOddA = 0x9e3779b97f4a7c15;  // 2^64 / golden ratio
constexpr uint64_t kOddB = 0xd6e8feb86659fd93;  // a multiplier with good avalanche

constexpr uint64_t mix(uint64_t lane, uint64_t word) noexcept { return std::rotl((lane ^ word) * kOddA, 29); }

constexpr uint64_t avalanche(uint64_t h) noexcept {
  h = (h ^ (h >> 32)) * kOddB;
  h = (h ^ (h >> 32)) * kOddB;
  return h ^ (h >> 32);
}

}  // namespace

uint64_t hash64(std::span<const std::byte> bytes) noexcept {
  constexpr size_t kLanes = 4, kWord = sizeof(uint64_t), kBlock = kLanes * kWord;
  uint64_t lanes[kLanes] = {kOddA, kOddA << 1, kOddB, kOddB << 1};
  size_t at = 0;
  for (; at + kBlock <= bytes.size(); at += kBlock) {
    uint64_t words[kLanes];
    std::memcpy(words, bytes.data() + at, kBlock);
    for (size_t k = 0; k < kLanes; ++k) lanes[k] = mix(lanes[k], words[k]);
  }
  for (size_t k = 0; at < bytes.size(); at += kWord, ++k) {
    uint64_t word = 0;  // the last one is filled up with zeros; the length tells them from zeros in the data
    std::memcpy(&word, bytes.data() + at, bytes.size() - at < kWord ? bytes.size() - at : kWord);
    lanes[k] = mix(lanes[k], word);
  }
  uint64_t h = bytes.size();
  for (uint64_t lane : lanes) h = mix(h, avalanche(lane));
  return avalanche(h);
}

bool has_checksum(std::span<const std::byte> bytes, uint64_t checksum) noexcept {
#ifdef SINEW_TRUST_CHECKSUMS
  return static_cast<void>(bytes), static_cast<void>(checksum), true;
#else
  return hash64(bytes) == checksum;
#endif
}

}  // namespace sinew::core
