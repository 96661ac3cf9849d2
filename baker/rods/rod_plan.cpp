// rod_plan.cpp  Reads a plan line by line.
#include "baker/rods/rod_plan.hpp"

#include <algorithm>

#include "baker/common/bad_input.hpp"
#include "baker/common/files/json_section.hpp"

namespace sinew::baker {
namespace {

uint64_t whole(JsonSection& section, const char* key, double otherwise, double low, double high) {
  const double value = section.number(key, otherwise, low, high);
  if (value != static_cast<double>(static_cast<uint64_t>(value))) section.complain(key, "is no whole number");
  return static_cast<uint64_t>(value);
}

RodLine read_line(JsonSection section, const std::string& path) {
  RodLine line;
  line.scene = section.text("scene");
  line.split = section.text("split");
  line.range.kind = rod_kind(line.scene, path);
  if (std::ranges::find(kRodSplits, line.split) == std::end(kRodSplits)) {
    section.complain("split", "is none of train, validation, test, long");
  }
  line.runs = static_cast<uint32_t>(whole(section, "runs", 1, 1, 1e5));
  line.steps = static_cast<uint32_t>(whole(section, "steps", 50, 3, 1e5));
  line.first_seed = whole(section, "first_seed", 1, 1, 1e12);
  line.range.rods = static_cast<int>(whole(section, "rods", 1, 1, 1000));
  if ((line.range.rods > 1) != (line.range.kind == RodKind::kTree)) {
    section.complain("rods", "must be above 1 in a tree, and only there");
  }
  RodRange& range = line.range;
  const Eigen::VectorXd segments = section.numbers("segments", 2, 2, 2000),
                        young = section.numbers("young_pa", 2, 1, 1e13);
  range.least_segments = segments[0], range.most_segments = segments[1];
  range.softest_pa = young[0], range.stiffest_pa = young[1];
  if (segments[0] > segments[1]) section.complain("segments", "has its larger number first");
  if (young[0] > young[1]) section.complain("young_pa", "has its larger number first");
  section.finish();
  return line;
}

bool share_a_seed(const RodLine& a, const RodLine& b) {
  return a.scene == b.scene && a.range.rods == b.range.rods && a.first_seed < b.first_seed + b.runs &&
         b.first_seed < a.first_seed + a.runs;
}

}  // namespace

RodPlan read_rod_plan(const std::string& path) {
  const JsonFile file = read_json_file(path);
  JsonSection section(file);
  RodPlan plan;
  plan.dt_s = section.number("dt_s", plan.dt_s, 1e-3, 0.1);
  plan.tolerance_rad = section.number("tolerance_rad", plan.tolerance_rad, 1e-6, 1e-2);
  for (const JsonSection& line : section.sections("runs")) plan.lines.push_back(read_line(line, path));
  section.finish();
  if (plan.lines.empty()) throw BadInput(path + ": key 'runs': asks for nothing; give one line or more");
  for (size_t b = 0; b < plan.lines.size(); ++b) {
    for (size_t a = 0; a < b; ++a) {
      if (share_a_seed(plan.lines[a], plan.lines[b])) {
        throw BadInput(path + ": runs[" + std::to_string(b) + "] shares seeds with runs[" +
                       std::to_string(a) + "]; what is held out would be trained on; give other seeds");
      }
    }
  }
  return plan;
}

}  // namespace sinew::baker
