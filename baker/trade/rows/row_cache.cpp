// row_cache.cpp  see row_cache.hpp.
#include "baker/trade/rows/row_cache.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <tuple>

#include "baker/common/files/read_file.hpp"
#include "baker/common/files/write_file.hpp"

namespace sinew::baker {
namespace {

using Json = nlohmann::ordered_json;

bool is_held(const nlohmann::json& file) {
  return file.is_object() && file.contains("made_of") && file.at("made_of").is_object() &&
         file.contains("rows") && file.at("rows").is_array();
}

// Names of what differs.
std::string differences(const Json& made_of, const nlohmann::json& held) {
  std::string out;
  for (const auto& [name, value] : made_of.items())
    if (!held.contains(name) || held.at(name) != nlohmann::json(value))
      out += (out.empty() ? "of another " : ", ") + name;
  return out;
}

}  // namespace

RowCache::RowCache(std::string path, Json made_of) : path_(std::move(path)), made_of_(std::move(made_of)) {
  if (!std::filesystem::exists(path_)) return;
  const nlohmann::json file = nlohmann::json::parse(read_text(path_), nullptr, false);
  const std::string others = is_held(file) ? differences(made_of_, file.at("made_of")) : "no table of rows";
  if (others.empty())
    take_up(file.at("rows"));
  else
    std::fprintf(stderr, "sinew-trade: %s: is %s; all is measured again\n", path_.c_str(), others.c_str());
}

void RowCache::take_up(const nlohmann::json& rows) {
  for (const auto& json : rows)
    if (const std::optional<Row> row = row_from(json)) rows_.push_back(*row);
  if (const size_t left_out = rows.size() - rows_.size())
    std::fprintf(stderr,
                 "sinew-trade: %s: %zu of %zu rows hold no figures of a step; they are measured again\n",
                 path_.c_str(), left_out, rows.size());
}

std::optional<Row> RowCache::find(const Row& way) const {
  const auto found = std::ranges::find(rows_, way.name, &Row::name);
  if (found == rows_.end()) return std::nullopt;
  const auto key = [](const Row& row) { return std::tie(row.kind, row.tier, row.level); };
  if (key(*found) == key(way)) return *found;
  std::fprintf(stderr, "sinew-trade: %s: \"%s\" is of another tier or LOD; it is measured again\n",
               path_.c_str(), way.name.c_str());
  return std::nullopt;
}

void RowCache::add(const Row& row) {
  std::erase_if(rows_, [&](const Row& held) { return held.name == row.name; });
  rows_.push_back(row);
  Json out = {{"made_of", made_of_}, {"rows", Json::array()}};
  for (const Row& held : rows_) out["rows"].push_back(to_json(held));
  write_file(path_, out.dump());
}

}  // namespace sinew::baker
