// bake_rod_data.cpp  sinew-bake rod-data: simulates the rods of a plan, one file a run.
#include <cstdio>
#include <filesystem>
#include <memory>

#include "baker/common/bad_input.hpp"
#include "baker/common/progress.hpp"
#include "baker/programs/commands.hpp"
#include "baker/programs/data_folder.hpp"
#include "baker/rods/rod_run.hpp"

namespace sinew::baker {
namespace {

namespace fs = std::filesystem;

struct RodDataOptions {
  std::string plan, output;
};

std::string file_of(const RodLine& line, uint64_t seed) {
  const std::string rods = line.range.rods > 1 ? std::to_string(line.range.rods) : "";
  return line.scene + rods + "-" + line.split + "-" + std::to_string(seed) + ".safetensors";
}

// Of a run; a line at the end says how many were left out because the solver did not reach the truth.
bool write_run(const RodLine& line, const RodPlan& plan, uint64_t seed, const fs::path& path) {
  try {
    write_safetensors(path.string(), simulate_rod(line, plan, seed));
    return true;
  } catch (const NoTruth& error) {
    std::fprintf(stderr, "rod-data: left out: %s\n", error.what());
    return false;
  }
}

void run_rod_data(const RodDataOptions& options) {
  const RodPlan plan = read_rod_plan(options.plan);
  begin_data_folder(options.output, options.plan);
  size_t total = 0, done = 0, left_out = 0;
  for (const RodLine& line : plan.lines) total += line.runs;
  Progress progress("rod-data", total);
  for (const RodLine& line : plan.lines) {
    for (uint64_t seed = line.first_seed; seed < line.first_seed + line.runs; ++seed) {
      const fs::path path = fs::path(options.output) / file_of(line, seed);
      if (!fs::exists(path)) left_out += !write_run(line, plan, seed, path);
      progress.update(++done);
    }
  }
  std::printf("%s: %zu runs, %zu left out\n", options.output.c_str(), total - left_out, left_out);
}

}  // namespace

void add_rod_data_command(CLI::App& app, int*) {
  auto options = std::make_shared<RodDataOptions>();
  CLI::App* command = app.add_subcommand("rod-data", "Simulates the rods that learned starts are trained on");
  command->add_option("--plan", options->plan, "JSON; see baker/rods/rod_plan.hpp")->required();
  command
      ->add_option("-o,--output", options->output,
                   "folder of the data set, a file a run; one that was cut goes on")
      ->required();
  command->callback([options] { run_rod_data(*options); });
}

}  // namespace sinew::baker
