// sinew-trade  Every tier of a character against ground truth: what it costs, how far it is off, which are
// worth having; and the character with those baked. See `sinew-trade --help`.
#include <chrono>
#include <cstdio>
#include <filesystem>

#include "baker/common/command_line/program.hpp"
#include "baker/common/files/write_file.hpp"
#include "baker/pack/character/patches_pack.hpp"
#include "baker/trade/measure.hpp"
#include "baker/trade/report/chart.hpp"
#include "baker/trade/report/table.hpp"
#include "baker/trade/report/write_tiers.hpp"
#include "baker/trade/source/made_of.hpp"
#include "baker/trade/source/processor.hpp"
#include "baker/trade/source/truths.hpp"

namespace {

using namespace sinew::baker;

struct Options {
  std::string character, folder;
  std::vector<std::string> truth, clips;
  double seconds = 10;
  BakedFrom source;
};

void add_options(CLI::App& app, Options* o) {
  app.add_option("character", o->character, "C.sinew")->required();
  app.add_option("-o,--output", o->folder, "folder of the tables, pictures, the character and cached results")
      ->required();
  app.add_option("--truth", o->truth, "trajectories of sinew-bake truth --positions");
  app.add_option("--source", o->source.glb,
                 "the glTF it was baked from: without --truth its clips are simulated; and it is baked with "
                 "other weights "
                 "and, of one control graph alone, other nodes to compare; by default C.glb next to C.sinew");
  app.add_option("--recipe", o->source.recipe, "as it was baked");
  app.add_option("--tissue", o->source.weights, "weights to bake it with otherwise: its own, then others");
  app.add_option("--rods", o->source.rods, "weights that its rods start from, as it was baked");
  app.add_option("--emulator", o->source.emulator, "weights that predict its patches, as it was baked");
  app.add_option("--clip", o->clips,
                 "a clip to simulate, best one that its weights were not trained on; by default all");
  app.add_option("--seconds", o->seconds, "of each that is simulated, 0.1 to 60; by default 10");
}

LoadedPack load(const std::string& path) {
  LoadedPack pack = LoadedPack::from_file(path);
  if (pack.view().kind != sinew::pack::FileKind::kCharacter)
    throw BadInput(path + ": is a model without a character; give what sinew-bake character made");
  if (pack.view().regions.empty()) throw BadInput(path + ": has no soft part, and so no tiers to measure");
  return pack;
}

void find_source(Options* o) {
  const std::string beside = std::filesystem::path(o->character).replace_extension(".glb").string();
  if (o->source.glb.empty() && o->truth.empty() && std::filesystem::exists(beside)) o->source.glb = beside;
  if (o->source.glb.empty() && o->truth.empty())
    throw BadInput(o->character + ": has no " + beside +
                   " next to it to simulate; give --source IN.glb --recipe R.json, or --truth T.safetensors");
}

std::vector<TrueSurface> read_truth(const std::vector<std::string>& paths, const LoadedPack& character) {
  std::vector<TrueSurface> out;
  for (const std::string& path : paths) out.emplace_back(path, character.view());
  return out;
}

std::vector<TrueSurface> find_truth(const Options& options, const LoadedPack& character) {
  if (!options.truth.empty()) return read_truth(options.truth, character);
  return read_truth(simulate_clips(options.source, options.clips, options.seconds, character.view(),
                                   options.folder + "/truth"),
                    character);
}

// It is baked otherwise with what it was baked with.
void check_emulator_of(const LoadedPack& character, const BakedFrom& source) {
  const bool emulates = emulates_patches(character.view());
  if (emulates && !source.weights.empty() && source.emulator.empty())
    throw BadInput(source.glb + ": its patches are emulated: give --emulator W.safetensors, as it was baked");
  if (source.emulator.empty()) return;
  if (!emulates) throw BadInput("--emulator " + source.emulator + ": the character has no emulated part");
  const Safetensors weights = read_safetensors(source.emulator);
  check_emulator(weights, static_cast<double>(character.view().network->rate_hz));
}

// What a run writes into its folder.
void promise_files(const Options& options) {
  const std::string stem = std::filesystem::path(options.character).stem().string();
  for (const std::string& file :
       {stem + ".sinew", std::string("trade.csv"), std::string("trade.json"), std::string("trade.svg"),
        std::string("trade.png"), std::string("measured.json")})
    promise_file(options.folder + "/" + file);
}

void write(const Measured& measured, const LoadedPack& character, const std::string& folder) {
  write_file(folder + "/trade.csv", std::string_view(as_csv(measured)));
  write_file(folder + "/trade.json", std::string_view(as_json(measured)));
  write_chart(folder + "/trade", measured);
  write_with_tiers(folder + "/" + measured.character + ".sinew", character, tier_records(measured.rows));
  std::fputs(as_table(measured).c_str(), stdout);
}

void run(Options options) {
  const auto start = std::chrono::steady_clock::now();
  if (!(options.seconds >= 0.1 && options.seconds <= 60)) throw BadInput("--seconds: must be from 0.1 to 60");
  promise_files(options);
  const LoadedPack character = load(options.character);
  find_source(&options);
  check_emulator_of(character, options.source);
  const std::vector<TrueSurface> surfaces = find_truth(options, character);
  make_folder(options.folder);  // not before truth and clips were found good
  const std::vector<Variant> variants = variants_of(options.source);
  const std::string kept = options.folder + "/measured.json";
  RowCache cache(kept, made_of(character, surfaces, options.source));
  const Measurement found = measure(character, surfaces, variants, cache);
  Measured measured{.character = std::filesystem::path(options.character).stem().string(),
                    .processor = processor_name(),
                    .motions = {},
                    .vertices = character.view().region_vertices.size(),
                    .rows = found.rows};
  for (const TrueSurface& surface : surfaces) measured.motions.push_back(surface.name());
  write(measured, character, options.folder);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  std::printf("%.0f s; %zu of %zu rows taken from %s\n", took.count(), found.measured_before,
              found.rows.size(), kept.c_str());
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Measures every tier of a character: time a step against error to ground truth."};
  Options options;
  add_options(app, &options);
  return run_program("sinew-trade", app, argc, argv, [&] {
    run(options);
    return 0;
  });
}
