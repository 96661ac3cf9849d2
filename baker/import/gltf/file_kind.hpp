// file_kind.hpp  What a file that is no glTF looks like, for the line that refuses it.
#pragma once
#include <string>
#include <vector>

namespace sinew::baker {

struct FileKind {
  std::string what;  // "an FBX"
  std::string mend;
};

// By its first bytes, whatever its name says.
FileKind kind_of_file(const std::vector<unsigned char>& bytes);

}  // namespace sinew::baker
