// recipe.cpp  A text is refused with one line, or read as the recipe of a character's tissue or of a
// creature.
#include "baker/mesh/recipe/recipe.hpp"

#include "baker/creature/creature.hpp"
#include "tests/fuzz/file_in_memory.hpp"
#include "tests/fuzz/mutate.hpp"
#include "tests/fuzz/refuses.hpp"

using namespace sinew;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const fuzz::FileInMemory file;
  const std::string& path = file.write(data, size);
  fuzz::refuses_or_does([&] { (void)baker::read_recipe(path); });
  fuzz::refuses_or_does([&] { (void)baker::read_creature_recipe(path); });
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
  fuzz::Random random(seed);
  return fuzz::change_json(data, size, max_size, random);
}
