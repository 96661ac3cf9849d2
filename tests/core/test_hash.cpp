// test_hash.cpp  The checksum sees every change, and stays the same for ever: it lies in files.
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <set>
#include <vector>

#include "core/hash.hpp"

using sinew::core::hash64;

namespace {

std::vector<std::byte> random_bytes(size_t count) {
  std::mt19937 random(5);
  std::vector<std::byte> bytes(count);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
  return bytes;
}

}  // namespace

TEST_CASE("every_single_bit_changes_the_hash") {
  std::vector<std::byte> bytes = random_bytes(133);  // whole blocks, whole words and a rest
  const uint64_t before = hash64(bytes);
  for (size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    const auto mask = static_cast<std::byte>(1u << bit % 8);
    bytes[bit / 8] ^= mask;
    CHECK(hash64(bytes) != before);
    bytes[bit / 8] ^= mask;
  }
}

TEST_CASE("zeros_of_different_lengths_have_different_hashes") {
  std::set<uint64_t> hashes;
  constexpr size_t kLengths = 200;
  for (size_t length = 0; length < kLengths; ++length) hashes.insert(hash64(std::vector<std::byte>(length)));
  CHECK(hashes.size() == kLengths);
}

TEST_CASE("swapped_words_change_the_hash") {
  std::vector<std::byte> bytes = random_bytes(96);
  const uint64_t before = hash64(bytes);
  for (size_t word = 0; word + 16 <= bytes.size(); word += 8) {
    std::vector<std::byte> swapped = bytes;
    std::swap_ranges(swapped.begin() + static_cast<long>(word), swapped.begin() + static_cast<long>(word + 8),
                     swapped.begin() + static_cast<long>(word + 8));
    CHECK(hash64(swapped) != before);
  }
}

// A change of these numbers is a new format version (pack/format.hpp).
TEST_CASE("the_hash_of_known_bytes_is_what_it_always_was") {
  CHECK(hash64({}) == 0xd8deb72135f1bdf6);
  CHECK(hash64(random_bytes(7)) == 0xac25056635f6c9ae);
  CHECK(hash64(random_bytes(1000)) == 0x22aa0a3a186ca602);
}
