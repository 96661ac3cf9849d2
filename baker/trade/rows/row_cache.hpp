// row_cache.hpp  Measured rows in a file, so that a run that was stopped goes on.
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "baker/trade/rows/row.hpp"

namespace sinew::baker {

class RowCache {
 public:
  // The rows that the file holds, if they are made of the same (made_of.hpp). Else it is begun anew, and rows
  // that are none are left out; one line on standard error says either.
  RowCache(std::string path, nlohmann::ordered_json made_of);
  // What was measured of that way to run a character. One of its name but another kind, tier or level
  // is not it, which one line on standard error says.
  std::optional<Row> find(const Row& way) const;
  void add(const Row& row);  // in the place of one of its name; writes the file

 private:
  void take_up(const nlohmann::json& rows);

  std::string path_;
  nlohmann::ordered_json made_of_;
  std::vector<Row> rows_;
};

}  // namespace sinew::baker
