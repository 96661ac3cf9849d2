// source.cpp  One-line messages that name the file.
#include "baker/import/source.hpp"

#include "baker/common/bad_input.hpp"

namespace sinew::baker {

std::string one_line(const std::string& text, size_t max_length) {
  std::string line;
  for (char c : text) {
    if (line.size() >= max_length) return line + "...";
    const bool printable = static_cast<unsigned char>(c) >= 0x20 && c != 0x7f;
    if (printable || (!line.empty() && line.back() != ' ')) line += printable ? c : ' ';
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

void Source::refuse(const std::string& where, const std::string& what, const std::string& mend) const {
  const std::string place = where.empty() ? "" : one_line(where) + ": ";
  throw BadInput(one_line(path, 4096) + ": " + place + one_line(what, 400) + "; " + mend);
}

void Source::note(const std::string& where, const std::string& what) {
  notes.push_back(where.empty() ? one_line(what, 400) : one_line(where) + ": " + one_line(what, 400));
}

}  // namespace sinew::baker
