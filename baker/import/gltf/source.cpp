// source.cpp  One-line messages that name the file.
#include "baker/import/gltf/source.hpp"

#include "baker/common/bad_input.hpp"

namespace sinew::baker {
namespace {

constexpr size_t kMostNotes = 200;  // a damaged file could make millions

}  // namespace

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
  throw BadInput(one_line(path_, 4096) + ": " + place + one_line(what, 400) + "; " + mend);
}

void Source::note(const std::string& where, const std::string& what) {
  for (Note& note : notes_)
    if (note.what == what) return void(++note.more);
  if (notes_.size() < kMostNotes)
    notes_.push_back({where, what, 0});
  else
    ++left_out_;
}

std::vector<std::string> Source::notes() const {
  std::vector<std::string> lines;
  for (const Note& note : notes_) {
    std::string line = note.where.empty() ? "" : one_line(note.where);
    if (note.more > 0) line += " and " + std::to_string(note.more) + " more";
    lines.push_back((line.empty() ? "" : line + ": ") + one_line(note.what, 400));
  }
  if (left_out_ > 0) lines.push_back(std::to_string(left_out_) + " more notes are left out");
  return lines;
}

}  // namespace sinew::baker
