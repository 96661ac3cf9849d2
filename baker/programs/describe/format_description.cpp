// format_description.cpp  A description as a table for people.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "baker/programs/describe/describe.hpp"

namespace sinew::baker {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float() && std::isnan(value.get<double>())) return "-";  // not measured
  if (value.is_number_float()) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value.get<double>());
    return text;
  }
  return value.is_null() ? "-" : value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// Rows are objects of the same keys; the keys are the heading, columns as wide as their longest cell.
std::string table(const std::string& title, const Json& rows) {
  if (rows.empty()) return "";
  std::vector<std::vector<std::string>> cells(1);
  for (const auto& [key, value] : rows.front().items()) cells[0].push_back(key);
  for (const Json& row : rows) {
    cells.emplace_back();
    for (const auto& [key, value] : row.items()) cells.back().push_back(text_of(value));
  }
  std::string out = title + "\n";
  for (const std::vector<std::string>& row : cells) {
    std::string line = "  ";
    for (size_t column = 0; column < row.size(); ++column) {
      size_t width = 0;
      for (const std::vector<std::string>& each : cells) width = std::max(width, each[column].size());
      line += row[column] + std::string(width - row[column].size() + 2, ' ');
    }
    out += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return out;
}

// One "name value" a line; long values are cut, --json has them whole.
std::string list(const std::string& title, const Json& object) {
  constexpr size_t kWidest = 100;
  size_t width = 0;
  for (const auto& [key, value] : object.items()) width = std::max(width, key.size());
  std::string out = object.empty() ? "" : title + "\n";
  for (const auto& [key, value] : object.items()) {
    if (value.is_array() && !value.empty() && value.front().is_object()) continue;  // a table of its own
    std::string text = text_of(value);
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c >= 0 && c < ' '; }, ' ');
    if (text.size() > kWidest) text = text.substr(0, kWidest) + " ...";
    out += "  " + key + std::string(width - key.size() + 2, ' ') + text + "\n";
  }
  return out;
}

}  // namespace

std::string format_description(const Json& description) {
  std::string out = text_of(description["kind"]) + ", " + text_of(description["bytes"]) + " bytes";
  if (description.contains("version")) out += ", format version " + text_of(description["version"]);
  out += "\n";
  for (const auto& [key, value] : description.items()) {
    if (value.is_array()) out += table(key, value);
    if (value.is_object()) out += list(key, value);
    if (key == "network") out += table("inputs", value["inputs"]);
  }
  return out;
}

}  // namespace sinew::baker
