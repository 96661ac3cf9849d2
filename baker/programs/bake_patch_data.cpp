// bake_patch_data.cpp  sinew-bake patch-data: simulates the bodies of a plan, one file a run.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "baker/common/bad_input.hpp"
#include "baker/common/progress.hpp"
#include "baker/patches/patch_run.hpp"
#include "baker/programs/commands.hpp"
#include "baker/programs/data_folder.hpp"

namespace sinew::baker {
namespace {

namespace fs = std::filesystem;

struct PatchDataOptions {
  std::string plan, output;
  bool with_explicit = false;
};

std::string file_of(const PatchLine& line, uint64_t seed) {
  return line.shape + "-" + line.split + "-" + std::to_string(seed) + ".safetensors";
}

// A line at the end says how many were left out because a step did not converge.
bool write_run(const PatchLine& line, const PatchPlan& plan, uint64_t seed, bool with_explicit,
               const fs::path& path) {
  try {
    write_safetensors(path.string(), simulate_patches(line, plan, seed, with_explicit));
    return true;
  } catch (const BadInput&) {
    throw;
  } catch (const std::runtime_error& error) {
    std::fprintf(stderr, "patch-data: left out: %s: %s\n", file_of(line, seed).c_str(), error.what());
    return false;
  }
}

void run_patch_data(const PatchDataOptions& options) {
  const PatchPlan plan = read_patch_plan(options.plan);
  begin_data_folder(options.output, options.plan);
  size_t total = 0, done = 0, left_out = 0;
  for (const PatchLine& line : plan.lines) total += line.runs;
  Progress progress("patch-data", total);
  for (const PatchLine& line : plan.lines)
    for (uint64_t seed = line.first_seed; seed < line.first_seed + line.runs; ++seed) {
      const fs::path path = fs::path(options.output) / file_of(line, seed);
      const bool with_explicit = options.with_explicit && line.split == "test";
      if (!fs::exists(path)) left_out += !write_run(line, plan, seed, with_explicit, path);
      progress.update(++done);
    }
  std::printf("%s: %zu runs, %zu left out\n", options.output.c_str(), total - left_out, left_out);
}

}  // namespace

void add_patch_data_command(CLI::App& app, int*) {
  auto options = std::make_shared<PatchDataOptions>();
  CLI::App* command =
      app.add_subcommand("patch-data", "Simulates the bodies that an emulator of patches is trained on");
  command->add_option("--plan", options->plan, "JSON; see baker/patches/patch_plan.hpp")->required();
  command->add_flag("--explicit", options->with_explicit,
                    "test runs also say what explicit central differences leave");
  command
      ->add_option("-o,--output", options->output,
                   "folder of the data set, a file a run; one that was cut goes on")
      ->required();
  command->callback([options] { run_patch_data(*options); });
}

}  // namespace sinew::baker
