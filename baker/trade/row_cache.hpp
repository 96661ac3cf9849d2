// row_cache.hpp  Measured rows in a file, so that a run that was stopped goes on.
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "baker/trade/row.hpp"

namespace sinew::baker {

class RowCache {
 public:
  // The rows that the file holds, if they are made of the same (made_of.hpp). Else it is begun anew, which
  // one line on standard error says.
  RowCache(std::string path, nlohmann::ordered_json made_of);
  std::optional<Row> find(const std::string& name) const;
  void add(const Row& row);  // and writes the file

 private:
  std::string path_;
  nlohmann::ordered_json made_of_;
  std::vector<Row> rows_;
};

}  // namespace sinew::baker
