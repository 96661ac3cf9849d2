// json_section.cpp  Checked access to a JSON object.
#include "baker/common/files/json_section.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "baker/common/bad_input.hpp"
#include "baker/common/edit_distance.hpp"

namespace sinew::baker {
namespace {

std::string shortly(double number) {
  std::ostringstream out;
  out << number;
  return out.str();
}

}  // namespace

JsonSection::JsonSection(const nlohmann::json& json, std::string place, const JsonFile* file)
    : json_(&json), file_(file), place_(std::move(place)) {
  if (!json.is_object()) throw BadInput(where("") + "must be an object { ... }");
}

JsonSection::JsonSection(const nlohmann::json& json, std::string place)
    : JsonSection(json, std::move(place), nullptr) {}

JsonSection::JsonSection(const JsonFile& file) : JsonSection(file.json, file.path, &file) {}

JsonSection JsonSection::inner(const nlohmann::json& json, const std::string& place) const {
  return {json, place_ + "." + place, file_};
}

// The line of the key, or where it is missing, that of the section.
std::string JsonSection::where(const std::string& key) const {
  if (file_ == nullptr) return place_ + ": ";
  const std::string inside = place_.substr(file_->path.size());
  auto found = file_->line_of.find(inside + "." + key);
  if (found == file_->line_of.end()) found = file_->line_of.find(inside);
  std::string text = file_->path;
  if (found != file_->line_of.end()) text += ":" + std::to_string(found->second);
  return text + ": " + (inside.empty() ? "" : inside.substr(1) + ": ");
}

void JsonSection::complain(const std::string& key, const std::string& what) const {
  throw BadInput(where(key) + "\"" + key + "\" " + what);
}

const nlohmann::json* JsonSection::find(const std::string& key) {
  known_.push_back(key);
  const auto at = json_->find(key);
  return at == json_->end() ? nullptr : &*at;
}

const nlohmann::json& JsonSection::need(const std::string& key) {
  const nlohmann::json* value = find(key);
  if (!value) complain(key, "is missing");
  return *value;
}

bool JsonSection::has(const std::string& key) { return find(key) != nullptr; }

double JsonSection::number(const std::string& key, double otherwise, double low, double high) {
  const nlohmann::json* value = find(key);
  if (!value) return otherwise;
  if (!value->is_number()) complain(key, "must be a number");
  const double number = value->get<double>();
  if (!(number >= low && number <= high))
    complain(key, "is " + shortly(number) + "; it must be within " + shortly(low) + " .. " + shortly(high));
  return number;
}

bool JsonSection::flag(const std::string& key, bool otherwise) {
  const nlohmann::json* value = find(key);
  if (!value) return otherwise;
  if (!value->is_boolean()) complain(key, "must be true or false");
  return value->get<bool>();
}

std::string JsonSection::text(const std::string& key) {
  const nlohmann::json& value = need(key);
  if (!value.is_string() || value.get<std::string>().empty())
    complain(key, "must be a text that is not empty");
  return value.get<std::string>();
}

std::string JsonSection::text(const std::string& key, const std::string& otherwise) {
  return has(key) ? text(key) : otherwise;
}

std::vector<std::string> JsonSection::texts(const std::string& key) {
  std::vector<std::string> texts;
  const nlohmann::json* value = find(key);
  if (!value) return texts;
  if (!value->is_array()) complain(key, "must be a list of texts");
  for (const auto& item : *value) {
    if (!item.is_string()) complain(key, "must be a list of texts");
    texts.push_back(item.get<std::string>());
  }
  return texts;
}

Eigen::VectorXd JsonSection::numbers(const std::string& key, long count, double low, double high) {
  const nlohmann::json& value = need(key);
  const std::string wanted = "must be " + std::to_string(count) + " numbers";
  if (!value.is_array() || static_cast<long>(value.size()) != count) complain(key, wanted);
  Eigen::VectorXd numbers(count);
  for (long i = 0; i < count; ++i) {
    const nlohmann::json& item = value[static_cast<size_t>(i)];
    if (!item.is_number()) complain(key, wanted);
    numbers[i] = item.get<double>();
    if (!(numbers[i] >= low && numbers[i] <= high))
      complain(key, "holds " + shortly(numbers[i]) + "; each must be within " + shortly(low) + " .. " +
                        shortly(high));
  }
  return numbers;
}

std::vector<int> JsonSection::whole_numbers(const std::string& key, int low, int high) {
  const nlohmann::json& value = need(key);
  if (!value.is_array()) complain(key, "must be a list of whole numbers");
  std::vector<int> out;
  for (const double number : numbers(key, static_cast<long>(value.size()), low, high)) {
    if (number != std::floor(number)) complain(key, "must be a list of whole numbers");
    out.push_back(static_cast<int>(number));
  }
  return out;
}

Eigen::Vector3d JsonSection::vector3(const std::string& key, const Eigen::Vector3d& otherwise, double low,
                                     double high) {
  if (!has(key)) return otherwise;
  return numbers(key, 3, low, high);
}

Eigen::Vector3d JsonSection::color(const std::string& key) {
  const std::string hex = text(key);
  const bool well_formed = hex.size() == 7 && hex[0] == '#' &&
                           hex.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
  if (!well_formed) complain(key, "must be a colour as in \"#ff8040\"");
  const long rgb = std::stol(hex.substr(1), nullptr, 16);
  return Eigen::Vector3d(static_cast<double>(rgb >> 16), static_cast<double>((rgb >> 8) & 255),
                         static_cast<double>(rgb & 255)) /
         255;
}

std::vector<Eigen::VectorXd> JsonSection::rows(const std::string& key, long count, double low, double high) {
  std::vector<Eigen::VectorXd> rows;
  const nlohmann::json* value = find(key);
  if (!value) return rows;
  if (!value->is_array()) complain(key, "must be a list of rows of " + std::to_string(count) + " numbers");
  for (size_t i = 0; i < value->size(); ++i) {
    const nlohmann::json row = {{"row", (*value)[i]}};
    rows.push_back(inner(row, key + "[" + std::to_string(i) + "]").numbers("row", count, low, high));
  }
  return rows;
}

std::vector<JsonSection> JsonSection::sections(const std::string& key) {
  std::vector<JsonSection> sections;
  const nlohmann::json* value = find(key);
  if (!value) return sections;
  if (!value->is_array()) complain(key, "must be a list of objects");
  for (size_t i = 0; i < value->size(); ++i)
    sections.push_back(inner((*value)[i], key + "[" + std::to_string(i) + "]"));
  return sections;
}

JsonSection JsonSection::section(const std::string& key) { return inner(need(key), key); }

void JsonSection::finish() const {
  for (const auto& item : json_->items()) {
    if (std::find(known_.begin(), known_.end(), item.key()) != known_.end()) continue;
    const auto nearest = std::min_element(known_.begin(), known_.end(), [&](const auto& a, const auto& b) {
      return edit_distance(a, item.key()) < edit_distance(b, item.key());
    });
    complain(item.key(), "is not a key of a recipe here; did you mean \"" + *nearest + "\"?");
  }
}

}  // namespace sinew::baker
