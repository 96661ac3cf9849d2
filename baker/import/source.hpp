// source.hpp  The file that is being imported, as its messages name it.
#pragma once
#include <string>
#include <vector>

namespace sinew::baker {

// Text from a file made fit for one line: control characters become spaces, length is bounded.
std::string one_line(const std::string& text, size_t max_length = 160);

struct Source {
  std::string path;
  std::vector<std::string> notes;

  // Throws BadInput "path: where: what; mend".
  [[noreturn]] void refuse(const std::string& where, const std::string& what, const std::string& mend) const;
  void note(const std::string& where, const std::string& what);
};

}  // namespace sinew::baker
