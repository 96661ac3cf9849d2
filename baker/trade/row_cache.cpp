// row_cache.cpp  see row_cache.hpp.
#include "baker/trade/row_cache.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "baker/common/read_file.hpp"
#include "baker/common/write_file.hpp"

namespace sinew::baker {
namespace {

using Json = nlohmann::ordered_json;

bool is_held(const nlohmann::json& file) {
  return file.is_object() && file.contains("made_of") && file.at("made_of").is_object() &&
         file.contains("rows");
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
    for (const auto& row : file.at("rows")) rows_.push_back(row_from(row));
  else
    std::fprintf(stderr, "sinew-trade: %s: is %s; all is measured anew\n", path_.c_str(), others.c_str());
}

std::optional<Row> RowCache::find(const std::string& name) const {
  const auto found = std::ranges::find(rows_, name, &Row::name);
  return found == rows_.end() ? std::nullopt : std::optional(*found);
}

void RowCache::add(const Row& row) {
  rows_.push_back(row);
  Json out = {{"made_of", made_of_}, {"rows", Json::array()}};
  for (const Row& held : rows_) out["rows"].push_back(to_json(held));
  write_file(path_, out.dump());
}

}  // namespace sinew::baker
