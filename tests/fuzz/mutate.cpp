// mutate.cpp  Words and numbers that break arithmetic.
#include "tests/fuzz/mutate.hpp"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>

namespace sinew::fuzz {
namespace {

uint32_t bits(float value) { return std::bit_cast<uint32_t>(value); }

uint32_t hostile_word(Random& random) {
  const uint32_t words[] = {0,
                            1,
                            2,
                            0x7fffffff,
                            0x80000000,
                            0xffffffff,
                            0xffff,
                            bits(1),
                            bits(-1),
                            bits(1e-6f),
                            bits(1e3f),
                            bits(1e6f),
                            bits(-1e6f),
                            bits(1e12f),
                            bits(std::numeric_limits<float>::max()),
                            bits(std::numeric_limits<float>::min()),
                            bits(std::numeric_limits<float>::denorm_min()),
                            bits(std::numeric_limits<float>::infinity()),
                            bits(std::numeric_limits<float>::quiet_NaN())};
  return words[random() % std::size(words)];
}

constexpr std::string_view kHostileNumbers[] = {
    "0",   "1",     "-1",   "2",    "0.5",        "-0.0",       "255",        "65535",
    "1e9", "1e-40", "1e39", "1e38", "2147483647", "2147483648", "4294967295", "18446744073709551615",
    "-5",  "1e308", "1000", "1e18"};

bool is_number_part(uint8_t c) {
  return std::isdigit(c) != 0 || c == '.' || c == '-' || c == '+' || c == 'e' || c == 'E';
}

}  // namespace

void change_word(std::span<uint8_t> bytes, Random& random) {
  if (bytes.size() < 4) {
    if (!bytes.empty()) bytes[random() % bytes.size()] ^= static_cast<uint8_t>(1u << random() % 8);
    return;
  }
  const std::span<uint8_t> at = bytes.subspan(random() % (bytes.size() / 4) * 4, 4);
  uint32_t word;
  std::memcpy(&word, at.data(), 4);
  switch (random() % 8) {
    case 0:
    case 1:
    case 2:
      word = hostile_word(random);
      break;
    case 3:
      word += static_cast<uint32_t>(random() % 9) - 4;
      break;
    case 4:  // as a number, larger or smaller by a power of two
      word = bits(std::ldexp(std::bit_cast<float>(word), static_cast<int>(random() % 41) - 20));
      break;
    case 5:
      word ^= 1u << random() % 32;
      break;
    case 6:  // another of the same kind
      std::memcpy(&word, bytes.data() + random() % (bytes.size() / 4) * 4, 4);
      break;
    default:
      LLVMFuzzerMutate(reinterpret_cast<uint8_t*>(&word), 4, 4);
  }
  std::memcpy(at.data(), &word, 4);
}

size_t change_json(uint8_t* text, size_t size, size_t max_size, Random& random) {
  if (size == 0 || random() % 3 == 0) return LLVMFuzzerMutate(text, size, max_size);
  uint8_t* const end = text + size;
  uint8_t* from = std::find_if(text + random() % size, end, [](uint8_t c) { return std::isdigit(c) != 0; });
  if (from == end) return LLVMFuzzerMutate(text, size, max_size);
  while (from > text && is_number_part(from[-1])) --from;
  uint8_t* const to = std::find_if_not(from, end, is_number_part);
  const std::string_view number = kHostileNumbers[random() % std::size(kHostileNumbers)];
  const size_t new_size = size - static_cast<size_t>(to - from) + number.size();
  if (new_size > max_size) return LLVMFuzzerMutate(text, size, max_size);
  std::memmove(from + number.size(), to, static_cast<size_t>(end - to));
  std::memcpy(from, number.data(), number.size());
  return new_size;
}

}  // namespace sinew::fuzz
