// count_allocations.hpp  How often operator new was called in this program.
#pragma once
#include <cstddef>

namespace sinew::test {

size_t allocation_count();

// Hands its argument back through another file, so that a compiler cannot leave the allocation out.
int* keep(int* memory);

}  // namespace sinew::test
