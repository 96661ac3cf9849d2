// patch_plan.cpp  Reads a plan line by line.
#include "baker/patches/patch_plan.hpp"

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

void read_range(JsonSection& section, const char* key, double low, double high, double& least, double& most) {
  const Eigen::VectorXd range = section.numbers(key, 2, low, high);
  least = range[0], most = range[1];
  if (least > most) section.complain(key, "has its larger number first");
}

BodyShape shape_of(const JsonSection& section, const std::string& name) {
  const auto* const found = std::ranges::find(kBodyShapes, name);
  if (found == std::end(kBodyShapes))
    section.complain("shape", "is none of sphere, cylinder, ear, slab, limb");
  return static_cast<BodyShape>(found - std::begin(kBodyShapes));
}

PatchLine read_line(JsonSection section) {
  PatchLine line;
  line.shape = section.text("shape");
  line.kind = shape_of(section, line.shape);
  line.split = section.text("split");
  if (std::ranges::find(kPatchSplits, line.split) == std::end(kPatchSplits))
    section.complain("split", "is none of train, validation, test");
  line.first_seed = whole(section, "first_seed", 1, 1, 1e12);
  line.runs = static_cast<uint32_t>(whole(section, "runs", 1, 1, 1e5));
  line.ticks = static_cast<uint32_t>(whole(section, "ticks", 100, 4, 1e4));
  read_range(section, "size_cells", 2, 20, line.least_size, line.most_size);
  read_range(section, "stiffness", 1e-3, 1e5, line.least_stiffness, line.most_stiffness);
  line.stiffnesses = static_cast<uint32_t>(whole(section, "stiffnesses", 0, 0, 1000));
  line.most_acceleration = section.number("most_acceleration", line.most_acceleration, 1e-3, 10);
  line.is_painted = section.flag("painted", false);
  section.finish();
  return line;
}

bool share_a_seed(const PatchLine& a, const PatchLine& b) {
  return a.kind == b.kind && a.first_seed < b.first_seed + b.runs && b.first_seed < a.first_seed + a.runs;
}

}  // namespace

PatchPlan read_patch_plan(const std::string& path) {
  const JsonFile file = read_json_file(path);
  JsonSection section(file);
  PatchPlan plan;
  plan.rate_hz = section.number("rate_hz", plan.rate_hz, 10, 240);
  plan.substeps = static_cast<uint32_t>(whole(section, "substeps", plan.substeps, 1, 64));
  plan.backward_euler = section.flag("backward_euler", plan.backward_euler);
  plan.damping_ratio = section.number("damping_ratio", plan.damping_ratio, 0, 0.9);
  for (const JsonSection& line : section.sections("runs")) plan.lines.push_back(read_line(line));
  section.finish();
  if (plan.lines.empty()) throw BadInput(path + ": key 'runs': asks for nothing; give one line or more");
  for (size_t b = 0; b < plan.lines.size(); ++b)
    for (size_t a = 0; a < b; ++a)
      if (share_a_seed(plan.lines[a], plan.lines[b]))
        throw BadInput(path + ": runs[" + std::to_string(b) + "] shares seeds with runs[" +
                       std::to_string(a) + "]; what is held out would be trained on; give other seeds");
  return plan;
}

}  // namespace sinew::baker
