// json_file.cpp  Lines are counted in what the parser has taken from the text when it tells of a key.
#include "baker/common/files/json_file.hpp"

#include <algorithm>
#include <iterator>
#include <vector>

#include "baker/common/bad_input.hpp"
#include "baker/common/files/read_file.hpp"

namespace sinew::baker {
namespace {

struct CountingLines {
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  const char* at = nullptr;
  size_t* line = nullptr;

  const char& operator*() const { return *at; }
  CountingLines& operator++() {
    if (*at == '\n') ++*line;
    ++at;
    return *this;
  }
  CountingLines operator++(int) {
    const CountingLines before = *this;
    ++*this;
    return before;
  }
  bool operator==(const CountingLines& other) const { return at == other.at; }
};

class LineFinder : public nlohmann::json_sax<nlohmann::json> {
 public:
  size_t line = 1;
  std::map<std::string, size_t> line_of;

  bool null() override { return value(); }
  bool boolean(bool) override { return value(); }
  bool number_integer(number_integer_t) override { return value(); }
  bool number_unsigned(number_unsigned_t) override { return value(); }
  bool number_float(number_float_t, const string_t&) override { return value(); }
  bool string(string_t&) override { return value(); }
  bool binary(binary_t&) override { return value(); }
  bool start_object(size_t) override { return open(false); }
  bool start_array(size_t) override { return open(true); }
  bool end_object() override { return open_.pop_back(), true; }
  bool end_array() override { return open_.pop_back(), true; }
  bool key(string_t& name) override {
    key_ = open_.back().place + "." + name;
    line_of.try_emplace(key_, line);
    return true;
  }
  bool parse_error(size_t, const std::string&, const nlohmann::json::exception&) override { return false; }

 private:
  struct Container {
    std::string place;
    bool is_list;
    size_t items = 0;
  };

  std::string next_place() {
    if (open_.empty()) return "";
    Container& in = open_.back();
    return in.is_list ? in.place + "[" + std::to_string(in.items++) + "]" : key_;
  }
  bool value() { return next_place(), true; }
  bool open(bool is_list) {
    const std::string place = next_place();
    line_of.try_emplace(place, line);
    open_.push_back({place, is_list});
    return true;
  }

  std::vector<Container> open_;
  std::string key_;
};

// nlohmann's line without its own name and place.
std::string fault(const nlohmann::json::parse_error& error) {
  const std::string text = error.what();
  const size_t column = text.find("column"), begin = text.find(": ", column);
  return column == std::string::npos || begin == std::string::npos ? text : text.substr(begin + 2);
}

// "[json.exception.out_of_range.406] number overflow parsing '1e999'": the one that parsing can come to.
std::string number_of(const nlohmann::json::out_of_range& error) {
  const std::string text = error.what();
  const size_t begin = text.find('\'') + 1;
  return text.substr(begin, text.rfind('\'') - begin);
}

std::string position(const std::string& text, size_t byte) {
  const size_t end = std::min(byte == 0 ? 0 : byte - 1, text.size());
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), '\n');
  const size_t begin = end == 0 ? std::string::npos : text.rfind('\n', end - 1);
  return std::to_string(line) + ":" + std::to_string(begin == std::string::npos ? end + 1 : end - begin);
}

}  // namespace

JsonFile read_json_file(const std::string& path) {
  const std::string text = read_text(path);
  JsonFile file{path, {}, {}};
  try {
    file.json = nlohmann::json::parse(text, nullptr, true, true);
  } catch (const nlohmann::json::parse_error& error) {
    throw BadInput(path + ":" + position(text, error.byte) + ": not JSON: " + fault(error));
  } catch (const nlohmann::json::out_of_range& error) {
    const std::string number = number_of(error);
    throw BadInput(path + ":" + position(text, text.find(number) + 1) + ": " + number +
                   " is larger than any number can be");
  }
  LineFinder finder;
  nlohmann::json::sax_parse(CountingLines{text.data(), &finder.line},
                            CountingLines{text.data() + text.size(), &finder.line}, &finder,
                            nlohmann::json::input_format_t::json, true, true);
  file.line_of = std::move(finder.line_of);
  return file;
}

}  // namespace sinew::baker
