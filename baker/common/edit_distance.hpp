// edit_distance.hpp  How many letters to insert, remove or replace: to name the key or bone that was meant.
#pragma once
#include <cstddef>
#include <string>

namespace sinew::baker {

size_t edit_distance(const std::string& a, const std::string& b);  // O(|a| |b|)

}  // namespace sinew::baker
