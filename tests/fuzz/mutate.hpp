// mutate.hpp  Changes that keep a file's outer shape, so that what reads its inside is reached.
#pragma once
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>

// libFuzzer's own change of a block, guided by what the code compares; returns its new size.
extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t max_size);

namespace sinew::fuzz {

using Random = std::minstd_rand;

// Puts another 4-byte word, whole or in part, in the place of one of them; numbers that break arithmetic are
// preferred.
void change_word(std::span<uint8_t> bytes, Random& random);

// Puts another number in the place of one in the text, or lets libFuzzer change it; returns its new size.
size_t change_json(uint8_t* text, size_t size, size_t max_size, Random& random);

}  // namespace sinew::fuzz
