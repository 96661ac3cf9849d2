// read_file.hpp  Whole files into memory.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace sinew::baker {

// Throws BadInput naming the path and the system's reason: missing, a directory, unreadable.
std::vector<std::byte> read_file(const std::string& path);
std::string read_text(const std::string& path);

}  // namespace sinew::baker
