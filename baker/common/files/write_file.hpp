// write_file.hpp  Files are written beside their place and renamed: a reader sees the old file or the whole
// new one. What a killed process left of the same file is removed; two that write it at once are in each
// other's way no more than that one of them is last.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace sinew::baker {

// Throws BadInput naming the path when it cannot be written or is an input of this run (kept_files.hpp);
// nothing half-written is left behind.
void write_file(const std::string& path, std::span<const std::byte> bytes);
void write_file(const std::string& path, std::string_view text);
// Throws BadInput where the path is a directory: for programs that work long before they write.
void refuse_directory(const std::string& path);
// With the folders above it. Throws BadInput when it is none afterwards.
void make_folder(const std::string& path);

}  // namespace sinew::baker
