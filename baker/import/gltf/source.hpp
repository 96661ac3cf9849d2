// source.hpp  The file that is being imported, as its messages name it.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace sinew::baker {

// Text from a file made fit for one line: control characters become spaces, length is bounded.
std::string one_line(const std::string& text, size_t max_length = 160);

class Source {
 public:
  explicit Source(std::string path) : path_(std::move(path)) {}
  const std::string& path() const { return path_; }

  // Throws BadInput "path: where: what; mend".
  [[noreturn]] void refuse(const std::string& where, const std::string& what, const std::string& mend) const;
  void note(const std::string& where, const std::string& what);
  // What was noted, one line each; the same of several places is one line, and very many end in a count.
  std::vector<std::string> notes() const;

 private:
  struct Note {
    std::string where, what;
    size_t more = 0;  // places after the first
  };
  std::string path_;
  std::vector<Note> notes_;
  size_t left_out_ = 0;
};

}  // namespace sinew::baker
