// write_block.cpp  write_block FILE: a small character with flesh and rods, for the consumer to load.
#include <cstdio>

#include "tests/scenes/soft_block.hpp"

int main(int count, char** arguments) {
  if (count != 2) return 2;
  const sinew::scenes::PackBytes pack =
      sinew::scenes::soft_block({.cells = 2, .nodes = 4, .rods = sinew::scenes::RodMatter{}});
  const std::span<const std::byte> bytes = pack.bytes();
  std::FILE* file = std::fopen(arguments[1], "wb");
  if (!file) return 1;
  const bool is_written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  return std::fclose(file) == 0 && is_written ? 0 : 1;
}
