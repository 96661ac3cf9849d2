// hop_of_crowd.hpp  A coarse creature with tiers, what is true of its hop, and how perf's programs are called
// on it.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "tests/baker/programs/creature_hop.hpp"

namespace sinew::test {

class HopOfCrowd {
 public:
  std::string tiered() const { return file("tiered.sinew"); }
  const std::string& truth() const { return hop_.truth; }              // 1.5 s
  std::string long_truth() const { return file("long.safetensors"); }  // 1.6 s
  const std::string& weights() const { return hop_.weights; }
  std::string file(const std::string& name) const { return hop_.folder.file(name); }

 private:
  friend const HopOfCrowd& hop_of_crowd();
  HopOfCrowd();
  CreatureHop hop_;
};

// Made once.
const HopOfCrowd& hop_of_crowd();

// A row by column; commas in quotes are of a name.
using Row = std::map<std::string, std::string>;
std::vector<Row> rows_of(const std::string& csv);
double number(const Row& row, const std::string& column);  // a test's failure if it is none or not finite

}  // namespace sinew::test
