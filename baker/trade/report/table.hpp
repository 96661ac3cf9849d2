// table.hpp  The measured rows for people and for machines.
#pragma once
#include <string>
#include <vector>

#include "baker/trade/rows/row.hpp"

namespace sinew::baker {

struct Measured {
  std::string character, processor;
  std::vector<std::string> motions;
  size_t vertices = 0;  // that tissue moves
  std::vector<Row> rows;
};

std::string as_table(const Measured& measured);
std::string as_csv(const Measured& measured);
std::string as_json(const Measured& measured);

}  // namespace sinew::baker
